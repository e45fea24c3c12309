//! How fast studies over records are where devices are real: rigid clutches with coasting flywheels, losses and delays.
//!
//! `cargo bench --bench real_devices` takes 100 structures under 200 motions of 40 s at 5 ms ([`shakings`]; those that overturn end there)
//! on one core, and prints record-runs a second in lanes, those of the core, which takes every hundredth one by one, those of registers that
//! every machine has, the shares of steps in which the core located an event, and that it took alone, and how far peaks are apart (θ/α, θ̈/(p²α)).

use std::time::Instant;

use sprag_ensemble::hybrid::{HybridBlock, HybridMotion, Steps};
use sprag_ensemble::machine::{Registers, shake_hybrid};
use sprag_ensemble::shaken::{Samples, Shaken};
use sprag_loops::{HybridLoop, Method, hybrid};
use sprag_shared::motion::hybrid::{HybridState, HybridSystem};
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Actuation, Drivetrain, Engagement, FlywheelLosses};
use sprag_shared::structure::{Restitution, Structure};
use sprag_sim::batch::case::TIGHT;
use sprag_sim::ground_motion::{Component, GroundMotion};
use sprag_sim::simulation::drive::{Course, Overturning};

mod shakings;

use shakings::{MOTIONS, SECONDS, STEP, STRUCTURES, block, motion};

const FREE_TIME: f64 = 10.0;
/// A vertical motion is half as strong as the horizontal one of its number.
const UP: f64 = 0.5;
/// One run of so many goes one by one.
const SPARSE: usize = 100;

fn main() {
    let motions: Vec<Samples> = (0..MOTIONS).map(|seed| Samples::new(STEP, motion(seed))).collect();
    println!("record-runs a second on one core: {MOTIONS} motions of {SECONDS} s at {STEP} s, {STRUCTURES} structures");
    println!(
        "{:8} {:22} {:>8} {:>10} {:>6} {:>8} {:>16} {:>14} {:>18}",
        "geometry", "case", "lanes", "one by one", "ratio", "baseline", "events, by core", "runs to core", "peaks apart, worst"
    );
    for geometry in [Geometry::Full, Geometry::Slender] {
        for case in [Case::Rigid, Case::Vertical, Case::Capacity] {
            compare(geometry, case, &motions);
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
    fn name(self) -> &'static str {
        match self {
            Case::Rigid => "rigid, level",
            Case::Vertical => "rigid, vertical too",
            Case::Capacity => "with capacity, level",
        }
    }
}

/// Prints a line of one geometry and case.
fn compare(geometry: Geometry, case: Case, motions: &[Samples]) {
    let vertical = case == Case::Vertical;
    let structures: Vec<Structure> = (0..STRUCTURES).filter_map(|index| structure(geometry, index)).collect();
    let systems: Vec<HybridSystem<f64>> =
        structures.iter().filter_map(|one| drivetrain(case).resolve(one, vertical).ok()).collect();
    let block = |index: usize| HybridBlock {
        system: &systems[index / motions.len()],
        overturned_at_slenderness: false,
        samples: &motions[index % motions.len()],
        factor: 1.0,
        vertical: vertical.then(|| (&motions[(index + 1) % motions.len()], UP)),
        checks: None,
    };
    let blocks: Vec<HybridBlock<'_>> = (0..systems.len() * motions.len()).map(block).collect();
    let method = hybrid(Method::Adaptive(TIGHT));
    let (mut worst, mut wrong, mut left, mut seconds) = (0.0_f64, 0, 0, [0.0; 3]);
    let mut steps = [0.0; 3];
    let few = |some: &[HybridBlock<'_>]| -> Vec<usize> { (0..some.len()).step_by(SPARSE).collect() };
    // In turns, so that whatever else the machine does slows down both.
    for (part, some) in blocks.chunks(motions.len() * 10).enumerate() {
        let start = Instant::now();
        let found = after(some, Registers::Widest);
        seconds[0] += start.elapsed().as_secs_f64();
        let tenth: Vec<HybridBlock<'_>> = some.iter().step_by(10).copied().collect();
        let start = Instant::now();
        let _ = after(&tenth, Registers::Baseline);
        seconds[1] += 10.0 * start.elapsed().as_secs_f64();
        let start = Instant::now();
        let one_by_one = |index: &usize| alone(&structures[part * 10 + index / motions.len()], &some[*index], &*method);
        let cores: Vec<(HybridState<f64>, Peaks<f64>)> = few(some).iter().map(one_by_one).collect();
        seconds[2] += SPARSE as f64 * start.elapsed().as_secs_f64();
        left += found.iter().filter(|found| found.is_none()).count();
        for Steps { plain, located, by_core } in found.iter().flatten().map(|found| found.steps) {
            steps = [steps[0] + f64::from(plain), steps[1] + f64::from(located), steps[2] + f64::from(by_core)];
        }
        for (index, (state, peaks)) in few(some).into_iter().zip(cores) {
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
        "{:8} {:22} {lanes:>8.0} {core:>10.0} {:>6.1} {baseline:>8.0} {located:>7.1} %, {by_core:.1} % {left:>5} of {} {worst:>18.1e}, {wrong} outcomes differ",
        format!("{geometry:?}"),
        case.name(),
        lanes / core,
        blocks.len(),
    );
}

/// The lanes, and the free time after the records.
fn after(blocks: &[HybridBlock<'_>], registers: Registers) -> Vec<Option<HybridMotion>> {
    let whole = |(block, found): (&HybridBlock<'_>, Option<HybridMotion>)| found?.after(block, FREE_TIME).ok();
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

fn structure(geometry: Geometry, index: u32) -> Option<Structure> {
    Some(Structure {
        geometry,
        device: Device {
            kind: DeviceKind::ClutchedPair,
            mass_ratio: 0.5,
            kinematics: KinematicsKind::Consistent,
            ..Device::NONE
        },
        ..Structure::new(block(index)?, Restitution::Constant(0.85))
    })
}

/// One run by the core.
fn alone(structure: &Structure, block: &HybridBlock<'_>, method: &dyn HybridLoop<f64>) -> (HybridState<f64>, Peaks<f64>) {
    let component = |samples: Option<&Samples>, factor: f64| {
        let values = samples.map(Samples::values).unwrap_or_default();
        [Component::record(0.0, STEP, values.iter().map(|value| factor * value))]
    };
    let up = block.vertical.map(|(up, _)| up);
    let [level, vertical] = GroundMotion::aligned(&component(Some(block.samples), 1.0), &component(up, UP));
    let vertical = up.map(|_| &vertical);
    let course = Course { vertical, ..Course::of(structure, &level, FREE_TIME, Overturning::Reached) };
    let (mut state, mut peaks) = (block.system.at_rest(), Peaks::default());
    let _ = course.follow_machine(block.system, method, &mut state, &mut peaks, || true);
    (state, peaks)
}
