//! What the coils of a device's clutches take: how long they hold, and how often they close.

use sprag_shared::math::scalar::Real;
use sprag_shared::motion::device_snapshot::DeviceOutput;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::state::BlockState;

use crate::scene::checks::CoilTable;

/// How long both clutches of a pair were engaged, and how often they closed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CoilUse {
    /// Time engaged, of both clutches together, s.
    pub engaged_s: f64,
    /// Closings of both.
    pub closings: u32,
    carried: bool,
    engaged: [bool; 2],
}

impl CoilUse {
    /// Of a device that works while its block stands too, `carried` by a support that moves otherwise than the ground.
    pub fn of(carried: bool) -> CoilUse {
        CoilUse { carried, ..CoilUse::default() }
    }

    /// The clutches were `engaged` for `duration` (s).
    pub fn hold(&mut self, engaged: [bool; 2], duration: f64) {
        for (before, now) in self.engaged.iter_mut().zip(engaged) {
            self.closings += u32::from(now && !*before);
            self.engaged_s += if now { duration } else { 0.0 };
            *before = now;
        }
    }

    /// What `coil`, of each clutch, takes for it: holding power × time engaged + energy of the closings, J.
    pub fn energy_j(&self, coil: &CoilTable) -> f64 {
        coil.holding_power_w * self.engaged_s + coil.closing_energy_j * f64::from(self.closings)
    }
}

/// Clutches that the motion itself switches, by Eq. 10: they are released while the block stands, but on a support of its own motion.
impl<S: Real> Observer<S> for CoilUse {
    #[inline(never)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        let engaged = if interval.engaged { output.snapshot(interval.to).device.engaged } else { [false; 2] };
        self.hold(engaged, (interval.to - interval.from).to_f64());
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.device_interval(output, interval);
    }

    fn event(&mut self, event: Event, _time: S, _state: &BlockState<S>) {
        if event == Event::Rest && !self.carried {
            self.hold([false; 2], 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn energy_is_power_times_time_and_a_share_for_each_closing() {
        let mut used = CoilUse::default();
        for (engaged, duration) in [([true, false], 0.2), ([true, false], 0.1), ([false; 2], 1.0), ([true, true], 0.5)] {
            used.hold(engaged, duration);
        }
        assert_eq!(used.closings, 3);
        assert!((used.engaged_s - 1.3).abs() < 1e-12);
        let coil = CoilTable { holding_power_w: 24.0, closing_energy_j: 5.0, largest_energy_j: None };
        assert!((used.energy_j(&coil) - (24.0 * 1.3 + 15.0)).abs() < 1e-12);
    }
}
