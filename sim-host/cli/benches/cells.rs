//! How fast the core is at tight accuracy: cells of an overturning map on one core, and an integrated record.
//!
//! `cargo bench --bench cells` prints cells a second for the 64 x 64 grid of each device and pulse (α = 20°, σ = 0.5, ω_g/p 0.2-8, a 1-10,
//! free time 60/p), and the time of 40 s of ground motion at 5 ms for each device, as minima of several passes, also as a ratio to that of
//! the hybrid loop. The yardstick of the same run is the number of slender-block Runge-Kutta steps a second.

use std::hint::black_box;

use sprag_loops::{Method, Precision};
use sprag_shared::equation::{Equation, SlenderBlock};
use sprag_shared::method::fixed::runge_kutta_4;
use sprag_shared::method::taylor::Taylor;
use sprag_shared::motion::hybrid::series::Series;
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::{Block, GRAVITY, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::Drivetrain;
use sprag_shared::structure::mount::Mount;
use sprag_shared::structure::{Restitution, Structure};
use sprag_sim::batch::case::TIGHT;
use sprag_sim::closed_loop::plant::Extremes;
use sprag_sim::ground_motion::{Component, GroundMotion};
use sprag_sim::simulation::drive::{Course, Overturning};
use sprag_sim::synthesis::NearFaultMotion;

mod figure08;

use figure08::{cells, fastest};

const PASSES: usize = 9;
/// Last terms of the series on a record, over α.
const RECORD_TOLERANCE: f64 = 1e-12;
/// Coefficients of the series on a record, whose pieces are short.
const RECORD_TERMS: usize = 9;

fn main() {
    let steps = yardstick();
    println!("yardstick: {:.1} million slender Runge-Kutta steps a second\n", steps / 1e6);
    println!("{:8} {:14} {:>14} {:>22}", "geometry", "device", "cells/s", "yardstick steps/cell");
    let method = f64::ideal(Method::Adaptive(TIGHT));
    for geometry in [Geometry::Full, Geometry::Slender] {
        let (mut count, mut total) = (0, 0.0);
        for device in DeviceKind::ALL {
            let cells = cells(geometry, device);
            let seconds = fastest(PASSES, || cells.iter().for_each(|case| _ = black_box(case.run(&*method))));
            (count, total) = (count + cells.len(), total + seconds);
            let rate = cells.len() as f64 / seconds;
            println!("{:8} {:14} {rate:14.0} {:22.0}", format!("{geometry:?}"), format!("{device:?}"), steps / rate);
        }
        let rate = count as f64 / total;
        println!("{:8} {:14} {rate:14.0} {:22.0}\n", format!("{geometry:?}"), "all", steps / rate);
    }
    println!(
        "{:8} {:14} {:>20} {:>20} {:>20}",
        "geometry", "device", "ms for 40 s at 5 ms", "error of the peak", "hybrid/ideal loop"
    );
    let motion = NearFaultMotion { duration_s: 40.0, ..NearFaultMotion::DEFAULT }.acceleration_m_s2().unwrap_or_default();
    let ground = GroundMotion::sum(&[Component::record(0.0, 0.005, motion.iter().map(|a| a / GRAVITY))]);
    for geometry in [Geometry::Full, Geometry::Slender] {
        for device in DeviceKind::ALL {
            let structure = structure(geometry, device);
            let course = Course::of(&structure, &ground, 10.0, Overturning::Proven);
            let ideal = |tolerance| record(&structure, &course, tolerance);
            let seconds = fastest(PASSES, || _ = black_box(ideal(RECORD_TOLERANCE)));
            let hybrid = fastest(PASSES, || _ = black_box(record_by_hybrid_loop(&structure, &course)));
            let error = ideal(RECORD_TOLERANCE) / ideal(1e-18) - 1.0;
            let (milliseconds, ratio) = (seconds * 1e3, hybrid / seconds);
            let (geometry, device) = (format!("{geometry:?}"), format!("{device:?}"));
            println!("{geometry:8} {device:14} {milliseconds:20.3} {:20.0e} {ratio:20.2}", error.abs());
        }
    }
}

/// Steps a second of one dependent chain.
fn yardstick() -> f64 {
    const STEPS: u32 = 1_000_000;
    let block = SlenderBlock { frequency_squared: 1.0, slenderness: 0.2, inertia: 1.0, lever: 1.0 };
    let seconds = fastest(PASSES, || {
        let mut state = (0.1, 0.0);
        for _ in 0..STEPS {
            let first = block.acceleration(1.0, state.0, state.1, 0.0);
            state = runge_kutta_4(&block, 1.0, state, first, [0.0; 3], black_box(1e-9));
        }
        black_box(state);
    });
    f64::from(STEPS) / seconds
}

/// A block that stays up, so that the whole record is integrated.
fn structure(geometry: Geometry, kind: DeviceKind) -> Structure {
    let block = Block::new(6.0, 0.2, RECTANGLE_INERTIA_RATIO).expect("within range");
    let device = Device { kind, mass_ratio: 0.5, mount: Mount::CentreOfMass, kinematics: KinematicsKind::Paper };
    let restitution = Restitution::Constant(0.95);
    Structure { geometry, device, ..Structure::new(block, restitution) }
}

/// Peak rotation by the loop for ideal devices.
fn record(structure: &Structure, course: &Course<'_>, tolerance: f64) -> f64 {
    let (mut state, mut peaks) = (BlockState::default(), Peaks::default());
    let method = Taylor::<f64, RECORD_TERMS>::adaptive(tolerance);
    course.follow(&structure.resolve().unwrap(), &method, &mut state, &mut peaks, || true).unwrap();
    peaks.rotation
}

/// The same by the hybrid loop, which could do without the other: the way not taken.
fn record_by_hybrid_loop(structure: &Structure, course: &Course<'_>) -> f64 {
    let system = Drivetrain::default().resolve(structure, false).unwrap();
    let mut extremes = Extremes::default();
    let method = Series::<f64, RECORD_TERMS>::adaptive(RECORD_TOLERANCE);
    course.follow_machine(&system, &method, &mut system.at_rest(), &mut extremes, || true).unwrap();
    extremes.peaks.rotation
}
