//! Elastic clutches from 10² to 10¹² N/m per kg of block at one fixed step.

use sprag_shared::motion::state::Phase;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_stability::{GEOMETRIES, Precision, elastic_run, in_both_precisions, relative, unit_block};

in_both_precisions!(every_stiffness_at_the_control_period, every_stiffness_at_ten_times_the_control_period, an_undamped_spring);

/// R = 2 m, α = 15°, σ = 0.5, η = 0.85.
fn structure(geometry: Geometry) -> Structure {
    let block = Block::new(2.0, 15.0_f64.to_radians(), RECTANGLE_INERTIA_RATIO).expect("within range");
    let mut structure = Structure { block, ..unit_block(geometry, 15.0, DeviceKind::ClutchedPair, 0.5, 0.85) };
    structure.device.kinematics = KinematicsKind::Consistent;
    structure
}

/// 3 thresholds, ω/p = 5, 12/p of free time.
fn every_stiffness<S: Precision>(step: f64, damping_ratio: f64, spread: f64) {
    for geometry in GEOMETRIES {
        let structure = structure(geometry);
        let p = structure.block.frequency_parameter();
        let pulse = (3.0 * geometry.uplift_threshold(structure.block.slenderness()), 5.0 * p);
        let time = core::f64::consts::TAU / pulse.1 + 12.0 / p;
        let mut last = None;
        let mut gain = 0.0_f64;
        for exponent in 2..=12 {
            let stiffness = sprag_shared::math::pow(10.0, f64::from(exponent));
            let end = elastic_run::<S>(&structure, (stiffness, damping_ratio), pulse, 12.0 / p, step);
            let what = format!("{} {geometry:?} K/m = 1e{exponent}, step {step}", S::NAME);
            let state = end.state.unwrap_or_else(|stopped| panic!("{what}: {stopped}"));
            assert!(state.rotation.is_finite() && state.velocity.is_finite() && end.peak.is_finite(), "{what}");
            assert_ne!(state.phase, Phase::Overturned, "{what}");
            assert!(end.peak > 0.02 && end.peak < 0.9 * structure.block.slenderness(), "{what}: {end:?}");
            assert!(end.steps <= (time / step) as u64 + 4_000 && end.events <= 4_000, "{what}: {end:?}");
            assert!(end.depth <= S::tolerance(1e-14, 1e-7), "{what}: {end:?}");
            // Stiff enough, a spring is a rigid clutch: its stiffness does not show.
            if exponent > 8 {
                let last: f64 = last.expect("a softer one");
                assert!(relative(end.peak, last) < spread, "{what}: {} after {last}", end.peak);
            }
            last = Some(end.peak);
            gain = gain.max(end.gain);
        }
        println!("{} {geometry:?} step {step}: the energy of a free motion grows by at most {gain:.1e} of the barrier", S::NAME);
        // A method of order 2 gives energy back to its error; twice the error of a step of 5e-4 s in this motion.
        assert!(gain < 4e-3 * (step / 5e-4) * (step / 5e-4) + 1e-3, "{} {geometry:?}: {gain}", S::NAME);
    }
}

fn every_stiffness_at_the_control_period<S: Precision>() {
    every_stiffness::<S>(5e-4, 0.3, 2e-3);
}

fn every_stiffness_at_ten_times_the_control_period<S: Precision>() {
    every_stiffness::<S>(5e-3, 0.3, 2e-2);
}

/// Without damping the twist keeps swinging. From some 10⁸ N/m per kg on, so does θ̇ at every turn, with events by the hundred
/// thousand: a limit.
fn an_undamped_spring<S: Precision>() {
    for exponent in [2, 5] {
        let structure = structure(Geometry::Full);
        let p = structure.block.frequency_parameter();
        let pulse = (3.0 * structure.geometry.uplift_threshold(structure.block.slenderness()), 5.0 * p);
        let stiffness = sprag_shared::math::pow(10.0, f64::from(exponent));
        let end = elastic_run::<S>(&structure, (stiffness, 0.0), pulse, 8.0 / p, 5e-4);
        let state = end.state.unwrap_or_else(|stopped| panic!("{} K/m = 1e{exponent}: {stopped}", S::NAME));
        assert!(state.rotation.is_finite() && state.phase != Phase::Overturned, "{} K/m = 1e{exponent}: {end:?}", S::NAME);
        assert!(end.steps < 40_000 && end.events < 20_000, "{} K/m = 1e{exponent}: {end:?}", S::NAME);
    }
}
