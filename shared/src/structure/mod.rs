//! Parameters of the structure: block, device with its mount, drivetrain, added mass, restitution and its scatter; in SI units, each with its range.
//!
//! [`Structure`] holds all but the [`drivetrain`]. [`inertance`] and [`gear_teeth`] are for the design of a device. The room imports `math`
//! and `equation`.

pub mod added_mass;
pub mod base;
pub mod block;
pub mod device;
pub mod drivetrain;
pub mod error;
pub mod foundation;
pub mod gear_teeth;
pub mod inertance;
pub mod mount;
pub mod restitution;
pub mod restitution_scatter;

use added_mass::AddedMass;
use block::{Block, Geometry};
use device::Device;
use error::ParameterError;

use crate::equation::FullBlock;
use crate::equation::any_body::AnyBody;
use crate::equation::body::{FullBody, SlenderBody};
use crate::math;
use crate::math::scalar::Real;

pub use base::Base;
pub use restitution::Restitution;
pub use restitution_scatter::RestitutionScatter;

/// A block with its device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Structure {
    /// The block.
    pub block: Block,
    /// Full or slender.
    pub geometry: Geometry,
    /// The device.
    pub device: Device,
    /// What rides on the block; [`AddedMass::NONE`] by default.
    pub added_mass: AddedMass,
    /// Impacts.
    pub restitution: Restitution,
    /// How impacts differ; [`RestitutionScatter::NONE`] by default, and always in the loop of ideal devices.
    pub restitution_scatter: RestitutionScatter,
    /// What it stands on; [`Base::Rigid`] by default.
    pub base: Base,
    /// θ̇/(pα) below which an impact may end in rest; 1e-12 to 1e-2, [`REST_SPEED`] by default. What remains after it is
    /// summed in closed form. Flywheels that coast then see weaker impacts: peaks differ by up to 7e-6 at the default, 0.4 % at 1e-3.
    pub rest_speed: f64,
}

/// Default of [`Structure::rest_speed`].
pub const REST_SPEED: f64 = 1e-6;

/// θ̇/(pα) with which an impact must come in to be counted; the impacts of a dying motion are infinitely many.
pub const COUNTED_SPEED: f64 = 1e-6;

impl Structure {
    /// The full block without a device, with the default of everything else.
    #[must_use]
    pub const fn new(block: Block, restitution: Restitution) -> Structure {
        Structure {
            block,
            geometry: Geometry::Full,
            device: Device::NONE,
            added_mass: AddedMass::NONE,
            restitution,
            restitution_scatter: RestitutionScatter::NONE,
            base: Base::Rigid,
            rest_speed: REST_SPEED,
        }
    }

    /// The same structure as a block that carries nothing: block, mass ratio and mount are those of the loaded block
    /// ([`AddedMass::block`], [`AddedMass::device`]), `self` as it is when there is nothing to carry. Whatever the block's α, R or λ
    /// decides (uplift, overturning, impacts) is decided by this one's; dimensionless results (θ/α, ω/p, a_g/(g tan α)) stay
    /// relative to the bare block, so that structures that carry more or less are compared on one scale.
    ///
    /// The slender model takes α', R' and λ' of the exact formulas and is linear about them.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter of the added mass that is outside its range.
    pub fn loaded(&self) -> Result<Structure, ParameterError> {
        self.added_mass.check()?;
        if self.added_mass.is_none() {
            return Ok(Structure { added_mass: AddedMass::NONE, ..*self });
        }
        let block = self.added_mass.block(&self.block)?;
        let device = self.added_mass.device(&self.block, self.geometry, &self.device);
        Ok(Structure { block, device, added_mass: AddedMass::NONE, ..*self })
    }

    /// The body of a structure that carries nothing, with `consistent` kinematics or the paper's, on ground that moves horizontally or, if
    /// `vertical`, both ways.
    ///
    /// # Errors
    /// The errors of [`mount::Mount::lever`].
    pub fn body<S: Real>(&self, consistent: bool, vertical: bool) -> Result<AnyBody<S>, ParameterError> {
        let (block, mount) = (&self.block, &self.device.mount);
        let (frequency_squared, slenderness) = (S::of(block.frequency_parameter_squared()), S::of(block.slenderness()));
        Ok(match self.geometry {
            Geometry::Slender => {
                let lever = S::of(math::square_root(mount.slender_lever_squared(block)?));
                AnyBody::Slender(SlenderBody { frequency_squared, slenderness, lever, vertical })
            }
            Geometry::Full => {
                let block = FullBlock { frequency_squared, slenderness };
                AnyBody::Full(FullBody { block, lever: mount.lever(&self.block)?.rounded(), consistent, vertical })
            }
        })
    }

    /// η of its impacts, with what it carries.
    ///
    /// # Errors
    /// The errors of [`Restitution::evaluate`] and [`Structure::loaded`].
    pub fn restitution(&self) -> Result<f64, ParameterError> {
        let Structure { block, geometry, device, restitution, .. } = self.loaded()?;
        restitution.evaluate(&block, geometry, &device)
    }
}
