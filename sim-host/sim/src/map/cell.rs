//! What becomes of the blocks of a map, many at once.

use std::fmt::Display;

use sprag_ensemble::machine::{Registers, run};
use sprag_ensemble::pulsed::{PulseResult, PulsedBlock};

use super::grid::{Grid, Subject, Values};
use crate::interrupt::Interrupt;
use crate::scene::ground::GroundError;
use crate::scene::{Scene, SceneError};
use crate::simulation::{DeviceRun, RunError, simulate_for_study};
use crate::under_records::{self, followed};

/// Reasons why a block of a map could not be followed.
#[derive(Debug, thiserror::Error)]
pub enum CellError {
    /// The scene, or that of a cell.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// The ground motion of a cell.
    #[error("{0}")]
    Ground(#[from] GroundError),
    /// A scene that cannot be simulated.
    #[error("{place}: {error}")]
    Run {
        /// Values of the axes.
        place: String,
        /// Error of the run.
        error: RunError,
    },
    /// A block that cannot be followed.
    #[error("{device}, {place}: {error}")]
    Block {
        /// Device.
        device: String,
        /// Values of the axes.
        place: String,
        /// Error of the case.
        error: String,
    },
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
}

/// What becomes of the block with device `device` at `places`: of those that are blocks under a pulse or a record side by side, of the others
/// one by one.
///
/// # Errors
/// [`CellError`] names the place.
pub fn results_at(grid: &Grid, device: usize, places: &[Values], interrupt: &Interrupt) -> Result<Vec<PulseResult>, CellError> {
    results_by(grid, device, places, interrupt, |pulsed| run(pulsed, Registers::Widest))
}

/// [`results_at`] with `pulses` to follow the blocks under pulses, wherever it does; its error has the number of the block.
///
/// # Errors
/// [`CellError`] names the place.
pub fn results_by<E: Display>(
    grid: &Grid,
    device: usize,
    places: &[Values],
    interrupt: &Interrupt,
    pulses: impl FnOnce(&[PulsedBlock]) -> Result<Vec<PulseResult>, (usize, E)>,
) -> Result<Vec<PulseResult>, CellError> {
    let mut results = vec![PulseResult::NO_ROCKING; places.len()];
    let (mut pulsed, mut pulsed_places) = (Vec::with_capacity(places.len()), Vec::with_capacity(places.len()));
    let (mut subjects, mut subject_places) = (Vec::new(), Vec::new());
    for (index, &values) in places.iter().enumerate() {
        match grid.subject(device, values)? {
            Subject::Pulsed(block) => {
                pulsed.push(block);
                pulsed_places.push(index);
            }
            Subject::Scene(scene) => {
                subjects.push(under_records::Subject::new(scene.only(device)));
                subject_places.push(index);
            }
        }
    }
    let name = &grid.scene.devices[device].name;
    let found = pulses(&pulsed).map_err(|(index, error)| {
        let place = grid.place(places[pulsed_places[index]]);
        CellError::Block { device: name.clone(), place, error: error.to_string() }
    })?;
    for (result, index) in found.into_iter().zip(pulsed_places) {
        results[index] = result;
    }
    let runs = subjects.iter().filter_map(|subject| Some((subject, grid.shaking(&subject.scene)?)));
    let mut shaken = followed(&runs.collect::<Vec<_>>()).into_iter();
    for (subject, index) in subjects.iter().zip(subject_places) {
        results[index] = match shaken.next().flatten() {
            Some(found) => PulseResult::of_shaken(&found, &subject.scene.block),
            None => simulated(&subject.scene, || grid.place(places[index]), interrupt)?,
        };
    }
    Ok(results)
}

/// A block simulated as the scene that it is, which has one device; `place` says where it is on the map.
fn simulated(scene: &Scene, place: impl Fn() -> String, interrupt: &Interrupt) -> Result<PulseResult, CellError> {
    let ground = scene.ground_motions()?;
    let runs = simulate_for_study(scene, &ground, interrupt).map_err(|error| match error {
        RunError::Interrupted => CellError::Interrupted,
        error => CellError::Run { place: place(), error },
    })?;
    let found = |peak: Option<f64>| peak.unwrap_or(f64::NAN);
    let result = |run: &DeviceRun| PulseResult {
        outcome: run.outcome,
        peak_rotation: found(run.peak_rotation),
        peak_acceleration: found(run.peak_acceleration),
    };
    Ok(runs.first().map_or(PulseResult::NO_ROCKING, result))
}
