//! From readings to what estimators need: biases taken off, units of the equations, and the ground's acceleration tracked.

use super::calibration::Calibration;
use super::sample::Sample;
use crate::math;
use crate::structure::block::GRAVITY;
use crate::structure::error::{ParameterError, require};

/// g, m/s².
const STANDARD_GRAVITY: f32 = GRAVITY as f32;

/// How the sensors are mounted and how late their readings are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instruments {
    /// Period of the control tick, s.
    pub period: f32,
    /// Travel of the rack over R in one count of the encoder.
    pub travel_per_count: f32,
    /// From the motion to the reading, s, of the gyroscope, …
    pub gyroscope_delay: f32,
    /// … the encoder, …
    pub encoder_delay: f32,
    /// … and the ground accelerometer.
    pub ground_delay: f32,
    /// Tracking of the ground's acceleration: gain of the value and gain of its growth over the period.
    pub(crate) gains: [f32; 2],
    /// 1 over `period`.
    pub(crate) period_inverse: f32,
    /// Where the block's accelerometer is, from its centre of mass, in its axes (along, up), m. [`Instruments::new`] has it there.
    pub block_position: [f32; 2],
}

/// Largest growth of the ground's acceleration that is extrapolated, g/s: a record of 1 g with 20 Hz in it. What grows faster is a
/// jump, which does not continue.
const FASTEST_GROWTH: f32 = 120.0;

/// Largest growth that is tracked, g/s: far beyond any sensor.
const MOST_GROWTH: f32 = 1e6;

/// Where the sizes of several readings sum up to less, all of them are [`usable`], with biases (at most a few m/s²) and without.
const PLAIN: f32 = 5e5;

/// Largest acceleration of the ground that is tracked, g: beyond any accelerometer's range.
const MOST_GROUND: f32 = 1e3;

impl Instruments {
    /// With a `period` (s) of 1e-6 to 0.1 s, encoder counts of `travel_per_count` (over R), delays in s (gyroscope, encoder, ground
    /// accelerometer) of 0 to 0.1 s, and the ground's acceleration tracked by a critically damped filter with a time constant of
    /// `tracking` (s), 0 or more; 0 takes every reading as it is.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn new(period: f64, travel_per_count: f64, delays: [f64; 3], tracking: f64) -> Result<Instruments, ParameterError> {
        require("period", period, (1e-6..=0.1).contains(&period), "from 1e-6 to 0.1 s")?;
        require("travel_per_count", travel_per_count, travel_per_count > 0.0, "above 0")?;
        for (name, delay) in ["gyroscope_delay", "encoder_delay", "ground_delay"].into_iter().zip(delays) {
            require(name, delay, (0.0..=0.1).contains(&delay), "from 0 to 0.1 s")?;
        }
        require("tracking", tracking, (0.0..=1.0).contains(&tracking), "from 0 to 1 s")?;
        // Fading-memory filter of first degree (Morrison 1969): poles both at e^(-T/τ).
        let pole = if tracking > 0.0 { math::exp(-period / tracking) } else { 0.0 };
        let gains = [(1.0 - pole * pole) as f32, ((1.0 - pole) * (1.0 - pole)) as f32];
        Ok(Instruments::of_gains(period as f32, travel_per_count as f32, delays.map(|delay| delay as f32), gains))
    }

    /// As [`Instruments::new`], in single precision and with the `gains` of the tracking, each 0 to 1; to the same bits wherever it is
    /// made.
    pub fn of_gains(period: f32, travel_per_count: f32, delays: [f32; 3], gains: [f32; 2]) -> Instruments {
        let [gyroscope_delay, encoder_delay, ground_delay] = delays;
        Instruments {
            period,
            travel_per_count,
            gyroscope_delay,
            encoder_delay,
            ground_delay,
            gains,
            period_inverse: 1.0 / period,
            block_position: [0.0; 2],
        }
    }

    /// The readings of one tick; what has not been read anew since the last tick is marked so.
    // Into the tick: what it gives need not go through memory then.
    #[inline(always)]
    pub fn read(&self, state: &mut InstrumentsState, sample: &Sample, zero: &Calibration) -> Measured {
        let ([along, up], [horizontal, vertical]) = (sample.block_accelerometer, sample.ground_accelerometer);
        let [a, b, c, d] = state.numbers;
        let all = sample.gyroscope.number != a && sample.encoder.number != b && along.number != c && horizontal.number != d;
        let sizes = [sample.gyroscope, along, up, horizontal, vertical].map(|reading| reading.value.abs());
        if all && sizes.iter().fold(0.0, |sum, size| sum + size) < PLAIN {
            state.numbers = numbers(sample);
            return self.measure(state, sample, zero, [true; 4], |_| true);
        }
        self.measure_some(state, sample, zero)
    }

    /// The same where it is done rarely.
    #[inline(never)]
    pub fn read_apart(&self, state: &mut InstrumentsState, sample: &Sample, zero: &Calibration) -> Measured {
        self.read(state, sample, zero)
    }

    #[inline(never)]
    fn measure_some(&self, state: &mut InstrumentsState, sample: &Sample, zero: &Calibration) -> Measured {
        let now = numbers(sample);
        let last = core::mem::replace(&mut state.numbers, now);
        let fresh = [now[0] != last[0], now[1] != last[1], now[2] != last[2], now[3] != last[3]];
        self.measure(state, sample, zero, fresh, usable)
    }

    /// Of `fresh` readings, those that are `usable`.
    #[inline(always)]
    fn measure(
        &self,
        state: &mut InstrumentsState,
        sample: &Sample,
        zero: &Calibration,
        fresh: [bool; 4],
        usable: impl Fn(f32) -> bool,
    ) -> Measured {
        let block = [0, 1].map(|axis: usize| sample.block_accelerometer[axis & 1].value - zero.block[axis & 1]);
        let force = [0, 1].map(|axis: usize| sample.ground_accelerometer[axis & 1].value - zero.ground[axis & 1]);
        let accelerations = [force[0] / STANDARD_GRAVITY, force[1] / STANDARD_GRAVITY - 1.0];
        let (mut ground, mut growth) = ([0.0; 2], [0.0; 2]);
        for axis in 0..2 {
            let track = &mut state.ground[axis];
            growth[axis] = self.track(track, accelerations[axis], fresh[3] && usable(accelerations[axis]));
            ground[axis] = track.value + growth[axis] * self.ground_delay;
        }
        Measured {
            rate: (fresh[0] && usable(sample.gyroscope.value)).then_some(sample.gyroscope.value - zero.gyroscope),
            travel: fresh[1].then(|| sample.encoder.counts.wrapping_sub(zero.encoder_zero) as f32 * self.travel_per_count),
            block: (fresh[2] && usable(block[0]) && usable(block[1]) && usable(force[0])).then_some(block),
            ground_force: force,
            ground,
            ground_rate: growth[0],
            engaged: sample.engaged,
        }
    }

    /// One tick of a `reading`; its growth as far as it is extrapolated.
    #[inline(always)]
    fn track(&self, track: &mut Track, reading: f32, fresh: bool) -> f32 {
        let ahead = track.value + track.rate * self.period;
        if track.started && fresh {
            let surprise = reading - ahead;
            track.value = within(ahead + self.gains[0] * surprise, MOST_GROUND);
            let rate = track.rate + self.gains[1] * surprise * self.period_inverse;
            // What is slow enough to be extrapolated is slow enough to be tracked.
            if rate.abs() <= FASTEST_GROWTH {
                track.rate = rate;
                return rate;
            }
            track.rate = within(rate, MOST_GROWTH);
        } else if track.started {
            track.value = within(ahead, MOST_GROUND);
        } else {
            let value = if fresh { reading } else { 0.0 };
            *track = Track { value, rate: 0.0, started: fresh };
        }
        beyond(track.rate, FASTEST_GROWTH)
    }
}

/// Of readings, in the order of [`InstrumentsState::numbers`].
#[inline]
fn numbers(sample: &Sample) -> [u32; 4] {
    let ([along, _], [horizontal, _]) = (sample.block_accelerometer, sample.ground_accelerometer);
    [sample.gyroscope.number, sample.encoder.number, along.number, horizontal.number]
}

/// As `x.clamp(-most, most)`, with one comparison for what is within.
#[inline]
fn within(x: f32, most: f32) -> f32 {
    if x.abs() <= most { x } else { beyond(x, most) }
}

#[cold]
#[inline(never)]
fn beyond(x: f32, most: f32) -> f32 {
    if x > most {
        most
    } else if x < -most {
        -most
    } else {
        x
    }
}

/// A number that a sensor can have read; the supervisor says what is wrong with another.
#[inline]
fn usable(reading: f32) -> bool {
    reading.abs() < 1e6
}

/// A value and its growth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Track {
    value: f32,
    rate: f32,
    started: bool,
}

/// State of the readings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InstrumentsState {
    /// Of the last readings of gyroscope, encoder, and both accelerometers.
    numbers: [u32; 4],
    ground: [Track; 2],
}

impl InstrumentsState {
    /// Number of the ground accelerometer's last reading.
    pub fn ground_number(&self) -> u32 {
        self.numbers[3]
    }
}

/// One tick's readings, without their biases; `None` is no new reading.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Rate of the gyroscope, rad/s.
    pub rate: Option<f32>,
    /// Travel of the rack, over R.
    pub travel: Option<f32>,
    /// Specific force on the block in its own axes, m/s².
    pub block: Option<[f32; 2]>,
    /// Specific force on the ground as last read, m/s².
    pub ground_force: [f32; 2],
    /// Acceleration of the ground in g, horizontal and vertical, tracked to this instant.
    pub ground: [f32; 2],
    /// Growth of the horizontal one, 1/s.
    pub ground_rate: f32,
    /// What each clutch reports of itself: engaged.
    pub engaged: [bool; 2],
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::sensing::sample::Reading;

    fn sample(k: u32, ground: f32) -> Sample {
        let reading = |value| Reading { value, number: k };
        Sample {
            gyroscope: reading(0.1),
            ground_accelerometer: [reading(ground * STANDARD_GRAVITY), reading(STANDARD_GRAVITY)],
            ..Sample::default()
        }
    }

    #[test]
    fn a_ramp_is_tracked_without_lag_and_carried_over_the_delay() {
        let instruments = Instruments::new(5e-4, 1e-6, [0.0, 0.0, 2e-3], 2e-3).unwrap();
        let mut state = InstrumentsState::default();
        for k in 1..400 {
            let time = k as f32 * 5e-4;
            // The reading is 2 ms old.
            let seen = instruments.read(&mut state, &sample(k, 3.0 * (time - 2e-3)), &Calibration::default());
            if k > 100 {
                assert!((seen.ground[0] - 3.0 * time).abs() < 1e-4, "{} at {time}", seen.ground[0]);
                assert!((seen.ground_rate - 3.0).abs() < 0.02);
                assert!(seen.ground[1].abs() < 1e-6);
            }
        }
    }

    #[test]
    fn without_tracking_a_reading_is_taken_as_it_is() {
        let instruments = Instruments::new(5e-4, 1e-6, [0.0; 3], 0.0).unwrap();
        let mut state = InstrumentsState::default();
        for (k, value) in [(1, 0.3), (2, -0.7), (3, 0.1)] {
            let seen = instruments.read(&mut state, &sample(k, value), &Calibration::default());
            assert!((seen.ground[0] - value).abs() < 1e-6);
        }
    }

    #[test]
    fn a_slower_sensor_is_carried_on_and_garbage_is_no_reading() {
        let instruments = Instruments::new(5e-4, 1e-6, [0.0; 3], 2e-3).unwrap();
        let mut state = InstrumentsState::default();
        for k in 1..800_u32 {
            let time = (k / 2 * 2) as f32 * 5e-4;
            let mut now = sample(k / 2 + 1, 3.0 * time);
            if k % 100 == 50 {
                now.ground_accelerometer[0].value = f32::NAN;
                now.gyroscope.value = f32::INFINITY;
            }
            let seen = instruments.read(&mut state, &now, &Calibration::default());
            assert!(seen.rate.is_none_or(f32::is_finite));
            if k > 200 {
                assert!((seen.ground[0] - 3.0 * k as f32 * 5e-4).abs() < 5e-3, "{} at {k}", seen.ground[0]);
            }
        }
    }

    #[test]
    fn the_same_number_is_no_new_reading_and_counts_wrap() {
        let instruments = Instruments::new(5e-4, 0.5, [0.0; 3], 0.0).unwrap();
        let mut state = InstrumentsState::default();
        let mut now = sample(1, 0.0);
        now.encoder.counts = i32::MIN + 1;
        now.encoder.number = 1;
        let zero = Calibration { encoder_zero: i32::MAX, gyroscope: 0.02, ..Calibration::default() };
        let seen = instruments.read(&mut state, &now, &zero);
        assert_eq!(seen.travel, Some(1.0));
        assert!((seen.rate.unwrap() - 0.08).abs() < 1e-7);
        let again = instruments.read(&mut state, &now, &zero);
        assert_eq!((again.rate, again.travel, again.block), (None, None, None));
    }
}
