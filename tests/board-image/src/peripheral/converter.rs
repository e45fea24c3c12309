//! ADC1, which converts the two coils' currents and their supply for ever (RM0090 section 13).

use super::registers::Registers;
use crate::model::Model;

const SR: u32 = 0x00;
const CR1: u32 = 0x04;
const CR2: u32 = 0x08;
const SQR3: u32 = 0x34;
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

/// Channel of the supply's divider, at PC2.
const SUPPLY_CHANNEL: u32 = 12;

/// Counts of a volt of the supply: 10 kΩ of 110, 3.3 V over 4096.
pub const COUNTS_PER_VOLT: f64 = 4096.0 / 3.3 * 10.0 / 110.0;

/// Counts of an ampere: 50 mΩ, 50 V/V, 3.3 V over 4096.
pub const COUNTS_PER_AMPERE: f64 = 4096.0 / 3.3 * 2.5;

/// What is at the converter's pins.
#[derive(Clone, Copy, Debug)]
pub struct Inputs {
    /// Of the coils, A.
    pub currents: [f64; 2],
    /// Of the coils, V.
    pub supply: f64,
}

/// The converter.
#[derive(Clone, Debug, Default)]
pub struct Converter {
    registers: Registers,
    /// It gives this for ever.
    pub stuck: Option<u32>,
}

/// Offsets and bits of a G4's (RM0440, ADC).
mod g4 {
    pub const ISR: u32 = 0x00;
    pub const CR: u32 = 0x08;
    pub const CFGR: u32 = 0x0C;
    pub const JSQR: u32 = 0x4C;
    pub const SQR1: u32 = 0x30;
    pub const DR: u32 = 0x40;
    pub const JDR1: u32 = 0x80;
    pub const JDR4: u32 = 0x8C;
    pub const ENABLED: u32 = 1;
    pub const STARTED: u32 = 1 << 2;
    pub const REGULATOR: u32 = 1 << 28;
    pub const DEEP_POWER_DOWN: u32 = 1 << 29;
    pub const CALIBRATES: u32 = 1 << 31;
    pub const CONTINUOUS: u32 = 1 << 13;
    pub const AUTOMATIC_INJECTED: u32 = 1 << 25;
    /// Of the two coils: PA1 and PC1.
    pub const CHANNELS: [u32; 2] = [2, 7];
    /// Of the supply's divider: PC2.
    pub const SUPPLY: u32 = 8;
}

impl Converter {
    fn ready_g4(&self) -> bool {
        self.registers.has(g4::CR, g4::ENABLED | g4::REGULATOR) && self.registers.get(g4::CR) & g4::DEEP_POWER_DOWN == 0
    }

    fn runs_g4(&self) -> bool {
        let both = self.registers.has(g4::CFGR, g4::CONTINUOUS | g4::AUTOMATIC_INJECTED);
        self.ready_g4() && both && self.registers.has(g4::CR, g4::STARTED)
    }

    /// A load from a G4's, with what is at its pins.
    pub fn read_g4(&self, offset: u32, inputs: Inputs) -> u32 {
        match offset {
            g4::ISR => u32::from(self.ready_g4()),
            g4::JDR1..=g4::JDR4 if self.runs_g4() => {
                let (sequence, place) = (self.registers.get(g4::JSQR), (offset - g4::JDR1) / 4);
                let channel = sequence >> (9 + 6 * place) & 31;
                let coil = g4::CHANNELS.iter().position(|of| *of == channel && place <= sequence & 3);
                coil.map_or(0, |coil| self.counts(inputs.currents[coil]))
            }
            g4::DR if self.runs_g4() && self.registers.get(g4::SQR1) >> 6 & 31 == g4::SUPPLY => self.volts(inputs.supply),
            g4::JDR1..=g4::JDR4 | g4::DR => 0,
            _ => self.registers.get(offset),
        }
    }

    /// A store to a G4's: bits of its control register are set by 1 and cleared by what they start.
    pub fn write_g4(&mut self, offset: u32, value: u32) {
        let stays = self.registers.get(g4::CR) & (g4::ENABLED | g4::STARTED);
        match offset {
            g4::ISR => {}
            // The regulator first, then what needs it.
            g4::CR if value & g4::REGULATOR == 0 => self.registers.set(g4::CR, value & g4::DEEP_POWER_DOWN),
            g4::CR => {
                let started = if stays & g4::ENABLED == 0 { value & !g4::STARTED } else { value };
                self.registers.set(g4::CR, started & !g4::CALIBRATES | stays);
            }
            _ => self.registers.set(offset, value),
        }
    }

    /// Registers as after a reset.
    pub fn reset(&mut self, model: Model) {
        self.registers = match model {
            Model::F405 => Registers::default(),
            Model::G474 => Registers::of(&[(g4::CR, g4::DEEP_POWER_DOWN), (g4::CFGR, 1 << 31)]),
        };
    }

    /// Whether it converts on and on by itself.
    fn runs(&self) -> bool {
        self.registers.has(CR2, ON | CONTINUOUS | STARTED) && self.registers.has(CR1, AUTOMATIC_INJECTED)
    }

    /// What it makes of a current, A: never more than its range.
    pub fn counts(&self, current: f64) -> u32 {
        self.stuck.unwrap_or((current * COUNTS_PER_AMPERE).clamp(0.0, 4095.0) as u32)
    }

    /// What it makes of the supply, V: never more than its range.
    pub fn volts(&self, supply: f64) -> u32 {
        self.stuck.unwrap_or((supply * COUNTS_PER_VOLT).clamp(0.0, 4095.0) as u32)
    }

    /// The coil whose current is in the injected data register at `offset`, from 0 on.
    pub fn coil(&self, offset: u32) -> Option<usize> {
        if !(FIRST_INJECTED..=LAST_INJECTED).contains(&offset) {
            return None;
        }
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

    /// A load, with what is at its pins.
    pub fn read(&self, offset: u32, inputs: Inputs) -> u32 {
        match offset {
            SR if self.runs() => 0b1_1110,
            FIRST_INJECTED..=LAST_INJECTED if self.runs() => {
                self.coil(offset).map_or(0, |coil| self.counts(inputs.currents[coil]))
            }
            FIRST_INJECTED..=LAST_INJECTED => 0,
            DATA if self.runs() && self.registers.get(SQR3) & 31 == SUPPLY_CHANNEL => self.volts(inputs.supply),
            DATA => 0,
            _ => self.registers.get(offset),
        }
    }

    /// A store.
    pub fn write(&mut self, offset: u32, value: u32) {
        self.registers.set(offset, value);
    }
}
