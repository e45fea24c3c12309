//! The unit that computes CRC-32 (RM0090 section 4).

/// The unit.
#[derive(Clone, Copy, Debug)]
pub struct CrcUnit(u32);

impl Default for CrcUnit {
    fn default() -> CrcUnit {
        CrcUnit(u32::MAX)
    }
}

impl CrcUnit {
    /// A load.
    pub fn read(&self, offset: u32) -> u32 {
        if offset == 0 { self.0 } else { 0 }
    }

    /// A store: a word into DR, or a reset by CR.
    pub fn write(&mut self, offset: u32, value: u32) {
        match offset {
            0 => {
                self.0 ^= value;
                for _ in 0..32 {
                    self.0 = self.0 << 1 ^ if self.0 >> 31 == 1 { 0x04C1_1DB7 } else { 0 };
                }
            }
            8 if value & 1 == 1 => self.0 = u32::MAX,
            _ => {}
        }
    }
}
