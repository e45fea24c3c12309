//! PWR, its voltage detector and EXTI (RM0090 sections 5 and 12), and the supply of 3.3 V.

use super::registers::Registers;
use crate::model::Model;

/// Of PWR.
const CR: u32 = 0x00;
const CSR: u32 = 0x04;
const DETECTOR_ON: u32 = 1 << 4;
const BACKUP_WRITABLE: u32 = 1 << 8;
const LOW: u32 = 1 << 2;
/// Of PWR of a G4 (RM0440, PWR).
const CR2: u32 = 0x04;
const CR3: u32 = 0x08;
const SR2: u32 = 0x14;
const CR5: u32 = 0x80;
const LOW_G4: u32 = 1 << 11;
const REGULATOR_READY: u32 = 1 << 14;

/// Of EXTI.
const IMR: u32 = 0x00;
const RTSR: u32 = 0x08;
const FTSR: u32 = 0x0C;
const SWIER: u32 = 0x10;
const PR: u32 = 0x14;
/// Line of the detector.
const LINE: u32 = 16;

/// Of the detector by its level, V, falling (DS8626, table 24, typical); rising it is 0.1 V higher.
const LEVELS: [f64; 8] = [2.04, 2.19, 2.35, 2.51, 2.66, 2.82, 2.93, 3.03];

/// Likewise of a G4 (DS12288, typical).
const LEVELS_G4: [f64; 8] = [2.05, 2.20, 2.36, 2.52, 2.64, 2.79, 2.90, f64::INFINITY];

/// The supply and who watches it.
#[derive(Clone, Debug)]
pub struct Supply {
    model: Model,
    power: Registers,
    lines: Registers,
    volts: f64,
    low: bool,
    /// How often the program has asked whether it is low, since the reset.
    pub looks: u32,
}

impl Supply {
    /// Of 3.3 V.
    pub fn new(model: Model) -> Supply {
        let (power, lines) = match model {
            Model::F405 => (Registers::of(&[(CR, 0xC000)]), Registers::default()),
            Model::G474 => (Registers::of(&[(CR, 0x200), (CR3, 0x8000), (CR5, 0x100)]), Registers::of(&[(IMR, 0x1F84_0000)])),
        };
        Supply { model, power, lines, volts: 3.3, low: false, looks: 0 }
    }

    /// Registers as after a reset.
    pub fn reset(&mut self) {
        *self = Supply { volts: self.volts, ..Supply::new(self.model) };
    }

    /// Whether the detector is on, and at which level it looks, V.
    fn detector(&self) -> (bool, f64) {
        match self.model {
            Model::F405 => (self.power.has(CR, DETECTOR_ON), LEVELS[(self.power.get(CR) >> 5 & 7) as usize]),
            Model::G474 => (self.power.has(CR2, 1), LEVELS_G4[(self.power.get(CR2) >> 1 & 7) as usize]),
        }
    }

    /// V.
    pub fn volts(&self) -> f64 {
        self.volts
    }

    /// The supply becomes `volts`.
    pub fn set_volts(&mut self, volts: f64) {
        self.volts = volts;
        self.look();
    }

    /// Whether the backup domain may be written.
    pub fn backup_writable(&self) -> bool {
        self.power.has(CR, BACKUP_WRITABLE)
    }

    fn look(&mut self) {
        let (on, level) = self.detector();
        let level = if self.low { level + 0.1 } else { level };
        let low = on && self.volts < level;
        let edge = match (self.low, low) {
            (false, true) => RTSR,
            (true, false) => FTSR,
            _ => return,
        };
        self.low = low;
        if self.lines.has(edge, 1 << LINE) {
            self.lines.set(PR, self.lines.get(PR) | 1 << LINE);
        }
    }

    /// Whether the detector's line asks for its interrupt.
    pub fn interrupts(&self) -> bool {
        self.lines.get(PR) & self.lines.get(IMR) & 1 << LINE != 0
    }

    /// A load from PWR.
    pub fn read_power(&mut self, offset: u32) -> u32 {
        let state = if self.model == Model::G474 { SR2 } else { CSR };
        self.looks += u32::from(offset == state);
        match offset {
            SR2 if self.model == Model::G474 => {
                if self.low {
                    LOW_G4
                } else {
                    0
                }
            }
            CSR if self.model == Model::F405 => self.power.get(CSR) | REGULATOR_READY | if self.low { LOW } else { 0 },
            _ => self.power.get(offset),
        }
    }

    /// A store to PWR.
    pub fn write_power(&mut self, offset: u32, value: u32) {
        self.power.set(offset, value);
        self.look();
    }

    /// A load from EXTI.
    pub fn read_lines(&self, offset: u32) -> u32 {
        self.lines.get(offset)
    }

    /// A store to EXTI.
    pub fn write_lines(&mut self, offset: u32, value: u32) {
        match offset {
            PR => self.lines.set(PR, self.lines.get(PR) & !value),
            SWIER => self.lines.set(PR, self.lines.get(PR) | value),
            _ => self.lines.set(offset, value),
        }
    }
}
