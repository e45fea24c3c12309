//! Clutches of a device whose support moves against the ground: they follow the motion of its terminals, v = ẋ − z, not that of the block.

use crate::equation::{Model, Shaking};
use crate::mode::State;
use crate::step::SUPPORT;

/// Speeds (m/s) up to which the terminals have just turned, or not moved yet.
const STILL: f64 = 1e-12;

impl Model {
    /// Clutches obey Eq. 10 by the motion of the terminals.
    pub fn follows_terminals(&self) -> bool {
        self.device.is_commanded() && self.support.moves()
    }

    /// v, the speed of the terminals against one another, m/s.
    pub fn terminals_now(&self, state: &State) -> f64 {
        self.rack_now(state) - state.values[SUPPORT]
    }

    /// The sign of v as a run begins: where nothing moves yet, that of the acceleration. Without that either, no clutch is wanted.
    pub fn begin_terminals(&self, state: &mut State, shaking: Shaking) {
        if !self.follows_terminals() {
            return;
        }
        self.take_terminals(state);
        self.look_at_drive(state, shaking);
        if self.terminals_now(state) != 0.0 {
            return;
        }
        if self.drive(state, shaking) == 0.0 {
            state.drive = -state.terminals;
        } else {
            state.terminals = state.drive;
        }
    }

    /// The sign of v as it is; where that is zero, as it was.
    pub fn take_terminals(&self, state: &mut State) {
        let speed = self.terminals_now(state);
        if speed != 0.0 {
            state.terminals = speed.signum();
        }
    }

    /// Where the ground jumps or the block sets out, terminals that do not move are about to, the way they accelerate.
    pub fn look_at_terminals(&self, state: &mut State, shaking: Shaking) {
        if !self.follows_terminals() || self.terminals_now(state).abs() > STILL {
            return;
        }
        let acceleration = self.drive(state, shaking);
        if acceleration != 0.0 {
            state.terminals = acceleration.signum();
        }
    }

    /// A block that does not move: what is due is carried out, and where the block stays, its clutches are commanded for the motion of
    /// the support. Those of a block on a support that moves with the ground have no motion to follow.
    pub fn command_at_rest(&self, state: &mut State, shaking: Shaking) {
        self.carry_out(state);
        if self.follows_terminals() && self.way_of_block(state, shaking) == 0.0 {
            self.look_at_drive(state, shaking);
            if shaking.support == 0.0 {
                // Without an acceleration there is nothing to resist.
                state.drive = -state.terminals;
            }
            self.command(state);
        }
    }
}
