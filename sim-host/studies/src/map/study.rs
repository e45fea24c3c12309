//! Runs a map: every cell with every device.

use std::ops::Range;
use std::time::Instant;

use sprag_ensemble::machine::{Registers, run, shake};
use sprag_ensemble::pulsed::PulseResult;
use sprag_ensemble::shaken::Shaken;
use sprag_report::long_run::error::LongRunError;
use sprag_report::long_run::in_order::in_order;
use sprag_report::long_run::rows::Rows;
use sprag_report::progress::Progress;
use sprag_sim::batch::case::CaseError;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::ground::GroundError;
use sprag_sim::scene::{Scene, SceneError};
use sprag_sim::simulation::{DeviceRun, RunError, simulate_for_study};

use super::grid::{Grid, Subject, Values};
use super::table::Labels;
use super::tally::{DeviceMap, Tally};

/// Reasons why a map could not be made.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
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
        error: CaseError,
    },
    /// Rows that cannot be kept, or resumed.
    #[error("{0}")]
    Rows(#[from] LongRunError),
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
}

/// A part of a device's cells, worked out.
struct Part {
    rows: Range<usize>,
    results: Vec<PulseResult>,
    text: Vec<u8>,
}

/// Runs `grid` with every device, on rayon's threads; results do not depend on how many there are.
///
/// # Errors
/// [`MapError`] names the cell.
pub fn study(grid: &Grid, progress: &Progress, interrupt: &Interrupt) -> Result<Vec<DeviceMap>, MapError> {
    let mut tally = Tally::new(grid);
    progress.begin(grid.table_rows() as u64);
    let whole = run_rows(grid, 0..grid.table_rows(), None, &mut tally, progress, interrupt, |_| Ok(()))?;
    if whole { Ok(tally.maps) } else { Err(MapError::Interrupted) }
}

/// Runs `grid` with every device, and gives each row of the map's table to `each`, in order, with its number.
///
/// # Errors
/// [`MapError`] names the cell.
pub fn study_rows(grid: &Grid, interrupt: &Interrupt, mut each: impl FnMut(usize, PulseResult)) -> Result<(), MapError> {
    let progress = Progress::new("cells");
    let rows = 0..grid.table_rows();
    progress.begin(rows.len() as u64);
    let whole = run_rows(grid, rows, None, &mut Tally::new(grid), &progress, interrupt, |part| {
        part.rows.clone().zip(&part.results).for_each(|(row, result)| each(row, *result));
        Ok(())
    })?;
    if whole { Ok(()) } else { Err(MapError::Interrupted) }
}

/// Works out what is left of `rows`, adds it there and to `tally`; `false` when it was interrupted.
///
/// # Errors
/// [`MapError`] names the place.
pub fn study_to(
    rows: &mut Rows,
    grid: &Grid,
    labels: &Labels,
    tally: &mut Tally,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<bool, MapError> {
    let left = rows.left();
    progress.begin((rows.done() + left.len()) as u64);
    progress.resume(rows.done() as u64);
    run_rows(grid, left, Some(labels), tally, progress, interrupt, |part| Ok(rows.append(&part.text, part.rows.len())?))
}

/// Rows of the map's table, device by device.
fn run_rows(
    grid: &Grid,
    rows: Range<usize>,
    labels: Option<&Labels>,
    tally: &mut Tally,
    progress: &Progress,
    interrupt: &Interrupt,
    mut keep: impl FnMut(&Part) -> Result<(), MapError>,
) -> Result<bool, MapError> {
    let cells = grid.columns() * grid.rows();
    for device in 0..grid.scene.devices.len() {
        let first = device * cells;
        let own = rows.start.max(first)..rows.end.min(first + cells);
        if own.is_empty() {
            continue;
        }
        let start = Instant::now();
        let work = |rows: Range<usize>| -> Result<Option<Part>, MapError> {
            if interrupt.is_set() {
                return Ok(None);
            }
            let cells = rows.start - first..rows.end - first;
            let places: Vec<Values> = cells.map(|cell| grid.values(cell % grid.columns(), cell / grid.columns())).collect();
            let results = match results_at(grid, device, &places, interrupt) {
                Err(MapError::Interrupted) => return Ok(None),
                results => results?,
            };
            let mut text = Vec::new();
            if let Some(labels) = labels {
                rows.clone().zip(&results).for_each(|(row, result)| labels.write(row, result, &mut text));
            }
            progress.advance(rows.len() as u64);
            Ok(Some(Part { rows, results, text }))
        };
        let length = own.len();
        let whole = in_order(own, grid.task(device), work, |part: Part| {
            keep(&part)?;
            part.rows.clone().zip(&part.results).for_each(|(row, result)| tally.add(row, *result));
            Ok(())
        })?;
        tally.time(device, length, start.elapsed().as_secs_f64());
        if !whole {
            return Ok(false);
        }
    }
    Ok(true)
}

/// What becomes of the block with device `device` at `places`: of those that are blocks under a pulse or a record side by side, of the others
/// one by one.
///
/// # Errors
/// [`MapError`] names the place.
pub fn results_at(grid: &Grid, device: usize, places: &[Values], interrupt: &Interrupt) -> Result<Vec<PulseResult>, MapError> {
    let mut results = vec![PulseResult::NO_ROCKING; places.len()];
    let (mut pulsed, mut pulsed_places) = (Vec::with_capacity(places.len()), Vec::with_capacity(places.len()));
    let (mut shaken, mut shaken_places) = (Vec::new(), Vec::new());
    for (index, &values) in places.iter().enumerate() {
        let scene = match grid.subject(device, values)? {
            Subject::Pulsed(block) => {
                pulsed.push(block);
                pulsed_places.push(index);
                continue;
            }
            Subject::Scene(scene) => scene,
        };
        match grid.shaken(&scene, device) {
            Some(block) => {
                shaken.push(block);
                shaken_places.push((index, scene));
            }
            None => results[index] = simulated(&scene.only(device), || grid.place(values), interrupt)?,
        }
    }
    let name = &grid.scene.devices[device].name;
    let found = run(&pulsed, Registers::Widest).map_err(|(index, error)| {
        let place = grid.place(places[pulsed_places[index]]);
        MapError::Block { device: name.clone(), place, error }
    })?;
    for (result, index) in found.into_iter().zip(pulsed_places) {
        results[index] = result;
    }
    for ((block, found), (index, scene)) in shaken.iter().zip(shake(&shaken, Registers::Widest)).zip(shaken_places) {
        let only = scene.only(device);
        let after =
            |found: Shaken| found.after(&block.plain, &only.structure(0), block.samples.duration(), only.free_time_s()).ok();
        results[index] = match found.and_then(after) {
            Some(found) => PulseResult::of_shaken(&found, &only.block),
            None => simulated(&only, || grid.place(places[index]), interrupt)?,
        };
    }
    Ok(results)
}

/// A block simulated as the scene that it is, which has one device; `place` says where it is on the map.
fn simulated(scene: &Scene, place: impl Fn() -> String, interrupt: &Interrupt) -> Result<PulseResult, MapError> {
    let ground = scene.ground_motions()?;
    let runs = simulate_for_study(scene, &ground, interrupt).map_err(|error| match error {
        RunError::Interrupted => MapError::Interrupted,
        error => MapError::Run { place: place(), error },
    })?;
    let found = |peak: Option<f64>| peak.unwrap_or(f64::NAN);
    let result = |run: &DeviceRun| PulseResult {
        outcome: run.outcome,
        peak_rotation: found(run.peak_rotation),
        peak_acceleration: found(run.peak_acceleration),
    };
    Ok(runs.first().map_or(PulseResult::NO_ROCKING, result))
}
