//! Whether the block stands on both toes, where sensors say nothing but noise.

use super::estimate::Estimate;
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

/// What it remembers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StandingState {
    /// It stands.
    pub stands: bool,
    ticks: u16,
}

impl Default for StandingState {
    fn default() -> Self {
        StandingState { stands: true, ticks: 0 }
    }
}

impl StandingState {
    /// Of a block that rocks.
    pub(super) const ROCKING: StandingState = StandingState { stands: false, ticks: 0 };
}

impl Standing {
    /// Looks at θ and θ̇ as an estimator has them at this tick; `true` while the block stands. A standing block is let go when the
    /// ground pushes harder than its weight holds, or when it moves; the side it moves to is written to `side`.
    #[inline]
    pub fn step(
        &self,
        state: &mut StandingState,
        model: &Model,
        seen: &Measured,
        (rotation, velocity): (f32, f32),
        side: &mut Sign,
    ) -> bool {
        let holds = model.parameters.uplift * (1.0 + seen.ground[1]);
        let pushed = seen.ground[0].abs() > holds;
        let moves = rotation.abs() > self.rotation || velocity.abs() > self.velocity;
        if state.stands {
            if pushed || moves {
                let otherwise = Sign::of(-seen.ground[0], *side);
                *side = if moves { Sign::of(velocity + rotation, otherwise) } else { otherwise };
                *state = StandingState { stands: false, ticks: 0 };
            }
        } else {
            state.ticks = if pushed || moves { 0 } else { state.ticks.saturating_add(1) };
            if state.ticks > self.ticks {
                *state = StandingState { stands: true, ticks: 0 };
            }
        }
        state.stands
    }

    /// What is known of a standing block.
    #[inline]
    pub fn estimate(seen: &Measured, side: Sign) -> Estimate {
        Estimate { side, ground: seen.ground, ground_rate: seen.ground_rate, standing: true, ..Estimate::default() }
    }
}
