//! `sprag manual`: pages for `man`.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use clap::Args;
use clap_mangen::Man;
use sprag_report::output::{OutputError, ResultFolder, Results};

use super::context::{Completion, Context, Run};

/// Write pages for `man`, one for each command.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example:\n  sprag manual ~/.local/share/man/man1")]
pub struct ManualArguments {
    /// Folder for the pages; it is made where it is missing, and pages that are there are replaced.
    #[arg(value_name = "DIR", value_hint = clap::ValueHint::DirPath)]
    pub folder: PathBuf,
}

impl Run for ManualArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let mut folder = ResultFolder::new(self.folder.clone(), true);
        folder.make("")?;
        let mut definition = crate::line::definition().disable_help_subcommand(true);
        definition.build();
        let mut pages = Results::default();
        add(&definition, &folder, &mut pages)?;
        pages.commit()?;
        context.print(format_args!("pages in {}\n", folder.display()));
        Ok(Completion::Complete)
    }
}

/// Writes the pages of a command and of those below it.
fn add(command: &clap::Command, folder: &Path, pages: &mut Results) -> Result<(), OutputError> {
    for below in command.get_subcommands().filter(|below| !below.is_hide_set()) {
        add(below, folder, pages)?;
    }
    let man = Man::new(command.clone());
    pages.add(&folder.join(man.get_filename()), |file| file.write_all(&page(&man)?))
}

/// The text of a page. Lines that begin with two spaces, of examples and names of columns, are neither filled nor hyphenated.
fn page(man: &Man) -> io::Result<Vec<u8>> {
    let mut text = Vec::new();
    man.render(&mut text)?;
    let (mut page, mut as_it_is) = (Vec::new(), false);
    for line in text.split_inclusive(|byte| *byte == b'\n') {
        if line.starts_with(b"  ") != as_it_is {
            as_it_is = !as_it_is;
            page.extend_from_slice(if as_it_is { b".nf\n" } else { b".fi\n" });
        }
        page.extend_from_slice(line);
    }
    Ok(page)
}

#[cfg(test)]
mod tests {
    use sprag_report::streams::BAD_INPUT;

    use super::*;

    fn run(folder: &Path) -> (i32, String) {
        let (code, _, err) = crate::line::run(&["manual", folder.to_str().unwrap()]);
        (code, err)
    }

    /// The page that cannot be written is named, and no other is replaced.
    #[test]
    fn pages_are_written_together_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let [batch, whole] = ["sprag-batch.1", "sprag.1"].map(|name| folder.path().join(name));
        std::fs::write(&batch, "before").unwrap();
        std::fs::create_dir(&whole).unwrap();
        let (code, refused) = run(folder.path());
        assert!(code == BAD_INPUT && refused.starts_with(&format!("sprag: {}", whole.display())), "{refused}");
        assert_eq!(std::fs::read(&batch).unwrap(), b"before");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
        std::fs::remove_dir(&whole).unwrap();
        assert_eq!(run(folder.path()), (0, String::new()));
        let text = std::fs::read_to_string(&batch).unwrap();
        assert!(text.contains("columns\n.nf\n  id,geometry,") && text.contains(",free_time\n.fi\nand the result"), "{text}");
    }
}
