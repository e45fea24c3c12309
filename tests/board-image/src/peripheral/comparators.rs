//! COMP1 and COMP3 of a G4 with DAC3 at their other inputs (RM0440, COMP and DAC), which look at the coils' currents.

use super::converter::COUNTS_PER_AMPERE;
use super::registers::Registers;

/// Of COMP, from SYSCFG's base: COMP1 and COMP3.
const COMPARATORS: [u32; 2] = [0x200, 0x208];
/// Their number.
const NUMBERS: [u32; 2] = [1, 3];
/// EN, INMSEL and INPSEL.
const SELECTED: u32 = 1 | 7 << 4 | 1 << 8;
/// On, channel 1 of DAC3 against PA1 (COMP1) and PC1 (COMP3).
const WANTED: [u32; 2] = [1 | 4 << 4, 1 | 4 << 4 | 1 << 8];

/// Of DAC3.
const CR: u32 = 0x00;
const DHR12R1: u32 = 0x08;
const DOR1: u32 = 0x2C;
const MCR: u32 = 0x3C;
/// Channel 1 to the chip's own parts, without the buffer; a bus above 160 MHz.
const INSIDE: u32 = 2 << 14 | 3;

/// Both, and what they compare with.
#[derive(Clone, Debug, Default)]
pub struct Comparators {
    /// SYSCFG and COMP.
    pub registers: Registers,
    source: Registers,
}

impl Comparators {
    /// Registers as after a reset.
    pub fn reset(&mut self) {
        *self = Comparators::default();
    }

    /// The comparator that looks at a coil, from 1 on, and the current from which its output is high, A.
    pub fn level(&self, coil: usize) -> Option<(u32, f64)> {
        let compares = self.registers.get(COMPARATORS[coil]) & SELECTED == WANTED[coil];
        let source = self.source.has(CR, 1) && self.source.get(MCR) & (3 << 14 | 7) == INSIDE;
        (compares && source).then(|| (NUMBERS[coil], f64::from(self.source.get(DHR12R1) & 0xFFF) / COUNTS_PER_AMPERE))
    }

    /// A load from DAC3.
    pub fn read_source(&self, offset: u32) -> u32 {
        self.source.get(if offset == DOR1 { DHR12R1 } else { offset })
    }

    /// A store to DAC3.
    pub fn write_source(&mut self, offset: u32, value: u32) {
        self.source.set(offset, value);
    }
}
