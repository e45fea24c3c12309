//! Taylor method of variable order and step: the power series of the solution over each step.
//!
//! [`super::motion_series`] has the recurrence.

use core::cell::Cell;

use super::dense_output::{DenseOutput, Integrator, StepStart};
use super::motion_series::{StepSeries, Truncation};
use crate::equation::any_equation::WithEquation;
use crate::equation::motion::Motion;
use crate::equation::switched::Switched;
use crate::math::polynomial;
use crate::math::power_series::{MAXIMUM_ORDER, SLOTS, Tape};
use crate::math::scalar::Real;
use crate::math::sign::Sign;

/// Coefficients of the series that is fastest at tight accuracy in f64 (`cargo bench --bench cells`).
pub const TERMS: usize = 20;

/// A Taylor method with `N` coefficients for each quantity (8 to 32), and the tape it works on. One per thread: it is
/// scratch space, not state.
pub struct Taylor<S, const N: usize, const SLOTS: usize = { self::SLOTS }> {
    pub(crate) tape: Tape<S, N, SLOTS>,
    pub(crate) tolerance: S,
    pub(crate) step: Option<S>,
}

impl<S: Real, const N: usize, const SLOTS: usize> Taylor<S, N, SLOTS> {
    /// Steps of its own choice: as long as the series' last terms stay below `tolerance` times the rotation that
    /// matters (α, or |θ| where larger). 1e-17 is tight in f64; from 1e-20 to 1e-2.
    pub fn adaptive(tolerance: S) -> Self {
        const { assert!(N >= 8 && N <= MAXIMUM_ORDER) };
        Taylor { tape: Tape::default(), tolerance, step: None }
    }

    /// Fixed steps of `step` s (above 0), order N − 2: θ̇ has one coefficient less than θ.
    pub fn fixed(step: S) -> Self {
        Taylor { step: Some(step), ..Self::adaptive(S::ZERO) }
    }
}

/// Dense output of one step as power series.
#[derive(Clone, Copy, Debug)]
pub struct TaylorOutput<S, const N: usize> {
    series: StepSeries<S, N>,
    /// Coefficients of the switching function, where it is not the acceleration.
    switching: [S; N],
    /// Bound of d²θ̈/dt² over the step.
    curvature: S,
}

impl<S: Real, const N: usize> Integrator<S> for Taylor<S, N> {
    type Output<'a> = TaylorOutput<S, N>;

    #[inline]
    fn integrate<'a>(&'a self, start: &'a StepStart<'a, S>) -> TaylorOutput<S, N> {
        let none = [S::ZERO; N];
        let mut output = TaylorOutput { series: StepSeries::new(start.length), switching: none, curvature: S::ZERO };
        let mut ground = none;
        start.segment.series(start.time, &mut ground);
        let tolerance = self.tolerance * start.scale.larger(start.rotation.abs());
        start.equation.known(Expansion { tape: &self.tape, output: &mut output, ground: &ground, start, tolerance });
        let series = &mut output.series;
        if self.step.is_none() && series.terms == N {
            for order in [N - 2, N - 1] {
                series.shorten(order, series.motion.rotation[order].abs(), tolerance);
            }
        }
        output.curvature = polynomial::curvature_bound(series.acceleration(), series.length);
        output
    }

    fn step(&self) -> Option<S> {
        self.step
    }
}

/// The coefficients of a step's power series, order by order.
struct Expansion<'a, S, const N: usize> {
    tape: &'a Tape<S, N>,
    output: &'a mut TaylorOutput<S, N>,
    ground: &'a [S; N],
    start: &'a StepStart<'a, S>,
    tolerance: S,
}

impl<S: Real, const N: usize> WithEquation<S> for Expansion<'_, S, N> {
    type Output = ();

    #[inline(always)]
    fn with<E: Switched<S>>(self, equation: &E) {
        // θ, θ̇ and the ground are the first three nodes.
        const GIVEN: usize = 3;
        let Expansion { tape, output, ground, start, tolerance } = self;
        let side = start.side.unit();
        let next = Cell::new(GIVEN);
        output.series.motion.start(tape, start.rotation, start.velocity);
        let mut truncation = Truncation::new(start.length, tolerance);
        for (k, &push) in ground.iter().enumerate().take(N - 2) {
            tape.set(2, k, push);
            next.set(GIVEN);
            let given = |slot| tape.given(&next, k, slot);
            let (theta, omega, shaking) = (given(0), given(1), given(2));
            let node = equation.acceleration(side, theta, omega, shaking);
            if k == 0
                && let Some(known) = start.acceleration
            {
                node.set_last(known);
            }
            if !equation.switches_with_acceleration() {
                output.switching[k] = equation.switching(side, theta, omega, shaking).last();
            }
            let rotation = output.series.motion.extend(tape, k, node.last());
            if truncation.ends_at(k, truncation.term(rotation, push)) {
                output.series.terms = k + 3;
                break;
            }
        }
    }
}

impl<S: Real, const N: usize> TaylorOutput<S, N> {
    fn switching_series(&self) -> &[S] {
        &self.switching[..self.series.acceleration().len()]
    }
}

impl<S: Real, const N: usize> DenseOutput<S> for TaylorOutput<S, N> {
    fn length(&self) -> S {
        self.series.length
    }

    #[inline]
    fn at(&self, time: S) -> Motion<S> {
        self.series.at(time)
    }

    #[inline]
    fn switching(&self, time: S) -> S {
        polynomial::value(self.switching_series(), time)
    }

    #[inline]
    fn acceleration_zero(&self, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        polynomial::first_zero(self.series.acceleration(), self.curvature, from, to, sign, from_zero)
    }

    #[inline]
    fn switching_zero(&self, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        let coefficients = self.switching_series();
        polynomial::first_zero(coefficients, polynomial::curvature_bound(coefficients, to), from, to, sign, from_zero)
    }

    #[inline]
    fn largest_acceleration(&self, from: (S, S), to: (S, S), floor: S) -> S {
        polynomial::largest_magnitude(self.series.acceleration(), self.curvature, from, to, floor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equation::FullBlock;
    use crate::equation::any_equation::AnyEquation;
    use crate::ground::Harmonics;

    /// The bound that the search for zeros rests on holds, and uses every coefficient of the step: it is that of the whole series.
    #[test]
    fn the_curvature_bound_covers_the_whole_series() {
        let equation = AnyEquation::Block(FullBlock { frequency_squared: 1.0, slenderness: 0.3 });
        let segment = Harmonics::sine(2.0, 5.0);
        for time in [0.1, 0.5, 1.0] {
            let start = StepStart {
                equation: &equation,
                segment: &segment,
                side: Sign::Positive,
                rotation: 0.1,
                velocity: 0.2,
                time,
                length: 10.0,
                acceleration: None,
                scale: 0.3,
            };
            let output = Taylor::<f64, 20>::adaptive(1e-15).integrate(&start);
            let (length, step) = (output.length(), 1e-3 * output.length());
            let rate = |time: f64| output.at(time).acceleration;
            let mut largest = 0.0_f64;
            for k in 1..1000 {
                let t = f64::from(k) * step;
                largest = largest.max(((rate(t + step) - 2.0 * rate(t) + rate(t - step)) / (step * step)).abs());
            }
            assert!(output.curvature >= largest * (1.0 - 1e-6), "{} < {largest}", output.curvature);
            assert_eq!(output.curvature, polynomial::curvature_bound(&output.series.motion.acceleration, length));
        }
    }
}
