//! Fixed steps for a block with a device. Events inside a step are located by taking the step again with a shorter length.

use super::exponential;
use super::path::{KnownStart, Path, PathStart, Tracer, WithStart};
use crate::drivetrain::any_drive::{first, padded};
use crate::drivetrain::drive::{Drive, UNKNOWNS};
use crate::equation::body::Body;
use crate::equation::motion::Motion;
use crate::math::scalar::Real;
use crate::method::dense_output::Arc;
use crate::method::fixed::FixedStep;

/// θ, θ̇ and the device's unknowns.
pub type Unknowns<S, const X: usize> = (S, S, [S; X]);

/// The unknowns a time `h` after the start, where θ̈ and the rates of the device's unknowns are `first`.
#[inline(always)]
fn advance<S: Real, B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize>(
    method: FixedStep<S>,
    known: &KnownStart<'_, S, B, D>,
    first: &(S, [S; X]),
    h: S,
) -> Unknowns<S, X> {
    match method {
        FixedStep::SemiImplicitEuler { .. } => semi_implicit_euler(known, first, h),
        FixedStep::ExponentialMidpoint { .. } if D::SPRINGS => exponential::midpoint(known, h),
        _ => runge_kutta_4(known, first, h),
    }
}

#[inline(always)]
fn semi_implicit_euler<S: Real, B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize>(
    known: &KnownStart<'_, S, B, D>,
    (acceleration, rates): &(S, [S; X]),
    h: S,
) -> Unknowns<S, X> {
    let PathStart { rotation, velocity, .. } = *known.start;
    let velocity = velocity + h * known.start.first(*acceleration);
    let given: [S; X] = first(&known.start.extra);
    (rotation + h * velocity, velocity, core::array::from_fn(|i| given[i] + h * rates[i]))
}

#[inline(always)]
fn runge_kutta_4<S: Real, B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize>(
    known: &KnownStart<'_, S, B, D>,
    (acceleration, r1): &(S, [S; X]),
    h: S,
) -> Unknowns<S, X> {
    let half = S::HALF * h;
    let (theta, omega) = (known.start.rotation, known.start.velocity);
    let given = first(&known.start.extra);
    let shifted = |rates: &[S; X], by: S| {
        let mut extra = given;
        for (value, &rate) in extra.iter_mut().zip(rates) {
            *value = *value + by * rate;
        }
        extra
    };
    let a1 = known.start.first(*acceleration);
    let omega_2 = omega + half * a1;
    let (a2, r2) = known.rates(half, theta + half * omega, omega_2, &shifted(r1, half));
    let omega_3 = omega + half * a2;
    let (a3, r3) = known.rates(half, theta + half * omega_2, omega_3, &shifted(&r2, half));
    let omega_4 = omega + h * a3;
    let (a4, r4) = known.rates(h, theta + h * omega_3, omega_4, &shifted(&r3, h));
    let (sixth, two) = (h * S::of(1.0 / 6.0), S::of(2.0));
    let mut extra = given;
    for i in 0..X {
        extra[i] = extra[i] + sixth * (r1[i] + two * (r2[i] + r3[i]) + r4[i]);
    }
    (theta + sixth * (omega + two * (omega_2 + omega_3) + omega_4), omega + sixth * (a1 + two * (a2 + a3) + a4), extra)
}

/// Motion and unknowns at one instant.
type Place<S> = (Motion<S>, [S; UNKNOWNS]);

/// The path of a fixed-step method: its ends, and the step taken again for every time between them.
#[derive(Debug)]
pub struct FixedPath<'a, S> {
    method: FixedStep<S>,
    start: PathStart<'a, S>,
    /// θ̈ and the rates of the device's unknowns at the start.
    first: (S, [S; UNKNOWNS]),
    end: Place<S>,
}

/// A step of length `time`; its `first` rates are taken where they are not known.
struct Step<'a, S> {
    method: FixedStep<S>,
    first: Option<&'a (S, [S; UNKNOWNS])>,
    time: S,
}

impl<S: Real> WithStart<S> for Step<'_, S> {
    type Output = ((S, [S; UNKNOWNS]), Place<S>);

    #[inline(always)]
    fn with<B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize>(
        self,
        known: &KnownStart<'_, S, B, D>,
    ) -> Self::Output {
        let Step { method, time, .. } = self;
        let start = known.start;
        let at_start = match self.first {
            Some((acceleration, rates)) => (*acceleration, first(rates)),
            None => known.rates(S::ZERO, start.rotation, start.velocity, &first(&start.extra)),
        };
        let (rotation, velocity, extra) = advance(method, known, &at_start, time);
        let (acceleration, _) = known.rates(time, rotation, velocity, &extra);
        ((at_start.0, padded(&at_start.1)), (Motion { rotation, velocity, acceleration }, padded(&extra)))
    }
}

/// Watched function `index` at `time`, where the motion is at `place`.
struct Guard<'a, S> {
    index: usize,
    time: S,
    place: &'a Place<S>,
}

impl<S: Real> WithStart<S> for Guard<'_, S> {
    type Output = S;

    #[inline(always)]
    fn with<B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize>(self, known: &KnownStart<'_, S, B, D>) -> S {
        let (motion, extra) = self.place;
        known.guard(self.index, self.time, motion, &first(extra))
    }
}

impl<'a, S: Real> FixedPath<'a, S> {
    fn new(method: FixedStep<S>, start: PathStart<'a, S>) -> Self {
        let (first, end) = Self::step(method, &start, None, start.length);
        FixedPath { method, start, first, end }
    }

    #[inline(never)]
    fn step(
        method: FixedStep<S>,
        start: &PathStart<'a, S>,
        first: Option<&(S, [S; UNKNOWNS])>,
        time: S,
    ) -> ((S, [S; UNKNOWNS]), Place<S>) {
        start.known(Step { method, first, time })
    }

    fn place(&self, time: S) -> Place<S> {
        if time == S::ZERO {
            let PathStart { rotation, velocity, extra, .. } = self.start;
            (Motion { rotation, velocity, acceleration: self.first.0 }, extra)
        } else if time == self.start.length {
            self.end
        } else {
            Self::step(self.method, &self.start, Some(&self.first), time).1
        }
    }
}

impl<S: Real> Arc<S> for FixedPath<'_, S> {
    #[inline(always)]
    fn length(&self) -> S {
        self.start.length
    }

    #[inline(never)]
    fn at(&self, time: S) -> Motion<S> {
        self.place(time).0
    }

    #[inline]
    fn switching(&self, time: S) -> S {
        self.at(time).acceleration
    }
}

impl<S: Real> Path<S> for FixedPath<'_, S> {
    #[inline]
    fn extra(&self, time: S) -> [S; UNKNOWNS] {
        self.place(time).1
    }

    #[inline(never)]
    fn guard(&self, index: usize, time: S) -> S {
        self.start.known(Guard { index, time, place: &self.place(time) })
    }
}

impl<S: Real> Tracer<S> for FixedStep<S> {
    type Path<'a> = FixedPath<'a, S>;

    #[inline(always)]
    fn path<'a>(&'a self, start: PathStart<'a, S>) -> Self::Path<'a> {
        FixedPath::new(*self, start)
    }

    #[inline(always)]
    fn step(&self) -> Option<S> {
        Some(FixedStep::step(self))
    }
}
