//! How fast studies are where devices are real: rigid clutches with coasting flywheels, losses and delays.
//!
//! `cargo bench --bench real_devices` takes 100 structures under 200 motions of 40 s at 5 ms ([`shakings`]; those that overturn end there),
//! and one block under a grid of sine pulses, on one core. It prints runs a second in lanes, those of the core, which takes a part of them
//! one by one, those of registers that every machine has, the shares of steps in which the core located an event, and that it took alone,
//! and how far peaks are apart (θ/α, θ̈/(p²α)).

use std::f64::consts::TAU;
use std::time::Instant;

use sprag_ensemble::hybrid::ground::{Ground, Sampled};
use sprag_ensemble::hybrid::{HybridBlock, HybridMotion, Steps};
use sprag_ensemble::machine::{Registers, shake_hybrid};
use sprag_ensemble::shaken::{Samples, Shaken};
use sprag_loops::{HybridLoop, Method, hybrid};
use sprag_shared::ground::{AnySegment, Harmonics};
use sprag_shared::motion::hybrid::{HybridState, HybridSystem};
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Actuation, Drivetrain, Engagement, FlywheelLosses};
use sprag_shared::structure::{Restitution, Structure};
use sprag_sim::batch::case::TIGHT;
use sprag_sim::ground_motion::{Component, GroundMotion};
use sprag_sim::side_by_side::InPieces;
use sprag_sim::simulation::drive::{Course, Overturning};

mod shakings;

use shakings::{MOTIONS, SECONDS, STEP, STRUCTURES, block, motion};

const FREE_TIME: f64 = 10.0;
/// A vertical motion is half as strong as the horizontal one of its number.
const UP: f64 = 0.5;
/// Pulses along both axes: frequencies ω/p from 0.2 to 8 and amplitudes from 1 to 10 times the uplift threshold.
const GRID: u32 = 64;

fn main() {
    let records: Vec<Samples> = (0..MOTIONS).map(|seed| Samples::new(STEP, motion(seed))).collect();
    println!(
        "runs a second on one core: {MOTIONS} motions of {SECONDS} s at {STEP} s, {STRUCTURES} structures; one under {GRID} x {GRID} pulses"
    );
    println!(
        "{:8} {:34} {:>8} {:>10} {:>6} {:>8} {:>16} {:>14} {:>18}",
        "geometry", "case", "lanes", "one by one", "ratio", "baseline", "events, by core", "runs to core", "peaks apart, worst"
    );
    for geometry in [Geometry::Full, Geometry::Slender] {
        for case in [Case::Rigid, Case::Vertical, Case::Capacity] {
            under_records(geometry, case, &records);
        }
        for case in [Case::Rigid, Case::Vertical, Case::Capacity] {
            under_pulses(geometry, case);
        }
    }
}

/// What is beside the block.
#[derive(Clone, Copy, PartialEq)]
enum Case {
    Rigid,
    Vertical,
    Capacity,
}

impl Case {
    /// Whether the ground moves vertically too.
    fn lifts(self) -> bool {
        self == Case::Vertical
    }

    fn name(self) -> &'static str {
        match self {
            Case::Rigid => "rigid, level ground",
            Case::Vertical => "rigid, vertical motion too",
            Case::Capacity => "with capacity",
        }
    }
}

fn under_records(geometry: Geometry, case: Case, records: &[Samples]) {
    let structures: Vec<Structure> = (0..STRUCTURES).filter_map(|index| Some(structure(geometry, block(index)?))).collect();
    let systems = systems(case, &structures);
    let motion = |index: usize| {
        let up = case.lifts().then(|| (&records[(index + 1) % records.len()], UP));
        Sampled { samples: &records[index % records.len()], factor: 1.0, vertical: up }
    };
    let block = |index: usize| block_on(&systems[index / records.len()], Ground::Record(motion(index)));
    let blocks: Vec<HybridBlock<'_>> = (0..systems.len() * records.len()).map(block).collect();
    compare((geometry, case, "records"), &blocks, (records.len() * 10, 100), |index| {
        let component = |of: &Samples, factor: f64| Component::record(0.0, STEP, of.values().iter().map(|value| factor * value));
        let Sampled { samples, vertical, .. } = motion(index);
        let up = vertical.map(|(up, factor)| component(up, factor));
        (&structures[index / records.len()], GroundMotion::aligned(&[component(samples, 1.0)], up.as_slice()))
    });
}

fn under_pulses(geometry: Geometry, case: Case) {
    let Ok(block) = Block::new(2.0, 20_f64.to_radians(), RECTANGLE_INERTIA_RATIO) else { return };
    let structures = [structure(geometry, block)];
    let systems = systems(case, &structures);
    let (p, uplift) = (block.frequency_parameter(), geometry.uplift_threshold(block.slenderness()));
    let along = |from: f64, to: f64, number: u32| from + (to - from) * f64::from(number) / f64::from(GRID - 1);
    let sine = |amplitude: f64, frequency: f64| {
        Component::pulse(0.0, TAU / frequency, AnySegment::Sine(Harmonics::sine(amplitude, frequency)))
    };
    let motions = |index: u32| {
        let (frequency, amplitude) = (p * along(0.2, 8.0, index % GRID), uplift * along(1.0, 10.0, index / GRID));
        // The ground does not fall away from the block.
        let up = case.lifts().then(|| sine(UP * amplitude.min(1.0), 2.0 * frequency));
        GroundMotion::aligned(&[sine(amplitude, frequency)], up.as_slice())
    };
    let motions: Vec<[GroundMotion; 2]> = (0..GRID * GRID).map(motions).collect();
    let up = |motion| Some(motion).filter(|_| case.lifts());
    let all: Vec<InPieces<'_>> = motions.iter().map(|[level, vertical]| InPieces::new(level, up(vertical), FREE_TIME)).collect();
    let blocks: Vec<HybridBlock<'_>> = all.iter().map(|pieces| block_on(&systems[0], pieces.ground())).collect();
    compare((geometry, case, "pulses"), &blocks, (512, 8), |index| (&structures[0], motions[index].clone()));
}

fn block_on<'a>(system: &'a HybridSystem<f64>, ground: Ground<'a>) -> HybridBlock<'a> {
    HybridBlock { system, overturned_at_slenderness: false, ground, checks: None, coils: None }
}

/// Prints a line: `blocks` in lanes, so many at a time, and one of so many by the core, which is given its structure and motions.
fn compare<'s>(
    (geometry, case, under): (Geometry, Case, &str),
    blocks: &[HybridBlock<'_>],
    (together, sparse): (usize, usize),
    motion: impl Fn(usize) -> (&'s Structure, [GroundMotion; 2]),
) {
    let method = hybrid(Method::Adaptive(TIGHT));
    let (mut worst, mut wrong, mut left, mut seconds) = (0.0_f64, 0, 0, [0.0; 3]);
    let mut steps = [0.0; 3];
    // In turns, so that whatever else the machine does slows down both.
    for (part, some) in blocks.chunks(together).enumerate() {
        let start = Instant::now();
        let found = to_the_end(some, Registers::Widest);
        seconds[0] += start.elapsed().as_secs_f64();
        let tenth: Vec<HybridBlock<'_>> = some.iter().step_by(10).copied().collect();
        let start = Instant::now();
        let _ = to_the_end(&tenth, Registers::Baseline);
        seconds[1] += 10.0 * start.elapsed().as_secs_f64();
        let few: Vec<usize> = (0..some.len()).step_by(sparse).collect();
        let start = Instant::now();
        let one_by_one = |&index: &usize| {
            let (structure, motions) = motion(part * together + index);
            alone(structure, some[index].system, &motions, case, &*method)
        };
        let cores: Vec<(HybridState<f64>, Peaks<f64>)> = few.iter().map(one_by_one).collect();
        seconds[2] += sparse as f64 * start.elapsed().as_secs_f64();
        left += found.iter().filter(|found| found.is_none()).count();
        for Steps { plain, located, by_core } in found.iter().flatten().map(|found| found.steps) {
            steps = [steps[0] + f64::from(plain), steps[1] + f64::from(located), steps[2] + f64::from(by_core)];
        }
        for (index, (state, peaks)) in few.into_iter().zip(cores) {
            let Some(found) = &found[index] else { continue };
            let outcome = Outcome::of(&state.motion, &peaks);
            wrong += usize::from(Shaken::from(*found).outcome() != outcome);
            if outcome == Outcome::Safe {
                let HybridSystem { slenderness, speed, .. } = some[index].system;
                worst = worst.max((found.peaks.rotation - peaks.rotation).abs() / slenderness);
                worst = worst.max((found.peaks.acceleration - peaks.acceleration).abs() * slenderness / (speed * speed));
            }
        }
    }
    let [lanes, baseline, core] = seconds.map(|seconds| blocks.len() as f64 / seconds);
    let [located, by_core] = [steps[1], steps[2]].map(|part| 100.0 * part / steps.iter().sum::<f64>());
    println!(
        "{:8} {:34} {lanes:>8.0} {core:>10.0} {:>6.1} {baseline:>8.0} {located:>7.1} %, {by_core:.1} % {left:>5} of {} {worst:>18.1e}, {wrong} outcomes differ",
        format!("{geometry:?}"),
        format!("{}, {under}", case.name()),
        lanes / core,
        blocks.len(),
    );
}

/// The lanes, and the free time after records.
fn to_the_end(blocks: &[HybridBlock<'_>], registers: Registers) -> Vec<Option<HybridMotion>> {
    let whole = |(block, found): (&HybridBlock<'_>, Option<HybridMotion>)| match block.ground {
        Ground::Record(_) => found?.after(block, FREE_TIME).ok(),
        Ground::Pieces(_) => found,
    };
    blocks.iter().zip(shake_hybrid(blocks, registers)).map(whole).collect()
}

/// Clutches on coasting flywheels that lose some speed, slow to engage and to release; the plates of those with a capacity slip above 0.3 of the
/// block's weight.
fn drivetrain(case: Case) -> Drivetrain {
    Drivetrain {
        engagement: match case {
            Case::Rigid | Case::Vertical => Engagement::Rigid,
            Case::Capacity => Engagement::Friction { capacity_ratio: 0.3 },
        },
        flywheel: FlywheelLosses { viscous_rate: 0.2, dry_deceleration: 0.05, brake_deceleration: 0.0, drag_rate: 0.0 },
        actuation: Actuation { engagement_delay: 0.02, release_delay: 0.01, ..Actuation::default() },
        ..Drivetrain::default()
    }
}

fn structure(geometry: Geometry, block: Block) -> Structure {
    Structure {
        geometry,
        device: Device {
            kind: DeviceKind::ClutchedPair,
            mass_ratio: 0.5,
            kinematics: KinematicsKind::Consistent,
            ..Device::NONE
        },
        ..Structure::new(block, Restitution::Constant(0.85))
    }
}

fn systems(case: Case, structures: &[Structure]) -> Vec<HybridSystem<f64>> {
    structures.iter().filter_map(|one| drivetrain(case).resolve(one, case.lifts()).ok()).collect()
}

/// One run by the core.
fn alone(
    structure: &Structure,
    system: &HybridSystem<f64>,
    [level, vertical]: &[GroundMotion; 2],
    case: Case,
    method: &dyn HybridLoop<f64>,
) -> (HybridState<f64>, Peaks<f64>) {
    let vertical = Some(vertical).filter(|_| case.lifts());
    let course = Course { vertical, ..Course::of(structure, level, FREE_TIME, Overturning::Reached) };
    let (mut state, mut peaks) = (system.at_rest(), Peaks::default());
    let _ = course.follow_machine(system, method, &mut state, &mut peaks, || true);
    (state, peaks)
}
