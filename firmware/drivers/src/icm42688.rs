//! TDK InvenSense ICM-42688-P, read once a tick by one transaction, brought up by one transaction a tick.
//!
//! Register names and values are those of DS-000347 rev. 1.7. Configured as the part that the simulator models: ±500 °/s and ±8 g in 16
//! bits, both at 8 kHz behind anti-alias filters at 536 Hz, user-interface filters wide open.
//!
//! The driver never waits and never gives up: a part that is absent, comes late, or lost its supply and its configuration is configured
//! anew from the top until it answers, and meanwhile gives no readings.

mod registers;

#[cfg(test)]
mod tests;

use embedded_hal::spi::SpiDevice;

use registers::{FIRST_DATA, IDENTITY, IDENTITY_OF_PART, READ, RESET, SETUP, STATUS_DATA_READY, STATUS_RESERVED};

/// Ticks left to the part after its reset, which takes 1 ms: enough at 10 kHz.
const RESET_TICKS: u8 = 16;

/// Ticks in a row without a new reading after which the part is configured anew. More than its start takes: some 30 ms for the
/// gyroscope, at 10 kHz.
const SILENT_TICKS: u16 = 1000;

/// Bytes of a reading: the address, acceleration (6), rate (6), time of synchronisation (2), status.
const LENGTH: usize = 16;

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
    /// Selects bank 0 and resets.
    Reset,
    /// Lets the reset pass, for so many more ticks.
    Wait(u8),
    /// Asks who is there.
    Identify,
    /// Writes the entry of [`SETUP`].
    Setup(usize),
    /// Reads; so many times in a row there was nothing new.
    Run(u16),
}

/// The part on a bus.
#[derive(Debug)]
pub struct Icm42688<D> {
    device: D,
    stage: Stage,
}

impl<D: SpiDevice> Icm42688<D> {
    /// On a bus of at most 24 MHz in mode 0 or 3.
    pub fn new(device: D) -> Icm42688<D> {
        Icm42688 { device, stage: Stage::Reset }
    }

    /// To be called once a tick: a reading, if there is a new one.
    pub fn tick(&mut self) -> Option<Reading> {
        let (next, reading) = match self.stage {
            Stage::Reset => (self.reset(), None),
            Stage::Wait(0) => (Stage::Identify, None),
            Stage::Wait(ticks) => (Stage::Wait(ticks - 1), None),
            Stage::Identify => (self.identify(), None),
            Stage::Setup(entry) => (self.set_up(entry), None),
            Stage::Run(silent) => match self.read() {
                Some(reading) => (Stage::Run(0), Some(reading)),
                None if silent < SILENT_TICKS => (Stage::Run(silent + 1), None),
                None => (Stage::Reset, None),
            },
        };
        self.stage = next;
        reading
    }

    fn reset(&mut self) -> Stage {
        // The first of the two leaves whatever bank a controller that was itself reset had selected.
        let done = RESET.into_iter().all(|write| self.device.write(&write).is_ok());
        if done { Stage::Wait(RESET_TICKS) } else { Stage::Reset }
    }

    fn identify(&mut self) -> Stage {
        let mut bytes = [IDENTITY | READ, 0];
        match self.device.transfer_in_place(&mut bytes) {
            Ok(()) if bytes[1] == IDENTITY_OF_PART => Stage::Setup(0),
            _ => Stage::Reset,
        }
    }

    fn set_up(&mut self, entry: usize) -> Stage {
        match SETUP.get(entry) {
            None => Stage::Run(0),
            Some(write) if self.device.write(write).is_ok() => Stage::Setup(entry + 1),
            Some(_) => Stage::Reset,
        }
    }

    fn read(&mut self) -> Option<Reading> {
        let mut bytes = [0; LENGTH];
        bytes[0] = FIRST_DATA | READ;
        self.device.transfer_in_place(&mut bytes).ok()?;
        let [_, a, b, c, d, e, f, g, h, i, j, k, l, _, _, status] = bytes;
        let reading = Reading {
            acceleration: [[a, b], [c, d], [e, f]].map(i16::from_be_bytes),
            rate: [[g, h], [i, j], [k, l]].map(i16::from_be_bytes),
        };
        // A line that is stuck high reads as reserved bits, too.
        let new = status & STATUS_DATA_READY != 0 && status & STATUS_RESERVED == 0;
        let valid = !reading.acceleration.contains(&INVALID) && !reading.rate.contains(&INVALID);
        (new && valid).then_some(reading)
    }
}
