//! Round tick values and their text.

use std::ops::Range;

/// Multiples of 1, 2 or 5 times a power of ten inside `range`, about `target` of them; never more than twice that.
///
/// Ticks closer to an end than `margin` times the range are left out, so that labels of stacked panels stay apart. Where
/// that leaves fewer than three, a finer step is taken.
pub(super) fn round_ticks(range: &Range<f64>, target: usize, margin: f64) -> Vec<f64> {
    let target = target.max(1);
    let coarse = ticks_of(range, target, margin);
    if coarse.len() >= 3 {
        return coarse;
    }
    let fine = ticks_of(range, 2 * target, margin);
    if fine.len() <= 2 * target { fine } else { coarse }
}

fn ticks_of(range: &Range<f64>, target: usize, margin: f64) -> Vec<f64> {
    let width = range.end - range.start;
    let step = round_step(width / target as f64);
    let first = ((range.start + margin * width) / step - 1e-9).ceil();
    let last = ((range.end - margin * width) / step + 1e-9).floor();
    let mut ticks = Vec::new();
    let mut multiple = first;
    while multiple <= last {
        // Adding zero turns a negative zero into a plain one.
        ticks.push(multiple * step + 0.0);
        multiple += 1.0;
    }
    ticks
}

/// The smallest of 1, 2, 5 times a power of ten that is not far below `rough`, which is positive.
fn round_step(rough: f64) -> f64 {
    let least = 0.7 * rough;
    let mut power = 1.0;
    while power > least && power > f64::MIN_POSITIVE {
        power /= 10.0;
    }
    while power * 10.0 <= least {
        power *= 10.0;
    }
    [1.0, 2.0, 5.0].into_iter().map(|digit| digit * power).find(|&step| step >= least).unwrap_or(power * 10.0)
}

/// Text of the tick at `value` when neighbours lie `step` apart, with a true minus sign.
pub(super) fn tick_text(value: f64, step: f64) -> String {
    let size = value.abs();
    let text = if size < step * 1e-6 {
        "0".to_owned()
    } else if size >= 1e5 || step < 1e-4 {
        scientific(size)
    } else {
        let mut decimals = 0;
        let mut unit = 1.0;
        while unit > step * (1.0 + 1e-9) {
            decimals += 1;
            unit /= 10.0;
        }
        format!("{size:.decimals$}")
    };
    if value < 0.0 && text != "0" { format!("\u{2212}{text}") } else { text }
}

fn scientific(size: f64) -> String {
    let text = format!("{size:.1e}");
    text.replace(".0e", "e").replace("e-", "e\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(round_ticks(&(-1.2..1.2), 5, 0.0), vec![-1.0, -0.5, 0.0, 0.5, 1.0]);
        assert_eq!(round_ticks(&(0.0..10.0), 5, 0.0), vec![0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(round_ticks(&(0.0..10.0), 5, 0.05), vec![2.0, 4.0, 6.0, 8.0]);
        for width in [1e-6, 0.3, 17.0, 4.2e7] {
            let ticks = round_ticks(&(-width..width), 5, 0.0);
            assert!((3..=10).contains(&ticks.len()), "{width}: {ticks:?}");
        }
    }

    #[test]
    fn text_has_the_decimals_of_the_step() {
        assert_eq!(tick_text(0.5, 0.5), "0.5");
        assert_eq!(tick_text(1.0, 0.5), "1.0");
        assert_eq!(tick_text(-0.25, 0.05), "\u{2212}0.25");
        assert_eq!(tick_text(20.0, 20.0), "20");
        assert_eq!(tick_text(1e-17, 0.5), "0");
        assert_eq!(tick_text(-2e-6, 1e-6), "\u{2212}2e\u{2212}6");
        assert_eq!(tick_text(2e6, 1e6), "2e6");
    }
}
