//! The lever of the rack as the rack's own travel shows it, without an angle.
//!
//! Every mount has ℓ = A cos δ + s B sin δ and ℓ' = A sin δ − s B cos δ ([`crate::equation::lever`]), so ℓ² + ℓ'² is a constant, and T = ∫ ℓ dθ
//! from θ = 0 is ℓ'₀ − ℓ' where θ is positive. Hence to either side
//!
//! ℓ² = ℓ₀² + 2 ℓ'₀ |T| − T²,
//!
//! and ℓ² = ℓ₀² of the slender block. All levers and travels over R.

use crate::equation::any_body::AnyBody;
use crate::equation::body::Body;
use crate::math::square_root32;

/// ℓ over its value at |θ| = α/2, by the travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RackLever {
    /// The terms of (ℓ/ℓ(α/2))²: constant, by |T| and by −T².
    terms: [f32; 3],
    /// |T| at |θ| = α. A block is seldom beyond it for long, and a count that is beyond it by far is a wrong one.
    most: f32,
}

impl RackLever {
    /// Of the rack on `body` of slenderness α (rad); 0 everywhere where the lever at α/2 is not positive.
    pub fn of(body: &AnyBody<f32>, slenderness: f32) -> RackLever {
        let [standing, middle, balanced] = [0.0_f32, 0.5, 1.0].map(|share| body.configuration(1.0, share * slenderness));
        let [arm, reference] = [&standing, &middle].map(|at| body.arm(at));
        let (begin, end) = (body.travel(1.0, &standing), body.travel(1.0, &balanced));
        let (growth, curvature) = match body {
            AnyBody::Slender(_) => (0.0, 0.0),
            // Its travel is −ℓ'.
            AnyBody::Full(_) => (-2.0 * begin, 1.0),
        };
        let scale = if reference > 0.0 { 1.0 / (reference * reference) } else { 0.0 };
        RackLever { terms: [arm * arm * scale, growth * scale, curvature * scale], most: end - begin }
    }

    /// ℓ over ℓ(α/2) where the rack has travelled `travel` from θ = 0, or as far as at |θ| = α.
    #[inline]
    pub fn at(&self, travel: f32) -> f32 {
        let [constant, growth, curvature] = self.terms;
        let away = travel.abs();
        let away = if away < self.most { away } else { self.most };
        let square = constant + (growth - curvature * away) * away;
        if square > 0.0 { square_root32(square) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::model::Model;
    use crate::structure::block::{Block, Geometry};
    use crate::structure::device::{Device, DeviceKind, KinematicsKind};
    use crate::structure::drivetrain::Drivetrain;
    use crate::structure::mount::Mount;
    use crate::structure::{Restitution, Structure};

    const MOUNTS: [Mount; 4] = [
        Mount::CentreOfMass,
        Mount::TyingPoint { height: 0.2, pulley_ratio: 4.0 },
        Mount::TyingPoint { height: 3.0, pulley_ratio: 1.5 },
        Mount::BaseCorners { pulley_ratio: 2.0 },
    ];

    fn each(mut check: impl FnMut(&Structure, &RackLever)) {
        for slenderness in [0.1, 0.35, 60_f64.to_radians()] {
            for mount in MOUNTS {
                for geometry in [Geometry::Full, Geometry::Slender] {
                    for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
                        let block = Block::new(2.0, slenderness, 4.0 / 3.0).unwrap();
                        let device = Device { kind: DeviceKind::ClutchedPair, mass_ratio: 0.5, mount, kinematics };
                        let structure = Structure { geometry, device, ..Structure::new(block, Restitution::Constant(0.8)) };
                        let body = Model::new(&structure, &Drivetrain::default()).unwrap().body;
                        check(&structure, &RackLever::of(&body, slenderness as f32));
                    }
                }
            }
        }
    }

    /// Against the mount's own lever, at the travel that is its integral.
    #[test]
    fn the_travel_shows_the_lever_of_every_mount_on_both_sides() {
        each(|structure, lever| {
            let (block, mount, geometry) = (&structure.block, &structure.device.mount, structure.geometry);
            let slenderness = block.slenderness();
            let at = |rotation: f64| mount.lever_at(block, geometry, rotation).unwrap();
            for share in [-1.0, -0.6, -0.1, -1e-3, 1e-3, 0.3, 0.5, 0.9, 1.0] {
                let (rotation, n) = (share * slenderness, 2000_i32);
                let travel: f64 =
                    (0..n).map(|k| at(rotation * (f64::from(k) + 0.5) / f64::from(n))).sum::<f64>() * rotation / f64::from(n);
                let (found, expected) = (f64::from(lever.at(travel as f32)), at(rotation) / at(0.5 * slenderness));
                assert!((found / expected - 1.0).abs() < 2e-5, "{mount:?} {geometry:?} at {share} α: {found} for {expected}");
            }
        });
    }

    /// A count that is nowhere near the block must not make its own error look small.
    #[test]
    fn a_travel_that_cannot_be_has_the_lever_of_balance() {
        each(|structure, lever| {
            let block = &structure.block;
            let at = |rotation: f64| structure.device.mount.lever_at(block, structure.geometry, rotation).unwrap();
            let balanced = at(block.slenderness()) / at(0.5 * block.slenderness());
            for travel in [10.0, -1e3, f32::MAX, f32::INFINITY, f32::NAN] {
                assert!((f64::from(lever.at(travel)) / balanced - 1.0).abs() < 2e-5, "{travel}");
            }
        });
    }
}
