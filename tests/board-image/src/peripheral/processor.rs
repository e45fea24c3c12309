//! What belongs to the processor itself: SysTick, NVIC, SCB, DWT (PM0214 section 4; ARMv7-M, B3 and C1).

use std::collections::BTreeSet;

use super::registers::Registers;

/// Exceptions, by their number.
pub const NMI: u32 = 2;
/// HardFault.
pub const HARD_FAULT: u32 = 3;
/// SysTick.
pub const SYSTICK: u32 = 15;
/// The first interrupt.
pub const FIRST_INTERRUPT: u32 = 16;

/// Lower than every priority that an exception can have.
pub const IDLE: i32 = 256;

const CONTROL: u32 = 0xE000_E010;
const RELOAD: u32 = 0xE000_E014;
const CURRENT: u32 = 0xE000_E018;
const ENABLE_SET: u32 = 0xE000_E100;
const ENABLE_CLEAR: u32 = 0xE000_E180;
const PENDING_SET: u32 = 0xE000_E200;
const PENDING_CLEAR: u32 = 0xE000_E280;
const PRIORITIES: u32 = 0xE000_E400;
const ICSR: u32 = 0xE000_ED04;
const VTOR: u32 = 0xE000_ED08;
const AIRCR: u32 = 0xE000_ED0C;
const SHPR1: u32 = 0xE000_ED18;
const CFSR: u32 = 0xE000_ED28;
const HFSR: u32 = 0xE000_ED2C;
const BFAR: u32 = 0xE000_ED38;
const DEMCR: u32 = 0xE000_EDFC;
const CYCLES_CONTROL: u32 = 0xE000_1000;
const CYCLES: u32 = 0xE000_1004;

const WRAPPED: u32 = 1 << 16;
const TRACE: u32 = 1 << 24;

/// The blocks, with the cycles of the core's clock by the half.
#[derive(Clone, Debug, Default)]
pub struct Private {
    /// From 0xE000_E000 on: four KiB.
    system: [Registers; 4],
    pending: BTreeSet<u32>,
    wrapped: bool,
    /// When SysTick wraps, half cycles.
    pub wraps: Option<u64>,
    cycles_from: Option<u64>,
    cycles: u32,
    /// SYSRESETREQ was written.
    pub reset_asked: bool,
}

impl Private {
    fn get(&self, address: u32) -> u32 {
        self.system[(address >> 10 & 3) as usize].get(address & 0x3FF)
    }

    fn set(&mut self, address: u32, value: u32) {
        self.system[(address >> 10 & 3) as usize].set(address & 0x3FF, value);
    }

    /// Bytes of a period of SysTick, half cycles.
    pub fn period(&self) -> u64 {
        2 * (u64::from(self.get(RELOAD) & 0xFF_FFFF) + 1)
    }

    /// SysTick's wraps until `half_cycles`.
    pub fn advance(&mut self, half_cycles: u64) {
        while let Some(at) = self.wraps.filter(|at| *at <= half_cycles) {
            self.wrapped = true;
            self.wraps = Some(at + self.period());
            if self.get(CONTROL) & 2 != 0 {
                self.pending.insert(SYSTICK);
            }
        }
    }

    /// An exception waits.
    pub fn pend(&mut self, exception: u32) {
        self.pending.insert(exception);
    }

    /// A HardFault waits: for an access that nothing answers at an address, or for an instruction that there is not.
    pub fn fault(&mut self, address: Option<u32>) {
        const UNDEFINED: u32 = 1 << 16;
        const PRECISE_AND_VALID: u32 = 1 << 9 | 1 << 15;
        const FORCED: u32 = 1 << 30;
        self.set(CFSR, self.get(CFSR) | if address.is_some() { PRECISE_AND_VALID } else { UNDEFINED });
        self.set(HFSR, self.get(HFSR) | FORCED);
        if let Some(address) = address {
            self.set(BFAR, address);
        }
        self.pending.insert(HARD_FAULT);
    }

    /// A HardFault waits, for the stack has no memory where an exception puts registers.
    pub fn stacking_fault(&mut self) {
        const STACKING: u32 = 1 << 12;
        const FORCED: u32 = 1 << 30;
        self.set(CFSR, self.get(CFSR) | STACKING);
        self.set(HFSR, self.get(HFSR) | FORCED);
        self.pending.insert(HARD_FAULT);
    }

    /// Whether there has been a fault since the flags were cleared.
    pub fn faulted(&self) -> bool {
        self.get(HFSR) != 0
    }

    /// Something waits, whether it may come or not.
    pub fn waits(&self) -> bool {
        !self.pending.is_empty()
    }

    /// Priority of an exception: smaller comes first.
    pub fn priority(&self, exception: u32) -> i32 {
        match exception {
            NMI => -2,
            HARD_FAULT => -1,
            4..FIRST_INTERRUPT => (self.get(SHPR1 - 4 + (exception & !3)) >> (8 * (exception & 3)) & 0xF0) as i32,
            _ => {
                let number = exception - FIRST_INTERRUPT;
                (self.get(PRIORITIES + (number & !3)) >> (8 * (number & 3)) & 0xF0) as i32
            }
        }
    }

    /// The first of those that wait and may come before `priority`.
    pub fn next(&self, priority: i32) -> Option<u32> {
        let enabled = |exception: u32| {
            exception < FIRST_INTERRUPT || {
                let number = exception - FIRST_INTERRUPT;
                self.get(ENABLE_SET + 4 * (number / 32)) >> (number % 32) & 1 == 1
            }
        };
        let may = self.pending.iter().copied().filter(|&exception| enabled(exception) && self.priority(exception) < priority);
        may.min_by_key(|&exception| (self.priority(exception), exception))
    }

    /// It comes.
    pub fn take(&mut self, exception: u32) {
        self.pending.remove(&exception);
    }

    /// Address of the vectors.
    pub fn vectors(&self) -> u32 {
        self.get(VTOR)
    }

    /// A load.
    pub fn read(&mut self, address: u32, half_cycles: u64) -> u32 {
        match address {
            CONTROL => self.get(CONTROL) | if std::mem::take(&mut self.wrapped) { WRAPPED } else { 0 },
            CURRENT => self.wraps.map_or(0, |at| ((at.saturating_sub(half_cycles)) / 2) as u32),
            ICSR => {
                let systick = u32::from(self.pending.contains(&SYSTICK)) << 26;
                let next = self.pending.first().copied().unwrap_or(0);
                systick | next << 12 | u32::from(self.pending.contains(&NMI)) << 31
            }
            AIRCR => self.get(AIRCR) & 0xFFFF | 0xFA05_0000,
            0xE000_ED00 => 0x410F_C241,
            CYCLES => match self.cycles_from {
                Some(from) => self.cycles.wrapping_add(((half_cycles - from) / 2) as u32),
                None => self.cycles,
            },
            // Four comparators; the counter of cycles is there.
            CYCLES_CONTROL => 0x4000_0000 | u32::from(self.cycles_from.is_some()),
            // Bits are cleared at the addresses from which they are read, too.
            0xE000_E000..0xE000_F000 => match address & !0x1F {
                ENABLE_CLEAR => self.get(address - ENABLE_CLEAR + ENABLE_SET),
                PENDING_SET | PENDING_CLEAR => {
                    let first = FIRST_INTERRUPT + 8 * (address & 0x1C);
                    (0..32).filter(|bit| self.pending.contains(&(first + bit))).map(|bit| 1 << bit).sum()
                }
                _ => self.get(address),
            },
            _ => 0,
        }
    }

    /// A store.
    pub fn write(&mut self, address: u32, value: u32, half_cycles: u64) {
        match address {
            CONTROL => {
                let begins = value & !self.get(CONTROL) & 1 != 0;
                self.set(CONTROL, value & 7);
                if value & 1 == 0 {
                    self.wraps = None;
                } else if begins {
                    self.wraps = Some(half_cycles + self.period());
                }
            }
            CURRENT => {
                self.wrapped = false;
                self.wraps = self.wraps.map(|_| half_cycles + self.period());
            }
            ICSR => {
                for (bit, exception) in [(26, SYSTICK), (31, NMI)] {
                    if value >> bit & 1 == 1 {
                        self.pending.insert(exception);
                    }
                }
                if value >> 25 & 1 == 1 {
                    self.pending.remove(&SYSTICK);
                }
            }
            AIRCR if value >> 16 == 0x05FA => {
                self.set(AIRCR, value & 0x700);
                self.reset_asked |= value & 4 != 0;
            }
            AIRCR => {}
            CYCLES => {
                self.cycles = value;
                self.cycles_from = self.cycles_from.map(|_| half_cycles);
            }
            CYCLES_CONTROL => {
                let now = self.read(CYCLES, half_cycles);
                let counts = value & 1 == 1 && self.get(DEMCR) & TRACE != 0;
                (self.cycles, self.cycles_from) = (now, counts.then_some(half_cycles));
            }
            0xE000_E000..0xE000_F000 => self.write_interrupts(address, value),
            _ => {}
        }
    }

    fn write_interrupts(&mut self, address: u32, value: u32) {
        let first = FIRST_INTERRUPT + 8 * (address & 0x1C);
        let numbers = (0..32).filter(|bit| value >> bit & 1 == 1).map(|bit| first + bit);
        match address & !0x1F {
            ENABLE_SET => self.set(address, self.get(address) | value),
            ENABLE_CLEAR => {
                let set = address - ENABLE_CLEAR + ENABLE_SET;
                self.set(set, self.get(set) & !value);
            }
            PENDING_SET => self.pending.extend(numbers),
            PENDING_CLEAR => numbers.for_each(|number| _ = self.pending.remove(&number)),
            // Flags are cleared by writing 1.
            _ if matches!(address, CFSR | HFSR) => self.set(address, self.get(address) & !value),
            _ => self.set(address, value),
        }
    }
}
