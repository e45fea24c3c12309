//! What a block with one device does under one motion.

use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::Block;
use sprag_sim::accuracy::ErrorEstimate;
use sprag_sim::side_by_side::{DeviceDemand, Followed};
use sprag_sim::simulation::DeviceRun;

/// A response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Outcome of the run.
    pub outcome: Outcome,
    /// max |θ|/α; `None` when overturned.
    pub peak_rotation: Option<f64>,
    /// max |F|/(mg) of the device on its support, until the end of the run or overturning; 0 where its clutches never bear any.
    pub force_ratio: f64,
    /// Farthest travel of the terminals to one side until then, m.
    pub stroke_m: f64,
    /// Largest bending stress of gear teeth until then, MPa; `None` where the scene has no gear.
    pub tooth_stress_mpa: Option<f64>,
    /// Energy of the coils until then, J; `None` where the scene has no coil, or the device no clutch that one holds.
    pub coil_energy_j: Option<f64>,
    /// How accurate that is, where it was asked for.
    pub error: Option<ErrorEstimate>,
}

impl Response {
    /// Response of a run with checks.
    pub fn of(run: &DeviceRun) -> Response {
        let checks = run.checks.as_ref();
        Response {
            outcome: run.outcome,
            peak_rotation: run.peak_rotation,
            force_ratio: run.peak_force_ratio.unwrap_or(0.0),
            stroke_m: checks.and_then(|checks| checks.stroke_with_fall_m).unwrap_or(0.0),
            tooth_stress_mpa: checks.and_then(|checks| checks.tooth_stress_with_fall_mpa),
            coil_energy_j: checks.and_then(|checks| checks.coil_energy_with_fall_j),
            error: run.error.map(|report| report.estimate),
        }
    }

    /// Response of `block` that lanes have followed and watched.
    pub fn of_followed(followed: &Followed, block: &Block) -> Option<Response> {
        let DeviceDemand { force_ratio, stroke_m, tooth_stress_mpa, coil_energy_j } = followed.demand?;
        Some(Response {
            outcome: followed.motion.outcome(),
            peak_rotation: followed.motion.relative_peaks(block).map(|(rotation, _)| rotation),
            force_ratio,
            stroke_m,
            tooth_stress_mpa,
            coil_energy_j,
            error: None,
        })
    }
}
