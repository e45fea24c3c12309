//! Closed loops whose clutches are plates that slip.

use std::path::Path;

use sprag_shared::motion::device_snapshot::DeviceOutput;
use sprag_shared::motion::observer::{MonotoneInterval, Observer};
use sprag_shared::motion::state::Phase;
use sprag_sim::closed_loop::LoopScene;
use sprag_sim::ground_motion::Segment;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::simulation::drive::Segmented;

/// Intervals so far; a loop of 25 s has 100,000 steps in motion at most, and few events.
struct Intervals(u32);

impl Observer<f64> for Intervals {
    fn device_interval(&mut self, _output: &dyn DeviceOutput<f64>, _interval: &MonotoneInterval<f64>) {
        self.0 += 1;
        assert!(self.0 < 300_000, "its events do not end");
    }
}

impl Segmented for Intervals {
    fn segment(&mut self, _start: f64, _segment: Option<&Segment>) {}
}

/// A controller holds both clutches while the block stands. Its last bounces drag the flywheels to and fro, ever less, and end.
#[test]
fn a_block_comes_to_rest_while_its_plates_slip() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/controller.toml");
    let interrupt = Interrupt::default();
    for capacity in [0.3, 0.5, 1.0] {
        let scene = Scene::load(&path, &[format!("device.0.clutch.capacity_ratio={capacity}")]).unwrap();
        let desk = LoopScene::new(scene).unwrap();
        let ending = desk.task(desk.pairs[0], 1, &interrupt).run(&mut Intervals(0), &mut ()).unwrap();
        assert_eq!(ending.motion.phase, Phase::Rest, "{capacity}");
    }
}
