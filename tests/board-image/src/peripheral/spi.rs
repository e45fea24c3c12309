//! SPI1 and SPI2 as masters of one sensor each (RM0090 section 28), and the wires to it.

use super::icm42688::Icm42688;
use super::registers::Registers;
use crate::model::Model;
use crate::random::Random;
use crate::time::SECOND;

const CR1: u32 = 0x00;
const CR2: u32 = 0x04;
const SR: u32 = 0x08;
const DR: u32 = 0x0C;

const ENABLE: u32 = 1 << 6;
/// Frames of 16 bits, not of 8, in CR1 of an F4 …
const LONG: u32 = 1 << 11;
/// … and in CR2 of a G4 (RM0440, SPI_CR2).
const SIXTEEN: u32 = 0xF << 8;
const NOT_EMPTY: u32 = 1;
const EMPTY: u32 = 1 << 1;
const OVERRUN: u32 = 1 << 6;

/// What becomes of the bits from the sensor.
#[derive(Clone, Debug, PartialEq)]
pub enum Wire {
    /// They arrive.
    Whole,
    /// All read as this.
    Stuck(bool),
    /// Each is another with this probability.
    Noisy(f64),
}

/// A bus with a sensor.
#[derive(Clone, Debug)]
pub struct Spi {
    model: Model,
    registers: Registers,
    received: Option<u16>,
    overrun: bool,
    /// The sensor.
    pub sensor: Icm42688,
    /// The wire from it.
    pub wire: Wire,
    random: Random,
}

impl Spi {
    /// With a sensor that has just got its supply; `seed` is that of the wire's noise.
    pub fn new(model: Model, seed: u64) -> Spi {
        let registers = Spi::registers(model);
        let (sensor, random) = (Icm42688::new(), Random::new(seed));
        Spi { model, registers, received: None, overrun: false, sensor, wire: Wire::Whole, random }
    }

    fn registers(model: Model) -> Registers {
        Registers::of(&[(CR2, if model == Model::G474 { 7 << 8 } else { 0 }), (0x10, 7)])
    }

    fn long(&self) -> bool {
        match self.model {
            Model::F405 => self.registers.has(CR1, LONG),
            Model::G474 => self.registers.has(CR2, SIXTEEN),
        }
    }

    /// Registers as after a reset. The sensor has none.
    pub fn reset(&mut self) {
        self.registers = Spi::registers(self.model);
        (self.received, self.overrun) = (None, false);
    }

    /// A load.
    pub fn read(&mut self, offset: u32) -> u32 {
        match offset {
            SR => {
                let overrun = if std::mem::take(&mut self.overrun) { OVERRUN } else { 0 };
                EMPTY | overrun | if self.received.is_some() { NOT_EMPTY } else { 0 }
            }
            DR => self.received.take().unwrap_or(0).into(),
            _ => self.registers.get(offset),
        }
    }

    /// A store, with the rate of the bus's clock, 1/s. Gives how long it keeps the wires busy.
    pub fn write(&mut self, offset: u32, value: u32, clock: u64, now: u64) -> u64 {
        if offset != DR {
            self.registers.set(offset, value);
            return 0;
        }
        if !self.registers.has(CR1, ENABLE) {
            return 0;
        }
        let bytes = if self.long() { 2 } else { 1 };
        let arrived =
            (0..bytes).rev().fold(0, |arrived, place| arrived << 8 | u16::from(self.byte((value >> (8 * place)) as u8, now)));
        self.overrun |= self.received.replace(arrived).is_some();
        let divider = 2 << (self.registers.get(CR1) >> 3 & 7);
        8 * bytes * divider * SECOND / clock
    }

    /// Sends a byte to the sensor; the one that arrives meanwhile.
    fn byte(&mut self, byte: u8, now: u64) -> u8 {
        let byte = self.sensor.exchange(byte, now);
        match self.wire {
            Wire::Whole => byte,
            Wire::Stuck(level) => u8::from(level) * 0xFF,
            Wire::Noisy(probability) => {
                (0..8).fold(byte, |byte, bit| if self.random.share() < probability { byte ^ 1 << bit } else { byte })
            }
        }
    }
}
