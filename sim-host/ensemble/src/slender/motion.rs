//! The motion of a step, and where it is at a time.

use sprag_shared::math::scalar::Scalar;
use sprag_shared::math::wide_hyperbolic::c2_c3;
use sprag_shared::math::wide_sine::sin_versine;

use crate::{Mask, Number, WIDTH, number};

/// The closed form of one step, from its start on.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// α, rad.
    pub slenderness: Number,
    /// 1/I.
    pub rate: Number,
    /// ω.
    pub frequency: Number,
    /// R times the sign of sin ψ in this half-cycle, rad.
    pub amplitude: Number,
    /// ψ from the start of the half-cycle, 0 to π rad.
    pub phase: Number,
    /// Sine and cosine of that.
    turn: (Number, Number),
    /// State at the start of the step.
    pub start: Place,
}

/// State of a motion at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// θ, rad.
    pub rotation: Number,
    /// y, rad.
    pub own: Number,
    /// ẏ, rad.
    pub own_rate: Number,
    /// s, rad.
    pub forced: Number,
    /// ṡ, rad.
    pub forced_rate: Number,
}

impl Motion {
    /// That of blocks of inertia I = 1/`rate` at θ = `rotation` with θ̇ = `velocity`, where ü_g/g is `ground` sin `phase`; `turn` is the sine and
    /// cosine of that.
    #[inline(always)]
    pub fn new(
        (rotation, velocity): (Number, Number),
        (slenderness, rate): (Number, Number),
        (ground, frequency): (Number, Number),
        (phase, turn): (Number, (Number, Number)),
    ) -> Motion {
        let amplitude = ground * rate / (rate + frequency * frequency);
        let (forced, forced_rate) = (amplitude * turn.0, amplitude * frequency * turn.1);
        let own = rotation - slenderness - forced;
        let own_rate = velocity - forced_rate;
        let start = Place { rotation, own, own_rate, forced, forced_rate };
        Motion { slenderness, rate, frequency, amplitude, phase, turn, start }
    }

    /// The same motion from `place` on, its state at `time`.
    #[inline(always)]
    pub fn from(&self, time: Number, place: Place) -> Motion {
        let phase = self.phase + self.frequency * time;
        Motion { phase, turn: Scalar::sin_cos(phase), start: place, ..*self }
    }

    /// Slenderness, rate, frequency, amplitude, phase, y and ẏ of one lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> [f64; 7] {
        [
            self.slenderness.0[lane],
            self.rate.0[lane],
            self.frequency.0[lane],
            self.amplitude.0[lane],
            self.phase.0[lane],
            self.start.own.0[lane],
            self.start.own_rate.0[lane],
        ]
    }

    /// The motions of lanes.
    #[inline(always)]
    pub fn of_lanes(lanes: &[[f64; 7]; WIDTH]) -> Motion {
        let mut numbers = [number(0.0); 7];
        for (lane, motion) in lanes.iter().enumerate() {
            for (numbers, value) in numbers.iter_mut().zip(motion) {
                numbers.0[lane] = *value;
            }
        }
        let [slenderness, rate, frequency, amplitude, phase, own, own_rate] = numbers;
        let (sine, cosine) = Scalar::sin_cos(phase);
        let (forced, forced_rate) = (amplitude * sine, amplitude * frequency * cosine);
        let start = Place { rotation: slenderness + (own + forced), own, own_rate, forced, forced_rate };
        Motion { slenderness, rate, frequency, amplitude, phase, turn: (sine, cosine), start }
    }

    /// At `time` from the start: up to the end of the half-cycle, and up to `time`²/I = 4.
    ///
    /// θ is the start's and what is added to it, as in [`sprag_shared::method::closed_form`]: however small the motion, nothing of it cancels.
    #[inline(always)]
    pub fn at(&self, time: Number) -> Place {
        let one = number(1.0);
        let start = &self.start;
        let squared = time * time;
        let own_turn = self.rate * squared;
        let (c2, c3) = c2_c3(own_turn);
        let (cosh, sinh) = (one + own_turn * c2, time * (one + own_turn * c3));
        let angle = self.frequency * time;
        let (sine, versine) = sin_versine(angle);
        let (sine_here, cosine_here) = self.turn;
        let cosine = one - versine;

        let [acceleration, ..] = self.accelerations(start);
        let free = self.velocity(start) * sinh + acceleration * (squared * c2);
        let even = (angle * angle) * c2 - versine;
        let odd = angle * (own_turn * c3) + (angle - sine);
        Place {
            rotation: start.rotation + (free + self.amplitude * (sine_here * even - cosine_here * odd)),
            own: start.own * cosh + start.own_rate * sinh,
            own_rate: start.own * (self.rate * sinh) + start.own_rate * cosh,
            forced: self.amplitude * (sine_here * cosine + cosine_here * sine),
            forced_rate: (self.amplitude * self.frequency) * (cosine_here * cosine - sine_here * sine),
        }
    }

    /// A little later, to the fifth power of `time`.
    #[inline(always)]
    pub fn soon_after(&self, place: &Place, time: Number) -> Place {
        let forced = -(self.frequency * self.frequency);
        let own_change = Change::new(self.rate, time).of(place.own, place.own_rate);
        let forced_change = Change::new(forced, time).of(place.forced, place.forced_rate);
        Place {
            rotation: place.rotation + (own_change.0 + forced_change.0 + time * self.velocity(place)),
            own: place.own + (time * place.own_rate + own_change.0),
            own_rate: place.own_rate + own_change.1,
            forced: place.forced + (time * place.forced_rate + forced_change.0),
            forced_rate: place.forced_rate + forced_change.1,
        }
    }

    /// θ̇.
    #[inline(always)]
    pub fn velocity(&self, place: &Place) -> Number {
        place.own_rate + place.forced_rate
    }

    /// θ̈, its slope and its curvature.
    #[inline(always)]
    pub fn accelerations(&self, place: &Place) -> [Number; 3] {
        let (rate, forced) = (self.rate, -(self.frequency * self.frequency));
        [
            rate * place.own + forced * place.forced,
            rate * place.own_rate + forced * place.forced_rate,
            (rate * rate) * place.own + (forced * forced) * place.forced,
        ]
    }
}

/// How x and ẋ change over a short time where ẍ = c x, to the fifth power of the time: x by more than its rate alone gives.
struct Change {
    /// c.
    factor: Number,
    /// cosh(t√c) − 1.
    even: Number,
    /// sinh(t√c)/√c − t.
    odd: Number,
    time: Number,
}

impl Change {
    #[inline(always)]
    fn new(factor: Number, time: Number) -> Change {
        let squared = factor * (time * time);
        let even = squared * (number(1.0 / 2.0) + squared * number(1.0 / 24.0));
        let odd = time * (squared * (number(1.0 / 6.0) + squared * number(1.0 / 120.0)));
        Change { factor, even, odd, time }
    }

    #[inline(always)]
    fn of(&self, value: Number, rate: Number) -> (Number, Number) {
        (value * self.even + rate * self.odd, rate * self.even + value * (self.factor * (self.time + self.odd)))
    }
}

impl Place {
    /// This where `mask` holds, `other` elsewhere.
    #[inline(always)]
    pub fn where_chosen(&self, mask: Mask, other: &Place) -> Place {
        Place {
            rotation: mask.choose(self.rotation, other.rotation),
            own: mask.choose(self.own, other.own),
            own_rate: mask.choose(self.own_rate, other.own_rate),
            forced: mask.choose(self.forced, other.forced),
            forced_rate: mask.choose(self.forced_rate, other.forced_rate),
        }
    }
}
