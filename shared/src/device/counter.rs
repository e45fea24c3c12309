//! An encoder's counter beyond its 16 bits.

/// A counter of 16 bits, extended to 32: it may move by less than half its range between two readings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extended {
    last: u16,
    counts: i32,
}

impl Extended {
    /// Of a counter that stands at 0 where `counts` have been counted.
    pub fn from(counts: i32) -> Extended {
        Extended { last: 0, counts }
    }

    /// Counts since the first reading of a counter that started at 0, wrapping.
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
    fn a_counter_goes_on_past_its_ends() {
        let mut extended = Extended::default();
        let counters = [0, 5, 65_535, 65_000, 40_000, 65_000, 20_000, 50_000, 10_000];
        let counts = counters.map(|counter| extended.read(counter));
        assert_eq!(counts, [0, 5, -1, -536, -25_536, -536, 20_000, 50_000, 75_536]);
    }
}
