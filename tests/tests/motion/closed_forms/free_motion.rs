//! Free rocking: periods, decay and first integrals.

use sprag_shared::math::{acosh, atan, cos, sin, square_root};
use sprag_shared::motion::observer::Event;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_shared::structure::mount::Mount;
use sprag_shared::structure::{Restitution, Structure};
use sprag_tests::{FullLog, relative, release, resized, unit_block};

use super::slender_blocks;

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
    for device in DeviceKind::ALL {
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
    for device in DeviceKind::ALL {
        for (degrees, size) in [(5.0, 1.0), (20.0, 3.0), (40.0, 0.5)] {
            for mass_ratio in [0.1, 0.5, 2.0] {
                for start in [0.3, 0.8, 0.97] {
                    let mut structure = resized(unit_block(Geometry::Full, degrees, device, mass_ratio, 0.9), size);
                    let paper = drift(&structure, start, paper_integral);
                    assert!(paper < 5e-15, "paper, {device:?}, {degrees}°, σ = {mass_ratio}: {paper:e}");
                    structure.device.kinematics = KinematicsKind::Consistent;
                    let consistent = drift(&structure, start, consistent_integral);
                    assert!(consistent < 5e-15, "consistent, {device:?}, {degrees}°, σ = {mass_ratio}: {consistent:e}");
                    // The test can distinguish the two.
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
