//! Where a smooth function crosses zero inside a step.

use super::scalar::Real;
use super::sign::Sign;

/// The zero in (`left`, `right`] of a function that has the sign `before` just after `left` and not at `right`.
///
/// `function` returns value and slope. Newton steps from `guess`, kept inside a bracket that always shrinks: at most 64
/// evaluations, usually four. A zero at `left` itself (the event just handled) cannot be returned, because its sign is the
/// one the caller gives, not a rounding error's.
pub fn newton_bracketed<S: Real>(left: S, right: S, before: Sign, guess: S, mut function: impl FnMut(S) -> (S, S)) -> S {
    let (mut low, mut high) = (left, right);
    let mut x = if guess > low && guess < high { guess } else { S::HALF * (low + high) };
    for _ in 0..64 {
        let (value, slope) = function(x);
        if value == S::ZERO {
            return x;
        }
        if before.times(value) > S::ZERO {
            low = x;
        } else {
            high = x;
        }
        let tolerance = S::EPSILON * x.abs();
        let newton = if slope == S::ZERO { low } else { x - value / slope };
        if slope != S::ZERO && (newton - x).abs() <= tolerance {
            return x;
        }
        let next = if newton > low && newton < high { newton } else { S::HALF * (low + high) };
        if (high - low) <= tolerance || next == x {
            return next;
        }
        x = next;
    }
    x
}

/// The zero in (`left`, `right`] of a function that has the sign `before` just after `left`, if its sign at `right` is the other: what the
/// ends show, and no more.
#[inline(always)]
pub fn zero_shown<S: Real>(left: S, right: S, before: Sign, function: impl Fn(S) -> S) -> Option<S> {
    (before.times(function(right)) < S::ZERO).then(|| illinois(left, right, before, function))
}

/// [`newton_bracketed`] for a function without a slope: false position with the Illinois correction, at most 64 evaluations. Apart, because
/// few steps have a zero.
#[inline(never)]
pub fn illinois<S: Real>(left: S, right: S, before: Sign, mut function: impl FnMut(S) -> S) -> S {
    let (mut low, mut high) = (left, right);
    let (mut at_low, mut at_high) = (before.times(function(left)), before.times(function(right)));
    let mut last_moved = None;
    for _ in 0..62 {
        let tolerance = S::EPSILON * (low.abs().larger(high.abs()));
        if high - low <= tolerance + tolerance {
            break;
        }
        let ratio = if at_low > S::ZERO && at_high < S::ZERO { at_low / (at_low - at_high) } else { S::HALF };
        let x = (low + (high - low) * ratio).larger(low + tolerance).smaller(high - tolerance);
        let value = before.times(function(x));
        if value == S::ZERO {
            return x;
        }
        if value > S::ZERO {
            (low, at_low) = (x, value);
            if last_moved == Some(Sign::Positive) {
                at_high = S::HALF * at_high;
            }
            last_moved = Some(Sign::Positive);
        } else {
            (high, at_high) = (x, value);
            if last_moved == Some(Sign::Negative) {
                at_low = S::HALF * at_low;
            }
            last_moved = Some(Sign::Negative);
        }
    }
    high
}

/// Least x above `low` and up to `high`, to within `tolerance`, from which `reached` holds; it does not at `low` and does at `high`.
pub fn bisection<S: Real>(mut low: S, mut high: S, tolerance: S, reached: impl Fn(S) -> bool) -> S {
    for _ in 0..64 {
        let middle = S::HALF * (low + high);
        if high - low <= tolerance || middle <= low || middle >= high {
            break;
        }
        *if reached(middle) { &mut high } else { &mut low } = middle;
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simple_roots_to_the_last_bits() {
        let root = newton_bracketed(0.0_f64, 3.0, Sign::Negative, 1.5, |x| (x * x - 2.0, 2.0 * x));
        assert!((root - core::f64::consts::SQRT_2).abs() < 4e-16);
        let without_slope = illinois(0.0_f64, 3.0, Sign::Negative, |x| x * x - 2.0);
        assert!((without_slope - core::f64::consts::SQRT_2).abs() < 1e-15);
        let single = illinois(0.0_f32, 3.0, Sign::Negative, |x| x * x - 2.0);
        assert!((single - core::f32::consts::SQRT_2).abs() < 5e-7);
    }

    #[test]
    fn the_root_just_left_behind_is_not_found_again() {
        // Zero at 0 with a rounding error of the wrong sign, and at 1.
        let root = newton_bracketed(0.0_f64, 1.7, Sign::Positive, 0.8, |x| (x * (1.0 - x) - 1e-18, 1.0 - 2.0 * x));
        assert!((root - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_grazing_root_and_a_flat_one_are_bounded_in_work() {
        let mut count = 0;
        let root = newton_bracketed(0.0_f64, 1.0, Sign::Positive, 0.5, |x| {
            count += 1;
            let d = 0.3 - x;
            (d * d * d, -3.0 * d * d)
        });
        assert!((root - 0.3).abs() < 1e-5 && count <= 64);
    }
}
