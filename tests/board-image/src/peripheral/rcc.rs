//! RCC: clocks, resets and why there was one (RM0090 section 7).

mod g4;

use super::registers::Registers;
use crate::model::Model;
use crate::time::{microseconds, milliseconds};

/// Offsets.
pub const CR: u32 = 0x00;
const PLLCFGR: u32 = 0x04;
const CFGR: u32 = 0x08;
const CIR: u32 = 0x0C;
const AHB1RSTR: u32 = 0x10;
const APB2RSTR: u32 = 0x24;
const AHB1ENR: u32 = 0x30;
/// Offset of RCC_CSR.
pub const CSR: u32 = 0x74;

const HSE_ON: u32 = 1 << 16;
const HSE_READY: u32 = 1 << 17;
const CSS_ON: u32 = 1 << 19;
const PLL_ON: u32 = 1 << 24;
const PLL_READY: u32 = 1 << 25;
const PLL_FROM_HSE: u32 = 1 << 22;
const CSS_FLAG: u32 = 1 << 7;
const CSS_CLEAR: u32 = 1 << 23;

/// Of the internal oscillator, 1/s.
const HSI: u64 = 16_000_000;
/// Of a crystal that is right, 1/s.
const HSE: u64 = 8_000_000;
/// A crystal's start: 2 ms (DS8626, table 39).
const CRYSTAL_START: u64 = milliseconds(2);
/// The PLL's lock: 300 µs at most (DS8626, table 43).
const LOCK: u64 = microseconds(300);

/// Why the chip was reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The supply came: memory and backup domain are lost.
    Power,
    /// The supply sagged: memory is not to be relied upon.
    BrownOut,
    /// The pin.
    Pin,
    /// The independent watchdog.
    Watchdog,
    /// SYSRESETREQ.
    Software,
    /// Option bytes were to come into force, on a G4.
    OptionReload,
}

impl Cause {
    /// Its flags in RCC_CSR: every reset pulls the pin, and the supply's coming is a sag that ends.
    fn flags(self) -> u32 {
        let own = match self {
            Cause::Power => 1 << 27 | 1 << 25,
            Cause::BrownOut => 1 << 25,
            Cause::Pin | Cause::OptionReload => 0,
            Cause::Watchdog => 1 << 29,
            Cause::Software => 1 << 28,
        };
        own | 1 << 26
    }
}

/// The block.
#[derive(Clone, Debug)]
pub struct Rcc {
    model: Model,
    registers: Registers,
    /// The crystal is there and whole.
    pub crystal: bool,
    /// Its rate, 1/s.
    pub(crate) crystal_hz: u64,
    /// When the crystal will run, if it has been switched on.
    crystal_at: Option<u64>,
    /// Likewise the PLL.
    pll_at: Option<u64>,
}

impl Rcc {
    /// After a reset for that cause; flags of before stay until the program clears them.
    pub fn reset(model: Model, before: Option<&Rcc>, cause: Cause) -> Rcc {
        let (crystal, crystal_hz) = before.map_or((true, HSE), |rcc| (rcc.crystal, rcc.crystal_hz));
        if model == Model::G474 {
            return Rcc { model, registers: g4::registers(before, cause), crystal, crystal_hz, crystal_at: None, pll_at: None };
        }
        let flags = match before {
            Some(rcc) if cause != Cause::Power => rcc.registers.get(CSR) & 0xFE00_0000,
            _ => 0,
        };
        let registers = Registers::of(&[
            (CR, 0x83),
            (PLLCFGR, 0x2400_3010),
            (AHB1ENR, 0x0010_0000),
            (CSR, flags | cause.flags()),
            (0x84, 0x2000_3000),
        ]);
        Rcc { model, registers, crystal, crystal_hz, crystal_at: None, pll_at: None }
    }

    fn crystal_runs(&self, now: u64) -> bool {
        self.crystal && self.crystal_at.is_some_and(|at| now >= at)
    }

    /// Rate of the core's clock, 1/s.
    pub fn core_hz(&self) -> u64 {
        let configuration = self.registers.get(CFGR);
        let hz = match (self.model, configuration >> 2 & 3) {
            (Model::F405, 1) | (Model::G474, 2) => self.crystal_hz,
            (Model::F405, 2..) => self.pll_hz(),
            (Model::G474, 3) => self.pll_hz_g4(),
            _ => HSI,
        };
        match configuration >> 4 & 15 {
            divider @ 8..=11 => hz >> (divider - 7),
            divider @ 12.. => hz >> (divider - 6),
            _ => hz,
        }
    }

    fn pll_hz(&self) -> u64 {
        let word = self.registers.get(PLLCFGR);
        let source = if word & PLL_FROM_HSE != 0 { self.crystal_hz } else { HSI };
        let (m, n, p) = (u64::from(word & 63), u64::from(word >> 6 & 511), u64::from(word >> 16 & 3) * 2 + 2);
        source / m.max(1) * n / p
    }

    /// Where the dividers of APB1 and APB2 are in RCC_CFGR.
    fn dividers(&self) -> [u32; 2] {
        match self.model {
            Model::F405 => [10, 13],
            Model::G474 => [8, 11],
        }
    }

    /// Rates of the peripherals' clocks at APB1 and APB2, 1/s.
    pub fn peripheral_hz(&self) -> [u64; 2] {
        self.dividers().map(|shift| match self.registers.get(CFGR) >> shift & 7 {
            divider @ 4.. => self.core_hz() >> (divider - 3),
            _ => self.core_hz(),
        })
    }

    /// Rates of the timers' clocks, 1/s: double where the bus is divided.
    pub fn timer_hz(&self) -> [u64; 2] {
        let divided = self.dividers().map(|shift| self.registers.get(CFGR) >> shift & 7 >= 4);
        let [first, second] = self.peripheral_hz();
        [if divided[0] { 2 * first } else { first }, if divided[1] { 2 * second } else { second }]
    }

    /// The slow internal oscillator has been switched on: LSION of RCC_CSR.
    pub fn slow_runs(&self) -> bool {
        self.registers.has(if self.model == Model::G474 { g4::CSR } else { CSR }, 1)
    }

    /// Whether the clock of the peripheral at `base` is on.
    pub fn clocks(&self, base: u32) -> bool {
        if self.model == Model::G474 {
            return self.clocks_g4(base);
        }
        let (offset, bit) = match base {
            0x4000_0000..=0x4000_0C00 => (0x40, base >> 10 & 31),
            0x4000_3800 => (0x40, 14),
            0x4000_7000 => (0x40, 28),
            0x4001_0400 => (0x44, 1),
            0x4001_1000 => (0x44, 4),
            0x4001_2000 => (0x44, 8),
            0x4001_3000 => (0x44, 12),
            0x4001_3800 => (0x44, 14),
            0x4002_0000..=0x4002_2000 => (0x30, base >> 10 & 15),
            0x4002_3000 => (0x30, 12),
            0x4002_4000 => (0x30, 18),
            0x4002_6000 => (0x30, 21),
            0x4002_6400 => (0x30, 22),
            _ => return true,
        };
        self.registers.has(offset, 1 << bit)
    }

    /// A load.
    pub fn read(&self, offset: u32, now: u64) -> u32 {
        let word = self.registers.get(offset);
        match offset {
            CR => {
                let crystal = if self.crystal_runs(now) { HSE_READY } else { 0 };
                let pll = if self.pll_at.is_some_and(|at| now >= at) { PLL_READY } else { 0 };
                word | crystal | pll
            }
            _ => word,
        }
    }

    /// A store. Gives the base of a peripheral that is reset by it, if one is.
    pub fn write(&mut self, offset: u32, value: u32, now: u64) -> Option<u32> {
        match offset {
            CR => {
                let (lock, read_only, internal) = match self.model {
                    Model::F405 => (LOCK, 2, (value & 1) << 1),
                    Model::G474 => (g4::LOCK, 0, g4::HSI_RUNS),
                };
                let starts = |on: u32, at: Option<u64>, time: u64| (value & on != 0).then(|| at.unwrap_or(now + time));
                self.crystal_at = starts(HSE_ON, self.crystal_at, CRYSTAL_START);
                self.pll_at = starts(PLL_ON, self.pll_at, lock);
                self.registers.set(CR, value & !(HSE_READY | PLL_READY | read_only) | internal);
            }
            CFGR => {
                let wanted = value & 3;
                let locked = self.pll_at.is_some_and(|at| now >= at);
                let ready = match (self.model, wanted) {
                    (Model::F405, 1) | (Model::G474, 2) => self.crystal_runs(now),
                    (Model::F405, 2..) => locked,
                    (Model::G474, 3) => locked && self.registers.has(g4::PLLCFGR, g4::PLL_R_ON),
                    _ => true,
                };
                let current = if ready { wanted } else { self.registers.get(CFGR) >> 2 & 3 };
                self.registers.set(CFGR, value & !0xC | current << 2);
            }
            _ if self.model == Model::G474 => return self.write_g4(offset, value),
            CIR if value & CSS_CLEAR != 0 => self.registers.set(CIR, value & !(CSS_CLEAR | CSS_FLAG)),
            CSR => {
                let flags = if value & 1 << 24 != 0 { 0 } else { self.registers.get(CSR) & 0xFE00_0000 };
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

    /// The crystal stops. Whether the clock security system has seen it, which then has changed to the internal oscillator.
    pub fn crystal_stops(&mut self) -> bool {
        self.crystal = false;
        let seen = self.registers.has(CR, CSS_ON | HSE_ON);
        if seen {
            self.registers.set(CR, self.registers.get(CR) & !(HSE_ON | PLL_ON | CSS_ON));
            let (internal, flags, flag) = match self.model {
                Model::F405 => (0, CIR, CSS_FLAG),
                Model::G474 => (g4::FROM_HSI, g4::CIFR, g4::CSS_FLAG),
            };
            self.registers.set(CFGR, self.registers.get(CFGR) & !0xF | internal);
            self.registers.set(flags, self.registers.get(flags) | flag);
            (self.crystal_at, self.pll_at) = (None, None);
        }
        seen
    }
}

/// The peripheral behind a bit of a reset register, of those that are modelled.
fn reset_base(offset: u32, bit: u32) -> Option<u32> {
    Some(match (offset, bit) {
        (0x10, 0..=8) => 0x4002_0000 + 0x400 * bit,
        (0x10, 21) => 0x4002_6000,
        (0x10, 22) => 0x4002_6400,
        (0x20, 0..=3) => 0x4000_0000 + 0x400 * bit,
        (0x20, 14) => 0x4000_3800,
        (0x24, 1) => 0x4001_0400,
        (0x24, 4) => 0x4001_1000,
        (0x24, 8) => 0x4001_2000,
        (0x24, 12) => 0x4001_3000,
        _ => return None,
    })
}
