//! Fixed-step methods: semi-implicit Euler and the classical Runge-Kutta method of order 4.
//!
//! Events inside a step are located by taking the step again with a shorter length, so an event's state has the accuracy
//! of the method.

use core::marker::PhantomData;

use crate::any_equation::WithEquation;
use crate::arc::{Arc, Method, Motion, Start};
use crate::detected::Switched;
use crate::equation::Equation;
use crate::scalar::{Real, Scalar};

/// Semi-implicit (symplectic) Euler: θ̇ first, then θ with the new θ̇. Order 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SemiImplicitEuler<S> {
    /// Step, s; above 0.
    pub step: S,
}

/// The classical Runge-Kutta method. Order 4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RungeKutta4<S> {
    /// Step, s; above 0.
    pub step: S,
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

/// How a fixed-step method gets from the start of a step to a time within it.
pub trait Advance<S: Real> {
    /// θ and θ̇ a time `h` after `start`, where θ̈ of `equation`, which is the start's, is `first`.
    fn advance<E: Equation<S>>(equation: &E, start: &Start<'_, S>, first: S, h: S) -> (S, S);

    /// The step, s.
    fn step(&self) -> S;
}

impl<S: Real> Advance<S> for SemiImplicitEuler<S> {
    #[inline(always)]
    fn advance<E: Equation<S>>(_equation: &E, start: &Start<'_, S>, first: S, h: S) -> (S, S) {
        let velocity = start.velocity + h * first;
        (start.rotation + h * velocity, velocity)
    }

    #[inline(always)]
    fn step(&self) -> S {
        self.step
    }
}

impl<S: Real> Advance<S> for RungeKutta4<S> {
    #[inline(always)]
    fn advance<E: Equation<S>>(equation: &E, start: &Start<'_, S>, first: S, h: S) -> (S, S) {
        let ground = [S::ZERO, start.piece.acceleration(start.time + S::HALF * h), start.piece.acceleration(start.time + h)];
        runge_kutta_4(equation, start.side.unit(), (start.rotation, start.velocity), first, ground, h)
    }

    #[inline(always)]
    fn step(&self) -> S {
        self.step
    }
}

/// The arc of a fixed-step method: its end, and the step taken again for every time before it.
#[derive(Debug)]
pub struct FixedArc<'a, S, A> {
    start: Start<'a, S>,
    first: S,
    end: Motion<S>,
    method: PhantomData<A>,
}

impl<'a, S: Real, A: Advance<S>> FixedArc<'a, S, A> {
    #[inline(always)]
    pub(crate) fn new(start: Start<'a, S>) -> Self {
        let first = if start.acceleration_is_zero {
            S::ZERO
        } else {
            let push = start.piece.acceleration(start.time);
            start.equation.acceleration(start.side.unit(), start.rotation, start.velocity, push)
        };
        let end = Self::motion(&start, first, start.length);
        FixedArc { start, first, end, method: PhantomData }
    }

    #[inline(never)]
    fn motion(start: &Start<'a, S>, first: S, time: S) -> Motion<S> {
        start.equation.known(Step { start, first, time, method: PhantomData::<A> })
    }
}

/// One step of length `time`.
struct Step<'s, 'a, S, A> {
    start: &'s Start<'a, S>,
    first: S,
    time: S,
    method: PhantomData<A>,
}

impl<S: Real, A: Advance<S>> WithEquation<S> for Step<'_, '_, S, A> {
    type Output = Motion<S>;

    #[inline(always)]
    fn with<E: Switched<S>>(self, equation: &E) -> Motion<S> {
        let Step { start, first, time, .. } = self;
        let (rotation, velocity) = A::advance(equation, start, first, time);
        let push = start.piece.acceleration(start.time + time);
        Motion { rotation, velocity, acceleration: equation.acceleration(start.side.unit(), rotation, velocity, push) }
    }
}

impl<S: Real, A: Advance<S>> Arc<S> for FixedArc<'_, S, A> {
    #[inline(always)]
    fn length(&self) -> S {
        self.start.length
    }

    #[inline]
    fn at(&self, time: S) -> Motion<S> {
        if time == S::ZERO {
            return Motion { rotation: self.start.rotation, velocity: self.start.velocity, acceleration: self.first };
        }
        if time == self.start.length { self.end } else { Self::motion(&self.start, self.first, time) }
    }

    #[inline]
    fn switching(&self, time: S) -> S {
        let motion = self.at(time);
        let push = self.start.piece.acceleration(self.start.time + time);
        self.start.equation.switching(self.start.side.unit(), motion.rotation, motion.velocity, push)
    }
}

macro_rules! fixed_step_method {
    ($method:ident) => {
        impl<S: Real> Method<S> for $method<S> {
            type Arc<'a> = FixedArc<'a, S, $method<S>>;

            #[inline(always)]
            fn arc<'a>(&'a self, start: Start<'a, S>) -> Self::Arc<'a> {
                FixedArc::new(start)
            }

            #[inline(always)]
            fn step(&self) -> Option<S> {
                Some(self.step)
            }
        }
    };
}

fixed_step_method!(SemiImplicitEuler);
fixed_step_method!(RungeKutta4);
