//! Denormal numbers: rotations, velocities and ground motions of 10⁻⁴⁰ in f32 and 10⁻³¹⁰ in f64. They cost no more steps, and the
//! results are those of zero.

use sprag_shared::motion::observer::Event;
use sprag_shared::motion::state::Phase;
use sprag_shared::structure::device::DeviceKind;
use sprag_stability::{GEOMETRIES, Precision, Segment, Start, Stepping, Tally, in_both_precisions, unit_block};

in_both_precisions!(a_denormal_rotation, a_denormal_velocity, a_denormal_ground_motion, a_denormal_tremor_on_a_standing_block);

const TAU: f64 = core::f64::consts::TAU;

fn steppings<S: Precision>() -> [Stepping<S>; 4] {
    [Stepping::Tight, Stepping::RungeKutta4(S::of(0.01)), Stepping::SemiImplicitEuler(S::of(0.01)), Stepping::Taylor(S::of(0.05))]
}

/// Let go at a denormal θ, and at denormal multiples of it: one fall, which no clock can measure, and rest.
fn a_denormal_rotation<S: Precision>() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            let structure = unit_block(geometry, 10.0, device, 0.5, 0.85);
            for rotation in [S::ZERO.up(), S::DENORMAL, S::DENORMAL * S::of(100.0)] {
                for side in [S::ONE, -S::ONE] {
                    for stepping in steppings() {
                        let start = Start::Released(side * rotation, S::ZERO);
                        // A search of 64 looks finds 2⁻⁶⁴ of a step; in Euler steps, whose θ̇ is not the slope of θ, it halves at every
                        // other look: 2⁻³². What gravity does in that time is all that the fall may come out with.
                        let euler = matches!(stepping, Stepping::SemiImplicitEuler(_));
                        let (peak, time) = if euler { (1e-24, 1e-10) } else { (1e-36, 1e-15) };
                        let mut tally = Tally::new();
                        if euler {
                            tally.floor = f64::INFINITY;
                        }
                        let run = S::tally(&structure, stepping, start, &[Segment::quiet(S::ONE)], tally);
                        run.tally.assert_sane(8, 16);
                        assert!(run.looks < 1_000, "{} {stepping:?}: {} looks", S::NAME, run.looks);
                        let end = run.end();
                        assert_eq!((end.phase, end.rotation, end.velocity, end.impacts), (Phase::Rest, S::ZERO, S::ZERO, 0));
                        let largest = run.tally.peaks.rotation.to_f64().max(run.tally.reach);
                        assert!(run.tally.peaks.rotation >= rotation && largest < peak, "{} {stepping:?}: {largest:e}", S::NAME);
                        let ended = run.tally.peaks.ended.expect("rest").to_f64();
                        assert!(ended < time, "{} {stepping:?}: rest after {ended:e} s", S::NAME);
                    }
                }
            }
        }
    }
}

/// Thrown from the floor with a denormal θ̇, or released tilted with one: as with none.
fn a_denormal_velocity<S: Precision>() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            let structure = unit_block(geometry, 10.0, device, 0.5, 0.85);
            let tilt = S::of(0.4 * structure.block.slenderness());
            for stepping in steppings() {
                let thrown = [Segment::quiet(S::ONE)];
                for velocity in [S::ZERO.up(), S::DENORMAL] {
                    let run = S::tally(&structure, stepping, Start::Released(S::ZERO, velocity), &thrown, Tally::new());
                    run.tally.assert_sane(8, 16);
                    assert!(run.looks < 1_000, "{} {stepping:?}: {} looks", S::NAME, run.looks);
                    assert_eq!((run.end().phase, run.end().impacts), (Phase::Rest, 0), "{} {stepping:?}", S::NAME);
                }
                let free = [Segment::quiet(S::of(10.0))];
                let inward = -S::DENORMAL;
                let with = S::tally(&structure, stepping, Start::Released(tilt, inward), &free, Tally::new());
                let without = S::tally(&structure, stepping, Start::Released(tilt, S::ZERO), &free, Tally::new());
                assert_eq!(with.end(), without.end(), "{} {geometry:?} {device:?} {stepping:?}", S::NAME);
                assert_eq!(with.tally.events, without.tally.events);
                assert!(with.looks <= without.looks + 100, "{} looks, {} without", with.looks, without.looks);
            }
        }
    }
}

/// A rocking block over a ground that hums with a denormal amplitude: as over none, to rounding, and for the same work.
fn a_denormal_ground_motion<S: Precision>() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            let structure = unit_block(geometry, 10.0, device, 0.5, 0.85);
            let start = Start::Released(S::of(0.4 * structure.block.slenderness()), S::ZERO);
            for stepping in steppings() {
                let time = S::of(4.0);
                let quiet = S::tally(&structure, stepping, start, &[Segment::constant(S::ZERO, time)], Tally::new());
                for ground in [
                    Segment::constant(S::DENORMAL, time),
                    Segment::line(S::DENORMAL, -S::DENORMAL, time),
                    Segment::sine(S::DENORMAL, S::of(TAU), time),
                    Segment::sine(S::ZERO.up(), S::of(TAU), time),
                ] {
                    let run = S::tally(&structure, stepping, start, &[ground], Tally::new());
                    run.tally.assert_sane(quiet.tally.steps + 20, quiet.tally.total() + 4);
                    assert!(
                        run.looks <= quiet.looks + 200,
                        "{} {stepping:?}: {} looks, {} without",
                        S::NAME,
                        run.looks,
                        quiet.looks
                    );
                    let (a, b) = (run.end(), quiet.end());
                    assert_eq!((a.phase, a.impacts), (b.phase, b.impacts), "{} {geometry:?} {device:?} {stepping:?}", S::NAME);
                    let off = (a.rotation - b.rotation).abs().larger((a.velocity - b.velocity).abs()).to_f64();
                    assert!(off < S::tolerance(1e-14, 1e-6), "{} {geometry:?} {device:?} {stepping:?}: {off:e}", S::NAME);
                }
            }
        }
    }
}

/// Two thousand samples of it: no arc at all.
fn a_denormal_tremor_on_a_standing_block<S: Precision>() {
    for geometry in GEOMETRIES {
        let structure = unit_block(geometry, 10.0, DeviceKind::ClutchedPair, 0.5, 0.85);
        let sample = |k: u32| S::DENORMAL * S::of(f64::from(k % 7) - 3.0);
        let record: Vec<_> = (0..2_000).map(|k| Segment::line(sample(k), sample(k + 1), S::of(0.005))).collect();
        let run = S::tally(&structure, Stepping::Tight, Start::Rest, &record, Tally::new());
        assert_eq!((run.end().phase, run.arcs, run.tally.count(Event::Uplift)), (Phase::Rest, 0, 0));
    }
}
