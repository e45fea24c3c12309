//! Sine and cosine in single precision, by one polynomial of the half angle.
//!
//! With y = x² the polynomials give 2 sin(x/2) = x (1 + y S(y)) and cos(x/2) = 1 + y C(y) on |x| ≤ π, and
//!
//! sin x = 2 sin(x/2) cos(x/2),  cos x = 1 − ½ (2 sin(x/2))².
//!
//! There is no branch and no table, so it costs the same everywhere and gives the same bits everywhere. The
//! coefficients interpolate the functions at the Chebyshev points of y ∈ [0, π²]; the truncation error is below 2e-8
//! of the half angle's sine. `tests/tests/motion/sine_exhaustive.rs` bounds the whole error over every f32 in [−π, π].

/// S(y), ascending.
const SINE: [f32; 4] = [-0.041_666_664, 0.000_520_827_66, -3.097_303e-6, 1.029_201_7e-8];
/// C(y), ascending.
const COSINE: [f32; 5] = [-0.125, 0.002_604_166_3, -2.170_101_8e-5, 9.677_57e-8, -2.568_116_8e-10];

/// sin x and cos x for |x| ≤ π. Absolute error below [`ERROR_BOUND`]; odd and even to the last bit
/// (of ±0 the sine is +0).
#[inline(always)]
pub fn sin_cos(x: f32) -> (f32, f32) {
    let y = x * x;
    let sine = SINE[0] + y * (SINE[1] + y * (SINE[2] + y * SINE[3]));
    let cosine = COSINE[0] + y * (COSINE[1] + y * (COSINE[2] + y * (COSINE[3] + y * COSINE[4])));
    let twice_half_sine = x + x * (y * sine);
    let half_cosine = 1.0 + y * cosine;
    (twice_half_sine * half_cosine, 1.0 - 0.5 * (twice_half_sine * twice_half_sine))
}

/// Largest absolute error of [`sin_cos`] on [−π, π], as proven by the exhaustive test: 5.737e-7, in the cosine near ±π,
/// where the error of 2 sin(x/2) counts twice. The sine's own is 2.512e-7.
pub const ERROR_BOUND: f64 = 5.74e-7;

/// sin x and cos x of any phase up to ±10,000 rad, by removing whole turns first (two-part 2π, error below 1e-6).
/// Beyond that the turns removed lose digits, as any f32 phase has by then.
#[inline]
pub fn sin_cos_of_phase(x: f32) -> (f32, f32) {
    // 2π = TURN_HIGH + TURN_MIDDLE + TURN_LOW; the products of the first two with a turn count below 2¹¹ are exact.
    const TURN_HIGH: f32 = 6.281_25;
    const TURN_MIDDLE: f32 = 0.001_935_005_2;
    const TURN_LOW: f32 = 3.019_916e-7;
    const PER_RADIAN: f32 = 0.159_154_94;
    let turns = x * PER_RADIAN;
    let whole = (if turns < 0.0 { turns - 0.5 } else { turns + 0.5 }) as i32 as f32;
    let rest = ((x - whole * TURN_HIGH) - whole * TURN_MIDDLE) - whole * TURN_LOW;
    sin_cos(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_where_exactness_is_expected() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert_eq!(sin_cos(-0.0), (0.0, 1.0));
        let tiny = f32::from_bits(1);
        assert_eq!(sin_cos(tiny), (tiny, 1.0));
    }

    #[test]
    fn phases_of_many_turns_stay_accurate() {
        for k in 0..200_000_u32 {
            let x = (k as f32 - 100_000.0) * 0.01;
            let (sine, cosine) = sin_cos_of_phase(x);
            let (exact_sine, exact_cosine) = crate::math::sin_cos(f64::from(x));
            assert!((f64::from(sine) - exact_sine).abs() < 1e-6, "sin {x}");
            assert!((f64::from(cosine) - exact_cosine).abs() < 1e-6, "cos {x}");
        }
    }
}
