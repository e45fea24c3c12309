//! Those who watch a block of the lanes while the core has it.

use sprag_shared::math::sign::Sign;
use sprag_shared::motion::device_snapshot::{DeviceOutput, Snapshot};
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::rest::impact_accumulation::Accumulation;
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::checks::Checks;
use sprag_shared::observers::coil_use::CoilUse;
use sprag_shared::observers::peaks::Peaks;

/// Peaks, and forces and the use of coils where these are asked for.
pub(super) struct Watch<'a> {
    pub(super) peaks: &'a mut Peaks<f64>,
    pub(super) checks: Option<&'a mut Checks<f64>>,
    pub(super) coils: Option<&'a mut CoilUse>,
    /// The steps may press harder than any before them; the bounces that a rest stands for may do so anyway.
    pub(super) pressed: bool,
}

impl Observer<f64> for Watch<'_> {
    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        self.peaks.interval(output.motion(), interval);
        if self.pressed {
            self.checks.device_interval(output, interval);
        }
        self.coils.device_interval(output, interval);
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        self.checks.device_at_rest(output, interval);
        self.coils.device_at_rest(output, interval);
    }

    fn event(&mut self, event: Event, time: f64, state: &BlockState<f64>) {
        self.peaks.event(event, time, state);
        self.checks.event(event, time, state);
        self.coils.event(event, time, state);
    }

    fn accumulation(&mut self, tail: &Accumulation<f64>) {
        self.peaks.accumulation(tail);
        self.coils.accumulation(tail);
    }

    fn device_bounce(&mut self, side: Sign, time: f64, snapshot: &dyn Fn() -> Snapshot<f64>) {
        self.checks.device_bounce(side, time, snapshot);
    }
}
