//! Signs of what clutch laws compare, with hysteresis.
//!
//! A sign changes only when its quantity is beyond zero by a band, which is a multiple of the standard deviation of its estimate:
//! noise about zero cannot make a clutch chatter, and a better estimate decides sooner.

use crate::control::estimation::estimate::Estimate;
use crate::math::sign::Sign;

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

    /// The signs of `estimate` after these, changed only where it is beyond `bands` standard deviations.
    #[inline]
    #[must_use]
    pub fn after(self, estimate: &Estimate, bands: f32) -> Signs {
        let band = estimate.deviation.scaled(bands);
        Signs {
            // The toe that carries the block is never in doubt for long: an impact has decided it.
            rotation: estimate.side,
            velocity: held(self.velocity, estimate.velocity, band.velocity),
            push: held(self.push, estimate.push, band.push),
            ground: held(self.ground, estimate.ground[0], band.ground),
            quiet: estimate.ground[0].abs() <= band.ground,
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
        let start = Signs::default().after(&at(1.0, -1.0), 2.0);
        assert_eq!((start.velocity, start.push), (Sign::Positive, Sign::Negative));
        let kept = start.after(&at(-0.019, 0.19), 2.0);
        assert_eq!(kept, start);
        let changed = start.after(&at(-0.021, 0.21), 2.0);
        assert_eq!((changed.velocity, changed.push), (Sign::Negative, Sign::Positive));
        // Without a band every change counts, and zero is none.
        assert_eq!(start.after(&at(-1e-9, 0.0), 0.0).velocity, Sign::Negative);
        assert_eq!(start.after(&at(0.0, 0.0), 0.0), start);
    }
}
