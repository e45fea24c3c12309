//! The power series of a step, of several blocks at once.

use std::cell::Cell;

use sprag_shared::equation::Equation;
use sprag_shared::math::RECIPROCALS;
use sprag_shared::math::power_series::Tape;
use sprag_shared::math::root::newton_bracketed;
use sprag_shared::math::scalar::Scalar;
use sprag_shared::math::sign::Sign;
use sprag_shared::method::motion_series::MotionSeries;

use crate::{Mask, Number, number};

/// Quantities of an equation of motion on the tape.
const SLOTS: usize = 18;

/// Power series of one step: scratch space, not state. θ has `TERMS` coefficients, θ̇ one less, θ̈ and the ground motion two less; what
/// their arrays have beyond is zero.
pub struct Series<const TERMS: usize> {
    tape: Tape<Number, TERMS, SLOTS>,
    /// Coefficients of ü_g/g about the start of the step; the caller sets it.
    pub ground: [Number; TERMS],
    motion: MotionSeries<Number, TERMS>,
    /// Coefficients of θ̈, divided by t where it is zero at the start.
    off_zero: [Number; TERMS],
}

impl<const TERMS: usize> Default for Series<TERMS> {
    fn default() -> Self {
        let zero = [number(0.0); TERMS];
        Series { tape: Tape::default(), ground: zero, motion: MotionSeries::default(), off_zero: zero }
    }
}

impl<const TERMS: usize> Series<TERMS> {
    /// Coefficients of θ̈ and of the ground motion.
    pub const RATES: usize = TERMS - 2;

    /// Coefficients of θ.
    #[inline(always)]
    pub fn rotation(&self) -> &[Number; TERMS] {
        &self.motion.rotation
    }

    /// When, in (0, `length`], the block in `lane` passes |θ| = `limit` (rad), at which it overturns.
    pub fn passes(&self, lane: usize, length: f64, limit: f64) -> f64 {
        let sum = |series: &[Number], time: f64| series.iter().rev().fold(0.0, |sum, c| sum * time + c.0[lane]);
        if self.rotation()[0].0[lane] >= limit {
            return 0.0;
        }
        newton_bracketed(0.0, length, Sign::Negative, length, |time| {
            (sum(self.rotation(), time) - limit, sum(self.velocity(), time))
        })
    }

    /// Coefficients of θ̇.
    #[inline(always)]
    pub fn velocity(&self) -> &[Number] {
        &self.motion.velocity[..TERMS - 1]
    }

    /// Coefficients of θ̈.
    #[inline(always)]
    pub fn acceleration(&self) -> &[Number] {
        &self.motion.acceleration[..Self::RATES]
    }

    /// Coefficients of θ̈, divided by t where it is zero at the start.
    #[inline(always)]
    pub fn acceleration_off_zero(&self) -> &[Number] {
        &self.off_zero[..Self::RATES]
    }

    /// The series about θ (`rotation`, rad) and θ̇ (`velocity`) of blocks on the positive side; where `at_zero`, θ̈ is zero now because
    /// an event was located on it.
    #[inline(always)]
    pub fn expand<E: Equation<Number>>(&mut self, equation: &E, rotation: Number, velocity: Number, at_zero: Mask) {
        self.motion.start(&self.tape, rotation, velocity);
        // A loop around sums of few products takes longer than the products; written out, many orders would not stay in a cache.
        const WRITTEN_OUT: usize = 8;
        macro_rules! write_out {
            ($($k:literal)+) => { $(if $k < Self::RATES { self.order(equation, $k, at_zero) })+ };
        }
        if Self::RATES <= WRITTEN_OUT {
            write_out!(0 1 2 3 4 5 6 7);
        } else {
            for k in 0..Self::RATES {
                self.order(equation, k, at_zero);
            }
        }
        let last = Self::RATES - 1;
        self.off_zero[last] = at_zero.choose(number(0.0), self.motion.acceleration[last]);
    }

    /// Adds coefficient `k` of θ̈.
    #[inline(always)]
    fn order<E: Equation<Number>>(&mut self, equation: &E, k: usize, at_zero: Mask) {
        // θ, θ̇ and the ground are the first three nodes.
        let next = Cell::new(3);
        let tape = &self.tape;
        tape.set(2, k, self.ground[k]);
        let (theta, omega, push) = (tape.given(&next, k, 0), tape.given(&next, k, 1), tape.given(&next, k, 2));
        let node = equation.acceleration(number(1.0), theta, omega, push);
        if k == 0 {
            node.set_last(at_zero.choose(number(0.0), node.last()));
        } else {
            self.off_zero[k - 1] = at_zero.choose(node.last(), self.motion.acceleration[k - 1]);
        }
        self.motion.extend(tape, k, node.last());
    }

    /// How far the last two terms of θ stay below `tolerance` (rad; Jorba and Zou's two-term rule).
    #[inline(always)]
    pub fn reach(&self, tolerance: Number) -> Number {
        let along = |order: usize| along(self.motion.rotation[order], order, tolerance);
        along(TERMS - 1).smaller(along(TERMS - 2)) * number(0.95)
    }
}

/// How far the term of this `coefficient` and `order` stays below `tolerance`; to about 7 %.
#[inline(always)]
pub(crate) fn along(coefficient: Number, order: usize, tolerance: Number) -> Number {
    // Above zero, so that the ratio is finite.
    let last = coefficient.abs() + number(f64::MIN_POSITIVE / f64::EPSILON);
    rough_power(tolerance / last, RECIPROCALS[order & 63])
}

/// x to the `exponent` (0 to 1) to about 7 %, for choosing step sizes only: as [`sprag_shared::math::scalar::Real::rough_power`], from the
/// high halves of the bits, for which registers have conversions to doubles. None has Rust's back, which saturates.
#[inline(always)]
fn rough_power(x: Number, exponent: f64) -> Number {
    const ONE: i32 = 0x3ff0_0000;
    // Added to this, 1.5 × 2⁵², a number loses its fraction, and its low half is the whole number.
    const WHOLE: f64 = 6_755_399_441_055_744.0;
    let mut power = x;
    for value in &mut power.0 {
        let high = (value.to_bits() >> 32) as i32;
        let scaled = f64::from(high - ONE) * exponent;
        let nearest = (scaled + WHOLE) - WHOLE;
        let beyond = if nearest.abs() > scaled.abs() { 1.0_f64.copysign(scaled) } else { 0.0 };
        let towards_zero = (nearest - beyond + WHOLE).to_bits();
        *value = f64::from_bits((towards_zero + ONE as u64) << 32);
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprag_shared::math;

    #[test]
    fn rough_power_is_close_enough_for_a_step_size() {
        for base in [1e-200_f64, 1e-9, 0.3, 1.0, 7.0, 1e200] {
            for exponent in [1.0 / 15.0, 1.0 / 8.0] {
                let power = rough_power(number(base), exponent).0[3];
                let high = (base.to_bits() >> 32) as i32 - 0x3ff0_0000;
                let converted = (f64::from(high) * exponent) as i32 + 0x3ff0_0000;
                assert_eq!(power.to_bits(), (converted as u64) << 32, "{base}^{exponent}");
                assert!((power / math::pow(base, exponent) - 1.0).abs() < 0.07, "{base}^{exponent}: {power}");
            }
        }
    }
}
