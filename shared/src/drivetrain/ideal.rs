//! Ideal devices in the hybrid loop: none, one inerter, and the ideal clutched pair, for scenes that need this loop for another
//! reason. With `FRICTION` the rack and the bearings lose energy, and a guided rack has a mass.

use super::transmission::{PointOf, Transmission};
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::value::Value;

/// Block without a device.
pub struct Alone;

/// One inerter, always engaged.
pub struct Single<const FRICTION: bool>;

/// The clutched pair that engages a stopped flywheel at speed without a loss of momentum.
pub struct IdealPair<const FRICTION: bool>;

impl<S: Real> Transmission<S, 0, 0> for Alone {
    const COMMANDED: bool = false;
    const HOLDS: bool = false;

    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, 0>) -> (V, [V; 0]) {
        (at.body.driving_moment(&at.configuration, [at.ground[0], at.ground[1]]), [])
    }
}

impl<S: Real, const FRICTION: bool> Transmission<S, 0, 0> for Single<FRICTION> {
    const COMMANDED: bool = false;
    const HOLDS: bool = FRICTION;
    const THROUGH_IMPACTS: bool = true;
    const PERMANENT: bool = true;
}

impl<S: Real, const FRICTION: bool> Transmission<S, 0, 1> for IdealPair<FRICTION> {
    const COMMANDED: bool = true;
    const HOLDS: bool = FRICTION;
}
