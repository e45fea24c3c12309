//! Whether the block stands on both toes, where sensors say nothing but noise.

use super::estimate::Estimate;
use super::state::EstimatorState;
use crate::control::model::Model;
use crate::control::sensing::instruments::Measured;
use crate::math::sign::Sign;

/// When a block stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// |θ| below which it may stand, rad.
    pub rotation: f32,
    /// |θ̇| below which it may stand, rad/s.
    pub velocity: f32,
    /// Ticks for which both must hold.
    pub ticks: u16,
}

impl Standing {
    /// Looks at the motion as an estimator has it at this tick; `true` while the block stands, and then at θ = 0. A standing block is let go
    /// when the ground pushes harder than its weight holds, or when it moves, to the side that the state then has.
    #[inline]
    pub(super) fn step(&self, state: &mut EstimatorState, model: &Model, seen: &Measured) -> bool {
        let (rotation, velocity) = (state.rotation, state.velocity);
        let holds = model.parameters.uplift * (1.0 + seen.ground[1]);
        let pushed = seen.ground[0].abs() > holds;
        let moves = rotation.abs() > self.rotation || velocity.abs() > self.velocity;
        if !state.rocks {
            if pushed || moves {
                let otherwise = Sign::of(-seen.ground[0], state.side);
                state.side = if moves { Sign::of(velocity + rotation, otherwise) } else { otherwise };
                (state.rocks, state.still) = (true, 0);
            }
        } else {
            state.still = if pushed || moves { 0 } else { state.still.saturating_add(1) };
            if state.still > self.ticks {
                (state.rocks, state.still) = (false, 0);
            }
        }
        if !state.rocks {
            (state.rotation, state.velocity, state.acceleration) = (0.0, 0.0, 0.0);
        }
        !state.rocks
    }

    /// What is known of a standing block.
    #[inline]
    pub fn estimate(seen: &Measured, side: Sign) -> Estimate {
        Estimate { side, ground: seen.ground, ground_rate: seen.ground_rate, standing: true, ..Estimate::default() }
    }
}
