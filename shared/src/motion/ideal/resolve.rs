//! Resolution of a structure's parameters into its equations of motion, once, before the loop.

use super::IdealSystem;
use crate::equation::any_equation::AnyEquation;
use crate::equation::body::FullBody;
use crate::equation::clutch_rule::ClutchRule;
use crate::equation::lever::CentreOfMass;
use crate::equation::{FullBlock, FullInerter, SlenderBlock};
use crate::math::scalar::Real;
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::error::{ParameterError, require};
use crate::structure::mount::Mount;
use crate::structure::{COUNTED_SPEED, Structure};

impl Structure {
    /// Equations of the structure with its added mass, and its clutch.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn resolve<S: Real>(&self) -> Result<IdealSystem<S>, ParameterError> {
        let sigma = self.device.mass_ratio;
        require("mass_ratio", sigma, (0.0..=10_000.0).contains(&sigma), "from 0 to 10000")?;
        let loaded = self.loaded()?;
        let Structure { block, geometry, device, restitution, rest_speed, .. } = &loaded;
        let speed = block.frequency_parameter() * block.slenderness();
        let scatter = self.restitution_scatter.deviation;
        require("restitution_scatter", scatter, scatter == 0.0, "0 in the loop of ideal devices")?;
        self.base.is_rigid()?;
        let rest = require("rest_speed", *rest_speed, (1e-12..=1e-2).contains(rest_speed), "from 1e-12 to 1e-2")?;
        let restitution = restitution.evaluate(block, *geometry, device)?;
        let [released, engaged] = loaded.equations()?;
        Ok(IdealSystem {
            released,
            engaged,
            restitution: S::of(restitution),
            uplift: S::of(geometry.uplift_threshold(block.slenderness())),
            slenderness: S::of(block.slenderness()),
            rest_speed: S::of(rest * speed),
            counted_speed: S::of(COUNTED_SPEED * speed),
            clutch: match device.kind {
                DeviceKind::None => ClutchRule::Without,
                DeviceKind::Inerter => ClutchRule::Always,
                DeviceKind::ClutchedPair => ClutchRule::Resisting,
            },
        })
    }

    /// The equations with the inerter released and engaged; what the device cannot be is the other one again.
    fn equations<S: Real>(&self) -> Result<[AnyEquation<S>; 2], ParameterError> {
        let Structure { block, device, .. } = self;
        let (p2, alpha) = (block.frequency_parameter_squared(), block.slenderness());
        let coupling = device.mass_ratio / block.inertia_ratio();
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
        let lever = device.mount.lever(&self.block)?.rounded();
        let consistent = device.kinematics == KinematicsKind::Consistent;
        let inerter = |coupling: f64| {
            let coupling = S::of(coupling);
            match device.mount {
                Mount::CentreOfMass => {
                    let body = FullBody { block, lever: CentreOfMass, consistent, vertical: false };
                    AnyEquation::Centre(FullInerter { body, coupling })
                }
                _ => AnyEquation::Point(FullInerter { body: FullBody { block, lever, consistent, vertical: false }, coupling }),
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
