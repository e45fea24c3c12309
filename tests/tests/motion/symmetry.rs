//! Symmetries of the equations, which hold to rounding.

use core::f64::consts::TAU;

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use sprag_shared::math::cos;
use sprag_shared::motion::observer::Event;
use sprag_shared::motion::state::Phase;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_shared::structure::mount::Mount;
use sprag_tests::{FullLog, GEOMETRIES, Segment, relative, release, resized, shake, unit_block};

/// The same 64 cases on every machine.
fn config() -> Config {
    Config { cases: 64, rng_seed: RngSeed::Fixed(1963), failure_persistence: None, max_shrink_iters: 50, ..Config::default() }
}

fn mounts() -> impl Strategy<Value = Mount> {
    prop_oneof![
        Just(Mount::CentreOfMass),
        (0.2..15.0, 0.5..4.0).prop_map(|(height, pulley_ratio)| Mount::TyingPoint { height, pulley_ratio }),
        (0.5..4.0).prop_map(|pulley_ratio| Mount::BaseCorners { pulley_ratio }),
    ]
}

/// Any structure, R = 7.35 m (p = 1/s).
fn structures() -> impl Strategy<Value = Structure> {
    (
        prop::sample::select(&GEOMETRIES),
        prop::sample::select(&DeviceKind::ALL),
        mounts(),
        prop::sample::select(&[KinematicsKind::Paper, KinematicsKind::Consistent]),
        (2.0..35.0, 0.0..2.0, 0.0..0.99),
    )
        .prop_map(|(geometry, kind, mount, kinematics, (degrees, mass_ratio, restitution))| {
            let mut structure = unit_block(geometry, degrees, kind, mass_ratio, restitution);
            structure.device.mount = mount;
            structure.device.kinematics = kinematics;
            structure
        })
}

/// What must not depend on the scale of a motion: peaks, first impacts, phase, number of impacts.
struct Shape {
    rotation: f64,
    acceleration: f64,
    impacts: Vec<f64>,
    phase: Phase,
}

/// Peaks in α and p²α, times in 1/p, under one cycle of a sine and 15/p after it.
fn shape(structure: &Structure, frequency: f64, amplitude: f64) -> Shape {
    let p = structure.block.frequency_parameter();
    let alpha = structure.block.slenderness();
    let level = amplitude * structure.geometry.uplift_threshold(structure.block.slenderness());
    let pulse = Segment::sine(level, frequency * p, TAU / (frequency * p));
    let (state, log) = shake(structure, &[pulse, Segment::quiet(15.0 / p)]);
    Shape {
        rotation: log.peaks.rotation / alpha,
        acceleration: log.peaks.acceleration / (p * p * alpha),
        impacts: log.times(Event::Impact).iter().take(5).map(|time| time * p).collect(),
        phase: state.phase,
    }
}

/// The largest relative difference of two shapes, or None where they differ in kind.
fn difference(a: &Shape, b: &Shape) -> Option<f64> {
    if a.phase != b.phase || a.impacts.len() != b.impacts.len() {
        return None;
    }
    let times = a.impacts.iter().zip(&b.impacts).map(|(a, b)| relative(*a, *b));
    Some(times.fold(relative(a.rotation, b.rotation).max(relative(a.acceleration, b.acceleration)), f64::max))
}

/// Two structures respond alike, up to rounding that grows with the motion's own sensitivity.
fn alike(a: &Structure, b: &Structure, frequency: f64, amplitude: f64) -> Result<(), TestCaseError> {
    let reference = shape(a, frequency, amplitude);
    // How much an error grows: well-conditioned motions only.
    let growth = difference(&reference, &shape(a, frequency, amplitude * (1.0 + 1e-9))).map_or(f64::INFINITY, |d| d / 1e-9);
    prop_assume!(growth < 300.0);
    let found = difference(&reference, &shape(b, frequency, amplitude));
    prop_assert!(found.is_some_and(|d| d < 1e-13 * growth.max(10.0)), "{:?} with a growth of {}", found, growth);
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    /// Slender: only ω/p, a_g/(gα), η and σ matter, not R and α.
    #[test]
    fn the_slender_response_depends_on_four_numbers(
        device in prop::sample::select(&DeviceKind::ALL),
        (mass_ratio, restitution) in (0.0..2.0, 0.3..0.99),
        (degrees, other_degrees) in (1.0..45.0, 1.0..45.0),
        size in 0.1..30.0,
        (frequency, amplitude) in (0.7..8.0, 1.05..6.0),
    ) {
        let block = |degrees| unit_block(Geometry::Slender, degrees, device, mass_ratio, restitution);
        alike(&block(degrees), &resized(block(other_degrees), size), frequency, amplitude)?;
    }

    /// Full: R sets the time scale 1/p and nothing else.
    #[test]
    fn time_scales_with_p(structure in structures(), size in 0.1..30.0, (frequency, amplitude) in (0.7..8.0, 1.05..6.0)) {
        let unit = structure.block.size();
        let mut other = resized(structure, size);
        if let Mount::TyingPoint { height, pulley_ratio } = structure.device.mount {
            other.device.mount = Mount::TyingPoint { height: height * size / unit, pulley_ratio };
        }
        alike(&structure, &other, frequency, amplitude)?;
    }

    /// Without ground motion no swing is larger than the one before it.
    #[test]
    fn free_swings_never_grow(structure in structures(), start in 0.01..0.99, other_side in any::<bool>()) {
        let rotation = start * structure.block.slenderness() * if other_side { -1.0 } else { 1.0 };
        let mut log = FullLog::default();
        release(&structure, rotation, 0.0, 20.0, &mut log);
        let mut largest = rotation.abs();
        let turns = log.states(Event::Turn);
        prop_assert!(structure.restitution() == Ok(0.0) || !turns.is_empty());
        for turn in turns {
            prop_assert!(turn.rotation.abs() <= largest * (1.0 + 1e-12), "{} after {}", turn.rotation, largest);
            largest = turn.rotation.abs();
        }
    }

    /// In the consistent kinematics the energy of block and engaged flywheel never grows, instant by instant.
    #[test]
    fn energy_never_grows(
        device in prop::sample::select(&DeviceKind::ALL),
        (degrees, mass_ratio, restitution) in (2.0..45.0, 0.0..3.0, 0.0..1.0),
        start in 0.01..0.99,
    ) {
        let mut structure = unit_block(Geometry::Full, degrees, device, mass_ratio, restitution);
        structure.device.kinematics = KinematicsKind::Consistent;
        let alpha = structure.block.slenderness();
        let coupling = if device == DeviceKind::None { 0.0 } else { 0.75 * mass_ratio };
        let mut log = FullLog::sampling(4);
        release(&structure, start * alpha, 0.0, 8.0, &mut log);
        let mut least = f64::INFINITY;
        for stretch in &log.stretches {
            let k = if stretch.engaged { coupling } else { 0.0 };
            for motion in &stretch.motions {
                let cosine = cos(alpha - stretch.side.times(motion.rotation));
                let energy = 0.5 * (1.0 + k * cosine * cosine) * motion.velocity * motion.velocity + cosine;
                prop_assert!(energy <= least + 1e-14, "{} after {}", energy, least);
                least = least.min(energy);
            }
        }
        // And it does fall when the block has hit the floor.
        prop_assert!(log.times(Event::Impact).is_empty() || restitution > 0.999 || least < cos(alpha * (1.0 - start)));
    }
}
