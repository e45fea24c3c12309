//! The controller of a closed loop: the shared code itself, or something that answers in its place.

use sprag_shared::control::controller::{Circumstances, Controller, ControllerState, Decision};
use sprag_shared::control::estimation::estimate::Estimate;
use sprag_shared::control::law::signs::Signs;
use sprag_shared::control::law::{DRIFT_TIME, Law, Situation, Wish};
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::supervisor::event_log::Entry;
use sprag_shared::math;
use sprag_shared::math::sign::Sign;

use super::plant::Whereabouts;

/// Who answers samples with decisions.
pub trait Driver {
    /// One tick.
    fn tick(&mut self, sample: &Sample, circumstances: Circumstances) -> Decision;

    /// What the law would want of the plant as it truly is, now and without hysteresis. Not `asked`, it only keeps up with the plant, and
    /// gives [`Wish::Release`].
    fn ideal(&mut self, plant: &Whereabouts, asked: bool) -> Wish;

    /// What its log holds, oldest first.
    fn log(&self) -> Vec<Entry>;
}

/// The shared controller and its state.
pub struct Shared<L> {
    /// Parameters.
    pub controller: Controller<L>,
    /// State.
    pub state: ControllerState,
    signs: Signs,
    drift: f64,
    /// Time over 1/p from tick to tick, and what is left of the drift after it.
    fading: (f64, f64),
    time: f64,
}

/// Ticks whose lengths differ by less than this fraction are as long: their ends are rounded.
const SAME_LENGTH: f64 = 1e-9;

impl<L: Law> Shared<L> {
    /// At power-on.
    pub fn new(controller: Controller<L>) -> Shared<L> {
        let state = controller.start();
        Shared { controller, state, signs: Signs::default(), drift: 0.0, fading: (0.0, 1.0), time: 0.0 }
    }
}

impl<L: Law> Driver for Shared<L> {
    fn tick(&mut self, sample: &Sample, circumstances: Circumstances) -> Decision {
        self.controller.tick(&mut self.state, sample, circumstances)
    }

    fn ideal(&mut self, plant: &Whereabouts, asked: bool) -> Wish {
        let (side, ground) = (plant.motion.side, plant.ground.map(|g| g as f32));
        let model = &self.controller.model;
        // The plant's own signs, which know which way a zero goes.
        self.signs = Signs {
            rotation: side,
            velocity: plant.motion.direction,
            push: plant.motion.terminal_acceleration_sign,
            ground: Sign::of(ground[0], self.signs.ground),
            quiet: ground[0] == 0.0,
        };
        let elapsed = f64::from(model.parameters.frequency) * (plant.time - self.time);
        if (elapsed - self.fading.0).abs() > SAME_LENGTH * elapsed {
            self.fading = (elapsed, math::exp(-elapsed / f64::from(DRIFT_TIME)));
        }
        self.drift = (self.drift + elapsed * plant.ground[0]) * self.fading.1;
        self.time = plant.time;
        if !asked {
            return Wish::Release;
        }
        let (rotation, velocity) = (plant.motion.rotation as f32, plant.motion.velocity as f32);
        let push = model.push(side, rotation, velocity, ground);
        let ground_rate = plant.ground_rate as f32;
        let estimate = Estimate { rotation, velocity, side, push, ground, ground_rate, ..Estimate::default() };
        self.controller.law.wish(&Situation {
            model,
            estimate,
            signs: self.signs,
            engaged: plant.engaged,
            spins: plant.spins.map(|spin| spin as f32),
            ground_drift: self.drift as f32,
        })
    }

    fn log(&self) -> Vec<Entry> {
        self.state.supervisor().log.iter().copied().collect()
    }
}
