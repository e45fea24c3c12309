//! Which flywheel resists: the two take turns by the direction of motion, so that the one released can spin down.

use super::Wish;
use crate::control::estimation::estimate::Estimate;
use crate::control::model::Model;
use crate::equation::clutch_rule::wheel_for;
use crate::math::sign::Sign;

/// What turn-taking remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TurnsState {
    /// Speeds of the flywheels as racks that moved with them, over R, 1/s.
    pub spins: [f32; 2],
    /// Flywheel whose turn it is.
    pub turn: Option<usize>,
}

/// How much faster than the rack (over R, 1/s, as a share of α) a flywheel may be that is taken on.
pub const AHEAD: f32 = 0.02;

impl TurnsState {
    /// The speeds a `period` (s) later: of an engaged flywheel that of the rack, of a released one less than before.
    #[inline]
    pub fn spin(&mut self, model: &Model, now: &Estimate, engaged: [bool; 2], period: f32) {
        self.spin_at(model, model.rack_speed(now.side, now.rotation, now.velocity), engaged, period);
    }

    /// [`TurnsState::spin`] where the speed of the `rack` is known already.
    #[inline]
    pub fn spin_at(&mut self, model: &Model, rack: f32, engaged: [bool; 2], period: f32) {
        if engaged == [true; 2] {
            self.spins = [rack; 2];
            return;
        }
        for (spin, engaged) in self.spins.iter_mut().zip(engaged) {
            *spin = if engaged { rack } else { model.coasted(*spin, period) };
        }
    }

    /// The clutches of a block that stands and is to be resisted as soon as it moves. Which way it will move nobody knows, so both flywheels
    /// wait on the rack, and the first motion gives the turn to the one of its direction. One that still spins would push the block.
    #[inline]
    pub fn wait(&mut self, model: &Model) -> [bool; 2] {
        self.turn = None;
        self.spins.map(|spin| spin.abs() <= AHEAD * model.parameters.slenderness)
    }

    /// The clutches that carry out `wish` for motion in `direction` at θ̇ = `velocity`. A flywheel keeps its turn for as long as the
    /// wish lasts, also through a turn of the motion: there the rack stands, and changing wheels would only open a gap. A new turn goes
    /// to the flywheel of the direction, unless it still runs ahead of the rack, so that taking it on would drive the block; then to the
    /// other one, unless that does too.
    #[inline]
    pub fn take(&mut self, model: &Model, wish: Wish, direction: Sign, now: &Estimate) -> [bool; 2] {
        self.turn = match wish {
            Wish::Release => None,
            Wish::Hold => Some(0),
            Wish::Resist => self.turn.or_else(|| {
                let rack = direction.times(model.rack_speed(now.side, now.rotation, now.velocity));
                let own = wheel_for(direction);
                let most = rack + AHEAD * model.parameters.slenderness;
                let behind = self.spins.map(|spin| direction.times(spin) <= most);
                let [first, second] = behind;
                match (own, first, second) {
                    (0, true, _) => Some(0),
                    (0, false, true) => Some(1),
                    (1, _, true) => Some(1),
                    (1, true, false) => Some(0),
                    _ => None,
                }
            }),
        };
        [self.turn == Some(0), self.turn == Some(1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::tests::spinning_model;

    fn moving(velocity: f32) -> Estimate {
        Estimate { rotation: 0.05, velocity, ..Estimate::default() }
    }

    #[test]
    fn turns_go_by_the_direction_of_motion_and_are_kept() {
        let model = spinning_model();
        let mut turns = TurnsState::default();
        assert_eq!(turns.take(&model, Wish::Resist, Sign::Positive, &moving(0.2)), [true, false]);
        // Through a turn of the motion.
        assert_eq!(turns.take(&model, Wish::Resist, Sign::Negative, &moving(-0.1)), [true, false]);
        assert_eq!(turns.take(&model, Wish::Release, Sign::Negative, &moving(-0.1)), [false, false]);
        assert_eq!(turns.take(&model, Wish::Resist, Sign::Negative, &moving(-0.1)), [false, true]);
    }

    #[test]
    fn a_flywheel_that_runs_ahead_is_not_taken_on() {
        let model = spinning_model();
        let mut turns = TurnsState { spins: [0.3, 0.0], turn: None };
        assert_eq!(turns.take(&model, Wish::Resist, Sign::Positive, &moving(0.1)), [false, true], "the other one is at rest");
        turns = TurnsState { spins: [0.3, 0.25], turn: None };
        assert_eq!(turns.take(&model, Wish::Resist, Sign::Positive, &moving(0.1)), [false, false], "both would drive");
        turns = TurnsState { spins: [0.3, 0.25], turn: None };
        assert_eq!(turns.take(&model, Wish::Resist, Sign::Positive, &moving(0.4)), [true, false], "the rack is faster");
    }

    #[test]
    fn both_wait_for_a_block_that_stands_and_the_first_motion_decides() {
        let model = spinning_model();
        for (direction, command) in [(Sign::Positive, [true, false]), (Sign::Negative, [false, true])] {
            let mut turns = TurnsState { turn: Some(0), ..TurnsState::default() };
            assert_eq!(turns.wait(&model), [true; 2]);
            let first = moving(direction.times(1e-6));
            assert_eq!(turns.take(&model, Wish::Resist, direction, &first), command);
        }
        let mut turns = TurnsState { spins: [0.0, -0.3], turn: None };
        assert_eq!(turns.wait(&model), [true, false], "the second one still spins");
    }

    #[test]
    fn released_flywheels_spin_down_by_the_model() {
        let model = spinning_model();
        let mut turns = TurnsState::default();
        turns.spin(&model, &moving(-0.3), [false, true], 5e-4);
        let fast = turns.spins[1];
        assert!(fast < -0.25 && turns.spins[0] == 0.0);
        for _ in 0..2000 {
            turns.spin(&model, &moving(0.0), [false, false], 5e-4);
        }
        // ẇ = −c w − d.
        let (c, d) = (f64::from(model.parameters.decay), f64::from(model.parameters.drag));
        let exact = -((f64::from(-fast) + d / c) * crate::math::exp(-c) - d / c).max(0.0);
        assert!((f64::from(turns.spins[1]) - exact).abs() < 1e-4, "{} {exact}", turns.spins[1]);
    }
}
