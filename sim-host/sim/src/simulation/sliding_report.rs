//! What the base of a block did that may slide.

use serde::Serialize;

/// Whether a base slid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SlidingOutcome {
    /// It never slid.
    Sticks,
    /// It slid, flat or under a block that rocks.
    Slides,
}

/// `sliding` of a run in `summary.json`. Displacements are over the ground, positive as its acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SlidingReport {
    /// Whether the base slid.
    pub outcome: SlidingOutcome,
    /// When it first did, s.
    pub first_slip_time_s: Option<f64>,
    /// max |x|, m; null when overturned or lifted off.
    pub peak_slide_m: Option<f64>,
    /// x at the end of the run, m; null when overturned or lifted off.
    pub residual_displacement_m: Option<f64>,
    /// Energy that friction took while the base slid, over m g R (1 − cos α); null when overturned or lifted off.
    pub friction_energy_ratio: Option<f64>,
    /// When the toe left the ground, where the run ends, s.
    pub lifted_off_time_s: Option<f64>,
}

impl SlidingReport {
    /// In words.
    pub fn words(&self) -> String {
        let since = self.first_slip_time_s.map(|time| format!(" from {time:.3} s on")).unwrap_or_default();
        let far = |value: f64| format!("{value:.4} m");
        let lifts = self
            .lifted_off_time_s
            .map(|time| format!("; the toe lifts off at {time:.4} s, where the run ends: its flight is not modelled"));
        let what = match (self.outcome, self.peak_slide_m, self.residual_displacement_m) {
            (SlidingOutcome::Sticks, ..) => "the base does not slide".to_owned(),
            (_, Some(peak), Some(residual)) => {
                format!("the base slides{since}: {} at most, {} at the end", far(peak), far(residual))
            }
            _ => format!("the base slides{since}"),
        };
        what + &lifts.unwrap_or_default()
    }
}
