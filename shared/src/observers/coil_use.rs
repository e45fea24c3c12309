//! What the coils of a device's clutches take: how long they hold, and how often they close.

use crate::math::scalar::Real;
use crate::motion::device_snapshot::DeviceOutput;
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::rest::impact_accumulation::Accumulation;
use crate::motion::state::{BlockState, Phase};

use super::counted_swing::{CountedSwing, clutches};

/// What coils did in a whole run, and before the fall of a block that overturns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoilUses {
    /// Until the end of the run, or where the block lies on the ground.
    pub whole: CoilUse,
    /// Of a block that does not overturn all of it.
    pub before_fall: CoilUse,
}

/// How long both clutches of a pair were engaged, and how often they closed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CoilUse {
    /// Time engaged, of both clutches together, s.
    pub engaged_s: f64,
    /// Closings of both, in swings that count.
    pub closings: u32,
    carried: bool,
    swing: CountedSwing,
    /// Those that count as engaged, a bit each.
    engaged: u8,
    /// The block stands on its base.
    stands: bool,
}

impl CoilUse {
    /// Of a device that works while its block stands too where it is `carried` by a support that moves otherwise than the ground; closings count
    /// as long as `swing` does.
    pub fn of(carried: bool, swing: CountedSwing) -> CoilUse {
        CoilUse { carried, swing, ..CoilUse::default() }
    }

    /// The clutches were `engaged` for `duration` (s).
    pub fn hold(&mut self, engaged: [bool; 2], duration: f64) {
        let counted = self.swing.engaged(self.engaged, clutches(engaged));
        self.closings += (counted & !self.engaged).count_ones();
        self.engaged = counted;
        for now in engaged {
            self.engaged_s += if now { duration } else { 0.0 };
        }
    }

    /// The block has moved, no faster than `fastest` (rad/s), for `duration` (s), in which nothing happened and the clutches were `engaged`.
    pub fn moves(&mut self, engaged: [bool; 2], fastest: f64, duration: f64) {
        self.swing.reaches(fastest);
        self.hold(engaged, duration);
        self.stands = false;
    }
}

/// Clutches that the motion itself switches, by Eq. 10: they are released while its weight holds the block, but on a support of its own motion.
impl<S: Real> Observer<S> for CoilUse {
    #[inline(never)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        let engaged = if interval.engaged { output.snapshot(interval.to).device.engaged } else { [false; 2] };
        self.moves(engaged, interval.fastest().to_f64(), (interval.to - interval.from).to_f64());
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.device_interval(output, interval);
        self.stands = true;
    }

    fn accumulation(&mut self, tail: &Accumulation<S>) {
        self.closings += tail.closings;
        self.engaged_s += tail.engaged.to_f64();
    }

    fn event(&mut self, event: Event, _time: S, state: &BlockState<S>) {
        self.swing.begins(event, state);
        // Those that hold a block on its base stay engaged until its weight alone does.
        let at_rest = event == Event::Rest || (event == Event::Switch && self.stands);
        if at_rest && state.phase == Phase::Rest && !self.carried {
            self.hold([false; 2], 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_counts_for_each_clutch_and_a_closing_once() {
        let mut used = CoilUse::default();
        for (engaged, duration) in [([true, false], 0.2), ([true, false], 0.1), ([false; 2], 1.0), ([true, true], 0.5)] {
            used.hold(engaged, duration);
        }
        assert_eq!(used.closings, 3);
        assert!((used.engaged_s - 1.3).abs() < 1e-12);
    }
}
