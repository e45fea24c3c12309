//! Standard series that sizes are chosen from.

/// Modules of spur gears, the first choice of ISO 54, mm.
pub const MODULES_MM: [f64; 18] =
    [1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0, 32.0, 40.0, 50.0];

/// Preferred numbers of the series R10 of ISO 3, from 1 to below 10.
pub const R10: [f64; 10] = [1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0];

/// Those of R20.
pub const R20: [f64; 20] =
    [1.0, 1.12, 1.25, 1.4, 1.6, 1.8, 2.0, 2.24, 2.5, 2.8, 3.15, 3.55, 4.0, 4.5, 5.0, 5.6, 6.3, 7.1, 8.0, 9.0];

/// Full scales that accelerometers usually have, g.
pub const ACCELEROMETER_RANGES_G: [f64; 4] = [2.0, 4.0, 8.0, 16.0];

/// Full scales that gyroscopes usually have, degrees per second.
pub const GYROSCOPE_RANGES_DEG_S: [f64; 5] = [125.0, 250.0, 500.0, 1000.0, 2000.0];

/// What a size may fall short of the number that it is for: sizes and demands are products of the same factors, which differ by rounding.
const ROUNDING: f64 = 1e-9;

/// The smallest number of `series` times a power of ten that is `least` or more; `least` from 1e-12 to 1e12. NaN outside.
pub fn preferred(series: &[f64], least: f64) -> f64 {
    preferred_where(series, |number| number >= least * (1.0 - ROUNDING) && least > 0.0)
}

/// The smallest number of `series` times a power of ten, from 1e-12 to 1e13, that `is_enough`; NaN where none is.
pub fn preferred_where(series: &[f64], is_enough: impl Fn(f64) -> bool) -> f64 {
    let decade = |power: i32| (0..power.abs()).fold(1.0, |product, _| 10.0 * product);
    let of_decade = |power: i32| {
        let factor = decade(power);
        series.iter().map(move |number| if power < 0 { number / factor } else { number * factor })
    };
    (-12..=12).flat_map(of_decade).find(|number| is_enough(*number)).unwrap_or(f64::NAN)
}

/// The smallest of `sizes`, which rise, that is `least` or more; `None` where none is.
pub fn smallest(sizes: &[f64], least: f64) -> Option<f64> {
    sizes.iter().copied().find(|size| *size >= least * (1.0 - ROUNDING))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_preferred_number_is_found_in_any_decade() {
        for (least, next) in [(1.0, 1.0), (1.01, 1.25), (8.1, 10.0), (0.034, 0.04), (2510.0, 3150.0), (1e-3, 1e-3)] {
            assert!((preferred(&R10, least) / next - 1.0).abs() < 1e-12, "{least}: {}", preferred(&R10, least));
        }
        assert_eq!(preferred(&R20, 1.05e3), 1120.0);
        assert!(preferred(&R10, 0.0).is_nan() && preferred(&R10, f64::INFINITY).is_nan());
    }

    #[test]
    fn series_rise_by_equal_factors_within_their_rounding() {
        for (series, steps) in [(&R10[..], 10.0_f64), (&R20[..], 20.0)] {
            for (index, number) in series.iter().enumerate() {
                let exact = index as f64 / steps;
                assert!((sprag_shared::math::log10(*number) - exact).abs() < 0.009, "{number} is off by more than 2 %");
            }
        }
        assert_eq!((smallest(&MODULES_MM, 6.5), smallest(&MODULES_MM, 51.0)), (Some(8.0), None));
    }
}
