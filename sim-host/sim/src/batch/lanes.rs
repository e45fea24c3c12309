//! Many cases at once: in lanes where they fit, and by the core for the rest.

use sprag_ensemble::alone::CaseError;
use sprag_ensemble::machine::{Registers, run_timed};
use sprag_ensemble::pulsed::{PulseResult, PulsedBlock};
use sprag_ensemble::times::PulseTimes;
use sprag_loops::{Method, Precision};
use sprag_shared::structure::REST_SPEED;
use sprag_shared::structure::block::Geometry;

use super::case::{Case, CaseResult, TIGHT};

/// Results of `cases` in any order, one each: to rounding in the lanes, and by the power series with this `tolerance` where the lanes
/// cannot tell, all of them for one below [`TIGHT`]. No result depends on the other cases.
///
/// Neighbours that share slenderness, mass ratio and restitution are quicker.
pub fn results(cases: &[Case], tolerance: f64) -> Vec<Result<CaseResult, CaseError>> {
    let method = f64::ideal(Method::Adaptive(tolerance));
    let found = if tolerance < TIGHT { vec![None; cases.len()] } else { in_lanes(cases) };
    cases.iter().zip(found).map(|(case, found)| found.map_or_else(|| case.run(&*method), Ok)).collect()
}

/// Results of `cases` to rounding; `None` for those that the core is to follow.
///
/// Those are what the lanes do not take (parameters at the ends of their ranges), motions that come so near the tip, the uplift threshold
/// or the end of their free time that rounding decides, and free times that end before the largest rotation.
pub fn in_lanes(cases: &[Case]) -> Vec<Option<CaseResult>> {
    // Blocks of one kind go together, and those of one slenderness, coupling and restitution share their series.
    let mut order: Vec<usize> = (0..cases.len()).filter(|&index| cases[index].rest_speed == REST_SPEED).collect();
    let kind = |case: &Case| (case.geometry == Geometry::Full, case.device as u8);
    order.sort_by(|&a, &b| {
        let (a, b) = (&cases[a], &cases[b]);
        kind(a)
            .cmp(&kind(b))
            .then(a.slenderness.total_cmp(&b.slenderness))
            .then(a.mass_ratio.total_cmp(&b.mass_ratio))
            .then(a.restitution.total_cmp(&b.restitution))
    });
    let pulsed: Vec<PulsedBlock> = order.iter().map(|&index| PulsedBlock::from(&cases[index])).collect();
    let free_times: Vec<f64> = order.iter().map(|&index| cases[index].free_time).collect();
    let mut results = vec![None; cases.len()];
    for (index, found) in order.into_iter().zip(run_timed(&pulsed, &free_times, Registers::Widest)) {
        results[index] = found.map(CaseResult::from);
    }
    results
}

impl From<(PulseResult, PulseTimes)> for CaseResult {
    fn from((result, times): (PulseResult, PulseTimes)) -> CaseResult {
        CaseResult {
            outcome: result.outcome,
            peak_rotation: result.peak_rotation,
            peak_acceleration: result.peak_acceleration,
            impacts: times.impacts,
            first_impact_time: times.first_impact,
            end_time: times.end,
        }
    }
}
