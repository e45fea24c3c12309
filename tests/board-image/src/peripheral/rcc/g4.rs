//! RCC of the G4 (RM0440, RCC).

use super::super::registers::Registers;
use super::{CFGR, CR, Cause, HSI, Rcc};
use crate::time::microseconds;

pub(super) const PLLCFGR: u32 = 0x0C;
pub(super) const CIFR: u32 = 0x1C;
const CICR: u32 = 0x20;
const AHB1RSTR: u32 = 0x28;
const APB2RSTR: u32 = 0x40;
const AHB1ENR: u32 = 0x48;
pub(super) const CSR: u32 = 0x94;

/// Of RCC_CFGR: the internal oscillator is wanted, and current.
pub(super) const FROM_HSI: u32 = 5;
/// HSION and HSIRDY.
pub(super) const HSI_RUNS: u32 = 1 << 8 | 1 << 10;
pub(super) const PLL_R_ON: u32 = 1 << 24;
pub(super) const CSS_FLAG: u32 = 1 << 8;
/// The flags of resets, of RCC_CSR.
const FLAGS: u32 = 0xFE00_0000;
const REMOVE_FLAGS: u32 = 1 << 23;

/// The PLL's lock: 40 µs at most (DS12288).
pub(super) const LOCK: u64 = microseconds(40);

/// Flags in RCC_CSR: the supply's coming and its sag are the same one.
fn flags(cause: Cause) -> u32 {
    let own = match cause {
        Cause::Power | Cause::BrownOut => 1 << 27,
        Cause::Pin => 0,
        Cause::Watchdog => 1 << 29,
        Cause::Software => 1 << 28,
        Cause::OptionReload => 1 << 25,
    };
    own | 1 << 26
}

/// Registers after a reset for that cause, where flags of before are there.
pub(super) fn registers(before: Option<&Rcc>, cause: Cause) -> Registers {
    let before = match before {
        Some(rcc) if cause != Cause::Power => rcc.registers.get(CSR) & FLAGS,
        _ => 0,
    };
    Registers::of(&[(CR, HSI_RUNS), (CFGR, FROM_HSI), (PLLCFGR, 0x1000), (AHB1ENR, 1 << 8), (CSR, before | flags(cause))])
}

impl Rcc {
    pub(super) fn pll_hz_g4(&self) -> u64 {
        let word = self.registers.get(PLLCFGR);
        let source = if word & 3 == 3 { self.crystal_hz } else { HSI };
        let field = |shift: u32, mask: u32| u64::from(word >> shift & mask);
        source / (field(4, 15) + 1) * field(8, 127) / (2 * field(25, 3) + 2)
    }

    pub(super) fn clocks_g4(&self, base: u32) -> bool {
        let (offset, bit) = match base {
            0x4000_0000..=0x4000_0C00 => (0x58, base >> 10 & 31),
            0x4000_2400 => (0x58, 10),
            0x4000_3800 => (0x58, 14),
            0x4000_7000 => (0x58, 28),
            0x4001_0000 => (0x60, 0),
            0x4001_3000 => (0x60, 12),
            0x4001_3400 => (0x60, 13),
            0x4001_3800 => (0x60, 14),
            0x4002_0000 => (AHB1ENR, 0),
            0x4002_0800 => (AHB1ENR, 2),
            0x4002_2000 => (AHB1ENR, 8),
            0x4002_3000 => (AHB1ENR, 12),
            0x4800_0000..=0x4800_1800 => (0x4C, base >> 10 & 15),
            0x5000_0000 => (0x4C, 13),
            0x5000_1000 => (0x4C, 18),
            _ => return true,
        };
        self.registers.has(offset, 1 << bit)
    }

    pub(super) fn write_g4(&mut self, offset: u32, value: u32) -> Option<u32> {
        match offset {
            // Locked while the PLL runs.
            PLLCFGR if self.pll_at.is_some() => {}
            CIFR => {}
            CICR => self.registers.set(CIFR, self.registers.get(CIFR) & !value),
            CSR => {
                let flags = if value & REMOVE_FLAGS != 0 { 0 } else { self.registers.get(CSR) & FLAGS };
                self.registers.set(CSR, flags | ((value & 1) * 3));
            }
            AHB1RSTR..=APB2RSTR => {
                let begun = value & !self.registers.get(offset);
                self.registers.set(offset, value);
                return (begun != 0).then(|| reset_base(offset, begun.trailing_zeros())).flatten();
            }
            _ => self.registers.set(offset, value),
        }
        None
    }
}

/// The peripheral behind a bit of a reset register, of those that the program could reset.
fn reset_base(offset: u32, bit: u32) -> Option<u32> {
    Some(match (offset, bit) {
        (0x2C, 0..=6) => 0x4800_0000 + 0x400 * bit,
        (0x38, 0..=3) => 0x4000_0000 + 0x400 * bit,
        (0x38, 14) => 0x4000_3800,
        (0x40, 12) => 0x4001_3000,
        (0x40, 13) => 0x4001_3400,
        (0x40, 14) => 0x4001_3800,
        _ => return None,
    })
}
