//! What every estimator carries from tick to tick, and the steps that all of them take.

use super::estimate::{Deviation, Estimate, bounded};
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
    /// Of the gyroscope, rad/s.
    pub(super) bias: f32,
    pub(super) side: Sign,
    /// Ticks for which some sensors are not yet believed again after an impact.
    pub(super) blank: u16,
    pub(super) rocks: bool,
    /// Ticks for which a block that rocks has looked as if it stood.
    pub(super) still: u16,
}

impl EstimatorState {
    /// Of a block that is met in motion at θ (rad) and θ̇ (rad/s), as after a reset in mid-earthquake.
    pub fn met(rotation: f32, velocity: f32) -> EstimatorState {
        let side = Sign::of(rotation, Sign::of(velocity, Sign::Positive));
        EstimatorState { rotation, velocity, side, rocks: true, ..EstimatorState::default() }
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
        model.rotation_of_travel(travel, then, Sign::of(travel, self.side)) - then
    }

    /// Keeps the motion within what can be.
    #[inline]
    pub(super) fn bound(&mut self) {
        (self.rotation, self.velocity, self.acceleration) = bounded(self.rotation, self.velocity, self.acceleration);
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
