//! Maximum of a quantity over a monotone interval, between its samples too.

use crate::math::scalar::Real;

/// Samples of an interval, its ends included; a maximum between two of them is then sought out.
pub(super) const LOOKS: usize = 10;

/// Steps of the search for a maximum, which shorten its bracket by 0.618 each.
const SEARCH_STEPS: u32 = 32;

/// Sample number `i` of an interval from `from` to `to` (s).
pub(super) fn instant<S: Real>((from, to): (S, S), i: usize) -> S {
    if i + 1 == LOOKS { to } else { from + S::of(i as f64) * ((to - from) / S::of(LOOKS as f64 - 1.0)) }
}

/// Time and value of the largest of `looks`, or of `function` near it where that may be above `record`.
pub(super) fn largest<S: Real>(span: (S, S), looks: &[S; LOOKS], record: Option<S>, function: &dyn Fn(S) -> S) -> (S, S) {
    let value = |i: usize| looks[i];
    let highest = (1..LOOKS).fold(0, |best, i| if value(i) > value(best) { i } else { best });
    let found = (instant(span, highest), value(highest));
    // The parabola through the three nearest looks shows whether there may be a record between them.
    let centre = highest.clamp(1, LOOKS - 2);
    let [left, middle, right] = [centre - 1, centre, centre + 1].map(value);
    let bend = middle + middle - left - right;
    let lean = right - left;
    if bend > S::ZERO && lean.abs() < bend + bend {
        let top = middle + lean * lean / (S::of(8.0) * bend);
        if record.is_none_or(|record| top + (top - found.1) > record) {
            let between = golden_section((instant(span, centre - 1), instant(span, centre + 1)), function);
            if between.1 > found.1 {
                return between;
            }
        }
    }
    found
}

/// Time and value of the largest value of `function` within `bracket`, which holds one maximum: golden-section search.
fn golden_section<S: Real>((mut low, mut high): (S, S), function: &dyn Fn(S) -> S) -> (S, S) {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let golden = S::of(GOLDEN);
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (function(left), function(right));
    for _ in 0..SEARCH_STEPS {
        if at_left > at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - golden * (high - low);
            at_left = function(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + golden * (high - low);
            at_right = function(right);
        }
    }
    if at_left > at_right { (left, at_left) } else { (right, at_right) }
}
