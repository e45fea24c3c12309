//! How fast studies over records are: blocks in lanes against the same blocks one at a time.
//!
//! `cargo bench --bench records` runs 100 structures with three devices under 200 motions of 40 s at 5 ms (noise in an envelope with a
//! pulse in it, peaks of 0.2 to 1 g; those that overturn end there) on one core, and prints record-runs a second for each device, those
//! of the core, which takes every hundredth, and how far their peaks are apart.

use std::hint::black_box;
use std::time::Instant;

use sprag_ensemble::machine::{Registers, shake};
use sprag_ensemble::plain::PlainBlock;
use sprag_ensemble::shaken::{Samples, Shaken, ShakenBlock};
use sprag_loops::{Method, Precision};
use sprag_shared::motion::state::{BlockState, Phase};
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{Device, DeviceKind};
use sprag_shared::structure::{Restitution, Structure};
use sprag_sim::batch::case::TIGHT;
use sprag_sim::ground_motion::{Component, GroundMotion};
use sprag_sim::simulation::drive::{Course, Overturning};

mod shakings;

use shakings::{MOTIONS, SECONDS, STEP, STRUCTURES, block, motion};

const FREE_TIME: f64 = 10.0;
/// The core takes one run of so many.
const SPARSE: usize = 100;

fn main() {
    let motions: Vec<Samples> = (0..MOTIONS).map(|seed| Samples::new(STEP, motion(seed))).collect();
    println!("record-runs a second on one core: {MOTIONS} motions of {SECONDS} s at {STEP} s, {STRUCTURES} structures");
    println!(
        "{:8} {:14} {:>14} {:>10} {:>8} {:>12} {:>18}",
        "geometry", "device", "lanes", "core", "ratio", "left to core", "peaks apart, worst"
    );
    for geometry in [Geometry::Full, Geometry::Slender] {
        let (mut runs, mut seconds) = (0, 0.0);
        for device in DeviceKind::ALL {
            let structures: Vec<Structure> = (0..STRUCTURES).filter_map(|index| structure(geometry, device, index)).collect();
            let asked: Vec<ShakenBlock<'_>> =
                structures.iter().flat_map(|one| motions.iter().filter_map(|samples| shaken(one, samples))).collect();
            let start = Instant::now();
            let found = black_box(after(&asked, &structures, motions.len()));
            let in_lanes = start.elapsed().as_secs_f64();
            (runs, seconds) = (runs + asked.len(), seconds + in_lanes);
            let left = found.iter().filter(|found| found.is_none()).count();
            let start = Instant::now();
            let mut worst = 0.0_f64;
            let mut wrong = 0;
            let sparse: Vec<usize> = (0..asked.len()).step_by(SPARSE).collect();
            for &index in &sparse {
                let one = &structures[index / motions.len()];
                let record = Component::record(0.0, STEP, asked[index].samples.values().iter().copied());
                let ground = GroundMotion::sum(&[record]);
                let (state, peaks) = alone(one, &ground);
                let Some(found) = found[index] else { continue };
                wrong += usize::from(found.phase != state.phase);
                if state.phase == Phase::Overturned || peaks.rotation == 0.0 {
                    continue;
                }
                for (ours, theirs) in [(found.peaks.rotation, peaks.rotation), (found.peaks.acceleration, peaks.acceleration)] {
                    worst = worst.max((ours / theirs - 1.0).abs());
                }
            }
            let alone = sparse.len() as f64 / start.elapsed().as_secs_f64();
            let lanes = asked.len() as f64 / in_lanes;
            let ratio = lanes / alone;
            let of = asked.len();
            println!(
                "{geometry:8} {device:14} {lanes:>14.0} {alone:>10.0} {ratio:>8.1} {left:>5} of {of} {worst:>18.1e}, {wrong} phases differ",
                geometry = format!("{geometry:?}"),
                device = format!("{device:?}"),
            );
        }
        println!("{:8} {:14} {:>14.0}", format!("{geometry:?}"), "all", runs as f64 / seconds);
    }
}

/// The lanes, and the free time after the records.
fn after(asked: &[ShakenBlock<'_>], structures: &[Structure], motions: usize) -> Vec<Option<Shaken>> {
    let found = shake(asked, Registers::Widest);
    let whole = |(index, found): (usize, Option<Shaken>)| {
        found?.after(&asked[index].plain, &structures[index / motions], asked[index].samples.duration(), FREE_TIME).ok()
    };
    found.into_iter().enumerate().map(whole).collect()
}

fn structure(geometry: Geometry, kind: DeviceKind, index: u32) -> Option<Structure> {
    Some(Structure {
        geometry,
        device: Device { kind, mass_ratio: 0.5, ..Device::NONE },
        ..Structure::new(block(index)?, Restitution::Constant(0.85))
    })
}

fn shaken<'a>(structure: &Structure, samples: &'a Samples) -> Option<ShakenBlock<'a>> {
    let plain = PlainBlock::of_structure(structure)?;
    Some(ShakenBlock { plain, frequency_parameter: structure.block.frequency_parameter(), samples, factor: 1.0 })
}

/// By the core, alone.
fn alone(structure: &Structure, ground: &GroundMotion) -> (BlockState<f64>, Peaks<f64>) {
    let course = Course::of(structure, ground, FREE_TIME, Overturning::Reached);
    let (mut state, mut peaks) = (BlockState::default(), Peaks::default());
    let _ = course.follow(&structure.resolve().unwrap(), &*f64::ideal(Method::Adaptive(TIGHT)), &mut state, &mut peaks, || true);
    (state, peaks)
}
