//! Runs a map: every cell with every device.

use std::ops::Range;
use std::time::Instant;

use sprag_ensemble::pulsed::PulseResult;
use sprag_report::long_run::error::LongRunError;
use sprag_report::long_run::in_order::in_order;
use sprag_report::long_run::rows::Rows;
use sprag_report::progress::Progress;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::map::cell::{CellError, results_at};
use sprag_sim::map::grid::{Grid, Values};

use super::table::Labels;
use super::tally::{DeviceMap, Tally};

/// Reasons why a map could not be made.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// A cell.
    #[error("{0}")]
    Cell(#[from] CellError),
    /// Rows that cannot be kept, or resumed.
    #[error("{0}")]
    Rows(#[from] LongRunError),
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
    if whole { Ok(tally.maps) } else { Err(CellError::Interrupted.into()) }
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
    if whole { Ok(()) } else { Err(CellError::Interrupted.into()) }
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
    for device in 0..grid.mapped().len() {
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
                Err(CellError::Interrupted) => return Ok(None),
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
