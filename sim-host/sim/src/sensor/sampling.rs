//! When a sensor samples.

use std::f64::consts::{SQRT_2, TAU};

use super::random::Random;

/// Two instants nearer to each other than this (s) are one: sums and products of the same periods differ by rounding.
pub(super) const SAME_INSTANT: f64 = 1e-9;

/// Furthest that jitter moves an instant, in periods, so that samples keep their order.
const FURTHEST: f64 = 0.45;

/// Instants at which a sensor samples and at which its readings can be read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Output data rate, Hz. 0 is continuous: a reading at every instant that the truth is given.
    pub rate: f64,
    /// Samples at whole periods after time 0, as a sensor does that the controller clocks, or that clocks the controller. Otherwise the
    /// sensor runs freely: its first sample falls anywhere in the first period.
    pub synchronous: bool,
    /// Standard deviation of the instant of a sample, s; at most a tenth of the period. Normal, cut off at 0.45 periods.
    pub jitter: f64,
    /// From the instant of sampling until the reading can be read, s; not negative. The delay of the low-pass filter comes on top.
    pub latency: f64,
}

impl Sampling {
    /// Continuous and at once.
    pub const CONTINUOUS: Sampling = Sampling { rate: 0.0, synchronous: true, jitter: 0.0, latency: 0.0 };

    /// What delays a sensor with a low-pass of `bandwidth` (Hz, 0 for none) from the motion to the reading that a tick sees, s: the low-pass
    /// (√2/ω_c for Butterworth's of second order), half of the time between readings, and the latency.
    pub fn delays(&self, bandwidth: f64) -> [f64; 3] {
        let filter = if bandwidth > 0.0 { SQRT_2 / (TAU * bandwidth) } else { 0.0 };
        let held = if self.rate > 0.0 && !self.synchronous { 0.5 / self.rate } else { 0.0 };
        [filter, held, self.latency]
    }
}

/// The instants, one after the other.
#[derive(Clone, Debug)]
pub(super) struct Clock {
    /// s.
    pub(super) period: f64,
    first: f64,
    index: i64,
    jitter: f64,
    random: Random,
    /// The next instant, s.
    pub(super) next: f64,
}

impl Clock {
    /// The clock of a sensor that is not continuous.
    pub(super) fn new(sampling: &Sampling, mut random: Random) -> Option<Clock> {
        if sampling.rate <= 0.0 {
            return None;
        }
        let period = 1.0 / sampling.rate;
        // Drawn in any case, so that the jitter is the same either way.
        let phase = random.uniform();
        let first = if sampling.synchronous { period } else { phase * period };
        let mut clock = Clock { period, first, index: 0, jitter: sampling.jitter, random, next: 0.0 };
        clock.place();
        Some(clock)
    }

    fn place(&mut self) {
        let shift = if self.jitter > 0.0 {
            (self.jitter * self.random.normal()).clamp(-FURTHEST * self.period, FURTHEST * self.period)
        } else {
            0.0
        };
        self.next = self.first + self.index as f64 * self.period + shift;
    }

    /// Advances to the instant after the next.
    #[inline]
    pub(super) fn step(&mut self) {
        self.index += 1;
        self.place();
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::Purpose;
    use super::*;

    fn clock(sampling: Sampling, seed: u64) -> Clock {
        Clock::new(&sampling, Random::new(seed, 0, Purpose::Clock)).unwrap()
    }

    #[test]
    fn a_synchronous_clock_ticks_at_whole_periods() {
        let mut clock = clock(Sampling { rate: 2000.0, ..Sampling::CONTINUOUS }, 1);
        for index in 1..100_000 {
            assert!((clock.next - f64::from(index) / 2000.0).abs() < 1e-12);
            clock.step();
        }
    }

    #[test]
    fn a_free_clock_starts_anywhere_in_the_first_period() {
        let sampling = Sampling { rate: 100.0, synchronous: false, ..Sampling::CONTINUOUS };
        let first: Vec<f64> = (0..4000).map(|seed| clock(sampling, seed).next * 100.0).collect();
        let mean = first.iter().sum::<f64>() / 4000.0;
        let square = first.iter().map(|phase| phase * phase).sum::<f64>() / 4000.0;
        assert!(first.iter().all(|phase| (0.0..1.0).contains(phase)));
        assert!((mean - 0.5).abs() < 0.02 && (square - 1.0 / 3.0).abs() < 0.02);
    }

    #[test]
    fn jitter_has_no_mean_the_stated_deviation_and_keeps_the_order() {
        for (jitter, tolerance) in [(10e-6, 0.01), (40e-6, 0.01)] {
            let mut clock = clock(Sampling { rate: 1000.0, jitter, ..Sampling::CONTINUOUS }, 3);
            let (mut sum, mut square, mut last) = (0.0, 0.0, 0.0);
            let count = 100_000;
            for index in 1..=count {
                let shift = clock.next - f64::from(index) / 1000.0;
                assert!(clock.next > last);
                sum += shift / f64::from(count);
                square += shift * shift / f64::from(count);
                last = clock.next;
                clock.step();
            }
            assert!(sum.abs() < 5.0 * jitter / 300.0, "{sum}");
            assert!((square.sqrt() / jitter - 1.0).abs() < tolerance, "{square}");
        }
    }
}
