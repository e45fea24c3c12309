//! The unmodified image of the board, run on the host by the bench in `tests/board-image`: its tests, and what a tick costs.

use crate::{
    firmware::{BOARD, Built},
    process::{cargo_in, run as done},
    stop::Stop,
    tools,
};
use std::path::Path;

/// The folder of the bench's workspace, from the root.
pub const WORKSPACE: &str = "tests/board-image";

/// Lints the bench and runs its tests with the images that were built.
///
/// # Errors
/// If Unicorn is missing, or at the first that fails.
pub fn tests(root: &Path, built: &Built) -> Result<(), Stop> {
    tools::need_unicorn()?;
    done(&mut cargo_in(root, WORKSPACE, &["fmt", "--check"]))?;
    done(&mut cargo_in(root, WORKSPACE, &["clippy", "--all-targets", "--", "-D", "warnings"]))?;
    done(cargo_in(root, WORKSPACE, &["test"]).envs(built.variables()))
}

/// Prints what a control tick costs (`ticks`), or what of the program it goes to (`profile`).
///
/// # Errors
/// If a build or the run fails.
pub fn measure(root: &Path, what: &str) -> Result<(), Stop> {
    tools::need_unicorn()?;
    let elf = BOARD.build(root)?;
    done(cargo_in(root, WORKSPACE, &["run", "--quiet", "--", what]).arg(elf))
}
