//! Cases of devices with a memory and of vertical ground motion.

use super::*;
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::motion::hybrid::mode_output::Shaking;
use sprag_shared::motion::hybrid::series::Series;

/// One of every engagement, with losses, and the two halves of a seed; every number is one of single precision.
pub fn drivetrains() -> [Drivetrain; 11] {
    let flywheel = FlywheelLosses { viscous_rate: 0.0625, dry_deceleration: 0.25, brake_deceleration: 5.0, drag_rate: 0.0 };
    let coasting = FlywheelLosses { brake_deceleration: 0.0, ..flywheel };
    let rack = Rack { guided_mass_ratio: 0.03125, viscous: 0.0625, dry_ratio: 0.00390625, load_friction: 0.0 };
    let of = |engagement, flywheel| Drivetrain { engagement, flywheel, rack, ..Drivetrain::default() };
    let elastic = |backlash, capacity_ratio| Engagement::Elastic { stiffness: 3e3, damping: 8.0, backlash, capacity_ratio };
    let actuation = Actuation {
        engagement_delay: 0.015625,
        release_delay: 0.0078125,
        delay: Delay::Transport,
        rise_time: 0.03125,
        time_constant: 0.0,
        dwell: 0.0625,
        miss_probability: 0.25,
        miss_seed: 0x0123_4567_89ab_cdef,
    };
    let friction = of(Engagement::Friction { capacity_ratio: 0.03125 }, flywheel);
    [
        of(Engagement::Ideal, coasting),
        of(Engagement::Rigid, flywheel),
        of(Engagement::Overrunning, coasting),
        Drivetrain { actuation, ..friction },
        of(elastic(0.0, f64::INFINITY), flywheel),
        of(elastic(0.001953125, 0.03125), FlywheelLosses { brake_deceleration: f64::INFINITY, ..flywheel }),
        Drivetrain { actuation: Actuation { time_constant: 0.0625, ..Actuation::default() }, ..friction },
        Drivetrain { support: Support::amplified(1.25), ..Drivetrain::default() },
        of(Engagement::Viscous { corner_frequency: 4.0 }, flywheel),
        Drivetrain {
            actuation: Actuation { rise_time: 0.0, ..actuation },
            ..of(Engagement::Rigid, FlywheelLosses { drag_rate: 0.125, ..flywheel })
        },
        Drivetrain { rack: Rack { load_friction: 0.125, ..rack }, ..of(Engagement::Rigid, flywheel) },
    ]
}

fn digest(case: &Case<'_>) -> (RunEnd, u64) {
    let mut digest = Digest::default();
    let end = case.run(&mut digest).unwrap();
    (end, digest.hash())
}

#[test]
fn bad_words_of_a_drivetrain_are_named() {
    let base = figure05(DeviceKind::ClutchedPair);
    let (good, count) = words(&Case { drivetrain: drivetrains()[5], ..base });
    let with = |index: usize, number: f32| {
        let mut words = good;
        words[index] = number.to_bits();
        match run(&words[..count], &mut ()) {
            Err(CaseError::Parameter(error)) => error.parameter,
            other => panic!("{other:?}"),
        }
    };
    for (index, parameter) in [
        (15, "stiffness"),
        (16, "damping"),
        (17, "backlash"),
        (18, "capacity_ratio"),
        (19, "viscous_rate"),
        (20, "dry_deceleration"),
        (21, "brake_deceleration"),
        (22, "guided_mass_ratio"),
        (23, "rack viscous"),
        (24, "rack dry_ratio"),
        (25, "engagement_delay"),
        (26, "release_delay"),
        (27, "rise_time"),
        (28, "dwell"),
        (29, "miss_probability"),
        (33, "support_amplification"),
        (34, "time_constant"),
        (35, "load_friction"),
        (36, "drag_rate"),
    ] {
        for number in [if index == 33 { -11.0 } else { -1.0 }, f32::NAN, 2e12] {
            assert_eq!(with(index, number), parameter);
        }
    }
}

#[test]
fn a_vertical_motion_fits_the_horizontal_one_and_leaves_some_weight() {
    let base = figure05(DeviceKind::None);
    let record = [0, 0.25_f32.to_bits(), (-0.5_f32).to_bits()];
    let recorded =
        |vertical| Case { ground: Ground::Record { interval: 0.5, samples: &record, vertical: Some(vertical) }, ..base };
    let uneven = CaseError::Uneven { horizontal: 3, vertical: 2 };
    assert_eq!(recorded(&record[..2]).run(&mut ()), Err(uneven));
    assert_eq!(recorded(&record[..2]).encode(&mut [0; 256]), Err(uneven));
    let (short, count) = words(&recorded(&record));
    assert_eq!(run(&short[..count - 1], &mut ()), Err(CaseError::Missing("the last vertical sample")));
    let parameter = |case: &Case<'_>| match case.run(&mut ()) {
        Err(CaseError::Parameter(error)) => error.parameter,
        other => panic!("{other:?}"),
    };
    assert_eq!(parameter(&recorded(&[0, (-1.0_f32).to_bits(), 0])), "vertical sample");
    let over = |shape| {
        let sine = GroundPiece { shape: Shape::Sine(Harmonics::sine(0.1875, 4.0)), duration: 1.0 };
        Case { ground: Ground::both_ways(&[(sine, shape)]).unwrap(), ..base }
    };
    assert_eq!(parameter(&over(Shape::Sine(Harmonics::sine(1.0, 4.0)))), "vertical acceleration");
    assert_eq!(parameter(&over(Shape::Linear(Linear { start: 1.0, slope: -2.0 }))), "vertical acceleration");
    assert!(over(Shape::Linear(Linear { start: 2.0, slope: -2.0 })).run(&mut ()).is_ok());
    let piece = (GroundPiece { shape: Shape::Quiet, duration: 1.0 }, Shape::Quiet);
    assert_eq!(Ground::both_ways(&[piece; 9]), Err(CaseError::TooManyPieces(9)));
}

#[test]
fn a_method_runs_what_it_is_for() {
    let base = figure05(DeviceKind::ClutchedPair);
    let refused = |case: Case<'_>| match case.run(&mut ()) {
        Err(CaseError::Method { method, .. }) => method == case.method,
        _ => false,
    };
    let [_, rigid, .., elastic, _, _, _, _, _] = drivetrains();
    for method in [FixedMethod::SemiImplicitEuler, FixedMethod::Taylor] {
        let vertical = Ground::both_ways(&[(GroundPiece { shape: Shape::Quiet, duration: 1.0 }, Shape::Quiet)]).unwrap();
        assert!(refused(Case { method, drivetrain: rigid, ..base }));
        assert!(refused(Case { method, ground: vertical, ..base }));
    }
    let method = FixedMethod::ExponentialMidpoint;
    assert!(refused(Case { method, ..base }));
    assert!(refused(Case { method, drivetrain: rigid, ..base }));
    assert!(!refused(Case { method, drivetrain: elastic, ..base }));
    // A single inerter has no clutch.
    let single = figure05(DeviceKind::Inerter);
    assert!(refused(Case { method, drivetrain: elastic, ..single }));
}

/// A seed without a probability calls for the other loop and changes nothing else.
#[test]
fn both_loops_move_an_ideal_device_alike() {
    let drivetrain = Drivetrain { actuation: Actuation { miss_seed: 7, ..Actuation::default() }, ..Drivetrain::default() };
    for geometry in [Geometry::Full, Geometry::Slender] {
        for kind in DeviceKind::ALL {
            let base = figure05(kind);
            let ideal = Case { structure: Structure { geometry, ..base.structure }, ..base };
            let other = Case { drivetrain, ..ideal };
            assert!(ideal.is_ideal() && !other.is_ideal());
            let ((a, _), (b, _)) = (digest(&ideal), digest(&other));
            assert_eq!((a.outcome, a.state.phase), (b.outcome, b.state.phase), "{geometry:?} {kind:?}");
            assert!((a.peaks.rotation / b.peaks.rotation - 1.0).abs() < 1e-5, "{geometry:?} {kind:?}: {a:?} {b:?}");
        }
    }
}

/// The digest sees every effect, and the same run twice is the same.
#[test]
fn every_effect_has_a_digest_of_its_own() {
    let base = figure05(DeviceKind::ClutchedPair);
    let pulse = GroundPiece { shape: Shape::Sine(Harmonics::sine(0.1875, 4.0)), duration: core::f32::consts::FRAC_PI_2 };
    let up = Shape::Sine(Harmonics::sine(0.25, 16.0));
    let mut hashes = std::vec![digest(&base).1];
    hashes.extend(drivetrains().map(|drivetrain| digest(&Case { drivetrain, ..base }).1));
    hashes.push(digest(&Case { ground: Ground::both_ways(&[(pulse, up)]).unwrap(), ..base }).1);
    let exponential = Case { method: FixedMethod::ExponentialMidpoint, drivetrain: drivetrains()[4], ..base };
    hashes.push(digest(&exponential).1);
    assert_eq!(digest(&exponential).1, digest(&exponential).1);
    for (index, hash) in hashes.iter().enumerate() {
        assert!(!hashes[..index].contains(hash), "{index}: {hashes:x?}");
    }
}

/// The first cycle by a tight series in double precision, in which every event is proven.
#[test]
fn single_precision_follows_every_device() {
    let base = figure05(DeviceKind::ClutchedPair);
    let pulse = GroundPiece { shape: Shape::Sine(Harmonics::sine(0.1875, 4.0)), duration: 0.75 };
    let up = Shape::Sine(Harmonics::sine(0.25, 16.0));
    let ground = Ground::both_ways(&[(pulse, up)]).unwrap();
    for (index, drivetrain) in drivetrains().into_iter().enumerate() {
        let machine: HybridSystem<f64> = drivetrain.resolve(&base.structure, true).unwrap();
        let mut state = machine.at_rest();
        let limits = Limits { overturned: 1.5, events: 100_000 };
        let (push, lift) = (Harmonics::sine(0.1875, 4.0), Harmonics::sine(0.25, 16.0));
        let shaking = Shaking { horizontal: &push, vertical: Some(&lift), support: None };
        machine.advance(&Series::<f64, 16>::adaptive(1e-15), &mut state, shaking, 0.75, &limits, &mut ()).unwrap();
        let exact = state.motion.rotation;
        let methods: &[_] = match drivetrain.engagement {
            Engagement::Elastic { .. } => {
                &[(FixedMethod::RungeKutta4, 1e-3, 1e-4), (FixedMethod::ExponentialMidpoint, 1e-3, 1e-4)]
            }
            _ => &[(FixedMethod::RungeKutta4, 5e-3, 1e-4)],
        };
        for &(method, step, tolerance) in methods {
            let end = Case { drivetrain, method, step, ground, free_time: 0.0, ..base }.run(&mut ()).unwrap();
            let error = end.state.rotation.to_f64() / exact - 1.0;
            assert!(error.abs() < tolerance, "{index} {method:?}: {error}");
        }
    }
}
