//! The instant of uplift: a push at the threshold to the last bit, beyond it for one sample, and θ, θ̇ and θ̈ all zero at once.

use core::f64::consts::TAU;

use sprag_shared::math::{asin, cos, cosh, exp, sin, square_root};
use sprag_shared::motion::observer::Event;
use sprag_shared::motion::state::Phase;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_stability::{
    Dice, GEOMETRIES, Log, Precision, Segment, Start, Stepping, Tally, in_both_precisions, relative, unit_block,
};

in_both_precisions!(
    a_push_at_the_threshold_moves_nothing,
    an_ulp_above_the_threshold_for_one_sample,
    an_ulp_above_the_threshold_for_good,
    a_push_that_only_touches_the_threshold,
    a_triple_root_at_uplift,
);

fn threshold<S: Precision>(structure: &Structure) -> S {
    S::of(structure.geometry.uplift_threshold(structure.block.slenderness()))
}

/// Both geometries, all devices, 60 slendernesses: what rounding makes of tan α cos α − sin α differs with every one.
fn structures() -> Vec<Structure> {
    let mut dice = Dice(1963);
    let mut list = Vec::new();
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            list.extend((0..60).map(|_| unit_block(geometry, dice.between(0.5, 50.0), device, 0.5, 0.85)));
        }
    }
    list
}

fn a_push_at_the_threshold_moves_nothing<S: Precision>() {
    for structure in structures() {
        for level in [threshold::<S>(&structure), -threshold::<S>(&structure)] {
            let interval = S::of(0.005);
            for segments in [
                vec![Segment::constant(level, S::of(100.0))],
                vec![Segment::line(S::ZERO, level, interval), Segment::line(level, S::ZERO, interval)],
                vec![Segment::sine(level, S::of(4.0), S::of(TAU / 4.0))],
                vec![Segment::cosine(level, S::of(4.0), S::of(TAU / 4.0))],
            ] {
                let run = S::tally(&structure, Stepping::Tight, Start::Rest, &segments, Tally::new());
                run.tally.assert_sane(0, 0);
                assert_eq!((run.end().phase, run.arcs), (Phase::Rest, 0), "{} {structure:?}", S::NAME);
            }
        }
    }
}

/// A record whose one sample, and a rectangular pulse of one interval, are an ulp beyond the threshold: the block stirs by less than
/// rounding can see of α and stands again within a few samples.
fn an_ulp_above_the_threshold_for_one_sample<S: Precision>() {
    let mut uplifts = 0;
    for structure in structures() {
        let alpha = structure.block.slenderness();
        for level in [threshold::<S>(&structure).up(), -threshold::<S>(&structure).up()] {
            let interval = S::of(0.005);
            let quiet = Segment::constant(S::ZERO, interval);
            for first in [
                vec![Segment::line(S::ZERO, level, interval), Segment::line(level, S::ZERO, interval)],
                vec![Segment::constant(level, interval)],
            ] {
                let segments: Vec<_> = first.into_iter().chain([quiet; 3]).collect();
                for stepping in [Stepping::Tight, Stepping::RungeKutta4(S::of(0.0005)), Stepping::SemiImplicitEuler(S::of(0.005))]
                {
                    let mut tally = Tally::new();
                    // The bound of the peak holds below the floor, too.
                    tally.floor = f64::INFINITY;
                    let run = S::tally(&structure, stepping, Start::Rest, &segments, tally);
                    run.tally.assert_sane(100, 100);
                    assert_eq!(run.end().phase, Phase::Rest, "{} {stepping:?} {structure:?}", S::NAME);
                    let peak = run.tally.peaks.rotation.to_f64().max(run.tally.reach);
                    let most = match stepping {
                        // Finds the floor to within the error of a step only.
                        Stepping::SemiImplicitEuler(step) => {
                            run.tally.peaks.acceleration.to_f64() * step.to_f64() * step.to_f64()
                        }
                        _ => 1e-4 * S::EPSILON.to_f64() * alpha.max(0.1),
                    };
                    assert!(peak <= most, "{} {stepping:?} {peak:e}", S::NAME);
                    uplifts += run.tally.count(Event::Uplift);
                }
            }
        }
    }
    assert!(uplifts > 100, "{uplifts}");
}

/// An ulp beyond the threshold that stays: θ̈ = p² times an ulp of the push or, where rounding of tan α and of the bracket take it,
/// nothing. The block moves to the right side if at all, and its work is bounded.
fn an_ulp_above_the_threshold_for_good<S: Precision>() {
    for structure in structures() {
        let alpha = structure.block.slenderness();
        for (level, towards) in [(threshold::<S>(&structure).up(), -1.0), (-threshold::<S>(&structure).up(), 1.0)] {
            for stepping in [Stepping::Tight, Stepping::RungeKutta4(S::of(0.02))] {
                let segments = [Segment::constant(level, S::of(2.0))];
                let run = S::tally(&structure, stepping, Start::Rest, &segments, Tally::new());
                run.tally.assert_sane(400, 400);
                let rotation = towards * run.end().rotation.to_f64();
                // φ = ε (cosh t − 1), ε an ulp or two.
                let most = 8.0 * S::EPSILON.to_f64() * alpha.max(0.1) * cosh(2.0) * (1.0 + sprag_shared::math::tan(alpha));
                assert!((-most * 1e-3..=most).contains(&rotation), "{} {stepping:?} {rotation:e} {structure:?}", S::NAME);
                if structure.geometry == Geometry::Slender {
                    assert!(rotation > 0.0, "{}: the bracket of a slender block is exact here: {structure:?}", S::NAME);
                }
            }
        }
    }
}

/// A sine whose crest is beyond the threshold by an ulp: the crossings lie together closer than the clock can resolve, or nearly so.
fn a_push_that_only_touches_the_threshold<S: Precision>() {
    for structure in structures() {
        for level in [threshold::<S>(&structure).up(), threshold::<S>(&structure) * S::of(1.0 + S::tolerance(1e-12, 1e-6))] {
            let segments = [Segment::sine(level, S::of(3.0), S::of(TAU / 3.0)), Segment::quiet(S::of(2.0))];
            let run = S::tally(&structure, Stepping::Tight, Start::Rest, &segments, Tally::new());
            run.tally.assert_sane(200, 200);
            assert_eq!(run.end().phase, Phase::Rest, "{} {structure:?}", S::NAME);
            assert!(run.tally.peaks.rotation.to_f64() <= S::tolerance(1e-15, 1e-8) * 100.0, "{:?}", run.tally.peaks);
        }
    }
}

/// Under a one-sine pulse θ, θ̇ and θ̈ vanish together where the push passes the threshold: θ starts as τ³, whether the pulse is
/// still at its start or cut off so that it starts exactly there. Against the closed form in units of 1/p_σ
/// φ = 1 − β/(1 + ω²) sin ωt + A e^τ + B e^{−τ}.
fn a_triple_root_at_uplift<S: Precision>() {
    for device in [DeviceKind::None, DeviceKind::Inerter] {
        let slower = square_root(if device == DeviceKind::None { 1.0 } else { 1.375 });
        let structure = unit_block(Geometry::Slender, 10.0, device, 0.5, 0.85);
        let alpha = structure.block.slenderness();
        for frequency in [0.7, 1.0, 2.0, 5.0, 9.0] {
            for ratio in [1.01, 1.3, 2.0] {
                let omega = frequency * slower;
                let phase = asin(1.0 / ratio);
                let part = ratio / (1.0 + omega * omega);
                let (sum, difference) = (-1.0 + part * sin(phase), part * cos(phase) * omega);
                // With τ from uplift.
                let rotation = |tau: f64| {
                    1.0 - part * sin(phase + omega * tau)
                        + 0.5 * (sum + difference) * exp(tau)
                        + 0.5 * (sum - difference) * exp(-tau)
                };
                // While the push still lifts, the block has not come down again.
                let tau = 0.9 * (core::f64::consts::PI - 2.0 * phase) / omega;
                // Still before the point where nothing brings it back.
                if rotation(tau) > 1.0 {
                    continue;
                }
                let whole = Segment::sine(S::of(ratio * alpha), S::of(frequency), S::of((phase / omega + tau) * slower));
                let cut = Segment::sine_from(S::of(ratio * alpha), S::of(frequency), S::of(phase), S::of(tau * slower));
                for (segment, name) in [(whole, "whole"), (cut, "cut at the threshold")] {
                    let mut log = Log::default();
                    let end = S::record(&structure, Stepping::Tight, Start::Rest, &[segment], &mut log)
                        .unwrap_or_else(|stopped| panic!("{stopped}"));
                    assert_eq!(log.times(Event::Uplift).len(), 1, "{name}: {:?}", log.events);
                    assert!(log.times(Event::Impact).is_empty(), "{name}");
                    let found = -end.rotation.to_f64() / alpha;
                    // The instant of uplift is known to an ulp of time over the slope of the push.
                    let tolerance = S::tolerance(1e-10, 2e-3) / square_root(ratio - 1.0);
                    assert!(
                        relative(found, rotation(tau)) < tolerance,
                        "{} {device:?} ω/p = {frequency} β = {ratio} {name}: {found} for {}",
                        S::NAME,
                        rotation(tau)
                    );
                }
            }
        }
    }
}
