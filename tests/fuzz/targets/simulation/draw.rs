//! Choices and numbers from the fuzzer's bytes; where they run out, every choice is the first one.

/// Bytes that are drawn one after another.
pub struct Draw<'a>(pub &'a [u8]);

impl Draw<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        *first
    }

    /// Below `count`, which is from 1 to 256.
    pub fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    /// One of `choices`.
    pub fn one<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// In one of `count` cases, not the first.
    pub fn seldom(&mut self, count: usize) -> bool {
        self.below(count) + 1 == count
    }

    /// From `low` above 0 to `high`, each decade as likely as another, and the ends themselves.
    pub fn number(&mut self, low: f64, high: f64) -> f64 {
        match self.byte() {
            0 => low,
            255 => high,
            byte => {
                // The bits of positive numbers grow as their logarithms do, nearly.
                let (from, to) = (low.to_bits() as f64, high.to_bits() as f64);
                let share = (f64::from(byte) + f64::from(self.byte()) / 256.0) / 256.0;
                f64::from_bits((from + share * (to - from)) as u64).clamp(low, high)
            }
        }
    }

    /// [`Draw::number`], or 0.
    pub fn number_or_zero(&mut self, low: f64, high: f64) -> f64 {
        if self.seldom(4) { 0.0 } else { self.number(low, high) }
    }

    /// From -1 to 1.
    pub fn share(&mut self) -> f64 {
        f64::from(i16::from_be_bytes([self.byte(), self.byte()])) / 32768.0
    }
}
