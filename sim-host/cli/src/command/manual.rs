//! `sprag manual`: pages for `man`.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;

use super::BAD_INPUT;

/// Write pages for `man`, one for each command.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example:\n  sprag manual ~/.local/share/man/man1")]
pub struct ManualArguments {
    /// Folder for the pages; it is made where it is missing, and pages that are there are replaced.
    #[arg(value_name = "DIR", value_hint = clap::ValueHint::DirPath)]
    pub folder: PathBuf,
}

/// Runs the command and gives its exit code.
pub fn run(arguments: &ManualArguments, out: &mut impl Write, err: &mut impl Write) -> i32 {
    let folder = &arguments.folder;
    let written = std::fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(crate::line::definition(), folder));
    match written {
        Ok(()) => {
            let _ = writeln!(out, "pages in {}", folder.display());
            0
        }
        Err(error) => {
            let _ = writeln!(err, "sprag: {}: {error}", folder.display());
            BAD_INPUT
        }
    }
}
