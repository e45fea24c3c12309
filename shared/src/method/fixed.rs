//! Fixed-step methods: semi-implicit Euler and the classical Runge-Kutta method of order 4.
//!
//! Events inside a step are located by taking the step again with a shorter length, so an event's state has the accuracy
//! of the method.
//!
//! For a block with a device, the same methods are in [`crate::motion::hybrid::steps`].

use super::dense_output::{DenseOutput, Integrator, StepStart};
use crate::equation::Equation;
use crate::equation::any_equation::WithEquation;
use crate::equation::motion::Motion;
use crate::equation::switched::Switched;
use crate::math::scalar::{Real, Scalar};

/// Fixed-step method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedStep<S> {
    /// Scheme of a step.
    pub scheme: Scheme,
    /// Step, s (above 0).
    pub step: S,
}

/// Scheme of a fixed step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// Semi-implicit (symplectic) Euler: velocities first, then positions with the new velocities. Order 1.
    SemiImplicitEuler,
    /// The classical Runge-Kutta method. Order 4.
    RungeKutta4,
    /// The exponential midpoint method ([`crate::motion::hybrid::exponential`]) for elastic clutches, order 2; for all other devices the
    /// Runge-Kutta method.
    ExponentialMidpoint,
}

/// One step of the classical Runge-Kutta method of length `h` for θ̈ = f(θ, θ̇, ü), where `ground` holds ü_g/g at the
/// start, the middle and the end, and `first` is f at the start. Written over [`Scalar`], so that SIMD lanes take it too.
#[inline(always)]
pub fn runge_kutta_4<S: Scalar, E: Equation<S>>(
    equation: &E,
    side: S,
    (rotation, velocity): (S, S),
    first: S,
    ground: [S; 3],
    h: S,
) -> (S, S) {
    let half = S::of(0.5) * h;
    let sixth = h * S::of(1.0 / 6.0);
    let f = |theta: S, omega: S, push: S| equation.acceleration(side, theta, omega, push);
    let omega_2 = velocity + half * first;
    let a_2 = f(rotation + half * velocity, omega_2, ground[1]);
    let omega_3 = velocity + half * a_2;
    let a_3 = f(rotation + half * omega_2, omega_3, ground[1]);
    let omega_4 = velocity + h * a_3;
    let a_4 = f(rotation + h * omega_3, omega_4, ground[2]);
    let two = S::of(2.0);
    (rotation + sixth * (velocity + two * (omega_2 + omega_3) + omega_4), velocity + sixth * (first + two * (a_2 + a_3) + a_4))
}

/// Dense output of a fixed-step method: its end, and the step taken again for every time before it.
pub struct FixedOutput<'a, S> {
    scheme: Scheme,
    start: &'a StepStart<'a, S>,
    first: S,
    end: Motion<S>,
}

impl<'a, S: Real> FixedOutput<'a, S> {
    pub(crate) fn new(scheme: Scheme, start: &'a StepStart<'a, S>) -> Self {
        let first = start.first_acceleration(start.equation);
        let end = Self::motion(scheme, start, first, start.length);
        FixedOutput { scheme, start, first, end }
    }

    #[inline(never)]
    fn motion(scheme: Scheme, start: &StepStart<'a, S>, first: S, time: S) -> Motion<S> {
        start.equation.known(Step { scheme, start, first, time })
    }
}

/// One step of length `time`, where θ̈ at the start is `first`.
struct Step<'s, 'a, S> {
    scheme: Scheme,
    start: &'s StepStart<'a, S>,
    first: S,
    time: S,
}

impl<S: Real> WithEquation<S> for Step<'_, '_, S> {
    type Output = Motion<S>;

    #[inline(always)]
    fn with<E: Switched<S>>(self, equation: &E) -> Motion<S> {
        let Step { scheme, start, first, time } = self;
        let side = start.side.unit();
        let push = start.segment.acceleration(start.time + time);
        let (rotation, velocity) = match scheme {
            Scheme::SemiImplicitEuler => {
                let velocity = start.velocity + time * first;
                (start.rotation + time * velocity, velocity)
            }
            Scheme::RungeKutta4 | Scheme::ExponentialMidpoint => {
                let ground = [S::ZERO, start.segment.acceleration(start.time + S::HALF * time), push];
                runge_kutta_4(equation, side, (start.rotation, start.velocity), first, ground, time)
            }
        };
        Motion { rotation, velocity, acceleration: equation.acceleration(side, rotation, velocity, push) }
    }
}

impl<S: Real> DenseOutput<S> for FixedOutput<'_, S> {
    fn length(&self) -> S {
        self.start.length
    }

    fn at(&self, time: S) -> Motion<S> {
        if time == S::ZERO {
            return Motion { rotation: self.start.rotation, velocity: self.start.velocity, acceleration: self.first };
        }
        if time == self.start.length { self.end } else { Self::motion(self.scheme, self.start, self.first, time) }
    }

    fn evaluated_end(&self) -> Option<S> {
        Some(self.end.acceleration)
    }

    fn switching(&self, time: S) -> S {
        let motion = self.at(time);
        let push = self.start.segment.acceleration(self.start.time + time);
        self.start.equation.switching(self.start.side.unit(), motion.rotation, motion.velocity, push)
    }
}

impl<S: Real> Integrator<S> for FixedStep<S> {
    type Output<'a> = FixedOutput<'a, S>;

    fn integrate<'a>(&'a self, start: &'a StepStart<'a, S>) -> Self::Output<'a> {
        FixedOutput::new(self.scheme, start)
    }

    fn step(&self) -> Option<S> {
        Some(self.step)
    }
}
