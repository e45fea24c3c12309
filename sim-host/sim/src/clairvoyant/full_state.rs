//! Full-state feedback: the controller's own decisions on the motion as it is, without sensors and without an estimator.
//!
//! What a law loses to sensors is not in it, so that a run costs little: laws are trained by it, and judged by the closed loop.

use std::collections::VecDeque;

use sprag_shared::control::controller::Controller;
use sprag_shared::control::estimation::estimate::Estimate;
use sprag_shared::control::law::Law;
use sprag_shared::control::law::any_law::ClutchLaw;
use sprag_shared::math::sign::Sign;
use sprag_shared::structure::error::ParameterError;

use super::rocker::{Engaged, OPEN, Place, Rocker};
use super::shaking::Shaking;
use crate::closed_loop::LoopTask;
use crate::ground_motion::GroundMotion;

/// How long after the ground motion the block is followed at most, 1/p.
const AFTERWARDS: f64 = 8.0;

/// What a controller made of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Followed {
    /// Peak |θ|/α; none of a block that overturned.
    pub peak: Option<f64>,
    /// Engagements, until the block stood or fell.
    pub engagements: u32,
}

/// A block with its controller.
#[derive(Clone, Debug)]
pub struct FullState {
    rocker: Rocker,
    controller: Controller<ClutchLaw>,
    /// Of a tick, s.
    period: f64,
    /// Ticks from a command to clutches that have moved.
    delay: usize,
}

impl FullState {
    /// Of the scene's device and controller; none for a device that is neither an ideal clutched pair nor a rigid one.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn of(task: &LoopTask<'_>) -> Result<Option<FullState>, ParameterError> {
        let Some(rocker) = Rocker::of(&task.machine()?, task.scene.geometry()) else { return Ok(None) };
        let clock = task.clock();
        let delay = (clock.actuation / clock.period).round() as usize;
        let controller = task.controller(task.controller.clutch_law())?;
        Ok(Some(FullState { rocker, controller, period: clock.period, delay }))
    }

    /// A ground motion, tick by tick.
    pub fn shaking(&self, ground: &GroundMotion) -> Shaking {
        Shaking::of(ground, self.period, 1, AFTERWARDS / self.rocker.frequency())
    }

    /// What `law` makes of a motion of a block that has stood.
    pub fn follow(&self, law: ClutchLaw, shaking: &Shaking) -> Followed {
        let controller = Controller { law, ..self.controller };
        let mut state = controller.start();
        let mut place = Place::REST;
        let still = estimate(&controller, &place, [0.0; 2], self.period);
        let ticks = 1 + usize::from(controller.gate.dwell);
        place.engaged = (0..ticks).fold(OPEN, |engaged, _| controller.choose(&mut state, &still, engaged).1);
        let mut commands = VecDeque::from(vec![place.engaged; self.delay]);
        let (mut last, mut engagements) = (0.0, 0);
        for part in shaking.parts() {
            let limit = self.rocker.no_return(part.bound);
            for &ground in part.ground {
                let estimate = estimate(&controller, &place, [last, ground], self.period);
                last = ground;
                commands.push_back(controller.choose(&mut state, &estimate, place.engaged).1);
                let command: Engaged = commands.pop_front().unwrap_or_default();
                if command != place.engaged {
                    engagements += u32::from(command != OPEN);
                    self.rocker.engage(&mut place, command);
                }
                self.rocker.step(&mut place, ground, self.period);
                if place.rotation.abs() >= limit && place.rotation * place.velocity > 0.0 {
                    return Followed { peak: None, engagements };
                }
            }
            if part.quiet
                && let Some(peak) = self.rocker.settles_at(&place)
            {
                return Followed { peak: Some(peak / self.rocker.slenderness()), engagements };
            }
        }
        Followed { peak: None, engagements }
    }
}

/// The motion in single precision, under ground accelerations (g) of a tick ago and now.
fn estimate<L: Law>(controller: &Controller<L>, place: &Place, [before, now]: [f64; 2], period: f64) -> Estimate {
    let side = Sign::of(place.side as f32, Sign::Positive);
    let (rotation, velocity, ground) = (place.rotation as f32, place.velocity as f32, [now as f32, 0.0]);
    if place.standing {
        return Estimate { side, ground, standing: true, ..Estimate::default() };
    }
    Estimate {
        rotation,
        velocity,
        side,
        push: controller.model.push(side, rotation, velocity, ground),
        ground,
        ground_rate: ((now - before) / period) as f32,
        standing: false,
        ..Estimate::default()
    }
}
