//! What every estimator carries from tick to tick, and the steps that all of them take.

use super::estimate::{Deviation, Estimate, bounded};
use super::reference::Reference;
use crate::control::model::Model;
use crate::control::sensing::instruments::{Instruments, Measured};
use crate::equation::body::Body;
use crate::math::sign::Sign;

/// State of an estimator, by default of a block that stands. What it does not estimate stays 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EstimatorState {
    pub(super) rotation: f32,
    pub(super) velocity: f32,
    pub(super) acceleration: f32,
    /// Travel over R that the encoder shows at θ = 0, beside what has been calibrated.
    pub(super) offset: f32,
    /// Of the gyroscope, rad/s, beside what has been calibrated.
    pub(super) bias: f32,
    pub(super) side: Sign,
    /// Ticks for which some sensors are not yet believed again after an impact.
    pub(super) blank: u16,
    pub(super) rocks: bool,
    /// Ticks for which a block that rocks has looked as if it stood.
    pub(super) still: u32,
    /// The last reading of the gyroscope was off by more than a jump, or turned a standing block, …
    pub(super) doubted: bool,
    /// … by this much, rad/s.
    pub(super) doubt: f32,
    /// Only impacts show where θ = 0 is ([`super::reference`]).
    pub(super) lost: bool,
    pub(super) reference: Reference,
}

impl EstimatorState {
    /// At power-on: whether the block stands, and where, nobody knows; it is taken to stand until it moves.
    pub fn unknown() -> EstimatorState {
        EstimatorState { lost: true, reference: Reference::unknown(), ..EstimatorState::default() }
    }

    /// Of a block that is met in motion at θ (rad) and θ̇ (rad/s), as after a reset in mid-earthquake, over which the encoder has lost what
    /// the rack travelled.
    pub fn met(rotation: f32, velocity: f32) -> EstimatorState {
        let side = Sign::of(rotation, Sign::of(velocity, Sign::Positive));
        let reference = Reference::after_reset(velocity);
        EstimatorState { rotation, velocity, side, rocks: true, lost: true, reference, ..EstimatorState::default() }
    }

    /// The sensors' zero of θ can no longer be trusted.
    pub fn doubt(&mut self) {
        (self.lost, self.reference) = (true, Reference::unknown());
    }

    /// What an encoder with a `travel` (over R) has travelled from θ = 0, as far as anybody knows.
    #[inline]
    pub fn travelled(&self, travel: f32) -> f32 {
        travel - self.offset
    }

    /// The biases that are subtracted before have grown by a `travel` (over R) of the encoder and a `rate` (rad/s) of the gyroscope.
    pub fn rebase(&mut self, travel: f32, rate: f32) {
        self.offset -= travel;
        self.bias -= rate;
    }

    /// The block stands: where the encoder is, there is θ = 0.
    #[inline]
    pub(super) fn stand(&mut self, travel: Option<f32>) {
        (self.rotation, self.velocity, self.acceleration) = (0.0, 0.0, 0.0);
        (self.rocks, self.still, self.doubted, self.lost) = (false, 0, false, false);
        self.offset = travel.unwrap_or(self.offset);
        self.reference = Reference::default();
    }

    /// A `period` (s) on by the trapezoidal rule, with θ̈ = `ahead`.
    #[inline]
    pub(super) fn advance(&mut self, ahead: f32, period: f32) {
        let velocity = self.velocity + ahead * period;
        let rotation = self.rotation + 0.5 * (self.velocity + velocity) * period;
        (self.rotation, self.velocity, _) = bounded(rotation, velocity, 0.0);
    }

    /// By how much the encoder's θ is off, compared with the motion of when it was read.
    #[inline]
    pub(super) fn encoder_error(&self, model: &Model, instruments: &Instruments, travel: f32) -> f32 {
        let then = self.rotation - self.velocity * instruments.encoder_delay;
        let travel = self.travelled(travel);
        model.rotation_of_travel(travel, then, Sign::of(travel, self.side)) - then
    }

    /// Keeps the motion within what can be.
    #[inline]
    pub(super) fn bound(&mut self) {
        (self.rotation, self.velocity, self.acceleration) = bounded(self.rotation, self.velocity, self.acceleration);
    }

    /// By how much the gyroscope's θ̇ is off (`error`, rad/s), as it may be believed: a reading that is off by more than a `jump` is a jump
    /// that nobody foresaw only if the next one says so too, and as large as the smaller of the two. Whether to take it over at once.
    #[inline]
    pub(super) fn believed(&mut self, error: f32, jump: f32) -> (f32, bool) {
        let (far, before) = (error.abs() > jump, self.doubted);
        self.doubted = far;
        if !far {
            return (error, false);
        }
        let agrees = before && (error > 0.0) == (self.doubt > 0.0);
        let both = if agrees && error.abs() > self.doubt.abs() { self.doubt } else { error };
        self.doubt = error;
        if agrees { (both, true) } else { (if error > 0.0 { jump } else { -jump }, false) }
    }

    /// θ has passed 0.
    #[inline]
    pub(super) fn hits(&self) -> bool {
        self.side.times(self.rotation) < 0.0 && self.side.times(self.velocity) < 0.0
    }

    /// The other toe takes over with a share of the velocity; sensors are not believed for `blank` ticks.
    #[inline]
    pub(super) fn impact(&mut self, share: f32, blank: u16) {
        self.side = self.side.opposite();
        self.velocity *= share;
        self.blank = blank;
    }

    /// θ̈ by the equation of motion.
    #[inline]
    pub(super) fn modelled_acceleration(&self, model: &Model, seen: &Measured, engaged: u8) -> f32 {
        model.acceleration(self.side, self.rotation, self.velocity, seen.ground, engaged)
    }

    /// As what the controller believes of a block that rocks.
    #[inline]
    pub(super) fn estimate(&self, seen: &Measured, push: f32, deviation: Deviation) -> Estimate {
        let EstimatorState { rotation, velocity, side, .. } = *self;
        let Measured { ground, ground_rate, .. } = *seen;
        let deviation = if self.lost { self.reference.spread(deviation) } else { deviation };
        Estimate { rotation, velocity, side, push, ground, ground_rate, standing: false, deviation }
    }

    /// The same where θ̈ is measured: the sign of the terminals' acceleration is that of the measured one.
    #[inline]
    pub(super) fn kinematic_estimate(&self, model: &Model, seen: &Measured, deviation: Deviation) -> Estimate {
        let configuration = model.configuration(self.side, self.rotation);
        let terminal = model.body.terminal_acceleration(&configuration, self.velocity, self.acceleration);
        self.estimate(seen, model.body.arm(&configuration) * terminal, deviation)
    }
}
