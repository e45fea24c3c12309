//! `sprag manual`: pages for `man`.

use std::path::PathBuf;

use clap::Args;

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
        let folder = &self.folder;
        let written = std::fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(crate::line::definition(), folder));
        written.map_err(|error| anyhow::anyhow!("{}: {error}", folder.display()))?;
        context.print(format_args!("pages in {}\n", folder.display()));
        Ok(Completion::Complete)
    }
}
