//! The boundaries of a map, on all cores.

use rayon::prelude::*;
use sprag_report::progress::Progress;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::map::boundaries::{self, Boundaries};
use sprag_sim::map::cell::{CellError, results_at};
use sprag_sim::map::grid::{Grid, Values};

/// Blocks of a batch that one task takes, at most and at least.
const MOST_AT_ONCE: usize = 2048;
const LEAST_AT_ONCE: usize = 8;

/// Traces the boundaries of the map of `device` as [`boundaries::refine`] does, on rayon's threads; results do not depend on how many there
/// are.
///
/// # Errors
/// [`CellError`] names the place.
pub fn refine(
    grid: &Grid,
    device: usize,
    outcomes: &[Outcome],
    evaluations: usize,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Boundaries, CellError> {
    boundaries::refine(grid, device, outcomes, evaluations, &|places: &[Values]| {
        progress.begin(places.len() as u64);
        let share = places.len().div_ceil(4 * rayon::current_num_threads()).clamp(LEAST_AT_ONCE, MOST_AT_ONCE);
        let parts = places.par_chunks(share).map(|part| {
            if interrupt.is_set() {
                return Err(CellError::Interrupted);
            }
            let results = results_at(grid, device, part, interrupt)?;
            progress.advance(part.len() as u64);
            Ok(results.iter().map(|result| result.outcome).collect())
        });
        let parts: Vec<Vec<Outcome>> = parts.collect::<Result<_, _>>()?;
        Ok(parts.concat())
    })
}
