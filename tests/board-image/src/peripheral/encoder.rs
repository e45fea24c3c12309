//! TIM4 as the counter of the encoder's edges (RM0090 section 18), and the rack that the encoder is at.

use super::registers::Registers;

const CR1: u32 = 0x00;
const SMCR: u32 = 0x08;
const EGR: u32 = 0x14;
const CNT: u32 = 0x24;
const ARR: u32 = 0x2C;

/// The counter.
#[derive(Clone, Debug, Default)]
pub struct Encoder {
    registers: Registers,
    position: i64,
}

impl Encoder {
    /// Registers as after a reset. The rack stays where it is.
    pub fn reset(&mut self) {
        self.registers = Registers::of(&[(ARR, 0xFFFF)]);
    }

    /// The rack goes to `position`, counts: what it moves is counted only where the timer counts.
    pub fn move_to(&mut self, position: i64) {
        let moved = position - self.position;
        self.position = position;
        if self.registers.has(CR1, 1) && self.registers.get(SMCR) & 7 == 3 {
            self.registers.set(CNT, (i64::from(self.count()) + moved) as u32 & 0xFFFF);
        }
    }

    /// What the timer has counted, modulo 2¹⁶.
    pub fn count(&self) -> u32 {
        self.registers.get(CNT)
    }

    /// A load.
    pub fn read(&self, offset: u32) -> u32 {
        self.registers.get(offset)
    }

    /// A store.
    pub fn write(&mut self, offset: u32, value: u32) {
        match offset {
            EGR if value & 1 != 0 => self.registers.set(CNT, 0),
            CNT => self.registers.set(CNT, value & 0xFFFF),
            _ => self.registers.set(offset, value),
        }
    }
}
