//! Time, counted in ticks of the controller: whole numbers neither drift nor lose their last digits.

/// A time that never comes.
pub const NEVER: u32 = u32::MAX;

/// The share of a tick by which a time may exceed a whole number of ticks and still be that number: 3 ms at 2 kHz is 6 ticks even where
/// f32 divides to 6.0000001.
const FORGIVEN: f32 = 1e-3;

/// The fewest ticks of `period` s that last `seconds`. Both at least 0 and finite; the result saturates.
pub fn ticks(seconds: f32, period: f32) -> u32 {
    let exact = seconds / period;
    let whole = exact as u32;
    if exact - whole as f32 > FORGIVEN { whole.saturating_add(1) } else { whole }
}

/// As [`ticks`], but a time of 0 means that what is timed is switched off.
pub fn ticks_or_never(seconds: f32, period: f32) -> u32 {
    if seconds > 0.0 { ticks(seconds, period) } else { NEVER }
}

/// For how long a condition has held without a break.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Streak(u32);

impl Streak {
    /// To be called once a tick.
    #[inline]
    pub fn note(&mut self, holds: bool) {
        self.0 = if holds { self.0.saturating_add(1) } else { 0 };
    }

    /// Whether the condition holds and first did so `ticks` ago or earlier: 0 is at once, [`NEVER`] is never.
    #[inline]
    pub fn lasted(&self, ticks: u32) -> bool {
        self.0 > ticks
    }

    /// In how many ticks it has been found to hold.
    pub fn length(&self) -> u32 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_ticks_that_are_not_too_few() {
        for (seconds, expected) in [(0.0, 0), (0.003, 6), (0.0031, 7), (0.0005, 1), (0.000_4, 1), (2.0, 4000)] {
            assert_eq!(ticks(seconds, 0.0005), expected, "{seconds}");
        }
        assert_eq!(ticks(f32::MAX, 0.0005), u32::MAX);
        assert_eq!(ticks_or_never(0.0, 0.0005), NEVER);
        assert_eq!(ticks_or_never(0.004, 0.0005), 8);
    }

    #[test]
    fn a_streak_lasts_from_its_first_tick() {
        let mut streak = Streak::default();
        assert!(!streak.lasted(0));
        streak.note(true);
        assert!(streak.lasted(0) && !streak.lasted(1));
        streak.note(true);
        assert!(streak.lasted(1));
        streak.note(false);
        assert!(!streak.lasted(0));
        assert!(!Streak(u32::MAX).lasted(NEVER));
    }
}
