//! What holds for every motion, over the whole parameter space.

use core::f64::consts::TAU;

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use sprag_shared::math::pow;
use sprag_shared::motion::observer::Event;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::mount::Mount;
use sprag_stability::{Energy, GEOMETRIES, Log, Precision, Segment, Start, Stepping, Tally, unit_block};

/// The same 128 cases on every machine.
fn config() -> Config {
    Config { cases: 128, rng_seed: RngSeed::Fixed(1963), failure_persistence: None, max_shrink_iters: 50, ..Config::default() }
}

/// From `low` to `high`, each power of ten as likely.
fn powers(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (0.0..1.0).prop_map(move |share| low * pow(high / low, share))
}

/// Any block with any device at its centre of mass.
fn structures() -> impl Strategy<Value = Structure> {
    (
        prop::sample::select(&GEOMETRIES),
        prop::sample::select(&DeviceKind::ALL),
        prop::sample::select(&[KinematicsKind::Paper, KinematicsKind::Consistent]),
        prop_oneof![Just(Mount::CentreOfMass), (0.5..4.0).prop_map(|pulley_ratio| Mount::BaseCorners { pulley_ratio })],
        (powers(1e-4, 1.047), powers(0.01, 100.0), powers(1e-3, 1e3), 0.0..1.0),
    )
        .prop_map(|(geometry, kind, kinematics, mount, (slenderness, size, mass_ratio, restitution))| {
            let mut structure = unit_block(geometry, 10.0, kind, mass_ratio, restitution);
            structure.block = Block::new(size, slenderness, RECTANGLE_INERTIA_RATIO).expect("within range");
            (structure.device.kinematics, structure.device.mount) = (kinematics, mount);
            structure
        })
}

/// A ground motion: amplitude in thresholds, ω/p, and samples of a record in thresholds.
type Motion = (f64, f64, Vec<f64>);

fn motions() -> impl Strategy<Value = Motion> {
    (powers(0.5, 300.0), powers(0.05, 50.0), prop::collection::vec(-3.0..3.0, 0..10))
}

/// One cycle of a sine, the record at 0.11/p, and 5/p of quiet, with times multiplied by `slower`.
fn segments<S: Precision>(structure: &Structure, (amplitude, frequency, samples): &Motion, slower: f64) -> Vec<Segment<S>> {
    let p = structure.block.frequency_parameter();
    let uplift = structure.geometry.uplift_threshold(structure.block.slenderness());
    let (level, time) = (|ratio: f64| S::of(ratio * uplift), |units: f64| S::of(units / p) * S::of(slower));
    let lines = samples.windows(2).map(|pair| Segment::line(level(pair[0]), level(pair[1]), time(0.11)));
    let omega = S::of(frequency * p) / S::of(slower);
    [Segment::sine(level(*amplitude), omega, time(TAU / frequency))]
        .into_iter()
        .chain(lines)
        .chain([Segment::quiet(time(5.0))])
        .collect()
}

/// Every method, with fixed steps in 1/p.
fn steppings<S: Precision>(structure: &Structure, slower: f64) -> [Stepping<S>; 4] {
    let step = |units: f64| S::of(units / structure.block.frequency_parameter()) * S::of(slower);
    [Stepping::Tight, Stepping::RungeKutta4(step(0.03)), Stepping::SemiImplicitEuler(step(0.01)), Stepping::Taylor(step(0.06))]
}

fn recorded<S: Precision>(structure: &Structure, stepping: Stepping<S>, segments: &[Segment<S>]) -> Log<S, true> {
    let mut log = Log::sampling(2);
    S::record(structure, stepping, Start::Rest, segments, &mut log).unwrap_or_else(|stopped| panic!("{stopped}: {structure:?}"));
    log
}

/// As numbers: −0 and 0 are one, and so is what rounding leaves of θ at an impact if its square is denormal: products of it are not
/// exact multiples any more.
fn bits<S: Precision>(x: S) -> u64 {
    if x * x < S::SMALLEST { 0 } else { x.bits() }
}

/// Two motions are one, with the second's rotations, times and velocities multiplied by these; to the bit.
fn same<S: Precision>(first: &Log<S, true>, second: &Log<S, true>, rotation: S, time: S) -> Result<(), TestCaseError> {
    let events = |log: &Log<S, true>| log.events.iter().map(|logged| logged.event).collect::<Vec<_>>();
    prop_assert_eq!(events(first), events(second));
    let velocity = rotation / time;
    for (a, b) in first.events.iter().zip(&second.events) {
        prop_assert_eq!(bits(a.time * time), bits(b.time));
        prop_assert_eq!(bits(a.state.rotation * rotation), bits(b.state.rotation));
        prop_assert_eq!(bits(a.state.velocity * velocity), bits(b.state.velocity));
        prop_assert_eq!(a.state.impacts, b.state.impacts);
        prop_assert_eq!(a.state.side, if rotation < S::ZERO { b.state.side.opposite() } else { b.state.side });
    }
    prop_assert_eq!(first.stretches.len(), second.stretches.len());
    for (a, b) in first.stretches.iter().zip(&second.stretches) {
        prop_assert_eq!(a.engaged, b.engaged);
        for (x, y) in a.motions.iter().zip(&b.motions) {
            prop_assert_eq!(bits(x.rotation * rotation), bits(y.rotation));
            prop_assert_eq!(bits(x.velocity * velocity), bits(y.velocity));
            prop_assert_eq!(bits(x.acceleration * velocity / time), bits(y.acceleration));
        }
    }
    Ok(())
}

/// With the device at its own mount, and tied to another point.
fn mirrored<S: Precision>(structure: &Structure, motion: &Motion) -> Result<(), TestCaseError> {
    let segments = segments::<S>(structure, motion, 1.0);
    let other: Vec<_> = segments.iter().map(|segment| segment.mirrored()).collect();
    for mount in [structure.device.mount, Mount::TyingPoint { height: 1.3 * structure.block.size(), pulley_ratio: 0.7 }] {
        let structure = Structure { device: Device { mount, ..structure.device }, ..*structure };
        for stepping in steppings(&structure, 1.0) {
            let (here, there) = (recorded(&structure, stepping, &segments), recorded(&structure, stepping, &other));
            same(&here, &there, -S::ONE, S::ONE)?;
            prop_assert_eq!(here.peaks.rotation.bits(), there.peaks.rotation.bits());
            prop_assert_eq!(here.peaks.acceleration.bits(), there.peaks.acceleration.bits());
        }
    }
    Ok(())
}

/// R times 4 is p over 2: with fixed steps everything is the same to the bit, at half the pace.
fn slower<S: Precision>(structure: &Structure, motion: &Motion) -> Result<(), TestCaseError> {
    let block = Block::new(4.0 * structure.block.size(), structure.block.slenderness(), RECTANGLE_INERTIA_RATIO);
    let larger = Structure { block: block.expect("within range"), ..*structure };
    let fast = segments::<S>(structure, motion, 1.0);
    let slow = segments::<S>(structure, motion, 2.0);
    for (one, two) in steppings(structure, 1.0).into_iter().zip(steppings(structure, 2.0)).skip(1) {
        same(&recorded(structure, one, &fast), &recorded(&larger, two, &slow), S::ONE, S::of(2.0))?;
    }
    Ok(())
}

/// The slender model knows no size of a rotation: α times 2 and the ground times 2 is θ times 2, to the bit with fixed steps.
fn wider<S: Precision>(structure: &Structure, motion: &Motion) -> Result<(), TestCaseError> {
    let slender = Structure {
        geometry: Geometry::Slender,
        device: Device { mount: Mount::CentreOfMass, ..structure.device },
        ..*structure
    };
    let block = Block::new(slender.block.size(), 0.5 * slender.block.slenderness(), RECTANGLE_INERTIA_RATIO);
    let narrow = Structure { block: block.expect("within range"), ..slender };
    let (wide, small) = (segments::<S>(&slender, motion, 1.0), segments::<S>(&narrow, motion, 1.0));
    for stepping in steppings(structure, 1.0).into_iter().skip(1) {
        same(&recorded(&narrow, stepping, &small), &recorded(&slender, stepping, &wide), S::of(2.0), S::ONE)?;
    }
    Ok(())
}

/// Finite, in order, above the floor, no event twice, and no more work than the motion has events.
fn orderly<S: Precision>(structure: &Structure, motion: &Motion) -> Result<(), TestCaseError> {
    let segments = segments::<S>(structure, motion, 1.0);
    for stepping in steppings(structure, 1.0) {
        // Euler steps locate an impact less exactly than to ulps.
        let floor = if matches!(stepping, Stepping::SemiImplicitEuler(_)) { 1e-4 / S::EPSILON.to_f64() } else { 64.0 };
        let mut tally = Tally::new();
        tally.floor = floor;
        let run = S::tally(structure, stepping, Start::Rest, &segments, tally);
        run.tally.assert_sane(60_000, 20_000);
        prop_assert!(run.tally.rebound <= structure.restitution().expect("within range") + 4.0 * S::EPSILON.to_f64());
        let end = run.end();
        prop_assert!(end.side.times(end.rotation) >= S::ZERO && end.rotation.is_finite());
        let [uplifts, _, _, _, _, rests, overturned, _] = run.tally.events;
        prop_assert!(overturned <= 1 && rests <= uplifts && uplifts <= rests + 1, "{:?}", run.tally);
    }
    Ok(())
}

/// Released on quiet ground.
fn losing<S: Precision>(structure: &Structure, tilt: f64) -> Result<(), TestCaseError> {
    let mut structure = *structure;
    structure.device.mount = Mount::CentreOfMass;
    let start = Start::Released(S::of(tilt * structure.block.slenderness()), S::ZERO);
    let segments = [Segment::quiet(S::of(20.0 / structure.block.frequency_parameter()))];
    let run = S::tally(&structure, Stepping::Tight, start, &segments, Tally::with_energy(Energy::of(&structure)));
    run.tally.assert_sane(20_000, 20_000);
    if Energy::is_conserved(&structure) {
        run.tally.assert_no_energy_gained(S::tolerance(1e-13, 3e-5));
    }
    prop_assert!(run.tally.turn.1 <= S::tolerance(1e-11, 1e-3), "{:?}", run.tally);
    prop_assert!(run.tally.count(Event::Overturned) == 0);
    Ok(())
}

/// A pulse in one call, and in two that are split at one of its events.
fn split<S: Precision>(structure: &Structure, motion: &Motion, share: f64) -> Result<(), TestCaseError> {
    let whole = segments::<S>(structure, motion, 1.0);
    let log = recorded(structure, Stepping::Tight, &whole[..1]);
    // Well-conditioned motions: what grows fast grows from any rounding.
    let early: Vec<_> = log.events.iter().take(4).collect();
    prop_assume!(!early.is_empty());
    let at = early[((share * early.len() as f64) as usize).min(early.len() - 1)].time;
    let p = structure.block.frequency_parameter();
    let omega = S::of(motion.1 * p);
    let level = S::of(motion.0 * structure.geometry.uplift_threshold(structure.block.slenderness()));
    prop_assume!(at > S::ZERO && at < whole[0].duration);
    let parts = [Segment::sine(level, omega, at), Segment::sine_from(level, omega, omega * at, whole[0].duration - at)];
    let cut = recorded(structure, Stepping::Tight, &parts);
    let until = |log: &Log<S, true>| {
        let mut events = Vec::new();
        for logged in log.events.iter().take_while(|logged| logged.time <= at * S::of(1.0 + 1e-4)) {
            // Where rounding leaves the sign of the terminals' acceleration open, the clutch may switch there and back at the cut.
            if logged.event == Event::Switch && events.last() == Some(&Event::Switch) {
                events.pop();
            } else {
                events.push(logged.event);
            }
        }
        events
    };
    prop_assert_eq!(until(&log), until(&cut), "{} split at {:?}", S::NAME, at);
    let off = (log.peaks.rotation - cut.peaks.rotation).abs() / log.peaks.rotation.larger(S::of(structure.block.slenderness()));
    let bounded = log.events.iter().all(|logged| logged.event != Event::Impact);
    prop_assert!(!bounded || off.to_f64() < S::tolerance(1e-9, 1e-2), "{}: peaks differ by {:?}", S::NAME, off);
    Ok(())
}

macro_rules! properties {
    ($module:ident, $number:ty) => {
        mod $module {
            use super::*;

            proptest! {
                #![proptest_config(config())]

                #[test]
                fn mirrored_ground_gives_the_mirrored_motion(structure in structures(), motion in motions()) {
                    mirrored::<$number>(&structure, &motion)?;
                }

                #[test]
                fn a_block_four_times_as_large_is_half_as_fast(structure in structures(), motion in motions()) {
                    slower::<$number>(&structure, &motion)?;
                }

                #[test]
                fn the_slender_model_has_no_size(structure in structures(), motion in motions()) {
                    wider::<$number>(&structure, &motion)?;
                }

                #[test]
                fn every_motion_is_in_order(structure in structures(), motion in motions()) {
                    orderly::<$number>(&structure, &motion)?;
                }

                #[test]
                fn quiet_ground_gives_no_energy(structure in structures(), tilt in 1e-6..0.999) {
                    losing::<$number>(&structure, tilt)?;
                }

                #[test]
                fn a_motion_in_two_parts_is_the_motion(structure in structures(), motion in motions(), share in 0.0..1.0) {
                    split::<$number>(&structure, &motion, share)?;
                }
            }
        }
    };
}

properties!(double, f64);
properties!(single, f32);

/// Not a device at all, σ = 0 and a clutched pair of it move alike: three programs, one motion.
#[test]
fn a_device_of_no_mass_is_none() {
    for geometry in GEOMETRIES {
        let motion = (2.5, 4.0, vec![0.4, -2.0, 1.7]);
        let alone = unit_block(geometry, 12.0, DeviceKind::None, 0.0, 0.85);
        let reference = recorded::<f64>(&alone, Stepping::Tight, &segments(&alone, &motion, 1.0));
        for device in [DeviceKind::Inerter, DeviceKind::ClutchedPair] {
            let with = unit_block(geometry, 12.0, device, 0.0, 0.85);
            let log = recorded::<f64>(&with, Stepping::Tight, &segments(&with, &motion, 1.0));
            assert!((log.peaks.rotation - reference.peaks.rotation).abs() < 1e-13);
            assert_eq!(log.times(Event::Impact).len(), reference.times(Event::Impact).len());
        }
    }
}
