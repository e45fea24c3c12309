//! Blocks with real devices in lanes against the core, which follows one at a time.

use std::f64::consts::TAU;

use sprag_ensemble::hybrid::ground::{Ground, Sampled};
use sprag_ensemble::hybrid::{HybridBlock, HybridMotion, Steps};
use sprag_ensemble::machine::{Registers, shake_hybrid};
use sprag_ensemble::shaken::{Samples, Shaken};
use sprag_loops::{Method, hybrid};
use sprag_shared::ground::harmonic::MavroeidisPapageorgiou;
use sprag_shared::ground::{AnySegment, DampedOscillation, Harmonics, Linear, Ricker};
use sprag_shared::math;
use sprag_shared::motion::hybrid::{HybridState, HybridSystem};
use sprag_shared::motion::state::Phase;
use sprag_shared::observers::checks::Checks;
use sprag_shared::observers::coil_use::CoilUse;
use sprag_shared::observers::counted_swing::CountedSwing;
use sprag_shared::observers::ledger::{Account, Clutching};
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::RestitutionScatter;
use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Actuation, Delay, Drivetrain, Engagement, FlywheelLosses, Rack};
use sprag_shared::structure::mount::Mount;
use sprag_shared::structure::{Restitution, Structure};
use sprag_sim::batch::case::TIGHT;
use sprag_sim::ground_motion::{Component, GroundMotion};
use sprag_sim::side_by_side::InPieces;
use sprag_sim::simulation::drive::{Course, Overturning};

use super::lanes_under_pulses::have_the_same_bits;
use super::lanes_under_records::motion;

/// Powers of two: times of samples are exact, so that the ground never seems to jump between two of them.
const STEP: f64 = 1.0 / 128.0;
/// Of old records, and beyond: series need more terms, and at last the core's own steps.
const LONG_STEPS: [f64; 3] = [1.0 / 32.0, 1.0 / 16.0, 1.0 / 4.0];
const SECONDS: f64 = 10.0;
const FREE_TIME: f64 = 6.0;
/// A vertical motion is a part of a horizontal one.
const UP: f64 = 0.4;

fn rigid(losses: (f64, f64, f64), actuation: Actuation) -> Drivetrain {
    let (viscous_rate, dry_deceleration, brake_deceleration) = losses;
    let flywheel = FlywheelLosses { viscous_rate, dry_deceleration, brake_deceleration, drag_rate: 0.0 };
    Drivetrain { engagement: Engagement::Rigid, flywheel, actuation, ..Drivetrain::default() }
}

/// Drivetrains of all kinds.
fn drivetrains() -> Vec<Drivetrain> {
    let delays = Actuation { engagement_delay: 0.02, release_delay: 0.01, ..Actuation::default() };
    let lossy = rigid((0.3, 0.05, 0.0), delays);
    vec![
        rigid((0.0, 0.0, 0.0), Actuation::default()),
        lossy,
        rigid((0.3, 0.05, 2.0), Actuation { delay: Delay::Transport, dwell: 0.05, ..delays }),
        rigid((0.0, 0.1, f64::INFINITY), Actuation { miss_probability: 0.2, miss_seed: 7, ..delays }),
        Drivetrain { rack: Rack { viscous: 0.2, dry_ratio: 0.02, ..Rack::default() }, ..lossy },
        Drivetrain { engagement: Engagement::Friction { capacity_ratio: 0.2 }, ..lossy },
        Drivetrain { engagement: Engagement::Overrunning, actuation: Actuation::default(), ..lossy },
        Drivetrain { actuation: delays, ..Drivetrain::default() },
        Drivetrain { engagement: Engagement::Viscous { corner_frequency: 3.0 }, ..lossy },
        Drivetrain { rack: Rack { load_friction: 0.2, ..Rack::default() }, ..lossy },
    ]
}

fn structures(geometry: Geometry) -> Vec<Structure> {
    structures_with(geometry, DeviceKind::ClutchedPair, KinematicsKind::Consistent)
}

fn structures_with(geometry: Geometry, kind: DeviceKind, kinematics: KinematicsKind) -> Vec<Structure> {
    let kinds = [(1.0, 0.15, 0.85), (2.0, 0.25, 0.7), (5.0, 0.17, 0.95), (0.4, 0.3, 0.5)];
    let structure = |(index, (size, slenderness, restitution)): (usize, (f64, f64, f64))| {
        let block = Block::new(size, slenderness, RECTANGLE_INERTIA_RATIO).unwrap();
        let mount = if index % 2 == 0 {
            Mount::CentreOfMass
        } else {
            Mount::TyingPoint { height: 1.6 * size * math::cos(slenderness), pulley_ratio: 1.0 }
        };
        Structure {
            geometry,
            device: Device { kind, mass_ratio: 0.5, mount, kinematics },
            restitution_scatter: RestitutionScatter { deviation: if index == 1 { 0.05 } else { 0.0 }, seed: 5 },
            ..Structure::new(block, Restitution::Constant(restitution))
        }
    };
    kinds.into_iter().enumerate().map(structure).collect()
}

/// Peaks, checks and the use of coils, at once.
type All = (Peaks<f64>, (Checks<f64>, CoilUse));

/// Checks of forces, and with `all` of everything else.
fn checks(structure: &Structure, all: bool) -> Checks<f64> {
    let account = Account { clutching: Clutching::Rigid, mass_ratio: structure.device.mass_ratio, ..Account::default() };
    let checks = Checks::new(&structure.block, structure.geometry, &structure.device.mount, &account).unwrap();
    if all { checks } else { checks.of_flywheels() }
}

fn coils(structure: &Structure) -> CoilUse {
    CoilUse::of(false, CountedSwing::of(&structure.block))
}

/// A motion of the ground, for lanes and for the core.
struct Moving<'a> {
    ground: Ground<'a>,
    level: GroundMotion,
    vertical: Option<GroundMotion>,
}

/// Records of this `step` (s), each at several scales, with a vertical one or without.
fn shaken(records: &[Samples], vertical: bool) -> Vec<Moving<'_>> {
    let component = |of: &Samples, factor: f64| Component::record(0.0, of.step(), of.values().iter().map(|value| factor * value));
    let moving = |samples, factor| {
        let level = [component(samples, factor)];
        let up = vertical.then_some((&records[0], UP));
        let ground = Ground::Record(Sampled { samples, factor, vertical: up });
        match up {
            None => Moving { ground, level: GroundMotion::sum(&level), vertical: None },
            Some((up, factor)) => {
                let [level, up] = GroundMotion::aligned(&level, &[component(up, factor)]);
                Moving { ground, level, vertical: Some(up) }
            }
        }
    };
    records.iter().flat_map(|samples| [0.25, 0.5, 0.8, -1.2, 2.0].map(|factor| moving(samples, factor))).collect()
}

/// By the core, alone.
fn alone(structure: &Structure, system: &HybridSystem<f64>, moving: &Moving<'_>) -> (HybridState<f64>, All) {
    let Moving { level, vertical, .. } = moving;
    let course = Course { vertical: vertical.as_ref(), ..Course::of(structure, level, FREE_TIME, Overturning::Reached) };
    let (mut state, mut all) = (system.at_rest(), (Peaks::default(), (checks(structure, true), coils(structure))));
    let method = hybrid(Method::Adaptive(TIGHT));
    course.follow_machine(system, &*method, &mut state, &mut all, || true).unwrap();
    (state, all)
}

/// Steps and phases of what was compared.
#[derive(Default)]
struct Seen {
    steps: [u32; 3],
    phases: [u32; 3],
}

/// A few per cent of the steps are the core's alone; more where flywheels are overrun, where the force on a mesh has a sign to look for, and with
/// viscous slip, of which lanes have no equations.
fn are_hard(drivetrain: &Drivetrain) -> bool {
    let hard = matches!(drivetrain.engagement, Engagement::Overrunning | Engagement::Viscous { .. });
    hard || drivetrain.rack.load_friction != 0.0
}

/// Compares lanes and core for `structures` on `drivetrain` under each of `motions`.
fn compare(structures: Vec<Structure>, drivetrain: &Drivetrain, motions: &[Moving<'_>]) -> Seen {
    let vertical = motions.iter().any(|moving| moving.vertical.is_some());
    let mut seen = Seen::default();
    for structure in structures {
        let system = drivetrain.resolve::<f64>(&structure, vertical).unwrap();
        let checks = checks(&structure, false);
        let coils = Some(coils(&structure));
        let block =
            |ground| HybridBlock { system: &system, overturned_at_slenderness: false, ground, checks: Some(&checks), coils };
        let asked: Vec<HybridBlock<'_>> = motions.iter().map(|moving| block(moving.ground)).collect();
        for ((block, moving), found) in asked.iter().zip(motions).zip(shake_hybrid(&asked, Registers::Widest)) {
            let found = found.expect("lanes take it");
            let free_time = if let Ground::Record(_) = block.ground { FREE_TIME } else { 0.0 };
            let found = found.after(block, free_time).unwrap();
            let Steps { plain, located, by_core } = found.steps;
            for (sum, number) in seen.steps.iter_mut().zip([plain, located, by_core]) {
                *sum += number;
            }
            let (state, (peaks, (checked, used))) = alone(&structure, &system, moving);
            let case = format!("{structure:?} {drivetrain:?} {:?}: {found:?} {state:?} {peaks:?}", block.ground);
            seen.phases[state.motion.phase as usize] += 1;
            assert_eq!(
                (found.state.motion.phase, found.state.motion.impacts),
                (state.motion.phase, state.motion.impacts),
                "{case}"
            );
            // On quiet ground θ̈ of a slender block changes its sign where the block overturns: rounding decides whether a clutch engages there.
            let last = u32::from((structure.geometry, state.motion.phase) == (Geometry::Slender, Phase::Overturned));
            assert!(found.state.device.engagements.abs_diff(state.device.engagements) <= last, "{case}");
            assert_eq!(found.peaks.rocked, peaks.rocked, "{case}");
            for (ours, theirs) in [(found.peaks.first_impact, peaks.first_impact), (found.peaks.ended, peaks.ended)] {
                assert_eq!(ours.is_some(), theirs.is_some(), "{case}");
                let apart = ours.zip(theirs).map_or(0.0, |(ours, theirs)| (ours - theirs).abs());
                assert!(apart < 1e-7, "{apart} {case}");
            }
            let largest = [checked.report.support, checked.report.largest_force(), checked.report.stroke()]
                .map(|found| found.map_or(0.0, |found| found.value));
            let ours = [found.support_force_ratio(), found.flywheel_force_ratio(), found.stroke()];
            for (ours, theirs) in ours.into_iter().zip(largest) {
                assert!((ours.unwrap() - theirs).abs() <= 1e-9 * (1.0 + theirs), "{ours:?} {theirs} {case}");
            }
            if state.motion.phase != Phase::Overturned {
                let (alpha, scale) = (system.slenderness, system.speed * system.speed / system.slenderness);
                assert!((found.peaks.rotation - peaks.rotation).abs() <= 1e-9 * alpha, "{case}");
                assert!((found.peaks.acceleration - peaks.acceleration).abs() <= 1e-9 * scale, "{case}");
            }
            // Nothing holds an inerter without clutches.
            if structure.device.kind == DeviceKind::ClutchedPair {
                let ours = found.coils.unwrap();
                assert!((ours.engaged_s - used.engaged_s).abs() <= 1e-7, "{ours:?} {used:?} {case}");
                assert!(ours.closings.abs_diff(used.closings) <= last, "{ours:?} {used:?} {case}");
            }
        }
    }
    seen
}

fn records(step: f64) -> Vec<Samples> {
    (1..6).map(|seed| Samples::new(step, motion(seed, SECONDS, step))).collect()
}

#[test]
fn real_devices_under_records_do_what_they_do_alone() {
    let records = records(STEP);
    let motions = shaken(&records, false);
    for geometry in [Geometry::Full, Geometry::Slender] {
        for (index, drivetrain) in drivetrains().iter().enumerate() {
            let seen = compare(structures(geometry), drivetrain, &motions);
            println!("{geometry:?} {index}: {:?} {:?}", seen.steps, seen.phases);
            assert!(seen.phases[Phase::Rest as usize] > 10 && seen.phases[Phase::Overturned as usize] > 5, "{:?}", seen.phases);
            let [plain, located, by_core] = seen.steps;
            assert!(are_hard(drivetrain) || by_core * 25 <= plain + located, "{:?}", seen.steps);
        }
    }
}

#[test]
fn real_devices_do_so_on_ground_that_moves_vertically_too() {
    let records = records(STEP);
    let motions = shaken(&records, true);
    for geometry in [Geometry::Full, Geometry::Slender] {
        // With dwell and misses some of these motions are so ill-conditioned that rounding shows in the ninth digit.
        for drivetrain in [0, 1, 4, 5].map(|index| drivetrains()[index]) {
            compare(structures(geometry), &drivetrain, &motions);
        }
    }
}

#[test]
fn ideal_devices_do_so_by_either_kinematics() {
    use KinematicsKind::{Consistent, Paper};
    let records = records(STEP);
    let motions = [shaken(&records, false), shaken(&records, true)];
    for geometry in [Geometry::Full, Geometry::Slender] {
        for kind in DeviceKind::ALL {
            for (kinematics, vertical) in [(Paper, false), (Paper, true), (Consistent, true)] {
                let mut structures = structures_with(geometry, kind, kinematics);
                // Ground that nearly lifts a block of nearly elastic impacts magnifies rounding up to 1e10 times.
                structures.retain(|structure| !vertical || structure.restitution != Restitution::Constant(0.95));
                let [plain, located, by_core] =
                    compare(structures, &Drivetrain::default(), &motions[usize::from(vertical)]).steps;
                assert!(by_core * 25 <= plain + located, "{kind:?} {kinematics:?} {plain} {located} {by_core}");
            }
        }
    }
}

#[test]
fn samples_far_apart_take_nothing_from_the_accuracy() {
    for (index, step) in LONG_STEPS.into_iter().enumerate() {
        let records = records(step);
        let motions = shaken(&records, false);
        for geometry in [Geometry::Full, Geometry::Slender] {
            for drivetrain in [Drivetrain::default(), drivetrains()[1], drivetrains()[5]] {
                let [plain, located, by_core] = compare(structures(geometry), &drivetrain, &motions).steps;
                println!("{step} {geometry:?} {plain} {located} {by_core}");
                assert!(index > 0 || by_core * 5 <= plain + located);
            }
        }
    }
}

/// Pulses of every shape, some of which jump or overlap, with a vertical one beside each or without.
fn pulses(vertical: bool) -> Vec<(GroundMotion, Option<GroundMotion>)> {
    let pulse = |start, duration, shape| Component::pulse(start, duration, shape);
    let sine = |amplitude, frequency: f64| pulse(0.0, TAU / frequency, AnySegment::Sine(Harmonics::sine(amplitude, frequency)));
    let cosine =
        |amplitude, frequency: f64| pulse(0.2, TAU / frequency, AnySegment::Sine(Harmonics::cosine(amplitude, frequency)));
    let ricker = |amplitude| pulse(0.0, 2.0, AnySegment::Ricker(Ricker { amplitude, rate: 5.0, centre: 1.0 }));
    let near_fault = MavroeidisPapageorgiou { velocity_amplitude: 0.9, frequency: 0.7, oscillations: 2.5, phase: 0.4 };
    let constant = |duration, level| pulse(0.3, duration, AnySegment::Linear(Linear::constant(level)));
    let free = DampedOscillation { real: 0.2, imaginary: 0.5, decay: 0.8, frequency: 4.0 };
    let lines =
        |factor| Component::record(0.5, 0.25, [0.0, 0.2, -0.3, 0.35, -0.1, 0.0].into_iter().map(move |value| factor * value));
    let level: Vec<Vec<Component>> = vec![
        vec![sine(0.3, 3.0)],
        vec![sine(-0.8, 6.0)],
        vec![cosine(0.35, 2.5)],
        vec![sine(0.7, 12.0)],
        vec![cosine(-1.5, 9.0)],
        vec![ricker(0.4)],
        vec![ricker(-0.9)],
        vec![pulse(0.1, near_fault.duration(), AnySegment::ThreeSines(near_fault.harmonics()))],
        vec![constant(0.4, 0.4)],
        vec![pulse(0.0, 5.0, AnySegment::Damped(free))],
        vec![sine(0.3, 4.0), lines(1.5), constant(0.2, -0.2)],
        vec![lines(2.0), ricker(0.2)],
    ];
    let with_vertical = |level: &Vec<Component>| {
        if !vertical {
            return (GroundMotion::sum(level), None);
        }
        let [level, up] = GroundMotion::aligned(level, &[sine(-UP, 7.0)]);
        (level, Some(up))
    };
    level.iter().map(with_vertical).collect()
}

fn in_pieces((level, vertical): &(GroundMotion, Option<GroundMotion>)) -> InPieces<'_> {
    InPieces::new(level, vertical.as_ref(), FREE_TIME)
}

#[test]
fn real_devices_do_so_under_pulses_and_sums_of_motions() {
    for vertical in [false, true] {
        let pulses = pulses(vertical);
        let pieces: Vec<InPieces<'_>> = pulses.iter().map(in_pieces).collect();
        let moving = |((level, vertical), ground)| Moving { ground, level, vertical };
        let grounds = pieces.iter().map(InPieces::ground);
        let motions: Vec<Moving<'_>> = pulses.iter().cloned().zip(grounds).map(moving).collect();
        for geometry in [Geometry::Full, Geometry::Slender] {
            for (index, drivetrain) in drivetrains().iter().enumerate() {
                let Seen { steps, phases } = compare(structures(geometry), drivetrain, &motions);
                println!("{vertical} {geometry:?} {index}: {steps:?} {phases:?}");
                assert!(phases[Phase::Rest as usize] > 20 && phases[Phase::Overturned as usize] > 5, "{phases:?}");
                assert!(are_hard(drivetrain) || steps[2] * 25 <= steps[0] + steps[1], "{steps:?}");
            }
        }
    }
}

#[test]
fn bits_depend_neither_on_registers_nor_on_neighbours() {
    let records = records(STEP);
    let pulses = pulses(false);
    let pieces: Vec<InPieces<'_>> = pulses.iter().map(in_pieces).collect();
    let record = |samples| Ground::Record(Sampled { samples, factor: 0.9, vertical: None });
    let motions: Vec<Ground<'_>> =
        records[..3].iter().map(record).chain(pieces.iter().step_by(2).map(InPieces::ground)).collect();
    let systems: Vec<HybridSystem<f64>> = [Geometry::Full, Geometry::Slender]
        .into_iter()
        .flat_map(structures)
        .flat_map(|structure| drivetrains().into_iter().map(move |drivetrain| drivetrain.resolve(&structure, false).unwrap()))
        .collect();
    let block = |(system, ground)| HybridBlock { system, overturned_at_slenderness: false, ground, checks: None, coils: None };
    let asked: Vec<HybridBlock<'_>> =
        systems.iter().flat_map(|system| motions.iter().map(move |&ground| (system, ground))).map(block).collect();
    type Bits = (Phase, [u64; 6], u32, Steps);
    have_the_same_bits(asked, |asked: &[HybridBlock<'_>], registers| -> Vec<Option<Bits>> {
        let of = |found: &HybridMotion| {
            let Shaken { phase, rotation, velocity, impacts, peaks } = (*found).into();
            let spins = found.state.device.wheels.map(|wheel| wheel.spin);
            let numbers = [rotation, velocity, peaks.rotation, peaks.acceleration, spins[0], spins[1]].map(f64::to_bits);
            (phase, numbers, impacts, found.steps)
        };
        shake_hybrid(asked, registers).iter().map(|found| found.as_ref().map(of)).collect()
    });
}

/// What lanes do not know is left to the core.
#[test]
fn what_is_not_plain_is_left_to_the_core() {
    let [structure, ..] = &structures(Geometry::Full)[..] else { unreachable!() };
    let lossy = drivetrains()[1];
    let guided = Drivetrain { rack: Rack { guided_mass_ratio: 0.1, ..Rack::default() }, ..lossy };
    let samples = Samples::new(STEP, motion(1, SECONDS, STEP));
    let of = |drivetrain: &Drivetrain, samples: &Samples| {
        let system = drivetrain.resolve(structure, false).unwrap();
        let ground = Ground::Record(Sampled { samples, factor: 1.0, vertical: None });
        let block = HybridBlock { system: &system, overturned_at_slenderness: false, ground, checks: None, coils: None };
        shake_hybrid(&[block], Registers::Widest)[0].is_some()
    };
    assert!(of(&lossy, &samples) && !of(&guided, &samples));
    for values in [vec![], vec![0.3], vec![0.0, 1e6, 0.0]] {
        assert!(!of(&lossy, &Samples::new(STEP, values)));
    }
}
