//! The probability behind a share: how many of a sample did, and what that says of the next.

use sprag_shared::math::square_root;

use super::{Band, Level};

/// The band of the probability of an event that happened `times` in `of` independent trials, in the mean where trials were repeated (Wilson
/// 1927, Journal of the American Statistical Association 22(158), Eq. 3): all π that lie within z standard errors √(π(1 − π)/n) of the
/// share k/n, which are
///
/// \[k + z²/2 ± z √(k (n − k)/n + z²/4)\]/(n + z²)
///
/// with z the half-width of `level`. Its ends lie within 0 and 1, and are not the share itself where nothing or everything
/// happened. `None` without trials, and for more events than trials.
pub fn wilson(times: f64, of: f64, level: Level) -> Option<Band> {
    if of <= 0.0 || times > of {
        return None;
    }
    let (k, n, z) = (times, of, level.normal());
    let middle = k + 0.5 * z * z;
    let half = z * square_root(k * (n - k) / n + 0.25 * z * z);
    // The ends of a sample of one kind are exact.
    let low = if times == 0.0 { 0.0 } else { (middle - half) / (n + z * z) };
    let high = if times == of { 1.0 } else { (middle + half) / (n + z * z) };
    Some(Band { low, high })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_those_of_the_closed_form() {
        let z2 = Level::COMMON.normal() * Level::COMMON.normal();
        // Nothing of n: up to z²/(n + z²); half of them: ½ ± ½ z/√(n + z²).
        let none = wilson(0.0, 87.0, Level::COMMON).unwrap();
        assert!(none.low == 0.0 && (none.high - z2 / (87.0 + z2)).abs() < 1e-15);
        let half = wilson(10.0, 20.0, Level::COMMON).unwrap();
        let width = 0.5 * square_root(z2 / (20.0 + z2));
        assert!((half.low - (0.5 - width)).abs() < 1e-15 && (half.high - (0.5 + width)).abs() < 1e-15);
        // Newcombe (1998), Statistics in Medicine 17, Table I: 81 of 263, 15 of 148, 1 of 29.
        for (times, of, low, high) in [(81.0, 263.0, 0.2553, 0.3662), (15.0, 148.0, 0.0624, 0.1605), (1.0, 29.0, 0.0061, 0.1718)]
        {
            let band = wilson(times, of, Level::COMMON).unwrap();
            assert!((band.low - low).abs() < 5e-5 && (band.high - high).abs() < 5e-5, "{times} of {of}: {band:?}");
        }
    }

    #[test]
    fn ends_solve_the_equation_that_they_come_from() {
        let level = Level::new(0.8).unwrap();
        for (times, of) in [(1.0, 4.0), (2.5, 87.0), (86.0, 87.0), (500.0, 1000.0)] {
            let band = wilson(times, of, level).unwrap();
            let share = times / of;
            for end in [band.low, band.high] {
                let errors = (share - end) / square_root(end * (1.0 - end) / of);
                assert!((errors.abs() - level.normal()).abs() < 1e-10, "{times} of {of}: {errors}");
            }
            assert!(band.low < share && share < band.high);
        }
    }

    #[test]
    fn events_and_their_absence_mirror_each_other() {
        for times in 0..=12 {
            let [there, not] = [times, 12 - times].map(|count| wilson(f64::from(count), 12.0, Level::COMMON).unwrap());
            assert!((there.low - (1.0 - not.high)).abs() < 1e-15 && (0.0..=1.0).contains(&there.low));
        }
        assert_eq!(wilson(0.0, 0.0, Level::COMMON), None);
        assert_eq!(wilson(3.0, 2.0, Level::COMMON), None);
    }
}
