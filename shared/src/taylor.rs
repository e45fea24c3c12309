//! The Taylor method: the solution's own power series over each step, and with it events to the last bits.
//!
//! The equation of motion, evaluated over the nodes of a [`Tape`], gives θ̈ = Σ a_k t^k one coefficient at a time, and θ's own
//! follow from it: v_{k+1} = a_k/(k+1), θ_{k+2} = v_{k+1}/(k+2).

use core::cell::Cell;

use crate::any_equation::WithEquation;
use crate::arc::{Arc, Method, Motion, Start};
use crate::detected::Switched;
use crate::math::RECIPROCALS;
use crate::polynomial;
use crate::scalar::{Real, Sign};
use crate::tape::{MAXIMUM_ORDER, Tape};

/// A Taylor method with `N` coefficients for each quantity (8 to 32), and the tape it works on. One per thread: it is
/// scratch space, not state.
pub struct Taylor<S, const N: usize> {
    tape: Tape<S, N>,
    tolerance: S,
    step: Option<S>,
}

impl<S: Real, const N: usize> core::fmt::Debug for Taylor<S, N> {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter
            .debug_struct("Taylor")
            .field("order", &(N - 1))
            .field("tolerance", &self.tolerance)
            .field("step", &self.step)
            .finish()
    }
}

impl<S: Real, const N: usize> Taylor<S, N> {
    /// Steps of its own choice: as long as the series' last terms stay below `tolerance` times the rotation that
    /// matters (α, or |θ| where larger). 1e-17 is tight in f64; from 1e-20 to 1e-2.
    pub fn adaptive(tolerance: S) -> Self {
        const { assert!(N >= 8 && N <= MAXIMUM_ORDER) };
        Taylor { tape: Tape::default(), tolerance, step: None }
    }

    /// Fixed steps of `step` s (above 0), order N − 2: θ̇ has one coefficient less than θ.
    pub fn fixed(step: S) -> Self {
        Taylor { step: Some(step), ..Taylor::adaptive(S::ZERO) }
    }
}

/// The series of one step.
#[derive(Clone, Copy, Debug)]
pub struct TaylorArc<S, const N: usize> {
    length: S,
    /// Coefficients in use, of θ.
    terms: usize,
    rotation: [S; N],
    velocity: [S; N],
    acceleration: [S; N],
    /// Of the switching function, where it is not the acceleration.
    switching: [S; N],
    /// Bound of d²θ̈/dt² over the arc.
    curvature: S,
}

impl<S: Real, const N: usize> Method<S> for Taylor<S, N> {
    type Arc<'a> = TaylorArc<S, N>;

    #[inline]
    fn arc<'a>(&'a self, start: Start<'a, S>) -> TaylorArc<S, N> {
        let mut arc = TaylorArc {
            length: start.length,
            terms: N,
            rotation: [S::ZERO; N],
            velocity: [S::ZERO; N],
            acceleration: [S::ZERO; N],
            switching: [S::ZERO; N],
            curvature: S::ZERO,
        };
        let mut ground = [S::ZERO; N];
        start.piece.series(start.time, &mut ground);
        arc.rotation[0] = start.rotation;
        arc.rotation[1] = start.velocity;
        arc.velocity[0] = start.velocity;
        let tolerance = self.tolerance * start.scale.larger(start.rotation.abs());
        let (side, length) = (start.side.unit(), start.length);
        let in_balance = start.acceleration_is_zero;
        start.equation.known(Expansion { tape: &self.tape, arc: &mut arc, ground: &ground, side, tolerance, in_balance });
        if self.step.is_none() && arc.terms == N {
            arc.length = self.reach(&arc, tolerance, length);
        }
        arc.curvature = polynomial::curvature_bound(&arc.acceleration[..arc.terms.min(N) - 2], arc.length);
        arc
    }

    #[inline(always)]
    fn step(&self) -> Option<S> {
        self.step
    }
}

/// The coefficients of an arc, order by order.
struct Expansion<'a, S, const N: usize> {
    tape: &'a Tape<S, N>,
    arc: &'a mut TaylorArc<S, N>,
    ground: &'a [S; N],
    side: S,
    tolerance: S,
    /// θ̈ is zero at the start.
    in_balance: bool,
}

impl<S: Real, const N: usize> WithEquation<S> for Expansion<'_, S, N> {
    type Output = ();

    #[inline(always)]
    fn with<E: Switched<S>>(self, equation: &E) {
        // θ, θ̇ and the ground are the first three nodes.
        const GIVEN: usize = 3;
        let Expansion { tape, arc, ground, side, tolerance, in_balance } = self;
        let next = Cell::new(GIVEN);
        tape.set(0, 0, arc.rotation[0]);
        tape.set(0, 1, arc.rotation[1]);
        tape.set(1, 0, arc.velocity[0]);
        let length = arc.length;
        let mut power = length * length;
        let mut previous = S::ONE;
        let mut push_power = S::ONE;
        for k in 0..N - 2 {
            tape.set(2, k, ground[k]);
            next.set(GIVEN);
            let given = |slot| tape.given(&next, k, slot);
            let (theta, omega, push) = (given(0), given(1), given(2));
            let node = equation.acceleration(side, theta, omega, push);
            let mut a = node.last();
            if k == 0 && in_balance {
                a = S::ZERO;
                node.set_last(a);
            }
            if !equation.switches_with_acceleration() {
                arc.switching[k] = equation.switching(side, theta, omega, push).last();
            }
            let v = a * S::of(RECIPROCALS[(k + 1) & 63]);
            let c = v * S::of(RECIPROCALS[(k + 2) & 63]);
            arc.acceleration[k] = a;
            arc.velocity[k + 1] = v;
            arc.rotation[k + 2] = c;
            tape.set(1, k + 1, v);
            tape.set(0, k + 2, c);

            // Two small terms in a row (every other one may vanish by symmetry) leave nothing that matters behind them, unless
            // the ground's own series goes on: at resonance it cancels against the block's for an order or two.
            let term = (c * power).abs().larger((ground[k] * push_power).abs());
            if k >= 3 && term <= tolerance && previous <= tolerance * S::of(50.0) {
                arc.terms = k + 3;
                break;
            }
            previous = term;
            push_power = push_power * length;
            power = power * length;
        }
    }
}

impl<S: Real, const N: usize> Taylor<S, N> {
    /// How far the last two terms of θ stay below the tolerance (Jorba and Zou's two-term rule), at most `length`.
    fn reach(&self, arc: &TaylorArc<S, N>, tolerance: S, length: S) -> S {
        let mut reach = length;
        for (order, coefficient) in [(N - 2, arc.rotation[N - 2]), (N - 1, arc.rotation[N - 1])] {
            if coefficient != S::ZERO {
                let exponent = S::of(RECIPROCALS[order & 63]);
                let ratio = (tolerance / coefficient.abs()).larger(S::SMALLEST);
                reach = reach.smaller(ratio.rough_power(exponent) * S::of(0.95));
            }
        }
        reach
    }
}

impl<S: Real, const N: usize> Arc<S> for TaylorArc<S, N> {
    #[inline(always)]
    fn length(&self) -> S {
        self.length
    }

    #[inline]
    fn at(&self, time: S) -> Motion<S> {
        if time == S::ZERO {
            return Motion { rotation: self.rotation[0], velocity: self.velocity[0], acceleration: self.acceleration[0] };
        }
        let n = self.terms.min(N);
        Motion {
            rotation: polynomial::value(&self.rotation[..n], time),
            velocity: polynomial::value(&self.velocity[..n - 1], time),
            acceleration: polynomial::value(&self.acceleration[..n - 2], time),
        }
    }

    #[inline]
    fn switching(&self, time: S) -> S {
        polynomial::value(&self.switching[..self.terms.min(N) - 2], time)
    }

    #[inline]
    fn acceleration_zero(&self, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        polynomial::first_zero(&self.acceleration[..self.terms.min(N) - 2], self.curvature, from, to, sign, from_zero)
    }

    #[inline]
    fn switching_zero(&self, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        let coefficients = &self.switching[..self.terms.min(N) - 2];
        polynomial::first_zero(coefficients, polynomial::curvature_bound(coefficients, to), from, to, sign, from_zero)
    }

    #[inline]
    fn largest_acceleration(&self, from: (S, S), to: (S, S), floor: S) -> S {
        polynomial::largest_magnitude(&self.acceleration[..self.terms.min(N) - 2], self.curvature, from, to, floor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::any_equation::AnyEquation;
    use crate::equation::FullBlock;
    use crate::ground::Harmonics;

    /// The bound that the search for zeros rests on holds, and uses every coefficient of the step: it is that of the whole series.
    #[test]
    fn the_curvature_bound_covers_the_whole_series() {
        let equation = AnyEquation::Block(FullBlock { frequency_squared: 1.0, slenderness: 0.3 });
        let piece = Harmonics::sine(2.0, 5.0);
        for time in [0.1, 0.5, 1.0] {
            let start = Start {
                equation: &equation,
                piece: &piece,
                side: Sign::Positive,
                rotation: 0.1,
                velocity: 0.2,
                time,
                length: 10.0,
                acceleration_is_zero: false,
                scale: 0.3,
            };
            let arc = Taylor::<f64, 20>::adaptive(1e-15).arc(start);
            let (length, step) = (arc.length(), 1e-3 * arc.length());
            let rate = |time: f64| arc.at(time).acceleration;
            let mut largest = 0.0_f64;
            for k in 1..1000 {
                let t = f64::from(k) * step;
                largest = largest.max(((rate(t + step) - 2.0 * rate(t) + rate(t - step)) / (step * step)).abs());
            }
            assert!(arc.curvature >= largest * (1.0 - 1e-6), "{} < {largest}", arc.curvature);
            assert_eq!(arc.curvature, polynomial::curvature_bound(&arc.acceleration, length));
        }
    }
}
