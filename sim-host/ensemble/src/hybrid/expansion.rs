//! The power series of one step of every block.

use std::array::from_fn;

use sprag_shared::math::power_series::Tape;
use sprag_shared::math::scalar::Scalar;
use sprag_shared::method::motion_series::{MotionSeries, StepSeries};

use super::located::LaneSeries;
use crate::{Number, number};

/// Coefficients of θ at least: as many as its and the guard's bounds look at.
pub(super) const LEAST_TERMS: usize = 6;

/// Coefficients of θ at most: as many as reach from one sample to the next.
pub(super) const TERMS: usize = 14;

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
    /// The series of one lane, whose step has this `length` (s), with so many coefficients of θ (`terms`); the others are zero.
    pub(super) fn of_lane(&self, lane: usize, terms: usize, length: f64) -> LaneSeries {
        fn of<const N: usize>(series: &[Number; N], lane: usize, terms: usize) -> [f64; N] {
            from_fn(|k| if k < terms { series[k].0[lane] } else { 0.0 })
        }
        let Expansion { motion: MotionSeries { rotation, velocity, acceleration }, guards, spins, .. } = self;
        let rates = terms - 2;
        let motion = MotionSeries {
            rotation: of(rotation, lane, terms),
            velocity: of(velocity, lane, terms - 1),
            acceleration: of(acceleration, lane, rates),
        };
        LaneSeries {
            motion: StepSeries { length, terms, motion },
            guards: from_fn(|i| of(&guards[i], lane, rates)),
            spins: from_fn(|i| of(&spins[i], lane, terms - 1)),
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
