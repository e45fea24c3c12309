//! Runs a map: every cell with every device.

use std::time::Instant;

use rayon::prelude::*;
use serde::Serialize;

use super::grid::Grid;
use crate::batch::case::CaseError;
use crate::ensemble::machine::{Registers, run};
use crate::ensemble::pulses::{PulseResult, PulsedBlock};
use crate::interrupt::Interrupt;
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::scene::SceneError;
use crate::scene::ground::GroundError;
use crate::simulation::{RunError, simulate};

/// Cells that one task works on before it looks up.
const CHUNK: usize = 2048;

/// Why a map could not be made.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// The scene, or that of a cell.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// The ground motion of a cell.
    #[error("{0}")]
    Ground(#[from] GroundError),
    /// A cell that cannot be simulated.
    #[error("cell {column} across, {row} up: {error}")]
    Run {
        /// From the left, from 1.
        column: usize,
        /// From below, from 1.
        row: usize,
        /// Why.
        error: RunError,
    },
    /// A block that cannot be followed.
    #[error("{device}, cell {column} across, {row} up: {error}")]
    Cell {
        /// Device.
        device: String,
        /// From the left, from 1.
        column: usize,
        /// From below, from 1.
        row: usize,
        /// Why.
        error: CaseError,
    },
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
}

/// How many cells have each outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Counts {
    /// The block never uplifts.
    pub no_rocking: usize,
    /// It rocks and stays up.
    pub safe: usize,
    /// It overturns before any impact.
    pub overturned_without_impact: usize,
    /// It overturns after one impact or more.
    pub overturned_after_impact: usize,
}

impl Counts {
    /// Of `results`.
    pub fn of(results: &[PulseResult]) -> Counts {
        let mut counts = Counts::default();
        for result in results {
            *match result.outcome {
                Outcome::NoRocking => &mut counts.no_rocking,
                Outcome::Safe => &mut counts.safe,
                Outcome::OverturnedWithoutImpact => &mut counts.overturned_without_impact,
                Outcome::OverturnedAfterImpact => &mut counts.overturned_after_impact,
            } += 1;
        }
        counts
    }

    /// That overturn.
    pub fn overturned(&self) -> usize {
        self.overturned_without_impact + self.overturned_after_impact
    }
}

/// The map of one device.
#[derive(Clone, Debug)]
pub struct DeviceMap {
    /// Its name.
    pub device: String,
    /// Cells row by row from the lowest, each from the left.
    pub results: Vec<PulseResult>,
    /// Time that it took, s.
    pub seconds: f64,
}

/// Runs `grid` with every device, on rayon's threads; results do not depend on how many there are.
///
/// # Errors
/// [`MapError`] names the cell.
pub fn study(grid: &Grid, progress: &Progress, interrupt: &Interrupt) -> Result<Vec<DeviceMap>, MapError> {
    let cells = grid.columns() * grid.rows();
    progress.begin((cells * grid.scene.devices.len()) as u64);
    let map = |device: usize| {
        let start = Instant::now();
        let chunks = (0..cells).into_par_iter().step_by(CHUNK).map(|first| {
            if interrupt.is_set() {
                return Err(MapError::Interrupted);
            }
            let part = chunk(grid, device, first..cells.min(first + CHUNK), interrupt);
            progress.advance(CHUNK.min(cells - first) as u64);
            part
        });
        let results: Vec<Vec<PulseResult>> = chunks.collect::<Result<_, _>>()?;
        let name = grid.scene.devices[device].name.clone();
        Ok(DeviceMap { device: name, results: results.concat(), seconds: start.elapsed().as_secs_f64() })
    };
    (0..grid.scene.devices.len()).map(map).collect()
}

/// Neighbouring cells: those that are blocks under a pulse side by side, the others one by one.
fn chunk(grid: &Grid, device: usize, cells: std::ops::Range<usize>, interrupt: &Interrupt) -> Result<Vec<PulseResult>, MapError> {
    let place = |cell: usize| (cell % grid.columns(), cell / grid.columns());
    let mut results = vec![PulseResult::NO_ROCKING; cells.len()];
    let mut pulsed: Vec<PulsedBlock> = Vec::with_capacity(cells.len());
    let mut their_cells = Vec::with_capacity(cells.len());
    for cell in cells.clone() {
        let (column, row) = place(cell);
        match grid.pulsed(device, column, row)? {
            Some(block) => {
                pulsed.push(block);
                their_cells.push(cell);
            }
            None => results[cell - cells.start] = simulated(grid, device, (column, row), interrupt)?,
        }
    }
    let found = run(&pulsed, Registers::Widest).map_err(|(index, error)| {
        let (column, row) = place(their_cells[index]);
        MapError::Cell { device: grid.scene.devices[device].name.clone(), column: column + 1, row: row + 1, error }
    })?;
    for (result, cell) in found.into_iter().zip(their_cells) {
        results[cell - cells.start] = result;
    }
    Ok(results)
}

/// A cell simulated as the scene that it is.
fn simulated(grid: &Grid, device: usize, cell: (usize, usize), interrupt: &Interrupt) -> Result<PulseResult, MapError> {
    let (column, row) = cell;
    let scene = grid.scene_of(column, row)?.only(device);
    let ground = scene.ground_motions()?;
    let runs = simulate(&scene, &ground, interrupt).map_err(|error| match error {
        RunError::Interrupted => MapError::Interrupted,
        error => MapError::Run { column: column + 1, row: row + 1, error },
    })?;
    let found = |peak: Option<f64>| peak.unwrap_or(f64::NAN);
    let result = |run: &crate::simulation::DeviceRun| PulseResult {
        outcome: run.outcome,
        peak_rotation: found(run.peak_rotation),
        peak_acceleration: found(run.peak_acceleration),
    };
    Ok(runs.first().map_or(PulseResult::NO_ROCKING, result))
}
