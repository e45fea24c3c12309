//! Clutch rule of an ideal device: never engaged, always, or by Eq. 10.

use crate::math::sign::Sign;

/// Clutch rule of an ideal device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClutchRule {
    /// There is no inerter.
    Without,
    /// One inerter, always engaged.
    Always,
    /// Eq. 10: engaged while acceleration and velocity have one sign. Two flywheels take turns: the first works on motion in
    /// the positive direction, the second on the negative, and each spins down while idle.
    Resisting,
}

impl ClutchRule {
    /// Whether there is an inerter at all.
    pub const fn has_inerter(self) -> bool {
        !matches!(self, ClutchRule::Without)
    }

    /// Whether engagement depends on the signs, so that their changes are events.
    pub const fn follows_signs(self) -> bool {
        matches!(self, ClutchRule::Resisting)
    }

    /// Whether an inerter is engaged while the velocity has the sign `direction` and the terminals' acceleration the
    /// sign `terminal_acceleration_sign`.
    pub fn engages(self, direction: Sign, terminal_acceleration_sign: Sign) -> bool {
        match self {
            ClutchRule::Without => false,
            ClutchRule::Always => true,
            ClutchRule::Resisting => direction == terminal_acceleration_sign,
        }
    }

    /// The flywheel that transfers force, if one is engaged: that of the direction, or the only one.
    pub fn flywheel(self, engaged: bool, direction: Sign) -> Option<usize> {
        engaged.then(|| if self.follows_signs() { wheel_for(direction) } else { 0 })
    }
}

/// The flywheel for motion in `direction`.
pub fn wheel_for(direction: Sign) -> usize {
    match direction {
        Sign::Positive => 0,
        Sign::Negative => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pair_resists_and_never_drives() {
        use Sign::{Negative, Positive};
        let pair = ClutchRule::Resisting;
        assert!(pair.engages(Positive, Positive) && pair.engages(Negative, Negative));
        assert!(!pair.engages(Positive, Negative) && !pair.engages(Negative, Positive));
        assert_eq!(pair.flywheel(true, Negative), Some(1));
        assert_eq!(ClutchRule::Always.flywheel(true, Negative), Some(0));
        assert_eq!(pair.flywheel(false, Negative), None);
    }
}
