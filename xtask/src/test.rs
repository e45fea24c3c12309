//! Every check of the project, in the order in which they are cheapest to fail.

use crate::{
    firmware, fuzz,
    process::{cargo, run as done},
    size,
    steps::Steps,
    stop::Stop,
    tools,
};
use std::path::Path;

/// Runs every check; each fuzz target gets so many seconds.
///
/// # Errors
/// At the first check that fails.
pub fn run(root: &Path, fuzz_seconds: u32) -> Result<(), Stop> {
    let mut steps = Steps::default();
    steps.step("tools", || {
        tools::need_board_target(root)?;
        tools::need_emulator()?;
        tools::need_cxx()
    })?;
    steps.step("format", || done(&mut cargo(root, &["fmt", "--all", "--check"])))?;
    steps.step("lints, host", || done(&mut cargo(root, &["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"])))?;
    steps.step("lints, board", || {
        let args = ["clippy", "--package", firmware::PACKAGE, "--target", firmware::TARGET, "--", "-D", "warnings"];
        done(&mut cargo(root, &args))
    })?;
    steps.step("documentation", || done(cargo(root, &["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings")))?;
    let elf = steps.step("firmware build", || firmware::build(root))?;
    steps.step("firmware size", || size::check(root, &elf))?;
    // The emulator tests are among them and find the firmware through the variable.
    steps.step("tests, host and emulator", || done(cargo(root, &["test", "--workspace"]).env(firmware::ELF_VARIABLE, &elf)))?;
    steps.step("fuzzing", || fuzz::run(root, None, fuzz_seconds))
}
