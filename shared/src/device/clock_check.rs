//! The rate of a board's clock, by an oscillator that has nothing to do with it.
//!
//! A slow internal oscillator is measured twice: at the start by the fast internal oscillator, and ever after by the crystal. What the slow
//! one itself is off by cancels; what it drifts with temperature is followed, while a crystal that changes to another rate does so at once.

/// By which share of its rate a clock may be off: the fast internal oscillator of an F405 is within 4 % from -10 to 85 °C.
pub const TOLERANCE: f32 = 0.05;

/// Measurements in a row that must be off: one may have been disturbed.
const CONFIRMED: u8 = 3;

/// Share of its distance by which the expected value follows a measurement: a minute at one a second.
const FOLLOWED: f32 = 1.0 / 64.0;

/// The check.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClockCheck {
    /// Counts of the clock between two edges.
    expected: f32,
    off: u8,
}

impl ClockCheck {
    /// By so many counts of the clock between two edges of the slow oscillator, as the fast internal one has measured them; 0 where none came.
    pub const fn new(expected: f32) -> ClockCheck {
        ClockCheck { expected, off: 0 }
    }

    /// A measurement, counts between two edges. Whether the clock is off by more than [`TOLERANCE`] again and again.
    pub fn is_off(&mut self, counts: u32) -> bool {
        let away = counts as f32 - self.expected;
        if counts > 0 && away.abs() <= TOLERANCE * self.expected {
            self.expected += FOLLOWED * away;
            self.off = 0;
        } else {
            self.off = self.off.saturating_add(1);
        }
        self.off >= CONFIRMED
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eight periods of 32 kHz at 84 MHz.
    const EDGES: u32 = 21_000;

    #[test]
    fn a_clock_that_is_off_is_found_at_the_third_measurement() {
        for (share, found) in [(0.94, true), (0.96, false), (1.0, false), (1.04, false), (1.06, true), (3.0, true), (0.0, true)] {
            let mut check = ClockCheck::new(EDGES as f32);
            let says = [(); 4].map(|()| check.is_off((share * EDGES as f32) as u32));
            assert_eq!(says, [false, false, found, found], "{share}");
        }
    }

    #[test]
    fn a_single_wrong_measurement_is_none() {
        let mut check = ClockCheck::new(EDGES as f32);
        assert!((0..1000).all(|turn| !check.is_off(if turn % 3 == 2 { EDGES } else { 2 * EDGES })));
    }

    #[test]
    fn a_slow_oscillator_that_stands_is_found() {
        let mut check = ClockCheck::new(0.0);
        assert!(!check.is_off(0) && !check.is_off(0) && check.is_off(0));
    }

    /// 40 % over four hours.
    #[test]
    fn a_slow_oscillator_that_drifts_with_temperature_is_followed() {
        let mut check = ClockCheck::new(EDGES as f32);
        assert!((0..14_400).all(|second| !check.is_off(EDGES + EDGES * 4 / 10 * second / 14_400)));
        // From there, a step is found.
        assert!(!check.is_off(EDGES) && !check.is_off(EDGES) && check.is_off(EDGES));
    }
}
