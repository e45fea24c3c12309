//! The gravitational mass that rides on the block: gears, racks and housings, whose weight and inertia change the block
//! that the equations see. What their rotation does is in the inertance already.

use super::block::{Block, Geometry};
use super::device::Device;
use super::error::{ParameterError, require};
use super::mount::Mount;
use crate::math;

/// A point mass on the block's centre line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AddedMass {
    /// μ = carried mass / block mass; 0 to 10.
    pub mass_ratio: f64,
    /// z, m above the base; 0 or more.
    pub height: f64,
}

impl AddedMass {
    /// Nothing; the default.
    pub const NONE: AddedMass = AddedMass { mass_ratio: 0.0, height: 0.0 };

    /// Whether there is nothing to carry.
    pub fn is_none(&self) -> bool {
        self.mass_ratio == 0.0
    }

    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn check(&self) -> Result<(), ParameterError> {
        require("carried mass_ratio", self.mass_ratio, (0.0..=10.0).contains(&self.mass_ratio), "from 0 to 10")?;
        require("carried height", self.height, self.height >= 0.0, "0 m or more").map(|_| ())
    }

    /// The block of (1 + μ) m that `block` and what it carries are together. With the half width b = R sin α, which
    /// stays, and the height h = R cos α of the centre of mass:
    ///
    /// h' = (h + μz)/(1 + μ),  tan α' = b/h',  R'² = b² + h'²,  λ' = (λR² + μ(b² + z²)) / ((1 + μ)R'²).
    ///
    /// By the parallel-axis theorem λ' = 1 + ((λ − 1)R² + (z − h)² μ/(1 + μ)) / ((1 + μ)R'²), which is never below 1, and has
    /// no bound above.
    ///
    /// # Errors
    /// As [`AddedMass::check`]; a height so great that a result is not finite.
    pub fn block(&self, block: &Block) -> Result<Block, ParameterError> {
        self.check()?;
        let (mu, z) = (self.mass_ratio, self.height);
        let (sin, cos) = math::sin_cos(block.slenderness());
        let (size, half_width, centre) = (block.size(), block.size() * sin, block.size() * cos);
        let total = 1.0 + mu;
        let loaded_centre = (centre + mu * z) / total;
        let squared = half_width * half_width + loaded_centre * loaded_centre;
        let above = z - centre;
        let central = (block.inertia_ratio() - 1.0) * size * size + above * above * mu / total;
        Block::composite(math::square_root(squared), math::atan(half_width / loaded_centre), 1.0 + central / (total * squared))
    }

    /// `device` in terms of the loaded block: σ' = σ/(1 + μ), tied to the same point of the body. The centre of mass of the
    /// bare `block` becomes the tying point at its height: h = R cos α, or R in the slender model, where that point travels R
    /// per radian and so has the lever R/R'. Other mounts are already measured from the base.
    pub fn device(&self, block: &Block, geometry: Geometry, device: &Device) -> Device {
        let mount = match device.mount {
            Mount::CentreOfMass => {
                let height = match geometry {
                    Geometry::Full => block.size() * math::cos(block.slenderness()),
                    Geometry::Slender => block.size(),
                };
                Mount::TyingPoint { height, pulley_ratio: 1.0 }
            }
            mount => mount,
        };
        Device { mass_ratio: device.mass_ratio / (1.0 + self.mass_ratio), mount, ..*device }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equation::Equation;
    use crate::equation::FullInerter;
    use crate::equation::any_equation::AnyEquation;
    use crate::equation::body::FullBody;
    use crate::motion::ideal::IdealSystem;
    use crate::structure::Structure;
    use crate::structure::block::GRAVITY;
    use crate::structure::device::{DeviceKind, KinematicsKind};
    use crate::structure::restitution::Restitution;
    use std::string::String;

    /// What a resolved system does at θ, θ̇ and ü_g/g.
    #[derive(Debug, PartialEq)]
    struct Seen {
        released: f64,
        engaged: f64,
        restitution: f64,
        uplift: f64,
        equations: [AnyEquation<f64>; 2],
    }

    fn look_at(structure: &Structure, rotation: f64, velocity: f64, ground: f64) -> Seen {
        let system: IdealSystem<f64> = structure.resolve().unwrap();
        let side = if rotation < 0.0 { -1.0 } else { 1.0 };
        Seen {
            released: system.released.acceleration(side, rotation, velocity, ground),
            engaged: system.engaged.acceleration(side, rotation, velocity, ground),
            restitution: system.restitution,
            uplift: system.uplift,
            equations: [system.released, system.engaged],
        }
    }

    fn structure(mount: Mount, added_mass: AddedMass) -> Structure {
        Structure {
            device: Device { kind: DeviceKind::Inerter, mass_ratio: 0.7, mount, kinematics: KinematicsKind::Consistent },
            added_mass,
            ..Structure::new(Block::new(2.0, 0.3, 1.4).unwrap(), Restitution::MomentumBalance)
        }
    }

    const MOUNTS: [Mount; 3] =
        [Mount::CentreOfMass, Mount::TyingPoint { height: 3.3, pulley_ratio: 1.5 }, Mount::BaseCorners { pulley_ratio: 2.0 }];

    const LOADS: [AddedMass; 5] = [
        AddedMass { mass_ratio: 0.01, height: 0.0 },
        AddedMass { mass_ratio: 0.2, height: 4.0 },
        AddedMass { mass_ratio: 1.0, height: 1.2 },
        AddedMass { mass_ratio: 10.0, height: 0.1 },
        AddedMass { mass_ratio: 10.0, height: 9.0 },
    ];

    /// θ̈ by torques about the toe: weight and ground inertia of the block's mass and of the carried one, each where it is.
    #[test]
    fn torques_of_block_and_point_mass_give_the_same_acceleration() {
        let (half_width, height) = (2.0 * math::sin(0.3), 2.0 * math::cos(0.3));
        for (added_mass, mount) in LOADS.into_iter().flat_map(|added_mass| MOUNTS.map(|mount| (added_mass, mount))) {
            for (rotation, velocity, ground) in [(0.11, 0.8, 0.4), (0.26, -1.3, -0.9), (-0.2, 0.5, 0.7), (-0.45, -2.0, 0.0)] {
                let side = if rotation < 0.0 { -1.0 } else { 1.0 };
                let (sin, cos) = math::sin_cos(rotation);
                // Clockwise turn of the point (0, z), seen from the toe at side · half_width.
                let torque = |z: f64| {
                    let (x, y) = (-side * half_width * cos + z * sin, side * half_width * sin + z * cos);
                    GRAVITY * x - GRAVITY * ground * y
                };
                let torque = torque(height) + added_mass.mass_ratio * torque(added_mass.height);
                let inertia =
                    1.4 * 4.0 + added_mass.mass_ratio * (half_width * half_width + added_mass.height * added_mass.height);
                let tied = |n: f64, z: f64| (n * (side * half_width * sin + z * cos), n * (side * half_width * cos - z * sin));
                let (travel, rate) = match mount {
                    Mount::CentreOfMass => tied(1.0, height),
                    Mount::TyingPoint { height, pulley_ratio } => tied(pulley_ratio, height),
                    Mount::BaseCorners { pulley_ratio: n } => (n * 2.0 * half_width * cos, -n * 2.0 * half_width * sin),
                };
                let engaged = (torque - 0.7 * travel * rate * velocity * velocity) / (inertia + 0.7 * travel * travel);
                let single = structure(mount, added_mass);
                let seen = look_at(&single, rotation, velocity, ground);
                assert!((seen.engaged - engaged).abs() < 1e-12, "{added_mass:?} {mount:?}: {} and {engaged}", seen.engaged);
                let none = Structure { device: Device { kind: DeviceKind::None, ..single.device }, ..single };
                let seen = look_at(&none, rotation, velocity, ground);
                let released = torque / inertia;
                assert!((seen.released - released).abs() < 1e-12, "{added_mass:?}: {} and {released}", seen.released);
            }
        }
    }

    /// Moment about the new toe of every mass at x² + z² − b² before (turning about the old toe) and (x + b)² + z² after.
    #[test]
    fn impacts_and_uplift_are_those_of_all_the_masses() {
        let (b, h) = (2.0 * math::sin(0.3), 2.0 * math::cos(0.3));
        for added_mass in LOADS {
            let AddedMass { mass_ratio: mu, height: z } = added_mass;
            let before = 1.4 * 4.0 - 2.0 * b * b + mu * (z * z - b * b);
            let after = 1.4 * 4.0 + mu * (b * b + z * z);
            let look = |mount, restitution| {
                let structure = Structure { restitution, ..structure(mount, added_mass) };
                let seen = structure.resolve::<f64>();
                assert_eq!(structure.restitution().ok(), seen.as_ref().ok().map(|seen| seen.restitution));
                seen
            };
            // A heavy mass near the ground makes a block too stocky to rock on, unless an inerter drives it.
            match look(Mount::CentreOfMass, Restitution::Geometric) {
                Ok(seen) => {
                    assert!((seen.restitution - before / after).abs() < 1e-14, "{added_mass:?}");
                    let threshold = b * (1.0 + mu) / (h + mu * z);
                    assert!((seen.uplift - threshold).abs() < 1e-13 * threshold, "{added_mass:?}");
                }
                Err(error) => assert!(before < 0.0 && error.parameter == "geometric restitution", "{added_mass:?} {error}"),
            }
            for (mount, kept, lever) in
                [(MOUNTS[0], 0.7 * h * h, h), (MOUNTS[1], 0.7 * 4.95 * 4.95, 4.95), (MOUNTS[2], 0.0, 4.0 * b)]
            {
                let eta = (before + kept) / (after + 0.7 * lever * lever);
                match look(mount, Restitution::MomentumBalance) {
                    Ok(seen) => assert!((seen.restitution - eta).abs() < 1e-14, "{added_mass:?} {mount:?}"),
                    Err(error) => {
                        assert!(eta < 0.0 && error.parameter == "momentum-balance restitution", "{added_mass:?} {error}")
                    }
                }
            }
        }
    }

    #[test]
    fn nothing_carried_changes_no_bit_and_no_type() {
        for geometry in [Geometry::Full, Geometry::Slender] {
            for mount in MOUNTS {
                let bare = Structure { geometry, ..structure(mount, AddedMass::NONE) };
                let empty = Structure { added_mass: AddedMass { mass_ratio: 0.0, height: 5.0 }, ..bare };
                assert_eq!(empty.loaded(), Ok(bare));
                let look = |structure: Structure| look_at(&structure, 0.21, -0.4, 0.3);
                assert_eq!(look(empty), look(bare));
            }
        }
        let bare = structure(Mount::CentreOfMass, AddedMass::NONE);
        let seen = look_at(&bare, 0.21, 0.0, 0.3);
        assert!(
            matches!(seen.equations[1], AnyEquation::Centre(FullInerter { body: FullBody { consistent: true, .. }, .. })),
            "{seen:?}"
        );
        let loaded = look_at(&Structure { added_mass: LOADS[1], ..bare }, 0.21, 0.0, 0.3);
        assert!(
            matches!(loaded.equations[1], AnyEquation::Point(FullInerter { body: FullBody { consistent: true, .. }, .. })),
            "{loaded:?}"
        );
        assert_ne!(loaded.engaged, seen.engaged);
    }

    #[test]
    fn a_mass_at_the_centre_of_mass_only_changes_the_inertia() {
        for (lambda, mu) in [(4.0 / 3.0, 0.5), (1.0, 2.0), (2.5, 10.0)] {
            let block = Block::new(3.0, 0.25, lambda).unwrap();
            let loaded = AddedMass { mass_ratio: mu, height: 3.0 * math::cos(0.25) }.block(&block).unwrap();
            let ratio = (lambda + mu) / (1.0 + mu);
            assert!((loaded.size() - 3.0).abs() < 1e-15 * 4.0 && (loaded.slenderness() - 0.25).abs() < 1e-15);
            assert!((loaded.inertia_ratio() - ratio).abs() < 1e-15 * 4.0);
            assert!((loaded.frequency_parameter_squared() - GRAVITY / (3.0 * ratio)).abs() < 1e-14);
        }
    }

    /// Moment of inertia about the toe and stability angle of a block and mass whose numbers are whole: b = 3, h = 4, R = 5.
    #[test]
    fn a_block_of_three_four_five() {
        let block = Block::new(5.0, math::atan(0.75), 1.2).unwrap();
        let loaded = AddedMass { mass_ratio: 1.0, height: 8.0 }.block(&block).unwrap();
        assert!((loaded.size() * loaded.size() - 45.0).abs() < 1e-13);
        assert!((math::tan(loaded.slenderness()) - 0.5).abs() < 1e-15);
        // (1.2 · 25 + 9 + 64) / (2 · 45)
        assert!((loaded.inertia_ratio() - 103.0 / 90.0).abs() < 1e-15);
        assert!((loaded.frequency_parameter_squared() - GRAVITY * 2.0 * 45.0_f64.sqrt() / 103.0).abs() < 1e-14);
    }

    #[test]
    fn the_slender_model_is_the_limit_of_the_full_one() {
        for (added_mass, mount) in LOADS.into_iter().flat_map(|added_mass| MOUNTS.map(|mount| (added_mass, mount))) {
            let slim = Structure { block: Block::new(2.0, 1e-4, 1.4).unwrap(), ..structure(mount, added_mass) };
            let alpha = slim.loaded().unwrap().block.slenderness();
            let look = |geometry| look_at(&Structure { geometry, ..slim }, 0.3 * alpha, 0.0, 0.2 * alpha);
            let (full, slender) = (look(Geometry::Full), look(Geometry::Slender));
            // What the slender model leaves out is of the order of α or, where ℓ has a sine in it, of α'.
            let close = |a: f64, b: f64| (a / b - 1.0).abs() < 10.0 * alpha;
            assert!(close(slender.engaged, full.engaged), "{added_mass:?} {mount:?}: {slender:?} {full:?}");
            assert!(close(slender.uplift, full.uplift) && close(slender.restitution, full.restitution));
        }
    }

    #[test]
    fn a_vanishing_mass_is_no_mass_in_the_slender_model_too() {
        for mount in MOUNTS {
            let bare = Structure { geometry: Geometry::Slender, ..structure(mount, AddedMass::NONE) };
            let light = Structure { added_mass: AddedMass { mass_ratio: 1e-13, height: 4.0 }, ..bare };
            let look = |structure: Structure| look_at(&structure, 0.21, 0.0, 0.3);
            assert!((look(light).engaged / look(bare).engaged - 1.0).abs() < 1e-11, "{mount:?}");
        }
    }

    #[test]
    fn loads_outside_their_range_are_named() {
        let error = |mass_ratio, height| {
            let structure = structure(Mount::CentreOfMass, AddedMass { mass_ratio, height });
            String::from(structure.resolve::<f64>().unwrap_err().parameter)
        };
        assert_eq!(error(-0.1, 1.0), "carried mass_ratio");
        assert_eq!(error(10.1, 1.0), "carried mass_ratio");
        assert_eq!(error(f64::NAN, 1.0), "carried mass_ratio");
        assert_eq!(error(0.1, -1e-9), "carried height");
        assert_eq!(error(0.0, f64::INFINITY), "carried height");
        // The limit of σ is the bare block's.
        let heavy = structure(Mount::CentreOfMass, AddedMass { mass_ratio: 9.0, height: 1.0 });
        let heavy = Structure { device: Device { mass_ratio: 20_000.0, ..heavy.device }, ..heavy };
        let refused = heavy.resolve::<f64>().unwrap_err();
        assert_eq!((refused.parameter, refused.value), ("mass_ratio", 20_000.0));
    }
}
