//! What the backup domain keeps over every reset but the loss of all supplies: 20 registers of the RTC and 4 KiB of memory (RM0090
//! sections 26.3.14 and 2.3.1).

/// First of the RTC's backup registers, from the RTC's base.
const REGISTERS: u32 = 0x50;

/// Both.
#[derive(Clone, Debug)]
pub struct Backup {
    registers: [u32; 20],
    memory: Vec<u32>,
}

impl Default for Backup {
    fn default() -> Backup {
        Backup { registers: [0; 20], memory: vec![0; 1024] }
    }
}

impl Backup {
    /// A load from the RTC.
    pub fn read(&self, offset: u32) -> u32 {
        offset.checked_sub(REGISTERS).and_then(|place| self.registers.get(place as usize / 4)).copied().unwrap_or(0)
    }

    /// A store to the RTC; `writable` is DBP of PWR_CR.
    pub fn write(&mut self, offset: u32, value: u32, writable: bool) {
        let place = offset.checked_sub(REGISTERS).and_then(|place| self.registers.get_mut(place as usize / 4));
        if let (Some(place), true) = (place, writable) {
            *place = value;
        }
    }

    /// A load from the memory.
    pub fn load(&self, offset: u32) -> u32 {
        self.memory.get(offset as usize / 4).copied().unwrap_or(0)
    }

    /// A store to the memory.
    pub fn store(&mut self, offset: u32, value: u32, writable: bool) {
        if let (Some(place), true) = (self.memory.get_mut(offset as usize / 4), writable) {
            *place = value;
        }
    }
}
