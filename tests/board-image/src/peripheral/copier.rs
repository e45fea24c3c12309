//! Stream 2 of DMA1, asked by TIM3's updates (RM0090 section 10): copies a half word from a register into the memory, on and on.
//!
//! Taken to copy whenever the register changes, which is up to a period of TIM3 earlier than it does.

use super::registers::Registers;
use crate::engine::Memory;

/// Offsets of stream 2's registers.
const CR: u32 = 0x10 + 0x18 * 2;
const PAR: u32 = CR + 0x08;
const M0AR: u32 = CR + 0x0C;
/// Channel 5, circular, enabled.
const ASKED_BY_TIM3: u32 = 5 << 25 | 1 << 8 | 1;

/// The stream.
#[derive(Clone, Debug, Default)]
pub struct Copier(Registers);

impl Copier {
    /// Registers as after a reset.
    pub fn reset(&mut self) {
        *self = Copier::default();
    }

    /// The register at `address` has become `value`, while TIM3 asks or not.
    pub fn changed(&self, address: u32, value: u32, asked: bool, memory: &Memory) {
        if asked && self.0.has(CR, ASKED_BY_TIM3) && self.0.get(PAR) == address {
            memory.write(self.0.get(M0AR), &value.to_le_bytes()[..2]);
        }
    }

    /// The same of channel 1 of a G4's DMA1 (RM0440, DMA), whose multiplexer leads request 65 to it: TIM3's update.
    pub fn changed_g4(&self, address: u32, value: u32, asked: bool, request: u32, memory: &Memory) {
        // CIRC, MSIZE and PSIZE of 16 bits, EN.
        if asked && request == 65 && self.0.has(0x08, 1 << 10 | 1 << 8 | 1 << 5 | 1) && self.0.get(0x10) == address {
            memory.write(self.0.get(0x14), &value.to_le_bytes()[..2]);
        }
    }

    /// A load.
    pub fn read(&self, offset: u32) -> u32 {
        self.0.get(offset)
    }

    /// A store.
    pub fn write(&mut self, offset: u32, value: u32) {
        self.0.set(offset, value);
    }
}
