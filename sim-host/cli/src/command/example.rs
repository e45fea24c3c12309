//! `sprag example`: the scenes and studies that ship, which are inside the program.

use std::io::{BufReader, Read, Write};
use std::path::PathBuf;

use clap::Args;
use include_dir::{Dir, File, include_dir};
use sprag_report::output::{Results, claim_file};

use super::context::{Completion, Context, Run};
use super::out_arguments::OverwriteArguments;

/// The scenes of the repository.
static SCENES: Dir<'static> = include_dir!("$CARGO_MANIFEST_DIR/../../scenes");

/// Write a scene or study that ships with the program, or list them.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag example\n  sprag example near_fault && sprag simulate near_fault.toml\n\n\
    Writes NAME.toml, the schema by which editors check it, and the record that it names where there is one.")]
pub struct ExampleArguments {
    /// The scene or study to write; all are listed without it.
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
    /// Folder for the files; it is made where it is missing.
    #[arg(long, value_name = "DIR", default_value = ".", value_hint = clap::ValueHint::DirPath)]
    pub out: PathBuf,
    #[command(flatten)]
    pub replace: OverwriteArguments,
}

impl Run for ExampleArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        match &self.name {
            None => scenes().for_each(|file| context.print(format_args!("{:<14}{}\n", stem(file), title(file)))),
            Some(name) => write(name, self)?.iter().for_each(|path| context.print(format_args!("{}\n", path.display()))),
        }
        Ok(Completion::Complete)
    }
}

fn write(name: &str, arguments: &ExampleArguments) -> anyhow::Result<Vec<PathBuf>> {
    let name = name.strip_suffix(".toml").unwrap_or(name);
    let unknown = || anyhow::anyhow!("there is no example {name}; there are {}", names().join(", "));
    let scene = scenes().find(|file| stem(file) == name).ok_or_else(unknown)?;
    let named = |file: &&File<'_>| {
        let name = file.path().display();
        file.path() == scene.path()
            || text(scene).contains(&format!("\"{name}\""))
            || text(scene).starts_with(&format!("#:schema {name}\n"))
    };
    let files: Vec<&File<'_>> = SCENES.files().filter(named).collect();
    let folder = &arguments.out;
    std::fs::create_dir_all(folder).map_err(|error| anyhow::anyhow!("{}: {error}", folder.display()))?;
    let mut results = Results::default();
    let mut paths = Vec::new();
    for file in files {
        let path = folder.join(file.path());
        let same = |mut there: BufReader<_>| {
            let mut bytes = Vec::new();
            there.read_to_end(&mut bytes).is_ok_and(|_| bytes == file.contents())
        };
        // A schema is the program's own, and of another version perhaps.
        let is_schema = file.path().extension().is_some_and(|extension| extension == "json");
        claim_file(&path, &[], arguments.replace.overwrite || is_schema, same)?;
        results.add(&path, |to| to.write_all(file.contents()))?;
        paths.push(path);
    }
    results.commit()?;
    Ok(paths)
}

/// The scenes and studies, by name.
fn scenes() -> impl Iterator<Item = &'static File<'static>> {
    SCENES.files().filter(|file| file.path().extension().is_some_and(|extension| extension == "toml"))
}

fn names() -> Vec<String> {
    scenes().map(stem).collect()
}

fn stem(file: &File<'_>) -> String {
    file.path().file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

fn text(file: &'static File<'static>) -> &'static str {
    file.contents_utf8().unwrap_or_default()
}

/// The title of a scene or study.
fn title(file: &'static File<'static>) -> String {
    let table: toml::Table = text(file).parse().unwrap_or_default();
    table.get("title").and_then(toml::Value::as_str).unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use sprag_report::streams::BAD_INPUT;

    use super::*;

    fn example(name: &str, folder: &Path) -> (i32, String) {
        let (code, _, err) = crate::line::run(&["example", name, "--out", folder.to_str().unwrap()]);
        (code, err)
    }

    #[test]
    fn every_example_has_a_title_and_is_written_with_what_it_needs() {
        for name in names() {
            let folder = tempfile::tempdir().unwrap();
            assert_eq!(example(&name, folder.path()), (0, String::new()));
            let scene = scenes().find(|file| stem(file) == name).unwrap();
            assert!(!title(scene).is_empty(), "{name}");
            let needs_record = text(scene).contains("near_fault.csv\"");
            assert_eq!(folder.path().join("near_fault.csv").exists(), needs_record, "{name}");
            let schema = text(scene).lines().next().and_then(|line| line.strip_prefix("#:schema "));
            assert!(folder.path().join(schema.unwrap()).exists(), "{name}");
        }
    }

    #[test]
    fn what_the_user_has_changed_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("statue.toml");
        std::fs::write(&path, "mine").unwrap();
        let (code, message) = example("statue", folder.path());
        assert!(code == BAD_INPUT && message.contains("--overwrite"), "{message}");
        assert_eq!(std::fs::read_to_string(path).unwrap(), "mine");
        let (code, message) = example("status", folder.path());
        assert!(code == BAD_INPUT && message.contains("statue"), "{message}");
    }
}
