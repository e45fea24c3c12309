//! Where θ = 0 is on the encoder, and rest on the gyroscope, found again in motion.
//!
//! An encoder that has lost counts, or was switched on in motion, is off by a constant travel o (over R), a gyroscope by b (rad/s). Each
//! impact fixes both: there θ = 0, so with τ the age of the impact when it is seen, ℓ the lever of the rack, and the gyroscope's and the
//! encoder's rotation since the last impact, a time t ago,
//!
//! z₁ = travel − ℓ (rate − b) τ = o − ℓ τ b,  z₂ = (∫ rate − Δθ)/t = b.
//!
//! Between impacts neither changes. The update is Kalman's, the covariance in Joseph's form. An impact is seen by its jump: the angular
//! speed falls to η times itself between two readings, which no ground motion makes it do; a clutch that engages does, and nothing is
//! concluded while one has just moved. The first impact that is seen gives the offset; the second, where the first says that it must be,
//! confirms it, or else takes its place.

use super::estimate::Deviation;
use super::state::EstimatorState;
use crate::control::model::Model;
use crate::control::sensing::instruments::{Instruments, Measured};
use crate::math::sign::Sign;
use crate::math::square_root32;
use nalgebra::{Matrix2, Vector2};

/// Standard deviation of a gyroscope's bias that nobody has measured, rad/s: what the sheets of such parts allow.
const BIAS: f32 = 0.02;

/// Of one that was measured before a reset.
const OLD_BIAS: f32 = 5e-4;

/// Of a rotation that nobody knows, over R: as good as any.
const ANYWHERE: f32 = 1.0;

/// For how long a reset loses counts on a board whose counter continues over it, s, and how many in any case, over R. One that has lost more is
/// found out by the first impact, and taken for unknown then.
const RESET_TIME: f32 = 2e-3;
const RESET_TRAVEL: f32 = 1e-4;

/// Of the gyroscope's mean over a swing, rad/s: scale, and shocks that it has felt.
const MEAN_RATE: f32 = 5e-4;

/// The shortest time over which a mean is worth having, s.
const LEAST_SWING: f32 = 0.1;

/// Standard deviations within which a measurement may be believed, and without which a disagreement is none.
const GATE: f32 = 4.0;
const REACH: f32 = 3.0;

/// Share of the jump of an impact that two readings in a row must show, and how much more than all of it they may.
const SEEN: f32 = 0.25;
const MOST_SEEN: f32 = 1.6;

/// Deviations of θ̇ that no noise reaches.
pub(super) const ABOVE_NOISE: f32 = 8.0;

/// How many times the velocity that a standing block may seem to have by a gyroscope alone none of its readings reaches by noise.
pub(super) const ABOVE_STANDING: f32 = 2.0;

/// For how long after a change of a clutch a jump may be its doing, s.
const ENGAGING: f32 = 0.025;

/// Of the travel (over R) at θ = 0 and the gyroscope's bias.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Reference {
    covariance: Matrix2<f32>,
    /// Standard deviation of the travel at θ = 0.
    spread: f32,
    /// Rotation by the gyroscope since the last impact, or since this began, …
    turned: f32,
    /// … that by the encoder, then, …
    began: f32,
    /// … and how long ago that was, s.
    elapsed: f32,
    /// Which clutches were engaged at the last tick, …
    engaged: [bool; 2],
    /// … and for how long none has been that was open before, s.
    unchanged: f32,
    /// The last readings of the gyroscope, the newest first, rad/s, how many there are, …
    rates: [f32; 4],
    read: u8,
    /// … and how old the newest is, and was the one before when it came, s.
    since: f32,
    between: f32,
    /// An impact has given the offset, which another one has to confirm.
    fixed: bool,
}

impl Reference {
    fn of(travel: f32, bias: f32) -> Reference {
        let covariance = Matrix2::new(travel * travel, 0.0, 0.0, bias * bias);
        Reference { covariance, spread: travel, ..Reference::default() }
    }

    pub fn unknown() -> Reference {
        Reference::of(ANYWHERE, BIAS)
    }

    pub fn after_reset(velocity: f32) -> Reference {
        Reference::of(RESET_TIME * velocity.abs() + RESET_TRAVEL, OLD_BIAS)
    }

    /// The `settled` deviation of an estimate, and what is not known of θ = 0.
    pub fn spread(&self, settled: Deviation) -> Deviation {
        Deviation { rotation: settled.rotation + self.spread, ..settled }
    }

    /// How far from θ = 0 the encoder may be there, over R.
    #[inline]
    pub fn reach(&self) -> f32 {
        REACH * self.spread
    }

    /// Takes the travel at an impact and the mean rate of the swing before it, by how much they are off. `false` where no such impact can
    /// be, by what was known before.
    fn update(&mut self, innovation: Vector2<f32>, observation: Matrix2<f32>, noise: Matrix2<f32>) -> Option<Vector2<f32>> {
        let cross = self.covariance * observation.transpose();
        let total = observation * cross + noise;
        if innovation.x * innovation.x > GATE * GATE * total.m11 {
            return None;
        }
        let gain = cross * total.try_inverse()?;
        let kept = Matrix2::identity() - gain * observation;
        self.covariance = kept * self.covariance * kept.transpose() + gain * noise * gain.transpose();
        self.spread = square_root32(self.covariance.m11.max(0.0));
        Some(gain * innovation)
    }
}

impl Reference {
    /// The last two readings have lost speed against the two before them, all four by more than noise, as an impact does: the loss of a
    /// single reading is none.
    fn jumped(&self, bias: f32, restitution: f32, noise: f32) -> bool {
        let side = Sign::of(self.rates[3], Sign::Positive);
        let [now, then, before, first] = self.rates.map(|rate| side.times(rate - bias));
        let (least, most) = (if before < first { before } else { first }, if now > then { now } else { then });
        let (lost, jump) = (least - most, (1.0 - restitution) * least);
        self.read >= 4
            && self.unchanged > ENGAGING
            && lost > SEEN * jump
            && lost > noise
            && lost < MOST_SEEN * jump + noise
            && now > 0.0
    }
}

impl EstimatorState {
    /// One tick of a block that rocks while only impacts show where θ = 0 is; `noise` is what no noise makes of two readings of θ̇ (rad/s).
    /// Whether there was an impact: then the state is that after it.
    #[inline(never)]
    pub(super) fn look_for_impact(&mut self, model: &Model, instruments: &Instruments, seen: &Measured, noise: f32) -> bool {
        let reference = &mut self.reference;
        if reference.elapsed <= 0.0 {
            reference.began = self.rotation;
        }
        let engages = seen.engaged.iter().zip(reference.engaged).any(|(now, before)| *now && !before);
        reference.engaged = seen.engaged;
        let period = instruments.period;
        reference.unchanged = if engages { 0.0 } else { reference.unchanged + period };
        reference.elapsed += period;
        reference.since += period;
        // Where there is no new reading the last one stands.
        if let Some(rate) = seen.rate {
            let [first, second, third, _] = reference.rates;
            reference.rates = [rate, first, second, third];
            reference.read = reference.read.saturating_add(1);
            (reference.between, reference.since) = (reference.since, 0.0);
        }
        reference.turned += reference.rates[0] * period;
        match seen.travel.filter(|_| seen.rate.is_some() && reference.jumped(self.bias, model.parameters.restitution, noise)) {
            Some(travel) => self.fix(model, instruments, travel),
            None => self.passes(model),
        }
    }

    /// An impact has just been seen.
    fn fix(&mut self, model: &Model, instruments: &Instruments, travel: f32) -> bool {
        let (period, arm) = (instruments.period, model.standing_arm());
        let reference = &mut self.reference;
        let rate = reference.rates[0];
        // Of two readings after it, the first came half the time between them after the impact; and what the sensor is late.
        let age = 1.5 * reference.between + instruments.gyroscope_delay - instruments.encoder_delay;
        let velocity = rate - self.bias;
        let mean = (reference.turned - (self.rotation - reference.began)) / reference.elapsed - self.bias;
        let innovation = Vector2::new(travel - arm * velocity * age - self.offset, mean);
        let observation = Matrix2::new(1.0, -arm * age, 0.0, 1.0);
        let timing = arm * velocity * (reference.between + period);
        let counts = instruments.travel_per_count;
        // A mean over less than a swing says little.
        let slip = if reference.elapsed > LEAST_SWING { counts / (arm * reference.elapsed) } else { ANYWHERE };
        let noise = Matrix2::new(timing * timing + counts * counts, 0.0, 0.0, slip * slip + MEAN_RATE * MEAN_RATE);
        let mut confirms = reference.fixed;
        let mut correction = reference.update(innovation, observation, noise);
        if correction.is_none() {
            // Not where what was known before says that it must be: it is that which is wrong.
            let Reference { rates, engaged, unchanged, .. } = *reference;
            *reference = Reference { rates, engaged, unchanged, ..Reference::unknown() };
            (confirms, correction) = (false, reference.update(innovation, observation, noise));
        }
        let Some(correction) = correction else { return false };
        reference.fixed = true;
        self.offset += correction.x;
        self.bias += correction.y;
        self.velocity = rate - self.bias;
        self.side = Sign::of(self.velocity, self.side.opposite());
        self.rotation = model.rotation_of_travel(travel - self.offset, 0.0, self.side);
        let reference = &mut self.reference;
        (reference.turned, reference.elapsed, reference.read) = (0.0, 0.0, 0);
        self.lost = !confirms;
        (self.blank, self.doubted) = (0, false);
        self.bound();
        true
    }

    /// Where no jump is seen, the other toe takes over only once θ must have passed 0.
    fn passes(&mut self, model: &Model) -> bool {
        let beyond = self.hits() && self.rotation.abs() * model.standing_arm() > self.reference.reach();
        if beyond {
            self.side = self.side.opposite();
        }
        beyond
    }
}
