//! Digest (hash) of a motion: two runs with the same digest went through the same bits.

use crate::math::fnv::Fnv;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::dense_output::DenseOutput;
use crate::motion::device_snapshot::DeviceOutput;
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::BlockState;

/// [`Fnv`] over the bits of θ and θ̇, the toe and the clutch at the end of every interval and after every event, and two counts; of a device
/// with a memory also the speeds of both flywheels and which of them are coupled.
///
/// Compared between two machines, builds or versions:
/// - counts differ: the runs differ in their events. One located an event that the other missed, or a step was cut
///   elsewhere; look at the events first.
/// - only the hash differs: the same events in the same order, but some operation rounded differently on the way (a fused
///   multiplication, another library, another order of terms).
///
/// It wants every swing of a free motion, so nothing is summed in closed form. Times are not in it: with fixed steps they
/// follow from the rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Digest {
    hash: Fnv,
    /// Intervals so far.
    pub stretches: u32,
    /// Events so far.
    pub events: u32,
}

impl Digest {
    /// The hash so far.
    pub fn hash(&self) -> u64 {
        self.hash.value()
    }

    fn instant<S: Real>(&mut self, rotation: S, velocity: S, side: Sign, kind: u8) {
        self.hash.number(rotation);
        self.hash.number(velocity);
        self.hash.byte(kind << 1 | u8::from(side == Sign::Negative));
    }
}

impl<S: Real> Observer<S> for Digest {
    fn interval(&mut self, _output: &dyn DenseOutput<S>, interval: &MonotoneInterval<S>) {
        self.stretches = self.stretches.wrapping_add(1);
        self.instant(interval.last.rotation, interval.last.velocity, interval.side, u8::from(interval.engaged));
    }

    fn event(&mut self, event: Event, _time: S, state: &BlockState<S>) {
        self.events = self.events.wrapping_add(1);
        let kind = match event {
            Event::Uplift => 2,
            Event::Impact => 3,
            Event::Turn => 4,
            Event::Switch => 5,
            Event::Rest => 6,
            Event::Overturned => 7,
            Event::Coupling => 8,
            Event::Slip => 9,
        };
        self.instant(state.rotation, state.velocity, state.side, kind);
    }

    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.interval(output.motion(), interval);
        let seen = output.snapshot(interval.to);
        seen.device.spin.iter().for_each(|&spin| self.hash.number(spin));
        self.hash.byte(seen.device.engaged.iter().fold(0, |flags, &engaged| flags << 1 | u8::from(engaged)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_an_instant_counts() {
        let of = |rotation: f32, velocity: f32, side, event| {
            let mut digest = Digest::default();
            digest.event(event, 0.0, &BlockState { rotation, velocity, side, ..BlockState::default() });
            assert_eq!((digest.stretches, digest.events), (0, 1));
            digest.hash()
        };
        let base = of(0.1, 0.2, Sign::Positive, Event::Turn);
        assert_eq!(base, of(0.1, 0.2, Sign::Positive, Event::Turn));
        assert_ne!(base, of(0.1_f32.next_up(), 0.2, Sign::Positive, Event::Turn));
        assert_ne!(base, of(0.1, 0.2_f32.next_up(), Sign::Positive, Event::Turn));
        assert_ne!(base, of(0.1, 0.2, Sign::Negative, Event::Turn));
        assert_ne!(base, of(0.1, 0.2, Sign::Positive, Event::Switch));
        assert_eq!(of(f32::NAN, 0.2, Sign::Positive, Event::Turn), of(-f32::NAN, 0.2, Sign::Positive, Event::Turn));
    }
}
