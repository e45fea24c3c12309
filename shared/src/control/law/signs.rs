//! Signs of what clutch laws compare, with hysteresis.
//!
//! A sign changes only when its quantity is beyond zero by a band, which is a multiple of the standard deviation of its estimate:
//! noise about zero cannot make a clutch chatter, and a better estimate decides sooner.
//!
//! θ̇ and the terminals' acceleration pass zero; the ground's acceleration stays there once the ground is still. So beside its sign it is
//! known whether it goes either way at all, with a hysteresis of its own: from within one band to beyond all but the rarest noise.

use crate::control::estimation::estimate::Estimate;
use crate::math::sign::Sign;

/// Bands beyond zero at which ü_g is more than noise.
const NOISE: f32 = 4.0;

/// Signs at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Signs {
    /// Sign of θ.
    pub rotation: Sign,
    /// Sign of θ̇.
    pub velocity: Sign,
    /// Sign of the terminals' acceleration.
    pub push: Sign,
    /// Sign of ü_g.
    pub ground: Sign,
    /// ü_g is nothing but noise: it goes neither way.
    pub quiet: bool,
}

impl Signs {
    /// Of a block that the ground sets free to `side`: Eq. 10 engages from the start.
    #[inline]
    #[must_use]
    pub fn at_uplift(side: Sign) -> Signs {
        Signs { rotation: side, velocity: side, push: side, ground: side.opposite(), quiet: false }
    }

    /// The signs of the motion `ahead` after these, changed only where it is beyond `bands` standard deviations. Whether the ground moves is seen
    /// `now`: its acceleration carried on along its tangent is noisier than its deviation.
    #[inline]
    #[must_use]
    pub fn after(self, now: &Estimate, ahead: &Estimate, bands: f32) -> Signs {
        let band = ahead.deviation.scaled(bands);
        let noise = if self.quiet { NOISE * band.ground } else { band.ground };
        Signs {
            // The toe that carries the block is never in doubt for long: an impact has decided it.
            rotation: ahead.side,
            velocity: held(self.velocity, ahead.velocity, band.velocity),
            push: held(self.push, ahead.push, band.push),
            ground: held(self.ground, ahead.ground[0], band.ground),
            quiet: now.ground[0].abs() <= noise,
        }
    }
}

/// The sign of `x` beyond ±`band`, else `last`.
#[inline]
fn held(last: Sign, x: f32, band: f32) -> Sign {
    if last.times(x) < -band { last.opposite() } else { last }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::estimation::estimate::Deviation;

    #[test]
    fn a_sign_is_kept_within_its_band_and_changes_beyond() {
        let deviation = Deviation { velocity: 0.01, push: 0.1, ..Deviation::default() };
        let at = |velocity: f32, push: f32| Estimate { velocity, push, deviation, ..Estimate::default() };
        let after = |signs: Signs, estimate: Estimate, bands| signs.after(&estimate, &estimate, bands);
        let start = after(Signs::default(), at(1.0, -1.0), 2.0);
        assert_eq!((start.velocity, start.push), (Sign::Positive, Sign::Negative));
        let kept = after(start, at(-0.019, 0.19), 2.0);
        assert_eq!(kept, start);
        let changed = after(start, at(-0.021, 0.21), 2.0);
        assert_eq!((changed.velocity, changed.push), (Sign::Negative, Sign::Positive));
        // Without a band every change counts, and zero is none.
        assert_eq!(after(start, at(-1e-9, 0.0), 0.0).velocity, Sign::Negative);
        assert_eq!(after(start, at(0.0, 0.0), 0.0), start);
    }

    #[test]
    fn the_noise_of_a_still_ground_goes_neither_way() {
        let deviation = Deviation { ground: 0.002, ..Deviation::default() };
        let at = |ground: f32| Estimate { ground: [ground, 0.0], deviation, ..Estimate::default() };
        let (mut signs, mut random, mut changes) = (Signs { quiet: true, ..Signs::default() }, 1_u32, 0);
        for _ in 0..20_000 {
            // Twelve uniform numbers have a standard deviation of 1 together.
            let noise = (0..12).fold(-6.0, |sum, _| {
                random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                sum + (random >> 8) as f32 / 16_777_216.0
            });
            let estimate = at(0.002 * noise);
            let next = signs.after(&estimate, &at(0.01 * noise), 1.0);
            changes += u32::from(next.quiet != signs.quiet);
            signs = next;
        }
        assert!(changes <= 8, "{changes}");
        // What is more than noise goes one way, until it is no more than noise.
        for (ground, quiet) in [(0.007, true), (0.009, false), (-0.003, false), (0.0021, false), (0.0019, true), (-0.0079, true)]
        {
            signs = signs.after(&at(ground), &at(ground), 1.0);
            assert_eq!(signs.quiet, quiet, "{ground}");
        }
        assert!(!signs.after(&at(1e-6), &at(1e-6), 0.0).quiet && signs.after(&at(0.0), &at(0.0), 0.0).quiet);
    }
}
