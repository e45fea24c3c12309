//! The coil of a clutch: full current to pull in, less to hold, and what the current says of it.

use crate::control::ticks::ticks;

/// Current per count of the converter, A: 3.3 V over 4096 counts, by an amplifier of 50 V/V on a shunt of 50 mΩ.
pub const AMPERES_PER_COUNT: f32 = 3.3 / 4096.0 / (50.0 * 0.05);

/// Current at and beyond which the converter shows nothing more, A: two counts below its last, for noise.
pub const FULL_SCALE: f32 = 4093.0 * AMPERES_PER_COUNT;

/// Share of the threshold below which a coil that was engaged no longer is.
const RELEASE_SHARE: f32 = 0.7;

/// Current, A, of a converter's counts.
pub fn current(counts: u16) -> f32 {
    counts as f32 * AMPERES_PER_COUNT
}

/// How a coil is driven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeakHold {
    /// Ticks of full voltage after a command to engage.
    pub pull_in_ticks: u32,
    /// Share of the full voltage after them, 0 to 1.
    pub hold_share: f32,
}

impl PeakHold {
    /// Pulling in for `pull_in_time`, s, at ticks of `period`, s, then holding with `hold_share` of the voltage. What is not a number or
    /// out of range becomes the nearest that is in it; a share that is not a number becomes 1, which holds in any case.
    pub fn new(pull_in_time: f32, hold_share: f32, period: f32) -> PeakHold {
        let share = if hold_share.is_nan() { 1.0 } else { hold_share.clamp(0.0, 1.0) };
        PeakHold { pull_in_ticks: ticks(pull_in_time, period), hold_share: share }
    }

    /// Duty, 0 to 1, in the `tick`th tick of a pulse, from 1 on.
    #[inline]
    pub fn duty(&self, tick: u32) -> f32 {
        if tick <= self.pull_in_ticks { 1.0 } else { self.hold_share }
    }
}

/// Counts of a comparator that switches `period` counts in all, for a duty of 0 to 1.
pub fn compare(duty: f32, period: u16) -> u16 {
    let counts = duty * period as f32 + 0.5;
    // The conversion takes what is below 0 or not a number for 0.
    if counts >= period as f32 { period } else { counts as u16 }
}

/// Whether the current through a coil engages its clutch, with hysteresis; the default is released.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Feedback {
    engaged: bool,
}

impl Feedback {
    /// With a `current` of so many A, where `threshold` A are needed. A current that is not a number is none.
    pub fn engaged(&mut self, current: f32, threshold: f32) -> bool {
        let needed = if self.engaged { RELEASE_SHARE * threshold } else { threshold };
        self.engaged = current >= needed;
        self.engaged
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pulls_in_then_holds() {
        let coil = PeakHold { pull_in_ticks: 3, hold_share: 0.4 };
        assert_eq!([1, 2, 3, 4, 5, u32::MAX].map(|tick| coil.duty(tick)), [1.0, 1.0, 1.0, 0.4, 0.4, 0.4]);
        assert_eq!(PeakHold { pull_in_ticks: u32::MAX, ..coil }.duty(u32::MAX), 1.0);
    }

    #[test]
    fn strange_settings_hold_rather_than_burn_or_drop() {
        assert_eq!(PeakHold::new(0.05, 0.35, 0.0005), PeakHold { pull_in_ticks: 100, hold_share: 0.35 });
        assert_eq!(PeakHold::new(0.05, f32::NAN, 0.0005).hold_share, 1.0);
        assert_eq!(PeakHold::new(0.05, 7.0, 0.0005).hold_share, 1.0);
        assert_eq!(PeakHold::new(0.05, -7.0, 0.0005).hold_share, 0.0);
    }

    #[test]
    fn a_duty_becomes_counts_within_the_period() {
        assert_eq!(
            [0.0, 0.5, 1.0, 2.0, -1.0, f32::NAN, f32::INFINITY].map(|duty| compare(duty, 8400)),
            [0, 4200, 8400, 8400, 0, 0, 8400]
        );
        assert_eq!(compare(1.0, u16::MAX), u16::MAX);
    }

    #[test]
    fn feedback_has_hysteresis() {
        let mut feedback = Feedback::default();
        let says = [0.0, 0.19, 0.2, 0.15, 0.141, 0.13, 0.19, 0.2, f32::NAN].map(|current| feedback.engaged(current, 0.2));
        assert_eq!(says, [false, false, true, true, true, false, false, true, false]);
    }

    #[test]
    fn the_converter_spans_more_than_an_ampere() {
        assert_eq!(current(0), 0.0);
        assert!((current(4095) - 1.32).abs() < 0.001);
    }
}
