//! The unstable equilibrium θ = α, its neighbours to the last bit, and motions that come close to it.

use sprag_shared::math::{acosh, cos, sin, square_root};
use sprag_shared::motion::observer::Event;
use sprag_shared::motion::state::Phase;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_stability::{
    Energy, GEOMETRIES, Log, Precision, Segment, Start, Stepping, Tally, in_both_precisions, relative, unit_block,
};

in_both_precisions!(standing_for_a_day, standing_in_fixed_steps, an_ulp_beside_it, grazing_the_overturning_point);

/// α whose f32 is exact in f64, so that "the equilibrium" is one number in both. σ = 0.5, consistent kinematics, p = 1/s.
fn structure(geometry: Geometry, device: DeviceKind) -> Structure {
    let mut structure = unit_block(geometry, 0.171_875_f64.to_degrees(), device, 0.5, 0.85);
    structure.device.kinematics = KinematicsKind::Consistent;
    structure
}

fn slenderness<S: Precision>(structure: &Structure) -> S {
    S::of(structure.block.slenderness())
}

/// θ = α, θ̇ = 0: the block stands for 86,400 s, to the last bit, and it takes a handful of steps.
fn standing_for_a_day<S: Precision>() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            for side in [S::ONE, -S::ONE] {
                let structure = structure(geometry, device);
                let alpha = slenderness::<S>(&structure);
                let start = Start::Released(side * alpha, S::ZERO);
                let day = [Segment::quiet(S::of(86_400.0))];
                let run = S::tally(&structure, Stepping::Tight, start, &day, Tally::with_energy(Energy::of(&structure)));
                run.tally.assert_sane(4, 2);
                run.tally.assert_no_energy_gained(0.0);
                let end = run.end();
                assert_eq!((end.phase, end.rotation, end.velocity, end.impacts), (Phase::Rocking, side * alpha, S::ZERO, 0));
            }
        }
    }
}

/// Every step gives the state back to the last bit, so that a longer time would be the same again.
fn standing_in_fixed_steps<S: Precision>() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            let structure = structure(geometry, device);
            let alpha = slenderness::<S>(&structure);
            for (stepping, steps) in [
                (Stepping::RungeKutta4(S::of(0.03125)), 11_520),
                (Stepping::SemiImplicitEuler(S::of(0.03125)), 11_520),
                (Stepping::Taylor(S::of(0.25)), 1_440),
            ] {
                let quiet = [Segment::quiet(S::of(360.0))];
                let run = S::tally(&structure, stepping, Start::Released(alpha, S::ZERO), &quiet, Tally::new());
                run.tally.assert_sane(steps, 2);
                assert_eq!((run.end().rotation, run.end().velocity), (alpha, S::ZERO), "{geometry:?} {device:?} {stepping:?}");
            }
        }
    }
}

/// One ulp (and 10⁻¹²) beyond it the block overturns without an impact; before it, it comes back, and the slender one
/// reaches the floor after acosh(α/(α − θ)) / p_σ. The difference α − θ is exact in floating point.
fn an_ulp_beside_it<S: Precision>() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            let structure = structure(geometry, device);
            let alpha = slenderness::<S>(&structure);
            let relative_offset = |offset: f64| alpha * S::of(1.0 + offset);
            for stepping in [Stepping::Tight, Stepping::RungeKutta4(S::of(0.01)), Stepping::SemiImplicitEuler(S::of(0.01))] {
                for side in [S::ONE, -S::ONE] {
                    for above in [alpha.up(), relative_offset(S::tolerance(1e-12, 2e-7))] {
                        let start = Start::Released(side * above, S::ZERO);
                        let run = S::tally(&structure, stepping, start, &[Segment::quiet(S::of(90.0))], Tally::new());
                        run.tally.assert_sane(10_000, 2);
                        assert_eq!((run.end().phase, run.end().impacts), (Phase::Overturned, 0), "{geometry:?} {device:?}");
                    }
                    for below in [alpha.down(), relative_offset(-S::tolerance(1e-12, 2e-7))] {
                        let start = Start::Released(side * below, S::ZERO);
                        let mut log = Log::default();
                        let end = S::record(&structure, stepping, start, &[Segment::quiet(S::of(90.0))], &mut log)
                            .unwrap_or_else(|stopped| panic!("{stopped}"));
                        assert_ne!(end.phase, Phase::Overturned, "{} {geometry:?} {device:?} {stepping:?}", S::NAME);
                        // Fixed steps may round their first moves away, and take longer.
                        if stepping != Stepping::Tight {
                            continue;
                        }
                        assert_eq!(end.phase, Phase::Rest, "{} {geometry:?} {device:?}", S::NAME);
                        let impact = log.times(Event::Impact)[0].to_f64();
                        let slower = if device == DeviceKind::None { 1.0 } else { square_root(1.375) };
                        let exact = slower * acosh(alpha.to_f64() / (alpha - below).to_f64());
                        if geometry == Geometry::Full {
                            assert!((0.9 * exact..1.2 * exact).contains(&impact), "{impact} beside {exact}");
                        } else {
                            // The first step away rounds θ to one part in α/ulp of what is left to the equilibrium.
                            let tolerance = 2.0 * alpha.to_f64() * S::EPSILON.to_f64() / (alpha - below).to_f64();
                            assert!((impact - exact).abs() < tolerance.max(1e-4), "{} {device:?}: {impact} for {exact}", S::NAME);
                        }
                    }
                }
            }
        }
    }
}

/// Thrown from the floor with the speed that just reaches α, a little less and a little more: below, the block turns where its
/// energy says; above, it overturns. At the speed itself rounding decides, but it decides on one of the two.
fn grazing_the_overturning_point<S: Precision>() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            let structure = structure(geometry, device);
            let alpha = structure.block.slenderness();
            // Rising freely, a clutched pair is released.
            let k = if device == DeviceKind::Inerter { 0.375 } else { 0.0 };
            let critical = match geometry {
                Geometry::Slender => alpha / square_root(1.0 + k),
                Geometry::Full => 2.0 * sin(0.5 * alpha) / square_root(1.0 + k * cos(alpha) * cos(alpha)),
            };
            let thrown = |offset: f64| {
                let start = Start::Released(S::ZERO, S::of(critical) * S::of(1.0 + offset));
                let tally = Tally::with_energy(Energy::of(&structure));
                let run = S::tally(&structure, Stepping::Tight, start, &[Segment::quiet(S::of(90.0))], tally);
                run.tally.assert_sane(2_000, 2_000);
                run.tally.assert_no_energy_gained(S::tolerance(1e-14, 4e-6));
                (run.end(), run.tally)
            };
            let least = S::tolerance(1e-12, 4e-6);
            for offset in [least, 100.0 * least, 1e-2] {
                let (end, tally) = thrown(offset);
                assert_eq!((end.phase, end.impacts), (Phase::Overturned, 0), "{} {geometry:?} {device:?} +{offset}", S::NAME);
                assert_eq!(tally.count(Event::Turn), 0);
                let (end, tally) = thrown(-offset);
                assert_eq!(end.phase, Phase::Rest, "{} {geometry:?} {device:?} −{offset}", S::NAME);
                if geometry == Geometry::Slender {
                    let reached = 1.0 - square_root(offset * (2.0 - offset));
                    let peak = tally.peaks.rotation.to_f64() / alpha;
                    // What is left to α at the turn is the square root of what is left of the energy.
                    let tolerance = 8.0 * S::EPSILON.to_f64() / square_root(offset);
                    assert!(relative(peak, reached) < tolerance.max(1e-13), "{} {device:?}: {peak} for {reached}", S::NAME);
                }
            }
            let (end, _) = thrown(0.0);
            assert!(
                matches!((end.phase, end.impacts), (Phase::Overturned, 0) | (Phase::Rest, 1..) | (Phase::Rocking, _)),
                "{end:?}"
            );
        }
    }
}
