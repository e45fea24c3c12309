//! The same case gives the same bits on the host and on the emulated Cortex-M4F: outcome, every count, and the digest of
//! all states on the way. And the target's step costs what it may.
//!
//! Needs `qemu-system-arm` and the firmware for the board, named by `SPRAG_EMULATED_CORE_ELF` (`cargo xtask test` does both).

use std::collections::BTreeMap;
use std::path::Path;

use sprag_case::{Case, FixedMethod, Ground, GroundPiece, Initially, Shape};
use sprag_shared::ground::Harmonics;
use sprag_shared::observers::digest::Digest;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::RestitutionScatter;
use sprag_shared::structure::added_mass::AddedMass;
use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Actuation, Delay, Drivetrain, Engagement, FlywheelLosses, Rack, Support};
use sprag_shared::structure::{Restitution, Structure};
use sprag_tests::emulation::{emulate, firmware, kernels};

const METHODS: [FixedMethod; 3] = [FixedMethod::SemiImplicitEuler, FixedMethod::RungeKutta4, FixedMethod::Taylor];

/// σ = 0.5, η = 0.85.
fn structure(block: Block, geometry: Geometry, kind: DeviceKind) -> Structure {
    let device = Device { kind, mass_ratio: 0.5, ..Device::NONE };
    Structure { geometry, device, ..Structure::new(block, Restitution::Constant(0.85)) }
}

/// A slender block of p = 1/s under one cycle of sine with ω/p and a_g/(gα).
fn slender_sine(kind: DeviceKind, frequency_ratio: f32, amplitude_ratio: f32) -> Case<'static> {
    let block = Block::of_unit_frequency(10.0_f64.to_radians(), RECTANGLE_INERTIA_RATIO).unwrap();
    let sine = Harmonics::sine(amplitude_ratio * block.slenderness() as f32, frequency_ratio);
    let pulse = GroundPiece { shape: Shape::Sine(sine), duration: std::f32::consts::TAU / frequency_ratio };
    Case {
        structure: structure(block, Geometry::Slender, kind),
        drivetrain: Drivetrain::default(),
        initially: Initially::Rest,
        method: FixedMethod::RungeKutta4,
        step: 2e-3,
        ground: Ground::pieces(&[pulse]).unwrap(),
        free_time: 12.0,
    }
}

fn figure05(kind: DeviceKind) -> Case<'static> {
    slender_sine(kind, 4.0, 1.5)
}

fn figure10(kind: DeviceKind) -> Case<'static> {
    slender_sine(kind, 6.0, 7.7)
}

/// R = 2 m, α = 10°, full, under `scenes/near_fault.csv`.
fn near_fault(kind: DeviceKind, record: &Record) -> Case<'_> {
    let block = Block::new(2.0, 10.0_f64.to_radians(), RECTANGLE_INERTIA_RATIO).unwrap();
    Case {
        structure: structure(block, Geometry::Full, kind),
        drivetrain: Drivetrain::default(),
        initially: Initially::Rest,
        method: FixedMethod::RungeKutta4,
        step: record.interval,
        ground: Ground::Record { interval: record.interval, samples: &record.samples, vertical: None },
        free_time: 5.0,
    }
}

/// A record as a case holds it.
struct Record {
    interval: f32,
    samples: Vec<u32>,
}

impl Record {
    /// Two columns, s and g.
    fn read(path: &Path) -> Record {
        let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let rows: Vec<(f64, f32)> = text
            .lines()
            .filter_map(|line| line.split_once(','))
            .filter_map(|(time, acceleration)| Some((time.trim().parse().ok()?, acceleration.trim().parse().ok()?)))
            .collect();
        let interval = (rows[1].0 - rows[0].0) as f32;
        Record { interval, samples: rows.iter().map(|&(_, acceleration)| acceleration.to_bits()).collect() }
    }
}

fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// `name value` a line.
fn values(lines: &str) -> BTreeMap<&str, &str> {
    lines.lines().filter_map(|line| line.split_once(' ')).collect()
}

/// Runs the case here and there; gives how it ends.
pub fn compare(name: &str, case: &Case<'_>) -> Outcome {
    let mut words = vec![0; 16_384];
    let count = case.encode(&mut words).unwrap();
    words.truncate(count);
    let mut digest = Digest::default();
    let end = sprag_case::run(&words, &mut digest).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    std::fs::write(folder.path().join("case.bin"), bytes).unwrap();
    let lines = emulate(&firmware(), folder.path(), Some("case.bin"));
    let board = values(&lines);
    let host = [
        ("outcome", end.outcome.name().to_owned()),
        ("impacts", end.state.impacts.to_string()),
        ("peak_rotation_rad", end.peaks.rotation.to_string()),
        ("missed_engagements", end.missed.to_string()),
        ("stretches", digest.stretches.to_string()),
        ("events", digest.events.to_string()),
        ("steps", end.steps.to_string()),
        ("digest", format!("{:016x}", digest.hash())),
    ];
    for (key, value) in &host {
        assert_eq!(board.get(key), Some(&value.as_str()), "{name}: {key} on the board and on the host; {lines}");
    }
    let number = |key: &str| board[key].parse::<u64>().unwrap();
    let peak = end.peaks.rotation / case.structure.block.slenderness() as f32;
    println!(
        "{name}: {} peak {peak:.4} impacts {} stretches {} digest {:016x} instructions {} ({} a step)",
        end.outcome.name(),
        end.state.impacts,
        digest.stretches,
        digest.hash(),
        number("instructions"),
        number("instructions_per_step"),
    );
    end.outcome
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn figure05_is_the_same_on_the_board() {
    for kind in DeviceKind::ALL {
        for method in METHODS {
            let case = Case { method, ..figure05(kind) };
            assert_eq!(compare(&format!("figure05 {kind:?} {method:?}"), &case), Outcome::Safe);
        }
    }
}

/// With the clutch's switches located the pair survives Figure 10 even in single precision.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn figure10_is_the_same_on_the_board() {
    for kind in DeviceKind::ALL {
        assert_eq!(compare(&format!("figure10 {kind:?}"), &figure10(kind)), Outcome::Safe);
    }
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn the_near_fault_motion_is_the_same_on_the_board() {
    let record = Record::read(&workspace().join("scenes/near_fault.csv"));
    for method in METHODS {
        let case = Case { method, ..near_fault(DeviceKind::ClutchedPair, &record) };
        compare(&format!("near_fault {method:?}"), &case);
    }
}

/// What an effect adds to the ideal pair.
struct Effect {
    name: &'static str,
    drivetrain: Drivetrain,
    method: FixedMethod,
    restitution: Restitution,
    scatter: RestitutionScatter,
    added_mass: AddedMass,
}

impl Effect {
    fn of(name: &'static str, drivetrain: Drivetrain) -> Effect {
        let restitution = Restitution::Constant(0.85);
        let (method, scatter) = (FixedMethod::RungeKutta4, RestitutionScatter::NONE);
        Effect { name, drivetrain, method, restitution, scatter, added_mass: AddedMass::NONE }
    }
}

/// Every one alone, and all together.
fn effects() -> Vec<Effect> {
    let rack = Rack { viscous: 0.05, dry_ratio: 0.004, ..Rack::default() };
    let guided = Rack { guided_mass_ratio: 0.05, ..Rack::default() };
    let coasting = FlywheelLosses { viscous_rate: 0.05, dry_deceleration: 0.3, brake_deceleration: 0.0, drag_rate: 0.0 };
    let braked = FlywheelLosses { brake_deceleration: 5.0, ..coasting };
    let late = Actuation {
        engagement_delay: 0.02,
        release_delay: 0.01,
        delay: Delay::Transport,
        rise_time: 0.0,
        time_constant: 0.0,
        dwell: 0.03,
        miss_probability: 0.25,
        miss_seed: 0x1234_5678_9abc_def0,
    };
    let delayed = Actuation { engagement_delay: 0.02, ..Actuation::default() };
    let of = |engagement, flywheel| Drivetrain { engagement, flywheel, ..Drivetrain::default() };
    let spring = |backlash, capacity_ratio| Engagement::Elastic { stiffness: 3e3, damping: 8.0, backlash, capacity_ratio };
    let (rigid, plates) = (of(Engagement::Rigid, braked), of(Engagement::Friction { capacity_ratio: 0.03 }, braked));
    let (elastic, loose) = (of(spring(0.0, f64::INFINITY), braked), of(spring(0.002, 0.03), braked));
    let all =
        Drivetrain { rack: Rack { guided_mass_ratio: 0.05, ..rack }, actuation: Actuation { rise_time: 0.02, ..late }, ..plates };
    let gears = AddedMass { mass_ratio: 0.05, height: 1.0 };
    let balance = Restitution::MomentumBalance;
    let scatter = RestitutionScatter { deviation: 0.05, seed: 1 << 40 | 3 };
    vec![
        Effect::of("rigid", rigid),
        Effect::of("overrunning", of(Engagement::Overrunning, coasting)),
        Effect::of("friction clutch", plates),
        Effect::of("elastic", elastic),
        Effect { method: FixedMethod::ExponentialMidpoint, ..Effect::of("elastic, exponential midpoint", elastic) },
        Effect::of("elastic with play and plates", loose),
        Effect { method: FixedMethod::ExponentialMidpoint, ..Effect::of("play and plates, exponential midpoint", loose) },
        Effect::of("rack and bearing friction", Drivetrain { rack, ..of(Engagement::Ideal, coasting) }),
        Effect::of("delays and misses", Drivetrain { actuation: late, ..Drivetrain::default() }),
        Effect {
            added_mass: gears,
            ..Effect::of("guided rack and carried mass", Drivetrain { rack: guided, ..Drivetrain::default() })
        },
        Effect::of(
            "friction clutch of a coil",
            Drivetrain { actuation: Actuation { time_constant: 0.05, ..Actuation::default() }, ..plates },
        ),
        Effect::of("viscous slip", of(Engagement::Viscous { corner_frequency: 4.0 }, braked)),
        Effect::of(
            "drag of rigid clutches",
            Drivetrain { actuation: delayed, ..of(Engagement::Rigid, FlywheelLosses { drag_rate: 0.5, ..coasting }) },
        ),
        Effect::of(
            "drag of friction clutches",
            Drivetrain {
                actuation: delayed,
                ..of(Engagement::Friction { capacity_ratio: 0.03 }, FlywheelLosses { drag_rate: 0.5, ..coasting })
            },
        ),
        Effect::of("load friction", Drivetrain { rack: Rack { load_friction: 0.1, ..rack }, ..of(Engagement::Ideal, coasting) }),
        Effect::of(
            "load friction of a rigid clutch",
            Drivetrain { rack: Rack { load_friction: 0.1, ..Rack::default() }, ..rigid },
        ),
        Effect::of("moving support", Drivetrain { support: Support::amplified(1.5), ..Drivetrain::default() }),
        Effect { restitution: balance, ..Effect::of("momentum balance", rigid) },
        Effect { scatter, ..Effect::of("impacts that differ", Drivetrain::default()) },
        Effect { restitution: balance, scatter, added_mass: gears, ..Effect::of("all together", all) },
    ]
}

/// The pulse of `scenes/near_fault.csv` (from 6.5 s to 9.5 s), and 0.7 times what comes 0.2 s before it, for the vertical motion.
fn pulse() -> [Record; 2] {
    let Record { interval, samples } = Record::read(&workspace().join("scenes/near_fault.csv"));
    [(1300, 1.0), (1260, 0.7)].map(|(first, factor)| {
        let scaled = samples[first..first + 600].iter().map(|&bits| (f32::from_bits(bits) * factor).to_bits());
        Record { interval, samples: scaled.collect() }
    })
}

/// R = 2 m, α = 14° on a pair with `drivetrain`, in the consistent kinematics.
fn real_device(record: &Record, drivetrain: Drivetrain) -> Case<'_> {
    let case = near_fault(DeviceKind::ClutchedPair, record);
    let device = Device { kinematics: KinematicsKind::Consistent, ..case.structure.device };
    let block = Block::new(2.0, 14.0_f64.to_radians(), RECTANGLE_INERTIA_RATIO).unwrap();
    Case { structure: Structure { block, device, ..case.structure }, drivetrain, free_time: 3.0, ..case }
}

fn hash(case: &Case<'_>) -> u64 {
    let mut digest = Digest::default();
    case.run(&mut digest).unwrap();
    digest.hash()
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn every_effect_is_the_same_on_the_board() {
    let [record, _] = pulse();
    // A seed without a probability changes nothing but the loop.
    let seed = Drivetrain { actuation: Actuation { miss_seed: 7, ..Actuation::default() }, ..Drivetrain::default() };
    let mut hashes = [Drivetrain::default(), seed].map(|drivetrain| hash(&real_device(&record, drivetrain))).to_vec();
    for Effect { name, drivetrain, method, restitution, scatter, added_mass } in effects() {
        for geometry in [Geometry::Full, Geometry::Slender] {
            let base = real_device(&record, drivetrain);
            let structure = Structure { geometry, restitution, restitution_scatter: scatter, added_mass, ..base.structure };
            let case = Case { structure, method, ..base };
            compare(&format!("{name} {geometry:?}"), &case);
            let missed = case.run(&mut ()).unwrap().missed;
            assert_eq!(missed > 0, drivetrain.actuation.miss_probability > 0.0, "{name} {geometry:?}: {missed} missed");
            let own = hash(&case);
            assert!(!hashes.contains(&own), "{name} {geometry:?} changes nothing");
            hashes.push(own);
        }
    }
}

/// Over ground that moves vertically too: a record, with every clutch and without one, and shapes in closed form.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn vertical_motion_is_the_same_on_the_board() {
    let [record, up] = pulse();
    let ground = Ground::Record { interval: record.interval, samples: &record.samples, vertical: Some(&up.samples) };
    let drivetrains = [Drivetrain::default(), effects().pop().unwrap().drivetrain];
    for kind in DeviceKind::ALL {
        // Without a device there is no drivetrain.
        let count = if kind == DeviceKind::None { 1 } else { 2 };
        for &drivetrain in &drivetrains[..count] {
            let level = real_device(&record, drivetrain);
            let level = Case { structure: structure(level.structure.block, Geometry::Full, kind), ..level };
            let case = Case { ground, ..level };
            let name = format!("vertical {kind:?} {:?}", drivetrain.engagement);
            compare(&name, &case);
            assert_ne!(hash(&case), hash(&level), "{name} changes nothing");
        }
    }
    let level = figure10(DeviceKind::ClutchedPair);
    let Ground::Pieces { horizontal: [pulse, ..], .. } = level.ground else { unreachable!() };
    let up = Shape::Sine(Harmonics::sine(0.4, 20.0));
    let case = Case { ground: Ground::both_ways(&[(pulse, up)]).unwrap(), free_time: 3.0, ..level };
    compare("vertical sine", &case);
}

/// One Runge-Kutta step of the full model with a clutched pair, Eq. 10 and impact included, takes at most 250
/// instructions.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_step_is_cheap_enough() {
    let elf = firmware();
    let folder = tempfile::tempdir().unwrap();
    let lines = emulate(&elf, folder.path(), None);
    println!("{lines}");
    let kernels = kernels(&lines);
    assert_eq!(kernels["nothing"], 0, "the counter must not count itself");
    let step = kernels["rk4-full-clutched-pair"];
    assert!((100..=250).contains(&step), "{step} instructions");
    assert!(20 * kernels["sine32-sin-cos"] < kernels["libm-sinf-and-cosf"]);
    let machines = kernels.iter().filter(|(name, _)| name.starts_with("machine-"));
    assert!(machines.clone().count() == 15 && machines.map(|(_, count)| count).all(|count| (500..=20_000).contains(count)));
}
