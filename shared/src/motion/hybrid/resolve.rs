//! Resolution of the parameters of block and drivetrain into their equations, as [`Structure::resolve`] for ideal devices.

use super::{Actuator, HybridSystem};
use crate::drivetrain::any_transmission::AnyTransmission;
use crate::drivetrain::elastic::ElasticPair;
use crate::drivetrain::friction::FrictionPair;
use crate::drivetrain::ideal::{Alone, IdealPair, Single};
use crate::drivetrain::overrunning::OverrunningPair;
use crate::drivetrain::rigid::RigidPair;
use crate::drivetrain::scaled_parameters::ScaledParameters;
use crate::equation::FullBlock;
use crate::equation::any_body::AnyBody;
use crate::equation::body::{FullBody, SlenderBody};
use crate::equation::kinematics::{BodyKinematics, RuntimeKinematics};
use crate::equation::lever::TyingPoint;
use crate::math;
use crate::math::scalar::Real;
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Drivetrain, Engagement, Rack};
use crate::structure::error::{ParameterError, require};
use crate::structure::restitution::Restitution;
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
        let sigma = structure.device.mass_ratio;
        require("mass_ratio", sigma, (0.0..=10_000.0).contains(&sigma), "from 0 to 10000")?;
        let rest = structure.rest_speed;
        require("rest_speed", rest, (1e-12..=1e-2).contains(&rest), "from 1e-12 to 1e-2")?;
        let rack = self.rack.guided_mass_ratio / heavier;
        let restitution = restitutions(&structure, sigma, rack)?;
        let parts = Parts { drivetrain: *self, structure, vertical, heavier, restitution };
        let body = match structure.geometry {
            Geometry::Slender => AnyBody::Slender(parts.slender()?),
            Geometry::Full => AnyBody::Full(parts.full()?),
        };
        Ok(parts.machine(body))
    }

    /// Whether flywheels have a speed of their own. Such a device moves by the consistent kinematics, whatever the structure
    /// says: a rack whose acceleration is not the derivative of its speed would run away from a flywheel locked to it.
    pub fn has_memory(&self, kind: DeviceKind) -> bool {
        kind == DeviceKind::ClutchedPair && self.engagement != Engagement::Ideal
    }
}

/// η with 0, 1 and 2 flywheels engaged through the impact, beside the guided rack.
fn restitutions(structure: &Structure, sigma: f64, rack: f64) -> Result<[f64; 3], ParameterError> {
    if structure.restitution != Restitution::MomentumBalance {
        return Ok([structure.restitution()?; 3]);
    }
    let engaged = |count: f64| {
        crate::structure::restitution::momentum_balance(
            &structure.block,
            structure.geometry,
            &structure.device.mount,
            rack + count * sigma,
        )
    };
    Ok([engaged(0.0)?, engaged(1.0)?, engaged(2.0)?])
}

struct Parts {
    drivetrain: Drivetrain,
    structure: Structure,
    /// The ground moves vertically too.
    vertical: bool,
    /// Its mass over that of the bare block.
    heavier: f64,
    restitution: [f64; 3],
}

impl Parts {
    fn remembers(&self) -> bool {
        self.drivetrain.has_memory(self.structure.device.kind)
    }

    fn slender<S: Real>(&self) -> Result<SlenderBody<S>, ParameterError> {
        let Structure { block, device, .. } = &self.structure;
        Ok(SlenderBody {
            frequency_squared: S::of(block.frequency_parameter_squared()),
            slenderness: S::of(block.slenderness()),
            lever: S::of(math::square_root(device.mount.slender_lever_squared(block)?)),
            vertical: self.vertical,
        })
    }

    fn full<S: Real>(&self) -> Result<FullBody<S, RuntimeKinematics>, ParameterError> {
        let Structure { block, device, .. } = &self.structure;
        let constants = device.mount.lever(block)?;
        Ok(FullBody {
            block: FullBlock {
                frequency_squared: S::of(block.frequency_parameter_squared()),
                slenderness: S::of(block.slenderness()),
            },
            lever: TyingPoint { along: S::of(constants.along), across: S::of(constants.across) },
            kinematics: RuntimeKinematics::chosen(self.remembers() || device.kinematics == KinematicsKind::Consistent),
            vertical: self.vertical,
        })
    }

    fn parameters<S: Real>(&self) -> ScaledParameters<S> {
        ScaledParameters::of(&self.drivetrain, &self.structure.block, self.structure.device.mass_ratio, self.heavier)
    }

    fn transmission<S: Real>(&self) -> AnyTransmission<S> {
        let parameters = self.parameters();
        let Drivetrain { engagement, flywheel, rack, .. } = &self.drivetrain;
        let friction = *rack != Rack::default() || flywheel.viscous_rate != 0.0 || flywheel.dry_deceleration != 0.0;
        match (self.structure.device.kind, friction) {
            (DeviceKind::None, _) => AnyTransmission::Alone(Alone),
            (DeviceKind::Inerter, false) => AnyTransmission::Single(Single(parameters)),
            (DeviceKind::Inerter, true) => AnyTransmission::SingleWithFriction(Single(parameters)),
            (DeviceKind::ClutchedPair, _) => match engagement {
                Engagement::Ideal if friction => AnyTransmission::IdealWithFriction(IdealPair(parameters)),
                Engagement::Ideal => AnyTransmission::Ideal(IdealPair(parameters)),
                Engagement::Rigid => AnyTransmission::Rigid(RigidPair(parameters)),
                Engagement::Overrunning => AnyTransmission::Overrunning(OverrunningPair(parameters)),
                Engagement::Friction { .. } => AnyTransmission::Friction(FrictionPair(parameters)),
                Engagement::Elastic { .. } => AnyTransmission::Elastic(ElasticPair(parameters)),
            },
        }
    }

    fn machine<S: Real>(&self, body: AnyBody<S>) -> HybridSystem<S> {
        let block = &self.structure.block;
        let speed = block.frequency_parameter() * block.slenderness();
        HybridSystem {
            body,
            transmission: self.transmission(),
            restitution: self.restitution.map(S::of),
            slenderness: S::of(block.slenderness()),
            speed: S::of(speed),
            rest_speed: S::of(self.structure.rest_speed * speed),
            counted_speed: S::of(COUNTED_SPEED * speed),
            actuator: Actuator::of(&self.drivetrain.actuation),
        }
    }
}
