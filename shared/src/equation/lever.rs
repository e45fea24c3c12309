//! The lever ℓ(θ) of an inerter's terminals: how far they travel when the block turns.
//!
//! Every mount in use is a point of the block whose travel is taken along a fixed direction, so with δ = αs − θ
//!
//! ℓ = A cos δ + s B sin δ,  ℓ' = dℓ/dθ = A sin δ − s B cos δ,
//!
//! with constants A and B. The horizontal inerter at the centre of mass is A = 1, B = 0 (Eq. 11).

use crate::math::scalar::Scalar;
use crate::math::value::Value;

/// Lever ℓ(θ) of one mount. `side` is s = ±1; `sin` and `cos` are of δ.
pub trait Lever<S: Scalar>: Copy {
    /// Lever ℓ, per R.
    fn arm<V: Value<S>>(&self, side: S, sin: V, cos: V) -> V;

    /// Rate of the lever ℓ' = dℓ/dθ, per R.
    fn arm_rate<V: Value<S>>(&self, side: S, sin: V, cos: V) -> V;
}

/// Lever of a horizontal inerter at the centre of mass: ℓ = cos δ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CentreOfMass;

impl<S: Scalar> Lever<S> for CentreOfMass {
    #[inline(always)]
    fn arm<V: Value<S>>(&self, _side: S, _sin: V, cos: V) -> V {
        cos
    }

    #[inline(always)]
    fn arm_rate<V: Value<S>>(&self, _side: S, sin: V, _cos: V) -> V {
        sin
    }
}

/// Lever of any other point and direction: ℓ = A cos δ + s B sin δ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TyingPoint<S> {
    /// A.
    pub along: S,
    /// B.
    pub across: S,
}

impl TyingPoint<f64> {
    /// The same in another precision.
    pub fn rounded<S: Scalar>(self) -> TyingPoint<S> {
        TyingPoint { along: S::of(self.along), across: S::of(self.across) }
    }
}

impl<S: Scalar> Lever<S> for TyingPoint<S> {
    #[inline(always)]
    fn arm<V: Value<S>>(&self, side: S, sin: V, cos: V) -> V {
        cos.scale(self.along) + sin.scale(side * self.across)
    }

    #[inline(always)]
    fn arm_rate<V: Value<S>>(&self, side: S, sin: V, cos: V) -> V {
        sin.scale(self.along) - cos.scale(side * self.across)
    }
}
