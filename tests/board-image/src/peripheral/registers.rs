//! Registers that only keep what is written to them, by their offset in the block.

/// A block of a KiB.
#[derive(Clone, Debug)]
pub struct Registers(Vec<u32>);

impl Default for Registers {
    fn default() -> Registers {
        Registers(vec![0; 256])
    }
}

impl Registers {
    /// All 0 but for these.
    pub fn of(values: &[(u32, u32)]) -> Registers {
        let mut registers = Registers::default();
        for &(offset, value) in values {
            registers.set(offset, value);
        }
        registers
    }

    /// What the register at `offset` holds.
    pub fn get(&self, offset: u32) -> u32 {
        self.0[(offset as usize & 0x3FF) / 4]
    }

    /// Has it hold `value`.
    pub fn set(&mut self, offset: u32, value: u32) {
        self.0[(offset as usize & 0x3FF) / 4] = value;
    }

    /// Whether all bits of `mask` are set in it.
    pub fn has(&self, offset: u32, mask: u32) -> bool {
        self.get(offset) & mask == mask
    }
}
