//! How motions end: in rest, overturned or undecided, and never in an endless loop. What decides when to stop must not
//! show in a result.

use core::f64::consts::{PI, TAU};

use sprag_shared::block::Geometry;
use sprag_shared::math::{acosh, asin, atanh, cos, cosh, exp, sinh, square_root};
use sprag_shared::observer::Event;
use sprag_shared::rocking::{Phase, State};
use sprag_shared::scalar::Sign;
use sprag_shared::structure::{DeviceKind, KinematicsKind, Structure};
use sprag_shared::taylor::Taylor;
use sprag_sim_host::batch::case::{Case, CaseResult, PulseShape, TERMS, TIGHT};
use sprag_sim_host::outcome::Outcome;
use sprag_tests::{
    DEVICES, Dice, FullLog, GEOMETRIES, Log, Segment, Start, boundary, follow, relative, release, shake, tight, unit_block,
};

/// Cases of all kinds, the same on every machine.
fn cases(count: usize) -> Vec<Case> {
    let mut dice = Dice(77);
    (0..count)
        .map(|index| Case {
            geometry: GEOMETRIES[index % 2],
            slenderness: dice.between(3.0, 30.0).to_radians(),
            device: DEVICES[index % 3],
            mass_ratio: dice.between(0.05, 1.5),
            restitution: dice.between(0.4, 0.95),
            pulse: if index % 4 < 2 { PulseShape::Sine } else { PulseShape::Cosine },
            frequency_ratio: dice.between(0.8, 8.0),
            amplitude_ratio: dice.between(1.05, 6.0),
            ..Case::default()
        })
        .collect()
}

fn run(case: &Case, tolerance: f64) -> CaseResult {
    case.run(&Taylor::<f64, TERMS>::adaptive(tolerance)).expect("a case that can be run")
}

/// The same outcome, the same impacts, the same end to a millionth.
fn same(a: &CaseResult, b: &CaseResult, case: &Case) {
    assert_eq!((a.outcome, a.impacts), (b.outcome, b.impacts), "{case:?}");
    assert!(relative(a.end_time, b.end_time) < 1e-6, "{} and {}: {case:?}", a.end_time, b.end_time);
}

/// The order of events and where the block is between them.
fn sane<const EVERY: bool>(log: &Log<f64, EVERY>) {
    assert!(log.events.is_sorted_by(|a, b| a.time <= b.time), "time runs forward");
    for stretch in &log.stretches {
        for motion in &stretch.motions {
            assert!(stretch.side.times(motion.rotation) >= -1e-14, "through the floor: {motion:?} on {:?}", stretch.side);
        }
    }
    assert!(log.events.len() < 20_000, "{} events", log.events.len());
}

#[test]
fn the_rest_threshold_does_not_show() {
    for case in cases(240) {
        let reference = run(&case, TIGHT);
        for factor in [0.1, 10.0, 100.0] {
            same(&reference, &run(&Case { rest_speed: case.rest_speed * factor, ..case }, TIGHT), &case);
        }
    }
    // Nor where every swing is followed.
    for (index, case) in cases(60).into_iter().enumerate() {
        let ends = [1e-8, 1e-6, 1e-5, 1e-4].map(|rest_speed| {
            let structure = Case { rest_speed, ..case }.structure().expect("a structure");
            let (level, duration) = pulse_of(&case, &structure);
            let (state, log) = shake(&structure, &[Segment::sine(level, case.frequency_ratio, duration), Segment::quiet(60.0)]);
            (state.phase, state.impacts, log.peaks.ended)
        });
        for end in ends {
            assert_eq!((end.0, end.1), (ends[0].0, ends[0].1), "case {index}");
            match (end.2, ends[0].2) {
                (Some(a), Some(b)) => assert!(relative(a, b) < 1e-6, "case {index}: rest at {a} and {b}"),
                (a, b) => assert_eq!(a, b),
            }
        }
    }
}

/// Level (g) and duration of a case's pulse.
fn pulse_of(case: &Case, structure: &Structure) -> (f64, f64) {
    (case.amplitude_ratio * case.geometry.uplift_threshold(&structure.block), TAU / case.frequency_ratio)
}

#[test]
fn the_tolerance_and_the_order_do_not_show() {
    fn by<const N: usize>(case: &Case, tolerance: f64) -> (State<f64>, Option<f64>) {
        let structure = case.structure().expect("a structure");
        let (level, duration) = pulse_of(case, &structure);
        let segments = [Segment::sine(level, case.frequency_ratio, duration), Segment::quiet(60.0)];
        let mut log = Log::<f64, false>::default();
        let method = Taylor::<f64, N>::adaptive(tolerance);
        let state = follow(&structure, &method, Start::Rest, &segments, &mut log).expect("a motion that can be followed");
        (state, log.peaks.ended)
    }
    for case in cases(240) {
        let reference = run(&case, TIGHT);
        for tolerance in [1e-17, 1e-14, 1e-12] {
            same(&reference, &run(&case, tolerance), &case);
        }
        let (state, ended) = by::<20>(&case, 1e-16);
        for (other, other_ended) in [
            by::<10>(&case, 1e-15),
            by::<12>(&case, 1e-15),
            by::<16>(&case, 1e-15),
            by::<28>(&case, 1e-15),
            by::<32>(&case, 1e-15),
        ] {
            assert_eq!((other.phase, other.impacts), (state.phase, state.impacts), "{case:?}");
            assert_eq!(other_ended.is_some(), ended.is_some());
            if let (Some(a), Some(b)) = (other_ended, ended) {
                assert!(relative(a, b) < 1e-6, "{a} and {b}: {case:?}");
            }
        }
    }
}

#[test]
fn the_free_time_does_not_show() {
    let mut shorter_runs = 0;
    for case in cases(240) {
        let reference = run(&case, TIGHT);
        same(&reference, &run(&Case { free_time: 600.0, ..case }, TIGHT), &case);
        for free_time in [30.0, 20.0] {
            // Shorter, but long enough for the end.
            if reference.end_time < TAU / case.frequency_ratio + free_time {
                same(&reference, &run(&Case { free_time, ..case }, TIGHT), &case);
                shorter_runs += 1;
            }
        }
    }
    assert!(shorter_runs > 240);
}

#[test]
fn the_closed_form_tail_agrees_with_every_swing() {
    let mut compared = 0;
    for geometry in GEOMETRIES {
        for device in DEVICES {
            for degrees in [3.0, 10.0, 20.0, 40.0] {
                for restitution in [0.3, 0.7, 0.85, 0.95, 0.99] {
                    for start in [0.05, 0.4, 0.9, 0.999] {
                        let structure = unit_block(geometry, degrees, device, 0.5, restitution);
                        let alpha = structure.block.slenderness();
                        let segments = [Segment::quiet(2000.0)];
                        let mut summed = Log::<f64, false>::default();
                        let release_at = Start::Released(start * alpha, 0.0);
                        let sum = follow(&structure, &tight(), release_at, &segments, &mut summed).expect("a sum");
                        let mut swung = FullLog::default();
                        let swing = release(&structure, start * alpha, 0.0, 2000.0, &mut swung);
                        assert_eq!((summed.decays, swung.decays), (1, 0), "one of the two is summed");
                        assert_eq!((sum.phase, swing.phase), (Phase::Rest, Phase::Rest));
                        assert_eq!(
                            sum.impacts, swing.impacts,
                            "{geometry:?} {device:?} {degrees}° η = {restitution} from {start}"
                        );
                        let (a, b) = (summed.peaks.ended.expect("rest"), swung.peaks.ended.expect("rest"));
                        assert!(relative(a, b) < 1e-9, "{geometry:?} {device:?} {degrees}° η = {restitution}: {a} and {b}");
                        assert!(relative(summed.peaks.rotation, swung.peaks.rotation) < 1e-12);
                        assert!(relative(summed.peaks.acceleration, swung.peaks.acceleration) < 1e-12);
                        compared += 1;
                    }
                }
            }
        }
    }
    assert_eq!(compared, 480);
}

/// The peaks of a motion whose largest swing is in the part that is summed: an impulse from rest on a moving ground.
#[test]
fn the_closed_form_tail_has_the_peaks_of_its_swings() {
    for geometry in GEOMETRIES {
        for device in DEVICES {
            for degrees in [5.0, 25.0] {
                let structure = unit_block(geometry, degrees, device, 0.7, 0.9);
                let alpha = structure.block.slenderness();
                for (speed, ground) in [(0.3, 0.0), (0.6, 0.4), (0.1, -0.5)] {
                    // A swing inward that ends in an impact, harder than any before it, and then the ground stops.
                    let segments = [Segment::constant(ground * alpha, 0.05), Segment::quiet(500.0)];
                    let start = Start::Released(0.02 * alpha, -speed * alpha);
                    let mut summed = Log::<f64, false>::default();
                    follow(&structure, &tight(), start, &segments, &mut summed).expect("a sum");
                    let mut swung = FullLog::default();
                    follow(&structure, &tight(), start, &segments, &mut swung).expect("swings");
                    assert!(summed.decays == 1);
                    let (a, b) = (summed.peaks, swung.peaks);
                    assert!(relative(a.rotation, b.rotation) < 1e-12, "{geometry:?} {device:?}: {a:?} {b:?}");
                    assert!(relative(a.acceleration, b.acceleration) < 1e-12, "{geometry:?} {device:?}: {a:?} {b:?}");
                    assert!(relative(a.ended.expect("rest"), b.ended.expect("rest")) < 1e-9);
                }
            }
        }
    }
}

/// Under a constant push c (in gα) below uplift, a slender block's swing on side s that starts with v (in pα) lasts
/// 2 atanh(v/r) with r = 1 + s c; infinitely many of them end in rest.
#[test]
fn accumulating_impacts_end_in_rest_at_their_closed_form() {
    for device in DEVICES {
        for push in [0.0, 0.3, -0.3, 0.9, -0.99] {
            for restitution in [0.0, 0.3, 0.85, 0.98] {
                for speed in [0.004, 1e-5] {
                    let structure = unit_block(Geometry::Slender, 9.0, device, 0.5, restitution);
                    let alpha = structure.block.slenderness();
                    let (rise, fall, per_swing) = match device {
                        DeviceKind::None => (1.0, 1.0, 1.0),
                        DeviceKind::Inerter => (square_root(1.375), square_root(1.375), 1.0),
                        DeviceKind::ClutchedPair => (1.0, square_root(1.375), 1.0 / square_root(1.375)),
                    };
                    let (mut exact, mut outgoing, mut side) = (0.0, speed, 1.0);
                    let mut impacts = 0;
                    while outgoing > 1e-18 {
                        let rate = 1.0 + side * push;
                        // Energy: v² = ((1−φ₀)² …) with p_σ of the equation in force.
                        exact += rise * atanh(outgoing * rise / rate) + fall * atanh(outgoing * rise / rate);
                        let incoming = outgoing * per_swing;
                        if incoming >= 1e-6 {
                            impacts += 1;
                        }
                        outgoing = incoming * restitution;
                        side = -side;
                    }
                    for constant in [true, false] {
                        // Constant, or far too slow a sine to tell.
                        let segment = if constant {
                            Segment::constant(push * alpha, 300.0)
                        } else {
                            Segment {
                                ground: sprag_tests::Ground::Line(sprag_shared::ground::Linear {
                                    start: push * alpha,
                                    slope: 1e-13 * alpha,
                                }),
                                duration: 300.0,
                            }
                        };
                        let mut log = FullLog::sampling(3);
                        let state = follow(&structure, &tight(), Start::Released(0.0, speed * alpha), &[segment], &mut log)
                            .expect("a motion that can be followed");
                        sane(&log);
                        assert_eq!(state.phase, Phase::Rest, "{device:?}, push {push}, η = {restitution}");
                        let ended = log.peaks.ended.expect("rest");
                        assert!(
                            relative(ended, exact) < 1e-9,
                            "{device:?}, push {push}, η = {restitution}: {ended}, exact {exact}"
                        );
                        assert_eq!(state.impacts, impacts, "{device:?}, push {push}, η = {restitution}");
                        assert_eq!((state.rotation, state.velocity), (0.0, 0.0));
                    }
                }
            }
        }
    }
}

#[test]
fn impacts_under_a_weak_sine_end_in_rest() {
    for geometry in GEOMETRIES {
        for device in DEVICES {
            // Faster and stronger, a sine below uplift can keep a rocking block going.
            for (level, frequency) in [(0.2, 3.0), (0.5, 1.0), (0.9, 0.3)] {
                let ends = [1e-7, 1e-6, 1e-5].map(|rest_speed| {
                    let structure = Structure { rest_speed, ..unit_block(geometry, 12.0, device, 0.5, 0.8) };
                    let uplift = geometry.uplift_threshold(&structure.block);
                    let segments = [Segment::sine(level * uplift, frequency, 200.0)];
                    let mut log = FullLog::sampling(3);
                    let start = Start::Released(0.03 * structure.block.slenderness(), 0.0);
                    let state = follow(&structure, &tight(), start, &segments, &mut log).expect("a motion that can be followed");
                    sane(&log);
                    assert_eq!(state.phase, Phase::Rest, "{geometry:?} {device:?} {level} {frequency} {rest_speed}: {state:?}");
                    assert_eq!(log.times(Event::Rest).len(), 1);
                    assert!(log.times(Event::Uplift).is_empty());
                    (state.impacts, log.peaks.ended.expect("rest"))
                });
                for end in ends {
                    assert_eq!(end.0, ends[0].0);
                    assert!(relative(end.1, ends[0].1) < 1e-6, "{geometry:?} {device:?}: rest at {} and {}", end.1, ends[0].1);
                }
            }
        }
    }
}

/// Twenty cycles above uplift: rest and uplift take turns, and each uplift is where the sine crosses the threshold.
#[test]
fn rest_and_uplift_take_turns() {
    for device in DEVICES {
        let structure = unit_block(Geometry::Full, 15.0, device, 0.5, 0.1);
        let uplift = Geometry::Full.uplift_threshold(&structure.block);
        let (ratio, frequency) = (1.2, 3.0);
        let mut log = FullLog::sampling(3);
        let segments = [Segment::sine(ratio * uplift, frequency, 20.0 * TAU / frequency)];
        follow(&structure, &tight(), Start::Rest, &segments, &mut log).expect("a motion that can be followed");
        sane(&log);
        let (uplifts, rests) = (log.times(Event::Uplift), log.times(Event::Rest));
        assert_eq!(uplifts.len(), 40, "{device:?}: one uplift each half cycle");
        for (n, (up, down)) in uplifts.iter().zip(&rests).enumerate() {
            let exact = (asin(1.0 / ratio) + PI * n as f64) / frequency;
            assert!((up - exact).abs() < 1e-13, "{device:?}: uplift {n} at {up}, exact {exact}");
            assert!(up < down && *down < (PI * (n + 1) as f64 + asin(1.0 / ratio)) / frequency);
        }
    }
}

#[test]
fn without_restitution_the_first_impact_is_the_end() {
    for geometry in GEOMETRIES {
        for device in DEVICES {
            let structure = unit_block(geometry, 10.0, device, 0.5, 0.0);
            let alpha = structure.block.slenderness();
            let mut log = FullLog::default();
            let state = release(&structure, 0.6 * alpha, 0.0, 50.0, &mut log);
            assert_eq!((state.phase, state.impacts), (Phase::Rest, 1));
            assert_eq!(log.times(Event::Rest), log.times(Event::Impact));
            let mut summed = Log::<f64, false>::default();
            let start = Start::Released(0.6 * alpha, 0.0);
            let sum = follow(&structure, &tight(), start, &[Segment::quiet(50.0)], &mut summed).expect("a motion");
            assert_eq!((sum.phase, sum.impacts), (Phase::Rest, 1));
            assert_eq!(summed.peaks.ended, log.peaks.ended);
        }
    }
}

/// An impact that stops the block while the ground pushes harder than the weight holds: it must leave again at once, to the
/// side to which it is pushed.
#[test]
fn a_stopped_block_leaves_with_the_push() {
    for geometry in GEOMETRIES {
        for device in DEVICES {
            for restitution in [0.0, 1e-12, 1e-3, 0.3, 1.0] {
                for (push, towards) in [(-1.5, 1.0), (1.5, -1.0)] {
                    let structure = unit_block(geometry, 10.0, device, 0.5, restitution);
                    let alpha = structure.block.slenderness();
                    let level = push * geometry.uplift_threshold(&structure.block);
                    // Inward, from the positive side.
                    let start = Start::Released(0.01 * alpha, -0.5 * alpha);
                    let mut log = FullLog::sampling(3);
                    let state = follow(&structure, &tight(), start, &[Segment::constant(level, 1.0)], &mut log)
                        .unwrap_or_else(|stopped| panic!("{stopped}: {geometry:?} {device:?} η = {restitution} push {push}"));
                    sane(&log);
                    assert_eq!(state.phase, Phase::Rocking);
                    assert!(
                        state.rotation * towards > 0.05 * alpha,
                        "{geometry:?} {device:?} η = {restitution}, push {push}: ends at {} α",
                        state.rotation / alpha
                    );
                }
            }
        }
    }
}

#[test]
fn with_full_restitution_free_rocking_goes_on() {
    for geometry in GEOMETRIES {
        for device in [DeviceKind::None, DeviceKind::Inerter] {
            for start in [1e-3, 0.3, 0.9] {
                let structure = unit_block(geometry, 10.0, device, 0.5, 1.0);
                let alpha = structure.block.slenderness();
                let mut log = FullLog::sampling(3);
                let state = release(&structure, start * alpha, 0.0, 60.0, &mut log);
                sane(&log);
                assert_eq!(state.phase, Phase::Rocking);
                for turn in log.states(Event::Turn) {
                    assert!(relative(turn.rotation.abs(), start * alpha) < 1e-10, "{geometry:?} {device:?}: {turn:?}");
                }
                let mut other = Log::<f64, false>::default();
                let start = Start::Released(start * alpha, 0.0);
                let same = follow(&structure, &tight(), start, &[Segment::quiet(60.0)], &mut other).expect("a motion");
                // The whole swings of small ones are summed; what is left of them is the same motion.
                assert_eq!((same.phase, same.impacts, same.side), (state.phase, state.impacts, state.side));
                assert!((same.velocity - state.velocity).abs() < 1e-6 * alpha, "{geometry:?} {device:?} {start:?}");
            }
        }
    }
}

#[test]
fn the_unstable_equilibrium_and_its_neighbours() {
    for geometry in GEOMETRIES {
        for device in DEVICES {
            for side in [1.0, -1.0] {
                let structure = unit_block(geometry, 10.0, device, 0.5, 0.85);
                let alpha = structure.block.slenderness();
                let mut log = FullLog::default();
                let state = release(&structure, side * alpha, 0.0, 60.0, &mut log);
                assert_eq!((state.phase, state.rotation, state.velocity), (Phase::Rocking, side * alpha, 0.0), "it stands");
                for above in [1e-15, 1e-12, 1e-6] {
                    let state = release(&structure, side * alpha * (1.0 + above), 0.0, 60.0, &mut FullLog::default());
                    assert_eq!((state.phase, state.impacts), (Phase::Overturned, 0), "{geometry:?} {device:?} +{above}");
                }
                for below in [1e-15, 1e-12, 1e-6] {
                    let rotation = alpha * (1.0 - below);
                    let mut log = FullLog::default();
                    let state = release(&structure, side * rotation, 0.0, 80.0, &mut log);
                    assert_eq!(state.phase, Phase::Rest, "{geometry:?} {device:?} −{below}");
                    let impact = log.times(Event::Impact)[0];
                    if geometry == Geometry::Slender {
                        // It falls with p_σ while an inerter is engaged; α − θ is exact in floating point.
                        let slower = if device == DeviceKind::None { 1.0 } else { square_root(1.375) };
                        let exact = slower * acosh(alpha / (alpha - rotation));
                        // Rounding of θ during the first step away counts against α − θ.
                        let tolerance = 1e-12 * exact + 1e-3 * f64::EPSILON / below;
                        assert!((impact - exact).abs() < tolerance, "{device:?} −{below}: {impact}, exact {exact}");
                    } else {
                        // Slower than the slender block at its start, later not by much.
                        assert!(impact > 0.9 * acosh(1.0 / below) && impact < 2.0 * acosh(1.0 / below));
                    }
                }
            }
        }
    }
}

/// A block thrown back on its floor while the ground holds it up: with b > 1 the push in gα, φ̈ = φ − 1 + b, it just
/// touches at v² = (φ₀ − 1 + b)² − (b − 1)².
#[test]
fn a_grazing_impact() {
    for device in DEVICES {
        for (push, start) in [(1.5, 0.2), (1.01, 0.05), (4.0, 0.5)] {
            let structure = unit_block(Geometry::Slender, 10.0, device, 0.5, 0.85);
            let alpha = structure.block.slenderness();
            // Moving inward while pushed outward, then outward and pushed outward: the pair is released, then engaged.
            let inertia = |engaged: bool| if engaged { 1.375 } else { 1.0 };
            let inward = square_root(inertia(device == DeviceKind::Inerter));
            let outward = square_root(inertia(device != DeviceKind::None));
            let (a, b): (f64, f64) = (start - 1.0 + push, push - 1.0);
            let grazing = square_root((a * a - b * b) / (inward * inward));
            let touch = inward * acosh(a / b);
            let after = 0.5;
            let exact = b * (cosh(after / outward) - 1.0);
            let mut missed = 0;
            for offset in [-1e-6_f64, -1e-9, -1e-12, -1e-14, 0.0, 1e-14, 1e-12, 1e-9, 1e-6] {
                let mut log = FullLog::sampling(3);
                let throw = Start::Released(start * alpha, -grazing * (1.0 + offset) * alpha);
                let state = follow(&structure, &tight(), throw, &[Segment::constant(-push * alpha, touch + after)], &mut log)
                    .expect("a motion that can be followed");
                sane(&log);
                // A miss by δ in speed is a miss by √δ in time; an impact takes as much of it.
                let tolerance = 20.0 * square_root(offset.abs().max(1e-15)) / b;
                let found = state.rotation / alpha;
                assert!((found - exact).abs() < tolerance * exact.max(b), "{device:?} {push} {offset}: {found} for {exact}");
                assert!(log.times(Event::Impact).len() <= 2, "there and back");
                missed += usize::from(log.times(Event::Impact).is_empty());
                if offset >= 1e-9 {
                    assert_eq!(log.times(Event::Impact).len(), 2, "{device:?} {push} {offset}");
                }
                if offset <= -1e-9 {
                    assert!(log.times(Event::Impact).is_empty(), "{device:?} {push} {offset}");
                }
            }
            assert!((2..=7).contains(&missed));
        }
    }
}

#[test]
fn uplift_at_the_threshold_and_just_above() {
    for geometry in GEOMETRIES {
        for device in DEVICES {
            for pulse in [PulseShape::Sine, PulseShape::Cosine] {
                for frequency_ratio in [0.5, 1.0, 3.7, 40.0] {
                    let case = Case { geometry, device, pulse, frequency_ratio, ..Case::default() };
                    for sign in [1.0, -1.0] {
                        for still in [0.0, 0.5, 1.0 - 1e-12, 1.0] {
                            let result = run(&Case { amplitude_ratio: sign * still, ..case }, TIGHT);
                            assert_eq!((result.outcome, result.impacts), (Outcome::NoRocking, 0), "at {still}");
                            assert_eq!((result.peak_rotation, result.peak_acceleration), (0.0, 0.0));
                        }
                        for above in [1e-12, 1e-9, 1e-6] {
                            let result = run(&Case { amplitude_ratio: sign * (1.0 + above), ..case }, TIGHT);
                            assert_eq!(
                                result.outcome,
                                Outcome::Safe,
                                "{geometry:?} {device:?} {pulse:?} {frequency_ratio} +{above}"
                            );
                            assert!(result.peak_rotation > 0.0 && result.peak_rotation < 0.01 * above.max(1e-9), "{result:?}");
                        }
                    }
                }
            }
        }
    }
}

/// At uplift under a sine pulse θ, θ̇ and θ̈ are zero together. The first impact comes from the closed form
/// φ = 1 − β/(1+ω²) sin ωt + A e^τ + B e^{−τ}, and just above the threshold (β = 1 + ε) from φ ~ √(2ε) ωτ³/6 − ω²τ⁴/24.
#[test]
fn the_triple_root_at_uplift() {
    for device in [DeviceKind::None, DeviceKind::Inerter] {
        let inertia = if device == DeviceKind::None { 1.0 } else { 1.375 };
        let slower = square_root(inertia);
        for frequency in [0.7, 1.0, slower, 1.0 / slower, 2.0, 5.0, 9.0] {
            for ratio in [1.01, 1.1, 1.3, 1.8, 3.0, 4.0] {
                // In units of 1/p_σ.
                let omega = frequency * slower;
                let uplift = asin(1.0 / ratio) / omega;
                let part = ratio / (1.0 + omega * omega);
                let sum = -1.0 + part * sprag_shared::math::sin(omega * uplift);
                let difference = part * omega * cos(omega * uplift);
                let rotation = |t: f64| {
                    let tau = t - uplift;
                    1.0 - part * sprag_shared::math::sin(omega * t)
                        + 0.5 * (sum + difference) * exp(tau)
                        + 0.5 * (sum - difference) * exp(-tau)
                };
                let end = TAU / omega;
                let samples = 4000;
                let at = |k: usize| uplift + (end - uplift) * k as f64 / f64::from(samples);
                let first = (20..=samples as usize).find(|&k| rotation(at(k)) < 0.0);
                let structure = unit_block(Geometry::Slender, 10.0, device, 0.5, 0.85);
                let alpha = structure.block.slenderness();
                let (_, log) = shake(&structure, &[Segment::sine(ratio * alpha, frequency, TAU / frequency)]);
                let impacts = log.times(Event::Impact);
                assert!(relative(log.times(Event::Uplift)[0], uplift * slower) < 1e-14);
                match first {
                    None => assert!(impacts.is_empty(), "{device:?} ω/p = {frequency}, β = {ratio}: {impacts:?}"),
                    Some(k) => {
                        let exact = slower * boundary(at(k - 1), at(k), |t| rotation(t) < 0.0);
                        assert!(
                            relative(impacts[0], exact) < 1e-9,
                            "{device:?} ω/p = {frequency}, β = {ratio}: {} for {exact}",
                            impacts[0]
                        );
                    }
                }
            }
            for above in [1e-10_f64, 1e-8, 1e-6] {
                let structure = unit_block(Geometry::Slender, 10.0, device, 0.5, 0.85);
                let alpha = structure.block.slenderness();
                let (_, log) = shake(&structure, &[Segment::sine((1.0 + above) * alpha, frequency, TAU / frequency)]);
                let lasts = log.times(Event::Impact)[0] - log.times(Event::Uplift)[0];
                let exact = 4.0 * square_root(2.0 * above) / frequency;
                assert!(relative(lasts, exact) < 4.0 * square_root(above) + 1e-15 / above, "+{above}: {lasts} for {exact}");
            }
        }
    }
}

/// An impact, the end of a pulse and a clutch command at one instant, or as near as floating point has neighbours.
#[test]
fn events_at_one_instant() {
    for device in DEVICES {
        let structure = unit_block(Geometry::Slender, 10.0, device, 0.5, 0.85);
        let alpha = structure.block.slenderness();
        let slower = if device == DeviceKind::None { 1.0 } else { square_root(1.375) };
        let impact = slower * acosh(1.0 / 0.6);
        for push in [0.0, 0.5, -0.5, 1.7, -1.7] {
            let states: Vec<_> = (-4..=4)
                .map(|ulps| {
                    let at = impact * (1.0 + f64::from(ulps) * f64::EPSILON);
                    let segments = [Segment::quiet(at), Segment::constant(push * alpha, 0.15)];
                    let mut log = FullLog::sampling(3);
                    let start = Start::Released(0.4 * alpha, 0.0);
                    let state = follow(&structure, &tight(), start, &segments, &mut log).expect("a motion that can be followed");
                    sane(&log);
                    state
                })
                .collect();
            for state in &states {
                assert_eq!((state.phase, state.impacts, state.side), (states[0].phase, 1, Sign::Negative), "{device:?} {push}");
                assert!((state.rotation - states[0].rotation).abs() < 1e-14);
                assert!((state.velocity - states[0].velocity).abs() < 1e-14);
            }
            // Outward with η √(1 − 0.36) … of the speed it fell with, against or with the push.
            let fell = 0.8 / slower;
            let rate = 1.0 - push;
            let rises =
                if device == DeviceKind::Inerter || (device == DeviceKind::ClutchedPair && rate < 0.0) { slower } else { 1.0 };
            let (t, v) = (0.15 / rises, 0.85 * fell * rises);
            let exact = rate * (1.0 - cosh(t)) + v * sinh(t);
            assert!(relative(-states[4].rotation / alpha, exact) < 1e-12, "{device:?} {push}: {:?} for {exact}", states[4]);
        }
    }
}

/// Whatever the ground does, the work is bounded.
#[test]
fn wild_ground_motions_end() {
    let mut dice = Dice(5);
    for index in 0..600 {
        let geometry = GEOMETRIES[index % 2];
        let device = DEVICES[index % 3];
        let restitution = [0.0, 1e-9, 0.1, 0.5, 0.9, 0.99, 0.999][index % 7];
        let mut structure = unit_block(geometry, dice.between(1.0, 60.0), device, dice.between(0.0, 3.0), restitution);
        if index % 5 == 0 {
            structure.device.kinematics = KinematicsKind::Consistent;
        }
        let uplift = geometry.uplift_threshold(&structure.block);
        let mut last = 0.0;
        let segments: Vec<_> = (0..60)
            .map(|_| {
                // Levels that like to be the threshold itself, and lengths from nothing to long.
                let level = match (dice.roll() * 6.0) as u32 {
                    0 => 0.0,
                    1 => uplift,
                    2 => -uplift,
                    3 => uplift * (1.0 + 1e-15),
                    _ => uplift * dice.between(-2.0, 2.0),
                };
                let duration = [1e-12, 1e-6, 1e-3, 0.05, 0.3][(dice.roll() * 5.0) as usize];
                let segment = match (dice.roll() * 4.0) as u32 {
                    0 => Segment::constant(level, duration),
                    1 => Segment::sine(level, dice.between(0.5, 60.0), duration),
                    2 => Segment::quiet(duration),
                    _ => Segment::line(last, level, duration),
                };
                last = level;
                segment
            })
            .chain([Segment::quiet(3.0)])
            .collect();
        let mut log = FullLog::sampling(2);
        follow(&structure, &tight(), Start::Rest, &segments, &mut log)
            .unwrap_or_else(|stopped| panic!("{stopped} in motion {index}: {structure:?}"));
        sane(&log);
    }
}

/// A block without loss at impacts never dies: large motions have their whole swings summed, and those too weak to matter end
/// in rest, so that every case has its result.
#[test]
fn a_motion_that_never_dies_has_a_result() {
    let method = Taylor::<f64, TERMS>::adaptive(TIGHT);
    for (restitution, device) in [(1.0, DeviceKind::None), (1.0, DeviceKind::Inerter), (0.999_999_9, DeviceKind::None)] {
        for (excess, rests) in [(1e-6, true), (0.05, false)] {
            let case = Case { restitution, device, amplitude_ratio: 1.0 + excess, ..Case::default() };
            let result = case.run(&method).unwrap_or_else(|error| panic!("{error}: η = {restitution}, {device:?}, {excess}"));
            assert_eq!(result.outcome, Outcome::Safe);
            let end = TAU / case.frequency_ratio + case.free_time;
            assert_eq!(result.end_time < end - 1e-9, rests, "η = {restitution}, {device:?}, {excess}: {}", result.end_time);
        }
    }
}
