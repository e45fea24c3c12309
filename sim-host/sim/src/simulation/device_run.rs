//! What a run of one device comes to.

use serde::Serialize;
use sprag_shared::math::scalar::Real;
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::observers::peaks::Peaks;

use super::demand::{Demand, Impulses, support_force_ratio};
use super::energy::EnergyReport;
use super::run::Task;
use super::sliding_report::SlidingReport;
use super::step_end::Trace;
use super::watchers::Watchers;
use crate::accuracy::answer::Comparable;
use crate::accuracy::{Answer, Compared, ErrorEstimate};
use crate::history::{History, Sample};
use crate::scene::checks::ChecksTable;

/// One device's run. The fields that serialize are the objects in `runs` of `summary.json`; times in s.
#[derive(Clone, Debug, Serialize)]
pub struct DeviceRun {
    /// Name of the device.
    pub device: String,
    /// Outcome of the run.
    pub outcome: Outcome,
    /// max |θ|/α; null when overturned or lifted off.
    pub peak_rotation: Option<f64>,
    /// max |θ̈|/(p²α); null when overturned or lifted off.
    pub peak_acceleration: Option<f64>,
    /// Impacts that came in with more than 1e-6 pα.
    pub impacts: u32,
    /// The first of them.
    pub first_impact_time_s: Option<f64>,
    /// Rest, overturning or the end of the run.
    pub end_time_s: f64,
    /// Times that other flywheels are engaged than before: changes of `engaged` in the history, in swings that count.
    pub clutch_switches: u32,
    /// Engagements that the clutch missed.
    #[serde(skip_serializing_if = "is_zero")]
    pub missed_engagements: u32,
    /// max |F|/(mg) of both flywheels together on their support, between samples too; at step ends where events are looked for there. None
    /// where nobody looked.
    pub peak_force_ratio: Option<f64>,
    /// What impacts and jolts ask of the toe; none where events are looked for at step ends.
    #[serde(flatten)]
    pub impulses: Impulses,
    /// What the motion asks of toe, device and gears, where the scene has `[checks]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub checks: Option<Demand>,
    /// Where the energy went, where the scene keeps a ledger.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyReport>,
    /// What the base did, where it may slide.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sliding: Option<SlidingReport>,
    /// How accurate it is, where that was asked for.
    #[serde(rename = "error_estimate", skip_serializing_if = "Option::is_none")]
    pub error: Option<ErrorReport>,
    /// The history.
    #[serde(skip)]
    pub history: History,
}

/// How accurate a run is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorReport {
    /// Size of the last terms of the series over the rotation that matters.
    pub tolerance: f64,
    /// False where the error that was asked for cannot be had.
    pub as_wanted: bool,
    /// Absolute errors; the time's in s.
    #[serde(flatten)]
    pub estimate: ErrorEstimate,
}

impl ErrorReport {
    /// Of an answer.
    pub fn of<R>(answer: &Answer<R>) -> ErrorReport {
        ErrorReport { tolerance: answer.closeness.tolerance, as_wanted: answer.as_wanted, estimate: answer.error }
    }

    /// In words, of a run whose peak is `peak`.
    pub fn words(&self, peak: Option<f64>) -> String {
        let enough = if self.as_wanted { "" } else { ", more than was asked for" };
        match (self.estimate.outcome_certain, peak) {
            (false, _) => "outcome in doubt: the motion comes too close to a boundary".to_owned(),
            (true, None) => "outcome certain".to_owned(),
            (true, Some(_)) => {
                format!(
                    "peak θ/α within {:.1e} ({:.1e} of it){enough}",
                    self.estimate.peak_rotation,
                    self.estimate.relative(peak)
                )
            }
        }
    }
}

impl Comparable for DeviceRun {
    type Outcome = Outcome;

    fn compared(&self) -> Compared<Outcome> {
        Compared {
            outcome: self.outcome,
            peak_rotation: self.peak_rotation,
            peak_acceleration: self.peak_acceleration,
            first_impact_time: self.first_impact_time_s,
        }
    }
}

fn is_zero(count: &u32) -> bool {
    *count == 0
}

/// What a run found beside its state and peaks.
#[derive(Clone, Debug, Default)]
pub(crate) struct Found {
    pub samples: Vec<Sample>,
    pub impacts_s: Vec<f64>,
    pub clutch_switches: u32,
    pub missed_engagements: u32,
    pub peak_force_ratio: Option<f64>,
    pub impulses: Impulses,
    pub checks: Option<Demand>,
    pub energy: Option<EnergyReport>,
    pub sliding: Option<SlidingReport>,
}

impl Found {
    /// By those who watched.
    pub fn watched<S: Real>(task: &Task<'_>, watchers: Watchers<'_, S>) -> Found {
        let Watchers { recorder, checks, asked, .. } = watchers;
        let demand = |(checks, table): (_, &ChecksTable)| Demand::of(task, table, &checks, asked.coils());
        let demand = checks.zip(task.scene.file.checks.as_ref()).map(demand);
        Found {
            samples: recorder.samples,
            impacts_s: recorder.impacts,
            clutch_switches: recorder.switches,
            missed_engagements: 0,
            peak_force_ratio: checks.map(|checks| support_force_ratio(task, &checks.report).unwrap_or(0.0)),
            impulses: checks.map(|checks| Impulses::of(&checks.before_fall())).unwrap_or_default(),
            checks: demand,
            energy: asked.energy(),
            sliding: None,
        }
    }
}

impl<S> From<Trace<S>> for Found {
    fn from(trace: Trace<S>) -> Found {
        Found {
            samples: trace.samples,
            impacts_s: trace.impacts,
            clutch_switches: trace.switches,
            peak_force_ratio: Some(trace.peak_force),
            ..Found::default()
        }
    }
}

impl DeviceRun {
    /// Of a motion that ended in `state` with `peaks`. Results stay relative to the bare block.
    pub(crate) fn of<S: Real>(task: &Task<'_>, state: &BlockState<S>, peaks: &Peaks<S>, found: Found) -> DeviceRun {
        let device = task.device().name.clone();
        let (alpha, p) = (task.scene.block.slenderness(), task.scene.block.frequency_parameter());
        let lifted_off = found.sliding.is_some_and(|sliding| sliding.lifted_off_time_s.is_some());
        let outcome = if lifted_off { Outcome::LiftedOff } else { Outcome::of(state, peaks) };
        let safe = |value: S| outcome.stands().then_some(value.to_f64());
        DeviceRun {
            device: device.clone(),
            outcome,
            peak_rotation: safe(peaks.rotation).map(|peak| peak / alpha),
            peak_acceleration: safe(peaks.acceleration).map(|peak| peak / (p * p * alpha)),
            impacts: state.impacts,
            first_impact_time_s: peaks.first_counted_impact.map(Real::to_f64),
            end_time_s: peaks.ended.map_or(task.end(), Real::to_f64),
            clutch_switches: found.clutch_switches,
            missed_engagements: found.missed_engagements,
            peak_force_ratio: found.peak_force_ratio,
            impulses: found.impulses,
            checks: found.checks,
            energy: found.energy,
            sliding: found.sliding,
            error: None,
            history: History {
                device,
                outcome: outcome.name().to_owned(),
                slenderness_rad: alpha,
                frequency_parameter_1_s: p,
                samples: found.samples,
                impacts_s: found.impacts_s,
                slides: found.sliding.is_some(),
            },
        }
    }
}
