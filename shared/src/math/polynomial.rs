//! Values, zeros and extremes of a step's series.

use super::power_series::MAXIMUM_ORDER;
use super::root::newton_bracketed;
use super::scalar::{Real, Scalar};
use super::sign::Sign;

/// Σ c_k t^k, as two interleaved Horner chains in t². Written over [`Scalar`], so that lanes take it too.
#[inline(always)]
pub fn value<S: Scalar>(coefficients: &[S], time: S) -> S {
    value_and_slope(coefficients, time).0
}

/// Value and derivative. With p = E(t²) + t O(t²), p' = O + 2t (E' + t O'): four chains at once.
#[inline(always)]
pub fn value_and_slope<S: Scalar>(coefficients: &[S], time: S) -> (S, S) {
    let squared = time * time;
    let (pairs, rest) = coefficients.as_chunks::<2>();
    let zero = S::of(0.0);
    let mut even = rest.first().copied().unwrap_or(zero);
    let (mut odd, mut even_slope, mut odd_slope) = (zero, zero, zero);
    for [low, high] in pairs.iter().rev() {
        even_slope = even_slope * squared + even;
        odd_slope = odd_slope * squared + odd;
        even = even * squared + *low;
        odd = odd * squared + *high;
    }
    (even + odd * time, odd + (time + time) * (even_slope + odd_slope * time))
}

/// Σ k(k−1) s(c_k) t^{k−2} with the function s = `size`.
#[inline(always)]
fn twice_derived<S: Real>(coefficients: &[S], time: S, size: impl Fn(S) -> S) -> S {
    let mut sum = S::ZERO;
    for (&c, &factor) in coefficients.iter().zip(&SECOND).skip(2).rev() {
        sum = sum * time + size(c) * S::of(factor);
    }
    sum
}

/// Bound of the second derivative's magnitude over [0, `to`]: Σ k(k−1)|c_k| to^{k−2}.
#[inline]
pub fn curvature_bound<S: Real>(coefficients: &[S], to: S) -> S {
    twice_derived(coefficients, to, S::abs)
}

/// k(k−1).
const SECOND: [f64; MAXIMUM_ORDER] = {
    let mut table = [0.0; MAXIMUM_ORDER];
    let mut k = 0;
    while k < MAXIMUM_ORDER {
        table[k] = (k * k) as f64 - k as f64;
        k += 1;
    }
    table
};

/// First zero in (`from`, `to`] of a polynomial with the sign `sign` just after `from`; with `from_zero` it is zero at
/// `from` itself. `from` ≥ 0.
///
/// No zero is lost: a stretch of width w is passed over only when it can hold none, because the values at its ends
/// exceed M w²/8 or the slope at its start exceeds M w (M bounds the second derivative); otherwise it is halved.
/// Two zeros closer together than 2⁻⁴⁰ of the stretch are a graze, and count as none. Work is bounded: a function that is
/// flat to rounding is settled by its signs at the ends after [`MOST_STRETCHES`] tries.
///
/// `curvature` is M on [0, `to`] ([`curvature_bound`]).
pub fn first_zero<S: Real>(coefficients: &[S], curvature: S, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
    let mut function = |t: S| match coefficients {
        [value, slope, ..] if t == S::ZERO => (*value, *slope),
        _ => value_and_slope(coefficients, t),
    };
    let (mut left, mut right, mut bound, mut at_zero) = (from, to, curvature, from_zero);
    for _ in 0..MOST_SHORTER {
        let end = value(coefficients, right);
        match search(&mut function, bound, (left, right, end), sign, at_zero) {
            Ok(None) if right < to => (left, right, bound, at_zero) = (right, to, curvature, false),
            Ok(zero) => return zero,
            // Over a shorter stretch the second derivative has a sharper bound.
            Err(reached) => {
                at_zero &= reached == left;
                (left, right) = (reached, S::HALF * (reached + right));
                bound = curvature_bound(coefficients, right);
            }
        }
    }
    first_zero_of(function, bound, (left, to, value(coefficients, to)), sign, at_zero)
}

/// Shorter stretches that [`first_zero`] tries, one after the other.
const MOST_SHORTER: u32 = 24;

/// Stretches that [`first_zero_of`] looks at before it settles for the signs at the ends; a hard case takes about 60.
pub const MOST_STRETCHES: u32 = 400;

/// [`first_zero`] for any function that gives value and slope, and a bound of its second derivative on the stretch.
/// `stretch` is (from, to, value at to).
pub fn first_zero_of<S: Real>(
    mut function: impl FnMut(S) -> (S, S),
    curvature: S,
    stretch: (S, S, S),
    sign: Sign,
    from_zero: bool,
) -> Option<S> {
    let (_, to, end) = stretch;
    search(&mut function, curvature, stretch, sign, from_zero).unwrap_or_else(|left| {
        (sign.times(end) < S::ZERO).then(|| newton_bracketed(left, to, sign, S::HALF * (left + to), function))
    })
}

/// [`first_zero_of`], or how far it was sought with [`MOST_STRETCHES`].
#[inline(never)]
fn search<S: Real>(
    function: &mut impl FnMut(S) -> (S, S),
    curvature: S,
    stretch: (S, S, S),
    sign: Sign,
    from_zero: bool,
) -> Result<Option<S>, S> {
    let (from, to, end) = stretch;
    let span = to - from;
    if span <= S::ZERO {
        return Ok(None);
    }
    let smallest = span * S::of(1.0 / (1_u64 << 40) as f64);
    let (mut left, mut width) = (from, span);
    let (mut value, mut slope) = function(from);
    let mut zero_at_left = from_zero || sign.times(value) <= S::ZERO;
    for _ in 0..MOST_STRETCHES {
        let right = if left + width >= to { to } else { left + width };
        let (right_value, right_slope) = if right == to { (end, S::ZERO) } else { function(right) };
        let w = right - left;
        let steep = sign.times(slope);
        // With curvature at most M, the slope cannot change sign over the stretch when it starts beyond M w.
        let monotone = steep.abs() > curvature * w;
        let changed = sign.times(right_value) < S::ZERO;
        if changed {
            if (monotone && !zero_at_left) || w <= smallest {
                let guess = left + w * S::HALF;
                return Ok(Some(newton_bracketed(left, right, sign, guess, function)));
            }
        } else {
            let clear = !zero_at_left && sign.times(value).smaller(sign.times(right_value)) > curvature * (w * w) * S::of(0.125);
            let passes = clear || (monotone && (steep > S::ZERO || !zero_at_left)) || w <= smallest;
            if passes {
                if right == to {
                    return Ok(None);
                }
                (left, value, slope) = (right, right_value, right_slope);
                zero_at_left = sign.times(value) <= S::ZERO;
                width = w + w;
                continue;
            }
        }
        width = w * S::HALF;
    }
    Err(left)
}

/// Largest |p(t)| of a polynomial on [`from`, `to`], if above `floor`; else `floor`.
pub fn largest_magnitude<S: Real>(coefficients: &[S], curvature: S, from: (S, S), to: (S, S), floor: S) -> S {
    let curve = (|t| value_and_slope(coefficients, t), |t| twice_derived(coefficients, t, |c| c));
    largest_magnitude_of(&curve, curvature, from, to, floor)
}

/// Largest magnitude of a curve, given as its value with its slope and its second derivative, on [`from`, `to`], where its values are
/// `left` and `right`, if above `floor`; else `floor`.
/// Interior extremes are found where the slope changes sign between the ends of a stretch that the bound `curvature` of the
/// second derivative does not rule out.
pub fn largest_magnitude_of<S: Real>(
    curve: &(impl Fn(S) -> (S, S), impl Fn(S) -> S),
    curvature: S,
    (from, left): (S, S),
    (to, right): (S, S),
    floor: S,
) -> S {
    let w = to - from;
    let ends = floor.larger(left.abs()).larger(right.abs());
    if left.abs().larger(right.abs()) + curvature * (w * w) * S::of(0.125) <= floor {
        return ends;
    }
    let left_slope = (curve.0)(from).1;
    let right_slope = (curve.0)(to).1;
    largest_within(curve, [(from, left, left_slope), (to, right, right_slope)], ends, curvature, w * S::of(1.0 / 16.0))
}

fn largest_within<S: Real>(
    curve: &(impl Fn(S) -> (S, S), impl Fn(S) -> S),
    ends: [(S, S, S); 2],
    floor: S,
    curvature: S,
    smallest: S,
) -> S {
    let [(from, left, left_slope), (to, right, right_slope)] = ends;
    let w = to - from;
    let ceiling = left.abs().larger(right.abs()) + curvature * (w * w) * S::of(0.125);
    if ceiling <= floor {
        return floor;
    }
    let peaks = left_slope * right_slope < S::ZERO;
    // Between slopes of one sign that change by no more than the smaller of them there is no extreme.
    if !peaks && left_slope.abs().larger(right_slope.abs()) > curvature * w {
        return floor;
    }
    if w > smallest && !(peaks && left_slope.abs() + right_slope.abs() > S::of(1.8) * curvature * w) {
        let middle = S::HALF * (from + to);
        let (value, slope) = (curve.0)(middle);
        let floor = floor.larger(value.abs());
        let floor = largest_within(curve, [ends[0], (middle, value, slope)], floor, curvature, smallest);
        return largest_within(curve, [(middle, value, slope), ends[1]], floor, curvature, smallest);
    }
    if !peaks {
        return floor;
    }
    let sign = Sign::of(left_slope, Sign::Positive);
    let at = newton_bracketed(from, to, sign, from + w * left_slope.abs() / (left_slope.abs() + right_slope.abs()), |t| {
        ((curve.0)(t).1, (curve.1)(t))
    });
    floor.larger((curve.0)(at).0.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec;
    use std::vec::Vec;

    fn with_roots(roots: &[f64], scale: f64) -> Vec<f64> {
        let mut coefficients = vec![scale];
        for &root in roots {
            let mut next = vec![0.0; coefficients.len() + 1];
            for (k, c) in coefficients.iter().enumerate() {
                next[k] -= c * root;
                next[k + 1] += c;
            }
            coefficients = next;
        }
        coefficients
    }

    #[test]
    fn the_first_of_several_zeros_is_found() {
        for roots in [[0.3, 0.30001, 0.9], [0.1, 0.5, 0.7], [0.999, 1.5, 2.0], [1e-6, 0.5, 0.6]] {
            let polynomial = with_roots(&roots, 3.0);
            let sign = Sign::of(polynomial[0], Sign::Positive);
            let found = first_zero(&polynomial, curvature_bound(&polynomial, 1.0), 0.0, 1.0, sign, false).unwrap();
            assert!((found - roots[0]).abs() < 1e-11, "{roots:?}: {found}");
        }
    }

    /// h² − x² of a twist x = bt² − ct that turns back just beyond −h, seen over a step that is a hundred times longer.
    #[test]
    fn a_double_crossing_at_the_start_of_a_long_stretch_is_found() {
        let (h, b) = (2.88e-5_f64, 0.45);
        for beyond in [1.001, 1.03, 1.5] {
            let c = (4.0 * b * h * beyond).sqrt();
            let polynomial = [h * h, 0.0, -c * c, 2.0 * b * c, -b * b];
            let first = (c - (c * c - 4.0 * b * h).sqrt()) / (2.0 * b);
            for to in [0.03, 0.46, 3.0] {
                let found = first_zero(&polynomial, curvature_bound(&polynomial, to), 0.0, to, Sign::Positive, false).unwrap();
                assert!((found / first - 1.0).abs() < 1e-9, "{beyond}, {to}: {found} and {first}");
            }
        }
    }

    #[test]
    fn the_zero_at_the_start_is_not_found_again() {
        let mut polynomial = with_roots(&[0.0, 0.4, 0.8], 1.0);
        for error in [0.0, 1e-18, -1e-18] {
            polynomial[0] = error;
            let found = first_zero(&polynomial, curvature_bound(&polynomial, 1.0), 0.0, 1.0, Sign::Positive, true).unwrap();
            assert!((found - 0.4).abs() < 1e-14);
        }
        let later = with_roots(&[0.0, 1.4, 1.8], 1.0);
        assert_eq!(first_zero(&later, curvature_bound(&later, 1.0), 0.0, 1.0, Sign::Positive, true), None);
    }

    #[test]
    fn a_graze_is_none() {
        for (polynomial, sign) in
            [(with_roots(&[0.4, 0.4], 1.0), Sign::Positive), (with_roots(&[1.2, 1.3, -0.5], -1.0), Sign::Negative)]
        {
            assert_eq!(first_zero(&polynomial, curvature_bound(&polynomial, 1.0), 0.0, 1.0, sign, false), None);
        }
    }

    #[test]
    fn extremes_inside_and_at_the_ends() {
        // cos(3t) on [0.1, 1.5]: |−1| inside at π/3.
        let mut cosine = [0.0; 30];
        let mut c = 1.0;
        for k in 0..15 {
            cosine[2 * k] = c;
            c *= -9.0 / ((2 * k + 1) as f64 * (2 * k + 2) as f64);
        }
        let largest = |from: f64, to: f64, floor: f64| {
            let end = |t: f64| (t, value(&cosine, t));
            largest_magnitude(&cosine, curvature_bound(&cosine, to), end(from), end(to), floor)
        };
        assert!((largest(0.1, 1.5, 0.0) - 1.0).abs() < 1e-15);
        assert!((largest(0.1, 0.6, 0.0) - crate::math::cos(0.3)).abs() < 1e-15);
        assert_eq!(largest(0.1, 0.6, 2.0), 2.0);
    }

    #[test]
    fn value_and_slope_agree_with_the_interleaved_value() {
        let coefficients = [0.3, -1.2, 0.7, 2.0, -0.4];
        for t in [0.0_f64, 0.2, -0.7, 1.3] {
            assert!((value(&coefficients, t) - value_and_slope(&coefficients, t).0).abs() < 1e-15);
        }
    }
}
