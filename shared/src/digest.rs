//! A fingerprint of a motion: two runs with the same digest went through the same bits.

use crate::arc::Arc;
use crate::control::controller::Decision;
use crate::observer::{Event, Observer, Stretch};
use crate::rocking::State;
use crate::scalar::{Real, Sign};
use crate::snapshot::{DeviceArc, DeviceObserver};

/// FNV-1a, 64 bits (Fowler, Noll and Vo 1991), over the bits of θ and θ̇, the toe and the clutch at the end of every
/// stretch and after every event, and two counts; of a device with a memory also the speeds of both flywheels and which of
/// them are coupled.
///
/// Compared between two machines, builds or versions:
/// - counts differ: the runs took different ways. An event was seen by one and missed by the other, or a step was cut
///   elsewhere; look at the events first.
/// - only the hash differs: the same events in the same order, but some operation rounded differently on the way (a fused
///   multiplication, another library, another order of terms).
///
/// It wants every swing of a free motion, so nothing is summed in closed form. Times are not in it: with fixed steps they
/// follow from the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest {
    hash: u64,
    stretches: u32,
    events: u32,
}

impl Default for Digest {
    fn default() -> Digest {
        Digest { hash: OFFSET, stretches: 0, events: 0 }
    }
}

/// FNV-1a of 32 bits, a word at a time, from [`FOLD_BASIS`] on. Every step can be undone, so a change of one word
/// never hides.
pub(crate) const fn fold(digest: u32, word: u32) -> u32 {
    (digest ^ word).wrapping_mul(0x0100_0193)
}

/// Where [`fold`] begins.
pub(crate) const FOLD_BASIS: u32 = 0x811C_9DC5;

/// FNV's offset basis.
const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

/// FNV's prime.
const PRIME: u64 = 0x0100_0000_01b3;

/// What is hashed for any NaN: its sign and payload are the machine's choice.
const NAN: u64 = 0x7ff8;

impl Digest {
    /// The hash so far.
    pub fn hash(&self) -> u64 {
        self.hash
    }

    /// Stretches so far.
    pub fn stretches(&self) -> u32 {
        self.stretches
    }

    /// Events so far.
    pub fn events(&self) -> u32 {
        self.events
    }

    #[inline]
    fn byte(&mut self, byte: u8) {
        self.hash = (self.hash ^ u64::from(byte)).wrapping_mul(PRIME);
    }

    /// The bytes of a number, lowest first.
    #[inline]
    fn number<S: Real>(&mut self, x: S) {
        let bits = if x.partial_cmp(&x).is_some() { x.bits() } else { NAN };
        for &byte in bits.to_le_bytes().iter().take(size_of::<S>()) {
            self.byte(byte);
        }
    }

    /// Command, wish, phase and estimate of a tick of a controller; neither a stretch nor an event.
    pub fn decision(&mut self, decision: &Decision) {
        let Decision { command, estimate, wish, phase, fault } = decision;
        self.byte(u8::from(command[0]) | u8::from(command[1]) << 1 | u8::from(estimate.standing) << 2 | (*wish as u8) << 3);
        self.byte(*phase as u8);
        self.byte(fault.map_or(0, |fault| fault.code() as u8));
        self.instant(estimate.rotation, estimate.velocity, estimate.side, 0);
        for quantity in [estimate.push, estimate.ground[0], estimate.ground[1], estimate.ground_rate] {
            self.number(quantity);
        }
    }

    #[inline]
    fn instant<S: Real>(&mut self, rotation: S, velocity: S, side: Sign, kind: u8) {
        self.number(rotation);
        self.number(velocity);
        self.byte(kind << 1 | u8::from(side == Sign::Negative));
    }
}

impl<S: Real> Observer<S> for Digest {
    #[inline]
    fn stretch(&mut self, _arc: &dyn Arc<S>, stretch: &Stretch<S>) {
        self.stretches = self.stretches.wrapping_add(1);
        self.instant(stretch.last.rotation, stretch.last.velocity, stretch.side, u8::from(stretch.engaged));
    }

    #[inline]
    fn event(&mut self, event: Event, _time: S, state: &State<S>) {
        self.events = self.events.wrapping_add(1);
        let kind = match event {
            Event::Uplift => 2,
            Event::Impact => 3,
            Event::Turn => 4,
            Event::Switch => 5,
            Event::Rest => 6,
            Event::Overturned => 7,
            Event::Coupling => 8,
        };
        self.instant(state.rotation, state.velocity, state.side, kind);
    }
}

impl<S: Real> DeviceObserver<S> for Digest {
    fn device_stretch(&mut self, arc: &dyn DeviceArc<S>, stretch: &Stretch<S>) {
        Observer::stretch(self, &arc, stretch);
        let seen = arc.snapshot(stretch.to);
        seen.spin.iter().for_each(|&spin| self.number(spin));
        self.byte(seen.engaged.iter().fold(0, |flags, &engaged| flags << 1 | u8::from(engaged)));
    }

    fn device_event(&mut self, event: Event, time: S, state: &State<S>) {
        Observer::event(self, event, time, state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_fnv_1a() {
        // A test vector of the hash's authors.
        let mut digest = Digest::default();
        b"foobar".iter().for_each(|&byte| digest.byte(byte));
        assert_eq!(digest.hash(), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn every_part_of_an_instant_counts() {
        let of = |rotation: f32, velocity: f32, side, event| {
            let mut digest = Digest::default();
            digest.event(event, 0.0, &State { rotation, velocity, side, ..State::default() });
            assert_eq!((digest.stretches(), digest.events()), (0, 1));
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
