//! Who watches a motion: peaks, histories, digests. What nobody watches costs nothing.

use crate::arc::{Arc, Motion};
use crate::decay::Decay;
use crate::rocking::State;
use crate::scalar::{Real, Sign};

/// What happened at an instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The block leaves its rest.
    Uplift,
    /// θ = 0; the state is the one after the impact.
    Impact,
    /// θ̇ = 0 at a largest rotation.
    Turn,
    /// The clutch engaged or released; the state is the one after it.
    Switch,
    /// A clutch of a device with a memory stuck, slipped, or took up its play; the state is the one after it.
    Coupling,
    /// The impacts have accumulated to rest.
    Rest,
    /// The block cannot return.
    Overturned,
}

/// A part of an arc over which θ and θ̇ are monotone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch<S> {
    /// Local time in the piece at which the arc starts, s.
    pub start: S,
    /// From here on the arc, s.
    pub from: S,
    /// To here on the arc, s.
    pub to: S,
    /// The motion at `from`.
    pub first: Motion<S>,
    /// The motion at `to`.
    pub last: Motion<S>,
    /// The inerter is engaged.
    pub engaged: bool,
    /// s.
    pub side: Sign,
    /// Sign of θ̇.
    pub direction: Sign,
}

/// Told of every stretch and every event, in order. Times are local to the piece of ground motion.
pub trait Observer<S: Real> {
    /// Wants every swing of a free motion; otherwise its end is summed in closed form ([`Decay`]).
    fn every_swing(&self) -> bool {
        true
    }

    /// The motion over a stretch.
    #[inline(always)]
    fn stretch(&mut self, arc: &dyn Arc<S>, stretch: &Stretch<S>) {
        let _ = (arc, stretch);
    }

    /// An event, with the state after it.
    #[inline(always)]
    fn event(&mut self, event: Event, time: S, state: &State<S>) {
        let _ = (event, time, state);
    }

    /// The rest of a free motion, summed.
    #[inline(always)]
    fn decay(&mut self, decay: &Decay<S>) {
        let _ = decay;
    }
}

/// Nobody.
impl<S: Real> Observer<S> for () {
    fn every_swing(&self) -> bool {
        false
    }
}

/// Two observers.
impl<S: Real, A: Observer<S>, B: Observer<S>> Observer<S> for (A, B) {
    fn every_swing(&self) -> bool {
        self.0.every_swing() || self.1.every_swing()
    }

    #[inline(always)]
    fn decay(&mut self, decay: &Decay<S>) {
        self.0.decay(decay);
        self.1.decay(decay);
    }

    #[inline(always)]
    fn stretch(&mut self, arc: &dyn Arc<S>, stretch: &Stretch<S>) {
        self.0.stretch(arc, stretch);
        self.1.stretch(arc, stretch);
    }

    #[inline(always)]
    fn event(&mut self, event: Event, time: S, state: &State<S>) {
        self.0.event(event, time, state);
        self.1.event(event, time, state);
    }
}

impl<S: Real, O: Observer<S> + ?Sized> Observer<S> for &mut O {
    fn every_swing(&self) -> bool {
        (**self).every_swing()
    }

    #[inline(always)]
    fn decay(&mut self, decay: &Decay<S>) {
        (**self).decay(decay);
    }

    #[inline(always)]
    fn stretch(&mut self, arc: &dyn Arc<S>, stretch: &Stretch<S>) {
        (**self).stretch(arc, stretch);
    }

    #[inline(always)]
    fn event(&mut self, event: Event, time: S, state: &State<S>) {
        (**self).event(event, time, state);
    }
}

/// Largest rotation and angular acceleration, and the first impact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peaks<S> {
    /// max |θ|, rad.
    pub rotation: S,
    /// max |θ̈| over one-sided limits, rad/s².
    pub acceleration: S,
    /// The block has uplifted.
    pub rocked: bool,
    /// Time of the first impact however weak, s from the origin: whether the block has hit the ground at all.
    pub first_impact: Option<S>,
    /// Time of the first of the impacts that are counted ([`State::impacts`]), s from the origin.
    pub first_counted_impact: Option<S>,
    /// Time at which the block came to rest or overturned, s from the origin.
    pub ended: Option<S>,
    /// Time of the present piece's start from the origin, s; the caller sets it.
    pub origin: S,
}

impl<S: Real> Observer<S> for Peaks<S> {
    fn every_swing(&self) -> bool {
        false
    }

    #[inline]
    fn decay(&mut self, decay: &Decay<S>) {
        self.rotation = self.rotation.larger(decay.rotation);
        self.acceleration = self.acceleration.larger(decay.acceleration);
    }

    #[inline]
    fn stretch(&mut self, arc: &dyn Arc<S>, stretch: &Stretch<S>) {
        // θ is monotone here; a largest value inside lies at a turn, where a stretch ends.
        let (first, last) = (&stretch.first, &stretch.last);
        self.rotation = self.rotation.larger(first.rotation.abs()).larger(last.rotation.abs());
        self.acceleration =
            arc.largest_acceleration((stretch.from, first.acceleration), (stretch.to, last.acceleration), self.acceleration);
    }

    #[inline]
    fn event(&mut self, event: Event, time: S, state: &State<S>) {
        match event {
            Event::Uplift => {
                self.rocked = true;
                self.ended = None;
            }
            Event::Impact => {
                let at = Some(self.origin + time);
                self.first_impact = self.first_impact.or(at);
                if state.impacts > 0 {
                    self.first_counted_impact = self.first_counted_impact.or(at);
                }
            }
            Event::Rest | Event::Overturned => self.ended = Some(self.origin + time),
            _ => {}
        }
    }
}
