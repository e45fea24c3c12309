//! Impacts: momentum by point masses and impulses, the cone of friction, and energy.

use super::*;
use crate::math;
use crate::math::sign::Sign;

/// Momentum and moment of momentum about the centre of mass of a block of mass 1 and R = 1 that turns at `rate` (clockwise) about a toe at
/// `toe` (from the middle of the base) that moves at `slip`: horizontal, vertical, angular.
fn momentum(alpha: f64, inertia: f64, toe: f64, rate: f64, slip: f64) -> [f64; 3] {
    // Velocity of the centre of mass, at (0, cos α), is that of the toe and a turn about it.
    let (dx, dz) = (0.0 - toe, math::cos(alpha));
    [slip + rate * dz, -rate * dx, (inertia - 1.0) * rate]
}

fn energy(alpha: f64, inertia: f64, toe: f64, rate: f64, slip: f64) -> f64 {
    let [x, z, spin] = momentum(alpha, inertia, toe, rate, slip);
    0.5 * (x * x + z * z + spin * spin / (inertia - 1.0))
}

/// For many impacts, on both sides, with and without sliding before.
#[test]
fn impulses_at_the_new_toe_within_the_cone_change_the_momentum() {
    let (mut stuck, mut slid, mut both) = (0, 0, 0);
    for alpha in [0.1, 0.3, 0.5, 0.7] {
        for friction in [0.02, 0.1, 0.3, 0.6, 1.2] {
            let system: SlidingSystem<f64> = block(alpha, friction).resolve_sliding().unwrap();
            for slip in [0.0, 0.02, -0.02, 0.3, -0.3, 2.0, -2.0] {
                for side in [Sign::Positive, Sign::Negative] {
                    let before = -side.unit::<f64>() * 0.7;
                    let landing = system.land(side, before, slip);
                    let (old, new) = (side.times(math::sin(alpha)), -side.times(math::sin(alpha)));
                    let was = momentum(alpha, 4.0 / 3.0, old, before, slip);
                    // On both toes it has no velocity of its own across the ground.
                    let is = momentum(alpha, 4.0 / 3.0, new, landing.velocity, landing.slip);
                    let [along, normal, turn] = [0, 1, 2].map(|i| is[i] - was[i]);
                    assert!(normal > 0.0);
                    // Clockwise moment of the impulse about the centre of mass, from where on the base it acts.
                    let arm = (-turn - along * math::cos(alpha)) / normal;
                    let half = math::sin(alpha);
                    let at_toe = if landing.velocity == 0.0 { arm.abs() <= half + 1e-12 } else { (arm - new).abs() < 1e-12 };
                    assert!(at_toe, "{alpha} {friction} {slip} {side:?}: {arm} {new}");
                    if landing.slip == 0.0 {
                        assert!(along.abs() <= friction * normal + 1e-12);
                        stuck += 1;
                    } else {
                        let opposed = -landing.slip.signum() * friction * normal;
                        assert!((along - opposed).abs() < 1e-12, "{along} {opposed}");
                        slid += 1;
                    }
                    both += usize::from(landing.velocity == 0.0);
                    let (first, last) = (
                        energy(alpha, 4.0 / 3.0, old, before, slip),
                        energy(alpha, 4.0 / 3.0, new, landing.velocity, landing.slip),
                    );
                    assert!(last <= first, "{first} {last}");
                }
            }
        }
    }
    assert!(stuck > 20 && slid > 20 && both > 20, "{stuck} {slid} {both}");
}

/// A given restitution below that of the block's momentum takes more, whether the impact slides or not.
#[test]
fn a_lower_restitution_never_adds_energy() {
    for alpha in [0.15, 0.4] {
        for eta in [0.0, 0.5, 0.7, 0.85] {
            for friction in [0.05, 0.3, 0.9] {
                let structure = Structure { restitution: Restitution::Constant(eta), ..block(alpha, friction) };
                let Ok(system) = structure.resolve_sliding::<f64>() else { continue };
                for slip in [0.0, 0.1, -0.1, 1.0, -1.0] {
                    let landing = system.land(Sign::Positive, -1.0, slip);
                    let toe = math::sin(alpha);
                    let (first, last) = (
                        energy(alpha, 4.0 / 3.0, toe, -1.0, slip),
                        energy(alpha, 4.0 / 3.0, -toe, landing.velocity, landing.slip),
                    );
                    assert!(last <= first * (1.0 + 1e-14) && landing.velocity <= 0.0, "{alpha} {eta} {friction} {slip}");
                }
            }
        }
    }
}

/// The impulses of an impact that sticks need a friction of (1 − η)/((1 + η) tan α); with more it sticks, with less it slides.
#[test]
fn it_sticks_down_to_the_friction_that_the_checks_name() {
    for (alpha, eta) in [(0.1745, 0.85), (0.3, 0.6)] {
        let needed = (1.0 - eta) / (1.0 + eta) / math::tan(alpha);
        for (factor, sticks) in [(1.0 + 1e-9, true), (1.0 - 1e-9, false)] {
            let structure = Structure { restitution: Restitution::Constant(eta), ..block(alpha, needed * factor) };
            let system: SlidingSystem<f64> = structure.resolve_sliding().unwrap();
            let landing = system.land(Sign::Negative, 0.4, 0.0);
            assert_eq!(landing.slip == 0.0, sticks, "{alpha} {factor}");
            assert!((landing.velocity - eta * 0.4).abs() < 1e-8);
        }
    }
}

/// Without friction nothing pushes the centre of mass along the ground.
#[test]
fn without_friction_the_centre_of_mass_keeps_its_speed_along_the_ground() {
    let (alpha, inertia) = (0.3_f64, 4.0 / 3.0);
    let system: SlidingSystem<f64> = block(alpha, 1e-15).resolve_sliding().unwrap();
    let landing = system.land(Sign::Positive, -1.0, 0.2);
    let speed = |rate: f64, slip: f64| slip + math::cos(alpha) * rate;
    assert!((speed(landing.velocity, landing.slip) - speed(-1.0, 0.2)).abs() < 1e-14);
    let squared = math::sin(alpha) * math::sin(alpha);
    let ratio = (inertia - 1.0 - squared) / (inertia - 1.0 + squared);
    assert!((landing.velocity + ratio).abs() < 1e-14);
}
