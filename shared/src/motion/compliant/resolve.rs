//! Resolution of a structure's parameters into the equations of a block on a compliant foundation.

use super::CompliantSystem;
use crate::equation::clutch_rule::ClutchRule;
use crate::math;
use crate::math::scalar::Real;
use crate::motion::ground_pair::LONGEST_STEP;
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::error::{ParameterError, require};
use crate::structure::mount::Mount;
use crate::structure::{Base, Structure};

impl Structure {
    /// The equations of the structure with its added mass on its compliant base, and the longest step (s) that follows its feet. Impacts
    /// have no part in them: the restitution is not looked at.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range, or what a block on feet cannot be followed with.
    pub fn resolve_compliant<S: Real>(&self) -> Result<(CompliantSystem<S>, f64), ParameterError> {
        let Base::Compliant(foundation) = self.base else {
            let range = "there, with a damping ratio, for a block on a compliant base";
            return Err(ParameterError { parameter: "vertical_frequency", value: 0.0, range });
        };
        let (stiffness, damping) = foundation.feet()?;
        let loaded = self.loaded()?;
        let Structure { block, geometry, device, .. } = &loaded;
        let fits = |fits: bool, range| require("vertical_frequency", foundation.vertical_frequency, fits, range).map(|_| ());
        fits(*geometry == Geometry::Full, "absent for the slender block, whose toes stay where they are")?;
        let mounted = device.kind == DeviceKind::None || device.mount == Mount::CentreOfMass;
        fits(mounted, "absent for a device that is not mounted at the centre of mass")?;
        let (sin_slenderness, cos_slenderness) = math::sin_cos(block.slenderness());
        let frequency = math::square_root(2.0 * stiffness);
        let system = CompliantSystem {
            frequency_squared: S::of(block.frequency_parameter_squared()),
            inertia: S::of(block.inertia_ratio()),
            slenderness: S::of(block.slenderness()),
            stiffness: S::of(stiffness),
            damping: S::of(damping),
            mass_ratio: S::of(device.mass_ratio),
            clutch: match device.kind {
                DeviceKind::None => ClutchRule::Without,
                DeviceKind::Inerter => ClutchRule::Always,
                DeviceKind::ClutchedPair => ClutchRule::Resisting,
            },
            consistent: device.kinematics == KinematicsKind::Consistent,
            sin_slenderness: S::of(sin_slenderness),
            cos_slenderness: S::of(cos_slenderness),
        };
        // The larger of ω_v and the decay of a foot's motion.
        Ok((system, LONGEST_STEP / frequency.max(2.0 * damping)))
    }
}
