//! Steps of the classical Runge-Kutta method, of a block whose mode lasts through the step: an event inside one is located by taking the
//! step again with a shorter length. What the ends of a step do not show is not seen.

use crate::equation::motion::Motion;
use crate::math::root::illinois;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::dense_output::DenseOutput;
use crate::motion::device_snapshot::DeviceOutput;
use crate::motion::ground_pair::GroundPair;
use crate::motion::observer::{MonotoneInterval, Observer};
use crate::motion::state::BlockState;

/// What changes within a step: θ and θ̇, a length over R and its speed, and energy lost over mR²; or the rates of all five.
pub(super) type Place<S> = [S; 5];

/// The place with `rates` for `h`.
fn after<S: Real>(place: &Place<S>, rates: &Place<S>, h: S) -> Place<S> {
    core::array::from_fn(|i| place[i] + h * rates[i])
}

/// The state of a block, with the mode that lasts through a step.
pub(super) trait Mode<S: Real>: Copy {
    /// Its equations.
    type System;

    /// The block.
    fn block(&self) -> &BlockState<S>;

    /// Where it is.
    fn place(&self) -> Place<S>;

    /// The same mode elsewhere.
    fn at(&self, place: &Place<S>) -> Self;

    /// Rates of the place on ground that has ü_g/g and the weight 1 + v̈_g/g.
    fn rates(&self, system: &Self::System, ground: [S; 2]) -> Place<S>;
}

/// Dense output of a step.
pub(super) struct Stretch<'a, S: Real, M: Mode<S>> {
    pub system: &'a M::System,
    /// As it was at the start.
    pub mode: M,
    ground: GroundPair<'a, S>,
    time: S,
    length: S,
    end: Place<S>,
}

impl<'a, S: Real, M: Mode<S>> Stretch<'a, S, M> {
    /// From `mode` at `time` over `length` (s).
    pub fn new(system: &'a M::System, ground: GroundPair<'a, S>, mode: M, time: S, length: S) -> Stretch<'a, S, M> {
        let mut stretch = Stretch { system, mode, ground, time, length, end: mode.place() };
        stretch.end = stretch.step(length);
        stretch
    }

    fn step(&self, h: S) -> Place<S> {
        let start = self.mode.place();
        let rates = |place: &Place<S>, ground| self.mode.at(place).rates(self.system, ground);
        let [middle, end] = [S::HALF * h, h].map(|t| self.ground(t));
        let first = rates(&start, self.ground(S::ZERO));
        let second = rates(&after(&start, &first, S::HALF * h), middle);
        let third = rates(&after(&start, &second, S::HALF * h), middle);
        let fourth = rates(&after(&start, &third, h), end);
        let both = after(&second, &third, S::ONE);
        let sum = after(&after(&first, &both, S::of(2.0)), &fourth, S::ONE);
        after(&start, &sum, h * S::of(1.0 / 6.0))
    }

    /// ü_g/g and the weight 1 + v̈_g/g `time` (s) after the start.
    pub fn ground(&self, time: S) -> [S; 2] {
        self.ground.at(self.time + time)
    }

    /// The state `time` (s) after the start.
    pub fn state(&self, time: S) -> M {
        if time == S::ZERO {
            self.mode
        } else if time == self.length {
            self.mode.at(&self.end)
        } else {
            self.mode.at(&self.step(time))
        }
    }

    /// How far it goes (s), and the first of `guards` whose `value` falls below zero there; of two at one instant the earlier one.
    pub fn first<G: Copy>(&self, guards: impl Iterator<Item = G>, value: impl Fn(G, S) -> S) -> (S, Option<G>) {
        let mut found: Option<(S, G)> = None;
        for guard in guards.filter(|guard| value(*guard, self.length) < S::ZERO) {
            let at = illinois(S::ZERO, self.length, Sign::Positive, |time| value(guard, time));
            found = found.filter(|(first, _)| *first <= at).or(Some((at, guard)));
        }
        (found.map_or(self.length, |(at, _)| at), found.map(|(_, guard)| guard))
    }

    /// Shows `observer` the motion up to `until` (s after the start), with a flywheel that is `engaged` or not.
    pub fn show(&self, until: S, engaged: bool, observer: &mut dyn Observer<S>)
    where
        Self: DeviceOutput<S>,
    {
        if until > S::ZERO {
            let BlockState { side, direction, .. } = *self.mode.block();
            let (start, from) = (self.time, S::ZERO);
            let (first, last) = (DenseOutput::at(self, from), DenseOutput::at(self, until));
            observer.device_interval(self, &MonotoneInterval { start, from, to: until, first, last, engaged, side, direction });
        }
    }
}

impl<S: Real, M: Mode<S>> DenseOutput<S> for Stretch<'_, S, M> {
    fn length(&self) -> S {
        self.length
    }

    fn at(&self, time: S) -> Motion<S> {
        let state = self.state(time);
        let BlockState { rotation, velocity, .. } = *state.block();
        let [_, acceleration, ..] = state.rates(self.system, self.ground(time));
        Motion { rotation, velocity, acceleration }
    }

    /// Steps are long beside the swings of θ̈: a cubic through its ends and two instants between them shows where θ̈ may be larger. It does not
    /// double within a step.
    fn largest_acceleration(&self, from: (S, S), to: (S, S), floor: S) -> S {
        let ends = from.1.abs().larger(to.1.abs());
        let floor = floor.larger(ends);
        if ends + ends <= floor {
            return floor;
        }
        let third = (to.0 - from.0) * S::of(1.0 / 3.0);
        let after = |thirds: S| self.at(from.0 + thirds * third).acceleration;
        let inner = [S::ONE, S::of(2.0)].map(after);
        let floor = floor.larger(inner[0].abs()).larger(inner[1].abs());
        cubic_extremes([from.1, inner[0], inner[1], to.1])
            .into_iter()
            .flatten()
            .fold(floor, |most, at| most.larger(after(at).abs()))
    }
}

/// Where the cubic with these values at 0, 1, 2 and 3 has its extremes between 0 and 3.
fn cubic_extremes<S: Real>([a, b, c, d]: [S; 4]) -> [Option<S>; 2] {
    // Newton's form: a + first u + second u (u − 1) + third u (u − 1) (u − 2).
    let first = b - a;
    let second = S::HALF * (c - b - first);
    let third = S::of(1.0 / 6.0) * (d - a + S::of(3.0) * (b - c));
    let (square, slope, start) = (S::of(3.0) * third, S::of(2.0) * second - S::of(6.0) * third, first - second + third + third);
    let discriminant = slope * slope - S::of(4.0) * square * start;
    if discriminant < S::ZERO {
        return [None; 2];
    }
    let sum = -S::HALF * (slope + Sign::of(slope, Sign::Positive).times(discriminant.square_root()));
    // One that does not exist is not finite, and not between.
    [sum / square, start / sum].map(|at| Some(at).filter(|at| *at > S::ZERO && *at < S::of(3.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_of_a_cubic() {
        let of = |cubic: fn(f64) -> f64| cubic_extremes([0.0, 1.0, 2.0, 3.0].map(cubic));
        let near = |found: Option<f64>, expected: f64| assert!((found.unwrap() - expected).abs() < 1e-12, "{found:?} {expected}");
        // The slope is (u − 0.5)(u − 2.5); then one extreme outside; then a parabola, a line, and no extreme at all.
        let [outer, inner] = of(|u| u * u * u / 3.0 - 1.5 * u * u + 1.25 * u + 7.0);
        near(outer, 2.5);
        near(inner, 0.5);
        assert_eq!(of(|u| u * u * u / 3.0 - 2.5 * u * u + 4.0 * u).into_iter().flatten().count(), 1);
        near(of(|u| 3.0 * u - u * u).into_iter().flatten().next(), 1.5);
        assert_eq!(of(|u| 2.0 - u), [None; 2]);
        assert_eq!(of(|_| 2.0), [None; 2]);
        assert_eq!(of(|u| u * u * u + u), [None; 2]);
    }
}
