//! The part's own self-test: electrodes push its masses, and each axis must answer as it did in the factory.
//!
//! DS-000347 rev. 1.7, "Self-test": the response of an axis is its reading with the test on less its reading with the test off. The factory
//! has left a code c of what it was, which stands for 2620 / 2^(3 − FS_SEL) · 1.01^(c − 1) counts, where FS_SEL is that of the range in
//! use; the maker's own driver takes from half of that on for passed, and has the waiting times below.
//!
//! It is done in the range in which the part is read afterwards, so that one whose range is another answers with half or twice as much.

use super::Reading;
use super::registers::{ACCELEROMETER_RANGE, GYROSCOPE_RANGE, TEST_ACCELEROMETER, TEST_GYROSCOPE};

/// From the sensors' being switched on to readings that have settled, s.
const SETTLING: f32 = 0.06;
/// From the gyroscope's test on to a steady response, s.
const GYROSCOPE_SETTLING: f32 = 0.2;
/// The same of the accelerometer's, s.
const ACCELEROMETER_SETTLING: f32 = 0.025;

/// What a test with two starts of the gyroscope (30 ms each) takes without the ticks of [`TICKS`], s.
const TIME: f32 = SETTLING + GYROSCOPE_SETTLING + ACCELEROMETER_SETTLING + 2.0 * 0.03;
/// Ticks of two resets, two configurations, three averages and the steps between, rounded up.
const TICKS: f32 = 200.0;

/// For how long the part gives no readings to its user while it is tested, s, with a tick every `period` s.
pub fn duration(period: f32) -> f32 {
    TIME + TICKS * period
}

/// Readings of an average: those of the accelerometer have a noise of 2 mg, of the gyroscope 0.08 °/s.
const AVERAGED: u8 = 32;

/// Ticks without a reading, or waited for the first, after which the test is given up: 0.2 s at 10 kHz.
const PATIENCE: u16 = 2000;

/// What the readings of an average may lie apart where nothing moves, counts: 0.1 g and 5 °/s.
const STILL_ACCELERATION: i32 = 410;
const STILL_RATE: i32 = 328;

/// Shares of what the factory has found that an answer lies between.
const PASSED: [f32; 2] = [0.5, 1.5];

/// Where the factory has left no code (0), what a response lies between, counts: 60 °/s to full scale, 50 mg to 1.2 g.
const ANY_RATE: [f32; 2] = [60.0 * 65.5, 32_768.0];
const ANY_ACCELERATION: [f32; 2] = [0.05 * 4096.0, 1.2 * 4096.0];

/// What a test has come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Every axis answered.
    Passed,
    /// An axis of these did not.
    Failed {
        /// Of the gyroscope.
        gyroscope: bool,
        /// Of the accelerometer.
        accelerometer: bool,
    },
    /// It moved meanwhile, or readings were missing: nothing is known.
    Undecided,
}

/// What a step asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// The next reading.
    Read,
    /// These bits of SELF_TEST_CONFIG.
    Excite(u8),
    /// The factory's codes, for [`SelfTest::judge`].
    ReadCodes,
    /// Nothing more.
    End,
}

/// What is being done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    Settle,
    Rest,
    GyroscopeSettles,
    Gyroscope,
    AccelerometerSettles,
    Accelerometer,
}

/// A test under way.
#[derive(Clone, Copy, Debug)]
pub struct SelfTest {
    step: Step,
    /// Ticks of the three times of settling.
    settling: [u16; 3],
    /// Ticks of this step so far, and those without a reading.
    ticks: u16,
    silent: u16,
    window: Window,
    /// Sums of [`AVERAGED`] readings at rest, and of each axis while its sensor is tested: acceleration, rate.
    rest: [i32; 6],
    tested: [i32; 6],
}

/// An average and how far its readings lie apart: acceleration, rate.
#[derive(Clone, Copy, Debug, Default)]
struct Window {
    count: u8,
    sums: [i32; 6],
    least: [i16; 6],
    most: [i16; 6],
}

impl Window {
    /// Adds a reading; whether there are enough.
    fn add(&mut self, reading: &Reading) -> bool {
        let [[a, b, c], [d, e, f]] = [reading.acceleration, reading.rate];
        let values = [a, b, c, d, e, f];
        if self.count == 0 {
            (self.least, self.most) = (values, values);
        }
        for (value, ((sum, least), most)) in values.into_iter().zip(self.sums.iter_mut().zip(&mut self.least).zip(&mut self.most))
        {
            *sum += i32::from(value);
            *least = value.min(*least);
            *most = value.max(*most);
        }
        self.count += 1;
        self.count >= AVERAGED
    }

    /// Whether nothing has moved, by the accelerometer, and by the gyroscope where it is not `excited`.
    fn is_still(&self, excited: bool) -> bool {
        let limits = [STILL_ACCELERATION, if excited { i32::MAX } else { STILL_RATE }];
        let apart = self.least.iter().zip(self.most).map(|(least, most)| i32::from(most) - i32::from(*least));
        apart.zip(limits.into_iter().flat_map(|limit| [limit; 3])).all(|(apart, limit)| apart <= limit)
    }
}

impl SelfTest {
    /// Of a part that is configured and whose sensors have just been switched on, with a tick every `period` s.
    pub fn new(period: f32) -> SelfTest {
        let settling = [SETTLING, GYROSCOPE_SETTLING, ACCELEROMETER_SETTLING].map(|time| (time / period) as u16 + 1);
        SelfTest { step: Step::Settle, settling, ticks: 0, silent: 0, window: Window::default(), rest: [0; 6], tested: [0; 6] }
    }

    /// Whether the part is being pushed, so that its configuration must be written anew.
    pub fn has_excited(&self) -> bool {
        !matches!(self.step, Step::Settle | Step::Rest)
    }

    /// A tick with its reading, if there was a new one.
    #[inline(never)]
    pub fn step(&mut self, reading: Option<Reading>) -> Order {
        let [at_first, gyroscope, accelerometer] = self.settling;
        let Some(reading) = reading else {
            self.silent += 1;
            return if self.silent < PATIENCE { Order::Read } else { Order::End };
        };
        self.ticks += 1;
        match self.step {
            Step::Settle => self.wait(at_first, Step::Rest),
            Step::GyroscopeSettles => self.wait(gyroscope, Step::Gyroscope),
            Step::AccelerometerSettles => self.wait(accelerometer, Step::Accelerometer),
            Step::Rest | Step::Gyroscope | Step::Accelerometer => self.average(&reading),
        }
    }

    fn wait(&mut self, ticks: u16, next: Step) -> Order {
        if self.ticks >= ticks {
            self.enter(next);
        }
        Order::Read
    }

    fn enter(&mut self, step: Step) {
        (self.step, self.ticks, self.silent, self.window) = (step, 0, 0, Window::default());
    }

    fn average(&mut self, reading: &Reading) -> Order {
        if !self.window.add(reading) {
            return Order::Read;
        }
        if !self.window.is_still(self.step != Step::Rest) {
            return Order::End;
        }
        let sums = self.window.sums;
        match self.step {
            Step::Rest => {
                self.rest = sums;
                self.enter(Step::GyroscopeSettles);
                Order::Excite(TEST_GYROSCOPE)
            }
            Step::Gyroscope => {
                self.tested = sums;
                self.enter(Step::AccelerometerSettles);
                Order::Excite(TEST_ACCELEROMETER)
            }
            _ => {
                // What the gyroscope has answered stays.
                for (tested, sum) in self.tested.iter_mut().zip(sums).take(3) {
                    *tested = sum;
                }
                Order::ReadCodes
            }
        }
    }

    /// What it comes to with the factory's codes of accelerometer and gyroscope.
    #[inline(never)]
    pub fn judge(&self, codes: [u8; 6]) -> Verdict {
        let (mut gyroscope, mut accelerometer) = (false, false);
        for (axis, ((rest, tested), code)) in self.rest.iter().zip(self.tested).zip(codes).enumerate() {
            let response = (tested - rest).unsigned_abs() as f32 / f32::from(AVERAGED);
            if axis < 3 {
                accelerometer |= !answers(response, code, ACCELEROMETER_RANGE, ANY_ACCELERATION);
            } else {
                gyroscope |= !answers(response, code, GYROSCOPE_RANGE, ANY_RATE);
            }
        }
        if gyroscope || accelerometer { Verdict::Failed { gyroscope, accelerometer } } else { Verdict::Passed }
    }
}

/// Whether a response, in counts of the `range` of this FS_SEL, is what the factory's code stands for, or without a code is among `any`.
#[inline(never)]
fn answers(response: f32, code: u8, range: u8, any: [f32; 2]) -> bool {
    let [least, most] = if code == 0 { any } else { PASSED.map(|share| share * expected(range, code)) };
    response > least && response < most
}

/// Counts for which a code (from 1 on) of the factory's stands in the `range` of this FS_SEL.
fn expected(range: u8, code: u8) -> f32 {
    let first = 2620.0 / f32::from(1_u8 << (3 - range));
    (1..code).fold(first, |counts, _| counts * 1.01)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the formula, in double precision, with logarithms.
    #[test]
    fn codes_stand_for_what_the_maker_says() {
        for (range, code, counts) in [(3, 1, 2620.0), (2, 1, 1310.0), (1, 101, 655.0 * 2.704_813_8), (2, 255, 1310.0 * 12.520_4)]
        {
            let found = expected(range, code);
            assert!((found / counts - 1.0_f32).abs() < 1e-4, "{range} {code}: {found}");
        }
    }

    #[test]
    fn readings_far_apart_are_no_rest() {
        let at = |acceleration: i16, rate: i16| Reading { acceleration: [acceleration, 0, 4096], rate: [0, 0, rate] };
        for (readings, at_rest, excited) in [
            ([at(10, 5), at(-10, -5)], true, true),
            ([at(300, 5), at(-300, -5)], false, false),
            ([at(10, 300), at(-10, -300)], false, true),
            ([at(10, 32_000), at(-10, -32_000)], false, true),
            ([at(32_000, 0), at(-32_000, 0)], false, false),
        ] {
            let mut window = Window::default();
            readings.iter().for_each(|reading| _ = window.add(reading));
            assert_eq!((window.is_still(false), window.is_still(true)), (at_rest, excited), "{readings:?}");
        }
    }
}
