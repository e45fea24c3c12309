//! One step of slender blocks under their pulses.

use std::f64::consts::PI;

use sprag_shared::math::scalar::Scalar;

use super::crest;
use super::pending::Pending;
use super::zero::{Wanted, zero};
use super::{Motion, Place};
use crate::blocks::{Arrival, Blocks, Bounds, MOST_HALVINGS};
use crate::pulsed::PulseResult;
use crate::pulses::{Pulses, Stepping};
use crate::{Mask, Number, WIDTH, number};

/// The longest step: time²/I is then below what [`Motion::at`] takes, because I is 1 or more.
const LONGEST: f64 = 2.0;

/// How soon a zero of θ̇ or θ̈ may come, in units of the time in which anything changes, before the core takes the block.
const TINY: f64 = 1e-10;

/// Steps in closed form.
#[derive(Clone, Debug)]
pub struct ClosedForm {
    /// Half-cycles of the sine that are over.
    half_cycles: Number,
    pending: Pending,
    /// Whether it will be asked when blocks overturn.
    watched: bool,
    /// When in the last step they have.
    passed: Number,
}

impl Default for ClosedForm {
    fn default() -> ClosedForm {
        ClosedForm { half_cycles: number(0.0), pending: Pending::default(), watched: false, passed: number(0.0) }
    }
}

impl ClosedForm {
    /// The sign of sin ψ.
    #[inline(always)]
    fn sign(&self) -> Number {
        // Two zeros of a cosine lie within its cycle.
        let odd = self.half_cycles.exceeds(number(0.5)) & number(1.5).exceeds(self.half_cycles);
        (!odd).sign()
    }
}

/// A length, at most `longest`, over which each θ̈ has one zero or none; the place there, and where there is a zero.
#[inline(always)]
fn plain_stretch(blocks: &mut Blocks, motion: &Motion, longest: Number) -> (Number, Place, Mask) {
    let nothing = number(0.0);
    let push = blocks.pushed.sign();
    let start = &motion.start;
    let [rate, slope, _] = motion.accelerations(start);
    let rate = blocks.at_zero.choose(nothing, rate) * push;
    let slope = slope * push;
    blocks.hard = blocks.hard | !blocks.at_zero.choose(slope, rate).exceeds(nothing);
    let mut length = longest;
    let mut halvings = 0;
    loop {
        let end = motion.at(length);
        let [rate_end, slope_end, _] = motion.accelerations(&end);
        let (rate_end, slope_end) = (rate_end * push, slope_end * push);
        let changed = nothing.exceeds(rate_end) & !blocks.hard;
        // Two zeros can only be where θ̈ bends away from zero: y has its sign throughout, and s̈ has not. Its tangents lie below it.
        let sags = (start.own * push).exceeds(nothing)
            & (end.own * push).exceeds(nothing)
            & (motion.amplitude * push).exceeds(nothing)
            & nothing.exceeds(slope)
            & slope_end.exceeds(nothing);
        let meet = (rate_end - rate - slope_end * length) / (slope - slope_end);
        let clear = (rate + slope * meet).exceeds(nothing);
        let unsettled = !(blocks.hard | changed | !sags | clear);
        if !unsettled.any() {
            return (length, end, changed);
        }
        halvings += 1;
        if halvings > MOST_HALVINGS {
            blocks.hard = blocks.hard | unsettled;
            return (length, end, changed & !unsettled);
        }
        length = unsettled.choose(length * number(0.5), length);
    }
}

impl Stepping for ClosedForm {
    #[inline(always)]
    fn renew(&mut self, lane: usize) {
        self.pending.renew(lane);
    }

    #[inline(always)]
    fn uplift(&mut self, lane: usize, half_cycles: f64) {
        self.half_cycles.0[lane] = half_cycles;
    }

    fn watch(&mut self) {
        self.watched = true;
    }

    fn passes(&self, lane: usize, _length: f64, _limit: f64) -> f64 {
        self.passed.0[lane]
    }

    #[inline(always)]
    fn stands(&mut self, lane: usize, index: usize, results: &mut [PulseResult]) {
        self.pending.stands(lane, index, results);
    }

    #[inline(always)]
    fn finish(&mut self, results: &mut [PulseResult]) -> &[usize] {
        self.pending.finish(results)
    }

    #[inline(always)]
    fn step<const PAIR: bool>(&mut self, blocks: &mut Blocks, bounds: &Bounds, pulses: &Pulses) -> Number {
        let Bounds { slenderness, coupling, .. } = *bounds;
        let (nothing, one) = (number(0.0), number(1.0));
        let half_cycle = number(PI);
        let phase = pulses.frequency * pulses.time + pulses.phase - self.half_cycles * half_cycle;
        let phase = phase.larger(nothing).smaller(half_cycle);
        let ground = pulses.amplitude * blocks.side * self.sign();
        let turn = Scalar::sin_cos(phase);
        // The sign of θ̈ does not depend on the mode.
        blocks.read_push(blocks.rotation - slenderness - ground * turn.0);
        let along = !(blocks.outward ^ blocks.pushed);
        let engaged = if PAIR { along } else { Mask::ALL };
        let rate = one / (one + engaged.choose(coupling, nothing));
        let here = (blocks.rotation, blocks.velocity);
        let motion = Motion::new(here, (slenderness, rate), (ground, pulses.frequency), (phase, turn));

        let to_half_cycle = (half_cycle - phase) / pulses.frequency;
        let longest = pulses.left().smaller(to_half_cycle).smaller(number(LONGEST));
        let (mut length, mut end, changed) = plain_stretch(blocks, &motion, longest);

        let push = blocks.pushed.sign();
        let direction = blocks.outward.sign();
        // A velocity that grows before it falls has its zero, if any, after that of θ̈: without a clutch nothing happens at the latter.
        let passed = if PAIR { Mask::NONE } else { changed & along };
        let (mut rate_zero, mut turned, mut hit) = (Mask::NONE, Mask::NONE, Mask::NONE);
        let mut looked_at_rate = passed | !changed;
        loop {
            let acceleration = !looked_at_rate;
            let followed = looked_at_rate & !blocks.hard;
            let velocity = followed & !turned & !hit & nothing.exceeds(motion.velocity(&end) * direction);
            let rotation = followed & !velocity & !hit & nothing.exceeds(end.rotation);
            let wanted = Wanted { rotation, velocity, acceleration, slope: Mask::NONE };
            if !wanted.any().any() {
                break;
            }
            let before = acceleration.choose(push, velocity.choose(direction, one));
            (length, end) = zero(&motion, &wanted, before, (length, &end));
            looked_at_rate = Mask::ALL;
            (rate_zero, turned, hit) =
                (acceleration | (rate_zero & !velocity & !rotation), velocity | (turned & !rotation), hit | rotation);
        }
        // Next to a zero that the step starts from, rounding decides.
        let tiny = !(length * length * (rate + pulses.frequency * pulses.frequency)).exceeds(number(TINY * TINY));
        blocks.hard = blocks.hard | (hit & blocks.outward) | ((turned | rate_zero) & tiny);
        let known = blocks.peak_acceleration;
        let ends = [&motion.start, &end].map(|place| motion.accelerations(place)[0].abs());
        let known = known.larger(blocks.at_zero.choose(nothing, ends[0])).larger(rate_zero.choose(nothing, ends[1]));
        blocks.peak_acceleration = known;
        let pending = crest::may_exceed(&motion, (length, &end), known) & !blocks.hard;
        if pending.any() {
            for lane in (0..WIDTH).filter(|&lane| pending.at(lane)) {
                self.pending.add(lane, &motion, length.0[lane]);
            }
        }

        let over = !to_half_cycle.exceeds(length);
        self.half_cycles = self.half_cycles + over.choose(one, nothing);
        let rotation = hit.choose(nothing, end.rotation);
        let velocity = turned.choose(nothing, motion.velocity(&end));
        blocks.arrive(Arrival { rotation, velocity, hit, turned, rate_zero, passed }, bounds);
        if self.watched && blocks.overturned.any() {
            // The limit as θ = 0.
            let (mut motion, mut end) = (motion, end);
            motion.start.rotation = motion.start.rotation - bounds.overturned;
            end.rotation = end.rotation - bounds.overturned;
            let rotation = blocks.overturned & nothing.exceeds(motion.start.rotation) & end.rotation.exceeds(nothing);
            let wanted = Wanted { rotation, ..Wanted::NOTHING };
            self.passed = rotation.choose(zero(&motion, &wanted, -one, (length, &end)).0, nothing);
        }
        length
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slender::tests::{motions, samples};

    /// Wherever θ̈ is looked at, it has the zeros that the ends show, and no others.
    #[test]
    fn a_stretch_has_the_zeros_that_it_is_said_to_have() {
        let (mut changes, mut halved) = (0, 0);
        for (motion, longest) in motions(400) {
            let pushed = motion.accelerations(&motion.start)[0].exceeds(number(0.0));
            let mut blocks = Blocks { pushed, ..Blocks::default() };
            let (length, end, changed) = plain_stretch(&mut blocks, &motion, longest);
            assert!(!blocks.hard.any());
            let mut seen = [0; WIDTH];
            let mut before = pushed;
            for place in samples(&motion, length).chain([end]) {
                let now = motion.accelerations(&place)[0].exceeds(number(0.0));
                for (lane, seen) in seen.iter_mut().enumerate() {
                    *seen += u32::from(now.at(lane) != before.at(lane));
                }
                before = now;
            }
            for (lane, seen) in seen.into_iter().enumerate() {
                assert_eq!(seen, u32::from(changed.at(lane)), "{:?} over {}", motion.lane(lane), length.0[lane]);
                changes += seen;
                halved += u32::from(length.0[lane] < longest.0[lane]);
            }
        }
        assert!(changes > 300 && halved > 3, "{changes} changes, {halved} shorter");
    }
}
