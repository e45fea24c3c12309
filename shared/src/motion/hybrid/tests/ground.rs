//! Vertical ground motion, guided racks and rack friction, against what they amount to.

use super::{constant, pair, shake, sine, structure, tight};
use crate::equation::any_body::AnyBody;
use crate::ground::{AnySegment, Harmonics};
use crate::motion::hybrid::mode_output::Shaking;
use crate::motion::hybrid::{HybridSystem, series::Series};
use crate::motion::observer::Event;
use crate::motion::state::{Limits, Phase};
use crate::observers::peaks::Peaks;
use crate::structure::Structure;
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Drivetrain, Rack};

/// Largest |θ| and the phase after one ground segment from rest.
fn shaken(structure: &Structure, horizontal: AnySegment<f64>, vertical: Option<AnySegment<f64>>, duration: f64) -> (f64, Phase) {
    let machine: HybridSystem<f64> = Drivetrain::default().resolve(structure, vertical.is_some()).unwrap();
    let moves_up = match machine.body {
        AnyBody::Slender(body) => body.vertical,
        AnyBody::Full(body) => body.vertical,
    };
    assert_eq!(moves_up, vertical.is_some());
    struct Watch(Peaks<f64>);
    impl crate::motion::observer::Observer<f64> for Watch {
        fn device_interval(
            &mut self,
            output: &dyn crate::motion::device_snapshot::DeviceOutput<f64>,
            interval: &crate::motion::observer::MonotoneInterval<f64>,
        ) {
            crate::motion::observer::Observer::interval(&mut self.0, output.motion(), interval);
        }
    }
    let (mut state, mut watch) = (machine.at_rest(), Watch(Peaks::default()));
    let shaking = Shaking { horizontal: &horizontal, vertical: vertical.as_ref().map(|ground| ground as _), support: None };
    let limits = Limits { overturned: 1.2, events: 100_000 };
    machine.advance(&tight(), &mut state, shaking, duration, &limits, &mut watch).unwrap();
    (watch.0.rotation, state.motion.phase)
}

/// Under a constant vertical acceleration gravity is another one: the motion is that without it, scaled in time by
/// √(1 + v̈_g/g), under a push divided by 1 + v̈_g/g.
#[test]
fn constant_vertical_acceleration_is_another_gravity() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        for kind in DeviceKind::ALL {
            for vertical in [-0.4, 0.3] {
                let structure = structure(geometry, 12.0, kind, 0.4, KinematicsKind::Consistent);
                let (amplitude, frequency) = (0.9, 12.0);
                let stretch = f64::sqrt(1.0 + vertical);
                let plain = shaken(&structure, sine(amplitude, frequency), None, 2.0);
                let push = sine(amplitude * (1.0 + vertical), frequency * stretch);
                let lifted = shaken(&structure, push, Some(constant(vertical)), 2.0 / stretch);
                assert_eq!(plain.1, lifted.1);
                assert!((plain.0 / lifted.0 - 1.0).abs() < 1e-10, "{geometry:?} {kind:?} {vertical}: {plain:?} {lifted:?}");
            }
        }
    }
}

/// At rest the block waits for |ü_g| > (g + v̈_g) tan α.
#[test]
fn vertical_acceleration_moves_the_uplift_threshold() {
    let structure = structure(Geometry::Full, 12.0, DeviceKind::None, 0.0, KinematicsKind::Paper);
    let threshold = crate::math::tan(structure.block.slenderness());
    for (push, rocks) in [(0.999, false), (1.001, true)] {
        let push = constant(threshold * 0.7 * push);
        let (_, phase) = shaken(&structure, push, Some(constant(-0.3)), 0.5);
        assert_eq!(phase == Phase::Rocking, rocks);
    }
}

/// A slender block with a guided rack is a slender block: inertia 1 + σ_r/λ, and a push 1 + σ_r as strong.
#[test]
fn a_guided_rack_is_inertia_and_push() {
    let sigma = 0.2;
    let rack = Drivetrain { rack: Rack { guided_mass_ratio: sigma, ..Rack::default() }, ..Drivetrain::default() };
    let with = shake(structure(Geometry::Slender, 10.0, DeviceKind::Inerter, 0.0, KinematicsKind::Paper), 2.0, 4.0);
    // The inertia is that of an inerter of the same mass; the push of the ground on it is the rest.
    let same =
        shake(structure(Geometry::Slender, 10.0, DeviceKind::Inerter, sigma, KinematicsKind::Paper), 2.0 * (1.0 + sigma), 4.0);
    let (guided, plain) = (with.machine(&rack, &tight()), same.ideal());
    assert!((guided.peak / plain.peak - 1.0).abs() < 1e-11, "{} and {}", guided.peak, plain.peak);
    assert_eq!(guided.impacts, plain.impacts);
}

fn dry(ratio: f64) -> Drivetrain {
    Drivetrain { rack: Rack { dry_ratio: ratio, ..Rack::default() }, ..Drivetrain::default() }
}

/// Free fall from θ₀ to the first turn on the other side without impact losses: dry friction takes F times the travel.
#[test]
fn dry_friction_takes_its_force_times_the_travel() {
    let mut structure = structure(Geometry::Slender, 10.0, DeviceKind::Inerter, 0.3, KinematicsKind::Paper);
    structure.restitution = crate::structure::restitution::Restitution::Constant(1.0);
    let (p2, alpha) = (structure.block.frequency_parameter_squared(), structure.block.slenderness());
    let force = 0.01;
    let start = 0.6 * alpha;
    let machine: HybridSystem<f64> = dry(force).resolve(&structure, false).unwrap();
    #[derive(Default)]
    struct Turns(std::vec::Vec<f64>);
    impl crate::motion::observer::Observer<f64> for Turns {
        fn event(&mut self, event: Event, _time: f64, state: &crate::motion::state::BlockState<f64>) {
            if event == Event::Turn {
                self.0.push(state.rotation);
            }
        }
    }
    let mut state = machine.released_at(start, 0.0, [0.0; 3]);
    let mut turns = Turns::default();
    let limits = Limits { overturned: 1.0, events: 10_000 };
    let shaking = Shaking::level(&Harmonics::QUIET);
    machine.advance(&Series::<f64, 20>::adaptive(1e-17), &mut state, shaking, 6.0, &limits, &mut turns).unwrap();
    // p²(α|θ| − θ²/2) falls by p² F/(mg) over every unit of travel.
    let energy = |theta: f64| p2 * (alpha * theta.abs() - 0.5 * theta * theta);
    let mut before = start;
    assert!(turns.0.len() > 3, "{:?}", turns.0);
    for turn in turns.0 {
        let lost = energy(before) - energy(turn);
        let expected = p2 * force * (before.abs() + turn.abs());
        assert!((lost / expected - 1.0).abs() < 1e-9, "{lost} and {expected}");
        before = turn;
    }
}

/// Near the unstable equilibrium the weight hardly moves the block, and rack friction holds it there.
#[test]
fn friction_holds_a_block_where_nothing_else_does() {
    let structure = structure(Geometry::Full, 10.0, DeviceKind::Inerter, 0.3, KinematicsKind::Paper);
    let alpha = structure.block.slenderness();
    // Held while |sin(α − θ)| ≤ F/(mg) cos(α − θ).
    let reach = crate::math::atan(0.02);
    for (angle, held) in [(alpha - 0.99 * reach, true), (alpha - 1.01 * reach, false), (alpha + 0.99 * reach, true)] {
        let machine: HybridSystem<f64> = dry(0.02).resolve(&structure, false).unwrap();
        let mut state = machine.released_at(angle, 0.0, [0.0; 3]);
        let limits = Limits { overturned: 1.5, events: 10_000 };
        let shaking = Shaking::level(&Harmonics::QUIET);
        machine.advance(&Series::<f64, 20>::adaptive(1e-17), &mut state, shaking, 1.0, &limits, &mut ()).unwrap();
        let (rotation, stays) = (state.motion.rotation, state.held);
        assert_eq!(stays, held, "at {angle}");
        assert_eq!(rotation == angle, held, "at {angle}: {rotation}");
    }
}

/// A mirrored pulse gives the mirrored motion.
#[test]
fn devices_are_symmetric() {
    for (name, drivetrain) in super::drivetrains() {
        let shake = pair(Geometry::Full, 3.0, 5.0);
        let [one, other] = [&shake, &shake.mirrored()].map(|shake| shake.machine(&drivetrain, &tight()));
        assert_eq!(one.peak.to_bits(), other.peak.to_bits(), "{name}");
        assert_eq!(one.spins[0], -other.spins[1], "{name}");
    }
}
