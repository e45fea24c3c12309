//! The way of the block over a short piece of the ground motion, for what is asked between its ends.

use sprag_shared::equation::motion::Motion;
use sprag_shared::math::sign::Sign;
use sprag_shared::motion::device_snapshot::DeviceOutput;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::state::BlockState;

const STILL: Motion<f64> = Motion { rotation: 0.0, velocity: 0.0, acceleration: 0.0 };

/// A monotone interval by its ends; of no length, a block that stands from then on.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    start: f64,
    length: f64,
    side: Sign,
    first: Motion<f64>,
    last: Motion<f64>,
}

impl Stretch {
    /// θ̇ as the cubic with its values and slopes at both ends, θ as its integral, θ̈ as its slope: over a step of h = 0.5 ms of a motion with
    /// p = 5 rad/s they miss by some (ph)⁴/384, 10⁻¹³ of themselves, and θ̈ by (ph)³/120, 10⁻¹⁰.
    fn at(&self, time: f64) -> Motion<f64> {
        if self.length <= 0.0 {
            return self.last;
        }
        let t = (time - self.start).min(self.length);
        let Motion { rotation, velocity, acceleration } = self.first;
        let over = 1.0 / self.length;
        let mean = (self.last.velocity - velocity) * over;
        let second = (3.0 * mean - 2.0 * acceleration - self.last.acceleration) * over;
        let third = (acceleration + self.last.acceleration - 2.0 * mean) * over * over;
        Motion {
            rotation: rotation + t * (velocity + t * (acceleration / 2.0 + t * (second / 3.0 + t * (third / 4.0)))),
            velocity: velocity + t * (acceleration + t * (second + t * third)),
            acceleration: acceleration + t * (2.0 * second + t * (3.0 * third)),
        }
    }
}

/// The way of a block without springs since the start of a piece.
#[derive(Clone, Debug, Default)]
pub struct Path {
    origin: f64,
    side: Sign,
    stretches: Vec<Stretch>,
}

impl Path {
    /// A piece begins at `time` (s), with the block on its toe of `side`.
    pub fn begin(&mut self, time: f64, side: Sign) {
        (self.origin, self.side) = (time, side);
        self.stretches.clear();
    }

    /// Side and motion at `time` (s) of the piece. A block that has not moved yet stands.
    pub fn at(&self, time: f64) -> (Sign, Motion<f64>) {
        let stretch = self.stretches.iter().rfind(|stretch| stretch.start <= time);
        stretch.map_or((self.side, STILL), |stretch| (stretch.side, stretch.at(time)))
    }
}

impl Observer<f64> for Path {
    fn device_interval(&mut self, _output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        let MonotoneInterval { start, from, to, first, last, side, .. } = *interval;
        if to > from {
            self.stretches.push(Stretch { start: self.origin + start + from, length: to - from, side, first, last });
        }
    }

    fn event(&mut self, event: Event, time: f64, state: &BlockState<f64>) {
        if event == Event::Rest {
            // A rest may stand for impacts that go on until then.
            let start = self.stretches.last().map_or(self.origin + time, |last| last.start + last.length);
            self.stretches.push(Stretch { start, length: 0.0, side: state.side, first: STILL, last: STILL });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// θ = sin pt, p = 5 rad/s.
    fn swing(time: f64) -> Motion<f64> {
        let (sine, cosine) = sprag_shared::math::sin_cos(5.0 * time);
        Motion { rotation: sine, velocity: 5.0 * cosine, acceleration: -25.0 * sine }
    }

    /// From `start` (s) on, for `length` (s).
    fn stretch(start: f64, length: f64) -> Stretch {
        Stretch { start, length, side: Sign::Positive, first: swing(start), last: swing(start + length) }
    }

    /// Errors of θ, θ̇ and θ̈ at a quarter of a stretch.
    fn errors(length: f64) -> [f64; 3] {
        let time = 0.1 + length / 4.0;
        let (found, exact) = (stretch(0.1, length).at(time), swing(time));
        [found.rotation - exact.rotation, found.velocity - exact.velocity, found.acceleration - exact.acceleration].map(f64::abs)
    }

    #[test]
    fn it_misses_by_the_fourth_power_of_the_step_its_integral_by_the_fifth_and_its_slope_by_the_third() {
        let (coarse, fine) = (errors(0.02), errors(0.01));
        for (expected, (coarse, fine)) in [32.0, 16.0, 8.0].into_iter().zip(coarse.into_iter().zip(fine)) {
            let ratio = coarse / fine;
            assert!((ratio / expected - 1.0).abs() < 0.15, "{expected}: {ratio}");
        }
        let tick = errors(5e-4);
        assert!(tick[0] < 1e-15 && tick[1] < 5e-13 && tick[2] < 3e-9, "{tick:?}");
    }

    #[test]
    fn a_block_stands_before_its_uplift_and_from_the_last_impact_that_is_followed() {
        let mut path = Path::default();
        path.begin(2.0, Sign::Negative);
        path.stretches.push(stretch(2.1, 0.2));
        assert_eq!(path.at(2.05), (Sign::Negative, STILL));
        assert_eq!(path.at(2.1), (Sign::Positive, swing(2.1)));
        // As far as rounding goes, a stretch ends where the piece does.
        assert_eq!(path.at(2.31), path.at(2.1 + 0.2));
        path.event(Event::Rest, 0.4, &BlockState { side: Sign::Negative, ..BlockState::default() });
        for time in [2.31, 2.5] {
            assert_eq!(path.at(time), (Sign::Negative, STILL));
        }
        path.begin(3.0, Sign::Negative);
        assert_eq!(path.at(3.1), (Sign::Negative, STILL));
    }
}
