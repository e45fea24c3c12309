//! Every closed form that a rocking block has, against the simulator.
//!
//! The closed forms are written here once more from the paper and from the theory of the linearised block; they share
//! nothing with the simulator but `sprag_shared::math`.

mod free_motion;
mod laws;
mod overturning;

use sprag_shared::math::square_root;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::{GRAVITY, Geometry};
use sprag_shared::structure::device::DeviceKind;
use sprag_tests::{resized, unit_block};

/// A slender block of 1.7 m without a device and the same with an inerter of σ = 0.5, each with its p or p_σ.
fn slender_blocks() -> [(Structure, f64); 2] {
    [(DeviceKind::None, 0.0), (DeviceKind::Inerter, 0.5)].map(|(device, mass_ratio)| {
        let structure = resized(unit_block(Geometry::Slender, 11.0, device, mass_ratio, 0.85), 1.7);
        let p2 = 0.75 * GRAVITY / 1.7 / (1.0 + 0.75 * mass_ratio);
        (structure, square_root(p2))
    })
}
