//! Equations of motion whose inerter each SIMD lane can have engaged or released.

use super::lever::Lever;
use super::{Equation, FullBlock, FullInerter, SlenderBlock};
use crate::math::scalar::Scalar;

/// An equation of motion of which each lane can have its inerter engaged or released.
pub trait Switched<S: Scalar>: Equation<S> {
    /// `engaged` where the mask holds, `released` elsewhere. The two may differ in the inerter only.
    fn switched(mask: S::Mask, engaged: &Self, released: &Self) -> Self;

    /// The same block with its inerter released.
    fn without_inerter(&self) -> Self;
}

impl<S: Scalar> Switched<S> for FullBlock<S> {
    #[inline(always)]
    fn switched(_mask: S::Mask, _engaged: &Self, released: &Self) -> Self {
        *released
    }

    #[inline(always)]
    fn without_inerter(&self) -> Self {
        *self
    }
}

impl<S: Scalar, L: Lever<S>> Switched<S> for FullInerter<S, L> {
    #[inline(always)]
    fn switched(mask: S::Mask, engaged: &Self, released: &Self) -> Self {
        released.with_coupling(S::select(mask, engaged.coupling, released.coupling))
    }

    #[inline(always)]
    fn without_inerter(&self) -> Self {
        self.with_coupling(S::of(0.0))
    }
}

impl<S: Scalar> Switched<S> for SlenderBlock<S> {
    #[inline(always)]
    fn switched(mask: S::Mask, engaged: &Self, released: &Self) -> Self {
        SlenderBlock {
            frequency_squared: S::select(mask, engaged.frequency_squared, released.frequency_squared),
            inertia: S::select(mask, engaged.inertia, released.inertia),
            ..*released
        }
    }

    #[inline(always)]
    fn without_inerter(&self) -> Self {
        SlenderBlock { frequency_squared: self.frequency_squared * self.inertia, inertia: S::of(1.0), ..*self }
    }
}
