//! Whether the block stands on both toes.
//!
//! A block that stands is at θ = 0, whatever the encoder says: its count there is followed within a fraction of a second, so that a rack
//! that creeps with temperature moves no block.

use super::estimate::Estimate;
use super::state::EstimatorState;
use crate::control::model::Model;
use crate::control::sensing::instruments::{Instruments, Measured};
use crate::math::sign::Sign;

/// When a block stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// |θ| by the encoder beyond which a block that stood moves, rad; one that rocked stands again within [`SETTLED`] of it.
    pub rotation: f32,
    /// |θ̇| below which a block that rocked may stand, rad/s.
    pub velocity: f32,
    /// Ticks for which a block that rocked must look as if it stood.
    pub ticks: u16,
}

/// Share of [`Standing::rotation`]; the rest is hysteresis.
pub const SETTLED: f32 = 0.25;

/// Time in which the encoder's zero follows a block that stands, s: longer than an uplift takes to be noticed, and quick for any creep.
const FOLLOWING: f32 = 0.2;

/// By how much longer than [`Standing::ticks`] a block must be still where nobody knows its rotation: within 1 % of its point of no return
/// it may hesitate for half a second, and nowhere else.
const PATIENCE: u32 = 25;

impl Standing {
    /// Looks at the readings of this tick, of a block that stood at the last one; `true` while it does. It is let go when the ground
    /// pushes harder than its weight holds, or when it moves by the encoder or, twice in a row by more than a `jump`, by a gyroscope that is
    /// believed (`rate`; both rad/s), to the side that the state then has.
    // Into the tick, as its caller is: the readings need not go through memory then.
    #[inline(always)]
    pub(super) fn holds(
        &self,
        state: &mut EstimatorState,
        model: &Model,
        instruments: &Instruments,
        seen: &Measured,
        rate: Option<f32>,
        jump: f32,
    ) -> bool {
        if state.lost {
            self.begin(state, seen);
        }
        let away = seen.travel.map_or(0.0, |travel| travel - state.offset);
        let turns = rate.is_some_and(|rate| (rate - state.bias).abs() > jump);
        let turned = turns && state.doubted;
        state.doubted = if rate.is_some() { turns } else { state.doubted };
        let rate = rate.map_or(0.0, |rate| rate - state.bias);
        let pushed = self.pushed(model, seen);
        let moved = away.abs() > self.rotation * model.standing_arm();
        if !(pushed || moved || turned) {
            state.offset += away * (instruments.period / FOLLOWING);
            return true;
        }
        let otherwise = Sign::of(-seen.ground[0], state.side);
        state.side = if moved || turned { Sign::of(if moved { away } else { rate }, otherwise) } else { otherwise };
        (state.rocks, state.still, state.doubted) = (true, 0, false);
        if moved {
            state.rotation = model.rotation_of_travel(away, 0.0, state.side);
        }
        if moved || turned {
            state.velocity = rate;
        }
        state.bound();
        false
    }

    /// After power-on the first count is as good a zero as any; that of a block which then stays as it is, is the one of θ = 0.
    #[inline(never)]
    fn begin(&self, state: &mut EstimatorState, seen: &Measured) {
        match seen.travel {
            Some(travel) if state.still == 0 => (state.offset, state.still) = (travel, 1),
            Some(_) if state.still > PATIENCE * u32::from(self.ticks) => state.stand(None),
            Some(_) => state.still = state.still.saturating_add(1),
            None => {}
        }
    }

    /// Looks at the motion of a block that rocked at the last tick, as an estimator has it at this one; `true` once it stands.
    #[inline]
    pub(super) fn settles(&self, state: &mut EstimatorState, model: &Model, seen: &Measured) -> bool {
        let still = state.velocity.abs() <= self.velocity
            && (state.lost || state.rotation.abs() <= SETTLED * self.rotation + state.reference.reach())
            && !self.pushed(model, seen);
        state.still = if still { state.still.saturating_add(1) } else { 0 };
        let needed = if state.lost { PATIENCE * u32::from(self.ticks) } else { self.ticks.into() };
        if state.still <= needed {
            return false;
        }
        state.stand(seen.travel);
        true
    }

    #[inline]
    fn pushed(&self, model: &Model, seen: &Measured) -> bool {
        seen.ground[0].abs() > model.parameters.uplift * (1.0 + seen.ground[1])
    }

    /// What is known of a standing block.
    #[inline]
    pub fn estimate(seen: &Measured, side: Sign) -> Estimate {
        Estimate { side, ground: seen.ground, ground_rate: seen.ground_rate, standing: true, ..Estimate::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::tests::example_model;

    /// One that never moves, from power-on and from a reset in motion on, by the longest time that may be set.
    #[test]
    fn a_block_that_nobody_has_located_stands_in_the_end() {
        let (model, seen) = (example_model(), Measured { travel: Some(0.0), ..Measured::default() });
        let standing = Standing { rotation: 1e-4, velocity: 1e-3, ticks: u16::MAX };
        let needed = 25 * 65_535;
        let mut state = EstimatorState::unknown();
        let begun = (0..2 * needed).find(|_| {
            standing.begin(&mut state, &seen);
            !state.lost
        });
        assert_eq!(begun, Some(needed + 1));
        let mut state = EstimatorState::met(0.0, 0.0);
        let settled = (0..2 * needed).find(|_| standing.settles(&mut state, &model, &seen));
        assert_eq!((settled, state.lost), (Some(needed), false));
    }
}
