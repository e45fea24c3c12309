//! What becomes of the blocks of a map, many at once.

use std::borrow::Cow;
use std::fmt::Display;

use sprag_ensemble::machine::{Registers, run};
use sprag_ensemble::pulsed::{PulseResult, PulsedBlock};

use super::grid::{Grid, Subject, Values};
#[cfg(feature = "effects")]
use crate::closed_loop::run::LoopError;
#[cfg(feature = "effects")]
use crate::closed_loop::{LoopFailure, LoopScene};
use crate::interrupt::Interrupt;
use crate::scene::controller::LawName;
use crate::scene::ground::GroundError;
use crate::scene::motions::GroundMotions;
use crate::scene::{Scene, SceneError};
use crate::side_by_side::{self, Shaking, followed};
use crate::simulation::{DeviceRun, RunError, simulate_for_study};

/// Reasons why a block of a map could not be followed.
#[derive(Debug, thiserror::Error)]
pub enum CellError {
    /// The scene of a cell.
    #[error("{place}: {error}")]
    Scene {
        /// Values of the axes.
        place: String,
        /// What is wrong.
        error: Box<SceneError>,
    },
    /// The ground motion of a cell.
    #[error("{place}: {error}")]
    Ground {
        /// Values of the axes.
        place: String,
        /// What is wrong.
        error: Box<GroundError>,
    },
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

/// What becomes of the block of map `device` at `places`: of those that are blocks under a pulse or a record side by side, of the others
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
    let of = &grid.mapped()[device];
    let mut results = vec![PulseResult::NO_ROCKING; places.len()];
    let (mut pulsed, mut pulsed_places) = (Vec::with_capacity(places.len()), Vec::with_capacity(places.len()));
    let mut shaken = Vec::new();
    for (index, &values) in places.iter().enumerate() {
        let place = || grid.place(values);
        match grid.subject(device, values).map_err(|error| CellError::Scene { place: place(), error: Box::new(error) })? {
            Subject::Pulsed(block) => {
                pulsed.push(block);
                pulsed_places.push(index);
            }
            Subject::Scene(scene) => {
                let scene = scene.only(of.device);
                let ground = if grid.shaking(&scene).is_none() { Some(ground_of(&scene, place)?) } else { None };
                shaken.push((side_by_side::Subject::new(scene), ground, index));
            }
            Subject::Loop(scene, law) => results[index] = looped(&scene, law, place, interrupt)?,
        }
    }
    let name = &of.name;
    let found = pulses(&pulsed).map_err(|(index, error)| {
        let place = grid.place(places[pulsed_places[index]]);
        CellError::Block { device: name.clone(), place, error: error.to_string() }
    })?;
    for (result, index) in found.into_iter().zip(pulsed_places) {
        results[index] = result;
    }
    let mut runs = Vec::with_capacity(shaken.len());
    for (subject, ground, _) in &shaken {
        let shaking = ground.as_ref().map(Shaking::Any).or_else(|| grid.shaking(&subject.scene));
        runs.extend(shaking.map(|shaking| (subject, shaking)));
    }
    for ((subject, ground, index), found) in shaken.iter().zip(followed(&runs)) {
        results[*index] = match found {
            Some(found) => PulseResult::of_shaken(&found.motion, &subject.scene.block),
            None => {
                let place = || grid.place(places[*index]);
                let ground = match ground {
                    Some(ground) => Cow::Borrowed(ground),
                    None => Cow::Owned(ground_of(&subject.scene, place)?),
                };
                simulated(&subject.scene, &ground, place, interrupt)?
            }
        };
    }
    Ok(results)
}

/// The ground motion of `scene`, at `place` on the map.
fn ground_of(scene: &Scene, place: impl Fn() -> String) -> Result<GroundMotions, CellError> {
    scene.ground_motions().map_err(|error| CellError::Ground { place: place(), error: Box::new(error) })
}

/// A block simulated as the scene that it is, which has one device; `place` says where it is on the map.
fn simulated(
    scene: &Scene,
    ground: &GroundMotions,
    place: impl Fn() -> String,
    interrupt: &Interrupt,
) -> Result<PulseResult, CellError> {
    let runs = simulate_for_study(scene, ground, interrupt).map_err(|error| match error {
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

/// A closed loop by `law` over a scene that has one device, as `sprag loop` closes it; nobody looks for the peak acceleration.
#[cfg(feature = "effects")]
fn looped(scene: &Scene, law: LawName, place: impl Fn() -> String, interrupt: &Interrupt) -> Result<PulseResult, CellError> {
    let mut desk = LoopScene::new(scene.clone()).map_err(|error| CellError::Ground { place: place(), error: Box::new(error) })?;
    desk.controller.law = law;
    let task = desk.task(0, desk.controller.sensors.seed(), interrupt);
    let (.., looped) = task.answered::<()>().map_err(|failure| match failure {
        LoopFailure::Loop(LoopError::Interrupted) => CellError::Interrupted,
        failure => CellError::Block {
            device: format!("{}, {}", scene.devices[0].name, law.name()),
            place: place(),
            error: failure.to_string(),
        },
    })?;
    let outcome = looped.outcome();
    let peak = looped.extremes.peaks.rotation / scene.block.slenderness();
    let peak_rotation = if outcome.overturned() { f64::NAN } else { peak };
    Ok(PulseResult { outcome, peak_rotation, peak_acceleration: f64::NAN })
}

/// Loops are effects, which this program does not have.
#[cfg(not(feature = "effects"))]
fn looped(scene: &Scene, _law: LawName, place: impl Fn() -> String, _interrupt: &Interrupt) -> Result<PulseResult, CellError> {
    Err(CellError::Run { place: place(), error: RunError::NoEffects { device: scene.devices[0].name.clone() } })
}
