//! Step grid of a fixed-step method: steps end at whole multiples of the step from the start of a ground segment, counted so that no
//! rounding adds up.

use crate::math::scalar::Real;

/// The first whole multiple of `step` (s, above 0) after `time` (s), or `end` (s) if that comes first. `tick` is the multiple found
/// last, 0 at the start of a ground segment; steps during a rest are skipped, so that a long rest costs no time.
pub fn next_stop<S: Real>(tick: &mut u32, step: S, time: S, end: S) -> S {
    let next = S::count(tick.wrapping_add(1)) * step;
    if next > time && S::count(*tick) * step == time {
        *tick += 1;
        return next.smaller(end);
    }
    leap(tick, step, time, end)
}

#[inline(never)]
fn leap<S: Real>(tick: &mut u32, step: S, time: S, end: S) -> S {
    let mut leap = 1_u32;
    while S::count(*tick) * step <= time {
        if *tick == u32::MAX {
            // Beyond the count's range steps continue from wherever they are.
            return (time + step).smaller(end);
        }
        let ahead = tick.saturating_add(leap);
        if S::count(ahead) * step <= time {
            *tick = ahead;
            leap = leap.saturating_mul(2);
        } else if leap > 1 {
            leap /= 2;
        } else {
            *tick += 1;
        }
    }
    (S::count(*tick) * step).smaller(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As counting one by one does, from any tick before it.
    #[test]
    fn the_first_multiple_after() {
        for step in [0.005_f32, 0.1, 1.0 / 3.0, 1e-3] {
            for k in 0..400 {
                let time = 0.013 * k as f32;
                let mut one_by_one = 0_u32;
                while one_by_one as f32 * step <= time {
                    one_by_one += 1;
                }
                for from in [0, one_by_one / 2, one_by_one] {
                    let mut tick = from;
                    assert_eq!(next_stop(&mut tick, step, time, 1e9), one_by_one as f32 * step);
                    assert_eq!(tick, one_by_one);
                }
            }
        }
    }

    #[test]
    fn a_long_rest_is_leapt_over_and_no_count_overflows() {
        let mut tick = 0;
        assert_eq!(next_stop(&mut tick, 1e-6_f64, 4000.0, 1e9), 4_000_000_001.0 * 1e-6);
        // A day in steps of 10 µs: more than a u32 counts.
        let mut tick = 0;
        assert_eq!(next_stop(&mut tick, 1e-5_f64, 86_400.0, 1e9), 86_400.0 + 1e-5);
        assert_eq!(next_stop(&mut tick, 1e-5_f64, 86_400.0, 86_400.000_005), 86_400.000_005);
    }
}
