//! An example to copy: a clutch law of one's own, tested on the desk.
//!
//! A law sees a [`Situation`] and says what it wants. Everything else (sensors, estimator, turn-taking, supervisor, plant) is that of the
//! product, so what is tested here is what would be flashed. `docs/controller.md` explains it step by step.

use sprag_shared::control::law::{Law, Situation, Wish};
use sprag_sim::closed_loop::plant::Extremes;
use sprag_sim::interrupt::Interrupt;
use sprag_studies::loop_study::bench::{Conditions, Variant, run_loop, with_loop};
use sprag_studies::loop_study::motion::Motion;

/// Resists only a block that moves outward.
#[derive(Clone, Copy)]
struct OutwardOnly;

impl Law for OutwardOnly {
    fn wish(&self, at: &Situation<'_>) -> Wish {
        let outward = at.signs.velocity == at.signs.rotation;
        let accelerating = at.signs.push == at.signs.velocity;
        if outward && accelerating { Wish::Resist } else { Wish::Release }
    }
}

/// Peak |θ|/α in closed loop with `law`.
fn peak_with(law: OutwardOnly, motion: &Motion, variant: &Variant) -> f64 {
    with_loop(motion, variant, &Conditions::new(None, &Interrupt::default()), |task| {
        let mut driver = task.driver_by(law)?;
        let mut extremes = Extremes::default();
        task.run_with(&mut *driver, &mut (), &mut extremes, &mut ())?;
        Ok(extremes.peaks.rotation / task.scene.block.slenderness())
    })
    .unwrap()
}

#[test]
fn a_law_of_ones_own_is_tested_as_it_would_be_flashed() {
    let motion = Motion::Pulse { shape: "sine", frequency: 4.0, amplitude: 2.0 };
    let real = Variant::new("real", &["controller.sensors.suite=\"adis16470\"", "controller.latency_s=0.001"]);
    let own = peak_with(OutwardOnly, &motion, &real);
    let passive =
        run_loop(&motion, &real.with("controller.law=\"passive\""), &Conditions::new(None, &Interrupt::default())).unwrap();
    let resisting =
        run_loop(&motion, &real.with("controller.law=\"resisting-predicted\""), &Conditions::new(None, &Interrupt::default()))
            .unwrap();
    // Half of Eq. 10 is worth something, and less than all of it.
    assert!(own < passive.peak, "{own} without, {}", passive.peak);
    assert!(resisting.peak < own, "{own} outward only, {}", resisting.peak);
}
