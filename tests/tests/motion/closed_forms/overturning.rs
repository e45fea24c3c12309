//! Where pulses and records overturn a block before its first impact.

use sprag_shared::math::{asin, atan, cos, exp, ln, square_root};
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::{GRAVITY, Geometry};
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_tests::{Dice, FullLog, Segment, boundary, overturned_without_impact, relative, release, resized, shake, unit_block};

use super::slender_blocks;

/// How far a boundary from the simulator may lie from its closed form.
const BOUNDARY: f64 = 1e-11;

/// The amplitude a_p/(gα) from which on `pulse` (amplitude in g, p → segments) overturns the block without an impact.
fn simulated_boundary(structure: &Structure, p: f64, near: f64, pulse: impl Fn(f64) -> Segment<f64>) -> f64 {
    let alpha = structure.block.slenderness();
    boundary(near * 0.95, near * 1.05, |ratio| {
        let (state, _) = shake(structure, &[pulse(ratio * alpha), Segment::quiet(80.0 / p)]);
        overturned_without_impact(&state)
    })
}

/// The root near `guess` of an increasing function.
fn root(guess: f64, function: impl Fn(f64) -> f64) -> f64 {
    boundary(guess * 0.95, guess * 1.05, |x| function(x) > 0.0)
}

#[test]
fn rectangular_pulse() {
    for (structure, p) in slender_blocks() {
        // β = 2 at p t₁ = ln 2 = 0.693147, and others from p t₁ = ln(β/(β−1)).
        for ratio in [1.05, 1.5, 2.0, 5.0, 40.0] {
            let duration = ln(ratio / (ratio - 1.0)) / p;
            let found = simulated_boundary(&structure, p, ratio, |amplitude| Segment::constant(amplitude, duration));
            assert!(relative(found, ratio) < BOUNDARY, "β = {ratio}: {found}");
        }
    }
    assert!(relative(ln(2.0 / (2.0 - 1.0)), core::f64::consts::LN_2) < 1e-15);
}

#[test]
fn half_sine_pulse() {
    for (structure, p) in slender_blocks() {
        for (frequency, printed) in [(2.0, 1.8007239), (4.0, 2.7907980), (8.0, 4.7870713)] {
            let closed = root(printed, |b| {
                square_root(b * b - 1.0) + b * exp(-(core::f64::consts::PI - asin(1.0 / b)) / frequency) - frequency
            });
            assert!((closed - printed).abs() < 1e-7, "closed form {closed}, printed {printed}");
            let found = simulated_boundary(&structure, p, closed, |amplitude| {
                Segment::sine(amplitude, frequency * p, core::f64::consts::PI / (frequency * p))
            });
            assert!(relative(found, closed) < BOUNDARY, "ω/p = {frequency}: {found} for {closed}");
            // Housner's formula is unconservative.
            assert!(square_root(1.0 + frequency * frequency) > found);
        }
    }
}

#[test]
fn one_sine_pulse() {
    for (structure, p) in slender_blocks() {
        for (frequency, printed) in [(1.0, 1.4183153), (2.0, 2.3499031), (3.0, 3.6311499), (5.0, 7.1681288)] {
            let closed = root(printed, |b| {
                square_root(b * b - 1.0) - b * exp(-(core::f64::consts::TAU - asin(1.0 / b)) / frequency) - frequency
            });
            assert!((closed - printed).abs() < 1e-7, "closed form {closed}, printed {printed}");
            let found = simulated_boundary(&structure, p, closed, |amplitude| {
                Segment::sine(amplitude, frequency * p, core::f64::consts::TAU / (frequency * p))
            });
            assert!(relative(found, closed) < BOUNDARY, "ω/p = {frequency}: {found} for {closed}");
        }
    }
}

#[test]
fn one_cosine_pulse() {
    for (structure, p) in slender_blocks() {
        for frequency in [1.0, 2.0, 3.0] {
            let closed = (1.0 + frequency * frequency) / (1.0 - exp(-core::f64::consts::TAU / frequency));
            if frequency == 2.0 {
                assert!((closed - 5.2258285).abs() < 1e-7);
            }
            let found = simulated_boundary(&structure, p, closed, |amplitude| {
                Segment::cosine(amplitude, frequency * p, core::f64::consts::TAU / (frequency * p))
            });
            assert!(relative(found, closed) < BOUNDARY, "ω/p = {frequency}: {found} for {closed}");
        }
    }
}

/// A record of samples in units of gα: straight lines, the motion of a slender block under them in closed form.
struct Record {
    samples: Vec<f64>,
    /// Between samples, in 1/p.
    step: f64,
}

/// What the closed form says of a record before a first impact.
struct Judgement {
    /// p ∫ e^{−p(t−t₀)} a/(gα) dt from uplift to the end.
    integral: f64,
    /// The smallest rotation |θ|/α at the samples after uplift; below zero means an impact.
    smallest: f64,
}

impl Record {
    /// Uplift where the scaled record first reaches 1, then piece by piece: with b the push outward in gα and time in
    /// 1/p, φ̈ = φ − 1 + b has the solution φ = 1 − b + A e^τ + B e^{−τ} as long as b is a straight line.
    fn judge(&self, scale: f64) -> Option<Judgement> {
        let mut uplifted: Option<f64> = None;
        let (mut integral, mut elapsed) = (0.0, 0.0);
        let (mut rotation, mut velocity, mut smallest) = (0.0, 0.0, f64::INFINITY);
        for pair in self.samples.windows(2) {
            let (mut first, last) = (pair[0] * scale, pair[1] * scale);
            let slope = (last - first) / self.step;
            let mut length = self.step;
            let sign = match uplifted {
                Some(sign) => sign,
                None if last.abs() > 1.0 => {
                    let sign = last.signum();
                    let before = (sign - first) / slope;
                    (first, length) = (sign, self.step - before);
                    uplifted = Some(sign);
                    sign
                }
                None => continue,
            };
            let (push, slope) = (sign * first, sign * slope);
            // ∫₀^h e^{−τ} (push + slope τ) dτ.
            let decline = exp(-length);
            integral += exp(-elapsed) * (push * (1.0 - decline) + slope * (1.0 - decline * (1.0 + length)));
            elapsed += length;
            let (value, rate) = (rotation - 1.0 + push, velocity + slope);
            let (grows, decays) = (0.5 * (value + rate), 0.5 * (value - rate));
            for part in 1..=8 {
                let t = length * f64::from(part) / 8.0;
                rotation = 1.0 - push - slope * t + grows * exp(t) + decays * exp(-t);
                smallest = smallest.min(rotation);
            }
            velocity = -slope + grows * exp(length) - decays * exp(-length);
        }
        uplifted.map(|_| Judgement { integral, smallest })
    }
}

#[test]
fn any_ground_motion_before_a_first_impact() {
    let mut dice = Dice(2024);
    let mut compared = 0;
    for _ in 0..400 {
        let step = dice.between(0.03, 0.2);
        let bias = dice.between(0.0, 0.5);
        let samples: Vec<f64> = [0.0].into_iter().chain((0..40).map(|_| dice.between(-1.0, 1.0) + bias)).chain([0.0]).collect();
        let record = Record { samples, step };
        let Some(scale) =
            (2..4000).map(|k| f64::from(k) * 0.01).find(|&scale| record.judge(scale).is_some_and(|j| j.integral > 1.0))
        else {
            continue;
        };
        let (low, high) = (scale - 0.01, scale);
        let (Some(below), Some(above)) = (record.judge(low), record.judge(high)) else { continue };
        // The criterion is one of motions without an impact, well away from one.
        if below.integral >= 1.0 || below.smallest < 1e-9 || above.smallest < 1e-9 {
            continue;
        }
        let closed = boundary(low, high, |scale| record.judge(scale).is_some_and(|j| j.integral > 1.0));
        for (structure, p) in slender_blocks() {
            let alpha = structure.block.slenderness();
            let found = boundary(low, high, |scale| {
                let segments: Vec<_> = record
                    .samples
                    .windows(2)
                    .map(|pair| Segment::line(pair[0] * scale * alpha, pair[1] * scale * alpha, record.step / p))
                    .chain([Segment::quiet(80.0 / p)])
                    .collect();
                overturned_without_impact(&shake(&structure, &segments).0)
            });
            assert!(relative(found, closed) < BOUNDARY, "{found} for {closed}");
            compared += 1;
        }
    }
    println!("{compared} boundaries of random records compared");
    assert!(compared >= 40, "only {compared} records decided anything");
}

#[test]
fn velocity_impulse() {
    for size in [0.4, 1.0, 7.0] {
        for degrees in [2.0, 10.0, 20.0, 40.0] {
            let alpha = f64::to_radians(degrees);
            let p2 = 0.75 * GRAVITY / size;
            let p = square_root(p2);
            let impulse = |geometry, device, mass_ratio, kinematics, velocity_gained: &dyn Fn(f64) -> f64, near: f64| {
                let mut structure = resized(unit_block(geometry, degrees, device, mass_ratio, 0.85), size);
                structure.device.kinematics = kinematics;
                boundary(near * 0.9, near * 1.1, |ground_velocity| {
                    let state = release(&structure, 0.0, velocity_gained(ground_velocity), 80.0 / p, &mut FullLog::default());
                    overturned_without_impact(&state)
                })
            };
            let paper = KinematicsKind::Paper;
            // Slender: p V/(gα) = 1, with p_σ for p.
            let closed = GRAVITY * alpha / p;
            let found = impulse(Geometry::Slender, DeviceKind::None, 0.0, paper, &|v| p2 * v / GRAVITY, closed);
            assert!(relative(found, closed) < BOUNDARY, "slender {found} for {closed}");
            let lowered = p2 / 1.375;
            let closed = GRAVITY * alpha / square_root(lowered);
            let found = impulse(Geometry::Slender, DeviceKind::Inerter, 0.5, paper, &|v| lowered * v / GRAVITY, closed);
            assert!(relative(found, closed) < BOUNDARY, "slender with an inerter {found} for {closed}");
            // Full: the impulse gives (1 + k cos²α) θ̇ = p² (V/g) cos α.
            let closed = square_root(8.0 / 3.0 * GRAVITY * size * (1.0 - cos(alpha))) / cos(alpha);
            let found = impulse(Geometry::Full, DeviceKind::None, 0.0, paper, &|v| p2 * v / GRAVITY * cos(alpha), closed);
            assert!(relative(found, closed) < BOUNDARY, "full {found} for {closed}");
            // With an inerter the first integrals give θ̇ at θ = 0 that just reaches θ = α.
            let k = 0.375_f64;
            let inertia = 1.0 + k * cos(alpha) * cos(alpha);
            let gained = |v: f64| p2 * v / GRAVITY * cos(alpha) / inertia;
            let per_velocity = gained(1.0);
            let root_k = square_root(k);
            let needed = square_root(2.0 * (atan(root_k) - atan(root_k * cos(alpha))) / root_k) * p;
            let found = impulse(Geometry::Full, DeviceKind::Inerter, 0.5, paper, &gained, needed / per_velocity);
            assert!(relative(found * per_velocity, needed) < BOUNDARY, "paper inerter");
            let needed = square_root(2.0 * (1.0 - cos(alpha)) / inertia) * p;
            let consistent = KinematicsKind::Consistent;
            let found = impulse(Geometry::Full, DeviceKind::Inerter, 0.5, consistent, &gained, needed / per_velocity);
            assert!(relative(found * per_velocity, needed) < BOUNDARY, "consistent inerter");
        }
    }
}
