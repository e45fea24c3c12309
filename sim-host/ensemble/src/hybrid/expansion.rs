//! The power series of one step of every block.

use sprag_shared::math::power_series::Tape;
use sprag_shared::math::scalar::Scalar;
use sprag_shared::method::motion_series::{MotionSeries, StepSeries};

use super::Kind;
use super::located::LaneSeries;
use crate::{Number, number};

/// Coefficients of θ at least: as many as its and the guard's bounds look at.
pub(super) const LEAST_TERMS: usize = 6;

/// Coefficients of θ under a record at most: as many as reach from one sample to the next.
pub(super) const RECORD_TERMS: usize = 14;

/// Coefficients of θ under any other motion.
pub(super) const TERMS: usize = 16;

/// Guards that lanes know: the command, and one of the plates of each flywheel.
pub(super) const LANE_GUARDS: usize = 3;

/// Those of θ̈.
pub(super) const RATES: usize = TERMS - 2;

/// Quantities of the equations on the tape.
const SLOTS: usize = 80;

/// Power series of one step of every block: scratch space, not state.
pub(super) struct Expansion {
    pub(super) tape: Tape<Number, TERMS, SLOTS>,
    pub(super) motion: MotionSeries<Number, TERMS>,
    /// Guards: the switching function with the sign that it keeps in the mode, and those of the plates of each flywheel.
    pub(super) guards: [[Number; RATES]; LANE_GUARDS],
    /// Speeds of the flywheels whose plates slip.
    pub(super) spins: [[Number; TERMS]; 2],
    /// Force of both flywheels together on their support; |F|/(λmR), 1/s².
    pub(super) force: [Number; RATES],
}

impl Default for Expansion {
    fn default() -> Self {
        let none = [number(0.0); RATES];
        Expansion {
            tape: Tape::default(),
            motion: MotionSeries::default(),
            guards: [none; LANE_GUARDS],
            spins: [[number(0.0); TERMS]; 2],
            force: none,
        }
    }
}

impl Expansion {
    /// The series of one lane of this `kind`, whose step has this `length` (s); what lanes of the kind have not is zero.
    pub(super) fn of_lane(&self, lane: usize, kind: Kind, length: f64) -> LaneSeries {
        fn copy<const N: usize>(from: &[Number; N], lane: usize, terms: usize, to: &mut [f64; N]) {
            for (to, from) in to.iter_mut().zip(&from[..terms]) {
                *to = from.0[lane];
            }
        }
        let Kind { terms, plates, .. } = kind;
        let MotionSeries { rotation, velocity, acceleration } = &self.motion;
        let mut motion = MotionSeries::default();
        copy(rotation, lane, terms, &mut motion.rotation);
        copy(velocity, lane, terms - 1, &mut motion.velocity);
        copy(acceleration, lane, terms - 2, &mut motion.acceleration);
        let (mut guards, mut spins) = ([[0.0; RATES]; LANE_GUARDS], [[0.0; TERMS]; 2]);
        let watched = if plates { LANE_GUARDS } else { 1 };
        for (from, to) in self.guards[..watched].iter().zip(&mut guards) {
            copy(from, lane, terms - 2, to);
        }
        if plates {
            for (from, to) in self.spins.iter().zip(&mut spins) {
                copy(from, lane, terms - 1, to);
            }
        }
        LaneSeries { motion: StepSeries { length, terms, motion }, guards, spins }
    }
}

/// Bound of the second derivative's magnitude over [0, `time`].
#[inline(always)]
pub(super) fn bend_of(coefficients: &[Number], time: Number) -> Number {
    let mut bend = number(0.0);
    for (k, coefficient) in coefficients.iter().enumerate().skip(2).rev() {
        bend = bend * time + coefficient.abs() * number((k * (k - 1)) as f64);
    }
    bend
}
