//! An encoder's counter beyond its 16 bits.

/// A counter of 16 bits, extended to 32: it may move by less than half its range between two readings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extended {
    last: u16,
    counts: i32,
}

impl Extended {
    /// Of a counter that has continued since `counts` was read, over a reset, and has started at 0 before it.
    pub fn going_on(counts: i32) -> Extended {
        Extended { last: counts as u16, counts }
    }

    /// Counts of a counter that started at 0, wrapping.
    pub fn read(&mut self, counter: u16) -> i32 {
        let moved = counter.wrapping_sub(self.last) as i16;
        self.last = counter;
        self.counts = self.counts.wrapping_add(i32::from(moved));
        self.counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_counter_continues_past_its_ends() {
        let mut extended = Extended::default();
        let counters = [0, 5, 65_535, 65_000, 40_000, 65_000, 20_000, 50_000, 10_000];
        let counts = counters.map(|counter| extended.read(counter));
        assert_eq!(counts, [0, 5, -1, -536, -25_536, -536, 20_000, 50_000, 75_536]);
    }

    /// The rack moves on while the processor does not look: nothing of it is lost.
    #[test]
    fn what_is_counted_over_a_reset_is_kept() {
        for start in [0, -1, 32_767, 65_535, -70_000, i32::MAX, i32::MIN] {
            for moved in [0, 1, -1, 5000, -5000, 32_767, -32_768] {
                let mut again = Extended::going_on(start);
                let counter = start.wrapping_add(moved) as u16;
                assert_eq!(again.read(counter), start.wrapping_add(moved));
                assert_eq!(again.read(counter.wrapping_add(3)), start.wrapping_add(moved + 3));
            }
        }
    }

    #[test]
    fn days_of_rocking_are_counted_one_by_one_through_every_wrap() {
        // Counts to and fro, never coming back to where it began, through both ends of 32 bits.
        for start in [0, i32::MAX - 5, i32::MIN + 5] {
            let (mut extended, mut truth) = (Extended::going_on(start), i64::from(start));
            let mut word = 1_u32;
            for step in 0..1_000_000_i64 {
                word = word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let moved = i64::from((word >> 16) as i16) + if step % 7 == 0 { 900 } else { 0 };
                truth += moved.clamp(i64::from(i16::MIN), i64::from(i16::MAX));
                assert_eq!(extended.read(truth as u16), truth as i32);
            }
            assert!((truth - i64::from(start)).abs() > 50_000_000, "{truth}");
        }
    }
}
