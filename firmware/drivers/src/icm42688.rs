//! TDK InvenSense ICM-42688-P, read once a tick, brought up a register a tick.
//!
//! Register names and values are those of DS-000347 rev. 1.7. Configured as the part that the simulator models: ±500 °/s and ±8 g in 16
//! bits, both at 8 kHz behind anti-alias filters at 536 Hz, user-interface filters wide open.
//!
//! A part that is configured already is only read back, so that a processor that was reset in the middle of a motion has readings again
//! within some ticks. While it is read, its configuration is compared on and on, and its temperature is read now and then.
//!
//! Where somebody asks for it, the part tests itself before it is read, once: never by itself, for it takes some 0.4 s.
//!
//! The driver never waits and never gives up: a part that is absent, comes late, or lost its supply and its configuration is configured
//! anew from the top until it answers, and meanwhile gives no readings.

mod registers;
mod self_test;

#[cfg(test)]
mod tests;

use embedded_hal::spi::SpiDevice;

use registers::{
    ACCELEROMETER_CODES, BANK, CONFIGURATION, FIRST_DATA, GYROSCOPE_CODES, IDENTITY, IDENTITY_OF_PART, READ, RESET, SELF_TEST,
    STATUS_DATA_READY, STATUS_RESERVED, TEMPERATURE,
};
use self_test::{Order, SelfTest};
pub use self_test::{Verdict, duration as test_duration};

/// Ticks left to the part after its reset, which takes 1 ms: enough at 10 kHz.
const RESET_TICKS: u8 = 16;

/// Ticks in a row without a new reading after which the part is configured anew. More than its start takes: some 30 ms for the
/// gyroscope, at 10 kHz.
const SILENT_TICKS: u16 = 1000;

/// The same for a part that was found configured, which has no start left to make.
const SILENT_TICKS_FOUND: u16 = 16;

/// Registers that are read back in a tick to recognise a part that is configured already.
const READ_BACK_A_TICK: usize = 4;

/// Ticks between two registers that are compared while the part is read, or its temperature: all of them within 0.7 s at 2 kHz.
const COMPARED_EVERY: u8 = 64;

/// Words of a reading: the address, acceleration (6 bytes), rate (6), time of synchronisation (2), status.
const LENGTH: usize = 8;

/// A value that a reading has while there is none.
const INVALID: i16 = i16::MIN;

/// A new reading, in counts of the part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Specific force along x, y, z: 4096 counts to g.
    pub acceleration: [i16; 3],
    /// Rate about x, y, z: 65.5 counts to a degree a second.
    pub rate: [i16; 3],
}

/// What the next tick does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// Asks who is there, and reads [`CONFIGURATION`] back from an entry on.
    Recognise(usize),
    /// Selects bank 0 and resets.
    Reset,
    /// Lets the reset pass, for so many more ticks.
    Wait(u8),
    /// Asks who is there.
    Identify,
    /// Writes an entry of [`CONFIGURATION`].
    Setup(usize),
    /// Continues its self-test.
    Test,
    /// Reads; so many times in a row there was nothing new.
    Run(u16),
}

/// Which register is compared next, and when.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Comparison {
    ticks: u8,
    entry: usize,
    /// It was another than it should be, once.
    doubtful: bool,
}

/// The part on a bus.
#[derive(Debug)]
pub struct Icm42688<D> {
    device: D,
    stage: Stage,
    comparison: Comparison,
    temperature: Option<i16>,
    /// Asked for, or under way.
    test: Option<SelfTest>,
    verdict: Option<Verdict>,
}

impl<D: SpiDevice<u16>> Icm42688<D> {
    /// On a bus of at most 24 MHz in mode 0 or 3, that sends words of 16 bits with the most significant bit first: an address and a value.
    pub fn new(device: D) -> Icm42688<D> {
        let (stage, comparison) = (Stage::Recognise(0), Comparison::default());
        Icm42688 { device, stage, comparison, temperature: None, test: None, verdict: None }
    }

    /// Has the part test itself, with a tick every `period` s, as soon as it is configured: before its first reading, or now. One that does
    /// not answer at once is not tested when it comes.
    #[inline(never)]
    pub fn test(&mut self, period: f32) {
        (self.test, self.verdict) = (Some(SelfTest::new(period)), None);
        if let Stage::Run(_) = self.stage {
            self.stage = Stage::Test;
        }
    }

    /// What the test has come to, once.
    pub fn verdict(&mut self) -> Option<Verdict> {
        self.verdict.take()
    }

    /// Temperature of the part as last read, °C: every half second at 2 kHz, to some kelvins.
    pub fn temperature(&self) -> Option<f32> {
        self.temperature.map(|counts| 25.0 + f32::from(counts) / 132.48)
    }

    /// To be called once a tick: a reading, if there is a new one.
    #[inline]
    pub fn tick(&mut self) -> Option<Reading> {
        if let Stage::Run(silent) = self.stage {
            return self.run(silent);
        }
        self.stage = self.bring_up();
        None
    }

    #[inline]
    fn run(&mut self, silent: u16) -> Option<Reading> {
        let reading = self.read();
        if !self.compare() {
            // What a part of another configuration says is not known.
            self.stage = Stage::Reset;
            return None;
        }
        match reading {
            Some(_) if silent == 0 => {}
            Some(_) => self.stage = Stage::Run(0),
            None if silent < SILENT_TICKS => self.stage = Stage::Run(silent + 1),
            None => self.stage = Stage::Reset,
        }
        reading
    }

    #[inline(never)]
    fn bring_up(&mut self) -> Stage {
        match self.stage {
            Stage::Recognise(entry) => self.recognise(entry),
            Stage::Reset => self.reset(),
            Stage::Wait(0) => Stage::Identify,
            Stage::Wait(ticks) => Stage::Wait(ticks - 1),
            Stage::Identify => {
                if self.is_there() {
                    Stage::Setup(0)
                } else {
                    self.give_up();
                    Stage::Reset
                }
            }
            Stage::Setup(entry) => self.set_up(entry),
            Stage::Test => self.go_on(),
            Stage::Run(silent) => Stage::Run(silent),
        }
    }

    /// Nothing is written but the bank, so that a part that gives readings keeps giving them.
    fn recognise(&mut self, entry: usize) -> Stage {
        // A controller that was itself reset may have left any bank selected.
        if entry == 0 && !(self.put(BANK, 0) && self.is_there()) {
            return Stage::Reset;
        }
        let end = entry + READ_BACK_A_TICK;
        match (entry..end).all(|entry| self.holds(entry)) {
            true if end < CONFIGURATION.len() => Stage::Recognise(end),
            true => self.begin(SILENT_TICKS - SILENT_TICKS_FOUND),
            false => Stage::Reset,
        }
    }

    /// The part is configured: it is tested, if that is asked for, or read from `silent` ticks without a reading on.
    fn begin(&self, silent: u16) -> Stage {
        if self.test.is_some() { Stage::Test } else { Stage::Run(silent) }
    }

    fn give_up(&mut self) {
        if self.test.take().is_some() {
            self.verdict = Some(Verdict::Undecided);
        }
    }

    /// A tick of the self-test.
    fn go_on(&mut self) -> Stage {
        let reading = self.read_apart();
        let Some(test) = &mut self.test else { return Stage::Run(0) };
        let order = test.step(reading);
        let excited = test.has_excited();
        match order {
            Order::Read => return Stage::Test,
            Order::Excite(axes) if self.put(SELF_TEST, axes) => return Stage::Test,
            Order::ReadCodes => {
                let mut codes = [0; 6];
                let [x, y, z, of_gyroscope @ ..] = &mut codes;
                let read =
                    self.read_codes(ACCELEROMETER_CODES, [x, y, z]) && self.read_codes(GYROSCOPE_CODES, of_gyroscope.each_mut());
                match self.test.take() {
                    Some(test) if read => self.verdict = Some(test.judge(codes)),
                    _ => self.verdict = Some(Verdict::Undecided),
                }
            }
            Order::Excite(_) | Order::End => self.give_up(),
        }
        if excited { Stage::Reset } else { Stage::Run(0) }
    }

    /// What the factory has left of three axes; whether it could be read.
    #[inline(never)]
    fn read_codes(&mut self, (bank, first): (u8, u8), codes: [&mut u8; 3]) -> bool {
        let mut read = self.put(BANK, bank);
        for (code, address) in codes.into_iter().zip(first..) {
            match self.register(address) {
                Some(value) => *code = value,
                None => read = false,
            }
        }
        self.put(BANK, 0) && read
    }

    fn reset(&mut self) -> Stage {
        let done = [(BANK, 0), RESET].into_iter().all(|(address, value)| self.put(address, value));
        self.comparison = Comparison::default();
        if done { Stage::Wait(RESET_TICKS) } else { Stage::Reset }
    }

    fn is_there(&mut self) -> bool {
        self.register(IDENTITY) == Some(IDENTITY_OF_PART)
    }

    fn set_up(&mut self, number: usize) -> Stage {
        let Some(entry) = CONFIGURATION.get(number) else { return self.begin(0) };
        let selected = number.checked_sub(1).and_then(|last| CONFIGURATION.get(last)).map_or(0, |last| last.bank);
        let done = (entry.bank == selected || self.put(BANK, entry.bank)) && self.put(entry.address, entry.value);
        if done { Stage::Setup(number + 1) } else { Stage::Reset }
    }

    /// Whether a register holds what it shall, with bank 0 selected before and after. There is nothing wrong with one that does not exist.
    fn holds(&mut self, number: usize) -> bool {
        let Some(entry) = CONFIGURATION.get(number).filter(|entry| entry.kept != 0) else { return true };
        let elsewhere = entry.bank != 0;
        let found = (!elsewhere || self.put(BANK, entry.bank)).then(|| self.register(entry.address)).flatten();
        let back = !elsewhere || self.put(BANK, 0);
        back && found.is_some_and(|value| (value ^ entry.value) & entry.kept == 0)
    }

    /// Compares a register, now and then; `false` when it was wrong twice: a bit that is lost on the wires does not come again.
    #[inline]
    fn compare(&mut self) -> bool {
        let Comparison { ticks, doubtful, .. } = self.comparison;
        if ticks < COMPARED_EVERY && !doubtful {
            self.comparison.ticks = ticks + 1;
            return true;
        }
        self.compare_next()
    }

    #[inline(never)]
    fn compare_next(&mut self) -> bool {
        let Comparison { entry, doubtful, .. } = self.comparison;
        let holds = self.holds(entry);
        let next = if entry < CONFIGURATION.len() { entry + 1 } else { 0 };
        if entry == CONFIGURATION.len() {
            self.read_temperature();
        }
        self.comparison = Comparison { ticks: 0, entry: if holds { next } else { entry }, doubtful: !holds };
        holds || !doubtful
    }

    fn read_temperature(&mut self) {
        let mut words = [u16::from_be_bytes([TEMPERATURE | READ, 0]), 0];
        let read = self.device.transfer_in_place(&mut words).is_ok();
        let [[_, high], [low, _]] = words.map(u16::to_be_bytes);
        let counts = i16::from_be_bytes([high, low]);
        self.temperature = (read && counts != INVALID).then_some(counts);
    }

    /// Writes a register.
    #[inline(never)]
    fn put(&mut self, address: u8, value: u8) -> bool {
        self.device.write(&[u16::from_be_bytes([address, value])]).is_ok()
    }

    #[inline(never)]
    fn register(&mut self, address: u8) -> Option<u8> {
        let mut words = [u16::from_be_bytes([address | READ, 0])];
        self.device.transfer_in_place(&mut words).ok()?;
        let [[_, value]] = words.map(u16::to_be_bytes);
        Some(value)
    }

    // Compiled twice: a reading in operation is not to cost a call.
    #[inline(always)]
    fn read(&mut self) -> Option<Reading> {
        let mut words = [0; LENGTH];
        words[0] = u16::from_be_bytes([FIRST_DATA | READ, 0]);
        self.device.transfer_in_place(&mut words).ok()?;
        let [a, b, c, d, e, f, g, last] = words;
        // Each value lies across two words.
        let value = |first: u16, second: u16| (first << 8 | second >> 8) as i16;
        let reading =
            Reading { acceleration: [value(a, b), value(b, c), value(c, d)], rate: [value(d, e), value(e, f), value(f, g)] };
        let [_, status] = last.to_be_bytes();
        // A line that is stuck high reads as reserved bits, too.
        let new = status & STATUS_DATA_READY != 0 && status & STATUS_RESERVED == 0;
        let valid = !reading.acceleration.contains(&INVALID) && !reading.rate.contains(&INVALID);
        (new && valid).then_some(reading)
    }

    #[inline(never)]
    fn read_apart(&mut self) -> Option<Reading> {
        self.read()
    }
}
