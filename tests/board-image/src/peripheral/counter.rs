//! TIM2, TIM3 and TIM5 as counters that count up (RM0090 section 18).

use super::registers::Registers;
use crate::time::SECOND;

const CR1: u32 = 0x00;
const DIER: u32 = 0x0C;
const EGR: u32 = 0x14;
const CNT: u32 = 0x24;
const PSC: u32 = 0x28;
const ARR: u32 = 0x2C;

/// A timer.
#[derive(Clone, Debug, Default)]
pub struct Counter {
    registers: Registers,
    begun: u64,
    /// In force: PSC is taken over at an update.
    prescaler: u64,
}

impl Counter {
    /// Registers as after a reset, of a timer of 32 bits.
    pub fn reset(&mut self) {
        *self = Counter { registers: Registers::of(&[(ARR, u32::MAX)]), ..Counter::default() };
    }

    /// What a register holds.
    pub fn register(&self, offset: u32) -> u32 {
        self.registers.get(offset)
    }

    /// Its count at a time, with the rate of its clock, 1/s.
    pub fn count(&self, clock: u64, now: u64) -> u64 {
        let ticks = u128::from(now - self.begun) * u128::from(clock) / u128::from(SECOND) / u128::from(self.prescaler + 1);
        (ticks % (u128::from(self.registers.get(ARR)) + 1)) as u64
    }

    /// Its clock changes from one rate to another, 1/s: it counts on.
    pub fn clocked(&mut self, before: u64, after: u64, now: u64) {
        let counted =
            u128::from(self.count(before, now)) * u128::from(SECOND) * u128::from(self.prescaler + 1) / u128::from(after);
        self.begun = now.saturating_sub(counted as u64);
    }

    /// Whether it asks a stream for a transfer at each update.
    pub fn asks(&self) -> bool {
        self.registers.has(CR1, 1) && self.registers.has(DIER, 1 << 8)
    }

    /// A load, with the rate of the timer's clock, 1/s.
    pub fn read(&self, offset: u32, clock: u64, now: u64) -> u32 {
        match offset {
            CNT if self.registers.has(CR1, 1) => self.count(clock, now) as u32,
            _ => self.registers.get(offset),
        }
    }

    /// A store.
    pub fn write(&mut self, offset: u32, value: u32, now: u64) {
        match offset {
            CR1 if value & !self.registers.get(CR1) & 1 != 0 => self.begun = now,
            EGR if value & 1 != 0 => (self.begun, self.prescaler) = (now, self.registers.get(PSC).into()),
            CNT => self.begun = now,
            _ => {}
        }
        self.registers.set(offset, value);
    }
}
