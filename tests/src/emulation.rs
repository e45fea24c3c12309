//! The firmware in the emulator.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The image of the core with its own checks.
///
/// # Panics
/// If it or the emulator is absent.
pub fn firmware() -> PathBuf {
    image("SPRAG_EMULATED_CORE_ELF")
}

/// The image of the controller's firmware, likewise.
///
/// # Panics
/// As [`firmware`].
pub fn controller_firmware() -> PathBuf {
    image("SPRAG_FIRMWARE_ELF")
}

/// The image of the board.
///
/// # Panics
/// If it is absent.
pub fn board_firmware() -> PathBuf {
    named("SPRAG_BOARD_ELF")
}

fn named(variable: &str) -> PathBuf {
    let elf = std::env::var_os(variable);
    elf.unwrap_or_else(|| panic!("{variable} names no image; `cargo xtask test` builds one and names it")).into()
}

fn image(variable: &str) -> PathBuf {
    let elf = named(variable);
    let emulator = Command::new("qemu-system-arm").arg("--version").stdout(Stdio::null()).status();
    assert!(emulator.is_ok(), "qemu-system-arm is not installed");
    elf
}

/// Runs the firmware in the emulator, in `folder` with a case file or none, and gives its lines.
pub fn emulate(elf: &Path, folder: &Path, case: Option<&str>) -> String {
    let semihosting = match case {
        Some(case) => format!("enable=on,target=native,arg=sprag,arg={case}"),
        None => "enable=on,target=native".to_owned(),
    };
    let mut command = Command::new("qemu-system-arm");
    command.args(["-machine", "netduinoplus2", "-nographic", "-icount", "shift=0"]);
    command.args(["-semihosting-config", &semihosting]).arg("-kernel").arg(elf);
    let output = command.current_dir(folder).stdin(Stdio::null()).output().unwrap();
    let (lines, errors) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{:?} {case:?}: {} {lines} {errors}", command, output.status);
    lines.into_owned()
}

/// The instructions of every kernel of the self check.
pub fn kernels(lines: &str) -> BTreeMap<&str, u32> {
    lines
        .lines()
        .filter_map(|line| line.strip_prefix("kernel ")?.split_once(' '))
        .map(|(name, count)| (name, count.split(' ').next().unwrap().parse().unwrap()))
        .collect()
}
