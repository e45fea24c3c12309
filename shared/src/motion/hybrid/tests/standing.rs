//! What holds a block that stands, and what frees it: against closed forms, and between methods.

use std::vec::Vec;

use super::{Shake, Watcher, drivetrains, pair, shake, sine, structure, tight};
use crate::equation::body::Body;
use crate::ground::{AnySegment, Linear};
use crate::math;
use crate::math::sign::Sign;
use crate::method::fixed::{FixedStep, Scheme};
use crate::motion::device_snapshot::DeviceOutput;
use crate::motion::hybrid::HybridSystem;
use crate::motion::hybrid::mode_output::Shaking;
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::{BlockState, Limits, Phase};
use crate::structure::Structure;
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Actuation, Drivetrain, Engagement, FlywheelLosses, Rack, Support};
use crate::structure::restitution::Restitution;

/// Friction of the bearings, m/s²: the typical one.
const DRY: f64 = 0.05;

/// Growth of the ground acceleration, g/s.
const SLOPE: f64 = 0.1;

fn bearings(engagement: Engagement) -> Drivetrain {
    let flywheel = FlywheelLosses { dry_deceleration: DRY, ..FlywheelLosses::default() };
    Drivetrain { engagement, flywheel, ..Drivetrain::default() }
}

fn plates(capacity_ratio: f64, rise_time: f64) -> Drivetrain {
    let actuation = Actuation { rise_time, ..Actuation::default() };
    Drivetrain { actuation, ..bearings(Engagement::Friction { capacity_ratio }) }
}

/// A slender block on ground whose acceleration grows from nothing to 1.5 times the threshold, for the positive side; flywheel `wheel`, behind
/// a dashpot of rate c, turns so that it pushes the block by so much of the threshold. When the block uplifts, and when it should: as weight
/// and ground let go of the rest of c (w + D/r) e^(−r t) − c D/r, with the brake in D.
pub fn pushed_by_a_flywheel(
    structure: &Structure,
    drivetrain: &Drivetrain,
    (wheel, dashpot): (usize, f64),
    push: f64,
) -> (f64, f64) {
    let FlywheelLosses { viscous_rate, dry_deceleration, brake_deceleration, .. } = drivetrain.flywheel;
    let block = &structure.block;
    let (p, alpha, k) = (block.frequency_parameter(), block.slenderness(), structure.device.mass_ratio / block.inertia_ratio());
    let (rate, dry) = (dashpot + viscous_rate, (dry_deceleration + brake_deceleration) / block.size());
    let machine: HybridSystem<f64> = drivetrain.resolve(structure, false).unwrap();
    let mut state = machine.at_rest();
    let spin = push * p * p * alpha / (k * dashpot);
    state.device.wheels[wheel].spin = spin;
    let (end, most) = (0.5, 1.5 * alpha);
    let lifts = |time: f64| {
        let left = (spin.abs() + dry / rate) * math::exp(-rate * time) - dry / rate;
        p * p * (most * time / end - alpha) + k * dashpot * left.max(0.0) * spin.signum()
    };
    let (mut low, mut high) = (0.0, end);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if lifts(middle) > 0.0 { high = middle } else { low = middle }
    }
    let ground = AnySegment::Linear(Linear { start: 0.0, slope: -most / end });
    let mut nobody = ();
    let mut watcher = Watcher::new(&mut nobody);
    let limits = Limits { overturned: 1.5, events: 10_000 };
    machine.advance(&tight(), &mut state, Shaking::level(&ground), end, &limits, &mut watcher).unwrap();
    assert_eq!(state.motion.phase, Phase::Rocking);
    let uplift = watcher.events.iter().find(|(event, _)| *event == Event::Uplift).unwrap().1;
    (uplift, low)
}

/// When a block that stands or is held begins to move.
#[derive(Default)]
struct Goes(Option<f64>);

impl Observer<f64> for Goes {
    fn device_interval(&mut self, _output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        if interval.last.rotation != interval.first.rotation {
            self.0 = self.0.or(Some(interval.start));
        }
    }

    fn event(&mut self, _event: Event, _time: f64, _state: &BlockState<f64>) {}
}

/// The push (in g) at which a ramp of ground acceleration moves a block at rest, with the clutches that a controller has `engaged` for
/// long and flywheels that turn at `spin` (1/s), each in its own direction.
fn uplift(drivetrain: &Drivetrain, engaged: Option<[bool; 2]>, spin: f64) -> f64 {
    let structure = structure(Geometry::Full, 10.0, DeviceKind::ClutchedPair, 0.5, KinematicsKind::Consistent);
    let mut machine: HybridSystem<f64> = drivetrain.resolve(&structure, false).unwrap();
    let mut state = machine.at_rest();
    if let Some(engaged) = engaged {
        machine.actuator.controlled = true;
        machine.actuator.engagement_delay = 1e-3;
        machine.preset(&mut state, engaged);
    }
    (state.device.wheels[0].spin, state.device.wheels[1].spin) = (spin, -spin);
    let ramp = Linear { start: 0.0, slope: SLOPE };
    let shaking = Shaking::level(&ramp);
    let limits = Limits { overturned: 1.0, events: 10_000 };
    let mut goes = Goes::default();
    machine.advance(&tight(), &mut state, shaking, 2.2, &limits, &mut goes).unwrap();
    SLOPE * goes.0.unwrap()
}

/// tan α, and with a standing flywheel that is coupled tan α + σ d/g: its bearings resist the rack with σ m d.
fn thresholds() -> [f64; 2] {
    let alone = math::tan(10.0_f64.to_radians());
    [alone, alone + 0.5 * DRY / crate::structure::block::GRAVITY]
}

#[test]
fn bearings_of_a_coupled_flywheel_hold_a_standing_block() {
    let [alone, held] = thresholds();
    for engagement in
        [Engagement::Ideal, Engagement::Rigid, Engagement::Overrunning, Engagement::Friction { capacity_ratio: 0.1 }]
    {
        let found = uplift(&bearings(engagement), None, 0.0);
        assert!((found - held).abs() < 1e-12, "{engagement:?}: {found} for {held}");
    }
    for engagement in [Engagement::Ideal, Engagement::Rigid, Engagement::Friction { capacity_ratio: 0.1 }] {
        for (engaged, expected) in [([false, false], alone), ([true, false], held), ([false, true], held)] {
            let found = uplift(&bearings(engagement), Some(engaged), 0.0);
            assert!((found - expected).abs() < 1e-12, "{engagement:?} {engaged:?}: {found} for {expected}");
        }
    }
}

#[test]
fn a_flywheel_that_is_not_coupled_holds_nothing() {
    let found = uplift(&bearings(Engagement::Overrunning), None, 3.0);
    assert!((found - thresholds()[0]).abs() < 1e-12, "{found}");
}

/// Plates that carry less than the bearings hold with what they carry; those that close fast enough with the bearings.
#[test]
fn plates_hold_with_what_they_carry() {
    let [alone, held] = thresholds();
    let weak = uplift(&plates(1e-3, 0.0), None, 0.0);
    assert!((weak - alone - 1e-3).abs() < 1e-12, "{weak}");
    for rise_time in [0.01, 0.5] {
        let fast = uplift(&plates(0.1, rise_time), None, 0.0);
        assert!((fast - held).abs() < 1e-12, "{fast} for {held}");
    }
    // A capacity that grows by less than the push lets the block go at once.
    let slow = uplift(&plates(0.1, 5.0), None, 0.0);
    assert!((slow - alone).abs() < 1e-8, "{slow} for {alone}");
}

/// The flywheel receives what the plates take from the block from the first instant, whatever its bearings.
#[test]
fn the_least_bearing_friction_is_none() {
    let shake = pair(Geometry::Slender, 1.7, 2.2);
    let peak = |dry_deceleration: f64| {
        let mut drivetrain = plates(0.08, 0.05);
        drivetrain.flywheel =
            FlywheelLosses { dry_deceleration, brake_deceleration: f64::INFINITY, viscous_rate: 0.0, drag_rate: 0.0 };
        shake.machine(&drivetrain, &tight()).peak
    };
    let (none, least) = (peak(0.0), peak(1e-9));
    assert!((none / least - 1.0).abs() < 1e-8, "{none} and {least}");
}

#[test]
fn rising_plates_with_bearings_and_brakes_come_to_an_end() {
    for brake_deceleration in [0.0, 2.0] {
        for rise_time in [1e-3, 0.01, 0.05] {
            for engagement_delay in [0.0, 1e-6, 1e-3] {
                let mut drivetrain = plates(0.1, rise_time);
                drivetrain.actuation.engagement_delay = engagement_delay;
                drivetrain.flywheel.brake_deceleration = brake_deceleration;
                for (amplitude, frequency) in [(1.2, 1.5), (1.6, 3.0), (3.0, 5.0)] {
                    let seen = pair(Geometry::Full, amplitude, frequency).machine(&drivetrain, &tight());
                    assert!(seen.peak > 0.0);
                }
            }
        }
    }
}

/// A clutch that is engaged on a spinning flywheel as the block is uplifted again pushes at once.
#[test]
fn a_second_uplift_feels_the_spinning_flywheels() {
    let block = structure(Geometry::Full, 10.0, DeviceKind::ClutchedPair, 0.5, KinematicsKind::Consistent);
    let mut shake: Shake = shake(block, 1.8, 4.6);
    let threshold = shake.structure.geometry.uplift_threshold(shake.structure.block.slenderness());
    shake.pieces.push((AnySegment::Quiet, 8.3));
    shake.pieces.push((sine(1.05 * threshold, core::f64::consts::PI), 0.55));
    shake.free_time = 0.0;
    let damped = Engagement::Elastic { stiffness: 3e3, damping: 8.0, backlash: 0.0, capacity_ratio: f64::INFINITY };
    for engagement in [Engagement::Friction { capacity_ratio: 0.01 }, damped] {
        let drivetrain = Drivetrain { engagement, ..Drivetrain::default() };
        let mut ledger = shake.ledger(&drivetrain);
        let series = shake.watched(&drivetrain, &tight(), &mut ledger);
        let uplifts: Vec<f64> =
            series.events.iter().filter(|(event, _)| *event == Event::Uplift).map(|(_, time)| *time).collect();
        assert!(uplifts.len() == 2 && series.spins.iter().any(|spin| spin.abs() > 1e-3), "{uplifts:?} {:?}", series.spins);
        let steps = shake.machine(&drivetrain, &FixedStep { scheme: Scheme::RungeKutta4, step: 2e-4 });
        let (a, b) = (series.state.rotation, steps.state.rotation);
        assert!((a - b).abs() < 1e-6 * a.abs() && a != 0.0, "{engagement:?}: {a} and {b}");
        let entries = ledger.entries;
        assert!(entries.residual().abs() < 1e-12 * entries.input.abs(), "{engagement:?}: {entries:?}");
    }
}

/// A flywheel that a block in motion has just brought to its speed is let go at once where the block slows down.
#[test]
fn an_overrunning_clutch_that_has_just_gripped_does_not_push() {
    let structure = structure(Geometry::Full, 10.0, DeviceKind::ClutchedPair, 0.5, KinematicsKind::Consistent);
    let drivetrain = Drivetrain { engagement: Engagement::Overrunning, ..Drivetrain::default() };
    let machine: HybridSystem<f64> = drivetrain.resolve(&structure, false).unwrap();
    // Outward, against the weight.
    let state = machine.released_at(0.0, 0.1, [0.0; 3]);
    let configuration = machine.body.configuration(state.motion.side.unit(), state.motion.rotation);
    let acceleration = machine.acceleration_now(&state, &configuration);
    let now = machine.snapshot(&machine.law(&state), &state, &machine.place(&state), acceleration);
    let (velocity, force) = (now.motion.velocity, now.device.force[0]);
    // 1 + kℓ² times as much is shaken off with the flywheel at rest before.
    let lever = math::cos(10.0_f64.to_radians());
    let k = 0.5 / structure.block.inertia_ratio();
    assert!((velocity * (1.0 + k * lever * lever) / 0.1 - 1.0).abs() < 1e-13, "{velocity}");
    assert_eq!(force, 0.0);
}

/// A tilted block that is about to turn outward is held by the flywheel that works outward. When weight and ground turn it inward that
/// clutch lets go: the block goes at once where the other flywheel spins ahead of the rack, and where it stands when its bearings are
/// overcome too.
#[test]
fn an_overrunning_clutch_holds_a_tilted_block_one_way() {
    let structure = structure(Geometry::Full, 10.0, DeviceKind::ClutchedPair, 0.5, KinematicsKind::Consistent);
    let machine: HybridSystem<f64> = bearings(Engagement::Overrunning).resolve(&structure, false).unwrap();
    let start = 0.5 * structure.block.slenderness();
    let balance = math::tan(structure.block.slenderness() - start);
    let bearings = 0.5 * DRY / crate::structure::block::GRAVITY;
    let outward = 0.4 * bearings;
    for (spin, expected) in [(-5.0, outward / SLOPE), (0.0, (outward + bearings) / SLOPE)] {
        let ground = Linear { start: -balance - outward, slope: SLOPE };
        let mut state = machine.released_at(start, 0.0, [ground.start, 0.0, 0.0]);
        assert!(state.held && state.device.wheels[0].coupling.is_engaged());
        let other = &mut state.device.wheels[1];
        (other.spin, other.turning) = (spin, (spin != 0.0).then_some(Sign::Negative));
        let limits = Limits { overturned: 1.0, events: 10_000 };
        let mut goes = Goes::default();
        machine.advance(&tight(), &mut state, Shaking::level(&ground), 0.1, &limits, &mut goes).unwrap();
        let found = goes.0.unwrap();
        assert!((found - expected).abs() < 1e-10, "{spin}: {found} for {expected}");
        assert!(state.motion.velocity < 0.0 && state.device.wheels[1].coupling.is_engaged() == (spin == 0.0));
    }
}

/// A controller engages an elastic clutch on a flywheel that spins while the block stands: it swings on its spring, w = w₀ cos Ωt with Ω² =
/// K/k, and lifts the block as the spring's moment passes that of the weight, sin Ωt = p² sin α Ω/(ℓKw₀).
#[test]
fn a_flywheel_swings_on_its_spring_under_a_standing_block() {
    let structure = structure(Geometry::Full, 10.0, DeviceKind::ClutchedPair, 0.5, KinematicsKind::Consistent);
    let engagement = Engagement::Elastic { stiffness: 1e3, damping: 0.0, backlash: 0.0, capacity_ratio: f64::INFINITY };
    let mut machine: HybridSystem<f64> = Drivetrain { engagement, ..Drivetrain::default() }.resolve(&structure, false).unwrap();
    machine.actuator.controlled = true;
    let block = &structure.block;
    let (alpha, k) = (block.slenderness(), structure.device.mass_ratio / block.inertia_ratio());
    let stiffness = machine.transmission.parameters.stiffness;
    let frequency = math::square_root(stiffness / k);
    let weight = block.frequency_parameter_squared() * math::sin_cos(alpha).0;
    for (share, wheel) in [(0.9, 0), (0.9, 1), (1.5, 0), (1.5, 1)] {
        let spin = share * weight * frequency / (stiffness * math::cos(alpha)) * if wheel == 0 { 1.0 } else { -1.0 };
        let mut state = machine.at_rest();
        state.device.wheels[wheel].spin = spin;
        machine.order(&mut state, [wheel == 0, wheel == 1], &mut ());
        let mut nobody = ();
        let mut watcher = Watcher::new(&mut nobody);
        let limits = Limits { overturned: 1.0, events: 10_000 };
        let (shaking, end) = (Shaking::level(&crate::ground::Harmonics::QUIET), 0.3);
        machine.advance(&tight(), &mut state, shaking, end, &limits, &mut watcher).unwrap();
        let uplift = watcher.events.iter().find(|(event, _)| *event == Event::Uplift);
        if share < 1.0 {
            let expected = spin * math::cos(frequency * end);
            let found = state.device.wheels[wheel].spin;
            assert!((found / expected - 1.0).abs() < 1e-10, "{wheel}: {found} for {expected}");
            assert!(state.motion.rotation == 0.0 && uplift.is_none());
        } else {
            let expected = math::asin(1.0 / share) / frequency;
            let found = uplift.unwrap().1;
            assert!((found / expected - 1.0).abs() < 1e-10, "{wheel}: {found} for {expected}");
        }
    }
}

/// A push that the bearings of an engaging clutch withstand is no uplift.
#[test]
fn a_block_that_is_held_on_its_base_has_not_rocked() {
    let block = structure(Geometry::Full, 10.0, DeviceKind::ClutchedPair, 0.5, KinematicsKind::Consistent);
    let [alone, held] = thresholds();
    for (push, uplifts) in [(0.5 * (alone + held), 0), (held + 1e-4, 1)] {
        // Half a sine, so that it comes and goes.
        let pieces = std::vec![(sine(push, 2.0), core::f64::consts::FRAC_PI_2)];
        let shake = Shake { structure: block, pieces, free_time: 1.0 };
        for engagement in [Engagement::Ideal, Engagement::Rigid, Engagement::Friction { capacity_ratio: 0.1 }] {
            let seen = shake.machine(&bearings(engagement), &tight());
            let count = seen.events.iter().filter(|(event, _)| *event == Event::Uplift).count();
            assert_eq!((count, seen.peak > 0.0), (uplifts, uplifts > 0), "{engagement:?} {push}: {:?}", seen.events);
        }
    }
}

/// Ground whose largest acceleration is the uplift threshold, but for rounding, moves no block, and time goes on.
#[test]
fn a_push_that_ends_at_the_threshold_moves_nothing() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        for (degrees, frequency) in (5..25).flat_map(|degrees| [0.5, 1.0, 7.0].map(|frequency| (f64::from(degrees), frequency))) {
            for (name, drivetrain) in drivetrains() {
                let drivetrain = Drivetrain { rack: Rack::default(), support: Support::default(), ..drivetrain };
                let block = structure(geometry, degrees, DeviceKind::ClutchedPair, 0.5, KinematicsKind::Consistent);
                for rounding in [-1.0, 0.0, 1.0] {
                    let mut shake = shake(block, 1.0, frequency);
                    let AnySegment::Sine(wave) = &mut shake.pieces[0].0 else { unreachable!() };
                    wave.terms[0].phase = core::f64::consts::FRAC_PI_2;
                    wave.terms[0].amplitude *= 1.0 + rounding * f64::EPSILON;
                    let seen = shake.machine(&drivetrain, &tight());
                    let uplifts = seen.events.iter().any(|(event, _)| *event == Event::Uplift);
                    let case = std::format!("{geometry:?} {degrees} {frequency} {name} {rounding}: {:?}", seen.events);
                    assert_eq!((uplifts, seen.peak, seen.acceleration), (false, 0.0, 0.0), "{case}");
                    assert!(seen.events.len() < 100, "{case}");
                }
            }
        }
    }
}

/// A sine that exceeds the threshold by a share of e lifts the block as it does so, where sin ωt = 1/(1 + e), however flat it is there.
#[test]
fn a_push_that_ends_above_the_threshold_lifts_in_time() {
    let block = structure(Geometry::Full, 10.0, DeviceKind::ClutchedPair, 0.5, KinematicsKind::Consistent);
    let p = block.block.frequency_parameter();
    for excess in [1e-12, 1e-9, 1e-6] {
        let seen = shake(block, 1.0 + excess, 1.0)
            .machine(&Drivetrain { engagement: Engagement::Rigid, ..Drivetrain::default() }, &tight());
        let found = p * seen.events.iter().find(|(event, _)| *event == Event::Uplift).unwrap().1;
        let expected = math::asin(1.0 / (1.0 + excess));
        // Rounding of the push over its slope there.
        let resolved = 256.0 * f64::EPSILON / math::square_root(2.0 * excess);
        assert!((found - expected).abs() < resolved, "{excess}: {found} for {expected}");
    }
}

/// Bounces that take hardly anything end in rest, although hundreds of the last ones follow one another within 1e-9/p.
#[test]
fn bounces_are_no_events_at_once_however_short() {
    let base = structure(Geometry::Full, 15.0, DeviceKind::ClutchedPair, 0.5, KinematicsKind::Consistent);
    let actuation = Actuation { engagement_delay: 0.01, release_delay: 0.01, ..Actuation::default() };
    let drivetrain = Drivetrain { engagement: Engagement::Rigid, actuation, ..Drivetrain::default() };
    let rests = |rest_speed: f64| {
        let structure = Structure { restitution: Restitution::Constant(0.99), rest_speed, ..base };
        let machine: HybridSystem<f64> = drivetrain.resolve(&structure, false).unwrap();
        let mut state = machine.released_at(1e-6 * structure.block.slenderness(), 0.0, [0.0; 3]);
        let (mut nobody, shaking) = ((), Shaking::level(&crate::ground::Harmonics::QUIET));
        let mut watcher = Watcher::new(&mut nobody);
        let limits = Limits { overturned: 1.0, events: 100_000 };
        machine.advance(&tight(), &mut state, shaking, 30.0, &limits, &mut watcher).unwrap();
        watcher.peaks.ended.unwrap()
    };
    let (sooner, later) = (rests(1e-8), rests(1e-12));
    assert!((later - sooner).abs() < 1e-9 * sooner, "{sooner} and {later}");
}
