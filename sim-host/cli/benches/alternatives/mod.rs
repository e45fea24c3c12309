//! Ways of writing the equations once that were tried and not taken; only the benchmark uses them.

use std::ops::{Add, Div, Mul, Neg, Sub};

use sprag_shared::equation::lever::{CentreOfMass, Lever, TyingPoint};
use sprag_shared::equation::{Equation, FullInerter};
use sprag_shared::math::scalar::Scalar;
use sprag_shared::math::value::Value;
use sprag_shared::math::wide_sine;
use sprag_shared::motion::step_end::{TimeStepping, TimeSteppingState};
use wide::f64x4;

/// An explicit SIMD type for the number.
#[derive(Clone, Copy, Debug)]
pub struct Quad(f64x4);

impl Quad {
    /// Amplitudes as those of the lanes.
    pub fn spread(chain: usize) -> Quad {
        Quad(f64x4::new(std::array::from_fn(|lane| 1.0 - 0.02 * (4 * chain + lane) as f64)))
    }
}

macro_rules! quad_operator {
    ($($operator:ident $method:ident),*) => {
        $(impl $operator for Quad {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Quad(self.0.$method(other.0))
            }
        })*
    };
}

quad_operator!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Quad {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Quad(-self.0)
    }
}

impl Scalar for Quad {
    type Mask = f64x4;
    #[inline(always)]
    fn of(value: f64) -> Self {
        Quad(f64x4::splat(value))
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        wide_sine::sin_cos(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Quad(self.0.abs())
    }
    #[inline(always)]
    fn exceeds(self, other: Self) -> f64x4 {
        self.0.simd_gt(other.0)
    }
    #[inline(always)]
    fn select(mask: f64x4, yes: Self, no: Self) -> Self {
        Quad(mask.select(yes.0, no.0))
    }
}

/// A mount that is looked up at every evaluation.
#[derive(Clone, Copy, Debug)]
pub enum AnyMount {
    CentreOfMass(CentreOfMass),
    TyingPoint(TyingPoint<f64>),
}

impl Lever<f64> for AnyMount {
    #[inline(always)]
    fn arm<V: Value<f64>>(&self, side: f64, sin: V, cos: V) -> V {
        match self {
            AnyMount::CentreOfMass(mount) => mount.arm(side, sin, cos),
            AnyMount::TyingPoint(mount) => mount.arm(side, sin, cos),
        }
    }
    #[inline(always)]
    fn arm_rate<V: Value<f64>>(&self, side: f64, sin: V, cos: V) -> V {
        match self {
            AnyMount::CentreOfMass(mount) => mount.arm_rate(side, sin, cos),
            AnyMount::TyingPoint(mount) => mount.arm_rate(side, sin, cos),
        }
    }
}

/// The equation behind a pointer. Such a function cannot be generic in turn, so it serves neither lanes nor series.
pub trait Acceleration {
    fn acceleration(&self, coupling: f64, side: f64, rotation: f64, velocity: f64, ground: f64) -> f64;
    fn switching(&self, side: f64, rotation: f64, velocity: f64, ground: f64) -> f64;
}

impl Acceleration for FullInerter<f64, CentreOfMass> {
    fn acceleration(&self, coupling: f64, side: f64, rotation: f64, velocity: f64, ground: f64) -> f64 {
        Equation::acceleration(&self.with_coupling(coupling), side, rotation, velocity, ground)
    }
    fn switching(&self, side: f64, rotation: f64, velocity: f64, ground: f64) -> f64 {
        Equation::switching(self, side, rotation, velocity, ground)
    }
}

/// The step of `TimeStepping::runge_kutta_4` with each evaluation behind a pointer.
#[inline(always)]
pub fn step_by_pointer(
    equation: &dyn Acceleration,
    block: &TimeStepping<f64, FullInerter<f64, CentreOfMass>>,
    state: TimeSteppingState<f64>,
    ground: [f64; 3],
    h: f64,
) -> TimeSteppingState<f64> {
    let TimeSteppingState { rotation, velocity, mut side } = state;
    if rotation == 0.0 && velocity == 0.0 {
        if ground[0].abs() <= block.uplift {
            return state;
        }
        side = if ground[0] > 0.0 { -1.0 } else { 1.0 };
    }
    let engaged = equation.switching(side, rotation, velocity, ground[0]) * velocity > 0.0;
    let coupling = if engaged { block.engaged.coupling } else { block.released.coupling };
    let f = |theta: f64, omega: f64, push: f64| equation.acceleration(coupling, side, theta, omega, push);
    let a_1 = f(rotation, velocity, ground[0]);
    let omega_2 = velocity + 0.5 * h * a_1;
    let a_2 = f(rotation + 0.5 * h * velocity, omega_2, ground[1]);
    let omega_3 = velocity + 0.5 * h * a_2;
    let a_3 = f(rotation + 0.5 * h * omega_2, omega_3, ground[1]);
    let omega_4 = velocity + h * a_3;
    let a_4 = f(rotation + h * omega_3, omega_4, ground[2]);
    let rotation = rotation + h / 6.0 * (velocity + 2.0 * (omega_2 + omega_3) + omega_4);
    let velocity = velocity + h / 6.0 * (a_1 + 2.0 * (a_2 + a_3) + a_4);
    if rotation * side < 0.0 {
        TimeSteppingState { rotation, velocity: velocity * block.restitution, side: -side }
    } else {
        TimeSteppingState { rotation, velocity, side }
    }
}
