//! Blocks under records in lanes against the core, which follows one at a time.

use sprag_ensemble::machine::{Registers, shake};
use sprag_ensemble::plain::PlainBlock;
use sprag_ensemble::shaken::{Samples, Shaken, ShakenBlock};
use sprag_loops::{Method, Precision};
use sprag_shared::math;
use sprag_shared::motion::state::{BlockState, Phase};
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind};
use sprag_shared::structure::{Restitution, Structure};
use sprag_sim::batch::case::TIGHT;
use sprag_sim::ground_motion::{Component, GroundMotion};
use sprag_sim::simulation::drive::{Course, Overturning};

use super::lanes_under_pulses::have_the_same_bits;

const STEP: f64 = 0.01;
const FREE_TIME: f64 = 6.0;

/// A motion of `seconds`, every `step`, with a pulse in it and noise on it (in g), strong in the middle.
pub(super) fn motion(seed: u64, seconds: f64, step: f64) -> Vec<f64> {
    let mut state = seed;
    let mut noise = 0.0;
    let length = (seconds / step) as usize;
    let value = |index: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        noise = 0.7 * noise + 0.3 * ((state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0);
        let time = index as f64 * step;
        let from_middle = time / seconds - 0.5;
        let envelope = math::exp(-12.0 * from_middle * from_middle);
        envelope * (0.45 * math::sin(2.0 * time + seed as f64) + 0.25 * math::sin(7.3 * time) + 0.5 * noise)
    };
    (0..length).map(value).collect()
}

fn structure(geometry: Geometry, kind: DeviceKind, (size, slenderness, restitution): (f64, f64, f64)) -> Structure {
    Structure {
        geometry,
        device: Device { kind, mass_ratio: 0.5, ..Device::NONE },
        ..Structure::new(Block::new(size, slenderness, RECTANGLE_INERTIA_RATIO).unwrap(), Restitution::Constant(restitution))
    }
}

fn shaken<'a>(structure: &Structure, samples: &'a Samples, factor: f64) -> ShakenBlock<'a> {
    let plain = PlainBlock::of_structure(structure).expect("a plain block");
    ShakenBlock { plain, frequency_parameter: structure.block.frequency_parameter(), samples, factor }
}

/// By the core, alone.
fn alone(structure: &Structure, ground: &GroundMotion) -> (BlockState<f64>, Peaks<f64>) {
    let course = Course::of(structure, ground, FREE_TIME, Overturning::Reached);
    let (mut state, mut peaks) = (BlockState::default(), Peaks::default());
    course.follow(&structure.resolve().unwrap(), &*f64::ideal(Method::Adaptive(TIGHT)), &mut state, &mut peaks, || true).unwrap();
    (state, peaks)
}

/// Structures of all kinds under scaled motions.
fn structures(geometry: Geometry, device: DeviceKind) -> Vec<Structure> {
    let kinds = [(1.0, 0.15, 0.85), (2.0, 0.25, 0.7), (5.0, 0.17, 0.95), (0.4, 0.3, 0.5), (3.0, 0.1, 0.0)];
    kinds.into_iter().map(|kind| structure(geometry, device, kind)).collect()
}

#[test]
fn blocks_under_records_do_what_they_do_alone() {
    let motions: Vec<Samples> = (1..7).map(|seed| Samples::new(STEP, motion(seed, 12.0, STEP))).collect();
    for geometry in [Geometry::Full, Geometry::Slender] {
        for device in DeviceKind::ALL {
            let mut seen = [0; 3];
            let mut left = 0;
            let mut all = 0;
            for structure in structures(geometry, device) {
                let blocks: Vec<(&Samples, f64)> =
                    motions.iter().flat_map(|samples| [0.25, 0.5, 0.8, -1.2, 2.0].map(|factor| (samples, factor))).collect();
                let asked: Vec<ShakenBlock<'_>> =
                    blocks.iter().map(|(samples, factor)| shaken(&structure, samples, *factor)).collect();
                for ((samples, factor), found) in blocks.into_iter().zip(shake(&asked, Registers::Widest)) {
                    all += 1;
                    let Some(found) = found else {
                        left += 1;
                        continue;
                    };
                    let found = found
                        .after(&PlainBlock::of_structure(&structure).unwrap(), &structure, samples.duration(), FREE_TIME)
                        .unwrap();
                    let record = Component::record(0.0, STEP, samples.values().iter().map(|value| factor * value));
                    let ground = GroundMotion::sum(&[record]);
                    let (state, peaks) = alone(&structure, &ground);
                    let case = format!("{structure:?} times {factor}: {found:?} {state:?} {peaks:?}");
                    seen[found.phase as usize] += 1;
                    assert_eq!((found.phase, found.impacts), (state.phase, state.impacts), "{case}");
                    assert_eq!(found.peaks.rocked, peaks.rocked, "{case}");
                    let times = [(found.peaks.first_impact, peaks.first_impact), (found.peaks.ended, peaks.ended)];
                    for (ours, theirs) in times {
                        assert_eq!(ours.is_some(), theirs.is_some(), "{case}");
                        let apart = ours.zip(theirs).map_or(0.0, |(ours, theirs)| (ours - theirs).abs());
                        assert!(apart < 1e-7, "{case}");
                    }
                    if found.phase != Phase::Overturned {
                        let pairs = [(found.peaks.rotation, peaks.rotation), (found.peaks.acceleration, peaks.acceleration)];
                        for (ours, theirs) in pairs {
                            assert!((ours - theirs).abs() <= 1e-9 * theirs, "{case}");
                        }
                    }
                }
            }
            assert!(left * 50 <= all, "{left} of {all} are left to the core");
            assert!(seen[Phase::Rest as usize] > 10 && seen[Phase::Overturned as usize] > 5, "{geometry:?} {device:?}: {seen:?}");
        }
    }
}

#[test]
fn bits_depend_neither_on_registers_nor_on_neighbours() {
    let motions: Vec<Samples> = (1..4).map(|seed| Samples::new(STEP, motion(seed, 8.0, STEP))).collect();
    for geometry in [Geometry::Full, Geometry::Slender] {
        let mut asked = Vec::new();
        for structure in DeviceKind::ALL.iter().flat_map(|device| structures(geometry, *device)) {
            asked.extend(motions.iter().flat_map(|samples| [0.6, 1.0].map(|factor| shaken(&structure, samples, factor))));
        }
        have_the_same_bits(asked, |asked: &[ShakenBlock<'_>], registers| -> Vec<Option<(Phase, [u64; 4], u32)>> {
            let of = |shaken: &Shaken| {
                let Shaken { phase, rotation, velocity, impacts, peaks } = shaken;
                (*phase, [*rotation, *velocity, peaks.rotation, peaks.acceleration].map(f64::to_bits), *impacts)
            };
            shake(asked, registers).iter().map(|found| found.as_ref().map(of)).collect()
        });
    }
}

/// A turned record gives the mirrored motion, to the last bit.
#[test]
fn a_record_turned_about_gives_the_mirrored_motion() {
    let samples = Samples::new(STEP, motion(3, 10.0, STEP));
    for structure in DeviceKind::ALL.iter().flat_map(|device| structures(Geometry::Full, *device)) {
        let [one, other] = [0.7, -0.7].map(|factor| shake(&[shaken(&structure, &samples, factor)], Registers::Widest)[0]);
        let (one, other) = (one.unwrap(), other.unwrap());
        assert_eq!((one.rotation, one.velocity, one.peaks), (-other.rotation, -other.velocity, other.peaks));
    }
}

/// Records that lanes have no business with are left to the core.
#[test]
fn what_is_not_plain_is_left_to_the_core() {
    let structure = structure(Geometry::Full, DeviceKind::None, (1.0, 0.15, 0.85));
    for values in [vec![], vec![0.3], vec![0.0, 1e6, 0.0]] {
        let samples = Samples::new(STEP, values);
        assert_eq!(shake(&[shaken(&structure, &samples, 1.0)], Registers::Widest), [None]);
    }
}
