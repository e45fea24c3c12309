//! The hardware pages, checked: the coil driver in the circuit simulator, the schematic by its electrical rules.

mod coil;
#[cfg(test)]
mod failures;
#[cfg(test)]
mod fits_firmware;
mod schematic;

use crate::{passed::Passed, steps::Steps, stop::Stop, tools};
use std::path::Path;

/// Folder of the coil driver's circuits.
const COIL: &str = "docs/hardware/coil";

/// The tests of the coil driver that need ngspice.
pub const COIL_TESTS: Passed = Passed { sources: &[COIL, "xtask/src/hardware/coil.rs"], file: "xtask/src/hardware/coil.passed" };

/// The checks of the schematic.
const SCHEMATIC_CHECKS: Passed =
    Passed { sources: &[schematic::FOLDER, "xtask/src/hardware/schematic.rs"], file: "xtask/src/hardware/schematic.passed" };

/// Simulates the coil driver and checks the schematic.
///
/// # Errors
/// At the first check that fails, or if a tool is missing.
pub fn run(root: &Path, steps: &mut Steps) -> Result<(), Stop> {
    tools::need_circuit_simulator()?;
    steps.step("coil driver", || coil::check(&root.join(COIL)))?;
    schematic(root, steps, true)
}

/// Checks the schematic, unless it has passed as it is and not `all` shall run.
///
/// # Errors
/// If the check fails, or a tool is missing.
pub fn schematic(root: &Path, steps: &mut Steps, all: bool) -> Result<(), Stop> {
    steps.step("schematic", || SCHEMATIC_CHECKS.or(root, all, || schematic::check(root)))
}
