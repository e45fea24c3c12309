//! Real devices of all kinds on random ground, far into the corners of their parameters: lanes and the core, two ways to take steps, agree.

use std::f64::consts::TAU;

use sprag_ensemble::hybrid::HybridBlock;
use sprag_ensemble::machine::{Registers, shake_hybrid};
use sprag_ensemble::shaken::Shaken;
use sprag_shared::ground::harmonic::MavroeidisPapageorgiou;
use sprag_shared::ground::{AnySegment, DampedOscillation, Harmonics, Linear, Ricker};
use sprag_shared::math;
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::{Block, GRAVITY, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Actuation, Delay, Drivetrain, Engagement, FlywheelLosses, Rack};
use sprag_shared::structure::mount::Mount;
use sprag_shared::structure::{Restitution, RestitutionScatter, Structure};
use sprag_sim::batch::case::TIGHT;
use sprag_sim::ground_motion::{Component, GroundMotion};
use sprag_sim::side_by_side::InPieces;
use sprag_sim::simulation::drive::{Course, Overturning};
use sprag_tests::{Dice, GEOMETRIES};

use super::hard_devices::follow;

const CASES: u64 = 2_000;

/// Far above rounding, and still accurate: by how much peaks differ there is how ill-conditioned a motion is.
const LOOSE: f64 = 1e-13;

fn one_of<T: Copy>(dice: &mut Dice, of: &[T]) -> T {
    of[(dice.roll() * of.len() as f64) as usize]
}

/// All orders of magnitude alike.
fn of_any_size(dice: &mut Dice, low: f64, high: f64) -> f64 {
    low * math::pow(high / low, dice.roll())
}

fn structure(dice: &mut Dice) -> Structure {
    let (size, slenderness) = (of_any_size(dice, 0.2, 20.0), dice.between(0.05, 0.7));
    let block = Block::new(size, slenderness, RECTANGLE_INERTIA_RATIO).unwrap();
    let height = dice.between(0.3, 1.9) * size * math::cos(slenderness);
    let mounts = [Mount::CentreOfMass, Mount::TyingPoint { height, pulley_ratio: one_of(dice, &[1.0, 2.0]) }];
    Structure {
        geometry: one_of(dice, &GEOMETRIES),
        device: Device {
            kind: one_of(dice, &[DeviceKind::ClutchedPair, DeviceKind::ClutchedPair, DeviceKind::Inerter]),
            mass_ratio: of_any_size(dice, 0.01, 5.0),
            mount: one_of(dice, &mounts),
            kinematics: one_of(dice, &[KinematicsKind::Consistent, KinematicsKind::Paper]),
        },
        restitution_scatter: RestitutionScatter { deviation: one_of(dice, &[0.0, 0.0, 0.05]), seed: (1e9 * dice.roll()) as u64 },
        ..Structure::new(block, Restitution::Constant(one_of(dice, &[0.0, 0.3, 0.7, 0.85, 0.95])))
    }
}

fn drivetrain(dice: &mut Dice, kind: DeviceKind) -> Drivetrain {
    let rack = Rack {
        viscous: one_of(dice, &[0.0, 0.0, 0.2, 50.0]),
        dry_ratio: one_of(dice, &[0.0, 0.0, 0.05, 0.4]),
        ..Rack::default()
    };
    if kind != DeviceKind::ClutchedPair {
        return Drivetrain { rack, ..Drivetrain::default() };
    }
    let plates = Engagement::Friction { capacity_ratio: one_of(dice, &[0.02, 0.1, 1.0]) };
    let engagement = one_of(dice, &[Engagement::Ideal, Engagement::Rigid, plates]);
    let actuation = Actuation {
        engagement_delay: one_of(dice, &[0.0, 1e-6, 0.02, 0.2]),
        release_delay: one_of(dice, &[0.0, 0.01, 0.1]),
        delay: one_of(dice, &[Delay::Inertial, Delay::Transport]),
        dwell: one_of(dice, &[0.0, 0.0, 0.1]),
        miss_probability: one_of(dice, &[0.0, 0.0, 0.3]),
        miss_seed: (1e9 * dice.roll()) as u64,
        ..Actuation::default()
    };
    let flywheel = FlywheelLosses {
        viscous_rate: one_of(dice, &[0.0, 0.3, 30.0, 1e4]),
        dry_deceleration: one_of(dice, &[0.0, 0.05, 3.0]),
        brake_deceleration: one_of(dice, &[0.0, 2.0, f64::INFINITY]),
        drag_rate: 0.0,
    };
    let flywheel = if engagement == Engagement::Ideal { FlywheelLosses::default() } else { flywheel };
    Drivetrain { engagement, flywheel, rack, actuation, ..Drivetrain::default() }
}

/// A motion of `amplitude` (in g) and about the angular frequency `w` (rad/s).
fn component(dice: &mut Dice, amplitude: f64, w: f64) -> Component {
    let (duration, shape) = match (6.0 * dice.roll()) as u32 {
        0 => (TAU / w, AnySegment::Sine(Harmonics::sine(amplitude, w))),
        1 => (TAU / w, AnySegment::Sine(Harmonics::cosine(amplitude, w))),
        2 => (6.0 / w, AnySegment::Ricker(Ricker { amplitude, rate: w, centre: 3.0 / w })),
        3 => (2.0 / w, AnySegment::Linear(Linear::constant(amplitude))),
        4 => {
            let (side, decay) = (0.6 * amplitude, 0.1 * w);
            (12.0 / w, AnySegment::Damped(DampedOscillation { real: side, imaginary: side, decay, frequency: w }))
        }
        _ => {
            let (velocity_amplitude, oscillations) = (amplitude * GRAVITY / w, dice.between(1.1, 5.0));
            let phase = dice.between(0.0, TAU);
            let pulse = MavroeidisPapageorgiou { velocity_amplitude, frequency: w / TAU, oscillations, phase };
            (pulse.duration(), AnySegment::ThreeSines(pulse.harmonics()))
        }
    };
    Component::pulse(one_of(dice, &[0.0, 0.0, 0.37]), duration, shape)
}

/// Horizontal motions from just above the threshold of uplift on, and with some probability a vertical one beside them.
fn ground(dice: &mut Dice, structure: &Structure) -> [GroundMotion; 2] {
    let (block, geometry) = (&structure.block, structure.geometry);
    let uplift = geometry.uplift_threshold(block.slenderness());
    let mut level = Vec::new();
    for _ in 0..=usize::from(dice.roll() < 0.3) {
        let amplitude = uplift * one_of(dice, &[1.0 + 1e-7, 1.01, -1.3, 2.0, -3.0, 8.0]);
        let w = block.frequency_parameter() * of_any_size(dice, 0.02, 60.0);
        level.push(component(dice, amplitude, w));
    }
    let mut up = Vec::new();
    if dice.roll() < 0.3 {
        let w = block.frequency_parameter() * of_any_size(dice, 0.02, 60.0);
        let amplitude = dice.between(-0.4, 0.4);
        up.push(Component::pulse(0.0, TAU / w, AnySegment::Sine(Harmonics::sine(amplitude, w))));
    }
    GroundMotion::aligned(&level, &up)
}

/// Outcome and peaks by the core, θ/α and θ̈/(p²α).
fn by_core(course: &Course<'_>, system: &HybridSystem<f64>, tolerance: f64) -> (Outcome, [f64; 2]) {
    let (state, peaks) = follow(course, system, tolerance);
    (Outcome::of(&state, &peaks), relative(system, &peaks))
}

fn relative(system: &HybridSystem<f64>, peaks: &Peaks<f64>) -> [f64; 2] {
    let HybridSystem { slenderness, speed, .. } = system;
    [peaks.rotation / slenderness, peaks.acceleration * slenderness / (speed * speed)]
}

#[test]
fn lanes_and_the_core_agree_on_random_devices() {
    let (mut outcomes, mut worst) = ([0; 4], 0.0_f64);
    for seed in 0..CASES {
        let dice = &mut Dice(seed << 32);
        let structure = structure(dice);
        let drivetrain = drivetrain(dice, structure.device.kind);
        let [level, up] = ground(dice, &structure);
        let vertical = Some(&up).filter(|up| up.peak_m_s2() > 0.0);
        let Ok(system) = drivetrain.resolve::<f64>(&structure, vertical.is_some()) else { continue };
        let free_time = 10.0 / structure.block.frequency_parameter();
        let course = Course { vertical, ..Course::of(&structure, &level, free_time, Overturning::Reached) };
        let (outcome, peaks) = by_core(&course, &system, TIGHT);
        let pieces = InPieces::new(&level, vertical, free_time);
        let block =
            HybridBlock { system: &system, overturned_at_slenderness: false, ground: pieces.ground(), checks: None, coils: None };
        let found = shake_hybrid(&[block], Registers::Widest)[0].expect("lanes take it").after(&block, 0.0).unwrap();
        let case = format!("case {seed}: {structure:?} {drivetrain:?}");
        assert_eq!(Shaken::from(found).outcome(), outcome, "{case}");
        outcomes[outcome as usize] += 1;
        if outcome != Outcome::Safe {
            continue;
        }
        let (_, loose) = by_core(&course, &system, LOOSE);
        for ((ours, theirs), loose) in relative(&system, &found.peaks).into_iter().zip(peaks).zip(loose) {
            let apart = (ours - theirs).abs() / (1.0 + theirs);
            assert!(apart <= 1e-8 + (loose - theirs).abs(), "{apart} of {theirs}, {loose} {case}");
            worst = worst.max(apart);
        }
    }
    println!("outcomes {outcomes:?}, peaks apart {worst:e} at most");
    assert!(outcomes.iter().all(|&number| number >= CASES / 50), "{outcomes:?}");
}
