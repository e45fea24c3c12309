//! Amplitudes within 10⁻¹² of a boundary of overturning: both sides have their outcome.

use core::f64::consts::{PI, TAU};

use sprag_shared::math::{asin, exp, ln, square_root};
use sprag_shared::motion::state::Phase;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_stability::{Outcome, Precision, Segment, Start, Stepping, Tally, boundary, in_both_precisions, relative, unit_block};

in_both_precisions!(
    beside_the_boundary_of_a_rectangular_pulse,
    beside_the_boundary_of_a_half_sine,
    beside_the_boundary_of_a_sine,
    beside_the_boundary_of_a_cosine,
    beside_a_boundary_after_impacts,
);

/// A pulse of an amplitude (g) on a block of unit p.
type Pulse<S> = dyn Fn(S) -> Segment<S>;

fn run<S: Precision>(structure: &Structure, pulse: &Pulse<S>, amplitude: f64) -> Outcome<S> {
    let segments = [pulse(S::of(amplitude)), Segment::quiet(S::of(90.0))];
    S::tally(structure, Stepping::Tight, Start::Rest, &segments, Tally::new())
}

/// Bisects for the boundary of overturning without an impact next to its closed form `ratio` (in gα), and takes amplitudes on both
/// sides of it.
fn beside<S: Precision>(ratio: f64, pulse: impl Fn(S) -> Segment<S> + 'static) {
    let structure = unit_block(Geometry::Slender, 11.0, DeviceKind::None, 0.0, 0.85);
    let alpha = structure.block.slenderness();
    let overturns = |run: &Outcome<S>| run.end().phase == Phase::Overturned && run.end().impacts == 0;
    let width = S::tolerance(1e-9, 1e-3);
    let found = boundary((1.0 - width) * ratio * alpha, (1.0 + width) * ratio * alpha, |amplitude| {
        overturns(&run(&structure, &pulse, amplitude))
    });
    let error = relative(found, ratio * alpha);
    println!("{}: boundary {:.7} gα, {error:.1e} from its closed form", S::NAME, found / alpha);
    assert!(error < S::tolerance(1e-11, 2e-5), "{}: {error:e} from β = {ratio}", S::NAME);
    // Bits below the boundary and above it, in f32 as many ulps as the motion's rounding may move it.
    let least = S::tolerance(1e-15, 2e-6);
    for offset in [least, 10.0 * least, 1e-12_f64.max(least), 1e-10_f64.max(least), 1e-4] {
        let below = run(&structure, &pulse, found * (1.0 - offset));
        let above = run(&structure, &pulse, found * (1.0 + offset));
        below.tally.assert_sane(3_000, 3_000);
        above.tally.assert_sane(3_000, 3_000);
        assert!(!overturns(&below), "{}: β − {offset:e} overturns", S::NAME);
        assert!(overturns(&above), "{}: β + {offset:e} does not", S::NAME);
        // Just below, the block has been at α for long, and comes back or overturns to the other side after an impact.
        assert!(below.end().impacts > 0, "{}: {:?}", S::NAME, below.end());
        assert!(offset > 1e-6 || below.tally.peaks.rotation.to_f64() > 0.99 * alpha, "{:?}", below.tally);
    }
}

/// p t₁ = ln(β/(β − 1)).
fn beside_the_boundary_of_a_rectangular_pulse<S: Precision>() {
    for ratio in [1.05, 2.0, 40.0] {
        beside::<S>(ratio, move |level| Segment::constant(level, S::of(ln(ratio / (ratio - 1.0)))));
    }
}

/// √(β² − 1) + β e^{−(p/ω)(π − asin 1/β)} = ω/p.
fn beside_the_boundary_of_a_half_sine<S: Precision>() {
    for (frequency, near) in [(2.0, 1.8007239), (4.0, 2.7907980), (8.0, 4.7870713)] {
        let criterion = |b: f64| square_root(b * b - 1.0) + b * exp(-(PI - asin(1.0 / b)) / frequency);
        let ratio = boundary(near * 0.99, near * 1.01, |b| criterion(b) > frequency);
        beside::<S>(ratio, move |level| Segment::sine(level, S::of(frequency), S::of(PI / frequency)));
    }
}

/// √(β² − 1) − β e^{−(p/ω)(2π − asin 1/β)} = ω/p.
fn beside_the_boundary_of_a_sine<S: Precision>() {
    for (frequency, near) in [(1.0, 1.4183153), (2.0, 2.3499031), (3.0, 3.6311499)] {
        let criterion = |b: f64| square_root(b * b - 1.0) - b * exp(-(TAU - asin(1.0 / b)) / frequency);
        let ratio = boundary(near * 0.99, near * 1.01, |b| criterion(b) > frequency);
        beside::<S>(ratio, move |level| Segment::sine(level, S::of(frequency), S::of(TAU / frequency)));
    }
}

/// β = (1 + (ω/p)²)/(1 − e^{−2πp/ω}).
fn beside_the_boundary_of_a_cosine<S: Precision>() {
    for frequency in [1.0, 2.0] {
        let ratio = (1.0 + frequency * frequency) / (1.0 - exp(-TAU / frequency));
        beside::<S>(ratio, move |level| Segment::cosine(level, S::of(frequency), S::of(TAU / frequency)));
    }
}

/// Boundaries without a closed form: of any overturning, between an amplitude that is safe and one that is not, every device.
fn beside_a_boundary_after_impacts<S: Precision>() {
    for device in DeviceKind::ALL {
        for frequency in [4.0, 6.0] {
            let structure = unit_block(Geometry::Full, 14.0, device, 0.5, 0.9);
            let threshold = structure.geometry.uplift_threshold(structure.block.slenderness());
            let pulse = move |level: S| Segment::sine(level, S::of(frequency), S::of(TAU / frequency));
            let overturns = |ratio: f64| run(&structure, &pulse, ratio * threshold).end().phase == Phase::Overturned;
            let found = boundary(1.01, 60.0, overturns);
            let least = S::tolerance(1e-12, 1e-5);
            for offset in [least, 10.0 * least] {
                let below = run(&structure, &pulse, found * (1.0 - offset) * threshold);
                let above = run(&structure, &pulse, found * (1.0 + offset) * threshold);
                below.tally.assert_sane(5_000, 5_000);
                above.tally.assert_sane(5_000, 5_000);
                assert_ne!(below.end().phase, Phase::Overturned, "{} {device:?} {found} − {offset:e}", S::NAME);
                assert_eq!(above.end().phase, Phase::Overturned, "{} {device:?} {found} + {offset:e}", S::NAME);
            }
            println!("{} {device:?} ω/p = {frequency}: overturns above {found:.6} thresholds", S::NAME);
        }
    }
}
