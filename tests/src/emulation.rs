//! The firmware in the emulator.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The core with its own checks, if everything that the emulation needs is there; otherwise says what is not.
pub fn firmware() -> Option<PathBuf> {
    image("SPRAG_EMULATED_CORE_ELF")
}

/// The controller's firmware, likewise.
pub fn controller_firmware() -> Option<PathBuf> {
    image("SPRAG_FIRMWARE_ELF")
}

fn image(variable: &str) -> Option<PathBuf> {
    let Some(elf) = std::env::var_os(variable) else {
        eprintln!("SKIPPED: {variable} is not set; `cargo xtask test` builds the firmware and sets it");
        return None;
    };
    if Command::new("qemu-system-arm").arg("--version").stdout(Stdio::null()).status().is_err() {
        eprintln!("SKIPPED: qemu-system-arm is not installed");
        return None;
    }
    Some(elf.into())
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
