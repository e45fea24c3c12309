//! Peak |θ̈| of a step.

use std::f64::consts::FRAC_PI_2;

use sprag_shared::math::lanes::Lanes;
use sprag_shared::math::scalar::Scalar;

use super::zero::{Wanted, zero};
use super::{Motion, Place};
use crate::{Mask, Number, WIDTH, number};

/// How often a step may be cut in [`WIDTH`] parts to look inside.
const DEEPEST: usize = 5;

/// Extremes within a step, as far as its two ends show.
struct Between {
    /// |θ̈| has one crest.
    crest: Mask,
    /// Not decided by the ends.
    doubtful: Mask,
    /// The sign of s̈, which θ̈ has at its crest.
    sign: Number,
}

/// The parts of θ̈ where the motion is, y/I and s̈, and their slopes, times `sign`.
#[inline(always)]
fn parts(motion: &Motion, place: &Place, sign: Number) -> [Number; 4] {
    let (own, forced) = (motion.rate * sign, -(motion.frequency * motion.frequency) * sign);
    [own * place.own, own * place.own_rate, forced * place.forced, forced * place.forced_rate]
}

/// What is between the start and `end`, of lanes where |θ̈| may exceed `known`. q is θ̈ with the sign that makes s̈ positive: crests of −q are at the ends, because q
/// bends downwards (q̈ < 0) where y and s̈ differ in sign.
#[inline(always)]
fn between(motion: &Motion, (length, end): (Number, &Place), known: Number) -> Between {
    let nothing = number(0.0);
    // s̈ = −ω² R sin ψ.
    let sign = motion.amplitude.exceeds(nothing).sign() * number(-1.0);
    let [own, own_slope, forced, forced_slope] = parts(motion, &motion.start, sign);
    let [own_end, own_slope_end, forced_end, forced_slope_end] = parts(motion, end, sign);
    let squared = motion.frequency * motion.frequency;
    let bend = motion.rate * own - squared * forced;
    let bend_end = motion.rate * own_end - squared * forced_end;
    let bend_slope = motion.rate * own_slope - squared * forced_slope;
    let bend_slope_end = motion.rate * own_slope_end - squared * forced_slope_end;
    let (slope, slope_end) = (own_slope + forced_slope, own_slope_end + forced_slope_end);

    // The two parts are largest at the ends, but s̈ where the half-cycle is half over.
    let quarter = number(FRAC_PI_2);
    let over_top = !motion.phase.exceeds(quarter) & (motion.phase + motion.frequency * length).exceeds(quarter);
    let forced_most = over_top.choose(squared * motion.amplitude.abs(), forced.larger(forced_end));
    let own_most = own.larger(own_end);
    let most = (own_most.larger(nothing) + forced_most).larger(-own.smaller(own_end));
    let open = most.exceeds(known);

    let same_sign = own.exceeds(nothing) & own_end.exceeds(nothing);
    let (down, down_end) = (!bend.exceeds(nothing), !bend_end.exceeds(nothing));
    // q̈ bends upwards where y and s̈ have one sign; there it may dip below zero between ends above it.
    let dips = same_sign & !down & !down_end & nothing.exceeds(bend_slope) & bend_slope_end.exceeds(nothing);
    let (rises, falls_end) = (slope.exceeds(nothing), nothing.exceeds(slope_end));
    // A slope that turns once has two zeros or none between ends of one sign: it may have where it turns towards zero.
    let twice = (down & !down_end & rises & !falls_end) | (!down & down_end & !rises & falls_end);
    let doubtful = open & (dips | twice);
    let crest = open & rises & falls_end & !dips;
    // Where it bends downwards throughout, it lies below the tangents of its ends.
    let (first, last) = (own + forced, own_end + forced_end);
    let meet = (last - first - slope_end * length) / (slope - slope_end);
    let below = down & down_end & !(first + slope * meet).exceeds(known);
    Between { crest: crest & !below, doubtful, sign }
}

/// Where |θ̈| may exceed `known` between the ends of a step.
#[inline(always)]
pub fn may_exceed(motion: &Motion, end: (Number, &Place), known: Number) -> Mask {
    let Between { crest, doubtful, .. } = between(motion, end, known);
    crest | doubtful
}

/// The larger of `known` and max |θ̈| of the step to `end`, and the lanes in which it is not decided.
#[inline(always)]
pub fn largest(motion: &Motion, end: (Number, &Place), known: Number) -> (Number, Mask) {
    let Between { crest, doubtful, sign } = between(motion, end, known);
    let mut largest = known;
    if crest.any() {
        let (_, top) = zero(motion, &Wanted { slope: crest, ..Wanted::NOTHING }, sign, end);
        largest = largest.larger(crest.choose(motion.accelerations(&top)[0].abs(), number(0.0)));
    }
    let mut unknown = Mask::NONE;
    if doubtful.any() {
        for lane in (0..WIDTH).filter(|&lane| doubtful.at(lane)) {
            match look_inside(&Motion::of_lanes(&[motion.lane(lane); WIDTH]), end.0.0[lane], largest.0[lane]) {
                Some(found) => largest.0[lane] = found,
                None => unknown.set(lane, true),
            }
        }
    }
    (largest, unknown)
}

/// The larger of `known` and max |θ̈| of one block, whose motion is in every lane, up to `length`; none if it is not decided.
#[inline(always)]
fn look_inside(motion: &Motion, length: f64, known: f64) -> Option<f64> {
    let mut largest = known;
    // What is still to be looked at: from, to, and into how many parts of parts it may be cut.
    let mut waiting = [(0.0, 0.0, 0); WIDTH * DEEPEST];
    waiting[0] = (0.0, length, DEEPEST);
    let mut count = 1;
    while count > 0 {
        count -= 1;
        let (from, to, deeper) = waiting[count];
        let part = (to - from) / WIDTH as f64;
        let starts = Lanes(std::array::from_fn(|lane| from + part * lane as f64));
        let (start, end) = (motion.at(starts), motion.at(starts + number(part)));
        let shifted = motion.from(starts, start);
        let highest = |place: &Place| motion.accelerations(place)[0].abs();
        largest = highest(&start).larger(highest(&end)).0.into_iter().fold(largest, f64::max);
        let end = (number(part), &end);
        let Between { crest, doubtful, sign } = between(&shifted, end, number(largest));
        if crest.any() {
            let (_, top) = zero(&shifted, &Wanted { slope: crest, ..Wanted::NOTHING }, sign, end);
            largest = crest.choose(highest(&top), number(0.0)).0.into_iter().fold(largest, f64::max);
        }
        for lane in (0..WIDTH).filter(|&lane| doubtful.at(lane)) {
            let from = starts.0[lane];
            *waiting.get_mut(count)? = (from, from + part, deeper.checked_sub(1)?);
            count += 1;
        }
    }
    Some(largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slender::tests::{motions, samples};

    #[test]
    fn the_largest_is_as_large_as_any() {
        let (mut crests, mut inside) = (0, 0);
        for (motion, length) in motions(400) {
            let (start, end) = (motion.start, motion.at(length));
            let size = |place: &Place| motion.accelerations(place)[0].abs();
            let known = size(&start).larger(size(&end));
            let Between { crest, doubtful, .. } = between(&motion, (length, &end), known);
            let may = may_exceed(&motion, (length, &end), known);
            let (found, unknown) = largest(&motion, (length, &end), known);
            let seen = samples(&motion, length).fold(known, |most, place| most.larger(size(&place)));
            for lane in 0..WIDTH {
                let (found, seen, known) = (found.0[lane], seen.0[lane], known.0[lane]);
                let what = || format!("{:?} over {}: {found} {seen} {known}", motion.lane(lane), length.0[lane]);
                assert!(!unknown.at(lane), "{}", what());
                assert!(found >= seen * (1.0 - 1e-14) && found <= seen * (1.0 + 1e-4), "{}", what());
                assert!(may.at(lane) || found == known, "{}", what());
                crests += u32::from(crest.at(lane));
                inside += u32::from(doubtful.at(lane));
            }
        }
        assert!(crests > 300 && inside > 10, "{crests} crests, {inside} looked into");
    }
}
