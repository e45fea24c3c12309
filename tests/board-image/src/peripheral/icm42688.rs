//! TDK InvenSense ICM-42688-P as seen from its bus (DS-000347 rev. 1.7): banks, reset, start-up times, data-ready, self-test, temperature.

use crate::time::{microseconds, milliseconds};

const BANK: u8 = 0x76;
const DEVICE_CONFIG: u8 = 0x11;
const TEMPERATURE: u8 = 0x1D;
const LAST_OF_TEMPERATURE: u8 = 0x1E;
const FIRST_DATA: u8 = 0x1F;
const STATUS: u8 = 0x2D;
const POWER: u8 = 0x4E;
const GYROSCOPE_CONFIG: u8 = 0x4F;
const ACCELEROMETER_CONFIG: u8 = 0x50;
const SELF_TEST: u8 = 0x70;
const IDENTITY: u8 = 0x75;
/// ZG_ST_DATA of bank 1, the last of the factory's codes.
const LAST_CODE: u8 = 0x61;

const DATA_READY: u8 = 1 << 3;
const RESET_DONE: u8 = 1 << 4;

/// After its reset the part does not answer for 1 ms (section 14.1, DEVICE_CONFIG).
const RESET_TIME: u64 = milliseconds(1);
/// No register may be written for 200 µs after the sensors are switched on (section 14.36, PWR_MGMT0).
const SETTLING: u64 = microseconds(200);

/// From a change of SELF_TEST_CONFIG to a response that is steady: of the accelerometer, and of the gyroscope, for which the maker's driver
/// waits 25 ms and 200 ms.
const RESPONSE: [u64; 2] = [milliseconds(20), milliseconds(180)];

/// What the factory has left in banks 2 and 1 of the response of accelerometer and gyroscope.
const CODES: [[u8; 3]; 2] = [[33, 43, 148], [105, 98, 120]];

/// Counts that a code stands for at ±2 g and ±250 °/s (FS_SEL 3), by the maker's formula.
fn response(code: u8) -> f64 {
    2620.0 * 1.01_f64.powi(i32::from(code) - 1)
}

/// What the part measures, in its counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Measured {
    /// x, y, z, as for ±8 g: 4096 a g.
    pub acceleration: [i16; 3],
    /// x, y, z, as for ±500 °/s: 65.5 a °/s.
    pub rate: [i16; 3],
}

/// The part.
#[derive(Clone, Debug)]
pub struct Icm42688 {
    /// What there is to be measured.
    pub measured: Measured,
    /// From this to valid data: the gyroscope's start (table 1: 30 ms).
    pub gyroscope_start: u64,
    /// Likewise of the accelerometer (table 2: 10 ms from sleep).
    pub accelerometer_start: u64,
    /// Share of what the factory has found by which each axis answers in a self-test: those of the accelerometer, of the gyroscope.
    pub answers: [[f64; 3]; 2],
    /// °C.
    pub temperature: f64,
    /// What the factory has left has been read to the end, as at the end of a self-test: what was delivered before was not for the
    /// controller.
    pub judged: bool,
    /// Self-tests, by the times that the gyroscope's was switched on.
    pub tests: u32,
    /// Resets asked for over the bus.
    pub resets: u32,
    /// Stores that the data sheet forbids, and which it does not say the outcome of.
    pub forbidden: u32,
    /// What the last burst got that had the data-ready bit, until it is taken.
    pub delivered: Option<Measured>,
    selected: bool,
    bytes: usize,
    address: u8,
    banks: [[u8; 128]; 5],
    bank: u8,
    silent_until: u64,
    gyroscope_from: Option<u64>,
    accelerometer_from: Option<u64>,
    /// Of the reading that the status has been read of.
    seen: u64,
    latched: Measured,
    reset_done: bool,
    /// Since when SELF_TEST_CONFIG is as it is.
    tested: u64,
}

impl Icm42688 {
    /// With its supply just there.
    pub fn new() -> Icm42688 {
        Icm42688 {
            measured: Measured { acceleration: [0, 0, 4096], rate: [0; 3] },
            gyroscope_start: milliseconds(30),
            accelerometer_start: milliseconds(10),
            answers: [[1.0; 3]; 2],
            temperature: 25.0,
            judged: false,
            tests: 0,
            resets: 0,
            forbidden: 0,
            delivered: None,
            selected: false,
            bytes: 0,
            address: 0,
            banks: Icm42688::defaults(),
            bank: 0,
            silent_until: 0,
            gyroscope_from: None,
            accelerometer_from: None,
            seen: 0,
            latched: Measured::default(),
            reset_done: true,
            tested: 0,
        }
    }

    fn defaults() -> [[u8; 128]; 5] {
        let mut banks = [[0; 128]; 5];
        for (register, value) in [
            (0x13, 0x01),
            (0x4C, 0x30),
            (0x4D, 0x91),
            (0x4F, 0x06),
            (0x50, 0x06),
            (0x51, 0x16),
            (0x52, 0x11),
            (0x53, 0x0D),
            (0x65, 0x10),
        ] {
            banks[0][register] = value;
        }
        banks[2][0x3B..0x3E].copy_from_slice(&CODES[0]);
        banks[1][0x5F..0x62].copy_from_slice(&CODES[1]);
        banks
    }

    /// Loses its supply and gets it again: all that was written to it is gone.
    pub fn brown_out(&mut self, now: u64) {
        self.forget(now);
    }

    fn forget(&mut self, now: u64) {
        (self.banks, self.bank) = (Icm42688::defaults(), 0);
        (self.gyroscope_from, self.accelerometer_from) = (None, None);
        self.silent_until = now + RESET_TIME;
        self.reset_done = true;
    }

    /// Whether both sensors run.
    pub fn runs(&self, now: u64) -> bool {
        [self.gyroscope_from, self.accelerometer_from].iter().all(|from| from.is_some_and(|from| now >= from))
    }

    /// What was written to a register.
    pub fn register(&self, bank: u8, register: u8) -> u8 {
        self.banks[usize::from(bank)][usize::from(register)]
    }

    /// The select line.
    pub fn select(&mut self, low: bool) {
        if low && !self.selected {
            self.bytes = 0;
        }
        self.selected = low;
    }

    /// A byte each way.
    pub fn exchange(&mut self, byte: u8, now: u64) -> u8 {
        if !self.selected || now < self.silent_until {
            return 0;
        }
        let place = self.bytes;
        self.bytes += 1;
        if place == 0 {
            self.address = byte;
            self.latch(now);
            return 0;
        }
        let register = (self.address & 0x7F).wrapping_add(place as u8 - 1) & 0x7F;
        if self.address & 0x80 != 0 {
            return self.read(register, now);
        }
        self.write(register, byte, now);
        0
    }

    /// Keeps a reading whole while it is read.
    fn latch(&mut self, now: u64) {
        let up = |from: Option<u64>| from.is_some_and(|from| now >= from);
        // Full scale halves with each step of the registers' upper three bits; counts are given for ±500 °/s and ±8 g.
        let range = |register: u8| i32::from(self.banks[0][usize::from(register)] >> 5);
        let scale = |counts: [i16; 3], sensor: usize, register: u8, nominal: i32| {
            std::array::from_fn(|axis| {
                let pushed = self.pushed(sensor, axis, now) * 2_f64.powi(range(register) - 3);
                (f64::from(counts[axis]) * 2_f64.powi(range(register) - nominal) + pushed).round() as i16
            })
        };
        let rate = if up(self.gyroscope_from) { scale(self.measured.rate, 1, GYROSCOPE_CONFIG, 2) } else { [i16::MIN; 3] };
        let acceleration = if up(self.accelerometer_from) {
            scale(self.measured.acceleration, 0, ACCELEROMETER_CONFIG, 1)
        } else {
            [i16::MIN; 3]
        };
        self.latched = Measured { acceleration, rate };
    }

    /// What the self-test adds to an axis of the accelerometer (0) or the gyroscope (1), counts at FS_SEL 3.
    fn pushed(&self, sensor: usize, axis: usize, now: u64) -> f64 {
        let config = self.banks[0][usize::from(SELF_TEST)];
        // The accelerometer's needs its supply, bit 6.
        let on = if sensor == 0 { config >> 6 & config >> (3 + axis) & 1 } else { config >> axis & 1 };
        let settled = ((now - self.tested) as f64 / RESPONSE[sensor] as f64).min(1.0);
        f64::from(on) * settled * self.answers[sensor][axis] * response(CODES[sensor][axis])
    }

    /// Number of the newest reading, if there has been one.
    fn newest(&self, now: u64) -> u64 {
        let rate = match self.banks[0][usize::from(GYROSCOPE_CONFIG)] & 15 {
            3 => 8000,
            4 => 4000,
            5 => 2000,
            _ => 1000,
        };
        let begun = self.gyroscope_from.or(self.accelerometer_from);
        begun.and_then(|begun| now.checked_sub(begun)).map_or(0, |since| 1 + since * rate / crate::time::SECOND)
    }

    fn read(&mut self, register: u8, now: u64) -> u8 {
        if register == BANK {
            return self.bank;
        }
        if self.bank != 0 {
            if self.bank == 1 && register == LAST_CODE {
                (self.judged, self.delivered) = (true, None);
            }
            return self.banks[usize::from(self.bank)][usize::from(register)];
        }
        let words = self.latched.acceleration.into_iter().chain(self.latched.rate);
        match register {
            IDENTITY => 0x47,
            TEMPERATURE | LAST_OF_TEMPERATURE => {
                let counts = ((self.temperature - 25.0) * 132.48).round() as i16;
                counts.to_be_bytes()[usize::from(register - TEMPERATURE)]
            }
            FIRST_DATA..0x2B => {
                let place = usize::from(register - FIRST_DATA);
                words.clone().nth(place / 2).map_or(0, |word| word.to_be_bytes()[place % 2])
            }
            STATUS => {
                let newest = self.newest(now);
                let new = newest > self.seen;
                self.seen = newest;
                // What has been latched before a sensor ran is marked as invalid.
                if new && self.runs(now) && words.clone().all(|word| word != i16::MIN) {
                    self.delivered = Some(self.latched);
                }
                let reset = if std::mem::take(&mut self.reset_done) { RESET_DONE } else { 0 };
                reset | if new { DATA_READY } else { 0 }
            }
            _ => self.banks[0][usize::from(register)],
        }
    }

    fn write(&mut self, register: u8, value: u8, now: u64) {
        if register == BANK {
            self.bank = (value & 7).min(4);
            return;
        }
        if self.bank == 0 && register == DEVICE_CONFIG && value & 1 != 0 {
            self.resets += 1;
            self.forget(now);
            return;
        }
        let switched_on = self.gyroscope_from.map(|from| from.saturating_sub(self.gyroscope_start));
        self.forbidden += u32::from(switched_on.is_some_and(|at| now < at + SETTLING));
        if self.bank == 0 && register == POWER {
            let starts = |on: bool, from: Option<u64>, time: u64| on.then(|| from.unwrap_or(now + time));
            self.gyroscope_from = starts(value >> 2 & 3 == 3, self.gyroscope_from, self.gyroscope_start);
            self.accelerometer_from = starts(value & 3 >= 2, self.accelerometer_from, self.accelerometer_start);
            self.seen = 0;
        }
        if self.bank == 0 && register == SELF_TEST {
            self.tested = now;
            self.tests += u32::from(value & 7 != 0);
        }
        self.banks[usize::from(self.bank)][usize::from(register)] = value;
    }
}

impl Default for Icm42688 {
    fn default() -> Icm42688 {
        Icm42688::new()
    }
}
