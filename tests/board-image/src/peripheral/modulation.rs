//! TIM8, which modulates the low-side switches (RM0090 section 17).

use super::registers::Registers;
use crate::time::SECOND;

const CR1: u32 = 0x00;
const SR: u32 = 0x10;
const EGR: u32 = 0x14;
const CCER: u32 = 0x20;
const PSC: u32 = 0x28;
const ARR: u32 = 0x2C;
/// Offset of CCR1; the others follow.
pub const CCR1: u32 = 0x34;
/// Offset of BDTR.
pub const BDTR: u32 = 0x44;
/// Offset of AF1, which an F4 has not (RM0440, TIM8_AF1).
const AF1: u32 = 0x60;

const ENABLE: u32 = 1;
const BREAK_ENABLE: u32 = 1 << 12;
const AUTOMATIC_OUTPUT: u32 = 1 << 14;
const MAIN_OUTPUT: u32 = 1 << 15;
const BREAK_FLAG: u32 = 1 << 7;

/// The timer.
#[derive(Clone, Debug, Default)]
pub struct Modulation {
    registers: Registers,
    /// What the comparators are at; a store to CCRx waits for the next update.
    compared: [u32; 4],
    begun: u64,
    update: Option<u64>,
    break_active: bool,
}

impl Modulation {
    /// Registers as after a reset.
    pub fn reset(&mut self) {
        *self = Modulation { registers: Registers::of(&[(ARR, 0xFFFF), (AF1, 1)]), ..Modulation::default() };
    }

    fn period(&self, clock: u64) -> u64 {
        u64::from(self.registers.get(PSC) + 1) * u64::from(self.registers.get(ARR) + 1) * SECOND / clock
    }

    fn update(&mut self) {
        for channel in 0..4 {
            self.compared[channel as usize] = self.registers.get(CCR1 + 4 * channel);
        }
        if self.registers.has(BDTR, AUTOMATIC_OUTPUT) && !self.break_active {
            self.registers.set(BDTR, self.registers.get(BDTR) | MAIN_OUTPUT);
        }
        self.update = None;
    }

    /// Lets time pass.
    pub fn advance(&mut self, now: u64) {
        if self.update.is_some_and(|at| now >= at) {
            self.update();
        }
    }

    /// Share of the time for which the output of a channel, from 0 on, is on.
    pub fn duty(&self, channel: u32) -> f64 {
        let on = self.registers.has(CCER, 1 << (4 * channel))
            && self.registers.has(BDTR, MAIN_OUTPUT)
            && self.registers.has(CR1, ENABLE);
        let top = f64::from(self.registers.get(ARR)) + 1.0;
        if on { (f64::from(self.compared[channel as usize]) / top).min(1.0) } else { 0.0 }
    }

    /// The level of the break input: while it is active, no output is on.
    pub fn set_break(&mut self, active: bool) {
        self.break_active = active;
        if active && self.registers.has(BDTR, BREAK_ENABLE) {
            self.registers.set(BDTR, self.registers.get(BDTR) & !MAIN_OUTPUT);
            self.registers.set(SR, self.registers.get(SR) | BREAK_FLAG);
        }
    }

    /// Whether a level of the break input, or of a comparator in its place, is what it is switched off by.
    pub fn breaks_at(&self, level: bool) -> bool {
        self.registers.has(BDTR, 1 << 13) == level
    }

    /// Whether a comparator of a G4, from 1 on, is at the break.
    pub fn has_comparator(&self, number: u32) -> bool {
        self.registers.has(AF1, 1 << number)
    }

    /// A load.
    pub fn read(&self, offset: u32) -> u32 {
        self.registers.get(offset)
    }

    /// A store, with the rate of the timer's clock, 1/s.
    pub fn write(&mut self, offset: u32, value: u32, clock: u64, now: u64) {
        match offset {
            SR => self.registers.set(SR, self.registers.get(SR) & value),
            EGR => {
                if value & 1 != 0 {
                    self.begun = now;
                    self.update();
                }
                return;
            }
            _ => self.registers.set(offset, value),
        }
        if self.break_active {
            self.set_break(true);
        }
        if offset == CR1 && value & ENABLE != 0 {
            self.begun = now;
        }
        if self.registers.has(CR1, ENABLE) && self.update.is_none() {
            let period = self.period(clock).max(1);
            self.update = Some(self.begun + ((now - self.begun) / period + 1) * period);
        }
    }
}
