//! Fixed-step methods keep their order through impacts and clutch switches, because events are located and not stepped
//! over.

use core::f64::consts::TAU;

use sprag_shared::math::ln;
use sprag_shared::math::scalar::Real;
use sprag_shared::method::dense_output::Integrator;
use sprag_shared::method::fixed::{FixedStep, Scheme};
use sprag_shared::method::taylor::Taylor;
use sprag_shared::motion::observer::Event;
use sprag_shared::motion::state::{BlockState, Phase};
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_tests::{Log, Segment, Start, follow, shake, unit_block};

/// A run with impacts, turns and, with a clutch, switches; ends in mid-swing.
struct Scene {
    structure: Structure,
    /// In uplift thresholds.
    amplitude: f64,
    frequency: f64,
    free: f64,
}

impl Scene {
    fn segments<S: Real>(&self) -> [Segment<S>; 2] {
        let level = self.amplitude * self.structure.geometry.uplift_threshold(self.structure.block.slenderness());
        [Segment::sine(S::of(level), S::of(self.frequency), S::of(TAU / self.frequency)), Segment::quiet(S::of(self.free))]
    }

    fn by<S: Real, M: Integrator<S>>(&self, method: &M) -> (BlockState<S>, Log<S, true>) {
        let mut log = Log::default();
        let state =
            follow(&self.structure, method, Start::Rest, &self.segments(), &mut log).expect("a motion that can be followed");
        (state, log)
    }
}

fn scenes() -> Vec<Scene> {
    let scene = |geometry, device, kinematics| {
        let mut structure = unit_block(geometry, 15.0, device, 0.5, 0.85);
        structure.device.kinematics = kinematics;
        Scene { structure, amplitude: 1.5, frequency: 5.0, free: 2.75 }
    };
    vec![
        scene(Geometry::Full, DeviceKind::None, KinematicsKind::Paper),
        scene(Geometry::Full, DeviceKind::Inerter, KinematicsKind::Consistent),
        scene(Geometry::Full, DeviceKind::ClutchedPair, KinematicsKind::Paper),
        scene(Geometry::Full, DeviceKind::ClutchedPair, KinematicsKind::Consistent),
        scene(Geometry::Slender, DeviceKind::ClutchedPair, KinematicsKind::Paper),
    ]
}

/// Error of the final state and of the worst event's time.
struct Errors {
    state: f64,
    events: f64,
}

/// The events that a run has whatever the method; None if they differ from the reference's.
fn errors<S: Real>(
    (state, log): &(BlockState<S>, Log<S, true>),
    (exact, exact_log): &(BlockState<f64>, Log<f64, true>),
) -> Errors {
    let timed = |event: &Event| matches!(event, Event::Uplift | Event::Impact | Event::Turn | Event::Switch);
    let events: Vec<_> = log.events.iter().filter(|logged| timed(&logged.event)).collect();
    let exact_events: Vec<_> = exact_log.events.iter().filter(|logged| timed(&logged.event)).collect();
    let kinds: Vec<_> = events.iter().map(|logged| logged.event).collect();
    let exact_kinds: Vec<_> = exact_events.iter().map(|logged| logged.event).collect();
    assert_eq!(kinds, exact_kinds, "the same events in the same order");
    let worst = events.iter().zip(&exact_events).map(|(a, b)| (a.time.to_f64() - b.time).abs()).fold(0.0, f64::max);
    let rotation = (state.rotation.to_f64() - exact.rotation).abs();
    let velocity = (state.velocity.to_f64() - exact.velocity).abs();
    Errors { state: rotation.max(velocity), events: worst }
}

/// The slope of ln error over ln step, by least squares.
fn order(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (mut x, mut y, mut xx, mut xy) = (0.0, 0.0, 0.0, 0.0);
    for &(step, error) in points {
        let (a, b) = (ln(step), ln(error));
        (x, y, xx, xy) = (x + a, y + b, xx + a * a, xy + a * b);
    }
    (n * xy - x * y) / (n * xx - x * x)
}

/// Runs `method` with `count` steps from `largest` downward by 1.5 and compares the orders seen with `expected`.
fn keeps_its_order<M: Integrator<f64>>(name: &str, expected: f64, largest: f64, count: i32, method: impl Fn(f64) -> M) {
    for (index, scene) in scenes().iter().enumerate() {
        let reference = shake(&scene.structure, &scene.segments());
        let switches = reference.1.times(Event::Switch).len();
        assert_eq!(reference.0.phase, Phase::Rocking, "scene {index} ends in mid-swing");
        assert!(reference.1.times(Event::Impact).len() >= 3, "scene {index}: {:?}", reference.1.times(Event::Impact));
        assert!(scene.structure.device.kind != DeviceKind::ClutchedPair || switches >= 4);
        let mut step = largest;
        let (mut states, mut events) = (Vec::new(), Vec::new());
        for _ in 0..count {
            let found = errors(&scene.by(&method(step)), &reference);
            states.push((step, found.state));
            events.push((step, found.events));
            step /= 1.5;
        }
        let (of_state, of_events) = (order(&states), order(&events));
        println!(
            "{name}, scene {index}: order {of_state:.2} of the state, {of_events:.2} of the events; {:.1e} to {:.1e}",
            states[0].1,
            states[states.len() - 1].1
        );
        for seen in [of_state, of_events] {
            assert!(seen > expected - 0.4, "{name}, scene {index}: order {seen}, {expected} expected: {states:?} {events:?}");
        }
    }
}

#[test]
fn semi_implicit_euler_is_of_order_1() {
    keeps_its_order("Euler", 1.0, 2e-3, 10, |step| FixedStep { scheme: Scheme::SemiImplicitEuler, step });
}

#[test]
fn runge_kutta_is_of_order_4() {
    keeps_its_order("Runge-Kutta", 4.0, 0.03, 10, |step| FixedStep { scheme: Scheme::RungeKutta4, step });
}

#[test]
fn a_fixed_taylor_method_is_of_its_order() {
    // With N coefficients of θ, θ̇ has N − 1: its error over a step is of order N − 1, and over a run of order N − 2.
    keeps_its_order("Taylor of 8", 6.0, 0.15, 7, Taylor::<f64, 8>::fixed);
    keeps_its_order("Taylor of 9", 7.0, 0.1, 5, Taylor::<f64, 9>::fixed);
}

/// In f32 the error falls in the same way until it meets rounding, and stays there.
#[test]
fn single_precision_converges_to_its_rounding() {
    for (index, scene) in scenes().iter().enumerate() {
        let reference = shake(&scene.structure, &scene.segments());
        let error = |step: f32| errors(&scene.by(&FixedStep { scheme: Scheme::RungeKutta4, step }), &reference);
        let (coarse, finer) = (error(0.12), error(0.06));
        println!("f32, scene {index}: {:.1e} at 0.12, {:.1e} at 0.06", coarse.state, finer.state);
        assert!(coarse.state > 6.0 * finer.state, "scene {index}: {:e} then {:e}", coarse.state, finer.state);
        for step in [0.01, 0.003, 0.001] {
            let fine = error(step);
            println!("f32, scene {index}: {:.1e} of the state, {:.1e} s of the events at {step}", fine.state, fine.events);
            // Half a unit in the last place of the size of θ, a step, in the same direction all along; an event moves by
            // an error of θ over its speed.
            let steps = (TAU / scene.frequency + scene.free) as f32 / step;
            let rounding = f64::from(f32::EPSILON * steps * scene.structure.block.slenderness() as f32).max(3e-6);
            assert!(fine.state < rounding, "scene {index}, step {step}: {:e}, rounding {rounding:e}", fine.state);
            assert!(fine.events < 30.0 * rounding, "scene {index}, step {step}: {:e} s, rounding {rounding:e}", fine.events);
        }
        let taylor = errors(&scene.by(&Taylor::<f32, 10>::adaptive(1e-7)), &reference);
        println!("f32, scene {index}: {:.1e} by the Taylor method, {:.1e} s of its events", taylor.state, taylor.events);
        assert!(taylor.state < 3e-6 && taylor.events < 1e-4);
    }
}
