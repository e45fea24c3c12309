//! Resolution of the parameters of block and drivetrain into their equations, as [`Structure::resolve`] for ideal devices.

use super::{Actuator, HybridSystem};
use crate::drivetrain::any_transmission::{AnyTransmission, TransmissionKind};
use crate::drivetrain::scaled_parameters::ScaledParameters;
use crate::math::scalar::Real;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Drivetrain, Engagement, Rack};
use crate::structure::error::{ParameterError, require};
use crate::structure::restitution::{Restitution, momentum_balance};
use crate::structure::{COUNTED_SPEED, Structure};

impl Drivetrain {
    /// The machine of `structure` with this drivetrain; `vertical` says that the ground moves vertically too.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn resolve<S: Real>(&self, structure: &Structure, vertical: bool) -> Result<HybridSystem<S>, ParameterError> {
        self.check()?;
        let heavier = 1.0 + structure.added_mass.mass_ratio;
        let structure = structure.loaded()?;
        let Structure { block, device, rest_speed, .. } = structure;
        let sigma = device.mass_ratio;
        require("mass_ratio", sigma, (0.0..=10_000.0).contains(&sigma), "from 0 to 10000")?;
        require("rest_speed", rest_speed, (1e-12..=1e-2).contains(&rest_speed), "from 1e-12 to 1e-2")?;
        structure.restitution_scatter.check()?;
        structure.base.is_rigid()?;
        let restitution = restitutions(&structure, sigma, self.rack.guided_mass_ratio / heavier)?;
        let consistent = self.needs_consistent_kinematics(device.kind) || device.kinematics == KinematicsKind::Consistent;
        let (p2, f) = (block.frequency_parameter_squared(), self.support.amplification);
        let ratio = device.mount.support_ratio();
        require("support_amplification", f, ratio.is_some() || f == 1.0, "1 for vertical devices at the base corners")?;
        let (moves, carried) = (self.support.given_apart, ratio.is_some());
        require("support_motion", 1.0, !moves || carried, "none for vertical devices at the base corners")?;
        let ratio = ratio.unwrap_or_default();
        let rides = moves && self.rack.guided_mass_ratio > 0.0;
        require("pulley_ratio", ratio, !rides || ratio == 1.0, "1 for a guided rack on a support of its own motion")?;
        let speed = block.frequency_parameter() * block.slenderness();
        Ok(HybridSystem {
            body: structure.body(consistent, vertical)?,
            transmission: AnyTransmission {
                kind: self.transmission(device.kind),
                parameters: match device.kind {
                    DeviceKind::None => ScaledParameters::default(),
                    _ => ScaledParameters::of(self, &block, sigma, heavier).on_support(self.support, sigma, ratio, p2),
                },
            },
            restitution: restitution.map(S::of),
            scatter: structure.restitution_scatter,
            slenderness: S::of(block.slenderness()),
            speed: S::of(speed),
            rest_speed: S::of(rest_speed.max(S::EPSILON.to_f64()) * speed),
            counted_speed: S::of(COUNTED_SPEED * speed),
            actuator: Actuator::of(&self.actuation),
        })
    }

    /// Whether the acceleration of the rack must be the derivative of its speed, whatever the structure says: a rack of the paper's kinematics would
    /// run away from a flywheel of its own speed, and on a support of its own motion turn against the acceleration by which Eq. 10 engages.
    pub fn needs_consistent_kinematics(&self, kind: DeviceKind) -> bool {
        match (kind, self.engagement) {
            (DeviceKind::None, _) => false,
            (DeviceKind::ClutchedPair, Engagement::Ideal) => self.support.moves(),
            (DeviceKind::Inerter, engagement) => matches!(engagement, Engagement::Viscous { .. }),
            (DeviceKind::ClutchedPair, _) => true,
        }
    }

    fn transmission(&self, kind: DeviceKind) -> TransmissionKind {
        let Drivetrain { engagement, flywheel, rack, support, .. } = self;
        let friction = *rack != Rack::default() || flywheel.viscous_rate != 0.0 || flywheel.dry_deceleration != 0.0;
        let on_support = support.moves();
        let (loaded, dragged) = (rack.load_friction != 0.0, flywheel.drag_rate != 0.0);
        match (kind, engagement) {
            (DeviceKind::None, _) => TransmissionKind::Alone,
            (DeviceKind::Inerter, _) if on_support => TransmissionKind::SingleOnSupport,
            (DeviceKind::ClutchedPair, _) if on_support => TransmissionKind::IdealOnSupport,
            (DeviceKind::Inerter, Engagement::Ideal | Engagement::Rigid) if loaded => TransmissionKind::LoadedSingle,
            (DeviceKind::ClutchedPair, Engagement::Ideal) if loaded => TransmissionKind::LoadedIdeal,
            (DeviceKind::ClutchedPair, Engagement::Rigid) if loaded => TransmissionKind::LoadedRigid,
            (DeviceKind::Inerter, Engagement::Viscous { .. }) => TransmissionKind::ViscousSingle,
            (DeviceKind::Inerter, _) if friction => TransmissionKind::SingleWithFriction,
            (DeviceKind::Inerter, _) => TransmissionKind::Single,
            (DeviceKind::ClutchedPair, Engagement::Ideal) if friction => TransmissionKind::IdealWithFriction,
            (DeviceKind::ClutchedPair, Engagement::Ideal) => TransmissionKind::Ideal,
            (DeviceKind::ClutchedPair, Engagement::Rigid) if dragged => TransmissionKind::DraggedRigid,
            (DeviceKind::ClutchedPair, Engagement::Friction { .. }) if dragged => TransmissionKind::DraggedFriction,
            (DeviceKind::ClutchedPair, Engagement::Rigid) => TransmissionKind::Rigid,
            (DeviceKind::ClutchedPair, Engagement::Overrunning) => TransmissionKind::Overrunning,
            (DeviceKind::ClutchedPair, Engagement::Friction { .. }) => TransmissionKind::Friction,
            (DeviceKind::ClutchedPair, Engagement::Elastic { .. }) => TransmissionKind::Elastic,
            (DeviceKind::ClutchedPair, Engagement::Viscous { .. }) => TransmissionKind::Viscous,
        }
    }
}

/// η with 0, 1 and 2 flywheels engaged through the impact, beside the guided rack.
fn restitutions(structure: &Structure, sigma: f64, rack: f64) -> Result<[f64; 3], ParameterError> {
    if structure.restitution != Restitution::MomentumBalance {
        return Ok([structure.restitution()?; 3]);
    }
    let Structure { block, geometry, device, .. } = structure;
    let engaged = |count: f64| momentum_balance(block, *geometry, &device.mount, rack + count * sigma);
    Ok([engaged(0.0)?, engaged(1.0)?, engaged(2.0)?])
}
