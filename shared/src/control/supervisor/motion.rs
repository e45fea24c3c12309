//! Whether anything moves, by whichever sensors may be believed.

use crate::control::sensing::calibration::{Calibration, off_gravity};
use crate::control::sensing::sample::Sample;

/// Thresholds of motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MotionLimits {
    /// rad/s.
    pub rate: f32,
    /// m/s².
    pub shaking: f32,
    pub counts: u32,
    /// m/s².
    pub gravity: f32,
}

/// By how much of its distance the value near which a reading stays follows one that has left it, but not gone far. All the way, it would be
/// at the peak of the noise that moved it, from where the next peak on the other side is twice as far: a block at rest would seem to move
/// for minutes.
const FOLLOWED: f32 = 0.25;

fn follow(value: f32, reading: f32, limit: f32) -> f32 {
    let away = reading - value;
    if away.abs() > 2.0 * limit { reading } else { value + FOLLOWED * away }
}

/// Ticks without motion after which the count is taken anew from which the block would move, a power of two: what a rack creeps in that
/// time is no motion.
const CREEPING: u32 = 256;

/// A tick more; at its end the count goes on over its last [`CREEPING`] values, so that counts are taken anew no more often than before.
fn longer(still: u32) -> u32 {
    still.checked_add(1).unwrap_or(u32::MAX - (CREEPING - 1))
}

/// For how many ticks nothing has moved.
///
/// Two criteria, because a bias is not known before it has been measured: a reading that stays near one value is still, whatever the
/// value; and once calibrated, a rate or an acceleration is that of a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Motion {
    /// Readings of the block, and of the ground, have stayed where they were.
    pub block_still: u32,
    pub ground_still: u32,
    /// Neither moves, by calibrated readings.
    pub quiet: u32,
    rate: f32,
    ground: [f32; 2],
    counts: i32,
}

impl Motion {
    /// One tick of sensors of which `good` (in the order of `Sensor::ALL`) may be believed; `shaking` is how far the ground's accelerometer is
    /// from rest, m/s².
    #[inline]
    pub fn step(&mut self, limits: &MotionLimits, sample: &Sample, good: [bool; 4], shaking: f32, calibration: &Calibration) {
        if good == [true; 4] {
            self.step_of(limits, sample, [true; 4], shaking, calibration);
        } else {
            self.step_without(limits, sample, good, shaking, calibration);
        }
    }

    #[inline(never)]
    fn step_without(&mut self, limits: &MotionLimits, sample: &Sample, good: [bool; 4], shaking: f32, calibration: &Calibration) {
        self.step_of(limits, sample, good, shaking, calibration);
    }

    // Twice: most of the time every sensor is good, and nothing needs to be asked.
    #[inline(always)]
    fn step_of(&mut self, limits: &MotionLimits, sample: &Sample, good: [bool; 4], shaking: f32, calibration: &Calibration) {
        let [gyroscope, _, ground, encoder] = good;
        let rate = sample.gyroscope.value;
        // Without a witness nobody knows that the block is still; a ground that nobody watches is no reason to wait.
        let mut block_still = if gyroscope || encoder { longer(self.block_still) } else { 0 };
        if gyroscope && (rate - self.rate).abs() > limits.rate {
            self.rate = follow(self.rate, rate, limits.rate);
            block_still = 0;
        }
        let counts = sample.encoder.counts;
        let travelled = encoder && counts.wrapping_sub(self.counts).unsigned_abs() > limits.counts;
        if travelled || (encoder && self.block_still % CREEPING == CREEPING - 1) {
            self.counts = counts;
            if travelled {
                block_still = 0;
            }
        }
        self.block_still = block_still;
        let force = sample.ground_accelerometer.map(|reading| reading.value);
        // The last place is off by (0, g) from what the function takes for rest, which is subtracted as a bias.
        let mut ground_still = self.ground_still.saturating_add(1);
        if ground && off_gravity(force, self.ground, 0.0) > limits.shaking {
            let ([along, up], [along_now, up_now]) = (self.ground, force);
            self.ground = [follow(along, along_now, limits.shaking), follow(up, up_now, limits.shaking)];
            ground_still = 0;
        }
        self.ground_still = ground_still;
        let rocks = travelled || (gyroscope && (rate - calibration.gyroscope).abs() > limits.rate);
        let shakes = ground && shaking > limits.shaking;
        self.quiet = if rocks || shakes { 0 } else { self.quiet.saturating_add(1) };
    }

    /// Block and ground have been still for so many ticks.
    pub fn still(&self, ticks: u32) -> bool {
        self.block_still >= ticks && self.ground_still >= ticks
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::sensing::sample::{Count, Reading};

    const LIMITS: MotionLimits = MotionLimits { rate: 0.02, shaking: 0.3, counts: 2, gravity: 9.81 };

    fn sample(rate: f32, ground: f32, counts: i32) -> Sample {
        let of = |value| Reading { value, number: 1 };
        Sample {
            gyroscope: of(rate),
            ground_accelerometer: [of(ground), of(9.81)],
            encoder: Count { counts, number: 1 },
            ..Sample::default()
        }
    }

    fn step(motion: &mut Motion, sample: &Sample, good: [bool; 4]) {
        let force = sample.ground_accelerometer.map(|reading| reading.value);
        motion.step(&LIMITS, sample, good, off_gravity(force, [0.0; 2], LIMITS.gravity), &Calibration::default());
    }

    fn run(motion: &mut Motion, sample: Sample, good: [bool; 4]) {
        for _ in 0..10 {
            step(motion, &sample, good);
        }
    }

    #[test]
    fn a_bias_is_still_but_not_quiet() {
        let mut motion = Motion::default();
        run(&mut motion, sample(0.1, 0.0, 5), [true; 4]);
        assert_eq!((motion.block_still, motion.ground_still, motion.quiet), (9, 9, 0));
        run(&mut motion, sample(0.11, 0.1, 6), [true; 4]);
        assert_eq!((motion.block_still, motion.ground_still), (19, 19));
        run(&mut motion, sample(0.0, 0.1, 6), [true; 4]);
        assert_eq!((motion.block_still, motion.ground_still, motion.quiet), (9, 29, 10));
    }

    #[test]
    fn each_witness_alone() {
        let mut motion = Motion::default();
        run(&mut motion, sample(0.0, 0.0, i32::MAX), [true; 4]);
        run(&mut motion, sample(0.0, 0.0, i32::MIN + 1), [true; 4]);
        assert_eq!(motion.block_still, 19, "a wrap of two counts is no motion");
        run(&mut motion, sample(0.0, 0.0, i32::MIN + 2), [true; 4]);
        assert_eq!((motion.block_still, motion.ground_still, motion.quiet), (9, 29, 9));
        run(&mut motion, sample(0.0, 0.7, i32::MIN + 2), [true; 4]);
        assert_eq!((motion.block_still, motion.ground_still, motion.quiet), (19, 9, 0));
        run(&mut motion, sample(9.0, 9.0, 9), [false; 4]);
        assert_eq!((motion.block_still, motion.ground_still, motion.quiet), (0, 19, 10));
        run(&mut motion, sample(9.0, f32::NAN, i32::MIN + 2), [false, false, false, true]);
        assert_eq!((motion.block_still, motion.quiet), (10, 20));
        assert!(motion.still(10) && !motion.still(11));
    }

    /// A count that goes to and fro by one while it creeps by a hundred in two minutes: a tenth of a millimetre at 1 µm a count.
    #[test]
    fn a_rack_that_creeps_does_not_move() {
        let mut motion = Motion::default();
        for tick in 0..240_000 {
            let counts = tick / 2400 + tick % 2;
            step(&mut motion, &sample(0.0, 0.0, counts), [true; 4]);
            assert!(tick < 10 || motion.quiet >= 10, "{tick}");
        }
    }

    /// Noise whose peaks are what the limits are made for, about a bias: sooner or later a value in its midst is found.
    #[test]
    fn a_block_at_rest_is_still_whatever_peak_began_it() {
        for first in [-1.0, -0.7, 0.0, 0.9, 1.0] {
            let (mut motion, mut random) = (Motion::default(), 7_u64);
            // Nearly normal, as a sum of twelve, with a sixth of the limit as its standard deviation. Knuth's MMIX generator.
            let mut noise = || {
                let shares = (0..12).map(|_| {
                    random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    (random >> 40) as f32 / 16_777_216.0
                });
                (shares.sum::<f32>() - 6.0) / 6.0
            };
            run(&mut motion, sample(0.1 + first * LIMITS.rate, 0.2 + first * LIMITS.shaking, 0), [true; 4]);
            let mut longest = (0, 0);
            for _ in 0..20_000 {
                let now = sample(0.1 + LIMITS.rate * noise(), 0.2 + LIMITS.shaking * noise(), 0);
                step(&mut motion, &now, [true; 4]);
                longest = (longest.0.max(motion.block_still), longest.1.max(motion.ground_still));
            }
            assert!(longest.0 > 15_000 && longest.1 > 15_000, "{first}: {longest:?}");
        }
    }
}
