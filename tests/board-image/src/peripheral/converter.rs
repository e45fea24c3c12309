//! ADC1, which converts the two coils' currents for ever (RM0090 section 13).

use super::registers::Registers;

const SR: u32 = 0x00;
const CR1: u32 = 0x04;
const CR2: u32 = 0x08;
const JSQR: u32 = 0x38;
const FIRST_INJECTED: u32 = 0x3C;
const LAST_INJECTED: u32 = 0x48;
const DATA: u32 = 0x4C;

const ON: u32 = 1;
const CONTINUOUS: u32 = 1 << 1;
const STARTED: u32 = 1 << 30;
const AUTOMATIC_INJECTED: u32 = 1 << 10;

/// Channel of the first coil; the second's is the next.
const FIRST_CHANNEL: u32 = 10;

/// Counts of an ampere: 50 mΩ, 50 V/V, 3.3 V over 4096.
const COUNTS_PER_AMPERE: f64 = 4096.0 / 3.3 * 2.5;

/// The converter.
#[derive(Clone, Debug, Default)]
pub struct Converter {
    registers: Registers,
    /// It gives this for ever.
    pub stuck: Option<u32>,
}

impl Converter {
    /// Registers as after a reset.
    pub fn reset(&mut self) {
        self.registers = Registers::default();
    }

    /// Whether it converts on and on by itself.
    fn runs(&self) -> bool {
        self.registers.has(CR2, ON | CONTINUOUS | STARTED) && self.registers.has(CR1, AUTOMATIC_INJECTED)
    }

    /// What it makes of a current, A: never more than its range.
    pub fn counts(&self, current: f64) -> u32 {
        self.stuck.unwrap_or((current * COUNTS_PER_AMPERE).clamp(0.0, 4095.0) as u32)
    }

    /// The coil whose current is in the injected data register at `offset`, from 0 on.
    pub fn coil(&self, offset: u32) -> Option<usize> {
        let sequence = self.registers.get(JSQR);
        let length = sequence >> 20 & 3;
        // The sequence of n + 1 is the last n + 1 of four.
        let place = 3 - length + (offset - FIRST_INJECTED) / 4;
        (place < 4)
            .then(|| sequence >> (5 * place) & 31)?
            .checked_sub(FIRST_CHANNEL)
            .filter(|coil| *coil < 2)
            .map(|coil| coil as usize)
    }

    /// A load, with the coils' currents, A.
    pub fn read(&self, offset: u32, currents: [f64; 2]) -> u32 {
        match offset {
            SR if self.runs() => 0b1_1110,
            FIRST_INJECTED..=LAST_INJECTED if self.runs() => self.coil(offset).map_or(0, |coil| self.counts(currents[coil])),
            FIRST_INJECTED..=LAST_INJECTED => 0,
            DATA if self.runs() => self.counts(currents[0]),
            _ => self.registers.get(offset),
        }
    }

    /// A store.
    pub fn write(&mut self, offset: u32, value: u32) {
        self.registers.set(offset, value);
    }
}
