//! The structure as the controller believes it to be.
//!
//! The same bodies that the simulator integrates ([`crate::equation::body`]), in single precision: what the controller knows of the
//! dynamics is written nowhere else. [`rack_lever`]: the lever of the rack by its travel.

pub mod rack_lever;

use crate::equation::any_body::{AnyBody, AnyConfiguration};
use crate::equation::body::Body;
use crate::math::sign::Sign;
use crate::structure::Structure;
use crate::structure::device::KinematicsKind;
use crate::structure::drivetrain::{Drivetrain, Engagement};
use crate::structure::error::{ParameterError, require};
use rack_lever::RackLever;

/// What the controller knows of the structure beside its body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelParameters {
    /// p, 1/s; above 0.
    pub frequency: f32,
    /// p², 1/s².
    pub frequency_squared: f32,
    /// α, rad; above 0 and below π/2.
    pub slenderness: f32,
    /// R, m; above 0.
    pub size: f32,
    /// η; 0 to 1.
    pub restitution: f32,
    /// Ground acceleration at which the block uplifts, g; above 0.
    pub uplift: f32,
    /// k = σ/λ of one flywheel; 0 or more.
    pub coupling: f32,
    /// A flywheel that is engaged exchanges momentum with the block and keeps spinning when released.
    pub wheels_spin: bool,
    /// Rate at which the speed of a released flywheel decays, 1/s; 0 or more, …
    pub decay: f32,
    /// … and its constant deceleration (bearing and brake), over R, 1/s²; 0 or more.
    pub drag: f32,
    /// A flywheel stops at once when released.
    pub stops_at_once: bool,
}

/// What the controller knows of the structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// The block.
    pub body: AnyBody<f32>,
    /// The rest.
    pub parameters: ModelParameters,
    /// The lever of the rack by its travel.
    pub rack_lever: RackLever,
    /// Travel over R of each side's toe at θ = 0, by [`Body::travel`], for s = +1.
    standing_travel: f32,
    /// Lever of the rack over R at θ = 0.
    standing_arm: f32,
}

impl Model {
    /// Of a `body` in single precision, to the same bits wherever it is made.
    pub fn of(body: AnyBody<f32>, parameters: ModelParameters) -> Model {
        let standing = body.configuration(1.0, 0.0);
        Model {
            body,
            parameters,
            rack_lever: RackLever::of(&body, parameters.slenderness),
            standing_travel: body.travel(1.0, &standing),
            standing_arm: body.arm(&standing),
        }
    }

    /// Of a structure with its drivetrain. What it carries is folded into the block.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn new(structure: &Structure, drivetrain: &Drivetrain) -> Result<Model, ParameterError> {
        let amplification = drivetrain.support.amplification;
        require(
            "support_amplification",
            amplification,
            amplification == 1.0,
            "1 for a controller: its encoder is on the support",
        )?;
        let moves = drivetrain.support.given_apart;
        require("support_motion", 1.0, !moves, "none for a controller: its encoder is on the support")?;
        let structure = structure.loaded()?;
        let block = &structure.block;
        let body = structure.body(structure.device.kinematics == KinematicsKind::Consistent, true)?;
        let wheels_spin = drivetrain.engagement != Engagement::Ideal;
        let flywheel = &drivetrain.flywheel;
        let stops_at_once = !wheels_spin || flywheel.brake_deceleration.is_infinite();
        let brake = if stops_at_once { 0.0 } else { flywheel.brake_deceleration };
        let parameters = ModelParameters {
            frequency: block.frequency_parameter() as f32,
            frequency_squared: block.frequency_parameter_squared() as f32,
            slenderness: block.slenderness() as f32,
            size: block.size() as f32,
            restitution: structure.restitution()? as f32,
            uplift: structure.geometry.uplift_threshold(block.slenderness()) as f32,
            coupling: (structure.device.mass_ratio / block.inertia_ratio()) as f32,
            wheels_spin,
            decay: flywheel.viscous_rate as f32,
            drag: ((flywheel.dry_deceleration + brake) / block.size()) as f32,
            stops_at_once,
        };
        Ok(Model::of(body, parameters))
    }

    /// What θ alone decides, to be worked out once for all that need it.
    #[inline]
    pub fn configuration(&self, side: Sign, rotation: f32) -> AnyConfiguration<f32> {
        self.body.configuration(side.unit(), rotation)
    }

    /// Quantity with the sign of the terminals' acceleration that Eq. 10 compares with the velocity, 1/s²: arm · (arm · D + ℓ'θ̇²), and
    /// D with the paper's kinematics. `ground` in g, horizontal and vertical.
    #[inline]
    pub fn push(&self, side: Sign, rotation: f32, velocity: f32, ground: [f32; 2]) -> f32 {
        self.push_at(&self.configuration(side, rotation), velocity, ground)
    }

    /// [`Model::push`] in a configuration.
    #[inline]
    pub fn push_at(&self, configuration: &AnyConfiguration<f32>, velocity: f32, ground: [f32; 2]) -> f32 {
        self.body.switching(configuration, velocity, self.body.driving_moment(configuration, ground))
    }

    /// θ̈ with `engaged` flywheels locked to the rack.
    #[inline]
    pub fn acceleration(&self, side: Sign, rotation: f32, velocity: f32, ground: [f32; 2], engaged: u8) -> f32 {
        self.acceleration_at(&self.configuration(side, rotation), velocity, ground, engaged)
    }

    /// [`Model::acceleration`] in a configuration.
    #[inline]
    pub fn acceleration_at(&self, configuration: &AnyConfiguration<f32>, velocity: f32, ground: [f32; 2], engaged: u8) -> f32 {
        let driving_moment = self.body.driving_moment(configuration, ground);
        self.body.solve_acceleration(configuration, driving_moment, f32::from(engaged) * self.parameters.coupling, velocity)
    }

    /// Speed of the rack over R.
    #[inline]
    pub fn rack_speed(&self, side: Sign, rotation: f32, velocity: f32) -> f32 {
        self.body.to_terminal(&self.configuration(side, rotation), velocity)
    }

    /// θ at which the rack has travelled `travel` (over R), by one step of Newton's method from `near`: within ½ ℓ'/ℓ (θ − near)².
    #[inline]
    pub fn rotation_of_travel(&self, travel: f32, near: f32, side: Sign) -> f32 {
        let configuration = self.body.configuration(side.unit(), near);
        let reached = self.body.travel(side.unit(), &configuration) - side.times(self.standing_travel);
        near + (travel - reached) / self.body.arm(&configuration)
    }

    /// Travel of the rack over R in a small rotation from θ = 0, per rad.
    #[inline]
    pub fn standing_arm(&self) -> f32 {
        self.standing_arm
    }

    /// cos δ and sin δ (1 and δ for the slender block).
    #[inline]
    pub fn direction_cosines(&self, side: Sign, rotation: f32) -> (f32, f32) {
        let (horizontal, vertical) = self.body.factors(&self.body.configuration(side.unit(), rotation));
        (-horizontal / self.parameters.frequency_squared, -vertical / self.parameters.frequency_squared)
    }

    /// Speed of a released flywheel a time `period` (s) later; both over R, 1/s.
    #[inline]
    pub fn coasted(&self, spin: f32, period: f32) -> f32 {
        let slowed = spin.abs() * (1.0 - self.parameters.decay * period) - self.parameters.drag * period;
        let left = if slowed > 0.0 && !self.parameters.stops_at_once { slowed } else { 0.0 };
        if spin < 0.0 { -left } else { left }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;
    use crate::structure::Restitution;
    use crate::structure::block::{Block, Geometry};
    use crate::structure::device::{Device, DeviceKind, KinematicsKind};
    use crate::structure::mount::Mount;

    fn structure(geometry: Geometry, mount: Mount, kinematics: KinematicsKind) -> Structure {
        Structure {
            geometry,
            device: Device { kind: DeviceKind::ClutchedPair, mass_ratio: 0.5, mount, kinematics },
            ..Structure::new(Block::new(2.0, 0.2, 4.0 / 3.0).unwrap(), Restitution::Constant(0.85))
        }
    }

    /// Travel and rotation are each other's inverse for every body and mount, on both sides.
    #[test]
    fn rotation_follows_from_travel() {
        for mount in
            [Mount::CentreOfMass, Mount::TyingPoint { height: 3.0, pulley_ratio: 1.5 }, Mount::BaseCorners { pulley_ratio: 2.0 }]
        {
            for geometry in [Geometry::Full, Geometry::Slender] {
                inverse(&structure(geometry, mount, KinematicsKind::Paper));
            }
        }
    }

    fn inverse(structure: &Structure) {
        let model = Model::new(structure, &Drivetrain::default()).unwrap();
        for rotation in [-0.3_f32, -0.05, -1e-4, 1e-4, 0.02, 0.19, 0.4] {
            let side = Sign::of(rotation, Sign::Positive);
            // ∫ ℓ dθ by the midpoint rule in double precision.
            let n = 2000;
            let arm = |k: i32| {
                let at = f64::from(rotation) * (f64::from(k) + 0.5) / f64::from(n);
                structure.device.mount.lever_at(&structure.block, structure.geometry, at).unwrap() * f64::from(rotation)
                    / f64::from(n)
            };
            let travel: f64 = (0..n).map(arm).sum();
            let near = rotation + 2e-4;
            let found = model.rotation_of_travel(travel as f32, near, side);
            assert!((found - rotation).abs() < 3e-7, "{rotation}: {found}");
        }
    }

    #[test]
    fn eq_10_sees_the_terminals_acceleration_in_the_kinematics_of_the_model() {
        let at = |v: f32| {
            let [paper, exact] = [KinematicsKind::Paper, KinematicsKind::Consistent].map(|kinematics| {
                let structure = structure(Geometry::Full, Mount::CentreOfMass, kinematics);
                Model::new(&structure, &Drivetrain::default()).unwrap()
            });
            (paper.push(Sign::Positive, 0.1, v, [0.02, 0.0]), exact.push(Sign::Positive, 0.1, v, [0.02, 0.0]))
        };
        let (paper, _) = at(0.3);
        let delta = 0.1_f64;
        let bracket = -(3.0 * 9.80665 / 8.0) * (math::sin(delta) + 0.02 * math::cos(delta));
        assert!((f64::from(paper) - bracket).abs() < 1e-6);
        // cos δ (cos δ D + sin δ θ̇²).
        let (still, moving) = (at(0.0).1, at(0.5).1);
        assert!((f64::from(moving - still) - math::cos(delta) * math::sin(delta) * 0.25).abs() < 1e-6);
    }

    #[test]
    fn released_flywheels_slow_down_and_never_turn_back() {
        let drivetrain = Drivetrain {
            engagement: Engagement::Rigid,
            flywheel: crate::structure::drivetrain::FlywheelLosses {
                viscous_rate: 0.5,
                dry_deceleration: 0.4,
                brake_deceleration: 1.0,
                drag_rate: 0.0,
            },
            ..Drivetrain::default()
        };
        let model = Model::new(&structure(Geometry::Slender, Mount::CentreOfMass, KinematicsKind::Paper), &drivetrain).unwrap();
        let mut spin = -0.3;
        for _ in 0..2000 {
            let next = model.coasted(spin, 5e-4);
            assert!(next <= 0.0 && next >= spin);
            spin = next;
        }
        assert_eq!(spin, 0.0);
    }
}
