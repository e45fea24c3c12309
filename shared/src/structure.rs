//! From the parameters of a block and its device to exactly the equations that they need.
//!
//! [`Structure::resolve`] chooses once, before the loop, among static compositions: what a structure does not have is not
//! in its loop at all.

use core::marker::PhantomData;

use crate::any_equation::AnyEquation;
use crate::block::{Block, Geometry};
use crate::carried::Carried;
use crate::clutch::ClutchRule;
use crate::equation::{FullBlock, FullInerter, SlenderBlock};
use crate::error::{ParameterError, require};
use crate::lever::{CentreOfMass, Mount, TyingPoint};
use crate::rocking::System;
use crate::scalar::Real;

pub use crate::restitution::Restitution;

/// Which device a block carries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DeviceKind {
    /// None.
    #[default]
    None,
    /// One inerter, always engaged.
    Inerter,
    /// Two clutched inerters (Eq. 10).
    ClutchedPair,
}

impl DeviceKind {
    /// Every kind.
    pub const ALL: [DeviceKind; 3] = [DeviceKind::None, DeviceKind::Inerter, DeviceKind::ClutchedPair];
}

/// Which acceleration the inerter's terminals have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KinematicsKind {
    /// Eq. 11: ℓ R θ̈.
    #[default]
    Paper,
    /// R (ℓ θ̈ + ℓ' θ̇²).
    Consistent,
}

/// A device and how it is mounted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Device {
    /// Which.
    pub kind: DeviceKind,
    /// σ = inertance / block mass; 0 to 10,000.
    pub mass_ratio: f64,
    /// Where.
    pub mount: Mount,
    /// Paper or consistent.
    pub kinematics: KinematicsKind,
}

impl Device {
    /// No device.
    pub const NONE: Device =
        Device { kind: DeviceKind::None, mass_ratio: 0.0, mount: Mount::CentreOfMass, kinematics: KinematicsKind::Paper };
}

/// A block with its device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Structure {
    /// The block.
    pub block: Block,
    /// Full or slender.
    pub geometry: Geometry,
    /// The device.
    pub device: Device,
    /// What rides on the block; [`Carried::NONE`] by default.
    pub carried: Carried,
    /// Impacts.
    pub restitution: Restitution,
    /// θ̇/(pα) below which an impact may end in rest; 1e-12 to 1e-2, [`REST_SPEED`] by default. What remains after it is
    /// summed in closed form. Flywheels that coast then see weaker impacts: peaks differ by up to 7e-6 at the default, 0.4 % at 1e-3.
    pub rest_speed: f64,
}

/// Default of [`Structure::rest_speed`].
pub const REST_SPEED: f64 = 1e-6;

/// θ̇/(pα) with which an impact must come in to be counted; the impacts of a dying motion are infinitely many.
pub const COUNTED_SPEED: f64 = 1e-6;

impl Structure {
    /// The same structure as a block that carries nothing: block, mass ratio and mount are those of the loaded block
    /// ([`Carried::block`], [`Carried::device`]), `self` as it is when there is nothing to carry. Whatever the block's α, R or λ
    /// decides (uplift, overturning, impacts) is decided by this one's; dimensionless results (θ/α, ω/p, a_g/(g tan α)) stay
    /// relative to the bare block, so that structures that carry more or less are compared on one scale.
    ///
    /// The slender model takes α', R' and λ' of the exact formulas and is linear about them.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter of what is carried that is outside its range.
    pub fn loaded(&self) -> Result<Structure, ParameterError> {
        self.carried.check()?;
        if self.carried.is_none() {
            return Ok(Structure { carried: Carried::NONE, ..*self });
        }
        let block = self.carried.block(&self.block)?;
        let device = self.carried.device(&self.block, self.geometry, &self.device);
        Ok(Structure { block, device, carried: Carried::NONE, ..*self })
    }

    /// η of its impacts, with what it carries.
    ///
    /// # Errors
    /// As [`Restitution::evaluate`] and [`Structure::loaded`].
    pub fn restitution(&self) -> Result<f64, ParameterError> {
        let Structure { block, geometry, device, restitution, .. } = self.loaded()?;
        restitution.evaluate(&block, geometry, &device)
    }

    /// The equations of the structure with what it carries, and its clutch.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn resolve<S: Real>(&self) -> Result<System<S>, ParameterError> {
        let sigma = self.device.mass_ratio;
        require("mass_ratio", sigma, (0.0..=10_000.0).contains(&sigma), "from 0 to 10000")?;
        self.loaded()?.compose()
    }

    /// The composition for a structure that carries nothing.
    fn compose<S: Real>(&self) -> Result<System<S>, ParameterError> {
        let p2 = self.block.frequency_parameter_squared();
        let alpha = self.block.slenderness();
        let device = &self.device;
        let coupling = device.mass_ratio / self.block.inertia_ratio();
        let speed = self.block.frequency_parameter() * alpha;
        let rest = require("rest_speed", self.rest_speed, (1e-12..=1e-2).contains(&self.rest_speed), "from 1e-12 to 1e-2")?;
        let restitution = self.restitution.evaluate(&self.block, self.geometry, device)?;
        let clutch = match device.kind {
            DeviceKind::None => ClutchRule::Without,
            DeviceKind::Inerter => ClutchRule::Always,
            DeviceKind::ClutchedPair => ClutchRule::Resisting,
        };
        let [released, engaged] = self.equations(p2, coupling)?;
        Ok(System {
            released,
            engaged,
            restitution: S::of(restitution),
            uplift: S::of(self.geometry.uplift_threshold(&self.block)),
            slenderness: S::of(alpha),
            rest_speed: S::of(rest * speed),
            counted_speed: S::of(COUNTED_SPEED * speed),
            clutch,
        })
    }

    /// The equations with the inerter released and engaged; what the device cannot be is the other one again.
    fn equations<S: Real>(&self, p2: f64, coupling: f64) -> Result<[AnyEquation<S>; 2], ParameterError> {
        let Structure { block, device, .. } = self;
        let alpha = block.slenderness();
        if self.geometry == Geometry::Slender {
            let squared = device.mount.slender_lever_squared(block)?;
            let equation = |engaged: bool| {
                let inertia = if engaged { 1.0 + coupling * squared } else { 1.0 };
                AnyEquation::Slender(SlenderBlock {
                    frequency_squared: S::of(p2 / inertia),
                    slenderness: S::of(alpha),
                    inertia: S::of(inertia),
                    lever: S::of(crate::math::square_root(squared)),
                })
            };
            return Ok([equation(device.kind == DeviceKind::Inerter), equation(device.kind != DeviceKind::None)]);
        }
        let block = FullBlock { frequency_squared: S::of(p2), slenderness: S::of(alpha) };
        let alone = AnyEquation::Block(block);
        if device.kind == DeviceKind::None {
            return Ok([alone; 2]);
        }
        let constants = device.mount.lever(&self.block)?;
        let point = TyingPoint { along: S::of(constants.along), across: S::of(constants.across) };
        let inerter = |coupling: f64| {
            let coupling = S::of(coupling);
            match (device.mount, device.kinematics) {
                (Mount::CentreOfMass, KinematicsKind::Paper) => {
                    AnyEquation::CentrePaper(FullInerter { block, coupling, lever: CentreOfMass, kinematics: PhantomData })
                }
                (Mount::CentreOfMass, KinematicsKind::Consistent) => {
                    AnyEquation::CentreConsistent(FullInerter { block, coupling, lever: CentreOfMass, kinematics: PhantomData })
                }
                (_, KinematicsKind::Paper) => {
                    AnyEquation::PointPaper(FullInerter { block, coupling, lever: point, kinematics: PhantomData })
                }
                (_, KinematicsKind::Consistent) => {
                    AnyEquation::PointConsistent(FullInerter { block, coupling, lever: point, kinematics: PhantomData })
                }
            }
        };
        let engaged = inerter(coupling);
        Ok(match (device.kind, device.kinematics) {
            (DeviceKind::Inerter, _) => [engaged; 2],
            // The clutch watches the terminals' acceleration, which is not that of a bare block.
            (_, KinematicsKind::Consistent) => [inerter(0.0), engaged],
            (_, KinematicsKind::Paper) => [alone, engaged],
        })
    }
}
