//! Two things at one instant: grazing impacts, a turn where the bracket is zero, impacts on the kinks of a record, events closer
//! than 10⁻¹⁵ s.

use core::f64::consts::TAU;

use sprag_shared::math::{acosh, cosh, exp, sinh, square_root};
use sprag_shared::motion::observer::Event;
use sprag_shared::motion::state::Phase;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_stability::{Log, Precision, Segment, Start, Stepping, Tally, in_both_precisions, sane, unit_block};

in_both_precisions!(
    a_grazing_impact,
    velocity_and_bracket_zero_at_one_instant,
    an_impact_on_a_kink_of_the_record,
    a_cut_at_every_event,
);

fn recorded<S: Precision>(structure: &Structure, start: Start<S>, segments: &[Segment<S>]) -> Log<S, true> {
    let mut log = Log::sampling(2);
    S::record(structure, Stepping::Tight, start, segments, &mut log).unwrap_or_else(|stopped| panic!("{stopped}: {structure:?}"));
    sane(&log);
    log
}

/// Thrown back on its floor while the ground holds it up: with b > 1 the push in gα, φ̈ = φ − 1 + b, the block just touches at
/// v² = (φ₀ − 1 + b)² − (b − 1)². Missed or hit by an ulp, it continues from there the same way.
fn a_grazing_impact<S: Precision>() {
    for device in DeviceKind::ALL {
        for (push, start) in [(1.5, 0.2), (1.01, 0.05), (4.0, 0.5)] {
            let structure = unit_block(Geometry::Slender, 10.0, device, 0.5, 0.85);
            let alpha = structure.block.slenderness();
            let slow = square_root(1.375);
            // Inward under an outward push the pair is released, then outward engaged.
            let inward = if device == DeviceKind::Inerter { slow } else { 1.0 };
            let outward = if device == DeviceKind::None { 1.0 } else { slow };
            let (a, b): (f64, f64) = (start - 1.0 + push, push - 1.0);
            let grazing = square_root(a * a - b * b) / inward;
            let touch = inward * acosh(a / b);
            let exact = b * (cosh(0.5 / outward) - 1.0);
            let least = S::tolerance(1e-15, 1e-7);
            for ulps in [-1e9_f64, -1e6, -1e3, -10.0, -1.0, 0.0, 1.0, 10.0, 1e3, 1e6, 1e9] {
                if ulps.abs() * least > 1e-3 {
                    continue;
                }
                let throw = Start::Released(S::of(start * alpha), S::of(-grazing * alpha) * S::of(1.0 + ulps * least));
                let segments = [Segment::constant(S::of(-push * alpha), S::of(touch + 0.5))];
                let run = S::tally(&structure, Stepping::Tight, throw, &segments, Tally::new());
                run.tally.assert_sane(300, 300);
                let impacts = run.tally.count(Event::Impact);
                assert!(impacts <= 2, "there and back: {impacts}");
                let sharp = ulps.abs() >= 1e3;
                assert!(!sharp || impacts == if ulps > 0.0 { 2 } else { 0 }, "{} {device:?} {push} {ulps}: {impacts}", S::NAME);
                // A miss by δ in speed is a miss by √δ in time.
                let tolerance = S::tolerance(20.0, 30.0) * square_root((ulps.abs() + 10.0) * least) / b;
                let found = run.end().rotation.to_f64() / alpha;
                assert!(
                    (found - exact).abs() < tolerance * exact.max(b),
                    "{} {device:?} {push} {ulps}: {found} for {exact}",
                    S::NAME
                );
            }
        }
    }
}

/// φ̈ = φ − 1 + b₀ + b₁ τ with φ = 1 − b₀ − b₁ τ + b₁ sinh(τ − t): at τ = t both θ̇ and θ̈ are zero and θ̈ changes sign, so that θ̇
/// touches zero and does not change its own. For a pair that is where the clutch engages.
fn velocity_and_bracket_zero_at_one_instant<S: Precision>() {
    for device in DeviceKind::ALL {
        for (slope, level) in [(0.4, 0.35), (0.2, 0.5), (1.0, 0.1)] {
            let structure = unit_block(Geometry::Slender, 10.0, device, 0.5, 0.85);
            let alpha = structure.block.slenderness();
            let slow = square_root(1.375);
            let before = if device == DeviceKind::Inerter { slow } else { 1.0 };
            let after = if device == DeviceKind::None { 1.0 } else { slow };
            // In each unit of time the line has its own slope.
            let instant: f64 = 0.8;
            let (b1, t) = (slope * before, instant / before);
            let at = |tau: f64| (1.0 - level - b1 * tau + b1 * sinh(tau - t), -b1 + b1 * cosh(tau - t));
            let (rotation, velocity) = at(0.0);
            let b2 = slope * after;
            let (later, late) = (0.7, 0.7 / after);
            // From φ = 1 − b₀ − b₁t with φ̇ = φ̈ = 0.
            let exact = (1.0 - level - slope * instant - b2 * late + b2 * sinh(late), b2 * (cosh(late) - 1.0));
            assert!(rotation > 0.0 && velocity > 0.0 && exp(t) > 0.0);
            let ground =
                Segment::line(S::of(-level * alpha), S::of((-level - slope * (instant + later)) * alpha), S::of(instant + later));
            for ulps in [-1000.0_f64, -3.0, 0.0, 3.0, 1000.0] {
                let nudge = 1.0 + ulps * S::EPSILON.to_f64();
                let start = Start::Released(S::of(rotation * alpha), S::of(velocity / before * alpha * nudge));
                let run = S::tally(&structure, Stepping::Tight, start, &[ground], Tally::new());
                run.tally.assert_sane(200, 60);
                assert_eq!(run.tally.count(Event::Impact), 0);
                assert!(run.tally.count(Event::Turn) <= 2, "{} {device:?}: {:?}", S::NAME, run.tally);
                let end = run.end();
                // θ̇ = ½ b₁ (τ − t)²: nudged by δ it is zero √(2δ/b₁) from the instant, where the clutch may switch.
                let tolerance = 40.0 * (ulps.abs() + 10.0) * S::EPSILON.to_f64();
                let found = (end.rotation.to_f64() / alpha, end.velocity.to_f64() / alpha * after);
                assert!(
                    (found.0 - exact.0).abs() < tolerance && (found.1 - exact.1).abs() < tolerance,
                    "{} {device:?} {ulps}: {found:?} for {exact:?}",
                    S::NAME
                );
            }
        }
    }
}

/// A record that changes level, or slope, at the very instant of an impact, an ulp before it, and an ulp after it.
fn an_impact_on_a_kink_of_the_record<S: Precision>() {
    for geometry in [Geometry::Full, Geometry::Slender] {
        for device in DeviceKind::ALL {
            let mut structure = unit_block(geometry, 10.0, device, 0.5, 0.85);
            structure.device.kinematics = KinematicsKind::Consistent;
            let alpha = structure.block.slenderness();
            let start = Start::Released(S::of(0.4 * alpha), S::ZERO);
            let zero = Segment::constant(S::ZERO, S::of(3.0));
            let instant = recorded(&structure, start, &[zero]).times(Event::Impact)[0];
            for (level, slope) in [(0.6, 0.0), (-0.6, 0.0), (0.0, 0.9), (0.0, -0.9)] {
                let mut ends = Vec::new();
                for cut in [instant.down(), instant, instant.up(), instant + S::of(1e-15)] {
                    let rest = S::of(1.5) - cut;
                    let second = Segment::line(S::of(level * alpha), S::of(level * alpha) + S::of(slope * alpha) * rest, rest);
                    let segments = [Segment::constant(S::ZERO, cut), second];
                    let run = S::tally(&structure, Stepping::Tight, start, &segments, Tally::new());
                    run.tally.assert_sane(100, 20);
                    ends.push((run.tally.count(Event::Impact), run.end()));
                }
                for (impacts, end) in &ends {
                    let (reference_impacts, reference) = &ends[1];
                    assert_eq!(
                        (impacts, end.phase),
                        (reference_impacts, Phase::Rocking),
                        "{} {geometry:?} {device:?} {level} {slope}",
                        S::NAME
                    );
                    let tolerance = S::tolerance(1e-13, 2e-5) * alpha;
                    assert!(
                        (end.rotation - reference.rotation).abs().to_f64() < tolerance,
                        "{} {geometry:?} {device:?} {level} {slope}: {ends:?}",
                        S::NAME
                    );
                    assert!(
                        (end.velocity - reference.velocity).abs().to_f64() < tolerance,
                        "{} {geometry:?} {device:?} {level} {slope}: {ends:?}",
                        S::NAME
                    );
                }
            }
        }
    }
}

/// One motion, cut in two at each of its events, an ulp before it and an ulp after it, and 10⁻¹⁵ s after it: each event is reported once,
/// and the motion is the same.
fn a_cut_at_every_event<S: Precision>() {
    let mut cuts = 0;
    for geometry in [Geometry::Full, Geometry::Slender] {
        for device in DeviceKind::ALL {
            let mut structure = unit_block(geometry, 12.0, device, 0.5, 0.85);
            structure.device.kinematics = KinematicsKind::Consistent;
            let level = S::of(1.5 * geometry.uplift_threshold(structure.block.slenderness()));
            let (frequency, duration) = (S::of(4.0), S::of(1.25 * TAU / 4.0));
            let whole = recorded(&structure, Start::Rest, &[Segment::sine(level, frequency, duration)]);
            let end = whole.stretches.last().expect("a stretch").motions.last().copied().expect("a motion");
            for event in &whole.events {
                for cut in [event.time.down(), event.time, event.time.up(), event.time + S::of(1e-15)] {
                    let segments = [
                        Segment::sine(level, frequency, cut),
                        Segment::sine_from(level, frequency, frequency * cut, duration - cut),
                    ];
                    let parts = recorded(&structure, Start::Rest, &segments);
                    let kinds = |log: &Log<S, true>| {
                        // Not those that rounding may move across the end.
                        let events = log.events.iter().take_while(|logged| logged.time < duration * S::of(0.9));
                        events.map(|logged| logged.event).collect::<Vec<_>>()
                    };
                    assert_eq!(kinds(&parts), kinds(&whole), "{} {geometry:?} {device:?} cut at {cut:?}", S::NAME);
                    let after = parts.stretches.last().expect("a stretch").motions.last().copied().expect("a motion");
                    let off = (after.rotation - end.rotation).abs().to_f64() / structure.block.slenderness();
                    assert!(
                        off < S::tolerance(1e-12, 2e-4),
                        "{} {geometry:?} {device:?} cut at {cut:?}: off by {off:e}",
                        S::NAME
                    );
                    cuts += 1;
                }
            }
        }
    }
    assert!(cuts > 100, "{cuts}");
}
