//! The hard cases that the target runs: single precision, fixed steps, as words that host and board both read.

use sprag_case::{Case, FixedMethod, Ground, GroundPiece, Initially, Shape};
use sprag_shared::ground::{Harmonics, Linear};
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Drivetrain, Engagement, FlywheelLosses};
use sprag_shared::structure::{Restitution, Structure};

/// A case, its name, and how it must end.
#[derive(Clone, Debug)]
pub struct TargetCase {
    /// As messages print it.
    pub name: &'static str,
    /// The case.
    pub case: Case<'static>,
    /// How it ends.
    pub outcome: Outcome,
    /// Most steps that it may take.
    pub steps: u32,
}

/// α of every block, rad: its f32 is exact in f64, so that the block's own α is that f32.
const SLENDERNESS: f32 = 0.171_875;

/// p = 1/s, σ = 0.5.
fn structure(geometry: Geometry, kind: DeviceKind, restitution: f64) -> Structure {
    let mass_ratio = if kind == DeviceKind::None { 0.0 } else { 0.5 };
    let block = Block::of_unit_frequency(f64::from(SLENDERNESS), RECTANGLE_INERTIA_RATIO).expect("a slenderness within range");
    Structure {
        geometry,
        device: Device { kind, mass_ratio, kinematics: KinematicsKind::Consistent, ..Device::NONE },
        ..Structure::new(block, Restitution::Constant(restitution))
    }
}

/// A block released on quiet ground.
fn released(structure: Structure, rotation: f32, velocity: f32, step: f32, free_time: f32) -> Case<'static> {
    Case {
        structure,
        drivetrain: Drivetrain::default(),
        initially: Initially::Released { rotation, velocity },
        method: FixedMethod::RungeKutta4,
        step,
        ground: Ground::pieces(&[]).expect("no pieces"),
        free_time,
    }
}

/// A block at rest under a list of pieces.
fn shaken(structure: Structure, pieces: &[(Shape, f32)], step: f32, free_time: f32) -> Case<'static> {
    let pieces: Vec<_> = pieces.iter().map(|&(shape, duration)| GroundPiece { shape, duration }).collect();
    Case {
        initially: Initially::Rest,
        ground: Ground::pieces(&pieces).expect("few pieces"),
        ..released(structure, 1.0, 0.0, step, free_time)
    }
}

fn constant(level: f32) -> Shape {
    Shape::Linear(Linear::constant(level))
}

/// All of them.
pub fn target_cases() -> Vec<TargetCase> {
    use DeviceKind::{ClutchedPair, Inerter, None as Alone};
    use Geometry::{Full, Slender};
    let mut cases = Vec::new();
    let mut add = |name, case, outcome, steps| cases.push(TargetCase { name, case, outcome, steps });
    let alpha = SLENDERNESS;
    let safe = Outcome::Safe;
    for (name, kind, restitution) in [
        ("impacts accumulate, η = 0.01", ClutchedPair, 0.01),
        ("impacts accumulate, η = 0.5", Alone, 0.5),
        ("impacts accumulate, η = 0.99", ClutchedPair, 0.99),
        ("impacts hardly die, η = 0.9999", Inerter, 0.9999),
        ("impacts do not die, η = 1", Alone, 1.0),
    ] {
        add(name, released(structure(Full, kind, restitution), 0.4 * alpha, 0.0, 0.02, 60.0), safe, 12_000);
    }
    for (name, geometry) in [("unstable equilibrium, full", Full), ("unstable equilibrium, slender", Slender)] {
        add(name, released(structure(geometry, ClutchedPair, 0.85), alpha, 0.0, 0.5, 3600.0), safe, 7_300);
    }
    let single = structure(Slender, Inerter, 0.85);
    add("an ulp inside the equilibrium", released(single, alpha.next_down(), 0.0, 0.02, 60.0), safe, 4_000);
    let over = Outcome::OverturnedWithoutImpact;
    add("an ulp outside the equilibrium", released(single, alpha.next_up(), 0.0, 0.02, 60.0), over, 4_000);
    let pair = structure(Slender, ClutchedPair, 0.85);
    add("a push at the threshold", shaken(pair, &[(constant(alpha), 10.0)], 0.02, 1.0), Outcome::NoRocking, 0);
    let above = alpha.next_up();
    add("an ulp above it for one sample", shaken(pair, &[(constant(above), 0.005)], 5e-4, 5.0), safe, 60);
    let crossing = Shape::Sine(Harmonics::sine(1.5 * alpha, 4.0));
    add("a triple root at uplift", shaken(pair, &[(crossing, core::f32::consts::FRAC_PI_2)], 0.01, 20.0), safe, 4_000);
    let held = [(constant(-1.5 * alpha), 2.0)];
    // φ₀ = 0.2 under 1.5 gα: just touches the floor at v² = (φ₀ − 1 + b)² − (b − 1)².
    let grazing = Initially::Released { rotation: 0.2 * alpha, velocity: -0.489_897_95 * alpha };
    let graze = Case { initially: grazing, ..shaken(structure(Slender, Alone, 0.85), &held, 0.02, 0.0) };
    add("a grazing impact", graze, safe, 200);
    let kinks = [(constant(0.9 * alpha), 0.25), (constant(-0.9 * alpha), 0.25), (constant(0.0), 0.25)];
    let kinked = Case {
        initially: Initially::Released { rotation: 0.031_25 * alpha, velocity: 0.0 },
        ..shaken(structure(Slender, Alone, 0.85), &kinks, 0.25, 20.0)
    };
    add("impacts near kinks", kinked, safe, 2_000);
    let long = Shape::Sine(Harmonics::sine(1.5 * alpha, 4.0));
    for (name, step, method) in [
        ("steps of 0.5/p, Runge-Kutta", 0.5, FixedMethod::RungeKutta4),
        ("steps of 0.5/p, semi-implicit Euler", 0.5, FixedMethod::SemiImplicitEuler),
        ("steps of 0.1/p, Taylor", 0.1, FixedMethod::Taylor),
    ] {
        let pair = structure(Full, ClutchedPair, 0.85);
        let case = Case { method, ..shaken(pair, &[(long, core::f32::consts::FRAC_PI_2)], step, 30.0) };
        add(name, case, safe, 2_000);
    }
    let denormal = released(structure(Full, ClutchedPair, 0.85), 1e-40, 0.0, 0.02, 1.0);
    add("a denormal rotation", denormal, safe, 60);
    let hum = Shape::Sine(Harmonics::sine(1e-40, 6.0));
    let shaking = Case {
        initially: Initially::Released { rotation: 0.4 * alpha, velocity: 0.0 },
        ..shaken(single, &[(hum, 10.0)], 0.02, 1.0)
    };
    add("a denormal ground motion", shaking, safe, 2_000);
    for (name, stiffness) in [("an elastic clutch, K/m = 1e2", 1e2), ("an elastic clutch, K/m = 1e12", 1e12)] {
        let damping = 0.6 * sprag_shared::math::square_root(stiffness * 0.5);
        let engagement = Engagement::Elastic { stiffness, damping, backlash: 0.0, capacity_ratio: f64::INFINITY };
        let flywheel = FlywheelLosses { brake_deceleration: 5.0, ..FlywheelLosses::default() };
        let drivetrain = Drivetrain { engagement, flywheel, ..Drivetrain::default() };
        let structure = structure(Full, ClutchedPair, 0.85);
        let method = FixedMethod::ExponentialMidpoint;
        let case = Case { drivetrain, method, ..shaken(structure, &[(long, core::f32::consts::FRAC_PI_2)], 0.005, 8.0) };
        add(name, case, safe, 6_000);
    }
    cases
}
