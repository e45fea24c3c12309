//! Building the firmware for the board.

use crate::{
    process::{cargo, executables},
    stop::Stop,
};
use std::path::{Path, PathBuf};

/// The board's target.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// The firmware's package.
pub const PACKAGE: &str = "sprag-emulated-core";

/// How the emulator runs it, as in `.cargo/config.toml`; the firmware follows.
pub const EMULATOR: [&str; 8] = [
    "-machine",
    "netduinoplus2",
    "-nographic",
    "-semihosting-config",
    "enable=on,target=native",
    "-icount",
    "shift=0",
    "-kernel",
];

/// The environment variable through which the emulator tests find the firmware.
pub const ELF_VARIABLE: &str = "SPRAG_EMULATED_CORE_ELF";

/// Builds the firmware with optimisation and gives the path of its ELF file.
///
/// # Errors
/// If the build fails.
pub fn build(root: &Path) -> Result<PathBuf, Stop> {
    let args = ["build", "--release", "--package", PACKAGE, "--target", TARGET];
    let elf = executables(&mut cargo(root, &args))?
        .pop()
        .ok_or_else(|| Stop::failed("cargo built the firmware but named no executable"))?;
    println!("{}", elf.display());
    Ok(elf)
}
