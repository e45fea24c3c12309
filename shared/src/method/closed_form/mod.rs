//! Closed form of the slender block's motion: exact to rounding, however long the step.
//!
//! Between two events θ̈ = p_σ² (θ − αs − ü), with ü in g, is linear. Over a time τ from the step's start (index 0)
//!
//! θ = θ₀ + θ̇₀ sinh(pτ)/p + θ̈₀ (cosh pτ − 1)/p² + f(τ),  f̈ = p² (f − \[ü(τ) − ü₀\]), f and ḟ zero at 0:
//!
//! the free motion and the response to the *change* of the ground's acceleration. With
//! ü − ü₀ = b τ + Σ \[ a (cos ωτ − 1) + c sin ωτ \]
//!
//! f = −b (sinh(pτ)/p − τ) + Σ p²/(p²+ω²) \[ a (ω²(cosh pτ − 1)/p² − 1 + cos ωτ) − c (ω sinh(pτ)/p − sin ωτ) \].
//!
//! Written in Stumpff functions ([`stumpff`]) nothing of this cancels, so that a step of 1e-5/p is as good as one of 1/p, and
//! short steps take neither an exponential nor a sine.
//!
//! θ̈ has a bounded second derivative with a simple bound, so its zeros are located with the proof that the Taylor method has,
//! and none is missed however long the step.
//!
//! It applies to slender blocks under ground segments that are [`Elementary`]: straight lines and sines, so records, pulses and
//! Mavroeidis-Papageorgiou wavelets. Anywhere else ([`Ricker`](crate::ground::Ricker)'s wavelet, the full model)
//! the method takes the Runge-Kutta step of the same length: never wrong, but of order 4.

use crate::equation::motion::Motion;
use crate::equation::{Equation, SlenderBlock};
use crate::ground::Elementary;
use crate::math::polynomial::{first_zero_of, largest_magnitude_of};
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::stumpff;
use crate::method::dense_output::{DenseOutput, Integrator, StepStart};
use crate::method::fixed::{FixedOutput, Scheme};

/// Longest step, in 1/p_σ, so that e^{pτ} stays small and the bounds tight.
const LONGEST: f64 = 4.0;

/// Integrator by the closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedForm<S> {
    /// Step, s; above 0. Results do not depend on it, only how often the motion is sampled.
    pub step: S,
}

/// Dense output of one step.
pub enum ClosedFormOutput<'a, S> {
    /// Motion in closed form.
    Closed(SlenderArc<S>),
    /// Motion by Runge-Kutta, where there is no closed form.
    Stepped(FixedOutput<'a, S>),
}

impl<S: Real> Integrator<S> for ClosedForm<S> {
    type Output<'a> = ClosedFormOutput<'a, S>;

    fn integrate<'a>(&'a self, start: &'a StepStart<'a, S>) -> ClosedFormOutput<'a, S> {
        match (start.equation.slender(), start.segment.elementary(start.time)) {
            (Some(block), Some(ground)) => ClosedFormOutput::Closed(SlenderArc::new(block, ground, start)),
            _ => ClosedFormOutput::Stepped(FixedOutput::new(Scheme::RungeKutta4, start)),
        }
    }

    fn step(&self) -> Option<S> {
        Some(self.step)
    }
}

/// The motion of a slender block under a line and sines.
#[derive(Clone, Copy, Debug)]
pub struct SlenderArc<S> {
    length: S,
    /// p_σ².
    rate: S,
    start: Motion<S>,
    /// Each sine times p²/(p²+ω²).
    ground: Elementary<S>,
    /// dθ̈/dτ at the start.
    jerk: S,
    end: Motion<S>,
    /// Bound of d²θ̈/dτ² over the step.
    curvature: S,
}

impl<S: Real> SlenderArc<S> {
    fn new(block: &SlenderBlock<S>, mut ground: Elementary<S>, start: &StepStart<'_, S>) -> Self {
        let rate = block.frequency_squared;
        let acceleration = start.first_acceleration(block);
        // θ̇ less the ground's rate of change, and θ̇ and θ̈ less those of the sines' particular solutions.
        let mut relative = start.velocity - ground.slope;
        let (mut odd, mut even) = (relative, acceleration);
        let mut bound = S::ZERO;
        for wave in ground.waves_mut() {
            let squared = wave.frequency * wave.frequency;
            relative = relative - wave.cosine * wave.frequency;
            let gain = rate / (rate + squared);
            (wave.sine, wave.cosine) = (wave.sine * gain, wave.cosine * gain);
            odd = odd - wave.cosine * wave.frequency;
            even = even + wave.sine * squared;
            bound = bound + (wave.sine.abs() + wave.cosine.abs()) * (squared * squared);
        }
        let longest = S::of(LONGEST);
        let length =
            if rate * (start.length * start.length) > longest * longest { longest / rate.square_root() } else { start.length };
        let here = Motion { rotation: start.rotation, velocity: start.velocity, acceleration };
        let mut output = SlenderArc { length, rate, start: here, ground, jerk: rate * relative, end: here, curvature: S::ZERO };
        let growth = output.growth(length);
        output.end = output.motion(length, growth);
        // d²θ̈/dτ² = p² [p² odd sinh(pτ)/p + even cosh pτ] and of each sine at most ω⁴ times its size.
        let Growth { squared, c2, c3 } = growth;
        let sinh = length * (S::ONE + squared * c3);
        output.curvature = rate * (rate * odd.abs() * sinh + even.abs() * (S::ONE + squared * c2)) + bound;
        output
    }

    fn growth(&self, time: S) -> Growth<S> {
        let squared = self.rate * (time * time);
        let (c2, c3) = stumpff::c2_c3(-squared);
        Growth { squared, c2, c3 }
    }

    #[inline(always)]
    fn motion(&self, time: S, growth: Growth<S>) -> Motion<S> {
        let Growth { squared, c2, c3 } = growth;
        let Motion { rotation, velocity, acceleration } = self.start;
        let slope = self.ground.slope;
        let sinh = time * (S::ONE + squared * c3);
        let cosh = S::ONE + squared * c2;
        let mut change = velocity * sinh + acceleration * (time * time * c2) - slope * (time * squared * c3);
        let mut velocity_change = velocity * (squared * c2) + acceleration * sinh - slope * (squared * c2);
        let mut end = acceleration * cosh + (velocity - slope) * (self.rate * sinh);
        for wave in self.ground.waves() {
            let turn = wave.frequency * time;
            let turned = turn * turn;
            let (w2, w3) = stumpff::c2_c3(turned);
            let odd = turn * (squared * c3 + turned * w3);
            let even = squared * c2 + turned * w2;
            let rise = self.rate * sinh + wave.frequency * turn * (S::ONE - turned * w3);
            change = change + wave.sine * (turned * (c2 - w2)) - wave.cosine * odd;
            velocity_change = velocity_change + wave.frequency * (wave.sine * odd - wave.cosine * even);
            end = end + wave.frequency * (wave.sine * wave.frequency * even - wave.cosine * rise);
        }
        Motion { rotation: rotation + change, velocity: velocity + velocity_change, acceleration: end }
    }

    /// θ̈ and its derivatives; the equation of motion gives the first, its own derivatives the others.
    fn acceleration(&self, time: S) -> [S; 3] {
        let growth = self.growth(time);
        let motion = self.motion(time, growth);
        let (mut push_slope, mut push_second) = (self.ground.slope, S::ZERO);
        for wave in self.ground.waves() {
            let turn = wave.frequency * time;
            let (w2, w3) = stumpff::c2_c3(turn * turn);
            let (sine, cosine) = (turn - turn * (turn * turn) * w3, S::ONE - turn * turn * w2);
            let squared = wave.frequency * wave.frequency;
            let amplitude = S::ONE + squared / self.rate;
            push_slope = push_slope + amplitude * wave.frequency * (wave.cosine * cosine - wave.sine * sine);
            push_second = push_second - amplitude * squared * (wave.sine * cosine + wave.cosine * sine);
        }
        [motion.acceleration, self.rate * (motion.velocity - push_slope), self.rate * (motion.acceleration - push_second)]
    }

    /// θ̈ and its derivative.
    fn value_and_slope(&self, time: S) -> (S, S) {
        if time == S::ZERO {
            return (self.start.acceleration, self.jerk);
        }
        let [value, slope, _] = self.acceleration(time);
        (value, slope)
    }
}

/// Stumpff's functions of −p²τ².
#[derive(Clone, Copy)]
struct Growth<S> {
    /// p²τ².
    squared: S,
    c2: S,
    c3: S,
}

impl<S: Real> DenseOutput<S> for SlenderArc<S> {
    fn length(&self) -> S {
        self.length
    }

    fn at(&self, time: S) -> Motion<S> {
        if time == S::ZERO {
            self.start
        } else if time == self.length {
            self.end
        } else {
            self.motion(time, self.growth(time))
        }
    }

    /// θ̈: slender blocks switch with it.
    fn acceleration_zero(&self, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        let stretch = (from, to, self.at(to).acceleration);
        first_zero_of(|t| self.value_and_slope(t), self.curvature, stretch, sign, from_zero)
    }

    fn largest_acceleration(&self, from: (S, S), to: (S, S), floor: S) -> S {
        let curve = (|t| self.value_and_slope(t), |t| self.acceleration(t)[2]);
        largest_magnitude_of(&curve, self.curvature, from, to, floor)
    }
}

macro_rules! either {
    ($output:expr, $inner:ident => $result:expr) => {
        match $output {
            ClosedFormOutput::Closed($inner) => $result,
            ClosedFormOutput::Stepped($inner) => $result,
        }
    };
}

impl<S: Real> DenseOutput<S> for ClosedFormOutput<'_, S> {
    fn length(&self) -> S {
        either!(self, output => output.length())
    }

    fn at(&self, time: S) -> Motion<S> {
        either!(self, output => output.at(time))
    }

    fn switching(&self, time: S) -> S {
        either!(self, output => output.switching(time))
    }

    fn acceleration_zero(&self, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        either!(self, output => output.acceleration_zero(from, to, sign, from_zero))
    }

    fn switching_zero(&self, from: S, to: S, sign: Sign, from_zero: bool) -> Option<S> {
        either!(self, output => output.switching_zero(from, to, sign, from_zero))
    }

    #[inline]
    fn largest_acceleration(&self, from: (S, S), to: (S, S), floor: S) -> S {
        either!(self, output => output.largest_acceleration(from, to, floor))
    }
}

#[cfg(test)]
mod tests;
