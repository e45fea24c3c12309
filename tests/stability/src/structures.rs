//! Blocks and devices.

use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind};
use sprag_shared::structure::{Restitution, Structure};

/// Both equations of motion.
pub const GEOMETRIES: [Geometry; 2] = [Geometry::Full, Geometry::Slender];

/// A block of unit frequency parameter, so that seconds read as times 1/p, with a device at its centre of mass in the
/// paper's kinematics. `slenderness` in degrees.
pub fn unit_block(geometry: Geometry, slenderness: f64, device: DeviceKind, mass_ratio: f64, restitution: f64) -> Structure {
    let block = Block::of_unit_frequency(slenderness.to_radians(), RECTANGLE_INERTIA_RATIO).expect("a slenderness within range");
    Structure {
        geometry,
        device: Device { kind: device, mass_ratio, ..Device::NONE },
        ..Structure::new(block, Restitution::Constant(restitution))
    }
}

/// The same structure with a block of `size` R (m) in place of the unit frequency.
pub fn resized(structure: Structure, size: f64) -> Structure {
    let block = Block::new(size, structure.block.slenderness(), structure.block.inertia_ratio()).expect("a size above 0");
    Structure { block, ..structure }
}
