//! The block on its feet, against closed forms, the rigid block, balances of energy, and symmetry.

use std::vec::Vec;

use super::{CompliantState, CompliantSystem, Foot, GroundPair};
use crate::ground::{AnySegment, GroundSegment, Harmonics, Linear};
use crate::math;
use crate::math::sign::Sign;
use crate::motion::device_snapshot::DeviceOutput;
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::{BlockState, Limits, Phase};
use crate::observers::peaks::Peaks;
use crate::structure::block::{Block, Geometry};
use crate::structure::device::{Device, DeviceKind, KinematicsKind};
use crate::structure::foundation::Foundation;
use crate::structure::mount::Mount;
use crate::structure::{Base, Restitution, Structure};

const ALPHA: f64 = 0.2;
const LIMITS: Limits<f64> = Limits { overturned: core::f64::consts::FRAC_PI_2, events: 10_000_000 };

fn structure(device: Device) -> Structure {
    Structure { device, ..Structure::new(Block::new(1.5, ALPHA, 1.3).unwrap(), Restitution::Geometric) }
}

fn on_feet(structure: Structure, vertical_frequency: f64, damping_ratio: f64) -> Structure {
    Structure { base: Base::Compliant(Foundation { vertical_frequency, damping_ratio }), ..structure }
}

fn device(kind: DeviceKind, kinematics: KinematicsKind) -> Device {
    Device { kind, mass_ratio: 0.5, mount: Mount::CentreOfMass, kinematics }
}

fn system(device: Device, vertical_frequency: f64, damping_ratio: f64) -> (CompliantSystem<f64>, f64) {
    on_feet(structure(device), vertical_frequency, damping_ratio).resolve_compliant().unwrap()
}

/// Events, and time, θ, θ̇ at the ends of intervals with what the device does there.
#[derive(Debug, Default)]
struct Seen {
    events: Vec<(Event, f64)>,
    ends: Vec<[f64; 3]>,
    origin: f64,
    /// Power that a flywheel has put into the block in any interval but by resisting.
    driven: f64,
}

impl Observer<f64> for Seen {
    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        let motion = output.motion().at(interval.to);
        self.ends.push([self.origin + interval.start + interval.to, motion.rotation, motion.velocity]);
        let middle = output.snapshot(0.5 * (interval.from + interval.to));
        self.driven = self.driven.max(-middle.support_force() * middle.terminal_velocity);
    }

    fn event(&mut self, event: Event, time: f64, _state: &BlockState<f64>) {
        self.events.push((event, self.origin + time));
    }
}

impl Seen {
    fn count(&self, event: Event) -> usize {
        self.events.iter().filter(|(of, _)| *of == event).count()
    }
}

/// Horizontal and vertical ground motion, and its duration (s).
type Piece = (AnySegment<f64>, Option<AnySegment<f64>>, f64);

/// `state` over `pieces` in steps of `step` (s).
fn follow(system: &CompliantSystem<f64>, state: &mut CompliantState<f64>, pieces: &[Piece], step: f64) -> Seen {
    let mut seen = Seen::default();
    for (horizontal, vertical, duration) in pieces {
        let ground = GroundPair { horizontal, vertical: vertical.as_ref().map(|up| up as &dyn GroundSegment<f64>) };
        system.advance(step, state, ground, *duration, &LIMITS, &mut seen).unwrap();
        seen.origin += duration;
    }
    seen
}

fn still() -> AnySegment<f64> {
    AnySegment::Linear(Linear::constant(0.0))
}

fn sine(amplitude: f64, frequency: f64) -> AnySegment<f64> {
    AnySegment::Sine(Harmonics::sine(amplitude, frequency))
}

/// Kinetic energy with an engaged flywheel, weight, compressed springs of feet that press, and losses; over mR².
fn energy(system: &CompliantSystem<f64>, state: &CompliantState<f64>) -> f64 {
    let BlockState { rotation, velocity, .. } = state.motion;
    let cosine = math::cos(ALPHA - rotation.abs());
    let ratio = if state.engaged { system.mass_ratio } else { 0.0 };
    let mass = system.inertia - 1.0 + (1.0 + ratio) * cosine * cosine;
    let kinetic = 0.5 * (mass * velocity * velocity + state.rise * state.rise);
    let springs: f64 = (0..2)
        .filter(|&foot| state.feet[foot] == Foot::Presses)
        .map(|foot| {
            let compression = system.foot(state, foot).0;
            0.5 * system.stiffness * compression * compression
        })
        .sum();
    kinetic + system.gravity() * state.height + springs + state.spent
}

#[test]
fn on_ground_that_does_not_move_it_stands_still() {
    let (system, step) = system(Device::NONE, 8.0, 0.1);
    let mut state = system.at_rest();
    let start = state;
    let seen = follow(&system, &mut state, &[(still(), None, 5.0)], step);
    assert!(seen.events.is_empty() && state.stands() && state.motion.phase == Phase::Rest);
    assert!(state.motion.rotation == 0.0 && (state.height - start.height).abs() < 1e-15);
    // Both feet share the weight: each sinks by g/ω_v².
    let omega = core::f64::consts::TAU * 8.0;
    let sunk = crate::structure::block::GRAVITY / (omega * omega) / 1.5;
    assert!((start.height + sunk).abs() < 1e-15);
}

#[test]
fn up_and_down_it_is_a_damped_oscillator() {
    let (ratio, hertz, push) = (0.15, 6.0, 0.1);
    let (system, step) = system(Device::NONE, hertz, ratio);
    let mut state = system.at_rest();
    let start = state.height;
    let up = AnySegment::Linear(Linear::constant(push));
    let duration = 0.37;
    follow(&system, &mut state, &[(still(), Some(up), duration)], 0.2 * step);
    let omega = core::f64::consts::TAU * hertz;
    let damped = omega * math::square_root(1.0 - ratio * ratio);
    let (sine, cosine) = math::sin_cos(damped * duration);
    let swing = math::exp(-ratio * omega * duration) * (cosine + ratio * omega / damped * sine);
    let expected = -push * system.gravity() / (omega * omega) * (1.0 - swing);
    assert!((state.height - start - expected).abs() < 1e-8 * start.abs(), "{} {expected}", state.height - start);
}

/// While both feet press, small rotations are those of an oscillator of ω² = (2 (k/m) sin²α − (g/R) cos α)/M and damping 2 (c/m) sin²α/M, with
/// M = λ − 1 + (1 + σ) cos²α.
#[test]
fn small_rotations_on_both_feet_are_a_damped_oscillator() {
    for inerter in [Device::NONE, device(DeviceKind::Inerter, KinematicsKind::Consistent)] {
        let (system, step) = system(inerter, 9.0, 0.2);
        let tilt = 1e-8;
        let mut state = system.released_at(tilt, 0.0, [0.0; 2]);
        assert!(state.stands());
        let duration = 0.31;
        follow(&system, &mut state, &[(still(), None, duration)], 0.2 * step);
        let (sine, cosine) = math::sin_cos(ALPHA);
        let mass = 0.3 + (1.0 + inerter.mass_ratio) * cosine * cosine;
        let square = (2.0 * system.stiffness * sine * sine - system.gravity() * cosine) / mass;
        let decay = system.damping * sine * sine / mass;
        let damped = math::square_root(square - decay * decay);
        let (s, c) = math::sin_cos(damped * duration);
        let expected = tilt * math::exp(-decay * duration) * (c + decay / damped * s);
        assert!((state.motion.rotation - expected).abs() < 1e-6 * tilt, "{} {expected}", state.motion.rotation);
    }
}

/// The fall from θ₀ to upright takes the rigid block's time, the closer the stiffer the feet.
#[test]
fn on_stiff_feet_it_falls_as_the_rigid_block() {
    for (inerter, kinematics) in
        [(false, KinematicsKind::Paper), (true, KinematicsKind::Paper), (true, KinematicsKind::Consistent)]
    {
        let own = if inerter { device(DeviceKind::Inerter, kinematics) } else { Device::NONE };
        // The rigid block by steps of its own: (λ + σ cos²δ) θ̈ + σ sin δ cos δ θ̇² = −λp² sin δ.
        let sigma = own.mass_ratio;
        let term = if kinematics == KinematicsKind::Consistent { sigma } else { 0.0 };
        let gravity = crate::structure::block::GRAVITY / 1.5;
        let rate = |(rotation, velocity): (f64, f64)| {
            let (sine, cosine) = math::sin_cos(ALPHA - rotation);
            let force = -gravity * sine - term * sine * cosine * velocity * velocity;
            (velocity, force / (1.3 + sigma * cosine * cosine))
        };
        let (mut now, mut rigid, h) = ((0.5 * ALPHA, 0.0), 0.0, 1e-5);
        while now.0 > 0.0 {
            let middle = rate(now);
            let middle = rate((now.0 + 0.5 * h * middle.0, now.1 + 0.5 * h * middle.1));
            now = (now.0 + h * middle.0, now.1 + h * middle.1);
            rigid += h;
        }
        rigid += now.0 / -now.1;
        let off = [40.0, 80.0, 160.0].map(|hertz| {
            let (system, step) = system(own, hertz, 0.3);
            let mut state = system.released_at(0.5 * ALPHA, 0.0, [0.0; 2]);
            let seen = follow(&system, &mut state, &[(still(), None, 1.2 * rigid)], step);
            // The other foot meets the ground with the toe's sunk in.
            let (_, time) = seen.events.iter().find(|(event, _)| *event == Event::Impact).unwrap();
            (time / rigid - 1.0).abs()
        });
        assert!(off[0] < 2e-2 && off[1] < 0.35 * off[0] && off[2] < 0.35 * off[1], "{off:?}");
    }
}

#[test]
fn energy_goes_to_the_dashpots_and_nowhere_else() {
    for (kind, kinematics) in [(DeviceKind::None, KinematicsKind::Consistent), (DeviceKind::Inerter, KinematicsKind::Consistent)]
    {
        for (hertz, ratio) in [(5.0, 0.05), (15.0, 0.3), (15.0, 0.0), (30.0, 1.0)] {
            let (system, step) = system(device(kind, kinematics), hertz, ratio);
            let mut state = system.released_at(-0.6 * ALPHA, 0.0, [0.0; 2]);
            let start = energy(&system, &state);
            let seen = follow(&system, &mut state, &[(still(), None, 6.0)], 0.25 * step);
            let end = energy(&system, &state);
            let available = system.gravity() * (math::cos(ALPHA) - math::cos(1.4 * ALPHA)).abs();
            assert!((end - start).abs() < 1e-6 * available, "{kind:?} {hertz} {ratio}: {start} {end}");
            assert!(seen.count(Event::Impact) > 2 && state.spent >= 0.0 && (state.spent > 0.0) == (ratio > 0.0));
        }
    }
}

#[test]
fn the_mirrored_ground_gives_the_mirrored_motion() {
    for kind in DeviceKind::ALL {
        let (system, step) = system(device(kind, KinematicsKind::Consistent), 10.0, 0.1);
        let run = |sign: f64| {
            let mut state = system.at_rest();
            let seen = follow(&system, &mut state, &[(sine(0.4 * sign, 6.0), None, 1.0), (still(), None, 2.0)], step);
            (state, seen)
        };
        let ((one, seen), (other, mirrored)) = (run(1.0), run(-1.0));
        assert_eq!(one.motion.rotation.to_bits(), (-other.motion.rotation).to_bits());
        assert_eq!(one.height.to_bits(), other.height.to_bits());
        assert_eq!(seen.events, mirrored.events);
        assert!(seen.count(Event::Uplift) > 0 && seen.count(Event::Impact) > 0);
    }
}

/// Before anything moves Eq. 10 wants nothing. So a jump of the ground engages a clutch at once, to either side.
#[test]
fn what_stands_still_wants_no_clutch() {
    let (system, step) = system(device(DeviceKind::ClutchedPair, KinematicsKind::Paper), 10.0, 0.3);
    let [one, other] = [0.15, -0.15].map(|push| {
        let mut state = system.at_rest();
        let quiet = follow(&system, &mut state, &[(still(), None, 0.5)], step);
        assert!(!state.engaged && quiet.events.is_empty(), "{state:?} {:?}", quiet.events);
        follow(&system, &mut state, &[(AnySegment::Linear(Linear::constant(push)), None, 0.5)], step).events
    });
    assert_eq!(one, other);
    assert_eq!(one[0], (Event::Switch, 0.0));
}

#[test]
fn the_error_falls_with_the_fourth_power_of_the_step() {
    for kind in DeviceKind::ALL {
        let (system, _) = system(device(kind, KinematicsKind::Paper), 6.0, 0.2);
        let run = |step: f64| {
            let mut state = system.at_rest();
            follow(&system, &mut state, &[(sine(0.5, 5.0), None, 1.1)], step);
            state.motion.rotation
        };
        let exact = run(2.5e-5);
        let off = [4e-3, 2e-3, 1e-3].map(|step| (run(step) - exact).abs());
        assert!(off[0] > 6.0 * off[1] && off[1] > 6.0 * off[2] && off[2] < 1e-6, "{kind:?} {off:?}");
    }
}

#[test]
fn the_pair_resists_and_never_drives() {
    for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
        let (system, step) = system(device(DeviceKind::ClutchedPair, kinematics), 10.0, 0.1);
        let mut state = system.at_rest();
        let seen = follow(&system, &mut state, &[(sine(0.4, 6.0), None, 1.0), (still(), None, 2.0)], step);
        assert!(seen.count(Event::Switch) > 3, "{}", seen.count(Event::Switch));
        assert!(seen.driven < 1e-9, "{}", seen.driven);
    }
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let error = |structure: &Structure, vertical_frequency, damping_ratio| {
        on_feet(*structure, vertical_frequency, damping_ratio).resolve_compliant::<f64>().unwrap_err().parameter
    };
    let bare = structure(Device::NONE);
    assert_eq!(error(&bare, 0.0, 0.1), "vertical_frequency");
    assert_eq!(error(&bare, f64::NAN, 0.1), "vertical_frequency");
    assert_eq!(error(&bare, 5.0, -0.1), "damping_ratio");
    assert_eq!(error(&Structure { geometry: Geometry::Slender, ..bare }, 5.0, 0.1), "vertical_frequency");
    let mounted =
        Device { mount: Mount::BaseCorners { pulley_ratio: 1.0 }, ..device(DeviceKind::Inerter, KinematicsKind::Paper) };
    assert_eq!(error(&structure(mounted), 5.0, 0.1), "vertical_frequency");
    assert_eq!(bare.resolve_compliant::<f64>().unwrap_err().parameter, "vertical_frequency");
    assert_eq!(on_feet(bare, 5.0, 0.1).resolve::<f64>().unwrap_err().parameter, "vertical_frequency");
}

/// θ̈ of a soft foundation has its largest value within a step: shorter ones find the same, but for the method's own error.
#[test]
fn the_largest_acceleration_lies_between_the_ends_of_steps_too() {
    let block = Block::new(0.59, 5.21_f64.to_radians(), 4.0 / 3.0).unwrap();
    let pair = device(DeviceKind::ClutchedPair, KinematicsKind::Paper);
    let structure = Structure { device: pair, ..Structure::new(block, Restitution::Geometric) };
    let (system, step) = on_feet(structure, 2.04, 0.56).resolve_compliant().unwrap();
    let (p, alpha) = (block.frequency_parameter(), block.slenderness());
    let frequency = 14.566 * p;
    let push = sine(1.822 * math::tan(alpha), frequency);
    let peak = |step: f64| {
        let (mut state, mut peaks) = (system.at_rest(), Peaks::default());
        for (ground, duration) in [(&push, core::f64::consts::PI / frequency), (&still(), 2.23 / p)] {
            let ground = GroundPair { horizontal: ground, vertical: None };
            system.advance(step, &mut state, ground, duration, &LIMITS, &mut peaks).unwrap();
        }
        peaks.acceleration
    };
    let (found, close) = (peak(step), peak(step / 32.0));
    assert!((found / close - 1.0).abs() < 1e-4, "{found} and {close}");
}

/// A soft foundation under a wave of 55 times its frequency: steps follow the wave.
#[test]
fn steps_follow_a_ground_that_is_faster_than_the_feet() {
    let block = Block::new(0.5051, 15.277_f64.to_radians(), 4.0 / 3.0).unwrap();
    let structure = Structure::new(block, Restitution::Geometric);
    let (system, step) = on_feet(structure, 0.7022, 0.2222).resolve_compliant().unwrap();
    let (p, alpha) = (block.frequency_parameter(), block.slenderness());
    let push = AnySegment::Sine(Harmonics::cosine(5.924 * math::tan(alpha), 64.0 * p));
    let peak = |step: f64| {
        let (mut state, mut peaks) = (system.at_rest(), Peaks::default());
        for (ground, duration) in [(&push, core::f64::consts::TAU / (64.0 * p)), (&still(), 2.71 / p)] {
            let ground = GroundPair { horizontal: ground, vertical: None };
            system.advance(step, &mut state, ground, duration, &LIMITS, &mut peaks).unwrap();
        }
        peaks.rotation / alpha
    };
    let (found, close) = (peak(step), peak(1e-5));
    assert!((found / close - 1.0).abs() < 1e-5 && (close - 0.003_014).abs() < 1e-6, "{found} and {close}");
}

/// On ground that accelerates by −a (1 − t/t₀) the block sets out, turns at 2 t₀ and is upright again at 3 t₀, wherever in its first step that is: the
/// feet change next to nothing in so short a time.
#[test]
fn a_push_that_turns_within_the_first_step_turns_the_block() {
    for kind in [DeviceKind::None, DeviceKind::Inerter] {
        let (system, step) = system(device(kind, KinematicsKind::Consistent), 5.0, 0.3);
        let limits = Limits { events: 1000, ..LIMITS };
        for part in [0.1, 0.2, 0.3, 0.34, 0.3625, 0.45, 0.5, 0.6, 0.9] {
            let (zero, duration) = (part * step, 3.5 * step);
            let run = |step: f64| {
                let push = Linear::between(-3e-5, -3e-5 * (1.0 - duration / zero), duration);
                let ground = GroundPair { horizontal: &push, vertical: None };
                let (mut state, mut seen) = (system.at_rest(), Seen::default());
                system.advance(step, &mut state, ground, duration, &limits, &mut seen).unwrap();
                (state.motion, seen)
            };
            let ((coarse, seen), (fine, _)) = (run(step), run(step / 64.0));
            let [(Event::Turn, turn)] = seen.events[..] else { panic!("{kind:?} {part}: {:?}", seen.events) };
            assert!((turn / (2.0 * zero) - 1.0).abs() < 1e-2, "{kind:?} {part}: {turn} {zero}");
            let off = (coarse.velocity / fine.velocity - 1.0).abs().max((coarse.rotation / fine.rotation - 1.0).abs());
            assert!(off < 1e-3, "{kind:?} {part}: {coarse:?} {fine:?}");
        }
    }
}

/// A block that moves against the direction that its state has comes to zero again and again, each time at once. One step is seen from the
/// other toe then.
#[test]
fn events_without_an_end_are_left_out_of_one_step() {
    let (system, step) = system(Device::NONE, 5.0, 0.3);
    let limits = Limits { events: 1000, ..LIMITS };
    let run = |direction: Sign| {
        let mut state = system.at_rest();
        state.motion = BlockState { velocity: 1e-3, side: direction, direction, ..state.motion };
        let ground = GroundPair { horizontal: &still(), vertical: None };
        system.advance(step, &mut state, ground, 10.0 * step, &limits, &mut Seen::default()).unwrap();
        state
    };
    let (right, wrong) = (run(Sign::Positive), run(Sign::Negative));
    assert!((wrong.motion.rotation / right.motion.rotation - 1.0).abs() < 1e-5, "{wrong:?} {right:?}");
    assert!((wrong.motion.velocity / right.motion.velocity - 1.0).abs() < 1e-5, "{wrong:?} {right:?}");
}
