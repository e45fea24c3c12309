//! Zeros of θ, θ̇, θ̈ and its slope in a step.

use sprag_shared::math::scalar::Scalar;

use super::{Motion, Place};
use crate::{Mask, Number, number};

/// Function whose zero is sought, in each lane one of these or none.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// θ.
    pub rotation: Mask,
    /// θ̇.
    pub velocity: Mask,
    /// θ̈.
    pub acceleration: Mask,
    /// The slope of θ̈.
    pub slope: Mask,
}

impl Wanted {
    /// Nothing.
    pub const NOTHING: Wanted =
        Wanted { rotation: Mask::NONE, velocity: Mask::NONE, acceleration: Mask::NONE, slope: Mask::NONE };

    /// Where anything is.
    #[inline(always)]
    pub fn any(&self) -> Mask {
        self.rotation | self.velocity | self.acceleration | self.slope
    }

    /// Value at `place` of the function whose zero is sought.
    #[inline(always)]
    fn of(&self, motion: &Motion, place: &Place) -> Sum {
        let (rate, forced) = (motion.rate, -(motion.frequency * motion.frequency));
        let late = self.acceleration | self.slope;
        let odd = self.velocity | self.slope;
        // Of every second derivative more, another factor.
        let (own, own_rate) = (late.choose(rate, number(1.0)), late.choose(forced, number(1.0)));
        let (a, a_rate, b, b_rate) =
            (own * place.own, own * place.own_rate, own_rate * place.forced, own_rate * place.forced_rate);
        let (own, forced_part) = (odd.choose(a_rate, a), odd.choose(b_rate, b));
        Sum {
            value: (late | odd).choose(own + forced_part, place.rotation),
            own,
            own_rate: odd.choose(rate * a, a_rate),
            forced: forced_part,
            forced_rate: odd.choose(forced * b, b_rate),
            factors: [rate, forced],
        }
    }
}

/// A derivative of θ: its two parts and their rates. Each part's second derivative is a multiple of itself.
#[derive(Clone, Copy, Debug)]
struct Sum {
    value: Number,
    own: Number,
    own_rate: Number,
    forced: Number,
    forced_rate: Number,
    factors: [Number; 2],
}

impl Sum {
    #[inline(always)]
    fn slope(&self) -> Number {
        self.own_rate + self.forced_rate
    }

    /// Its second derivative.
    #[inline(always)]
    fn second(&self) -> Sum {
        let [a, b] = self.factors;
        let (own, forced) = (a * self.own, b * self.forced);
        Sum {
            value: own + forced,
            own,
            own_rate: a * self.own_rate,
            forced,
            forced_rate: b * self.forced_rate,
            factors: self.factors,
        }
    }
}

/// Evaluations of a motion in search of a zero; two or three are usual.
const MOST_EVALUATIONS: u32 = 60;

/// How near Halley's step must come for the last one, in units of the time in which anything changes: what that one leaves out is the
/// sixth power over 720.
const NEAR: f64 = 5e-3;

/// How small Newton's last correction must be, relative to the time from the start: the error is its square.
const CONVERGED: f64 = 1e-8;

/// Where on (0, 1] that quartic vanishes, about, which has the value, slope and curvature of `start` at 0 and the value and slope of `end`
/// at 1. There it is below 0; up to its only zero, but not at 0 perhaps, it is above.
#[inline(always)]
fn guess([value, slope, curvature]: [Number; 3], [value_end, slope_end]: [Number; 2]) -> Number {
    let (nothing, one) = (number(0.0), number(1.0));
    let square = number(0.5) * curvature;
    let rest = value_end - value - slope - square;
    let fourth = slope_end - slope - curvature - number(3.0) * rest;
    let third = rest - fourth;
    let (mut low, mut top) = (nothing, one);
    let (mut here, mut here_slope, mut x) = (value_end, slope_end, one);
    for _ in 0..3 {
        let next = x - here / here_slope;
        let inside = next.exceeds(low) & top.exceeds(next);
        x = inside.choose(next, number(0.5) * (low + top));
        here = value + x * (slope + x * (square + x * (third + x * fourth)));
        here_slope = slope + x * (curvature + x * (number(3.0) * third + x * (number(4.0) * fourth)));
        let before = here.exceeds(nothing);
        low = before.choose(x, low);
        top = before.choose(top, x);
    }
    let next = x - here / here_slope;
    (next.exceeds(low) & top.exceeds(next)).choose(next, x)
}

/// The time in (0, `end`] at which what is `wanted` vanishes, and the place there; `end` where nothing is. There it has the sign `before`
/// (±1) up to its only zero, and the other at `end`; at the start it may be zero too.
#[inline(always)]
pub fn zero(motion: &Motion, wanted: &Wanted, before: Number, end: (Number, &Place)) -> (Number, Place) {
    let nothing = number(0.0);
    let (last, place_last) = end;
    let (first, at_end) = (wanted.of(motion, &motion.start), wanted.of(motion, place_last));
    let scale = before * last;
    let from = [(first.value * before).larger(nothing), first.slope() * scale, first.second().value * (scale * last)];
    let share = guess(from, [at_end.value * before, at_end.slope() * scale]);
    let mut open = wanted.any();
    let mut x = open.choose(share * last, last);
    let mut found = *place_last;
    let (mut low, mut top) = (nothing, last);
    // The square of how fast anything changes.
    let quick = motion.frequency * motion.frequency + motion.rate;
    for _ in 0..MOST_EVALUATIONS {
        let place = motion.at(x);
        let here = wanted.of(motion, &place);
        let (second, fourth) = (here.second(), here.second().second());
        let (value, slope) = (here.value, here.slope());
        let still_before = (value * before).exceeds(nothing);
        low = still_before.choose(x, low);
        top = still_before.choose(top, x);
        // Halley's step, then Newton's for the quintic about here.
        let halves = number(0.5) * second.value;
        let mut change = -(value * slope) / (slope * slope - value * halves);
        let near = !(change * change * quick).exceeds(number(NEAR * NEAR));
        let (cube, quartic, quintic) =
            (second.slope() * number(1.0 / 6.0), fourth.value * number(1.0 / 24.0), fourth.slope() * number(1.0 / 120.0));
        let mut correction = nothing;
        for _ in 0..2 {
            let rest = value + change * (slope + change * (halves + change * (cube + change * (quartic + change * quintic))));
            let rest_slope = slope
                + change
                    * (second.value
                        + change * (number(3.0) * cube + change * (number(4.0) * quartic + change * (number(5.0) * quintic))));
            correction = rest / rest_slope;
            change = near.choose(change - correction, change);
        }
        let next = x + change;
        let near = near & !correction.abs().exceeds(number(CONVERGED) * next.abs());
        let last_bit = number(2.3e-16) * last;
        let inside = (next.exceeds(low) & top.exceeds(next)) | !change.abs().exceeds(last_bit);
        let narrow = !(top - low).exceeds(last_bit);
        let done = (near & inside) | narrow;
        let settled = open & done;
        if settled.any() {
            let change = inside.choose(change, nothing);
            let there = motion.soon_after(&place, change);
            found = there.where_chosen(settled, &found);
            x = settled.choose(x + change, x);
        }
        open = open & !done;
        if !open.any() {
            break;
        }
        x = open.choose(inside.choose(next, number(0.5) * (low + top)), x);
    }
    (x, found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::WIDTH;
    use crate::slender::tests::{motions, samples};

    /// Each of the four, wherever samples show that it changes its sign once.
    #[test]
    fn what_changes_its_sign_once_vanishes_where_it_is_said_to() {
        let kinds = [
            Wanted { rotation: Mask::ALL, ..Wanted::NOTHING },
            Wanted { velocity: Mask::ALL, ..Wanted::NOTHING },
            Wanted { acceleration: Mask::ALL, ..Wanted::NOTHING },
            Wanted { slope: Mask::ALL, ..Wanted::NOTHING },
        ];
        for (kind, all) in kinds.into_iter().enumerate() {
            let mut zeros = 0;
            for (motion, length) in motions(400) {
                let (start, end) = (motion.start, motion.at(length));
                let value = |place: &Place| all.of(&motion, place).value;
                let (before, mut once) =
                    (value(&start).exceeds(number(0.0)), value(&start).exceeds(number(0.0)) ^ value(&end).exceeds(number(0.0)));
                let mut changed = Mask::NONE;
                for place in samples(&motion, length) {
                    let now = before ^ value(&place).exceeds(number(0.0));
                    once = once & !(changed & !now);
                    changed = changed | now;
                }
                let wanted = Wanted {
                    rotation: all.rotation & once,
                    velocity: all.velocity & once,
                    acceleration: all.acceleration & once,
                    slope: all.slope & once,
                };
                let (time, place) = zero(&motion, &wanted, before.sign(), (length, &end));
                let again = motion.at(time);
                for lane in 0..WIDTH {
                    let size = [start, end].iter().map(|place| value(place).0[lane].abs()).fold(0.0, f64::max)
                        + place.own.0[lane].abs()
                        + place.forced.0[lane].abs() * (1.0 + sprag_shared::math::pow(motion.frequency.0[lane], 3.0));
                    let what = || format!("{kind} of {:?} over {}: {}", motion.lane(lane), length.0[lane], time.0[lane]);
                    if once.at(lane) {
                        zeros += 1;
                        assert!(time.0[lane] > 0.0 && time.0[lane] <= length.0[lane], "{}", what());
                        assert!(value(&place).0[lane].abs() < 1e-14 * size, "{}: {} {size}", what(), value(&place).0[lane]);
                        assert!(value(&again).0[lane].abs() < 1e-14 * size, "{}: {} {size}", what(), value(&again).0[lane]);
                    } else {
                        assert_eq!(time.0[lane], length.0[lane]);
                    }
                }
            }
            assert!(zeros > 100, "{kind}: {zeros}");
        }
    }

    /// An uplift: θ̇ and θ̈ are zero at the start, and that zero is not the one looked for.
    #[test]
    fn a_zero_at_the_start_is_not_taken_for_a_later_one() {
        let (ground, frequency) = (number(-0.4), number(1.3));
        // a sin ψ = α.
        let phase = number(sprag_shared::math::asin(0.3 / 0.4));
        let motion = Motion::new(
            (number(0.0), number(0.0)),
            (number(0.3), number(1.0)),
            (ground, frequency),
            (phase, Scalar::sin_cos(phase)),
        );
        let length = number(1.5);
        let end = motion.at(length);
        let wanted = Wanted { acceleration: Mask::ALL, ..Wanted::NOTHING };
        assert!(motion.accelerations(&end)[0].0[0] < 0.0);
        let (time, _) = zero(&motion, &wanted, number(1.0), (length, &end));
        assert!(time.0[0] > 0.1 && time.0[0] < 1.5);
    }
}
