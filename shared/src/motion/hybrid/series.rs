//! The Taylor method for a block with a device: one power series for every unknown and every guard
//! ([`crate::method::taylor`]).

use core::cell::Cell;

use super::mode_output::{KnownModeStart, ModeIntegrator, ModeOutput, ModeStart, WithModeStart};
use crate::drivetrain::clutch_state::{GUARDS, Guard, UNKNOWNS};
use crate::drivetrain::transmission::{EvaluationPoint, Transmission};
use crate::equation::Accelerations;
use crate::equation::body::Body;
use crate::equation::motion::Motion;
use crate::math::power_series::{DEVICE_SLOTS, Tape};
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::{RECIPROCALS, polynomial};
use crate::method::dense_output::DenseOutput;
use crate::method::motion_series::{StepSeries, Truncation};
use crate::method::taylor::Taylor;

/// Last terms that are left of [`Guard::Below`], over the square of the plates' capacity: by so much a force may exceed it.
const ABOVE_CAPACITY: f64 = 1e-7;

/// [`Taylor`] with a tape for a device's unknowns and guards.
pub type Series<S, const N: usize> = Taylor<S, N, DEVICE_SLOTS>;

/// Mode output of one step as power series.
#[derive(Clone, Copy, Debug)]
pub struct SeriesModeOutput<S, const N: usize> {
    series: StepSeries<S, N>,
    unknowns: [[S; N]; UNKNOWNS],
    guards: [[S; N]; GUARDS],
}

/// The coefficients of a step's power series, order by order.
struct Expansion<'a, S, const N: usize> {
    tape: &'a Tape<S, N, DEVICE_SLOTS>,
    output: &'a mut SeriesModeOutput<S, N>,
    /// Accelerations of ground and support.
    ground: &'a Accelerations<[S; N]>,
    /// [`Series::tolerance`] in rad.
    tolerance: S,
    /// Size of a rotation that matters, rad.
    scale: S,
}

impl<S: Real, const N: usize> WithModeStart<S> for Expansion<'_, S, N> {
    /// The size of each unknown that matters.
    type Output = [S; UNKNOWNS];

    #[inline(always)]
    fn with<B: Body<S>, D: Transmission<S, X, G>, const X: usize, const G: usize>(
        self,
        known: &KnownModeStart<'_, S, B, D, X, G>,
    ) -> Self::Output {
        // θ, θ̇, the ground twice and the clock, then the device's unknowns.
        const GIVEN: usize = 5;
        let Expansion { tape, output, ground: [ground, vertical, support], tolerance, scale } = self;
        let start = known.start;
        let parameters = &start.system.transmission.parameters;
        let (shaken_up, supported) = (start.shaking.vertical.is_some(), parameters.relative_push != S::ZERO);
        // A support of its own motion is the last of what is given.
        let given_count = GIVEN + X + usize::from(supported);
        let next = Cell::new(given_count);
        let side = start.side.unit();
        output.series.motion.start(tape, start.place.rotation, start.place.velocity);
        for (i, unknown) in output.unknowns.iter_mut().enumerate().take(X) {
            unknown[0] = start.place.unknowns[i];
            tape.set(GIVEN + i, 0, start.place.unknowns[i]);
        }
        let sizes = known.transmission.scales(parameters, start.system.speed);
        let mut truncation = Truncation::new(start.length, tolerance);
        for k in 0..N - 2 {
            tape.set(2, k, ground[k]);
            if shaken_up {
                tape.set(3, k, vertical[k]);
            }
            tape.set(4, k, if k == 1 { S::ONE } else { S::ZERO });
            if supported {
                tape.set(GIVEN + X, k, support[k]);
            }
            next.set(given_count);
            let given = |slot| tape.given(&next, k, slot);
            let (theta, omega, push) = (given(0), given(1), given(2));
            let up = if shaken_up { given(3) } else { push };
            let at = EvaluationPoint {
                body: known.body,
                parameters,
                law: start.law,
                configuration: known.body.configuration(side, theta),
                velocity: omega,
                unknowns: core::array::from_fn(|i| given(GIVEN + i)),
                ground: [push, up, if supported { given(GIVEN + X) } else { push }],
                clock: given(4),
            };
            let (acceleration, rates) = known.transmission.flow(&at);
            if k == 0 {
                acceleration.set_last(start.first(acceleration.last()));
            }
            let a = if known.is_held() { S::ZERO } else { acceleration.last() };
            let reciprocal = S::of(RECIPROCALS[(k + 1) & 63]);
            let rotation = output.series.motion.extend(tape, k, a);
            let mut term = truncation.term(rotation, ground[k]);
            if shaken_up {
                term = term.larger((vertical[k] * truncation.power).abs());
            }
            if supported {
                term = term.larger((support[k] * truncation.power).abs());
            }
            for (i, rate) in rates.iter().enumerate() {
                let coefficient = rate.last() * reciprocal;
                output.unknowns[i][k + 1] = coefficient;
                tape.set(GIVEN + i, k + 1, coefficient);
                term = term.larger((coefficient * truncation.power * start.length).abs() * (scale / sizes[i]));
            }
            for (i, guard) in output.guards.iter_mut().enumerate().take(G) {
                let watch = start.law.watch[i];
                if watch != Guard::Nothing {
                    guard[k] = known.transmission.guard(&at, acceleration, watch).last();
                }
            }
            if truncation.ends_at(k, term) {
                output.series.terms = k + 3;
                break;
            }
        }
        core::array::from_fn(|i| sizes.get(i).copied().unwrap_or(S::ONE))
    }
}

impl<S: Real, const N: usize> ModeIntegrator<S> for Series<S, N> {
    type Output<'a> = SeriesModeOutput<S, N>;

    #[inline(never)]
    fn integrate<'a>(&'a self, start: &'a ModeStart<'a, S>) -> SeriesModeOutput<S, N> {
        let none = [S::ZERO; N];
        let mut output =
            SeriesModeOutput { series: StepSeries::new(start.length), unknowns: [none; UNKNOWNS], guards: [none; GUARDS] };
        let mut ground = [none; 3];
        start.shaking.horizontal.series(start.time, &mut ground[0]);
        if let Some(segment) = start.shaking.vertical {
            segment.series(start.time, &mut ground[1]);
        }
        if let Some(segment) = start.shaking.support {
            segment.series(start.time, &mut ground[2]);
        }
        let scale = start.system.slenderness.larger(start.place.rotation.abs());
        let tolerance = self.tolerance * scale;
        let sizes = start.known(Expansion { tape: &self.tape, output: &mut output, ground: &ground, tolerance, scale });
        let SeriesModeOutput { series, unknowns, guards } = &mut output;
        if self.step.is_none() && series.terms == N {
            // Every unknown counts; those of the first order have one coefficient fewer.
            for order in [N - 2, N - 1] {
                series.shorten(order, series.motion.rotation[order].abs(), tolerance);
                if start.system.transmission.parameters.relative_push != S::ZERO {
                    // A support that swings fast shows in the guards before it shows in θ.
                    series.shorten(order - 2, ground[2][order - 2].abs(), tolerance);
                }
                for (unknown, &size) in unknowns.iter().zip(&sizes) {
                    series.shorten(order - 1, unknown[order - 1].abs() * (scale / size), tolerance);
                }
            }
        }
        let capacity = start.system.transmission.parameters.capacity;
        if self.step.is_none() && capacity.is_finite() {
            // The square of a force needs more terms than the force.
            let terms = series.acceleration().len();
            let squares = guards.iter().zip(&start.law.watch).filter(|(_, watch)| matches!(watch, Guard::Below(..)));
            for (guard, _) in squares {
                for order in [terms - 2, terms - 1] {
                    series.shorten(order, guard[order].abs(), S::of(ABOVE_CAPACITY) * capacity * capacity);
                }
            }
        }
        output
    }

    fn step(&self) -> Option<S> {
        self.step
    }
}

impl<S: Real, const N: usize> DenseOutput<S> for SeriesModeOutput<S, N> {
    fn length(&self) -> S {
        self.series.length
    }

    #[inline(never)]
    fn at(&self, time: S) -> Motion<S> {
        self.series.at(time)
    }

    #[inline]
    fn largest_acceleration(&self, from: (S, S), to: (S, S), floor: S) -> S {
        let coefficients = self.series.acceleration();
        let curvature = polynomial::curvature_bound(coefficients, self.series.length);
        polynomial::largest_magnitude(coefficients, curvature, from, to, floor)
    }
}

#[inline(never)]
fn zero<S: Real>(coefficients: &[S], to: S, sign: Sign, from_zero: bool) -> Option<S> {
    polynomial::first_zero(coefficients, polynomial::curvature_bound(coefficients, to), S::ZERO, to, sign, from_zero)
}

impl<S: Real, const N: usize> ModeOutput<S> for SeriesModeOutput<S, N> {
    #[inline(never)]
    fn unknowns(&self, time: S) -> [S; UNKNOWNS] {
        let n = self.series.velocity().len();
        core::array::from_fn(|i| polynomial::value(&self.unknowns[i][..n], time))
    }

    #[inline(never)]
    fn guard(&self, index: usize, time: S) -> S {
        let n = self.series.acceleration().len();
        self.guards.get(index).map_or(S::ONE, |guard| polynomial::value(&guard[..n], time))
    }

    #[inline]
    fn velocity_zero(&self, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        zero(self.series.velocity(), to, sign, from_zero)
    }

    #[inline]
    fn guard_zero(&self, index: usize, to: S, from_zero: bool) -> Option<S> {
        let guard = self.guards.get(index)?;
        zero(&guard[..self.series.acceleration().len()], to, Sign::Positive, from_zero)
    }

    #[inline]
    fn unknown_zero(&self, index: usize, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        let unknown = self.unknowns.get(index)?;
        zero(&unknown[..self.series.velocity().len()], to, sign, from_zero)
    }
}
