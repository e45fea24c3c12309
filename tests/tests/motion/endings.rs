//! How motions end: in rest, overturned or undecided, and never in an endless loop. What decides when to stop must not
//! show in a result.

use core::f64::consts::{PI, TAU};

use sprag_loops::{Method, Precision};
use sprag_shared::math::{asin, atanh, sin_cos, square_root};
use sprag_shared::method::taylor::Taylor;
use sprag_shared::motion::observer::Event;
use sprag_shared::motion::state::{BlockState, Phase};
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_sim::batch::case::{Case, CaseResult, PulseShape, TIGHT};
use sprag_sim::batch::lanes::in_lanes;
use sprag_tests::scene_text::{IDEAL_DEVICES, RIGID_PAIR, runs};
use sprag_tests::{Dice, FullLog, GEOMETRIES, Log, Segment, Start, follow, relative, release, sane, shake, tight, unit_block};

/// Cases of all kinds, the same on every machine.
fn cases(count: usize) -> Vec<Case> {
    let mut dice = Dice(77);
    (0..count)
        .map(|index| Case {
            geometry: GEOMETRIES[index % 2],
            slenderness: dice.between(3.0, 30.0).to_radians(),
            device: DeviceKind::ALL[index % 3],
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
    case.run(&*f64::ideal(Method::Adaptive(tolerance))).expect("a case that can be run")
}

/// The same outcome, the same impacts, the same end to a millionth.
fn same(a: &CaseResult, b: &CaseResult, case: &Case) {
    assert_eq!((a.outcome, a.impacts), (b.outcome, b.impacts), "{case:?}");
    assert!(relative(a.end_time, b.end_time) < 1e-6, "{} and {}: {case:?}", a.end_time, b.end_time);
}

/// A block that hardly rocks bounces on both toes until it rests: inward on the toe that the ground pushes it on, at p² (1 + a) sin α/(1 + kℓ²).
#[test]
fn the_rest_threshold_does_not_show_in_bounces() {
    let (alpha, amplitude_ratio) = (10.0_f64.to_radians(), 1.000_05);
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            let of = |rest_speed: f64| Case {
                geometry,
                device,
                slenderness: alpha,
                mass_ratio: 0.5,
                restitution: 0.85,
                pulse: PulseShape::Sine,
                frequency_ratio: 4.0,
                amplitude_ratio,
                rest_speed,
                ..Case::default()
            };
            let (sin, cos) = if geometry == Geometry::Full { sin_cos(alpha) } else { (alpha, 1.0) };
            let carried = if device == DeviceKind::Inerter { 0.5 / (4.0 / 3.0) * cos * cos } else { 0.0 };
            let bound = (1.0 + amplitude_ratio) * sin / alpha / (1.0 + carried);
            let followed = [1e-3, 1e-4, 1e-6, 1e-9].map(|rest_speed| run(&of(rest_speed), TIGHT));
            let in_lanes = in_lanes(&[of(Case::default().rest_speed)]).remove(0);
            for result in followed.into_iter().chain(in_lanes) {
                assert_eq!(result.outcome, Outcome::Safe);
                let peak = result.peak_acceleration;
                assert!(peak <= bound && relative(peak, bound) < 5e-3, "{geometry:?} {device:?}: {peak} of {bound}");
            }
        }
    }
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
    (case.amplitude_ratio * case.geometry.uplift_threshold(structure.block.slenderness()), TAU / case.frequency_ratio)
}

#[test]
fn the_tolerance_and_the_order_do_not_show() {
    fn by<const N: usize>(case: &Case, tolerance: f64) -> (BlockState<f64>, Option<f64>) {
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
        for device in DeviceKind::ALL {
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
        for device in DeviceKind::ALL {
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
    for device in DeviceKind::ALL {
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
                        // Constant, or far too slow a sine to see.
                        let segment = if constant {
                            Segment::constant(push * alpha, 300.0)
                        } else {
                            Segment {
                                ground: sprag_shared::ground::AnySegment::Linear(sprag_shared::ground::Linear {
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
        for device in DeviceKind::ALL {
            // Faster and stronger, a sine below uplift can keep a rocking block going.
            for (level, frequency) in [(0.2, 3.0), (0.5, 1.0), (0.9, 0.3)] {
                let ends = [1e-7, 1e-6, 1e-5].map(|rest_speed| {
                    let structure = Structure { rest_speed, ..unit_block(geometry, 12.0, device, 0.5, 0.8) };
                    let uplift = geometry.uplift_threshold(structure.block.slenderness());
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
    for device in DeviceKind::ALL {
        let structure = unit_block(Geometry::Full, 15.0, device, 0.5, 0.1);
        let uplift = Geometry::Full.uplift_threshold(structure.block.slenderness());
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
fn with_full_restitution_free_rocking_continues() {
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

/// A block without loss at impacts never dies: large motions have their whole swings summed, and those too weak to matter end
/// in rest, so that every case has its result.
#[test]
fn a_motion_that_never_dies_has_a_result() {
    let method = f64::ideal(Method::Adaptive(TIGHT));
    for (restitution, device) in [(1.0, DeviceKind::None), (1.0, DeviceKind::Inerter), (0.999_999_9, DeviceKind::None)] {
        for (excess, rests) in [(1e-6, true), (0.05, false)] {
            let case = Case { restitution, device, amplitude_ratio: 1.0 + excess, ..Case::default() };
            let result = case.run(&*method).unwrap_or_else(|error| panic!("{error}: η = {restitution}, {device:?}, {excess}"));
            assert_eq!(result.outcome, Outcome::Safe);
            let end = TAU / case.frequency_ratio + case.free_time;
            assert_eq!(result.end_time < end - 1e-9, rests, "η = {restitution}, {device:?}, {excess}: {}", result.end_time);
        }
    }
}

/// A large block falls slowly: some 5 s after the ground has come to rest it is on its way.
const SLOW: &str = r#"
[block]
size_m = 6.0
slenderness_deg = 10.0
[[ground]]
motion = "sine"
amplitude_g = 0.45
frequency_hz = 0.35
"#;

#[test]
fn a_block_that_cannot_return_when_its_run_ends_has_overturned() {
    for (events, devices) in [("", format!("{IDEAL_DEVICES}{RIGID_PAIR}")), (STEP_ENDS, IDEAL_DEVICES.to_owned())] {
        let ends = |seconds: u32| runs(&format!("{SLOW}{devices}{events}[run]\nfree_time_s = {seconds}\n"));
        let (soon, late) = (ends(5), ends(60));
        assert!(late.iter().any(|run| run.end_time_s > 5.0 + 1.0 / 0.35), "some fall for longer");
        for (soon, late) in soon.iter().zip(&late) {
            assert_eq!(soon.outcome, late.outcome, "{} {events}", soon.device);
            assert!(soon.end_time_s <= late.end_time_s, "{}", soon.device);
        }
    }
}

/// The history has two rows wherever another flywheel is engaged from then on, at impacts too.
#[test]
fn clutch_switches_are_those_of_the_history() {
    let scene =
        "[block]\nsize_m = 2.0\nslenderness_deg = 10.0\n[[ground]]\nmotion = \"sine\"\namplitude_g = 0.4\nfrequency_hz = 1.0\n";
    for events in ["", STEP_ENDS] {
        // A sample a step.
        let devices = if events.is_empty() { format!("{IDEAL_DEVICES}{RIGID_PAIR}") } else { IDEAL_DEVICES.to_owned() };
        let runs = runs(&format!("{scene}{devices}{events}[output]\ninterval_s = 0.001\n"));
        for run in &runs {
            let engaged: Vec<u8> = run.history.samples.iter().map(|sample| sample.engaged).collect();
            let changes = engaged.windows(2).filter(|pair| pair[0] != pair[1]).count();
            assert_eq!(run.clutch_switches as usize, changes, "{} {events}", run.device);
            let pair = run.device.contains("pair");
            assert_eq!(changes > 0, pair, "{}", run.device);
            // A clutch that resists before an impact is released there.
            assert!(!pair || changes > 2 * run.impacts as usize, "{}: {changes} of {} impacts", run.device, run.impacts);
        }
    }
}

const STEP_ENDS: &str = "[accuracy]\nmethod = \"runge-kutta-4\"\nstep_s = 0.001\nevents = \"step-end\"\n";
