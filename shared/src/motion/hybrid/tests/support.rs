//! A support that moves on its own, against what it amounts to.

use std::vec::Vec;

use super::{Shake, constant, shake, structure, tight};
use crate::drivetrain::clutch_state::Coupling;
use crate::ground::{Harmonics, Linear};
use crate::motion::hybrid::HybridSystem;
use crate::motion::hybrid::mode_output::Shaking;
use crate::motion::observer::{Event, Observer};
use crate::motion::state::{BlockState, Limits, Phase};
use crate::observers::peaks::Peaks;
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Drivetrain, Engagement, FlywheelLosses, Rack, Support};
use crate::structure::error::ParameterError;
use crate::structure::mount::Mount;
use crate::structure::restitution::Restitution;

const SIGMA: f64 = 0.5;

fn on(amplification: f64) -> Drivetrain {
    Drivetrain { support: Support::amplified(amplification), ..Drivetrain::default() }
}

fn single(geometry: Geometry, mount: Mount, amplitude: f64) -> Shake {
    let mut shake = shake(structure(geometry, 10.0, DeviceKind::Inerter, SIGMA, KinematicsKind::Paper), amplitude, 4.0);
    shake.structure.device.mount = mount;
    shake
}

/// The ground pushes a block with an inerter on a support that moves f times as much 1 − σ n (f − 1) ℓ as strongly, where ℓ (over cos δ for
/// the exact block) is constant.
#[test]
fn with_one_inerter_it_is_another_push() {
    let tied = Mount::TyingPoint { height: 1.4, pulley_ratio: 1.5 };
    for (geometry, mount, lever) in [
        (Geometry::Slender, Mount::CentreOfMass, 1.0),
        (Geometry::Full, Mount::CentreOfMass, 1.0),
        (Geometry::Slender, tied, 1.5 * 1.5 * 0.7),
    ] {
        for f in [1.2, 0.8, 1.5, 0.5, -1.0] {
            let push = 1.0 - SIGMA * (f - 1.0) * lever;
            let moved = single(geometry, mount, 2.5).machine(&on(f), &tight());
            let plain = single(geometry, mount, 2.5 * push).ideal();
            assert!((moved.peak / plain.peak - 1.0).abs() < 1e-11, "{geometry:?} f = {f}: {} and {}", moved.peak, plain.peak);
            assert_eq!(moved.impacts, plain.impacts, "{geometry:?} f = {f}");
            let other = single(geometry, mount, 2.5).ideal();
            assert!((moved.peak / other.peak - 1.0).abs() > 0.01, "f = {f} does not matter");
        }
    }
}

/// |ü_g| (1 − σ (f − 1)) = g tan α is the uplift, also with a pair: one of its flywheels resists from the first instant of the support's motion on.
#[test]
fn it_moves_the_uplift_threshold() {
    for kind in [DeviceKind::Inerter, DeviceKind::ClutchedPair] {
        let structure = structure(Geometry::Full, 12.0, kind, SIGMA, KinematicsKind::Paper);
        let threshold = crate::math::tan(structure.block.slenderness());
        for f in [1.4, 0.6] {
            let machine: HybridSystem<f64> = on(f).resolve(&structure, false).unwrap();
            for (push, rocks) in [(0.999, false), (1.001, true), (-0.999, false), (-1.001, true)] {
                let ground = constant(push * threshold / (1.0 - SIGMA * (f - 1.0)));
                let mut state = machine.at_rest();
                let shaking = Shaking::level(&ground);
                let limits = Limits { overturned: 1.5, events: 10_000 };
                let stands = machine.stands_through(&machine.footing(), &mut state, shaking, 0.3);
                assert!(!(stands && rocks), "{kind:?} f = {f}: the footing misses an uplift at {push}");
                machine.advance(&tight(), &mut state, shaking, 0.3, &limits, &mut ()).unwrap();
                assert_eq!(state.motion.phase == Phase::Rocking, rocks, "{kind:?} f = {f}, {push}");
            }
        }
    }
}

/// A slender block falls back from θ₀ under a constant push u, its support faster, at c = λ(f − 1) p² u: the rack moves outward on it,
/// which the first flywheel resists until both accelerate alike, where α + u − θ = −λ(f − 1) u. Until then θ̇² has an energy, under the
/// push (1 − σ (f − 1)) u.
#[test]
fn a_pair_resists_the_motion_of_its_terminals() {
    #[derive(Default)]
    struct Switches(Vec<BlockState<f64>>);
    impl Observer<f64> for Switches {
        fn event(&mut self, event: Event, _time: f64, state: &BlockState<f64>) {
            if event == Event::Switch {
                self.0.push(*state);
            }
        }
    }
    let structure = structure(Geometry::Slender, 15.0, DeviceKind::ClutchedPair, SIGMA, KinematicsKind::Paper);
    let (p2, alpha) = (structure.block.frequency_parameter_squared(), structure.block.slenderness());
    let lambda = structure.block.inertia_ratio();
    let (start, push, f) = (0.1, 0.05, -3.0);
    let switch = alpha + push + lambda * (f - 1.0) * push;
    assert!(0.0 < switch && switch < start);
    let engaged = push * (1.0 - SIGMA * (f - 1.0));
    let fall = p2 * ((alpha + engaged) * (start - switch) - 0.5 * (start * start - switch * switch));
    let expected = 2.0 * fall / (1.0 + SIGMA / lambda);
    for (side, wheel) in [(1.0, 0), (-1.0, 1)] {
        let machine: HybridSystem<f64> = on(f).resolve(&structure, false).unwrap();
        let ground = Linear::constant(side * push);
        let mut state = machine.released_at(side * start, 0.0, [side * push, 0.0, 0.0]);
        assert_eq!(state.device.wheels[wheel].coupling, Coupling::Locked);
        let (mut switches, limits) = (Switches::default(), Limits { overturned: 1.0, events: 1000 });
        machine.advance(&tight(), &mut state, Shaking::level(&ground), 0.6, &limits, &mut switches).unwrap();
        let released = switches.0[0];
        assert!((released.rotation / (side * switch) - 1.0).abs() < 1e-12, "{} and {switch}", released.rotation);
        let energy = released.velocity * released.velocity;
        assert!((energy / expected - 1.0).abs() < 1e-12, "{energy} and {expected}");
    }
}

/// By name, value and reason; a guided rack moves with the block and needs nothing of the support.
#[test]
fn what_needs_the_velocity_of_the_support_is_refused() {
    let pair = structure(Geometry::Full, 12.0, DeviceKind::ClutchedPair, SIGMA, KinematicsKind::Consistent);
    let refused = |drivetrain: Drivetrain| drivetrain.resolve::<f64>(&pair, false).unwrap_err();
    let flywheel = |losses| refused(Drivetrain { flywheel: losses, ..on(1.2) });
    let rack = |rack| refused(Drivetrain { rack, ..on(1.2) });
    let reasons = [
        refused(Drivetrain { engagement: Engagement::Rigid, ..on(1.2) }),
        refused(Drivetrain { engagement: Engagement::Overrunning, ..on(1.2) }),
        refused(Drivetrain { engagement: Engagement::Friction { capacity_ratio: 0.1 }, ..on(1.2) }),
        flywheel(FlywheelLosses { viscous_rate: 0.1, ..FlywheelLosses::default() }),
        flywheel(FlywheelLosses { dry_deceleration: 0.1, ..FlywheelLosses::default() }),
        rack(Rack { viscous: 0.1, ..Rack::default() }),
        rack(Rack { dry_ratio: 0.1, ..Rack::default() }),
    ];
    let expected = ParameterError {
        parameter: "support_amplification",
        value: 1.2,
        range: "1 with friction or a flywheel that keeps its speed",
    };
    assert!(reasons.iter().all(|reason| *reason == expected), "{reasons:?}");
    for value in [-10.1, 10.1, f64::INFINITY] {
        assert_eq!(refused(on(value)), ParameterError { parameter: "support_amplification", value, range: "from -10 to 10" });
    }
    let mut corners = pair;
    corners.device.mount = Mount::BaseCorners { pulley_ratio: 1.0 };
    let error = on(1.2).resolve::<f64>(&corners, false).unwrap_err();
    assert_eq!(error.range, "1 for vertical devices at the base corners");
    assert!(on(1.0).resolve::<f64>(&corners, false).is_ok());
    let guided = Drivetrain { rack: Rack { guided_mass_ratio: 0.1, ..Rack::default() }, ..on(1.2) };
    assert!(guided.resolve::<f64>(&pair, false).is_ok());
}

/// Quiet ground does not move the support.
#[test]
fn on_quiet_ground_it_is_nothing() {
    for kind in [DeviceKind::Inerter, DeviceKind::ClutchedPair] {
        let structure = structure(Geometry::Full, 12.0, kind, SIGMA, KinematicsKind::Consistent);
        let [moved, plain] = [on(3.0), Drivetrain::default()].map(|drivetrain| {
            let machine: HybridSystem<f64> = drivetrain.resolve(&structure, false).unwrap();
            let mut state = machine.released_at(0.1, 0.0, [0.0; 3]);
            let shaking = Shaking::level(&Harmonics::QUIET);
            let limits = Limits { overturned: 1.5, events: 10_000 };
            machine.advance(&tight(), &mut state, shaking, 1.0, &limits, &mut ()).unwrap();
            state.motion
        });
        assert!((moved.rotation / plain.rotation - 1.0).abs() < 1e-12, "{kind:?}: {} and {}", moved.rotation, plain.rotation);
        assert_eq!(moved.impacts, plain.impacts);
    }
}

/// There the last bounces are those on the ground, however many they are. So they are on ground that has come to rest, but for rounding of the
/// support's speed.
#[test]
fn the_last_bounces_on_a_still_support_are_those_on_the_ground() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        let mut structure = structure(geometry, 10.0, DeviceKind::ClutchedPair, SIGMA, KinematicsKind::Consistent);
        structure.restitution = Restitution::Constant(0.98);
        let [moved, plain] = [on(1.2), Drivetrain::default()].map(|drivetrain| {
            let machine: HybridSystem<f64> = drivetrain.resolve(&structure, false).unwrap();
            let mut state = machine.released_at(0.3 * structure.block.slenderness(), 0.0, [0.0; 3]);
            let (mut peaks, limits) = (Peaks::default(), Limits { overturned: 1.5, events: 100_000 });
            let shaking = Shaking::level(&Harmonics::QUIET);
            machine.advance(&tight(), &mut state, shaking, 20.0, &limits, &mut peaks).unwrap();
            assert_eq!(state.motion.phase, Phase::Rest);
            (peaks.ended.unwrap(), state.motion.impacts)
        });
        assert!((moved.0 / plain.0 - 1.0).abs() < 1e-9, "{geometry:?}: {moved:?} {plain:?}");
        assert_eq!(moved.1, plain.1, "{geometry:?}");
        for f in [1.2, 0.7, -1.0] {
            let mut pulse = shake(structure, 1.5, 4.0);
            pulse.free_time = 20.0;
            assert_eq!(pulse.machine(&on(f), &tight()).state.phase, Phase::Rest, "{geometry:?} f = {f}");
        }
    }
}
