//! Numbers as text: the fewest digits that read back to the same f64.

use std::fmt::Write as _;

/// Lowest bits of a mantissa. Below 1e7 a number that lies halfway between two texts, of which not everybody takes the same, has 18 of zero.
const LAST_BITS: u64 = (1 << 16) - 1;

/// Texts of numbers, one at a time.
#[derive(Default)]
pub struct NumberText {
    quick: zmij::Buffer,
    whole: itoa::Buffer,
    other: String,
}

impl NumberText {
    /// The text of `number`: that of `{:?}`, in a fifth of its time for most numbers.
    #[inline]
    pub fn of(&mut self, number: f64) -> &str {
        if (1e-4..1e7).contains(&number.abs()) && number.to_bits() & LAST_BITS != 0 {
            return self.quick.format_finite(number);
        }
        self.other.clear();
        // Writing into a string does not fail.
        let _ = write!(self.other, "{number:?}");
        &self.other
    }

    /// The text of `count`.
    pub fn of_count(&mut self, count: u64) -> &str {
        self.whole.format(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_rust_gives_them() {
        let mut text = NumberText::default();
        let mut same = |number: f64| assert_eq!(text.of(number), format!("{number:?}"));
        for number in [0.0, -0.0, 1.0, 0.1, -2.5, 1e-4, 9.999e-5, 1e16, 5e-324, f64::MAX, f64::INFINITY, f64::NAN] {
            same(number);
        }
        let mut state = 0x9E37_79B9_7F4A_7C15_u64;
        for index in 0..200_000_u64 {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            // Mantissas of all lengths, and magnitudes within the bounds and beyond.
            let mantissa = (state >> (index % 53) << (index % 53)) & ((1 << 52) - 1);
            same(f64::from_bits(mantissa | (1005 + index % 45) << 52));
            same(f64::from_bits(state));
            // Halfway between texts of 17 digits.
            same((state >> 34) as f64 + 0.062_5 / f64::from(1_u32 << (index % 12)));
        }
    }
}
