//! The energy of a rocking block.

use sprag_shared::equation::motion::Motion;
use sprag_shared::math::scalar::Real;
use sprag_shared::math::sign::Sign;
use sprag_shared::math::{cos, sin};
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};

/// Energy of the block and of its engaged flywheel over I_O p² (dimensionless), above that of rest, with the inerter at the
/// centre of mass: ½(1 + k cos²q) (θ̇/p)² + cos q − cos α, q = α − |θ|, k = σ/λ; slender ½(1 + k) (θ̇/p)² + α|θ| − ½θ².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// α, rad.
    pub slenderness: f64,
    /// p, 1/s.
    pub frequency: f64,
    /// k while engaged.
    pub coupling: f64,
    /// Full or slender.
    pub geometry: Geometry,
}

impl Energy {
    /// That of `structure`.
    pub fn of(structure: &Structure) -> Energy {
        let coupling = match structure.device.kind {
            DeviceKind::None => 0.0,
            _ => structure.device.mass_ratio / structure.block.inertia_ratio(),
        };
        Energy {
            slenderness: structure.block.slenderness(),
            frequency: structure.block.frequency_parameter(),
            coupling,
            geometry: structure.geometry,
        }
    }

    /// Whether the equations of motion conserve it: the paper's kinematics of a full block do not.
    pub fn is_conserved(structure: &Structure) -> bool {
        structure.geometry == Geometry::Slender
            || structure.device.kind == DeviceKind::None
            || structure.device.kinematics == KinematicsKind::Consistent
    }

    /// At an instant.
    pub fn at<S: Real>(&self, motion: &Motion<S>, side: Sign, engaged: bool) -> f64 {
        let rotation = side.times(motion.rotation.to_f64());
        let speed = motion.velocity.to_f64() / self.frequency;
        let k = if engaged { self.coupling } else { 0.0 };
        let cosine = cos(self.slenderness - rotation);
        let (inertia, weight) = match self.geometry {
            // cos q − cos α without its cancellation.
            Geometry::Full => (1.0 + k * cosine * cosine, 2.0 * sin(self.slenderness - 0.5 * rotation) * sin(0.5 * rotation)),
            Geometry::Slender => (1.0 + k, rotation * (self.slenderness - 0.5 * rotation)),
        };
        0.5 * inertia * speed * speed + weight
    }

    /// What it takes to overturn the block.
    pub fn barrier(&self) -> f64 {
        let half = 0.5 * self.slenderness;
        match self.geometry {
            Geometry::Full => 2.0 * sin(half) * sin(half),
            Geometry::Slender => 2.0 * half * half,
        }
    }
}
