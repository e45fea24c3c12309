//! One reading, looked at by itself: is it new, finite, within its range, and does it change?

use crate::control::sensing::sample::Reading;
use crate::control::ticks::Streak;

/// Readings that must repeat before they count as stuck, so that a slow sensor is not judged by two.
const FEWEST_REPEATS: u8 = 3;

/// Of a number's bits, those of its size.
const SIZE: u32 = u32::MAX >> 1;

/// When a reading is at fault: times in ticks, `stale` at least 1; `full_scale` above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WatchLimits {
    pub stale: u32,
    pub stuck: u32,
    pub stuck_moving: u32,
    pub full_scale: f32,
    pub saturation: u32,
}

/// What is known of a reading.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Watch {
    bits: u32,
    number: u32,
    last: Last,
    /// What came before; of a usual reading nothing did that matters.
    history: History,
}

/// What the last reading was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Last {
    /// New, another than the one before, and within its range, while the block did not move …
    UsualAtRest,
    /// … and while it did.
    UsualInMotion,
    /// New and the same as a usual one just before it, as happens by chance: while the block did not move at either …
    RepeatedAtRest,
    /// … and while it did at both.
    RepeatedInMotion,
    /// Anything else.
    #[default]
    Doubted,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct History {
    /// A reading has been taken.
    seen: bool,
    /// The sensor is there, so that a reading is due.
    due: bool,
    /// Identical new readings in a row, at any time and while the block moves.
    repeats: u8,
    repeats_moving: u8,
    /// Ticks since the last new reading.
    age: u32,
    saturated: Streak,
    unchanged: Streak,
    unchanged_moving: Streak,
}

impl Watch {
    /// Of a sensor that is there, though nothing has been read yet.
    pub fn expecting() -> Watch {
        Watch { history: History { due: true, ..History::default() }, ..Watch::default() }
    }

    /// Nothing that came before matters, nor can anything be held against the last reading.
    fn trusted(&self) -> bool {
        self.last != Last::Doubted
    }

    /// A reading has been taken.
    pub fn seen(&self) -> bool {
        self.trusted() || self.history.seen
    }

    /// One tick; `moving` says that the block does, by another sensor's account or this one's. `true` where there has been a reading and
    /// nothing can be held against it.
    #[inline(always)]
    pub fn step(&mut self, reading: Reading, limits: &WatchLimits, moving: bool) -> bool {
        let bits = reading.value.to_bits();
        // Sizes compare as their bits do, and those of what is not finite are the largest.
        let within = bits & SIZE < limits.full_scale.to_bits();
        if reading.number != self.number && bits != self.bits && within {
            let last = if moving { Last::UsualInMotion } else { Last::UsualAtRest };
            (self.number, self.bits, self.last) = (reading.number, bits, last);
            return true;
        }
        self.repeat(reading, limits, moving)
    }

    /// The same where the reading is not usual, but perhaps the first that repeats.
    #[inline(never)]
    fn repeat(&mut self, reading: Reading, limits: &WatchLimits, moving: bool) -> bool {
        if reading.number != self.number && reading.value.to_bits() == self.bits {
            let repeated = match (self.last, moving) {
                (Last::UsualAtRest, false) => Some(Last::RepeatedAtRest),
                (Last::UsualInMotion, true) => Some(Last::RepeatedInMotion),
                _ => None,
            };
            if let Some(last) = repeated {
                (self.number, self.last) = (reading.number, last);
                return true;
            }
        }
        self.doubt(reading, limits, moving)
    }

    /// One tick of a reading of which only the arrival is watched.
    #[inline]
    pub fn arrival(&mut self, number: u32, limits: &WatchLimits) -> bool {
        if number != self.number {
            (self.number, self.last) = (number, Last::UsualAtRest);
            return true;
        }
        let history = self.recall();
        history.age = history.age.saturating_add(1);
        self.seen() && !self.stale(limits)
    }

    /// What came before, from a usual reading on.
    fn recall(&mut self) -> &mut History {
        let last = core::mem::take(&mut self.last);
        if last != Last::Doubted {
            let moving = matches!(last, Last::UsualInMotion | Last::RepeatedInMotion);
            let repeats = u8::from(matches!(last, Last::RepeatedAtRest | Last::RepeatedInMotion));
            let repeats_moving = if moving { repeats } else { 0 };
            let mut history = History { seen: true, due: true, repeats, repeats_moving, ..History::default() };
            for _ in 0..=repeats {
                history.unchanged.note(true);
                history.unchanged_moving.note(moving);
            }
            self.history = history;
        }
        &mut self.history
    }

    #[inline(never)]
    fn doubt(&mut self, reading: Reading, limits: &WatchLimits, moving: bool) -> bool {
        // A number of 0 says that none has been taken. After that any other number is news, so that a wrap is nothing special.
        let (fresh, same) = (reading.number != self.number, reading.value.to_bits() == self.bits);
        let history = self.recall();
        history.age = history.age.saturating_add(1);
        // At full scale a sensor that works repeats itself too.
        let at_full_scale = reading.value.abs() >= limits.full_scale;
        if fresh {
            let changed = !history.seen || !same || at_full_scale;
            if changed {
                history.unchanged = Streak::default();
                history.unchanged_moving = Streak::default();
            }
            history.repeats = if changed { 0 } else { history.repeats.saturating_add(1) };
            history.repeats_moving = if changed || !moving { 0 } else { history.repeats_moving.saturating_add(1) };
            (history.age, history.seen, history.due) = (0, true, true);
        }
        history.unchanged.note(history.seen);
        history.unchanged_moving.note(history.seen && moving);
        history.saturated.note(history.seen && at_full_scale);
        if fresh {
            (self.number, self.bits) = (reading.number, reading.value.to_bits());
        }
        let wrong = self.stale(limits) || self.saturated(limits) || self.stuck(limits) || !reading.value.is_finite();
        self.seen() && !wrong
    }

    pub fn stale(&self, limits: &WatchLimits) -> bool {
        !self.trusted() && self.history.due && self.history.age >= limits.stale
    }

    pub fn saturated(&self, limits: &WatchLimits) -> bool {
        !self.trusted() && self.history.saturated.lasted(limits.saturation)
    }

    pub fn stuck(&self, limits: &WatchLimits) -> bool {
        let History { repeats, repeats_moving, unchanged, unchanged_moving, .. } = &self.history;
        let always = *repeats >= FEWEST_REPEATS && unchanged.lasted(limits.stuck);
        !self.trusted() && (always || (*repeats_moving >= FEWEST_REPEATS && unchanged_moving.lasted(limits.stuck_moving)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::ticks::NEVER;
    use super::*;

    const LIMITS: WatchLimits = WatchLimits { stale: 6, stuck: NEVER, stuck_moving: 8, full_scale: 10.0, saturation: 8 };

    fn feed(watch: &mut Watch, numbers: core::ops::Range<u32>, moving: bool, value: impl Fn(u32) -> f32) {
        for number in numbers {
            for _ in 0..2 {
                watch.step(Reading { value: value(number), number }, &LIMITS, moving);
            }
        }
    }

    #[test]
    fn nothing_is_wrong_before_the_first_reading() {
        let mut watch = Watch::default();
        for _ in 0..100 {
            watch.step(Reading { value: 20.0, number: 0 }, &LIMITS, true);
        }
        assert!(!watch.seen() && !watch.stale(&LIMITS) && !watch.stuck(&LIMITS) && !watch.saturated(&LIMITS));
        let mut expected = Watch::expecting();
        for tick in 1..10 {
            expected.step(Reading::default(), &LIMITS, false);
            assert!(!expected.seen());
            assert_eq!(expected.stale(&LIMITS), tick >= 6);
        }
    }

    #[test]
    fn at_full_scale_a_reading_that_repeats_is_saturated_and_not_stuck() {
        for (value, stuck) in [(-10.0, false), (9.9, true)] {
            let mut watch = Watch::default();
            feed(&mut watch, 1..20, true, |_| value);
            assert_eq!((watch.stuck(&LIMITS), watch.saturated(&LIMITS)), (stuck, !stuck), "{value}");
        }
    }

    #[test]
    fn numbers_wrap() {
        let mut watch = Watch::default();
        for step in 0..20_u32 {
            let number = (u32::MAX - 8).wrapping_add(step);
            for _ in 0..2 {
                watch.step(Reading { value: step as f32, number }, &LIMITS, true);
                assert!(!watch.stale(&LIMITS) && !watch.stuck(&LIMITS));
            }
        }
    }

    #[test]
    fn an_age_that_has_grown_for_years_stays_and_ends_with_the_next_reading() {
        let reading = |number| Reading { value: 0.5 * number as f32, number };
        let history = History { seen: true, due: true, age: u32::MAX - 3, ..History::default() };
        let mut watch = Watch { number: 7, history, ..Watch::default() };
        for _ in 0..10 {
            watch.step(reading(7), &LIMITS, false);
            assert!(watch.stale(&LIMITS));
        }
        assert!(watch.step(reading(8), &LIMITS, false) && !watch.stale(&LIMITS));
        let mut arrival = Watch { number: 8, history, ..Watch::default() };
        for _ in 0..10 {
            assert!(!arrival.arrival(8, &LIMITS) && arrival.stale(&LIMITS));
        }
        assert!(arrival.arrival(0, &LIMITS) && !arrival.stale(&LIMITS));
    }

    /// Any readings, old, repeated and beyond the scale, to one watch that takes its short cuts and one that does not.
    #[test]
    fn short_cuts_change_nothing() {
        let (mut short, mut long) = (Watch::default(), Watch::default());
        let (mut reading, mut random, mut moving) = (Reading::default(), 1_u32, false);
        for tick in 0..100_000 {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let dice = random >> 24;
            // Long runs of one kind among short ones.
            let among = if tick / 1000 % 2 == 0 { 64 } else { 8 };
            moving ^= dice.is_multiple_of(among);
            reading.number = reading.number.wrapping_add(u32::from(dice % among > 2));
            if dice % 11 > 4 {
                reading.value = [0.1, 0.2, -0.3, 9.9, 10.0, -12.0, f32::NAN][(dice % 7) as usize];
            }
            let well = short.step(reading, &LIMITS, moving);
            assert_eq!(well, long.doubt(reading, &LIMITS, moving), "{tick}");
            let verdict = |watch: &Watch| (watch.seen(), watch.stale(&LIMITS), watch.stuck(&LIMITS), watch.saturated(&LIMITS));
            assert_eq!(verdict(&short), verdict(&long), "{tick}");
        }
    }

    #[test]
    fn stuck_only_where_it_must_change() {
        let mut watch = Watch::default();
        feed(&mut watch, 1..500, false, |_| 0.3);
        assert!(!watch.stuck(&LIMITS));
        // The time at rest does not count.
        feed(&mut watch, 500..504, true, |_| 0.3);
        assert!(!watch.stuck(&LIMITS));
        feed(&mut watch, 504..505, true, |_| 0.3);
        assert!(watch.stuck(&LIMITS));
        feed(&mut watch, 505..506, true, |_| 0.4);
        assert!(!watch.stuck(&LIMITS));
    }

    #[test]
    fn a_slow_sensor_needs_three_repeats() {
        let mut watch = Watch::default();
        for tick in 0..30_u32 {
            watch.step(Reading { value: 0.3, number: 1 + tick / 8 }, &LIMITS, true);
            assert_eq!(watch.stuck(&LIMITS), tick >= 24, "{tick}");
        }
    }

    #[test]
    fn saturation_has_its_time() {
        let mut watch = Watch::default();
        feed(&mut watch, 1..3, true, |_| 5.0);
        feed(&mut watch, 3..7, true, |number| if number % 2 == 0 { 10.0 } else { -11.0 });
        assert!(!watch.saturated(&LIMITS));
        feed(&mut watch, 7..8, true, |_| 10.0);
        assert!(watch.saturated(&LIMITS));
        feed(&mut watch, 8..9, true, |_| 5.0);
        assert!(!watch.saturated(&LIMITS));
    }
}
