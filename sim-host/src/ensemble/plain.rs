//! Which devices of a scene the lanes know.

use sprag_shared::block::Geometry;
use sprag_shared::lever::Mount;
use sprag_shared::structure::{DeviceKind, KinematicsKind, Structure};

use crate::scene::Scene;
use crate::scene::accuracy::{AccuracyTable, MethodName};

/// A block with an ideal device, at rest at first, of which nothing is asked but what becomes of it.
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
    /// η.
    pub restitution: f64,
}

impl PlainBlock {
    /// The block of `scene` with device number `device`, if it is one; whatever the ground does.
    pub fn of(scene: &Scene, device: usize) -> Option<PlainBlock> {
        let file = &scene.file;
        let carrier = scene.devices.get(device)?;
        let AccuracyTable { level, method, step_s, step_ratio, precision, .. } = &file.accuracy;
        let as_it_is = level.is_none() && *method == MethodName::Taylor && step_s.is_none() && step_ratio.is_none();
        let plain = as_it_is
            && *precision == Default::default()
            && file.vertical.is_empty()
            && file.block.initial_rotation_ratio == 0.0
            && file.block.initial_velocity_ratio == 0.0
            && carrier.is_ideal();
        if plain { PlainBlock::of_structure(&scene.structure(device)) } else { None }
    }

    /// That of `structure`, if its inerter turns as the lanes know it.
    pub fn of_structure(structure: &Structure) -> Option<PlainBlock> {
        let Structure { block, geometry, device, carried, restitution, .. } = structure;
        let k = device.mass_ratio / block.inertia_ratio();
        let coupling = match (geometry, device.kind, device.mount, device.kinematics) {
            (_, DeviceKind::None, ..) => 0.0,
            (Geometry::Slender, _, mount, _) => k * mount.slender_lever_squared(block).ok()?,
            (Geometry::Full, _, Mount::CentreOfMass, KinematicsKind::Paper) => k,
            _ => return None,
        };
        let restitution = restitution.evaluate(block, *geometry, device).ok()?;
        carried.is_none().then_some(PlainBlock {
            geometry: *geometry,
            device: device.kind,
            slenderness: block.slenderness(),
            coupling,
            restitution,
        })
    }
}
