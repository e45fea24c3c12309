//! Models of the block in SIMD lanes: equations of motion, and first integrals after the ground has stopped.

use sprag_shared::equation::body::FullBody;
use sprag_shared::equation::first_integral::{FirstIntegral, FullIntegral, SlenderIntegral};
use sprag_shared::equation::lever::CentreOfMass;
use sprag_shared::equation::switched::Switched;
use sprag_shared::equation::{FullBlock, FullInerter, SlenderBlock};
use sprag_shared::structure::block::Geometry;

use crate::blocks::Modes;
use crate::pulses::{BySeries, Stepping};
use crate::slender::step::ClosedForm;
use crate::{Number, number};

/// Model of a block in SIMD lanes; p = 1.
pub trait Model {
    /// Equation of motion.
    type Equation: Switched<Number>;
    /// First integral.
    type Integral: FirstIntegral;
    /// Integrator under pulses.
    type Stepping: Stepping;

    /// Full or slender.
    const GEOMETRY: Geometry;

    /// The equations of blocks of these slendernesses α (rad) and couplings k = σ/λ (slender: kℓ²).
    fn modes(slenderness: Number, coupling: Number) -> Modes<Self::Equation>;

    /// The integral with κ k = `coupling`.
    fn integral(coupling: f64) -> Self::Integral;

    /// |θ̈|/p² of a block of slenderness `alpha` (rad) at θ = 0 on quiet ground, with κ k = `coupling`.
    fn rate(alpha: f64, coupling: f64) -> f64 {
        Self::integral(coupling).acceleration(alpha)
    }
}

/// Model of the full block alone.
#[derive(Clone, Copy, Debug)]
pub struct FullAlone;

/// Model of the full block with an inerter at its centre of mass, paper kinematics.
#[derive(Clone, Copy, Debug)]
pub struct FullWithInerter;

/// Model of the slender block with any inerter, or none with k = 0.
#[derive(Clone, Copy, Debug)]
pub struct Slender;

#[inline(always)]
fn full(slenderness: Number) -> FullBlock<Number> {
    FullBlock { frequency_squared: number(1.0), slenderness }
}

impl Model for FullAlone {
    type Equation = FullBlock<Number>;
    type Integral = FullIntegral;
    type Stepping = BySeries<FullAlone>;

    const GEOMETRY: Geometry = Geometry::Full;

    #[inline(always)]
    fn modes(slenderness: Number, _coupling: Number) -> Modes<Self::Equation> {
        Modes { released: full(slenderness), engaged: full(slenderness) }
    }

    #[inline(always)]
    fn integral(_coupling: f64) -> FullIntegral {
        FullIntegral { coupling: 0.0 }
    }
}

impl Model for FullWithInerter {
    type Equation = FullInerter<Number, CentreOfMass>;
    type Integral = FullIntegral;
    type Stepping = BySeries<FullWithInerter>;

    const GEOMETRY: Geometry = Geometry::Full;

    #[inline(always)]
    fn modes(slenderness: Number, coupling: Number) -> Modes<Self::Equation> {
        let block = full(slenderness);
        let engaged = FullInerter { body: FullBody { block, lever: CentreOfMass, consistent: false, vertical: false }, coupling };
        Modes { released: engaged.with_coupling(number(0.0)), engaged }
    }

    #[inline(always)]
    fn integral(coupling: f64) -> FullIntegral {
        FullIntegral { coupling }
    }
}

impl Model for Slender {
    type Equation = SlenderBlock<Number>;
    type Integral = SlenderIntegral;
    type Stepping = ClosedForm;

    const GEOMETRY: Geometry = Geometry::Slender;

    #[inline(always)]
    fn modes(slenderness: Number, coupling: Number) -> Modes<Self::Equation> {
        let one = number(1.0);
        let of = |inertia: Number| SlenderBlock { frequency_squared: one / inertia, slenderness, inertia, lever: one };
        Modes { released: of(one), engaged: of(one + coupling) }
    }

    #[inline(always)]
    fn integral(coupling: f64) -> SlenderIntegral {
        SlenderIntegral { inertia: 1.0 + coupling }
    }
}
