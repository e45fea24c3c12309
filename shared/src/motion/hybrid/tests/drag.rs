//! Drag of open clutches, against transfer functions, the rack's own friction and its limits.

use std::vec::Vec;

use super::limits::engaging_at_speed;
use super::maxwell::Swing;
use super::standing::pushed_by_a_flywheel;
use super::{Watcher, pair, sine, structure, tight};
use crate::ground::{AnySegment, Linear};
use crate::math::exp;
use crate::motion::hybrid::HybridSystem;
use crate::motion::hybrid::mode_output::Shaking;
use crate::motion::state::Limits;
use crate::observers::ledger::Entries;
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Actuation, Drivetrain, Engagement, FlywheelLosses, Rack};

const SIGMA: f64 = 0.5;
const LIMITS: Limits<f64> = Limits { overturned: 1.5, events: 10_000 };
/// Clutches that never engage.
const OPEN: Actuation = Actuation {
    engagement_delay: 0.0,
    release_delay: 0.01,
    delay: crate::structure::drivetrain::Delay::Inertial,
    rise_time: 0.0,
    time_constant: 0.0,
    dwell: 0.0,
    miss_probability: 1.0,
    miss_seed: 1,
};
const CLUTCHES: [Engagement; 2] = [Engagement::Rigid, Engagement::Friction { capacity_ratio: 0.1 }];

fn open(engagement: Engagement, flywheel: FlywheelLosses) -> Drivetrain {
    Drivetrain { engagement, flywheel, actuation: OPEN, ..Drivetrain::default() }
}

fn dragged(drag_rate: f64) -> FlywheelLosses {
    FlywheelLosses { drag_rate, ..FlywheelLosses::default() }
}

/// About its unstable balance a slender block is linear: swung at ω between two open clutches it has the amplitude and phase that an
/// inertance 2b/(1 + iω/c) gives, and what the speeds of the flywheels differ by decays as e^(−ct).
#[test]
fn open_clutches_are_maxwell_elements() {
    for engagement in CLUTCHES {
        for ratio in [0.3, 1.0, 4.0] {
            let structure = structure(Geometry::Slender, 15.0, DeviceKind::ClutchedPair, SIGMA, KinematicsKind::Consistent);
            let block = &structure.block;
            let (alpha, k) = (block.slenderness(), 2.0 * SIGMA / block.inertia_ratio());
            let (omega, amplitude) = (8.0 * block.frequency_parameter(), 0.5);
            let rate = omega / ratio;
            let machine: HybridSystem<f64> = open(engagement, dragged(rate)).resolve(&structure, false).unwrap();
            let swing = Swing::of(block, k, (omega, amplitude), ratio);
            let size = swing.size();
            let mut state = machine.released_at(alpha + swing.at(0.0, swing.rotation), swing.at(0.0, swing.velocity), [0.0; 3]);
            let apart = 0.7 * omega * size;
            state.device.wheels[0].spin = swing.at(0.0, swing.spin) + apart;
            state.device.wheels[1].spin = swing.at(0.0, swing.spin) - apart;
            let ground = sine(amplitude, omega);
            let end = 2.3 * core::f64::consts::TAU / omega;
            machine.advance(&tight(), &mut state, Shaking::level(&ground), end, &LIMITS, &mut ()).unwrap();
            let error = (state.motion.rotation - alpha - swing.at(end, swing.rotation)) / size;
            assert!(error.abs() < 1e-11, "{engagement:?}, ω/c = {ratio}: θ off by {error:e}");
            let still_apart = apart * exp(-rate * end);
            for (wheel, differs) in state.device.wheels.iter().zip([still_apart, -still_apart]) {
                let error = (wheel.spin - swing.at(end, swing.spin) - differs) / (omega * size);
                assert!(error.abs() < 1e-11, "{engagement:?}, ω/c = {ratio}: w off by {error:e}");
            }
        }
    }
}

/// Flywheels that their brakes hold leave viscous friction of the rack, 2σc of it, and what the rack would lose is lost in the clutches.
#[test]
fn against_held_flywheels_it_is_friction_of_the_rack() {
    let rate = 0.8;
    for geometry in [Geometry::Slender, Geometry::Full] {
        for engagement in CLUTCHES {
            let shake = pair(geometry, 3.0, 5.0);
            let entries = |drivetrain: &Drivetrain| -> (f64, Entries<f64>) {
                let mut ledger = shake.ledger(drivetrain);
                (shake.watched(drivetrain, &tight(), &mut ledger).peak, ledger.entries)
            };
            let (peak, own) = entries(&open(engagement, FlywheelLosses { brake_deceleration: 100.0, ..dragged(rate) }));
            let rack = Rack { viscous: 2.0 * SIGMA * rate, ..Rack::default() };
            let (expected, other) = entries(&Drivetrain { rack, ..open(engagement, FlywheelLosses::default()) });
            assert!((peak / expected - 1.0).abs() < 1e-12, "{geometry:?} {engagement:?}: {peak} and {expected}");
            assert!(other.rack > 0.0 && own.rack == 0.0 && own.brake == 0.0, "{own:?}");
            assert!((own.clutch / other.rack - 1.0).abs() < 1e-10, "{own:?} and {other:?}");
        }
    }
}

/// A strong drag locks both flywheels to the rack, with an error of 1/c; a weak one is none. The motion has its peak before an impact,
/// which flywheels behind a dashpot do not go through with the block.
#[test]
fn between_open_and_locked_clutches() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        for engagement in CLUTCHES {
            let mut shake = engaging_at_speed(geometry);
            shake.free_time = 1.0;
            let mut locked = shake.clone();
            (locked.structure.device.kind, locked.structure.device.mass_ratio) = (DeviceKind::Inerter, 2.0 * SIGMA);
            let limit = locked.machine(&Drivetrain::default(), &tight()).peak;
            let peak = |rate| shake.machine(&open(engagement, dragged(rate)), &tight()).peak;
            let errors: Vec<f64> = [10.0, 100.0, 1000.0].iter().map(|&rate| (peak(rate) / limit - 1.0).abs()).collect();
            assert!(errors[1] < errors[0] / 5.0 && errors[2] < errors[1] / 5.0, "{geometry:?} {engagement:?}: {errors:?}");
            assert!(errors[2] < 0.02, "{geometry:?} {engagement:?}: {errors:?}");
            let free = shake.machine(&open(engagement, FlywheelLosses::default()), &tight()).peak;
            assert!((peak(1e-9) / free - 1.0).abs() < 1e-7, "{geometry:?} {engagement:?}");
        }
    }
}

/// [`pushed_by_a_flywheel`] through its open clutch.
#[test]
fn a_coasting_flywheel_pushes_a_standing_block() {
    let structure = structure(Geometry::Slender, 10.0, DeviceKind::ClutchedPair, SIGMA, KinematicsKind::Consistent);
    for (dry_deceleration, brake_deceleration, push) in [(0.0, 0.0, 0.3), (0.0, 0.5, 0.9), (0.8, 0.0, 0.6), (0.3, 0.5, -0.5)] {
        for engagement in CLUTCHES {
            let flywheel = FlywheelLosses { viscous_rate: 0.5, dry_deceleration, brake_deceleration, drag_rate: 6.0 };
            let (uplift, expected) = pushed_by_a_flywheel(&structure, &open(engagement, flywheel), (1, 6.0), push);
            assert!((uplift - expected).abs() < 1e-9, "{engagement:?}, {flywheel:?}: {uplift} and {expected}");
        }
    }
}

/// A block that a flywheel lifts through its open clutch rises against the acceleration of Eq. 10, which knows weight and ground alone: its own
/// clutch is commanded once these move it.
#[test]
fn a_block_that_a_flywheel_lifts_is_resisted_once_the_ground_moves_it() {
    let structure = structure(Geometry::Slender, 10.0, DeviceKind::ClutchedPair, SIGMA, KinematicsKind::Consistent);
    let block = &structure.block;
    let (p, alpha, k) = (block.frequency_parameter(), block.slenderness(), SIGMA / block.inertia_ratio());
    let (end, most, rate, delay) = (0.5, 1.5 * alpha, 6.0, 0.01);
    let ground = AnySegment::Linear(Linear { start: 0.0, slope: -most / end });
    let actuation = Actuation { engagement_delay: delay, ..Actuation::default() };
    for engagement in CLUTCHES {
        for push in [0.9, 0.1, 0.01, 0.001] {
            let drivetrain = Drivetrain { actuation, ..open(engagement, dragged(rate)) };
            let machine: HybridSystem<f64> = drivetrain.resolve(&structure, false).unwrap();
            let mut start = machine.at_rest();
            start.device.wheels[1].spin = push * p * p * alpha / (k * rate);
            let mut nobody = ();
            let mut watcher = Watcher::new(&mut nobody);
            machine.advance(&tight(), &mut start.clone(), Shaking::level(&ground), end, &LIMITS, &mut watcher).unwrap();
            let commanded = watcher.switches[0].0 - delay;
            let mut then = start;
            machine.advance(&tight(), &mut then, Shaking::level(&ground), commanded, &LIMITS, &mut ()).unwrap();
            let moves = most * commanded / end - alpha + then.motion.rotation;
            assert!(then.motion.rotation > 0.0, "{engagement:?}, {push}: it has risen");
            assert!(moves.abs() < 1e-12, "{engagement:?}, {push}: commanded at {commanded} s, where {moves} moves the block");
        }
    }
}

#[test]
fn it_has_a_range_and_what_it_cannot_go_with_is_refused() {
    let check = |engagement, flywheel, rack| Drivetrain { rack, ..open(engagement, flywheel) }.check();
    let refused = |engagement, flywheel, rack: Rack| {
        assert_eq!(check(engagement, flywheel, rack).unwrap_err().parameter, "drag_rate", "{engagement:?} {flywheel:?} {rack:?}");
    };
    for rate in [-1.0, 1001.0, f64::INFINITY, f64::NAN] {
        refused(Engagement::Rigid, dragged(rate), Rack::default());
    }
    for engagement in [Engagement::Ideal, Engagement::Overrunning, Engagement::Viscous { corner_frequency: 2.0 }] {
        refused(engagement, dragged(0.1), Rack::default());
    }
    refused(Engagement::Rigid, dragged(0.1), Rack { load_friction: 0.1, ..Rack::default() });
    for engagement in CLUTCHES {
        let at_once = Drivetrain { actuation: Actuation::default(), ..open(engagement, dragged(0.1)) };
        assert_eq!(at_once.check().unwrap_err().parameter, "drag_rate");
        refused(engagement, FlywheelLosses { brake_deceleration: f64::INFINITY, ..dragged(0.1) }, Rack::default());
        let strong = FlywheelLosses { brake_deceleration: 1e9, ..dragged(1000.0) };
        assert_eq!(check(engagement, strong, Rack { viscous: 1.0, ..Rack::default() }), Ok(()));
    }
}
