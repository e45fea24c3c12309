//! The hardware pages, checked: the coil driver in the circuit simulator, the schematic by its electrical rules.

mod coil;
#[cfg(test)]
mod failures;
#[cfg(test)]
mod fits_firmware;
mod schematic;

use crate::{steps::Steps, stop::Stop, tools};
use std::path::Path;

/// Folder of the coil driver's circuits.
const COIL: &str = "docs/hardware/coil";

/// Simulates the coil driver and checks the schematic.
///
/// # Errors
/// At the first check that fails, or if a tool is missing.
pub fn run(root: &Path, steps: &mut Steps) -> Result<(), Stop> {
    tools::need_circuit_simulator()?;
    steps.step("coil driver", || coil::check(&root.join(COIL)))?;
    steps.step("schematic", || schematic::check(root))
}
