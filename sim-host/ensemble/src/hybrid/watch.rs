//! Those who watch a block of the lanes while the core has it.

use sprag_shared::math::sign::Sign;
use sprag_shared::motion::device_snapshot::{DeviceOutput, Snapshot};
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::rest::impact_accumulation::Accumulation;
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::checks::Checks;
use sprag_shared::observers::peaks::Peaks;

/// Peaks, and the force on the support where that is asked for.
pub(super) struct Watch<'a> {
    pub(super) peaks: &'a mut Peaks<f64>,
    pub(super) checks: Option<&'a mut Checks<f64>>,
    /// The steps may press harder than any before them; the bounces that a rest stands for may do so anyway.
    pub(super) pressed: bool,
}

impl Observer<f64> for Watch<'_> {
    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        self.peaks.interval(output.motion(), interval);
        if let Some(checks) = self.checks.as_mut().filter(|_| self.pressed) {
            checks.device_interval(output, interval);
        }
    }

    fn event(&mut self, event: Event, time: f64, state: &BlockState<f64>) {
        self.peaks.event(event, time, state);
        if let Some(checks) = &mut self.checks {
            checks.event(event, time, state);
        }
    }

    fn accumulation(&mut self, tail: &Accumulation<f64>) {
        self.peaks.accumulation(tail);
    }

    fn device_bounce(&mut self, side: Sign, time: f64, snapshot: &dyn Fn() -> Snapshot<f64>) {
        if let Some(checks) = &mut self.checks {
            checks.device_bounce(side, time, snapshot);
        }
    }
}
