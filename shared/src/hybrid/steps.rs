//! Explicit fixed steps for a block with a device: the classical Runge-Kutta method. Events inside a step are located by
//! taking the step again with a shorter length.

use core::marker::PhantomData;

use super::path::{Path, PathStart, Tracer};
use crate::arc::{Arc, Motion};
use crate::body::Body;
use crate::drivetrain::drive::Drive;
use crate::fixed::RungeKutta4;
use crate::scalar::Real;

/// θ, θ̇ and the device's unknowns.
pub type Unknowns<S, const X: usize> = (S, S, [S; X]);

/// How a fixed-step method gets from the start of a step to a time within it.
pub trait Stepper<S: Real> {
    /// The unknowns a time `h` after `start`, where θ̈ and the rates of the device's unknowns are `first`.
    fn advance<B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize>(
        start: &PathStart<'_, S, B, D, X>,
        first: &(S, [S; X]),
        h: S,
    ) -> Unknowns<S, X>;
}

impl<S: Real> Stepper<S> for RungeKutta4<S> {
    #[inline]
    fn advance<B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize>(
        start: &PathStart<'_, S, B, D, X>,
        (first, r1): &(S, [S; X]),
        h: S,
    ) -> Unknowns<S, X> {
        let half = S::HALF * h;
        let (theta, omega) = (start.rotation, start.velocity);
        let shifted = |rates: &[S; X], by: S| {
            let mut extra = start.extra;
            for (value, &rate) in extra.iter_mut().zip(rates) {
                *value = *value + by * rate;
            }
            extra
        };
        let a1 = start.first(*first);
        let omega_2 = omega + half * a1;
        let (a2, r2) = start.rates::<G>(half, theta + half * omega, omega_2, &shifted(r1, half));
        let omega_3 = omega + half * a2;
        let (a3, r3) = start.rates::<G>(half, theta + half * omega_2, omega_3, &shifted(&r2, half));
        let omega_4 = omega + h * a3;
        let (a4, r4) = start.rates::<G>(h, theta + h * omega_3, omega_4, &shifted(&r3, h));
        let (sixth, two) = (h * S::of(1.0 / 6.0), S::of(2.0));
        let mut extra = start.extra;
        for i in 0..X {
            extra[i] = extra[i] + sixth * (r1[i] + two * (r2[i] + r3[i]) + r4[i]);
        }
        (theta + sixth * (omega + two * (omega_2 + omega_3) + omega_4), omega + sixth * (a1 + two * (a2 + a3) + a4), extra)
    }
}

/// The path of a fixed-step method: its ends, and the step taken again for every time between them.
#[derive(Debug)]
pub struct FixedPath<'a, S, B, D, A, const X: usize, const G: usize> {
    start: PathStart<'a, S, B, D, X>,
    /// θ̈ and the rates of the device's unknowns at the start.
    first: (S, [S; X]),
    end: (Motion<S>, [S; X]),
    method: PhantomData<A>,
}

impl<'a, S: Real, B: Body<S>, D: Drive<S, X, G>, A: Stepper<S>, const X: usize, const G: usize> FixedPath<'a, S, B, D, A, X, G> {
    /// From `start`.
    #[inline(never)]
    pub fn of(start: PathStart<'a, S, B, D, X>) -> Self {
        let first = start.rates::<G>(S::ZERO, start.rotation, start.velocity, &start.extra);
        let still = Motion { rotation: start.rotation, velocity: start.velocity, acceleration: first.0 };
        let extra = start.extra;
        let mut path = FixedPath { start, first, end: (still, extra), method: PhantomData };
        path.end = path.look(path.start.length);
        path
    }

    /// A step of length `time`. It is taken from many places: one copy of it keeps programs small.
    #[inline(never)]
    fn look(&self, time: S) -> (Motion<S>, [S; X]) {
        let (rotation, velocity, extra) = A::advance::<B, D, X, G>(&self.start, &self.first, time);
        let (acceleration, _) = self.start.rates::<G>(time, rotation, velocity, &extra);
        (Motion { rotation, velocity, acceleration }, extra)
    }

    fn known(&self, time: S) -> Option<(Motion<S>, [S; X])> {
        if time == S::ZERO {
            let PathStart { rotation, velocity, extra, .. } = self.start;
            Some((Motion { rotation, velocity, acceleration: self.first.0 }, extra))
        } else if time == self.start.length {
            Some(self.end)
        } else {
            None
        }
    }

    fn state(&self, time: S) -> (Motion<S>, [S; X]) {
        self.known(time).unwrap_or_else(|| self.look(time))
    }
}

impl<S: Real, B: Body<S>, D: Drive<S, X, G>, A: Stepper<S>, const X: usize, const G: usize> Arc<S>
    for FixedPath<'_, S, B, D, A, X, G>
{
    #[inline(always)]
    fn length(&self) -> S {
        self.start.length
    }

    #[inline(never)]
    fn at(&self, time: S) -> Motion<S> {
        self.state(time).0
    }

    #[inline]
    fn switching(&self, time: S) -> S {
        self.at(time).acceleration
    }
}

impl<S: Real, B: Body<S>, D: Drive<S, X, G>, A: Stepper<S>, const X: usize, const G: usize> Path<S, X>
    for FixedPath<'_, S, B, D, A, X, G>
{
    #[inline]
    fn extra(&self, time: S) -> [S; X] {
        self.state(time).1
    }

    #[inline(never)]
    fn guard(&self, index: usize, time: S) -> S {
        let (motion, extra) = self.state(time);
        self.start.guard::<G>(index, time, &motion, &extra)
    }
}

impl<S: Real> Tracer<S> for RungeKutta4<S> {
    type Path<'a, B: Body<S> + 'a, D: Drive<S, X, G> + 'a, const X: usize, const G: usize> =
        FixedPath<'a, S, B, D, RungeKutta4<S>, X, G>;

    #[inline(always)]
    fn path<'a, B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize>(
        &'a self,
        start: PathStart<'a, S, B, D, X>,
    ) -> Self::Path<'a, B, D, X, G> {
        FixedPath::of(start)
    }

    #[inline(always)]
    fn step(&self) -> Option<S> {
        Some(self.step)
    }
}
