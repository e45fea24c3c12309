//! Impacts that differ: closed forms of free rocking, other methods and precisions, the mirrored motion, the ledger.

use std::vec::Vec;

use super::{Shake, drivetrains, pair, structure, tight};
use crate::ground::Harmonics;
use crate::math;
use crate::math::scalar::Real;
use crate::method::fixed::{FixedStep, Scheme};
use crate::motion::hybrid::HybridSystem;
use crate::motion::hybrid::mode_output::{ModeIntegrator, Shaking};
use crate::motion::observer::{Event, Observer};
use crate::motion::state::{BlockState, Limits};
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::Drivetrain;
use crate::structure::restitution::Restitution;
use crate::structure::{RestitutionScatter, Structure};

const SCATTER: RestitutionScatter = RestitutionScatter { deviation: 0.05, seed: 4 };

fn scattered(geometry: Geometry, kind: DeviceKind, scatter: RestitutionScatter) -> Structure {
    let structure = structure(geometry, 12.0, kind, 0.4, KinematicsKind::Consistent);
    Structure { restitution_scatter: scatter, ..structure }
}

fn of(shake: Shake, restitution_scatter: RestitutionScatter) -> Shake {
    Shake { structure: Structure { restitution_scatter, ..shake.structure }, ..shake }
}

/// |θ̇| after each impact of a block that is released at 0.7 α and left alone.
fn speeds<S: Real, T: ModeIntegrator<S>>(structure: &Structure, method: &T) -> Vec<f64> {
    #[derive(Default)]
    struct Speeds(Vec<f64>);
    impl<S: Real> Observer<S> for Speeds {
        fn event(&mut self, event: Event, _time: S, state: &BlockState<S>) {
            if event == Event::Impact {
                self.0.push(state.velocity.to_f64().abs());
            }
        }
    }
    let machine: HybridSystem<S> = Drivetrain::default().resolve(structure, false).unwrap();
    let mut state = machine.released_at(S::of(0.7 * structure.block.slenderness()), S::ZERO, [S::ZERO; 3]);
    let mut speeds = Speeds::default();
    let limits = Limits { overturned: S::ONE, events: 100_000 };
    let shaking = Shaking::level(&Harmonics::QUIET);
    machine.advance(method, &mut state, shaking, S::of(8.0), &limits, &mut speeds).unwrap();
    speeds.0
}

/// Between impacts nothing is lost, so that n impacts leave θ̇ = θ̇₀ η₁ … ηₙ, with p² (2αθ₀ − θ₀²) or 2p² (cos(α − θ₀) − cos α) as θ̇₀².
#[test]
fn n_impacts_leave_the_product_of_the_drawn_ratios() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        let structure = scattered(geometry, DeviceKind::None, SCATTER);
        let (p2, alpha) = (structure.block.frequency_parameter_squared(), structure.block.slenderness());
        let start = 0.7 * alpha;
        let squared = match geometry {
            Geometry::Slender => p2 * (2.0 * alpha * start - start * start),
            Geometry::Full => 2.0 * p2 * (math::cos(alpha - start) - math::cos(alpha)),
        };
        let found = speeds(&structure, &tight());
        assert!(found.len() > 30, "{}", found.len());
        let mut expected = squared.sqrt();
        for (speed, impact) in found.iter().zip(1..).take(30) {
            expected *= SCATTER.draw(impact, 0.85);
            assert!((speed / expected - 1.0).abs() < 1e-9, "{geometry:?}, impact {impact}: {speed} and {expected}");
        }
    }
}

/// The k-th impact draws the same by series and by fixed steps of any length, in double and in single precision.
#[test]
fn draws_do_not_depend_on_steps_or_precision() {
    let structure = scattered(Geometry::Slender, DeviceKind::None, SCATTER);
    let drawn: Vec<f64> = (2..=12).map(|impact| SCATTER.draw(impact, 0.85)).collect();
    let ratios = |speeds: &[f64]| speeds.windows(2).map(|pair| pair[1] / pair[0]).take(11).collect::<Vec<f64>>();
    let scheme = Scheme::RungeKutta4;
    for (found, allowed) in [
        (speeds::<f64, _>(&structure, &FixedStep { scheme, step: 1e-3 }), 1e-7),
        (speeds::<f64, _>(&structure, &FixedStep { scheme, step: 7e-3 }), 1e-4),
        (speeds::<f32, _>(&structure, &FixedStep { scheme, step: 2e-3 }), 1e-3),
    ] {
        for (ratio, eta) in ratios(&found).iter().zip(&drawn) {
            assert!((ratio - eta).abs() < allowed, "{ratio} and {eta}");
        }
    }
}

/// Without a deviation a seed changes no bit; with one, each seed is another motion.
#[test]
fn off_it_is_not_there() {
    for (name, drivetrain) in drivetrains() {
        let seen = |deviation, seed| {
            let scatter = RestitutionScatter { deviation, seed };
            of(pair(Geometry::Full, 3.0, 5.0), scatter).machine(&drivetrain, &tight())
        };
        let (plain, other) = (seen(0.0, 0), seen(0.0, 77));
        assert_eq!(plain.events, other.events, "{name}");
        assert_eq!((plain.peak.to_bits(), plain.state), (other.peak.to_bits(), other.state), "{name}");
        let [one, two] = [1, 2].map(|seed| seen(0.05, seed));
        assert!(one.events != plain.events && two.events != one.events, "{name}");
    }
}

/// A mirrored pulse gives the mirrored motion, with the same draws.
#[test]
fn scattered_impacts_are_symmetric() {
    for (name, drivetrain) in drivetrains() {
        let shake = of(pair(Geometry::Full, 3.0, 5.0), SCATTER);
        let [one, other] = [&shake, &shake.mirrored()].map(|shake| shake.machine(&drivetrain, &tight()));
        assert_eq!(one.peak.to_bits(), other.peak.to_bits(), "{name}");
        assert_eq!((one.impacts, one.events), (other.impacts, other.events), "{name}");
    }
}

/// What impacts take is drawn, never negative, and the books close.
#[test]
fn the_ledger_closes_with_scattered_impacts() {
    for restitution in [Restitution::Constant(0.9), Restitution::MomentumBalance] {
        for (name, drivetrain) in drivetrains() {
            let shake = of(pair(Geometry::Full, 3.0, 5.0), RestitutionScatter { deviation: 0.2, seed: 9 });
            let shake = Shake { structure: Structure { restitution, ..shake.structure }, ..shake };
            let mut ledger = shake.ledger(&drivetrain);
            shake.watched(&drivetrain, &tight(), &mut ledger);
            let entries = ledger.entries;
            let residual = entries.residual().abs() / entries.input.abs();
            assert!(residual < 1e-10 && entries.impact > 0.0, "{name}, {restitution:?}: {residual:e} of the input, {entries:?}");
        }
    }
}

/// The loop of ideal devices knows no scatter, and says so.
#[test]
fn the_other_loop_refuses_it() {
    let structure = scattered(Geometry::Full, DeviceKind::Inerter, SCATTER);
    let error = structure.resolve::<f64>().unwrap_err();
    assert_eq!((error.parameter, error.value), ("restitution_scatter", 0.05));
    let wide = Structure { restitution_scatter: RestitutionScatter { deviation: 0.6, seed: 0 }, ..structure };
    let error = Drivetrain::default().resolve::<f64>(&wide, false).unwrap_err();
    assert_eq!((error.parameter, error.range), ("restitution_scatter", "from 0 to 0.5"));
}
