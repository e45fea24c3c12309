//! A support with a motion of its own, beside the ground's.

use std::vec::Vec;

use super::{constant, sine, structure, tight};
use crate::ground::{AnySegment, DampedOscillation, GroundSegment, Harmonics, Ricker};
use crate::method::fixed::{FixedStep, Scheme};
use crate::motion::device_snapshot::DeviceOutput;
use crate::motion::hybrid::mode_output::{ModeIntegrator, Shaking};
use crate::motion::hybrid::{HybridState, HybridSystem};
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::{BlockState, Limits, Phase};
use crate::observers::checks::Checks;
use crate::observers::ledger::{Account, Clutching, Ledger};
use crate::observers::peaks::Peaks;
use crate::structure::Structure;
use crate::structure::block::{GRAVITY, Geometry};
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Actuation, Delay, Drivetrain, Engagement, FlywheelLosses, Rack, Support};
use crate::structure::mount::Mount;

const SIGMA: f64 = 0.5;

const LIMITS: Limits<f64> = Limits { overturned: 1.5, events: 100_000 };

fn moving() -> Drivetrain {
    Drivetrain { support: Support::MOVING, ..Drivetrain::default() }
}

fn of(geometry: Geometry, kind: DeviceKind, mount: Mount) -> Structure {
    let mut structure = structure(geometry, 10.0, kind, SIGMA, KinematicsKind::Consistent);
    structure.device.mount = mount;
    structure
}

/// Follows a block through `pieces`: ground, support against it, and how long they last (s).
fn follow<T: ModeIntegrator<f64>>(
    machine: &HybridSystem<f64>,
    method: &T,
    pieces: &[(AnySegment<f64>, AnySegment<f64>, f64)],
    observer: &mut dyn Observer<f64>,
) -> HybridState<f64> {
    let mut state = machine.at_rest();
    for (ground, support, duration) in pieces {
        let shaking = Shaking { support: Some(support), ..Shaking::level(ground) };
        machine.advance(method, &mut state, shaking, *duration, &LIMITS, observer).unwrap();
    }
    state
}

/// A cycle of the ground under a support that swings faster and rings on.
fn pieces(sign: f64) -> [(AnySegment<f64>, AnySegment<f64>, f64); 2] {
    let cycle = core::f64::consts::TAU / 9.0;
    let ringing = DampedOscillation { real: sign * 0.2, imaginary: sign * 0.3, decay: 1.5, frequency: 31.0 };
    [
        (sine(sign * 0.5, 9.0), AnySegment::Sine(Harmonics::sine(sign * 0.4, 23.0)), cycle),
        (AnySegment::Quiet, AnySegment::Damped(ringing), 3.0),
    ]
}

fn account(kind: DeviceKind) -> Account {
    let clutching = if kind == DeviceKind::ClutchedPair { Clutching::Ideal } else { Clutching::Permanent };
    Account { clutching, mass_ratio: SIGMA, on_support: true, ..Account::default() }
}

/// One that moves by f − 1 times the ground's acceleration against it is one that moves by f times.
#[test]
fn in_proportion_to_the_ground_it_is_the_factor() {
    let tied = Mount::TyingPoint { height: 1.4, pulley_ratio: 1.5 };
    for kind in [DeviceKind::Inerter, DeviceKind::ClutchedPair] {
        for (geometry, mount) in
            [(Geometry::Slender, Mount::CentreOfMass), (Geometry::Full, Mount::CentreOfMass), (Geometry::Full, tied)]
        {
            for f in [1.2, 0.0, -1.0] {
                let structure = of(geometry, kind, mount);
                let cycle = core::f64::consts::TAU / 9.0;
                let pieces = [(sine(0.5, 9.0), sine((f - 1.0) * 0.5, 9.0), cycle), (AnySegment::Quiet, AnySegment::Quiet, 3.0)];
                let factor = Drivetrain { support: Support::amplified(f), ..Drivetrain::default() };
                let [own, factor, plain] = [moving(), factor, Drivetrain::default()].map(|drivetrain| {
                    let mut peaks = Peaks::default();
                    let state = follow(&drivetrain.resolve(&structure, false).unwrap(), &tight(), &pieces, &mut peaks);
                    (peaks.rotation, state.motion)
                });
                assert!((own.0 / factor.0 - 1.0).abs() < 1e-12, "{kind:?} {geometry:?} f = {f}: {} and {}", own.0, factor.0);
                assert!((own.1.rotation - factor.1.rotation).abs() < 1e-11, "{own:?} {factor:?}");
                assert_eq!(own.1.impacts, factor.1.impacts);
                assert!((own.0 / plain.0 - 1.0).abs() > 1e-3, "{kind:?} {geometry:?} f = {f} does not matter");
            }
        }
    }
}

#[test]
fn its_work_closes_the_ledger() {
    for kind in [DeviceKind::Inerter, DeviceKind::ClutchedPair] {
        for geometry in [Geometry::Slender, Geometry::Full] {
            let structure = of(geometry, kind, Mount::CentreOfMass);
            let machine = moving().resolve(&structure, false).unwrap();
            let mut ledger = Ledger::new(&structure.block, geometry, &account(kind));
            follow(&machine, &tight(), &pieces(1.0), &mut ledger);
            let entries = ledger.entries;
            let residual = entries.residual().abs() / entries.input.abs();
            assert!(residual < 1e-10, "{kind:?} {geometry:?}: {residual:e} of the input, {entries:?}");
            let mut blind = Ledger::new(&structure.block, geometry, &Account { on_support: false, ..account(kind) });
            follow(&machine, &tight(), &pieces(1.0), &mut blind);
            let wavelet = AnySegment::Ricker(Ricker { amplitude: 0.2, rate: 5.0, centre: 0.7 });
            let mut standing = Ledger::new(&structure.block, geometry, &account(kind));
            let end = follow(&machine, &tight(), &[(AnySegment::Quiet, wavelet, 1.4)], &mut standing);
            assert_eq!(end.motion.phase, Phase::Rest);
            assert!(standing.entries.residual().abs() < 1e-15, "{:?}", standing.entries);
            let blind = blind.entries.residual().abs() / entries.input.abs();
            assert!(blind > 1e-4, "{kind:?}: the support does no work ({blind:e})");
        }
    }
}

#[test]
fn the_mirrored_motion_is_the_mirror() {
    for kind in [DeviceKind::Inerter, DeviceKind::ClutchedPair] {
        let machine = moving().resolve(&of(Geometry::Full, kind, Mount::CentreOfMass), false).unwrap();
        let [one, other] = [1.0, -1.0].map(|sign| follow(&machine, &tight(), &pieces(sign), &mut ()).motion);
        assert_eq!((one.rotation, one.velocity, one.impacts), (-other.rotation, -other.velocity, other.impacts), "{kind:?}");
        assert!(one.impacts > 0);
    }
}

#[test]
fn runge_kutta_agrees_with_the_series() {
    for kind in [DeviceKind::Inerter, DeviceKind::ClutchedPair] {
        let machine = moving().resolve(&of(Geometry::Full, kind, Mount::CentreOfMass), false).unwrap();
        let peak = |peaks: Peaks<f64>| peaks.rotation;
        let (mut series, mut steps) = (Peaks::default(), Peaks::default());
        follow(&machine, &tight(), &pieces(1.0), &mut series);
        let method = FixedStep { scheme: Scheme::RungeKutta4, step: 1e-3 };
        follow(&machine, &method, &pieces(1.0), &mut steps);
        let (series, steps) = (peak(series), peak(steps));
        assert!((steps / series - 1.0).abs() < 1e-8, "{kind:?}: {steps} and {series}");
    }
}

/// A fast swing opens and closes clutches many times; none of these instants may be missed until a step's end, however long the steps of
/// the slow block are.
#[test]
fn clutches_switch_on_time_however_fast_it_swings() {
    let machine = moving().resolve(&of(Geometry::Full, DeviceKind::ClutchedPair, Mount::CentreOfMass), false).unwrap();
    for k in 0..40 {
        let frequency = 8.0 + 0.7 * f64::from(k);
        let swing = DampedOscillation { real: 0.0, imaginary: 0.4, decay: 0.05 * frequency, frequency };
        let push = (constant(-0.4), AnySegment::Damped(swing), 0.25);
        let fall = (AnySegment::Quiet, AnySegment::Damped(swing), 1.5);
        let method = FixedStep { scheme: Scheme::RungeKutta4, step: 2e-4 };
        let series = follow(&machine, &tight(), &[push, fall], &mut ()).motion;
        let steps = follow(&machine, &method, &[push, fall], &mut ()).motion;
        assert!((series.rotation - steps.rotation).abs() < 1e-9, "ω = {frequency}: {series:?} {steps:?}");
        assert_eq!(series.impacts, steps.impacts, "ω = {frequency}");
    }
}

/// Force and speed of an engaged flywheel have one sign, standing or rocking: it resists its rack and never drives it.
#[test]
fn a_pair_never_drives() {
    #[derive(Default)]
    struct Powers {
        taken: f64,
        driven: f64,
    }
    impl Observer<f64> for Powers {
        fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
            for share in [0.0, 0.2, 0.5, 0.8, 1.0] {
                let device = output.snapshot(interval.from + share * (interval.to - interval.from)).device;
                for (force, spin) in device.force.iter().zip(device.spin) {
                    (self.taken, self.driven) = (self.taken.max(force * spin), self.driven.min(force * spin));
                }
            }
        }

        fn device_at_rest(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
            // One of no length is before the commands of its instant.
            if interval.to > interval.from {
                self.device_interval(output, interval);
            }
        }
    }
    for (geometry, mount) in [
        (Geometry::Slender, Mount::CentreOfMass),
        (Geometry::Full, Mount::CentreOfMass),
        (Geometry::Full, Mount::TyingPoint { height: 1.4, pulley_ratio: 1.5 }),
    ] {
        let machine = moving().resolve(&of(geometry, DeviceKind::ClutchedPair, mount), false).unwrap();
        for size in [0.2, 1.0] {
            let mut powers = Powers::default();
            let pieces = pieces(1.0).map(|(ground, support, duration)| match (ground, support) {
                (AnySegment::Sine(_), support) if size < 1.0 => (AnySegment::Quiet, support, duration),
                (ground, support) => (ground, support, duration),
            });
            follow(&machine, &tight(), &pieces, &mut powers);
            let Powers { taken, driven } = powers;
            assert!(taken > 0.01 && driven > -1e-11 * taken, "{geometry:?} {mount:?} {size}: {taken} {driven}");
        }
    }
}

/// The clutches of a standing block follow Eq. 10 at the terminals: on a support that accelerates by A sin ωt, whose speed is (A/ω)(1 − cos
/// ωt), one flywheel works from each cycle's start to its middle; by A cos ωt they take turns, from each zero of the speed to the next of
/// the acceleration. F = σ |ü_s| there.
#[test]
fn the_clutches_of_a_standing_block_follow_the_support() {
    #[derive(Default)]
    struct Switches(Vec<f64>);
    impl Observer<f64> for Switches {
        fn event(&mut self, event: Event, time: f64, _state: &BlockState<f64>) {
            assert_eq!(event, Event::Switch);
            self.0.push(time);
        }
    }
    let structure = of(Geometry::Full, DeviceKind::ClutchedPair, Mount::CentreOfMass);
    let machine: HybridSystem<f64> = moving().resolve(&structure, false).unwrap();
    let (amplitude, frequency) = (0.2, 7.0);
    let quarter = core::f64::consts::FRAC_PI_2 / frequency;
    for (support, quarters) in [
        (Harmonics::sine(amplitude, frequency), [0.0, 2.0, 4.0, 6.0, 8.0]),
        (Harmonics::cosine(amplitude, frequency), [0.0, 1.0, 2.0, 3.0, 4.0]),
    ] {
        let shaking = Shaking { support: Some(&support), ..Shaking::level(&Harmonics::QUIET) };
        let account = account(DeviceKind::ClutchedPair);
        let mut checks = Checks::<f64>::new(&structure.block, Geometry::Full, &Mount::CentreOfMass, &account).unwrap();
        let mut switches = Switches::default();
        let observers: [&mut dyn Observer<f64>; 2] = [&mut checks, &mut switches];
        for observer in observers {
            let mut state = machine.at_rest();
            machine.advance(&tight(), &mut state, shaking, (quarters[4] + 0.5) * quarter, &LIMITS, observer).unwrap();
            assert_eq!(state.motion.phase, Phase::Rest);
        }
        let force = checks.report.support.unwrap().value;
        assert!((force / (SIGMA * amplitude) - 1.0).abs() < 1e-12, "{force}");
        // A speed that only touches zero is zero within a rounding for some nanoseconds, in which clutches may change places.
        let touches = quarters[1] == 2.0;
        let resolution = if touches { 1e-7 } else { 1e-12 };
        switches.0.dedup_by(|later, sooner| touches && *later - *sooner < resolution);
        let expected = quarters.map(|quarters| quarters * quarter);
        assert_eq!(switches.0.len(), expected.len(), "{:?}", switches.0);
        for (time, expected) in switches.0.iter().zip(expected) {
            assert!((time - expected).abs() < resolution, "{time} and {expected}");
        }
    }
}

/// A stretch of a few roundings of the clock, after a clutch has moved, comes to its end.
#[test]
fn a_stretch_that_the_clock_hardly_resolves_ends() {
    let structure = of(Geometry::Full, DeviceKind::ClutchedPair, Mount::CentreOfMass);
    let half = core::f64::consts::PI / 7.0;
    let (precise, single): (HybridSystem<f64>, HybridSystem<f32>) =
        (moving().resolve(&structure, false).unwrap(), moving().resolve(&structure, false).unwrap());
    for roundings in 0..64 {
        let support = Harmonics::sine(0.2, 7.0);
        let shaking = Shaking { support: Some(&support), ..Shaking::level(&Harmonics::QUIET) };
        let mut state = precise.at_rest();
        let duration = f64::from_bits(half.to_bits() + roundings);
        precise.advance(&tight(), &mut state, shaking, duration, &LIMITS, &mut Peaks::default()).unwrap();
        assert_eq!(state.motion.phase, Phase::Rest);
        let support = Harmonics::sine(0.2_f32, 7.0);
        let shaking = Shaking { support: Some(&support), ..Shaking::level(&Harmonics::QUIET) };
        let (mut state, limits) = (single.at_rest(), Limits { overturned: 1.5, events: 100_000 });
        let duration = f32::from_bits((half as f32).to_bits() + roundings as u32);
        let method = FixedStep { scheme: Scheme::RungeKutta4, step: 1e-3_f32 };
        single.advance(&method, &mut state, shaking, duration, &limits, &mut Peaks::default()).unwrap();
        assert_eq!(state.motion.phase, Phase::Rest);
    }
}

/// On ground that stands still the flywheel lifts the block where σ |ü_s| = g tan α, and so does one of a pair.
#[test]
fn it_lifts_a_block_by_its_inerter_alone() {
    let structure = of(Geometry::Full, DeviceKind::Inerter, Mount::CentreOfMass);
    let threshold = crate::math::tan(structure.block.slenderness()) / SIGMA;
    for (kind, push, rocks) in [
        (DeviceKind::Inerter, 0.999, false),
        (DeviceKind::Inerter, 1.001, true),
        (DeviceKind::Inerter, -0.999, false),
        (DeviceKind::Inerter, -1.001, true),
        (DeviceKind::ClutchedPair, 0.999, false),
        (DeviceKind::ClutchedPair, 1.001, true),
        (DeviceKind::ClutchedPair, -0.999, false),
        (DeviceKind::ClutchedPair, -1.001, true),
    ] {
        let machine: HybridSystem<f64> = moving().resolve(&of(Geometry::Full, kind, Mount::CentreOfMass), false).unwrap();
        let support = constant(push * threshold);
        let shaking = Shaking { support: Some(&support), ..Shaking::level(&Harmonics::QUIET) };
        let mut state = machine.at_rest();
        let stands = machine.stands_through(&machine.footing(), &mut state, shaking, 0.3);
        assert!(!(stands && rocks), "the footing misses an uplift at {push}");
        machine.advance(&tight(), &mut state, shaking, 0.3, &LIMITS, &mut ()).unwrap();
        assert_eq!(state.motion.phase == Phase::Rocking, rocks, "{kind:?}, {push}");
        // A wall that pulls the flywheel on drags the block with it: the two accelerations have one sign.
        assert!(!rocks || state.motion.rotation * push > 0.0, "{state:?}");
    }
    // Where the ground ends in a swing the uplift is an instant of its own.
    let swing = DampedOscillation { real: 0.0, imaginary: -2.0 * threshold, decay: 0.0, frequency: 4.0 };
    let machine: HybridSystem<f64> = moving().resolve(&structure, false).unwrap();
    let at = crate::math::asin(0.5) / 4.0;
    for (until, phase) in [(at * (1.0 - 1e-9), Phase::Rest), (at * (1.0 + 1e-9), Phase::Rocking)] {
        let shaking = Shaking { support: Some(&swing as &dyn GroundSegment<f64>), ..Shaking::level(&Harmonics::QUIET) };
        let mut state = machine.at_rest();
        machine.advance(&tight(), &mut state, shaking, until, &LIMITS, &mut ()).unwrap();
        assert_eq!(state.motion.phase, phase);
    }
}

/// A support that gains speed for less than the transport delay of an engagement: the command to open catches up with the one to engage, and both are
/// due at once. The flywheel of the standing block takes up the speed that the support has then, ½ σ v²/(λR²), and the brake has it.
#[test]
fn an_engagement_of_no_length_creates_what_the_brake_takes() {
    let structure = of(Geometry::Slender, DeviceKind::ClutchedPair, Mount::CentreOfMass);
    let actuation = Actuation { engagement_delay: 0.05, delay: Delay::Transport, ..Actuation::default() };
    let machine: HybridSystem<f64> = Drivetrain { actuation, ..moving() }.resolve(&structure, false).unwrap();
    let pieces = [(AnySegment::Quiet, constant(0.04), 0.02), (AnySegment::Quiet, constant(-0.01), 0.04)];
    let mut ledger = Ledger::new(&structure.block, Geometry::Slender, &account(DeviceKind::ClutchedPair));
    let state = follow(&machine, &tight(), &pieces, &mut ledger);
    assert_eq!(state.motion.phase, Phase::Rest);
    let speed = GRAVITY * (0.04 * 0.02 - 0.01 * 0.03) / structure.block.size();
    let created = 0.5 * SIGMA / structure.block.inertia_ratio() * speed * speed;
    let entries = ledger.entries;
    assert!((entries.created / created - 1.0).abs() < 1e-12, "{entries:?} and {created}");
    assert!((entries.brake / created - 1.0).abs() < 1e-12 && entries.clutch == 0.0, "{entries:?}");
}

/// As the factor, by name and reason.
#[test]
fn what_needs_its_velocity_is_refused() {
    let pair = of(Geometry::Full, DeviceKind::ClutchedPair, Mount::CentreOfMass);
    let flywheel = FlywheelLosses { viscous_rate: 0.1, ..FlywheelLosses::default() };
    let rack = Rack { dry_ratio: 0.1, ..Rack::default() };
    for (drivetrain, structure, parameter, range) in [
        (
            Drivetrain { engagement: Engagement::Rigid, ..moving() },
            pair,
            "support_motion",
            "none with friction or a flywheel that keeps its speed",
        ),
        (Drivetrain { flywheel, ..moving() }, pair, "support_motion", "none with friction or a flywheel that keeps its speed"),
        (Drivetrain { rack, ..moving() }, pair, "support_motion", "none with friction or a flywheel that keeps its speed"),
        (
            moving(),
            of(Geometry::Full, DeviceKind::ClutchedPair, Mount::BaseCorners { pulley_ratio: 1.0 }),
            "support_motion",
            "none for vertical devices at the base corners",
        ),
        (
            Drivetrain { support: Support { amplification: 1.2, ..Support::MOVING }, ..moving() },
            pair,
            "support_amplification",
            "1 beside a support's own motion",
        ),
    ] {
        let error = drivetrain.resolve::<f64>(&structure, false).unwrap_err();
        assert_eq!((error.parameter, error.range), (parameter, range));
    }
}
