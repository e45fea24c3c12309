//! Blocks and devices that the lanes integrate.

use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_shared::structure::mount::Mount;

/// A block with an ideal device, at rest at first, of which only the outcome is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlainBlock {
    /// Full or slender.
    pub geometry: Geometry,
    /// Its device, at the centre of mass, paper kinematics.
    pub device: DeviceKind,
    /// α, rad.
    pub slenderness: f64,
    /// k = σ/λ; for the slender model kℓ², with any mount.
    pub coupling: f64,
    /// Restitution η.
    pub restitution: f64,
    /// Counts as overturned when |θ| reaches α, even if the ground would bring it back.
    pub overturned_at_slenderness: bool,
}

impl PlainBlock {
    /// κ k on quiet ground while it moves outward and while it moves inward.
    pub(crate) fn couplings<const PAIR: bool>(&self) -> (f64, f64) {
        (if PAIR { 0.0 } else { self.coupling }, self.coupling)
    }

    /// |θ| (rad) at which an outward motion counts as overturned, of one that does not return from beyond `no_return` (rad).
    pub(crate) fn overturned_at(&self, no_return: f64) -> f64 {
        if self.overturned_at_slenderness { self.slenderness } else { no_return }
    }

    /// Whether the lanes may take it: parameters as the core would accept them.
    pub(crate) fn is_within_range(&self) -> bool {
        (1e-4..1.5).contains(&self.slenderness) && (0.0..=1e3).contains(&self.coupling) && (0.0..=1.0).contains(&self.restitution)
    }

    /// The block of `structure`, if the lanes have its device.
    pub fn of_structure(structure: &Structure) -> Option<PlainBlock> {
        let Structure { block, geometry, device, added_mass, restitution, restitution_scatter, friction_coefficient, .. } =
            structure;
        let k = device.mass_ratio / block.inertia_ratio();
        let coupling = match (geometry, device.kind, device.mount, device.kinematics) {
            (_, DeviceKind::None, ..) => 0.0,
            (Geometry::Slender, _, mount, _) => k * mount.slender_lever_squared(block).ok()?,
            (Geometry::Full, _, Mount::CentreOfMass, KinematicsKind::Paper) => k,
            _ => return None,
        };
        let restitution = restitution.evaluate(block, *geometry, device).ok()?;
        let lanes_know = added_mass.is_none() && !restitution_scatter.is_on() && friction_coefficient.is_none();
        lanes_know.then_some(PlainBlock {
            geometry: *geometry,
            device: device.kind,
            slenderness: block.slenderness(),
            coupling,
            restitution,
            overturned_at_slenderness: false,
        })
    }
}
