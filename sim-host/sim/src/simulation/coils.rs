//! What the coils of a scene's device take, with and without the fall of a block that overturns.

use sprag_shared::math::scalar::Real;
use sprag_shared::motion::device_snapshot::DeviceOutput;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::rest::impact_accumulation::Accumulation;
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::coil_use::{CoilUse, CoilUses};
use sprag_shared::observers::fall::Fall;

/// Coils of clutches that the motion itself switches, or what a controller has commanded in their place.
#[derive(Debug)]
pub struct Coils<S> {
    used: CoilUse,
    fall: Fall<S, CoilUse>,
    /// By a controller.
    pub commanded: Option<CoilUses>,
}

impl<S: Real> Coils<S> {
    /// Of a block of α = `slenderness` (rad), that are `used` so far.
    pub fn new(used: CoilUse, slenderness: f64) -> Coils<S> {
        Coils { used, fall: Fall::beyond(S::of(slenderness)), commanded: None }
    }

    /// What they did.
    pub fn uses(&self) -> CoilUses {
        let before_fall = self.fall.before().unwrap_or(self.used);
        self.commanded.unwrap_or(CoilUses { whole: self.used, before_fall })
    }
}

impl<S: Real> Observer<S> for Coils<S> {
    #[inline(never)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        let passed = self.fall.passed(output, interval, |up_to_it| {
            let mut before = self.used;
            if let Some(interval) = up_to_it {
                before.device_interval(output, interval);
            }
            before
        });
        self.fall.keep(passed);
        self.used.device_interval(output, interval);
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.used.device_at_rest(output, interval);
    }

    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        self.fall.event(event);
        self.used.event(event, time, state);
    }

    fn accumulation(&mut self, tail: &Accumulation<S>) {
        self.used.accumulation(tail);
    }
}
