//! When the ideal clutch engages: not at all, always, or by Eq. 10.

use crate::scalar::Sign;

/// The rule of an ideal device, as a type, so that a device without a clutch has no clutch in its loop.
pub trait Clutch: Copy {
    /// The scene has an inerter at all.
    const INERTER: bool;
    /// Engagement depends on the signs, so that their changes are events.
    const FOLLOWS_SIGNS: bool;

    /// Whether an inerter is engaged while the velocity has the sign `direction` and the terminals' acceleration the
    /// sign `drive`.
    fn engaged(direction: Sign, drive: Sign) -> bool;
}

/// The block alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoInerter;

/// One inerter, always engaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleInerter;

/// Eq. 10: engaged while acceleration and velocity have one sign. Two flywheels take turns: the first works on motion in
/// the positive direction, the second on the negative, and each spins down while idle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClutchedPair;

impl Clutch for NoInerter {
    const INERTER: bool = false;
    const FOLLOWS_SIGNS: bool = false;

    #[inline(always)]
    fn engaged(_direction: Sign, _drive: Sign) -> bool {
        false
    }
}

impl Clutch for SingleInerter {
    const INERTER: bool = true;
    const FOLLOWS_SIGNS: bool = false;

    #[inline(always)]
    fn engaged(_direction: Sign, _drive: Sign) -> bool {
        true
    }
}

impl Clutch for ClutchedPair {
    const INERTER: bool = true;
    const FOLLOWS_SIGNS: bool = true;

    #[inline(always)]
    fn engaged(direction: Sign, drive: Sign) -> bool {
        direction == drive
    }
}

/// Which flywheel transfers force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Flywheel {
    /// None.
    #[default]
    Idle,
    /// The one for positive motion, or the only one.
    First,
    /// The one for negative motion.
    Second,
}

/// The flywheel that works under rule `C`.
pub fn flywheel<C: Clutch>(engaged: bool, direction: Sign) -> Flywheel {
    match (engaged, C::FOLLOWS_SIGNS, direction) {
        (false, _, _) => Flywheel::Idle,
        (true, true, Sign::Negative) => Flywheel::Second,
        _ => Flywheel::First,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pair_resists_and_never_drives() {
        use Sign::{Negative, Positive};
        assert!(ClutchedPair::engaged(Positive, Positive) && ClutchedPair::engaged(Negative, Negative));
        assert!(!ClutchedPair::engaged(Positive, Negative) && !ClutchedPair::engaged(Negative, Positive));
        assert_eq!(flywheel::<ClutchedPair>(true, Negative), Flywheel::Second);
        assert_eq!(flywheel::<SingleInerter>(true, Negative), Flywheel::First);
        assert_eq!(flywheel::<ClutchedPair>(false, Negative), Flywheel::Idle);
    }
}
