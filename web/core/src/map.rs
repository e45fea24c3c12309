//! Overturning maps, cell by cell, and their boundaries.

use sprag_ensemble::pulsed::{PulseResult, PulsedBlock};
use sprag_ensemble::rows::RESULT;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::map::boundaries::refine;
use sprag_sim::map::cell::{CellError, results_by};
use sprag_sim::map::grid::{Grid, Values};

use crate::columns::{Column, Columns};
use crate::scene::PageError;

/// Blocks beside those of the grid that the boundaries of one device may take: some seconds.
const EVALUATIONS: usize = 200_000;

/// Whoever follows blocks under pulses, given and returned as rows of [`sprag_ensemble::rows`].
pub type Lanes<'a> = &'a dyn Fn(&[f64]) -> Result<Vec<f64>, String>;

/// What becomes of a device at `places`.
fn results(grid: &Grid, device: usize, places: &[Values], lanes: Lanes<'_>) -> Result<Vec<PulseResult>, CellError> {
    results_by(grid, device, places, &Interrupt::default(), |pulsed: &[PulsedBlock]| {
        let rows: Vec<f64> = pulsed.iter().flat_map(PulsedBlock::row).collect();
        let found = if rows.is_empty() { Vec::new() } else { lanes(&rows).map_err(|error| (0, error))? };
        let results: Option<Vec<PulseResult>> = found.as_chunks::<RESULT>().0.iter().map(PulseResult::of_row).collect();
        results.filter(|results| results.len() == pulsed.len()).ok_or_else(|| (0, "the lanes gave no results".to_owned()))
    })
}

/// Axes and devices of a map; the y of a cut is one value, NaN.
pub fn about(grid: &Grid) -> Columns {
    let y = grid.map.y.as_ref();
    let mut about = vec![
        ("devices", Column::Texts(grid.mapped().iter().map(|mapped| mapped.name.clone()).collect())),
        ("x", Column::Numbers((0..grid.columns()).map(|cell| grid.map.x.value(cell)).collect())),
        ("y", Column::Numbers(y.map_or(vec![f64::NAN], |y| (0..y.cells).map(|cell| y.value(cell)).collect()))),
        ("xKey", Column::Text(grid.map.x.key.clone())),
    ];
    about.extend(y.map(|y| ("yKey", Column::Text(y.key.clone()))));
    about
}

/// What becomes of a device in `cells`, by their numbers: row · columns + column.
///
/// # Errors
/// [`PageError`] names the cell that cannot be followed, and a device or a cell that the map does not have.
pub fn cells(grid: &Grid, device: usize, cells: &[u32], lanes: Lanes<'_>) -> Result<Columns, PageError> {
    device_of(grid, device)?;
    let all = grid.columns() * grid.rows();
    if let Some(cell) = cells.iter().find(|&&cell| cell as usize >= all) {
        return Err(PageError::Unknown(cell.to_string(), format!("the map's {all} cells")));
    }
    let places: Vec<Values> =
        cells.iter().map(|&cell| grid.values(cell as usize % grid.columns(), cell as usize / grid.columns())).collect();
    let results = results(grid, device, &places, lanes).map_err(PageError::failed)?;
    Ok(vec![
        ("outcome", Column::Codes(results.iter().map(|result| result.outcome as u8).collect())),
        ("peakRotation", Column::Numbers(results.iter().map(|result| result.peak_rotation).collect())),
        ("peakAcceleration", Column::Numbers(results.iter().map(|result| result.peak_acceleration).collect())),
    ])
}

/// Where the outcomes of a whole map of a device change.
///
/// # Errors
/// [`PageError`] for codes of outcomes that are not those of all cells, and what [`cells`] refuses.
pub fn boundaries(grid: &Grid, device: usize, outcome: &[u8], lanes: Lanes<'_>) -> Result<Columns, PageError> {
    device_of(grid, device)?;
    let outcomes: Vec<Outcome> = outcome.iter().filter_map(|&code| Outcome::ALL.get(usize::from(code)).copied()).collect();
    if outcomes.len() != grid.columns() * grid.rows() {
        return Err(PageError::Failed(format!("outcomes of {} cells are not those of the whole map", outcomes.len())));
    }
    let evaluate = |places: &[Values]| {
        let results = results(grid, device, places, lanes)?;
        Ok(results.iter().map(|result| result.outcome).collect())
    };
    let found = refine(grid, device, &outcomes, EVALUATIONS, &evaluate).map_err(PageError::failed)?;
    let each = found.boundaries.iter().map(|boundary| {
        let vertices = boundary.vertices.iter().flat_map(|&(x, y)| [x, y.unwrap_or(f64::NAN)]);
        vec![
            ("left", Column::Codes(vec![boundary.left as u8])),
            ("right", Column::Codes(vec![boundary.right as u8])),
            ("vertices", Column::Numbers(vertices.collect())),
        ]
    });
    Ok(vec![("boundaries", Column::Each(each.collect()))])
}

fn device_of(grid: &Grid, device: usize) -> Result<(), PageError> {
    let all = grid.mapped().len();
    if device < all { Ok(()) } else { Err(PageError::Unknown(device.to_string(), format!("the scene's {all} devices"))) }
}
