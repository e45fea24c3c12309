//! From the parameters of a block and its device to exactly the equations that they need.
//!
//! [`Structure::resolve`] chooses once, before the loop, among static compositions: what a structure does not have is not
//! in its loop at all.

use core::marker::PhantomData;

use crate::block::{Block, Geometry};
use crate::carried::Carried;
use crate::clutch::{Clutch, ClutchedPair, NoInerter, SingleInerter};
use crate::detected::Switched;
use crate::equation::{Consistent, Equation, FullBlock, FullInerter, Kinematics, Paper, SlenderBlock};
use crate::error::{ParameterError, require};
use crate::lever::{CentreOfMass, Lever, Mount, TyingPoint};
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

/// What to do with the resolved system; called once, with its own types.
pub trait WithSystem<S: Real> {
    /// The result.
    type Output;

    /// Goes on with `system`.
    fn with<R: Equation<S>, E: Switched<S>, C: Clutch>(self, system: System<S, R, E, C>) -> Self::Output;
}

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

    /// Resolves the structure, with what it carries, and hands the system to `next`.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn resolve<S: Real, W: WithSystem<S>>(&self, next: W) -> Result<W::Output, ParameterError> {
        let sigma = self.device.mass_ratio;
        require("mass_ratio", sigma, (0.0..=10_000.0).contains(&sigma), "from 0 to 10000")?;
        self.loaded()?.compose(next)
    }

    /// The composition for a structure that carries nothing.
    fn compose<S: Real, W: WithSystem<S>>(&self, next: W) -> Result<W::Output, ParameterError> {
        let p2 = self.block.frequency_parameter_squared();
        let alpha = self.block.slenderness();
        let device = &self.device;
        let coupling = device.mass_ratio / self.block.inertia_ratio();
        let common = Common {
            restitution: self.restitution.evaluate(&self.block, self.geometry, device)?,
            uplift: self.geometry.uplift_threshold(&self.block),
            slenderness: alpha,
            speed: self.block.frequency_parameter() * alpha,
            rest: require("rest_speed", self.rest_speed, (1e-12..=1e-2).contains(&self.rest_speed), "from 1e-12 to 1e-2")?,
        };
        match self.geometry {
            Geometry::Slender => {
                let squared = device.mount.slender_lever_squared(&self.block)?;
                let equation = |engaged: bool| {
                    let inertia = if engaged { 1.0 + coupling * squared } else { 1.0 };
                    SlenderBlock {
                        frequency_squared: S::of(p2 / inertia),
                        slenderness: S::of(alpha),
                        inertia: S::of(inertia),
                        lever: S::of(crate::math::square_root(squared)),
                    }
                };
                Ok(match device.kind {
                    DeviceKind::None => next.with(common.system::<S, _, _, NoInerter>(equation(false), equation(false))),
                    DeviceKind::Inerter => next.with(common.system::<S, _, _, SingleInerter>(equation(true), equation(true))),
                    DeviceKind::ClutchedPair => {
                        next.with(common.system::<S, _, _, ClutchedPair>(equation(false), equation(true)))
                    }
                })
            }
            Geometry::Full => {
                let block = FullBlock { frequency_squared: S::of(p2), slenderness: S::of(alpha) };
                if device.kind == DeviceKind::None {
                    return Ok(next.with(common.system::<S, _, _, NoInerter>(block, block)));
                }
                let constants = device.mount.lever(&self.block)?;
                let point = TyingPoint { along: S::of(constants.along), across: S::of(constants.across) };
                Ok(match (device.mount, device.kinematics) {
                    (Mount::CentreOfMass, KinematicsKind::Paper) => {
                        common.full::<S, _, Paper, W>(device.kind, block, coupling, CentreOfMass, next)
                    }
                    (Mount::CentreOfMass, KinematicsKind::Consistent) => {
                        common.full::<S, _, Consistent, W>(device.kind, block, coupling, CentreOfMass, next)
                    }
                    (_, KinematicsKind::Paper) => common.full::<S, _, Paper, W>(device.kind, block, coupling, point, next),
                    (_, KinematicsKind::Consistent) => {
                        common.full::<S, _, Consistent, W>(device.kind, block, coupling, point, next)
                    }
                })
            }
        }
    }
}

/// What every composition shares.
struct Common {
    restitution: f64,
    uplift: f64,
    slenderness: f64,
    speed: f64,
    rest: f64,
}

impl Common {
    fn system<S: Real, R, E, C>(&self, released: R, engaged: E) -> System<S, R, E, C> {
        System {
            released,
            engaged,
            restitution: S::of(self.restitution),
            uplift: S::of(self.uplift),
            slenderness: S::of(self.slenderness),
            rest_speed: S::of(self.rest * self.speed),
            counted_speed: S::of(COUNTED_SPEED * self.speed),
            clutch: PhantomData,
        }
    }

    fn full<S: Real, L: Lever<S>, K: Kinematics, W: WithSystem<S>>(
        &self,
        kind: DeviceKind,
        block: FullBlock<S>,
        coupling: f64,
        lever: L,
        next: W,
    ) -> W::Output {
        let engaged = FullInerter { block, coupling: S::of(coupling), lever, kinematics: PhantomData::<K> };
        match kind {
            DeviceKind::ClutchedPair if K::CONSISTENT => {
                next.with(self.system::<S, _, _, ClutchedPair>(engaged.with_coupling(S::of(0.0)), engaged))
            }
            DeviceKind::ClutchedPair => next.with(self.system::<S, _, _, ClutchedPair>(block, engaged)),
            _ => next.with(self.system::<S, _, _, SingleInerter>(engaged, engaged)),
        }
    }
}
