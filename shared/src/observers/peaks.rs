//! Peak rotation, peak angular acceleration, and the time of the first impact.

use crate::math::scalar::Real;
use crate::method::dense_output::DenseOutput;
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::rest::free_decay::Decay;
use crate::motion::rest::impact_accumulation::Accumulation;
use crate::motion::state::BlockState;

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
    /// Time of the first of the impacts that are counted ([`BlockState::impacts`]), s from the origin.
    pub first_counted_impact: Option<S>,
    /// Time at which the block came to rest or overturned, s from the origin.
    pub ended: Option<S>,
    /// Time of the present ground segment's start from the origin, s; the caller sets it.
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

    fn accumulation(&mut self, tail: &Accumulation<S>) {
        self.acceleration = tail.raise(self.acceleration);
    }

    #[inline]
    fn interval(&mut self, output: &dyn DenseOutput<S>, interval: &MonotoneInterval<S>) {
        // θ is monotone here; a largest value inside lies at a turn, where an interval ends.
        let (first, last) = (&interval.first, &interval.last);
        self.rotation = self.rotation.larger(first.rotation.abs()).larger(last.rotation.abs());
        self.acceleration =
            output.largest_acceleration((interval.from, first.acceleration), (interval.to, last.acceleration), self.acceleration);
    }

    #[inline]
    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
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
            Event::Slip => self.ended = None,
            Event::Rest | Event::Overturned => self.ended = Some(self.origin + time),
            _ => {}
        }
    }
}
