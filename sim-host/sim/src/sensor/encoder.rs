//! The incremental encoder on the rack.

use std::f64::consts::PI;

use sprag_shared::control::sensing::sample::Count;
use sprag_shared::math;

use super::delivery::Delivery;
use super::random::{Purpose, Random};
use super::sampling::{Clock, SAME_INSTANT, Sampling};

/// An incremental encoder: it reads ⌊x/r + φ⌋ − ⌊x₀/r + φ⌋ of a travel x (m), with the phase φ of its scale drawn evenly from 0 to 1. It
/// has no hysteresis: both ways the count changes at the same places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    /// r, travel per count after quadrature, m; above 0.
    pub resolution: f64,
    /// Probability that a count is missed, 0 to 1. Missed counts are never made up for, but those of both ways cancel in the mean.
    pub miss_probability: f64,
    /// When the counter is read, and when that is known.
    pub sampling: Sampling,
}

impl Encoder {
    /// 10 nm per count, always known: 21 m until the count wraps.
    pub const IDEAL: Encoder = Encoder { resolution: 1e-8, miss_probability: 0.0, sampling: Sampling::CONTINUOUS };

    /// Resolution (m) of a rotary encoder with `counts` per revolution after quadrature on a pinion of `radius` (m): 2πr/counts.
    pub const fn rotary_resolution(counts: f64, radius: f64) -> f64 {
        2.0 * PI * radius / counts
    }
}

/// An encoder at work.
#[derive(Clone, Debug)]
pub(super) struct EncoderSensor {
    resolution: f64,
    phase: f64,
    /// Place on the scale where it started, in counts.
    start: i64,
    /// Place on the scale where it last looked for missed counts.
    seen: i64,
    /// Counts missed so far, signed.
    missed: i64,
    /// Counts until the next one that is missed.
    until_miss: u64,
    miss_probability: f64,
    random: Random,
    clock: Option<Clock>,
    time: f64,
    travel: f64,
    number: u32,
    delivery: Delivery<Count>,
}

impl EncoderSensor {
    /// An encoder whose axis has the number `axis`, at `travel` (m) and time 0.
    pub(super) fn new(encoder: &Encoder, seed: u64, axis: u64, travel: f64) -> EncoderSensor {
        let mut sensor = EncoderSensor {
            resolution: encoder.resolution,
            phase: Random::new(seed, axis, Purpose::TurnOn).uniform(),
            start: 0,
            seen: 0,
            missed: 0,
            until_miss: 0,
            miss_probability: encoder.miss_probability,
            random: Random::new(seed, axis, Purpose::Noise),
            clock: Clock::new(&encoder.sampling, Random::new(seed, axis, Purpose::Clock)),
            time: 0.0,
            travel,
            number: 1,
            delivery: Delivery::new(encoder.sampling.latency, Count { counts: 0, number: 1 }),
        };
        sensor.start = sensor.place(travel);
        sensor.seen = sensor.start;
        sensor.until_miss = sensor.draw_miss();
        sensor
    }

    #[inline(always)]
    fn place(&self, travel: f64) -> i64 {
        // As `floor`, which without SSE4.1 is a call; beyond the range of an i64 both end there.
        let place = travel / self.resolution + self.phase;
        let toward_zero = place as i64;
        toward_zero.saturating_sub(i64::from((toward_zero as f64) > place))
    }

    /// Counts up to and with the next one missed: geometric, ⌊ln(1 − u)/ln(1 − p)⌋ + 1.
    fn draw_miss(&mut self) -> u64 {
        if self.miss_probability <= 0.0 {
            return u64::MAX;
        }
        let counts = math::ln(1.0 - self.random.uniform()) / math::log1p(-self.miss_probability);
        (counts as u64).saturating_add(1)
    }

    /// The counter once the rack has gone straight to `travel`.
    fn count(&mut self, travel: f64) -> i32 {
        let place = self.place(travel);
        if self.miss_probability > 0.0 {
            let direction = place.wrapping_sub(self.seen).signum();
            let mut passed = place.abs_diff(self.seen);
            while passed >= self.until_miss {
                passed -= self.until_miss;
                self.missed = self.missed.wrapping_add(direction);
                self.until_miss = self.draw_miss();
            }
            self.until_miss -= passed;
            self.seen = place;
        }
        // The counter wraps, as a register of 32 bits does.
        place.wrapping_sub(self.start).wrapping_sub(self.missed) as i32
    }

    fn send(&mut self, instant: f64, travel: f64) {
        self.number = self.number.wrapping_add(1);
        let counts = self.count(travel);
        self.delivery.send(instant, Count { counts, number: self.number });
    }

    /// As [`super::Sensors::advance`].
    pub(super) fn advance(&mut self, time: f64, travel: f64) {
        let (start, before) = (self.time, self.travel);
        let end = time.max(start);
        let Some(mut next) = self.clock.as_ref().map(|clock| clock.next) else {
            self.send(end, travel);
            self.delivery.deliver(end);
            (self.time, self.travel) = (end, travel);
            return;
        };
        while next <= end + SAME_INSTANT {
            let instant = next.clamp(start, end);
            let part = if end > start { (instant - start) / (end - start) } else { 1.0 };
            let Some(clock) = &mut self.clock else { break };
            clock.step();
            next = clock.next;
            self.send(instant, before + part * (travel - before));
        }
        // The counter itself never stops counting, and missing.
        if self.miss_probability > 0.0 {
            self.count(travel);
        }
        self.delivery.deliver(end);
        (self.time, self.travel) = (end, travel);
    }

    /// What can be read.
    pub(super) fn readable(&self) -> Count {
        self.delivery.readable()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: Encoder = Encoder { resolution: 1e-3, miss_probability: 0.0, sampling: Sampling::CONTINUOUS };

    #[test]
    fn the_scale_is_rounded_down_from_a_phase_that_is_anywhere() {
        // Over many specimens the count is the travel, without bias either way.
        for travel in [0.4e-3, -0.4e-3, 12.3e-3, -12.3e-3] {
            let mean: f64 = (0..4000)
                .map(|seed| {
                    let mut encoder = EncoderSensor::new(&STEP, seed, 5, 0.0);
                    encoder.advance(1e-3, travel);
                    let counts = f64::from(encoder.readable().counts);
                    assert!((counts - travel / 1e-3).abs() < 1.0);
                    counts / 4000.0
                })
                .sum();
            assert!((mean - travel / 1e-3).abs() < 0.04, "{travel}: {mean}");
        }
    }

    #[test]
    fn going_back_and_forth_leaves_no_drift_and_no_hysteresis() {
        let mut encoder = EncoderSensor::new(&STEP, 1, 5, 0.0);
        let path = |index: i32| 0.02 * math::sin(0.01 * f64::from(index));
        let mut up = std::collections::BTreeMap::new();
        for index in 0..100_000 {
            encoder.advance(1e-4 * f64::from(index), path(index));
            let counts = encoder.readable().counts;
            // The same place gives the same count, whichever way and however late it is passed.
            assert_eq!(*up.entry(path(index).to_bits()).or_insert(counts), counts);
            assert!((f64::from(counts) - path(index) / 1e-3).abs() < 1.0);
        }
        encoder.advance(10.0, 0.0);
        assert_eq!(encoder.readable(), Count { counts: 0, number: 100_002 });
    }

    #[test]
    fn sampling_and_latency_hold_the_count_back() {
        let sampling = Sampling { rate: 1000.0, latency: 2e-3, ..Sampling::CONTINUOUS };
        let mut encoder = EncoderSensor::new(&Encoder { sampling, ..STEP }, 1, 5, 0.0);
        let mut exact = EncoderSensor::new(&STEP, 1, 5, 0.0);
        let mut counts = Vec::new();
        for index in 1..2000_i32 {
            let (time, travel) = (1e-4 * f64::from(index), 2e-3 * f64::from(index));
            encoder.advance(time, travel);
            exact.advance(time, travel);
            counts.push(exact.readable().counts);
            if index >= 30 {
                let read = ((index / 10 - 2) * 10) as usize;
                assert_eq!(encoder.readable().counts, counts[read - 1], "{index}");
                assert_eq!(encoder.readable().number as usize, read / 10 + 1);
            }
        }
    }

    #[test]
    fn missed_counts_are_as_many_as_stated_and_lost_for_good() {
        let missing = Encoder { miss_probability: 0.01, ..STEP };
        let mut encoder = EncoderSensor::new(&missing, 1, 5, 0.0);
        encoder.advance(1.0, 100.0);
        let lost = 100_000 - encoder.readable().counts;
        assert!((850..1150).contains(&lost), "{lost}");
        let back: Vec<i32> = (0..400)
            .map(|seed| {
                let mut encoder = EncoderSensor::new(&missing, seed, 5, 0.0);
                encoder.advance(1.0, 1.0);
                encoder.advance(2.0, 0.0);
                encoder.readable().counts
            })
            .collect();
        let mean = f64::from(back.iter().sum::<i32>()) / 400.0;
        let square = f64::from(back.iter().map(|counts| counts * counts).sum::<i32>()) / 400.0;
        // 1000 counts each way: mean 0, variance 2 · 1000 · p(1 − p).
        assert!(mean.abs() < 1.0 && (square / 19.8 - 1.0).abs() < 0.3, "{mean} {square}");
    }

    #[test]
    fn a_pinion_rolls_its_circumference() {
        assert!((Encoder::rotary_resolution(8192.0, 0.05) - 38.35e-6).abs() < 1e-8);
    }
}
