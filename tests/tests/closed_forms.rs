//! Every closed form that a rocking block has, against the simulator.
//!
//! The closed forms are written here once more from the paper and from the theory of the linearised block; they share
//! nothing with the simulator but `sprag_shared::math`.

use sprag_shared::block::{Block, GRAVITY, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::lever::Mount;
use sprag_shared::math::{acosh, asin, atan, cos, exp, ln, sin, square_root};
use sprag_shared::observer::Event;
use sprag_shared::rocking::Phase;
use sprag_shared::structure::{DeviceKind, KinematicsKind, Restitution, Structure};
use sprag_tests::{Dice, FullLog, Segment, boundary, overturned_without_impact, relative, release, resized, shake, unit_block};

/// How far a boundary from the simulator may lie from its closed form.
const BOUNDARY: f64 = 1e-11;

/// A slender block of 1.7 m without a device and the same with an inerter of σ = 0.5, each with its p or p_σ.
fn slender_blocks() -> [(Structure, f64); 2] {
    [(DeviceKind::None, 0.0), (DeviceKind::Inerter, 0.5)].map(|(device, mass_ratio)| {
        let structure = resized(unit_block(Geometry::Slender, 11.0, device, mass_ratio, 0.85), 1.7);
        let p2 = 0.75 * GRAVITY / 1.7 / (1.0 + 0.75 * mass_ratio);
        (structure, square_root(p2))
    })
}

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
    assert!(compared >= 40, "only {compared} records told anything");
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

#[test]
fn period_of_free_rocking() {
    for (structure, p) in slender_blocks() {
        let structure = Structure { restitution: Restitution::Constant(1.0), ..structure };
        let alpha = structure.block.slenderness();
        for ratio in [0.01, 0.2, 0.5, 0.9, 0.999] {
            let period = 4.0 / p * acosh(1.0 / (1.0 - ratio));
            let mut log = FullLog::default();
            release(&structure, ratio * alpha, 0.0, 1.1 * period, &mut log);
            let (impacts, turns) = (log.times(Event::Impact), log.times(Event::Turn));
            // The error of a turn grows with the sensitivity of its energy: near θ₀ = α like 1/(1 − θ₀/α)².
            let tolerance = 1e-13 / ((1.0 - ratio) * (1.0 - ratio)) + 1e-13 / ratio;
            for (time, quarters) in [(impacts[0], 1.0), (turns[0], 2.0), (impacts[1], 3.0), (turns[1], 4.0)] {
                assert!(relative(time, quarters * period / 4.0) < tolerance, "θ₀/α = {ratio}: quarter {quarters} at {time}");
            }
            assert!((log.states(Event::Turn)[1].rotation / alpha - ratio).abs() < tolerance);
        }
    }
}

/// φ_n = 1 − √(1 − η^{2n}(1 − (1 − φ₀)²)), without its cancellation.
fn amplitude_after(impacts: u32, restitution: f64, first: f64) -> f64 {
    let mut energy = first * (2.0 - first);
    for _ in 0..impacts {
        energy *= restitution * restitution;
    }
    energy / (1.0 + square_root(1.0 - energy))
}

#[test]
fn amplitudes_after_impacts() {
    for device in sprag_tests::DEVICES {
        for restitution in [0.99, 0.85, 0.5] {
            for first in [0.95, 0.5, 0.1] {
                let structure = unit_block(Geometry::Slender, 8.0, device, 0.5, restitution);
                let alpha = structure.block.slenderness();
                let mut log = FullLog::default();
                release(&structure, first * alpha, 0.0, 40.0, &mut log);
                // The pair falls with p_σ and rises with p, which counts like an η that is smaller by p_σ/p.
                let per_impact = if device == DeviceKind::ClutchedPair { restitution / square_root(1.375) } else { restitution };
                let turns = log.states(Event::Turn);
                assert!(turns.len() >= 8);
                for (n, state) in (1..).zip(&turns).take(20) {
                    let closed = amplitude_after(n, per_impact, first);
                    let found = state.rotation.abs() / alpha;
                    if closed > 1e-9 {
                        assert!(relative(found, closed) < 1e-11, "{device:?} η = {restitution}, φ₀ = {first}, n = {n}");
                    }
                    assert_eq!(state.impacts, n);
                    assert_eq!(state.rotation > 0.0, n % 2 == 0, "sides take turns");
                }
            }
        }
    }
}

#[test]
fn geometric_restitution_of_a_rectangle() {
    for degrees in [2.0, 10.0, 25.0, 45.0] {
        let structure =
            Structure { restitution: Restitution::Geometric, ..unit_block(Geometry::Full, degrees, DeviceKind::None, 0.0, 0.0) };
        let sine = sin(f64::to_radians(degrees));
        let closed = 1.0 - 1.5 * sine * sine;
        if degrees == 10.0 {
            assert!((closed - 0.9548).abs() < 5e-5);
        }
        let mut log = FullLog::sampling(1);
        release(&structure, 0.5 * f64::to_radians(degrees), 0.0, 3.0, &mut log);
        let impact = log.events.iter().find(|logged| logged.event == Event::Impact).expect("an impact");
        let before = log.stretches.iter().rfind(|stretch| stretch.time < impact.time).expect("a stretch before it");
        let incoming = before.motions.last().expect("its end").velocity;
        assert!(relative(impact.state.velocity / incoming, closed) < 1e-15);
    }
}

/// The largest change of `integral`(k, q, ω) within an arc between two events, with q = α − |θ|, ω in p.
fn drift(structure: &Structure, start: f64, integral: impl Fn(f64, f64, f64) -> f64) -> f64 {
    let alpha = structure.block.slenderness();
    let p = structure.block.frequency_parameter();
    let coupling = structure.device.mass_ratio / structure.block.inertia_ratio();
    let mut log = FullLog::sampling(7);
    release(structure, start * alpha, 0.0, 12.0 / p, &mut log);
    assert!(log.times(Event::Impact).len() >= 2);
    let mut worst = 0.0_f64;
    let mut reference: Option<((f64, bool), f64)> = None;
    for stretch in &log.stretches {
        let k = if stretch.engaged { coupling } else { 0.0 };
        // A new arc of the phase plane starts with every impact and every clutch switch.
        let breaks = log
            .events
            .iter()
            .rfind(|logged| matches!(logged.event, Event::Impact | Event::Switch) && logged.time <= stretch.time + 1e-12);
        let arc = (breaks.map_or(0.0, |logged| logged.time), stretch.engaged);
        for motion in &stretch.motions {
            let q = alpha - stretch.side.times(motion.rotation);
            let value = integral(k, q, motion.velocity / p);
            match reference {
                Some((known, first)) if known == arc => worst = worst.max((value - first).abs()),
                _ => reference = Some((arc, value)),
            }
        }
    }
    worst
}

fn paper_integral(k: f64, q: f64, omega: f64) -> f64 {
    let root_k = square_root(k);
    0.5 * omega * omega + if k == 0.0 { cos(q) } else { atan(root_k * cos(q)) / root_k }
}

fn consistent_integral(k: f64, q: f64, omega: f64) -> f64 {
    0.5 * (1.0 + k * cos(q) * cos(q)) * omega * omega + cos(q)
}

#[test]
fn first_integrals_hold_to_rounding() {
    for device in sprag_tests::DEVICES {
        for (degrees, size) in [(5.0, 1.0), (20.0, 3.0), (40.0, 0.5)] {
            for mass_ratio in [0.1, 0.5, 2.0] {
                for start in [0.3, 0.8, 0.97] {
                    let mut structure = resized(unit_block(Geometry::Full, degrees, device, mass_ratio, 0.9), size);
                    let paper = drift(&structure, start, paper_integral);
                    assert!(paper < 5e-15, "paper, {device:?}, {degrees}°, σ = {mass_ratio}: {paper:e}");
                    structure.device.kinematics = KinematicsKind::Consistent;
                    let consistent = drift(&structure, start, consistent_integral);
                    assert!(consistent < 5e-15, "consistent, {device:?}, {degrees}°, σ = {mass_ratio}: {consistent:e}");
                    // The test can tell the two apart.
                    if device == DeviceKind::Inerter {
                        assert!(drift(&structure, start, paper_integral) > 1e-9);
                    }
                }
            }
        }
    }
}

/// Any mount's terminal travels by ℓ dθ, and its consistent kinematics conserve ½(1 + k ℓ²)ω² + cos q.
#[test]
fn every_mount_conserves_its_energy() {
    let alpha = f64::to_radians(15.0);
    let size = 2.0;
    let tie = |n: f64, height: f64| {
        // The point (0, z) of the centre line lies at (−R sin α, z) from the toe; turned by θ, its x grows by this a radian.
        move |q: f64| {
            let theta = alpha - q;
            n * (height / size * cos(theta) + sin(alpha) * sin(theta))
        }
    };
    // The raised corner, 2 R sin α from the toe, is 2 R sin α sin θ high.
    let corners = |n: f64| move |q: f64| n * 2.0 * sin(alpha) * cos(alpha - q);
    for device in [DeviceKind::Inerter, DeviceKind::ClutchedPair] {
        let with = |mount| {
            let mut structure = resized(unit_block(Geometry::Full, 15.0, device, 0.8, 0.9), size);
            structure.device.mount = mount;
            structure.device.kinematics = KinematicsKind::Consistent;
            structure
        };
        let check = |structure: &Structure, lever: &dyn Fn(f64) -> f64| {
            let worst = drift(structure, 0.7, |k, q, omega| {
                let arm = lever(q);
                0.5 * (1.0 + k * arm * arm) * omega * omega + cos(q)
            });
            assert!(worst < 5e-15, "{:?}: {worst:e}", structure.device.mount);
        };
        for (height, ratio) in [(1.0, 1.0), (3.5, 1.0), (2.0, 3.0)] {
            check(&with(Mount::TyingPoint { height, pulley_ratio: ratio }), &tie(ratio, height));
        }
        for ratio in [1.0, 4.0] {
            check(&with(Mount::BaseCorners { pulley_ratio: ratio }), &corners(ratio));
        }
    }
}

/// How far the paper's kinematics are off in energy, from 0.8 α to the impact.
#[test]
fn the_papers_kinematics_miss_energy() {
    for (degrees, mass_ratio, printed) in [(10.0, 0.5, 0.4), (20.0, 0.5, 1.6), (20.0, 1.0, 2.5)] {
        let structure = unit_block(Geometry::Full, degrees, DeviceKind::Inerter, mass_ratio, 0.9);
        let alpha = structure.block.slenderness();
        let k = 0.75 * mass_ratio;
        let mut log = FullLog::sampling(1);
        release(&structure, 0.8 * alpha, 0.0, 20.0, &mut log);
        let impact = log.times(Event::Impact)[0];
        let before = log.stretches.iter().rfind(|stretch| stretch.time < impact).expect("a stretch before the impact");
        let omega = before.motions.last().expect("its end").velocity;
        let kinetic = 0.5 * (1.0 + k * cos(alpha) * cos(alpha)) * omega * omega;
        let missing = (kinetic + cos(alpha) - cos(0.2 * alpha)).abs() / kinetic;
        assert!((100.0 * missing - printed).abs() <= 0.05, "α = {degrees}°, σ = {mass_ratio}: {missing}");
        // And from the paper's first integral.
        let root_k = square_root(k);
        let squared = 2.0 * (atan(root_k * cos(0.2 * alpha)) - atan(root_k * cos(alpha))) / root_k;
        assert!(relative(omega * omega, squared) < 1e-13);
    }
}

/// Grounds on which nothing may happen: the threshold of uplift is g tan α, or gα for the slender model (Eq. 1).
#[test]
fn uplift_threshold() {
    for degrees in [3.0, 10.0, 30.0] {
        let alpha = f64::to_radians(degrees);
        let block = Block::new(1.0, alpha, RECTANGLE_INERTIA_RATIO).expect("a block");
        for (geometry, closed) in [(Geometry::Full, sin(alpha) / cos(alpha)), (Geometry::Slender, alpha)] {
            assert!(relative(geometry.uplift_threshold(&block), closed) < 1e-15);
            let structure = unit_block(geometry, degrees, DeviceKind::None, 0.0, 0.85);
            for (factor, rocks) in [(1.0 - 1e-12, false), (1.0 + 1e-12, true)] {
                for sign in [1.0, -1.0] {
                    let (state, log) = shake(&structure, &[Segment::constant(sign * factor * closed, 0.5)]);
                    assert_eq!(log.peaks.rocked, rocks);
                    assert_eq!(state.phase == Phase::Rocking, rocks);
                    // To the side opposite to the push.
                    assert!(!rocks || state.rotation * sign < 0.0);
                }
            }
        }
    }
}

/// Eq. 10 at every instant: a clutched inerter is engaged while acceleration and velocity of its terminals have one sign,
/// ℓθ̈ and ℓθ̇ in the paper's kinematics, ℓθ̈ + ℓ'θ̇² and ℓθ̇ in the consistent ones. The sign does not depend on κ.
#[test]
fn the_clutch_keeps_its_law() {
    let mut told = [0_usize; 2];
    for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
        for mount in
            [Mount::CentreOfMass, Mount::TyingPoint { height: 3.0, pulley_ratio: 2.0 }, Mount::BaseCorners { pulley_ratio: 3.0 }]
        {
            for (degrees, frequency, amplitude) in [(5.0, 4.0, 3.0), (20.0, 2.0, 1.6), (20.0, 5.0, 4.0), (35.0, 3.0, 2.0)] {
                let alpha = f64::to_radians(degrees);
                let mut structure = resized(unit_block(Geometry::Full, degrees, DeviceKind::ClutchedPair, 0.9, 0.85), 2.0);
                structure.device.mount = mount;
                structure.device.kinematics = kinematics;
                // ℓ = A cos δ + s B sin δ.
                let (a, b) = match mount {
                    Mount::CentreOfMass => (1.0, 0.0),
                    Mount::TyingPoint { height, pulley_ratio: n } => {
                        let z = height / 2.0;
                        (n * (z * cos(alpha) + sin(alpha) * sin(alpha)), n * (z * sin(alpha) - sin(alpha) * cos(alpha)))
                    }
                    Mount::BaseCorners { pulley_ratio: n } => {
                        (2.0 * n * sin(alpha) * cos(alpha), 2.0 * n * sin(alpha) * sin(alpha))
                    }
                };
                let p = structure.block.frequency_parameter();
                let level = amplitude * sin(alpha) / cos(alpha);
                let pulse = Segment::sine(level, frequency * p, core::f64::consts::TAU / (frequency * p));
                let mut log = FullLog::sampling(6);
                sprag_tests::follow(
                    &structure,
                    &sprag_tests::tight(),
                    sprag_tests::Start::Rest,
                    &[pulse, Segment::quiet(3.0 / p)],
                    &mut log,
                )
                .expect("a motion that can be followed");
                for stretch in &log.stretches {
                    let side: f64 = stretch.side.unit();
                    // The ends of a stretch are where signs change.
                    for motion in &stretch.motions[1..stretch.motions.len() - 1] {
                        let q = alpha * side - motion.rotation;
                        let lever = a * cos(q) + side * b * sin(q);
                        let rate = a * sin(q) - side * b * cos(q);
                        let quadratic =
                            if kinematics == KinematicsKind::Consistent { rate * motion.velocity * motion.velocity } else { 0.0 };
                        let power = (lever * motion.acceleration + quadratic) * lever * motion.velocity;
                        if power.abs() > 1e-12 {
                            assert_eq!(stretch.engaged, power > 0.0, "{kinematics:?} {mount:?} α = {degrees}°: {stretch:?}");
                            told[usize::from(stretch.engaged)] += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(told[0] > 1000 && told[1] > 1000, "{told:?}");
}
