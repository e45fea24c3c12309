//! The motion of a step, and where it is at a time.

use sprag_shared::math::wide_hyperbolic::cosh_sinhc;
use sprag_shared::scalar::Scalar;

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
    /// y at the start, rad.
    pub own: Number,
    /// ẏ at the start, rad.
    pub own_rate: Number,
}

/// Where a motion is: its two parts and their rates, rad.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// y.
    pub own: Number,
    /// ẏ.
    pub own_rate: Number,
    /// s.
    pub forced: Number,
    /// ṡ.
    pub forced_rate: Number,
}

impl Motion {
    /// That of blocks of inertia I = 1/`rate` at θ = `rotation` with θ̇ = `velocity`, where ü_g/g is `ground` sin `phase`.
    #[inline(always)]
    pub fn new(
        (rotation, velocity): (Number, Number),
        (slenderness, rate): (Number, Number),
        (ground, frequency, phase): (Number, Number, Number),
    ) -> Motion {
        let amplitude = ground * rate / (rate + frequency * frequency);
        let (sine, cosine) = Scalar::sin_cos(phase);
        let own = rotation - slenderness - amplitude * sine;
        let own_rate = velocity - amplitude * frequency * cosine;
        Motion { slenderness, rate, frequency, amplitude, phase, own, own_rate }
    }

    /// The motion of one lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> [f64; 7] {
        [
            self.slenderness.0[lane],
            self.rate.0[lane],
            self.frequency.0[lane],
            self.amplitude.0[lane],
            self.phase.0[lane],
            self.own.0[lane],
            self.own_rate.0[lane],
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
        Motion { slenderness, rate, frequency, amplitude, phase, own, own_rate }
    }

    /// Where it starts.
    #[inline(always)]
    pub fn start(&self) -> Place {
        let (sine, cosine) = Scalar::sin_cos(self.phase);
        Place {
            own: self.own,
            own_rate: self.own_rate,
            forced: self.amplitude * sine,
            forced_rate: self.amplitude * self.frequency * cosine,
        }
    }

    /// At `time` from the start: up to the end of the half-cycle, and up to `time`²/I = 4.
    #[inline(always)]
    pub fn at(&self, time: Number) -> Place {
        let (cosh, sinhc) = cosh_sinhc(self.rate * (time * time));
        let (sine, cosine) = Scalar::sin_cos(self.phase + self.frequency * time);
        let sinh = time * sinhc;
        Place {
            own: self.own * cosh + self.own_rate * sinh,
            own_rate: self.own * (self.rate * sinh) + self.own_rate * cosh,
            forced: self.amplitude * sine,
            forced_rate: self.amplitude * self.frequency * cosine,
        }
    }

    /// A little later, to the fifth power of `time`.
    #[inline(always)]
    pub fn soon_after(&self, place: &Place, time: Number) -> Place {
        let forced = -(self.frequency * self.frequency);
        let (own, own_rate) = along(place.own, place.own_rate, self.rate, time);
        let (forced, forced_rate) = along(place.forced, place.forced_rate, forced, time);
        Place { own, own_rate, forced, forced_rate }
    }

    /// θ.
    #[inline(always)]
    pub fn rotation(&self, place: &Place) -> Number {
        self.slenderness + (place.own + place.forced)
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

/// x and ẋ a `time` after they are `value` and `rate`, where ẍ = `factor` x; to the fifth power of `time`.
#[inline(always)]
fn along(value: Number, rate: Number, factor: Number, time: Number) -> (Number, Number) {
    let one = number(1.0);
    let squared = factor * (time * time);
    // cosh and sinh of time √factor, the latter over √factor.
    let cosh = one + squared * (number(1.0 / 2.0) + squared * number(1.0 / 24.0));
    let sinh = time * (one + squared * (number(1.0 / 6.0) + squared * number(1.0 / 120.0)));
    (value * cosh + rate * sinh, rate * cosh + value * (factor * sinh))
}

impl Place {
    /// This where `mask` holds, `other` elsewhere.
    #[inline(always)]
    pub fn where_chosen(&self, mask: Mask, other: &Place) -> Place {
        Place {
            own: mask.choose(self.own, other.own),
            own_rate: mask.choose(self.own_rate, other.own_rate),
            forced: mask.choose(self.forced, other.forced),
            forced_rate: mask.choose(self.forced_rate, other.forced_rate),
        }
    }
}
