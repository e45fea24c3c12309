//! Equations of motion of the rocking block, each written once.
//!
//! With s = sgn θ and δ = αs − θ, everything divided by I_O = λmR² (Eq. 13-16, and the same with consistent kinematics):
//!
//! (1 + κ k ℓ²) θ̈ + κ k ℓ ℓ' θ̇² = −p² [ sin δ + (ü_g/g) cos δ ],  k = σ/λ,
//!
//! where the θ̇² term belongs to the consistent kinematics only. An equation here has κ fixed: between two events a block
//! is either engaged or not. They are written over [`Value`], so the same lines give an acceleration in f32 or f64, in
//! SIMD lanes, and the coefficients of a Taylor series.
//!
//! [`lever`]: the inerter's terminals; [`body`]: the same equations in parts, for devices with forces of their own;
//! [`clutch_rule`]: Eq. 10; [`first_integral`]: the energy integral. The room imports `math` only.

pub mod any_body;
pub mod any_equation;
pub mod body;
pub mod clutch_rule;
pub mod first_integral;
pub mod lever;
pub mod motion;
pub mod switched;

use crate::math::scalar::Scalar;
use crate::math::value::Value;
use body::{Body, FullBody};
use lever::Lever;

/// Accelerations at an instant, in g: of the ground, horizontal and vertical, and of a support of its own motion, horizontal and relative to
/// the ground.
pub type Accelerations<S> = [S; 3];

/// Equation of motion of one rotation, of second order and smooth between events.
pub trait Equation<S: Scalar>: Copy {
    /// Whether the clutch's switching function is the acceleration itself (paper kinematics), so that one search finds
    /// the zeros of both.
    #[inline(always)]
    fn switches_with_acceleration(&self) -> bool {
        true
    }

    /// θ̈ (rad/s²) on `side` s = ±1 for θ (rad), θ̇ (rad/s) and the ground acceleration ü_g/g.
    fn acceleration<V: Value<S>>(&self, side: S, rotation: V, velocity: V, ground: V) -> V;

    /// A quantity with the sign of the acceleration of the inerter's terminals along their travel, the same whether the
    /// inerter is engaged or not (Eq. 10 compares it with the velocity).
    #[inline(always)]
    fn switching<V: Value<S>>(&self, side: S, rotation: V, velocity: V, ground: V) -> V {
        self.acceleration(side, rotation, velocity, ground)
    }

    /// Acceleration of the inerter's terminals per R (1/s²): ℓθ̈, plus ℓ'θ̇² in the consistent kinematics.
    fn terminal_acceleration(&self, side: S, rotation: S, velocity: S, acceleration: S) -> S;

    /// The equation as that of the slender block, if it is one: linear, so that its motion has a closed form.
    #[inline(always)]
    fn slender(&self) -> Option<&SlenderBlock<S>> {
        None
    }

    /// Power that the paper's kinematics take without a cause, per λmR² (1/s³): −κ k ℓ ℓ' θ̇³, which is what the energy
    /// ½(1 + κ k ℓ²)θ̇² of block and flywheel misses of the work done on them; 0 where energy is conserved.
    #[inline(always)]
    fn paper_power(&self, _side: S, _rotation: S, _velocity: S) -> S {
        S::of(0.0)
    }
}

/// Equation of motion of the block alone, or with its inerter released (Eq. 2): θ̈ = −p² [ sin δ + (ü_g/g) cos δ ].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullBlock<S> {
    /// p², 1/s².
    pub frequency_squared: S,
    /// α, rad.
    pub slenderness: S,
}

impl<S: Scalar> FullBlock<S> {
    /// δ = αs − θ on side s = ±1.
    #[inline(always)]
    pub fn delta<V: Value<S>>(&self, side: S, rotation: V) -> V {
        (-rotation).offset(side * self.slenderness)
    }

    /// Driving moment D = −p² [w sin δ + (ü_g/g) cos δ] per λmR², with `weight` w sin δ; w is 1, or 1 + v̈_g/g where the ground moves
    /// vertically too.
    #[inline(always)]
    pub fn driving_moment<V: Value<S>>(&self, weight: V, cos: V, ground: V) -> V {
        (weight + ground * cos).scale(-self.frequency_squared)
    }
}

impl<S: Scalar> Equation<S> for FullBlock<S> {
    #[inline(always)]
    fn acceleration<V: Value<S>>(&self, side: S, rotation: V, _velocity: V, ground: V) -> V {
        let (sin, cos) = self.delta(side, rotation).sin_cos();
        self.driving_moment(sin, cos, ground)
    }

    #[inline(always)]
    fn terminal_acceleration(&self, _side: S, _rotation: S, _velocity: S, _acceleration: S) -> S {
        S::of(0.0)
    }
}

/// Equation of motion of the block with its inerter (Eq. 13-16, any mount); κ = 0 with the inerter released.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FullInerter<S, L> {
    /// The block and its lever.
    pub body: FullBody<S, L>,
    /// κ k: σ/λ while engaged, 0 while released. In SIMD lanes each lane has its own.
    pub coupling: S,
}

impl<S, L> FullInerter<S, L> {
    /// The same mount with another coupling κ k.
    #[inline(always)]
    pub fn with_coupling(self, coupling: S) -> Self {
        FullInerter { coupling, ..self }
    }

    /// The same on level ground in the consistent kinematics, or in the paper's: a constant spares what compiles for it the choice.
    #[inline(always)]
    pub fn with_kinematics(self, consistent: bool) -> Self {
        FullInerter { body: FullBody { consistent, vertical: false, ..self.body }, ..self }
    }
}

impl<S: Scalar, L: Lever<S>> Equation<S> for FullInerter<S, L> {
    #[inline(always)]
    fn switches_with_acceleration(&self) -> bool {
        !self.body.consistent
    }

    #[inline(always)]
    fn acceleration<V: Value<S>>(&self, side: S, rotation: V, velocity: V, ground: V) -> V {
        let at = self.body.configuration(side, rotation);
        self.body.solve_acceleration(&at, self.body.driving_moment(&at, [ground; 2]), self.coupling, velocity)
    }

    #[inline(always)]
    fn switching<V: Value<S>>(&self, side: S, rotation: V, velocity: V, ground: V) -> V {
        let at = self.body.configuration(side, rotation);
        self.body.switching(&at, velocity, self.body.driving_moment(&at, [ground; 2]))
    }

    #[inline(always)]
    fn terminal_acceleration(&self, side: S, rotation: S, velocity: S, acceleration: S) -> S {
        self.body.terminal_acceleration(&self.body.configuration(side, rotation), velocity, acceleration)
    }

    #[inline(always)]
    fn paper_power(&self, side: S, rotation: S, velocity: S) -> S {
        self.body.paper_power(side, &self.body.configuration(side, rotation), velocity, self.coupling)
    }
}

/// Equation of motion of the slender block (Eq. 17-18), where an engaged inerter only lowers the frequency parameter:
/// θ̈ = −p_σ² [ αs − θ + ü_g/g ],  p_σ² = p²/(1 + κ k ℓ²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlenderBlock<S> {
    /// p_σ² = p²/(1 + κ k ℓ²), 1/s².
    pub frequency_squared: S,
    /// α, rad.
    pub slenderness: S,
    /// 1 + κ k ℓ².
    pub inertia: S,
    /// ℓ.
    pub lever: S,
}

impl<S: Scalar> Equation<S> for SlenderBlock<S> {
    #[inline(always)]
    fn acceleration<V: Value<S>>(&self, side: S, rotation: V, _velocity: V, ground: V) -> V {
        (rotation - ground).offset(-(side * self.slenderness)).scale(self.frequency_squared)
    }

    #[inline(always)]
    fn terminal_acceleration(&self, _side: S, _rotation: S, _velocity: S, acceleration: S) -> S {
        self.lever * acceleration
    }

    #[inline(always)]
    fn slender(&self) -> Option<&SlenderBlock<S>> {
        Some(self)
    }
}
