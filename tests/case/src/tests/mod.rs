use super::words::{MAGIC, VERSION};
use super::*;
use sprag_shared::ground::harmonic::MavroeidisPapageorgiou;
use sprag_shared::ground::{Harmonics, Linear, Ricker};
use sprag_shared::math::scalar::Real;
use sprag_shared::method::taylor::Taylor;
use sprag_shared::motion::state::Limits;
use sprag_shared::observers::digest::Digest;
use sprag_shared::structure::added_mass::AddedMass;
use sprag_shared::structure::block::{Block, Geometry};
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Actuation, Delay, Engagement, FlywheelLosses, Rack, Support};
use sprag_shared::structure::mount::Mount;
use sprag_shared::structure::restitution::Restitution;
use sprag_shared::structure::{REST_SPEED, RestitutionScatter};

mod devices;

/// A slender block of p = 1/s under one cycle of sine, ω/p = 4, a_g/gα = 1.5 (Figure 5).
fn figure05(kind: DeviceKind) -> Case<'static> {
    let alpha = 0.125;
    let pulse = Shape::Sine(Harmonics::sine(1.5 * alpha as f32, 4.0));
    Case {
        structure: Structure {
            geometry: Geometry::Slender,
            device: Device { kind, mass_ratio: 0.5, ..Device::NONE },
            rest_speed: f64::from(REST_SPEED as f32),
            ..Structure::new(Block::new(8.0, alpha, 1.25).unwrap(), Restitution::Constant(0.875))
        },
        drivetrain: Drivetrain::default(),
        initially: Initially::Rest,
        method: FixedMethod::RungeKutta4,
        step: 1e-2,
        ground: Ground::pieces(&[GroundPiece { shape: pulse, duration: core::f32::consts::FRAC_PI_2 }]).unwrap(),
        free_time: 20.0,
    }
}

fn words(case: &Case<'_>) -> ([u32; 256], usize) {
    let mut words = [0; 256];
    let count = case.encode(&mut words).unwrap();
    (words, count)
}

#[test]
fn a_case_comes_back_as_it_went() {
    let record = [0, 0.25_f32.to_bits(), (-0.5_f32).to_bits()];
    let wavelet = MavroeidisPapageorgiou { velocity_amplitude: 0.9, frequency: 0.5, oscillations: 2.0, phase: 0.0 }.harmonics();
    let single = wavelet.terms.map(|t| sprag_shared::ground::harmonic::Harmonic {
        amplitude: t.amplitude as f32,
        frequency: t.frequency as f32,
        phase: t.phase as f32,
    });
    let shapes = [
        Shape::Quiet,
        Shape::Linear(Linear { start: 0.1, slope: -2.0 }),
        Shape::Sine(Harmonics::cosine(0.3, 6.0)),
        Shape::ThreeSines(Harmonics { terms: single }),
        Shape::Ricker(Ricker { amplitude: 0.4, rate: 3.0, centre: 1.5 }),
    ];
    let base = figure05(DeviceKind::ClutchedPair);
    let recorded = |vertical| Ground::Record { interval: 0.5, samples: &record, vertical };
    let mut cases = std::vec![base, Case { ground: recorded(None), ..base }, Case { ground: recorded(Some(&record)), ..base }];
    for drivetrain in devices::drivetrains() {
        cases.push(Case { drivetrain, ..base });
    }
    let elastic = devices::drivetrains()[4];
    cases.push(Case { drivetrain: elastic, method: FixedMethod::ExponentialMidpoint, ..base });
    let piece = |shape| GroundPiece { shape, duration: 0.5 };
    let sine = Shape::Sine(Harmonics::cosine(0.3, 6.0));
    cases.push(Case { ground: Ground::both_ways(&shapes.map(|shape| (piece(sine), shape))).unwrap(), ..base });
    cases.push(Case {
        initially: Initially::Released { rotation: -0.0625, velocity: 0.5 },
        method: FixedMethod::Taylor,
        ground: Ground::pieces(&shapes.map(piece)).unwrap(),
        ..base
    });
    for (mount, restitution) in [
        (Mount::TyingPoint { height: 2.0, pulley_ratio: 1.5 }, Restitution::Geometric),
        (Mount::BaseCorners { pulley_ratio: 3.0 }, Restitution::MomentumBalance),
    ] {
        let device = Device { mount, kinematics: KinematicsKind::Consistent, ..base.structure.device };
        let added_mass = AddedMass { mass_ratio: 0.0625, height: 5.5 };
        let restitution_scatter = RestitutionScatter { deviation: 0.0, seed: 3 << 40 | 5 };
        let structure =
            Structure { device, added_mass, geometry: Geometry::Full, restitution, restitution_scatter, ..base.structure };
        cases.push(Case { structure, method: FixedMethod::SemiImplicitEuler, ..base });
    }
    let scatter = RestitutionScatter { deviation: 0.0625, seed: u64::MAX - 7 };
    cases.push(Case { structure: Structure { restitution_scatter: scatter, ..base.structure }, ..base });
    for case in cases {
        let (words, count) = words(&case);
        assert_eq!(Case::decode(&words[..count]), Ok(case));
        let end = run(&words[..count], &mut ()).unwrap();
        assert!(end.steps > 50 && end.peaks.rotation > 0.0, "{end:?}");
        let too_small = case.encode(&mut [0; 20]).unwrap_err();
        assert_eq!(too_small, CaseError::Full);
    }
}

#[test]
fn bad_words_are_named() {
    let (good, count) = words(&figure05(DeviceKind::Inerter));
    let with = |index: usize, word: u32| {
        let mut words = good;
        words[index] = word;
        run(&words[..count], &mut ()).unwrap_err()
    };
    assert_eq!(run(&[], &mut ()), Err(CaseError::Missing("the first word")));
    assert_eq!(run(&good[..count - 1], &mut ()), Err(CaseError::Missing("a number of the shape")));
    assert_eq!(run(&good[..count + 3], &mut ()), Err(CaseError::Trailing(3)));
    assert_eq!(with(0, 7), CaseError::Magic(7));
    assert_ne!(MAGIC, 7);
    assert_eq!(with(1, VERSION + 1), CaseError::Version(VERSION + 1));
    for (index, of) in [
        (5, "geometry"),
        (6, "device"),
        (8, "mount"),
        (11, "kinematics"),
        (14, "engagement"),
        (32, "delay"),
        (37, "restitution"),
        (43, "start"),
        (46, "method"),
        (49, "ground"),
        (51, "vertical motion"),
        (52, "shape"),
    ] {
        for word in [9, u32::MAX] {
            assert_eq!(with(index, word), CaseError::Kind { of, word });
        }
    }
    assert_eq!(with(50, 9), CaseError::TooManyPieces(9));
    let parameter = |index: usize, number: f32| match with(index, number.to_bits()) {
        CaseError::Parameter(error) => error.parameter,
        other => panic!("{other}"),
    };
    assert_eq!(parameter(2, 0.0), "size");
    assert_eq!(parameter(3, f32::NAN), "slenderness");
    assert_eq!(parameter(4, 0.5), "inertia_ratio");
    assert_eq!(parameter(7, -1.0), "mass_ratio");
    assert_eq!(parameter(12, 10.5), "carried mass_ratio");
    assert_eq!(parameter(13, -1.0), "carried height");
    assert_eq!(parameter(38, 1.5), "restitution");
    assert_eq!(parameter(39, 0.0), "rest_speed");
    assert_eq!(parameter(40, 0.75), "restitution_scatter");
    assert_eq!(parameter(47, 0.0), "step");
    assert_eq!(parameter(48, f32::INFINITY), "free_time");
    assert_eq!(parameter(53, -1.0), "duration");
    assert_eq!(parameter(55, f32::NAN), "number of a shape");
    assert_eq!(with(47, 1e-7_f32.to_bits()), CaseError::TooManySteps);
}

/// Half of the mass at the base doubles the stability angle: a block that moves on beyond its own comes back.
#[test]
fn a_loaded_block_overturns_where_it_is_loaded_to() {
    let base = figure05(DeviceKind::None);
    let outcome = |added_mass, geometry, rotation| {
        let structure = Structure { added_mass, geometry, ..base.structure };
        let initially = Initially::Released { rotation, velocity: 0.03 };
        Case { structure, initially, ground: Ground::pieces(&[]).unwrap(), ..base }.run(&mut ()).unwrap().outcome
    };
    for geometry in [Geometry::Full, Geometry::Slender] {
        let low = AddedMass { mass_ratio: 1.0, height: 0.0 };
        assert_eq!(outcome(AddedMass::NONE, geometry, 0.2), Outcome::OverturnedWithoutImpact);
        assert_eq!(outcome(low, geometry, 0.2), Outcome::Safe);
        assert_eq!(outcome(low, geometry, 0.26), Outcome::OverturnedWithoutImpact);
    }
}

/// The slender peaks of Figure 5 (VERIFICATION): here with η = 0.875, so close to them before the first impact only; what
/// matters is that f32 and f64 agree.
#[test]
fn single_precision_is_close_to_double() {
    let in_double = |structure: &Structure| {
        let system = structure.resolve().unwrap();
        let (mut state, mut peaks) = (BlockState::default(), Peaks::default());
        let method = Taylor::<f64, 24>::adaptive(1e-17);
        let limits = Limits { overturned: 1.0, events: 100_000 };
        let pulse = Harmonics::sine(1.5 * 0.125, 4.0);
        system.advance(&method, &mut state, &pulse, core::f64::consts::FRAC_PI_2, &limits, &mut peaks).unwrap();
        system.advance(&method, &mut state, &Harmonics::QUIET, 20.0, &limits, &mut peaks).unwrap();
        peaks.rotation
    };
    for kind in DeviceKind::ALL {
        let case = figure05(kind);
        let exact = in_double(&case.structure);
        for (method, step, tolerance) in [
            (FixedMethod::RungeKutta4, 1e-2, 1e-5),
            (FixedMethod::Taylor, 5e-2, 1e-5),
            (FixedMethod::SemiImplicitEuler, 1e-3, 1e-2),
        ] {
            let mut digest = Digest::default();
            let end = Case { method, step, ..case }.run(&mut digest).unwrap();
            assert_eq!(end.outcome, Outcome::Safe);
            assert_eq!(end.state.phase, sprag_shared::motion::state::Phase::Rest, "{kind:?} {method:?}");
            let error = end.peaks.rotation.to_f64() / exact - 1.0;
            assert!(error.abs() < tolerance, "{kind:?} {method:?}: {error}");
            assert!(digest.stretches >= end.steps && digest.events > 10);
        }
    }
}

/// A scene asks for a method by the name that an error gives it back.
#[test]
fn methods_have_names_of_their_own() {
    let names = [
        (FixedMethod::SemiImplicitEuler, "semi-implicit-euler"),
        (FixedMethod::RungeKutta4, "runge-kutta-4"),
        (FixedMethod::Taylor, "taylor"),
        (FixedMethod::ExponentialMidpoint, "exponential-midpoint"),
    ];
    for (method, name) in names {
        assert_eq!(method.name(), name);
    }
}
