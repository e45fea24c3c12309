//! What `sprag map --refine` adds: the boundaries of every device, and what is said about them.

use std::time::Instant;

use indicatif::HumanCount;
use serde::Serialize;
use sprag_report::progress::Progress;
use sprag_report::text_table::{TextTable, number};
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::map::boundaries::Boundaries;
use sprag_sim::map::cell::CellError;
use sprag_sim::map::grid::Grid;
use sprag_studies::map::boundaries::refine;
use sprag_studies::map::tally::DeviceMap;

use super::report::Report;

/// The boundaries of a device in `summary.json`.
#[derive(Serialize)]
pub(super) struct BoundarySummary {
    boundaries: usize,
    vertices: usize,
    evaluations: usize,
    unresolved_squares: usize,
    unresolved_relative_width: f64,
    seconds: f64,
}

impl BoundarySummary {
    pub(super) fn of(boundaries: &Boundaries, seconds: f64) -> BoundarySummary {
        BoundarySummary {
            boundaries: boundaries.boundaries.len(),
            vertices: boundaries.vertices(),
            evaluations: boundaries.evaluations,
            unresolved_squares: boundaries.unresolved,
            unresolved_relative_width: boundaries.unresolved_width,
            seconds,
        }
    }
}

/// The boundaries of every device's map, all of whose cells are shown, with so many evaluations for each, and the time that each took, s.
pub(super) fn trace(
    grid: &Grid,
    maps: &[DeviceMap],
    evaluations: usize,
    interrupt: &Interrupt,
) -> Result<(Vec<Boundaries>, Vec<f64>), CellError> {
    let most = HumanCount((evaluations * maps.len()) as u64);
    let progress = Progress::of_unknown_length(&format!("blocks (at most {most}) on boundaries"));
    let of_device = |(device, map): (usize, &DeviceMap)| -> Result<(Boundaries, f64), CellError> {
        let outcomes: Vec<Outcome> = map.shown.iter().map(|result| result.outcome).collect();
        let start = Instant::now();
        let boundaries = refine(grid, device, &outcomes, evaluations, &progress, interrupt)?;
        Ok((boundaries, start.elapsed().as_secs_f64()))
    };
    let all: Result<Vec<_>, CellError> = maps.iter().enumerate().map(of_device).collect();
    progress.finish();
    Ok(all?.into_iter().unzip())
}

/// Prints a row a device, and what was left coarser.
pub(super) fn print_boundaries(report: &mut Report, all: &[Boundaries], seconds: &[f64]) {
    let mut table = TextTable::new(1, ["device", "boundaries", "vertices", "evaluations", "seconds"]);
    for (of_device, seconds) in all.iter().zip(seconds) {
        table.row(vec![
            of_device.device.clone(),
            of_device.boundaries.len().to_string(),
            of_device.vertices().to_string(),
            of_device.evaluations.to_string(),
            number(*seconds, 1),
        ]);
    }
    report.print(format_args!("\n{}", table.for_terminal()));
    for Boundaries { device, unresolved, unresolved_width, evaluations, .. } in all.iter().filter(|all| all.unresolved > 0) {
        report.print(format_args!(
            "{device}: {unresolved} squares on boundaries are left coarser, up to a relative {unresolved_width:.1e} wide, after \
             {evaluations} evaluations; --evaluations allows more",
        ));
    }
}
