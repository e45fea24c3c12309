//! Fixed-step methods for a block with a device. Events inside a step are located by taking the step again with a shorter length.

use super::exponential;
use super::mode_output::{KnownModeStart, ModeIntegrator, ModeOutput, ModeStart, Place, WithModeStart};
use crate::drivetrain::clutch_state::{Guard, UNKNOWNS};
use crate::drivetrain::transmission::{Transmission, first};
use crate::equation::Accelerations;
use crate::equation::body::Body;
use crate::equation::motion::Motion;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::dense_output::DenseOutput;
use crate::method::fixed::{FixedStep, Scheme};

/// θ̈ and the rates of the device's unknowns.
type Rates<S, const X: usize> = (S, [S; X]);

/// The state a time `h` after `from`, where the rates are `rates`; `ground` is the ground's acceleration then, in g.
#[inline(always)]
fn advance<S: Real, B: Body<S>, D: Transmission<S, X, G>, const X: usize, const G: usize>(
    scheme: Scheme,
    known: &KnownModeStart<'_, S, B, D, X, G>,
    (from, rates): (&Place<S, X>, &Rates<S, X>),
    (h, ground): (S, Accelerations<S>),
) -> Place<S, X> {
    let first = known.start.first(rates.0);
    match scheme {
        Scheme::SemiImplicitEuler => {
            let velocity = from.velocity + h * first;
            let unknowns = core::array::from_fn(|i| from.unknowns[i] + h * rates.1[i]);
            Place { time: h, ground, rotation: from.rotation + h * velocity, velocity, unknowns }
        }
        Scheme::ExponentialMidpoint if D::SPRINGS => exponential::midpoint(known, from, (h, ground)),
        Scheme::RungeKutta4 | Scheme::ExponentialMidpoint => runge_kutta_4(known, from, (first, &rates.1), (h, ground)),
    }
}

#[inline(always)]
fn runge_kutta_4<S: Real, B: Body<S>, D: Transmission<S, X, G>, const X: usize, const G: usize>(
    known: &KnownModeStart<'_, S, B, D, X, G>,
    from: &Place<S, X>,
    (a1, r1): (S, &[S; X]),
    (h, ground): (S, Accelerations<S>),
) -> Place<S, X> {
    let half = S::HALF * h;
    let middle = known.start.ground_at(half);
    let Place { rotation: theta, velocity: omega, unknowns, .. } = *from;
    let stage = |time: S, ground, rotation, velocity, rates: &[S; X]| {
        known.rates(&Place {
            time,
            ground,
            rotation,
            velocity,
            unknowns: core::array::from_fn(|i| unknowns[i] + time * rates[i]),
        })
    };
    let omega_2 = omega + half * a1;
    let (a2, r2) = stage(half, middle, theta + half * omega, omega_2, r1);
    let omega_3 = omega + half * a2;
    let (a3, r3) = stage(half, middle, theta + half * omega_2, omega_3, &r2);
    let omega_4 = omega + h * a3;
    let (a4, r4) = stage(h, ground, theta + h * omega_3, omega_4, &r3);
    let (sixth, two) = (h * S::of(1.0 / 6.0), S::of(2.0));
    Place {
        time: h,
        ground,
        rotation: theta + sixth * (omega + two * (omega_2 + omega_3) + omega_4),
        velocity: omega + sixth * (a1 + two * (a2 + a3) + a4),
        unknowns: core::array::from_fn(|i| unknowns[i] + sixth * (r1[i] + two * (r2[i] + r3[i]) + r4[i])),
    }
}

/// Mode output of a fixed-step method: its ends, and the step taken again for every time between them.
pub struct FixedModeOutput<'a, S> {
    scheme: Scheme,
    start: &'a ModeStart<'a, S>,
    /// At the start.
    rates: Rates<S, UNKNOWNS>,
    /// The end, and θ̈ there.
    end: (Place<S, UNKNOWNS>, S),
    /// No guard is negative at the end.
    guarded: bool,
}

/// A step of length `time`; the `rates` at its start are taken where they are not known.
struct Step<'a, S> {
    scheme: Scheme,
    rates: Option<&'a Rates<S, UNKNOWNS>>,
    time: S,
}

impl<S: Real> WithModeStart<S> for Step<'_, S> {
    type Output = (Rates<S, UNKNOWNS>, (Place<S, UNKNOWNS>, S), bool);

    #[inline(always)]
    fn with<B: Body<S>, D: Transmission<S, X, G>, const X: usize, const G: usize>(
        self,
        known: &KnownModeStart<'_, S, B, D, X, G>,
    ) -> Self::Output {
        let from = known.start.place.map(first);
        let rates = match self.rates {
            Some((acceleration, rates)) => (*acceleration, first(rates)),
            None => known.rates(&from),
        };
        let ground = known.start.ground_at(self.time);
        let end = advance(self.scheme, known, (&from, &rates), (self.time, ground));
        let point = known.point(&end);
        let (acceleration, _) = known.flow(&point);
        let negative =
            |watch: Guard<S>| watch != Guard::Nothing && known.transmission.guard(&point, acceleration, watch) < S::ZERO;
        // Of a held block θ̈ is not that of the equation.
        let guarded = !known.is_held() && !known.start.law.watch.iter().take(G).any(|watch| negative(*watch));
        let all = |unknowns: &[S; X]| core::array::from_fn(|i| unknowns.get(i).copied().unwrap_or(S::ZERO));
        ((rates.0, all(&rates.1)), (end.map(all), acceleration), guarded)
    }
}

impl<'a, S: Real> FixedModeOutput<'a, S> {
    fn new(scheme: Scheme, start: &'a ModeStart<'a, S>) -> Self {
        let (rates, end, guarded) = Self::step(scheme, start, None, start.length);
        FixedModeOutput { scheme, start, rates, end, guarded }
    }

    #[inline(never)]
    fn step(
        scheme: Scheme,
        start: &ModeStart<'_, S>,
        rates: Option<&Rates<S, UNKNOWNS>>,
        time: S,
    ) -> (Rates<S, UNKNOWNS>, (Place<S, UNKNOWNS>, S), bool) {
        start.known(Step { scheme, rates, time })
    }

    fn place(&self, time: S) -> (Place<S, UNKNOWNS>, S) {
        if time == S::ZERO {
            (self.start.place, self.rates.0)
        } else if time == self.start.length {
            self.end
        } else {
            Self::step(self.scheme, self.start, Some(&self.rates), time).1
        }
    }
}

impl<S: Real> DenseOutput<S> for FixedModeOutput<'_, S> {
    fn length(&self) -> S {
        self.start.length
    }

    #[inline(never)]
    fn at(&self, time: S) -> Motion<S> {
        let (Place { rotation, velocity, .. }, acceleration) = self.place(time);
        Motion { rotation, velocity, acceleration }
    }
}

impl<S: Real> ModeOutput<S> for FixedModeOutput<'_, S> {
    #[inline]
    fn keeps_signs(&self, direction: Sign) -> bool {
        // As the ends show, which is all that these methods know.
        self.guarded && direction.times(self.end.0.velocity) >= S::ZERO
    }

    #[inline]
    fn unknowns(&self, time: S) -> [S; UNKNOWNS] {
        self.place(time).0.unknowns
    }

    #[inline(never)]
    fn guard(&self, index: usize, time: S) -> S {
        let (place, acceleration) = self.place(time);
        let ModeStart { system, law, side, held, .. } = *self.start;
        let point = system.point(law, side, &place);
        let acceleration = if held { system.transmission.acceleration(&point) } else { acceleration };
        system.transmission.guard(&point, acceleration, law.watch[index])
    }
}

impl<S: Real> ModeIntegrator<S> for FixedStep<S> {
    type Output<'a> = FixedModeOutput<'a, S>;

    #[inline(always)]
    fn integrate<'a>(&'a self, start: &'a ModeStart<'a, S>) -> Self::Output<'a> {
        FixedModeOutput::new(self.scheme, start)
    }

    fn step(&self) -> Option<S> {
        Some(self.step)
    }
}
