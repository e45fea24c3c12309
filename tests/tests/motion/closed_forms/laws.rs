//! When a block uplifts and a clutch engages.

use sprag_shared::math::{cos, sin};
use sprag_shared::motion::state::Phase;
use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_shared::structure::mount::Mount;
use sprag_tests::{FullLog, Segment, relative, resized, shake, unit_block};

/// Grounds on which nothing may happen: the threshold of uplift is g tan α, or gα for the slender model (Eq. 1).
#[test]
fn uplift_threshold() {
    for degrees in [3.0, 10.0, 30.0] {
        let alpha = f64::to_radians(degrees);
        let block = Block::new(1.0, alpha, RECTANGLE_INERTIA_RATIO).expect("a block");
        for (geometry, closed) in [(Geometry::Full, sin(alpha) / cos(alpha)), (Geometry::Slender, alpha)] {
            assert!(relative(geometry.uplift_threshold(block.slenderness()), closed) < 1e-15);
            let structure = unit_block(geometry, degrees, DeviceKind::None, 0.0, 0.85);
            for (factor, rocks) in [(1.0 - 1e-12, false), (1.0 + 1e-12, true)] {
                for sign in [1.0, -1.0] {
                    let (state, log) = shake(&structure, &[Segment::constant(sign * factor * closed, 0.5)]);
                    assert_eq!(log.peaks.rocked, rocks);
                    assert_eq!(state.phase == Phase::Rocking, rocks);
                    // To the side opposite to the push.
                    assert!(!rocks || state.rotation * sign < 0.0);
                }
            }
        }
    }
}

/// Eq. 10 at every instant: a clutched inerter is engaged while acceleration and velocity of its terminals have one sign,
/// ℓθ̈ and ℓθ̇ in the paper's kinematics, ℓθ̈ + ℓ'θ̇² and ℓθ̇ in the consistent ones. The sign does not depend on κ.
#[test]
fn the_clutch_keeps_its_law() {
    let mut stretches = [0_usize; 2];
    for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
        for mount in
            [Mount::CentreOfMass, Mount::TyingPoint { height: 3.0, pulley_ratio: 2.0 }, Mount::BaseCorners { pulley_ratio: 3.0 }]
        {
            for (degrees, frequency, amplitude) in [(5.0, 4.0, 3.0), (20.0, 2.0, 1.6), (20.0, 5.0, 4.0), (35.0, 3.0, 2.0)] {
                let alpha = f64::to_radians(degrees);
                let mut structure = resized(unit_block(Geometry::Full, degrees, DeviceKind::ClutchedPair, 0.9, 0.85), 2.0);
                structure.device.mount = mount;
                structure.device.kinematics = kinematics;
                // ℓ = A cos δ + s B sin δ.
                let (a, b) = match mount {
                    Mount::CentreOfMass => (1.0, 0.0),
                    Mount::TyingPoint { height, pulley_ratio: n } => {
                        let z = height / 2.0;
                        (n * (z * cos(alpha) + sin(alpha) * sin(alpha)), n * (z * sin(alpha) - sin(alpha) * cos(alpha)))
                    }
                    Mount::BaseCorners { pulley_ratio: n } => {
                        (2.0 * n * sin(alpha) * cos(alpha), 2.0 * n * sin(alpha) * sin(alpha))
                    }
                };
                let p = structure.block.frequency_parameter();
                let level = amplitude * sin(alpha) / cos(alpha);
                let pulse = Segment::sine(level, frequency * p, core::f64::consts::TAU / (frequency * p));
                let mut log = FullLog::sampling(6);
                sprag_tests::follow(
                    &structure,
                    &sprag_tests::tight(),
                    sprag_tests::Start::Rest,
                    &[pulse, Segment::quiet(3.0 / p)],
                    &mut log,
                )
                .expect("a motion that can be followed");
                for stretch in &log.stretches {
                    let side: f64 = stretch.side.unit();
                    // The ends of a stretch are where signs change.
                    for motion in &stretch.motions[1..stretch.motions.len() - 1] {
                        let q = alpha * side - motion.rotation;
                        let lever = a * cos(q) + side * b * sin(q);
                        let rate = a * sin(q) - side * b * cos(q);
                        let quadratic =
                            if kinematics == KinematicsKind::Consistent { rate * motion.velocity * motion.velocity } else { 0.0 };
                        let power = (lever * motion.acceleration + quadratic) * lever * motion.velocity;
                        if power.abs() > 1e-12 {
                            assert_eq!(stretch.engaged, power > 0.0, "{kinematics:?} {mount:?} α = {degrees}°: {stretch:?}");
                            stretches[usize::from(stretch.engaged)] += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(stretches[0] > 1000 && stretches[1] > 1000, "{stretches:?}");
}
