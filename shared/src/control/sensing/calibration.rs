//! Biases of the sensors, found while nothing moves.

use super::sample::Sample;
use serde::{Deserialize, Serialize};

/// Biases that the estimators subtract.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// Gyroscope at rest, rad/s.
    pub gyroscope: f32,
    /// Block accelerometer at rest less (0, g), m/s².
    pub block: [f32; 2],
    /// Ground accelerometer at rest less (0, g), m/s².
    pub ground: [f32; 2],
    /// Count of the encoder at θ = 0.
    pub encoder_zero: i32,
}

impl Calibration {
    /// Goes a `share` of the way to what has been `found` now. `part` is what the encoder's zero is ahead of its whole number, in counts.
    pub fn follow(&mut self, found: &Calibration, share: f32, part: &mut f32) {
        let toward = |own: &mut f32, found: f32| *own += share * (found - *own);
        toward(&mut self.gyroscope, found.gyroscope);
        for (own, found) in self.block.iter_mut().zip(found.block).chain(self.ground.iter_mut().zip(found.ground)) {
            toward(own, found);
        }
        toward(part, found.encoder_zero.wrapping_sub(self.encoder_zero) as f32);
        let whole = *part as i32;
        self.encoder_zero = self.encoder_zero.wrapping_add(whole);
        *part -= whole as f32;
    }
}

/// The farther of an accelerometer's two readings from (0, g), its bias subtracted, m/s².
pub(in crate::control) fn off_gravity(reading: [f32; 2], bias: [f32; 2], gravity: f32) -> f32 {
    let [along, up] = [reading[0] - bias[0], reading[1] - bias[1] - gravity].map(f32::abs);
    if along > up { along } else { up }
}

/// Limits of a new bias.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plausible {
    /// Largest bias of the gyroscope, rad/s.
    pub gyroscope: f32,
    /// Of each axis of an accelerometer, m/s².
    pub accelerometer: f32,
}

/// The mean of a reading, as its mean difference from the first, summed with Kahan's compensation: an hour of ticks is more than f32 counts to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Mean {
    first: f32,
    sum: f32,
    /// By how much the sum is too large.
    excess: f32,
}

impl Mean {
    fn add(&mut self, ticks: u32, value: f32) {
        if ticks == 0 {
            *self = Mean { first: value, sum: 0.0, excess: 0.0 };
        } else {
            let news = value - self.first - self.excess;
            let sum = self.sum + news;
            self.excess = (sum - self.sum) - news;
            self.sum = sum;
        }
    }

    fn get(&self, ticks: u32) -> f32 {
        self.first + self.sum / ticks as f32
    }
}

/// A calibration under way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Averaging {
    ticks: u32,
    /// Good throughout, in the order of [`Sensor::ALL`](super::sensor::Sensor::ALL).
    good: [bool; 4],
    gyroscope: Mean,
    block: [Mean; 2],
    ground: [Mean; 2],
    encoder: Mean,
    encoder_first: i32,
}

impl Averaging {
    /// For how many ticks it has averaged.
    pub fn ticks(&self) -> u32 {
        self.ticks
    }

    /// Adds a sample of still sensors, of which `good` may be trusted.
    pub fn add(&mut self, sample: &Sample, good: [bool; 4]) {
        let ticks = self.ticks;
        if ticks == 0 {
            self.good = good;
            self.encoder_first = sample.encoder.counts;
        }
        self.good = [self.good[0] && good[0], self.good[1] && good[1], self.good[2] && good[2], self.good[3] && good[3]];
        self.gyroscope.add(ticks, sample.gyroscope.value);
        for (mean, reading) in self.block.iter_mut().zip(sample.block_accelerometer) {
            mean.add(ticks, reading.value);
        }
        for (mean, reading) in self.ground.iter_mut().zip(sample.ground_accelerometer) {
            mean.add(ticks, reading.value);
        }
        self.encoder.add(ticks, sample.encoder.counts.wrapping_sub(self.encoder_first) as f32);
        self.ticks = ticks.saturating_add(1);
    }

    /// What has been found, with `last` where a sensor was not good or its bias not plausible; and which were not plausible.
    pub fn finish(&self, last: &Calibration, plausible: &Plausible, gravity: f32) -> (Calibration, [bool; 4]) {
        if self.ticks == 0 {
            return (*last, [false; 4]);
        }
        let get = |mean: Mean| mean.get(self.ticks);
        let gyroscope = get(self.gyroscope);
        let [block, ground] = [self.block, self.ground].map(|[along, up]| [get(along), get(up) - gravity]);
        // Written so that NaN is not within.
        let small = |value: f32, limit: f32| value.abs() <= limit;
        let level = |bias: [f32; 2]| bias.iter().all(|value| small(*value, plausible.accelerometer));
        let fits = [small(gyroscope, plausible.gyroscope), level(block), level(ground), true];
        let taken = [self.good[0] && fits[0], self.good[1] && fits[1], self.good[2] && fits[2], self.good[3]];
        let half = |value: f32| if value < 0.0 { value - 0.5 } else { value + 0.5 };
        let found = Calibration {
            gyroscope: if taken[0] { gyroscope } else { last.gyroscope },
            block: if taken[1] { block } else { last.block },
            ground: if taken[2] { ground } else { last.ground },
            encoder_zero: if taken[3] {
                self.encoder_first.wrapping_add(half(get(self.encoder)) as i32)
            } else {
                last.encoder_zero
            },
        };
        let [gyroscope_good, block_good, ground_good, _] = self.good;
        (found, [gyroscope_good && !fits[0], block_good && !fits[1], ground_good && !fits[2], false])
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample::{Count, Reading};
    use super::*;

    const PLAUSIBLE: Plausible = Plausible { gyroscope: 0.2, accelerometer: 1.0 };
    const LAST: Calibration = Calibration { gyroscope: 7.0, block: [7.0; 2], ground: [7.0; 2], encoder_zero: 7 };

    fn sample(gyroscope: f32, block: [f32; 2], ground: [f32; 2], counts: i32) -> Sample {
        let of = |value| Reading { value, number: 1 };
        Sample {
            gyroscope: of(gyroscope),
            block_accelerometer: block.map(of),
            ground_accelerometer: ground.map(of),
            encoder: Count { counts, number: 1 },
            engaged: [false; 2],
        }
    }

    fn finished(samples: &[Sample], good: [bool; 4]) -> (Calibration, [bool; 4]) {
        let mut averaging = Averaging::default();
        for sample in samples {
            averaging.add(sample, good);
        }
        averaging.finish(&LAST, &PLAUSIBLE, 9.81)
    }

    #[test]
    fn biases_are_means() {
        let samples = [
            sample(0.02, [0.1, 9.91], [-0.2, 9.71], i32::MAX),
            sample(0.04, [0.3, 10.11], [-0.4, 9.51], i32::MIN + 1),
            sample(0.03, [0.2, 10.01], [-0.3, 9.61], i32::MIN),
        ];
        let (found, bad) = finished(&samples, [true; 4]);
        assert_eq!(bad, [false; 4]);
        let close = |value: f32, expected: f32| assert!((value - expected).abs() < 1e-5, "{value} {expected}");
        close(found.gyroscope, 0.03);
        close(found.block[0], 0.2);
        close(found.block[1], 0.2);
        close(found.ground[0], -0.3);
        close(found.ground[1], -0.2);
        assert_eq!(found.encoder_zero, i32::MIN);
    }

    #[test]
    fn a_long_mean_loses_nothing() {
        let mut averaging = Averaging::default();
        for tick in 0..120_000 {
            let noise = if tick % 2 == 0 { 0.01 } else { -0.01 };
            averaging.add(&sample(0.05 + noise, [0.1, 9.91 + noise], [0.0, 9.81], 0), [true; 4]);
        }
        let (found, _) = averaging.finish(&LAST, &PLAUSIBLE, 9.81);
        assert!((found.gyroscope - 0.05).abs() < 1e-5 && (found.block[1] - 0.1).abs() < 1e-5, "{found:?}");
    }

    #[test]
    fn the_longest_mean_loses_nothing() {
        // Beyond 2^24 ticks, from where on a bare sum of f32 stays where it is.
        let mut averaging = Averaging::default();
        averaging.add(&sample(0.0, [0.0, 9.81], [0.0, 9.81], 7), [true; 4]);
        for _ in 0..20_000_000 {
            averaging.add(&sample(0.05, [0.1, 9.91], [-0.1, 9.71], 10), [true; 4]);
        }
        let (found, bad) = averaging.finish(&LAST, &PLAUSIBLE, 9.81);
        assert_eq!((bad, found.encoder_zero), ([false; 4], 10));
        let close = |value: f32, expected: f32| assert!((value - expected).abs() < 2e-6, "{found:?}");
        close(found.gyroscope, 0.05);
        close(found.block[0], 0.1);
        close(found.block[1], 0.1);
        close(found.ground[0], -0.1);
        close(found.ground[1], -0.1);
    }

    #[test]
    fn what_is_not_plausible_or_not_good_is_not_taken() {
        let turning = sample(0.3, [0.0, 9.81], [f32::NAN, 9.81], 3);
        let (found, bad) = finished(&[turning; 3], [true; 4]);
        assert_eq!((found.gyroscope, found.block, found.ground, found.encoder_zero), (7.0, [0.0; 2], [7.0; 2], 3));
        assert_eq!(bad, [true, false, true, false]);
        let (found, bad) = finished(&[turning; 3], [false; 4]);
        assert_eq!((found, bad), (LAST, [false; 4]));
        assert_eq!(finished(&[], [true; 4]), (LAST, [false; 4]));
    }

    #[test]
    fn a_drift_is_followed_with_a_lag() {
        let (mut own, mut part) = (Calibration { encoder_zero: i32::MAX - 10, ..Calibration::default() }, 0.0);
        // 20 counts and 0.6 mrad/s in 3600 steps, of which 120 are the lag.
        for step in 0..=3600_i32 {
            let found = Calibration {
                gyroscope: step as f32 / 6e6,
                encoder_zero: (i32::MAX - 10).wrapping_add(step / 180),
                ..Calibration::default()
            };
            own.follow(&found, 1.0 / 120.0, &mut part);
        }
        assert!((own.gyroscope - 3481.0 / 6e6).abs() < 1e-7, "{own:?}");
        assert_eq!(own.encoder_zero, (i32::MAX - 10).wrapping_add(18));
        assert!(part.abs() < 1.0);
    }

    #[test]
    fn the_farther_axis_counts() {
        assert!((off_gravity([0.5, 9.81], [0.1, 0.0], 9.81) - 0.4).abs() < 1e-6);
        assert!((off_gravity([0.0, 9.0], [0.0; 2], 9.81) - 0.81).abs() < 1e-6);
    }
}
