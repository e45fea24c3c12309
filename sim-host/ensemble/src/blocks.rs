//! Event-driven integration of several blocks, one in each SIMD lane.
//!
//! Each block is looked at in the mirror that puts it on the positive side, so that an impact turns its ground motion about. A step
//! ends at the first zero of θ̈, θ̇ or θ in it, found in this order as in [`sprag_shared::motion::ideal`]: between zeros of θ̈ the velocity
//! is monotone, between zeros of θ̇ the rotation is, so no crossing is missed. Without a clutch a zero of θ̈ after which a growing velocity falls
//! ends no step. Where the coefficients do not show how many zeros of θ̈
//! a step has, it is halved; what is still not plain then makes a block [`Blocks::hard`], and it is not followed any further.

use sprag_shared::equation::switched::Switched;
use sprag_shared::math::scalar::Scalar;
use sprag_shared::structure::COUNTED_SPEED;

use crate::plain::PlainBlock;
use crate::polynomial::{Shape, extreme, largest_in_lane, shape, value, value_and_slope, zero};
use crate::rest::WEAK_IMPACT;
use crate::series::Series;
use crate::{Mask, Number, WIDTH, number};

/// Size of the last terms of a step's series over α.
pub(crate) const TOLERANCE: f64 = 3e-15;

/// Halvings of a step that a block may ask for.
pub(crate) const MOST_HALVINGS: u32 = 24;

/// State of the blocks in the lanes, with their peaks and events; p = 1.
#[derive(Clone, Copy, Debug)]
pub struct Blocks {
    /// |θ|, rad.
    pub rotation: Number,
    /// Outward θ̇, rad.
    pub velocity: Number,
    /// Moves outward.
    pub outward: Mask,
    /// θ̈ is outward.
    pub pushed: Mask,
    /// θ̈ = 0 here, by an event just handled.
    pub at_zero: Mask,
    /// The sign of θ̈ must be evaluated again.
    pub fresh: Mask,
    /// +1, or −1 where the mirror turns the ground motion about.
    pub side: Number,
    /// max |θ|, rad.
    pub peak_rotation: Number,
    /// max |θ̈|, rad.
    pub peak_acceleration: Number,
    /// Has passed θ = 0.
    pub impact: Mask,
    /// Has just passed it with more than [`Bounds::counted`].
    pub counted: Mask,
    /// Has passed [`Bounds::overturned`].
    pub overturned: Mask,
    /// Has just passed it so slowly that impacts accumulate.
    pub weak: Mask,
    /// The core must integrate it.
    pub hard: Mask,
}

/// End of a step, and its event, if any.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// θ, rad.
    pub rotation: Number,
    /// θ̇, rad.
    pub velocity: Number,
    /// Impact: θ = 0.
    pub hit: Mask,
    /// Turn: θ̇ = 0.
    pub turned: Mask,
    /// Zero of the acceleration: θ̈ = 0.
    pub rate_zero: Mask,
    /// θ̈ has changed its sign within the step.
    pub passed: Mask,
}

/// Parameters of the blocks.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// α, rad.
    pub slenderness: Number,
    /// Coupling k.
    pub coupling: Number,
    /// Restitution η.
    pub restitution: Number,
    /// |θ| at which an outward motion counts as overturned, rad.
    pub overturned: Number,
    /// θ̇ after an impact below which impacts accumulate, rad.
    pub weak: Number,
    /// θ̇ with which an impact must come in to be counted, rad.
    pub counted: Number,
    /// Size of the last terms of θ, rad, where |θ| is below 1 rad.
    pub tolerance: Number,
}

impl Bounds {
    /// A harmless block, whose motions idle lanes go through.
    pub(crate) fn harmless() -> Bounds {
        let (zero, one) = (number(0.0), number(1.0));
        Bounds { slenderness: one, coupling: zero, restitution: zero, overturned: one, weak: zero, counted: zero, tolerance: one }
    }

    /// Another block in `lane`, which does not return from beyond `no_return` (rad).
    pub(crate) fn renew(&mut self, lane: usize, block: &PlainBlock, no_return: f64) {
        let PlainBlock { slenderness, coupling, restitution, .. } = *block;
        self.slenderness.0[lane] = slenderness;
        self.coupling.0[lane] = coupling;
        self.restitution.0[lane] = restitution;
        self.overturned.0[lane] = block.overturned_at(no_return);
        self.weak.0[lane] = WEAK_IMPACT * slenderness;
        self.counted.0[lane] = COUNTED_SPEED * slenderness;
        self.tolerance.0[lane] = TOLERANCE * slenderness;
    }
}

/// Equations of motion with the inerter released and engaged.
#[derive(Clone, Copy, Debug)]
pub struct Modes<E> {
    /// Equation with the inerter released.
    pub released: E,
    /// Equation with the inerter engaged.
    pub engaged: E,
}

impl Default for Blocks {
    /// Blocks at rest, without peaks and events.
    fn default() -> Blocks {
        let zero = number(0.0);
        Blocks {
            rotation: zero,
            velocity: zero,
            outward: Mask::ALL,
            pushed: Mask::ALL,
            at_zero: Mask::NONE,
            fresh: Mask::NONE,
            side: number(1.0),
            peak_rotation: zero,
            peak_acceleration: zero,
            impact: Mask::NONE,
            counted: Mask::NONE,
            overturned: Mask::NONE,
            weak: Mask::NONE,
            hard: Mask::NONE,
        }
    }
}

impl Blocks {
    /// New block in `lane`, without peaks and events.
    #[inline]
    pub fn renew(&mut self, lane: usize) {
        (self.peak_rotation.0[lane], self.peak_acceleration.0[lane]) = (0.0, 0.0);
        for answer in [&mut self.impact, &mut self.overturned, &mut self.hard] {
            answer.set(lane, false);
        }
    }

    /// The block in `lane` uplifts now to `side`, ±1, by a ground acceleration that crosses the threshold or has jumped above it.
    #[inline]
    pub fn uplift(&mut self, lane: usize, side: f64, crossing: bool) {
        (self.rotation.0[lane], self.velocity.0[lane], self.side.0[lane]) = (0.0, 0.0, side);
        self.outward.set(lane, true);
        self.pushed.set(lane, true);
        self.at_zero.set(lane, crossing);
        self.fresh.set(lane, false);
        self.weak.set(lane, false);
    }

    /// One step of every block, at most `longest`; returns how far each went. `series.ground` is ü_g/g in each block's mirror.
    #[inline(always)]
    pub fn step<E: Switched<Number>, const PAIR: bool, const TERMS: usize>(
        &mut self,
        modes: &Modes<E>,
        bounds: &Bounds,
        series: &mut Series<TERMS>,
        longest: Number,
    ) -> Number {
        let nothing = number(0.0);
        let one = number(1.0);
        if self.fresh.any() {
            // The sign of θ̈ does not depend on the mode.
            self.read_push(modes.released.switching(one, self.rotation, self.velocity, series.ground[0]));
        }
        let along = !(self.outward ^ self.pushed);
        let equation = if PAIR { E::switched(along, &modes.engaged, &modes.released) } else { modes.engaged };
        series.expand(&equation, self.rotation, self.velocity, self.at_zero);
        let push = self.pushed.sign();

        let reach = series.reach(bounds.tolerance * one.larger(self.rotation));
        let from_zero = self.at_zero;
        let (mut length, changed, plain) = self.plain_stretch(series, push, reach.smaller(longest));
        // A velocity that grows before it falls has its zero, if any, after that of θ̈: without a clutch nothing happens at the latter.
        let passed = if PAIR { Mask::NONE } else { changed & along };
        let changed = changed & !passed;
        if changed.any() {
            length = zero(series.acceleration_off_zero(), push, plain.end, length, changed);
        }
        // θ̇ is monotone up to here, or grows before it falls.
        let direction = self.outward.sign();
        let mut velocity = value(series.velocity(), length);
        let turned = nothing.exceeds(velocity * direction);
        if turned.any() {
            length = zero(series.velocity(), direction, velocity, length, turned);
            velocity = turned.choose(nothing, velocity);
        }
        // θ is monotone up to here.
        let mut rotation = value(series.rotation(), length);
        let hit = nothing.exceeds(rotation);
        if hit.any() {
            self.hard = self.hard | (hit & self.outward);
            length = zero(series.rotation(), one, rotation, length, hit);
            velocity = hit.choose(value(series.velocity(), length), velocity);
            rotation = hit.choose(nothing, rotation);
        }
        let uneventful = !(changed | turned | hit | from_zero).any();
        let over_step = if uneventful { plain } else { shape(series.acceleration(), length) };
        self.widen(series, length, push, passed, over_step);

        let rate_zero = changed & !turned & !hit;
        self.arrive(Arrival { rotation, velocity, hit, turned: turned & !hit, rate_zero, passed }, bounds);
        length
    }

    /// Reads the sign of θ̈ from `rate`, which has it, where that is to be read anew.
    #[inline(always)]
    pub fn read_push(&mut self, rate: Number) {
        self.pushed = (self.fresh & rate.exceeds(number(0.0))) | (!self.fresh & self.pushed);
    }

    /// The end of a step over which θ was monotone.
    #[inline(always)]
    pub fn arrive(&mut self, arrival: Arrival, bounds: &Bounds) {
        let Arrival { rotation, velocity, hit, turned, rate_zero, passed } = arrival;
        self.peak_rotation = self.peak_rotation.larger(rotation);
        self.overturned = self.overturned | (self.outward & rotation.exceeds(bounds.overturned));
        let after = velocity * bounds.restitution;
        self.counted = hit & !bounds.counted.exceeds(velocity.abs());
        self.weak = hit & bounds.weak.exceeds(after.abs());
        self.rotation = rotation;
        self.velocity = hit.choose(-after, velocity);
        self.pushed = self.pushed ^ (rate_zero | passed);
        self.at_zero = rate_zero;
        self.outward = (self.outward ^ turned) | hit;
        self.side = hit.choose(-self.side, self.side);
        self.impact = self.impact | hit;
        self.fresh = hit;
    }

    /// A length, at most `longest`, over which each θ̈ has one zero or none: the length, where there is a zero, and the shape of θ̈ (over t
    /// where that is zero at the start).
    #[inline(always)]
    fn plain_stretch<const TERMS: usize>(
        &mut self,
        series: &Series<TERMS>,
        push: Number,
        longest: Number,
    ) -> (Number, Mask, Shape) {
        let nothing = number(0.0);
        let rates = series.acceleration_off_zero();
        let start = rates[0] * push;
        self.hard = self.hard | !start.exceeds(nothing);
        let mut length = longest;
        let mut halvings = 0;
        loop {
            let plain = shape(rates, length);
            let Shape { end, monotone, bent, sag, .. } = plain;
            let last = end * push;
            let changed = nothing.exceeds(last);
            let clear = start.smaller(last).exceeds(sag);
            let unsettled = !(self.hard | monotone | (changed & bent) | (clear & !changed));
            if !unsettled.any() {
                return (length, changed, plain);
            }
            halvings += 1;
            if halvings > MOST_HALVINGS {
                self.hard = self.hard | unsettled;
                return (length, changed, plain);
            }
            length = unsettled.choose(length * number(0.5), length);
        }
    }

    /// Takes into account the largest |θ̈| of a step of the given length, over which θ̈ has the shape `over_step` and the sign of `push`, or, where
    /// `passed`, may lose it once.
    #[inline(always)]
    fn widen<const TERMS: usize>(
        &mut self,
        series: &Series<TERMS>,
        length: Number,
        push: Number,
        passed: Mask,
        over_step: Shape,
    ) {
        let nothing = number(0.0);
        let rates = series.acceleration();
        let Shape { end, sag, monotone, bent, twisted } = over_step;
        let ends = rates[0].abs().larger(end.abs());
        let open = (ends + sag).exceeds(self.peak_acceleration) & !monotone & !self.hard;
        self.peak_acceleration = self.peak_acceleration.larger(ends);
        if !open.any() {
            return;
        }
        let slope = value_and_slope(rates, length).1;
        let (first, last) = (rates[1] * push, slope * push);
        let opposite = nothing.exceeds(first * last);
        let rises_then_falls = first.exceeds(nothing) & nothing.exceeds(last);
        // A slope that turns at most once and changes its sign has one zero. Where it only falls, θ̈ lies below the tangents of its ends.
        let start = rates[0] * push;
        let meet = (end * push - start - last * length) / (first - last);
        let below = bent & !passed & !(start + first * meet).exceeds(self.peak_acceleration);
        let crest = open & (rises_then_falls | (passed & opposite)) & (bent | twisted) & !below;
        if crest.any() {
            let highest = extreme(rates, (rates[1], slope), length, crest).abs();
            self.peak_acceleration = self.peak_acceleration.larger(crest.choose(highest, nothing));
        }
        // A slope that turns at most once and has one sign at both ends has two zeros or none: none where it sets out away from zero.
        let away = (rates[2] * rates[1]).exceeds(nothing);
        let doubtful = open & !bent & !(twisted & (opposite | away));
        if doubtful.any() {
            for lane in (0..WIDTH).filter(|&lane| doubtful.at(lane)) {
                let peak = &mut self.peak_acceleration.0[lane];
                *peak = largest_in_lane::<TERMS>(rates, lane, (length.0[lane], end.0[lane]), *peak);
            }
        }
    }
}
