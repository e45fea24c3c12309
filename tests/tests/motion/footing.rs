//! A standing block that is let through a piece of ground motion without a look for its uplift, beside the event loop that looks.

use sprag_shared::ground::Linear;
use sprag_shared::math;
use sprag_shared::method::fixed::{FixedStep, Scheme};
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::motion::hybrid::mode_output::Shaking;
use sprag_shared::motion::state::{Limits, Phase};
use sprag_sim::scene::Scene;

/// Straight pieces that rise to the threshold tan α and beyond, to both sides, with and without vertical motion: where the short way is taken it
/// leaves the same state, it is taken well below the threshold, and never where the loop finds an uplift.
#[test]
fn a_block_that_stands_for_certain_stands_in_the_event_loop() {
    let text = "block = { size_m = 2.0, slenderness_deg = 10.0 }
        device = [{ kind = 'clutched-pair', mass_ratio = 0.5, engagement = 'rigid' }]
        ground = [{ motion = 'sine', amplitude_ratio = 1.0, frequency_ratio = 1.0 }]";
    let scene = Scene::parse(text, "scene").expect("a scene");
    let method = FixedStep { scheme: Scheme::RungeKutta4, step: 5e-4 };
    let (duration, limits) = (5e-4, Limits { overturned: 1.0, events: 1000 });
    let (mut short, mut uplifts) = (0, 0);
    for vertical in [None, Some(0.2), Some(-0.2)] {
        let drivetrain = scene.devices[0].drivetrain;
        let machine: HybridSystem<f64> = drivetrain.resolve(&scene.structure(0), vertical.is_some()).expect("a machine");
        let footing = machine.footing();
        let threshold = math::tan(10.0_f64.to_radians()) * (1.0 + vertical.unwrap_or(0.0));
        for step in -150..=150 {
            let last = 0.01 * f64::from(step);
            let line = Linear::between(0.9 * last * threshold, last * threshold, duration);
            let up = vertical.map(Linear::constant);
            let shaking = Shaking { horizontal: &line, vertical: up.as_ref().map(|up| up as _), support: None };
            let (mut one, mut other) = (machine.at_rest(), machine.at_rest());
            let stands = machine.stands_through(&footing, &mut one, shaking, duration);
            machine.advance(&method, &mut other, shaking, duration, &limits, &mut ()).expect("a piece");
            if stands {
                assert_eq!(one, other, "{last}");
            }
            assert!(stands || last.abs() > 0.99, "{last}");
            assert!(!stands || other.motion.phase == Phase::Rest, "{last}");
            short += usize::from(stands);
            uplifts += usize::from(other.motion.phase == Phase::Rocking);
        }
    }
    assert!(short > 500 && uplifts > 200, "{short} {uplifts}");
}
