//! The power series of one step of every block.

use sprag_shared::math::power_series::Tape;
use sprag_shared::math::scalar::Scalar;
use sprag_shared::method::motion_series::{MotionSeries, StepSeries};

use super::Kind;
use super::located::LaneSeries;
use super::stretch::Stepped;
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
    /// Force of a flywheel that is locked, likewise.
    pub(super) on_wheel: [Number; RATES],
    /// The series of one lane, for the core.
    pub(super) one: LaneSeries,
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
            on_wheel: none,
            one: LaneSeries {
                motion: StepSeries::new(0.0),
                guards: [[0.0; RATES]; LANE_GUARDS],
                spins: [[0.0; TERMS]; 2],
                goes_on: false,
                guarded: false,
            },
        }
    }
}

impl Expansion {
    /// Takes out the series of one lane of this `kind`, which has `stepped`; what lanes of the kind have not stays zero.
    pub(super) fn take_out(&mut self, lane: usize, kind: Kind, stepped: &Stepped) {
        fn copy<const N: usize>(from: &[Number; N], lane: usize, terms: usize, to: &mut [f64; N]) {
            for (to, from) in to.iter_mut().zip(&from[..terms]) {
                *to = from.0[lane];
            }
        }
        let Kind { terms, plates, .. } = kind;
        let Expansion { motion: MotionSeries { rotation, velocity, acceleration }, guards, spins, one, .. } = self;
        (one.motion.length, one.motion.terms) = (stepped.time.0[lane], terms);
        (one.goes_on, one.guarded) = (stepped.goes_on.at(lane), stepped.guarded.at(lane));
        copy(rotation, lane, terms, &mut one.motion.motion.rotation);
        copy(velocity, lane, terms - 1, &mut one.motion.motion.velocity);
        copy(acceleration, lane, terms - 2, &mut one.motion.motion.acceleration);
        let watched = if plates { LANE_GUARDS } else { 1 };
        for (from, to) in guards[..watched].iter().zip(&mut one.guards) {
            copy(from, lane, terms - 2, to);
        }
        if plates {
            for (from, to) in spins.iter().zip(&mut one.spins) {
                copy(from, lane, terms - 1, to);
            }
        }
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
