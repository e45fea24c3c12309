//! Modes of the automaton (`docs/modes.md`) and the state that goes with them.

use crate::actuation::Command;
use crate::step::{ROTATION, SIZE, SPIN, TWIST, VELOCITY};

/// What the block does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BlockMode {
    /// At rest on its base, θ = θ̇ = 0.
    Standing,
    /// Turning about one toe.
    Rocking {
        /// s = sgn θ, or the side it moves to.
        side: f64,
        /// sgn θ̇, or the sign it is about to take.
        direction: f64,
    },
    /// Tilted, held by dry friction.
    Held {
        /// s = sgn θ.
        side: f64,
    },
    /// It will not come back.
    Overturned,
}

/// How one flywheel hangs on the rack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Link {
    /// Not at all.
    Open,
    /// w = ẋ, or w = ẋ − z on a support that moves.
    Locked,
    /// Plates slip; the flywheel is pulled along with this sign.
    Slipping(f64),
    /// Pulled along by the difference of the speeds.
    Dragged,
    /// Engaged, within the backlash.
    Play,
    /// On the spring, at this side of the backlash.
    Contact(f64),
    /// On the spring at this side, and the plates in series slip with this sign.
    Saturated(f64, f64),
}

/// One flywheel.
#[derive(Clone, Copy, Debug)]
pub struct Wheel {
    /// Its link.
    pub link: Link,
    /// The way it turns, for its dry friction; none while that friction holds it.
    pub turning: Option<f64>,
    /// Command and clocks of its clutch.
    pub command: Command,
    /// Created by its clutch in a swing that does not count, while it does not and the clutch holds, 1/s².
    pub lent: f64,
}

/// Everything at an instant.
#[derive(Clone, Debug)]
pub struct State {
    /// s.
    pub time: f64,
    /// Rotation, velocity, speeds, twists, and integrals of powers; see [`crate::step`].
    pub values: [f64; SIZE],
    /// The block's mode.
    pub block: BlockMode,
    /// The flywheels'.
    pub wheels: [Wheel; 2],
    /// Sign of the terminals' acceleration by weight and ground alone (Eq. 10), as last found.
    pub drive: f64,
    /// Sign of the speed of the terminals, as last found, where clutches follow that on a support that moves.
    pub terminals: f64,
    /// The acceleration has come to agree with that sign, so that its zero is a change.
    pub armed: bool,
    /// Engagements so far that have a number.
    pub engagements: u32,
    /// The last impact left the block so slow that engagements of its swing have none.
    pub weak: bool,
    /// Impacts so far that have a number.
    pub impacts: u32,
    /// Sign of the force of what is locked over that of the motion, as last found: friction of the mesh adds to it or takes from it.
    pub load: f64,
    /// The flywheel whose force has just reached the capacity of its plates, or zero (overrunning): it slips or parts, whatever
    /// rounding says.
    pub slipped: Option<usize>,
}

impl State {
    /// θ.
    pub fn rotation(&self) -> f64 {
        self.values[ROTATION]
    }

    /// θ̇.
    pub fn velocity(&self) -> f64 {
        self.values[VELOCITY]
    }

    /// w of a flywheel, m/s.
    pub fn spin(&self, wheel: usize) -> f64 {
        self.values[SPIN + wheel]
    }

    /// z of its clutch, m.
    pub fn twist(&self, wheel: usize) -> f64 {
        self.values[TWIST + wheel]
    }

    /// s of δ = αs − θ.
    pub fn side(&self) -> f64 {
        match self.block {
            BlockMode::Rocking { side, .. } | BlockMode::Held { side } => side,
            BlockMode::Standing => 1.0,
            BlockMode::Overturned => self.rotation().signum(),
        }
    }

    /// The block is on its way, and which.
    pub fn direction(&self) -> Option<f64> {
        match self.block {
            BlockMode::Rocking { direction, .. } => Some(direction),
            _ => None,
        }
    }
}

/// The flywheel that works for motion in this direction.
pub fn wheel_for(direction: f64) -> usize {
    usize::from(direction < 0.0)
}
