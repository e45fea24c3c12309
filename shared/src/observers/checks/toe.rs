//! Reactions at the toe: forces of a smooth motion, and impulses where θ̇ jumps.
//!
//! With the centre of mass at (−R sin δ, R cos δ) from the toe, δ = αs − θ, x to the right and positive rotation clockwise about
//! the right-hand toe, Newton's second law gives per weight mg
//!
//! H = ü_g/g + (R/g)(cos δ θ̈ + sin δ θ̇²) + n F,  V = 1 + v̈_g/g + (R/g)(sin δ θ̈ − cos δ θ̇²)
//!
//! with a horizontal device, where F/(mg) is the force at the rack and n the pulley's ratio; a vertical device pulls the
//! raised corner down by n F, which adds s n F to V instead. Slender: sin δ → δ, cos δ → 1.
//!
//! A jump Δθ̇ changes the momentum of the block at once. The same law, integrated over the jump, gives the impulses of the toe per
//! mR, with N = Σ σ Δw + μ_g Δ(ℓθ̇) that of flywheels and rack at the rack:
//!
//! H = cos δ Δθ̇ + n N,  V = sin δ Δθ̇  (vertical device: H = cos δ Δθ̇,  V = sin δ Δθ̇ + s n N).
//!
//! A jolt, at which a rigid clutch closes at speed, keeps the moment of momentum about the toe, λ Δθ̇ + ℓ N = 0. So N = −λ Δθ̇/ℓ, and
//! H/V does not depend on the size of the jolt. At the centre of mass |H/V| = (λ − cos²δ)/(sin δ cos δ); V < 0 where the jolt slows
//! a block that rises: the ground would have to pull.
//!
//! An impact gives an angle to the path of the centre of mass: with θ̇⁻ before and η θ̇⁻ after it, and N of what is locked to the
//! rack through it (Σσ of flywheels, μ_g), along and normal to the ground
//!
//! H = (1 − η)(cos α + n (Σσ + μ_g) ℓ₀)|θ̇⁻|,  V = (1 + η) sin α |θ̇⁻|,  ℓ₀ = ℓ(0),
//!
//! which at the centre of mass needs a friction of (1 − η)/(1 + η) (1 + Σσ + μ_g)/tan α. A vertical device adds to V only, and is
//! left out.

use crate::equation::lever::TyingPoint;
use crate::math;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::device_snapshot::Snapshot;
use crate::observers::ledger::{Account, Clutching};
use crate::structure::block::{Block, Geometry};
use crate::structure::error::ParameterError;
use crate::structure::mount::Mount;

/// Parameters of block and device for the reactions at the toe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Toe<S> {
    geometry: Geometry,
    /// α, rad.
    pub slenderness: S,
    sin_slenderness: S,
    cos_slenderness: S,
    /// λ.
    inertia: S,
    /// 1/p², s²: from F/(λmR) to F/(mg).
    per_weight: S,
    /// R/g, s².
    drop_time_squared: S,
    /// R, m.
    pub size: S,
    lever: [S; 2],
    pulley: S,
    vertical: bool,
    /// σ of a flywheel that is locked to the rack through an impact.
    mass_ratio: S,
    /// μ_g.
    rack_mass_ratio: S,
}

impl<S: Real> Toe<S> {
    /// # Errors
    /// The errors of [`Mount::lever`].
    pub fn new(block: &Block, geometry: Geometry, mount: &Mount, account: &Account) -> Result<Toe<S>, ParameterError> {
        let TyingPoint { along, across } = mount.lever(block)?;
        let p2 = block.frequency_parameter_squared();
        let alpha = block.slenderness();
        let (pulley, vertical) = match *mount {
            Mount::CentreOfMass => (1.0, false),
            Mount::TyingPoint { pulley_ratio, .. } => (pulley_ratio, false),
            Mount::BaseCorners { pulley_ratio } => (pulley_ratio, true),
        };
        let (sin, cos) = geometry.sin_cos(alpha);
        let lever = match geometry {
            Geometry::Full => [along, across],
            Geometry::Slender => [math::square_root(mount.slender_lever_squared(block)?), 0.0],
        };
        // An ideal clutch, which only resists, lets go at an impact; plates and springs pass no impulse on.
        let holds = matches!(account.clutching, Clutching::Permanent | Clutching::Rigid);
        Ok(Toe {
            geometry,
            slenderness: S::of(alpha),
            sin_slenderness: S::of(sin),
            cos_slenderness: S::of(cos),
            inertia: S::of(block.inertia_ratio()),
            per_weight: S::of(1.0 / p2),
            drop_time_squared: S::of(1.0 / (p2 * block.inertia_ratio())),
            size: S::of(block.size()),
            lever: lever.map(S::of),
            pulley: S::of(pulley),
            vertical,
            mass_ratio: S::of(if holds { account.mass_ratio } else { 0.0 }),
            rack_mass_ratio: S::of(account.rack_mass_ratio),
        })
    }

    /// sin δ and cos δ, or what stands for them in the slender model.
    fn direction(&self, side: Sign, rotation: S) -> (S, S) {
        self.geometry.sin_cos(side.times(self.slenderness) - rotation)
    }

    /// ℓ = A cos δ + s B sin δ; slender: a constant.
    fn arm(&self, side: Sign, (sin, cos): (S, S)) -> S {
        let [along, across] = self.lever;
        along * cos + side.times(across) * sin
    }

    /// A force over λmR (1/s²) over the weight.
    pub fn over_weight(&self, force: S) -> S {
        self.per_weight * force
    }

    /// H and V over the weight.
    pub fn reactions(&self, side: Sign, snapshot: &Snapshot<S>) -> [S; 2] {
        let (sin, cos) = self.direction(side, snapshot.motion.rotation);
        let (turn, pull) = (snapshot.motion.acceleration, snapshot.motion.velocity * snapshot.motion.velocity);
        let device = self.pulley * self.over_weight(snapshot.support_force() + snapshot.device.rack_force);
        let horizontal = snapshot.ground[0] + self.drop_time_squared * (cos * turn + sin * pull);
        let vertical = S::ONE + snapshot.ground[1] + self.drop_time_squared * (sin * turn - cos * pull);
        if self.vertical { [horizontal, vertical + side.times(device)] } else { [horizontal + device, vertical] }
    }

    /// H and V of a jolt that changes θ̇ by `jump` (rad/s) at θ, over mR; rad/s.
    pub fn jolt(&self, side: Sign, rotation: S, jump: S) -> [S; 2] {
        let (sin, cos) = self.direction(side, rotation);
        let device = -self.pulley * self.inertia * jump / self.arm(side, (sin, cos));
        let [horizontal, vertical] = [cos * jump, sin * jump];
        if self.vertical { [horizontal, vertical + side.times(device)] } else { [horizontal + device, vertical] }
    }

    /// H and V, without signs, of an impact from |θ̇| = `before` to `after` (rad/s) with `engaged` flywheels at the rack, over mR; rad/s.
    pub fn impact(&self, before: S, after: S, engaged: u32) -> [S; 2] {
        let arm = self.arm(Sign::Positive, (self.sin_slenderness, self.cos_slenderness));
        let rides = if self.vertical { S::ZERO } else { S::count(engaged) * self.mass_ratio + self.rack_mass_ratio };
        let along = self.cos_slenderness + self.pulley * rides * arm;
        [along * (before - after), self.sin_slenderness * (before + after)]
    }

    /// Travel of the terminals at θ: R∫ℓ dθ = R [ A (s sin α − sin δ) + s B (cos δ − cos α) ], slender Rℓθ; m.
    pub fn travel(&self, side: Sign, rotation: S) -> S {
        let (sin, cos) = self.direction(side, rotation);
        let [along, across] = self.lever;
        let straight = side.times(self.sin_slenderness) - sin;
        self.size * (along * straight + side.times(across) * (cos - self.cos_slenderness))
    }
}
