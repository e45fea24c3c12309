//! IWDG, on an oscillator of its own (RM0090 section 21).

use crate::time::SECOND;

const KR: u32 = 0x00;
const PR: u32 = 0x04;
const RLR: u32 = 0x08;

/// The watchdog.
#[derive(Clone, Debug)]
pub struct Watchdog {
    prescaler: u32,
    reload: u32,
    writable: bool,
    /// When it resets the chip, once it runs.
    pub bites: Option<u64>,
    /// Feedings so far.
    pub fed: u64,
    /// Rate of its oscillator, 1/s: 17 to 47 kHz (DS8626, table 42).
    pub hz: u64,
}

impl Default for Watchdog {
    fn default() -> Watchdog {
        Watchdog { prescaler: 0, reload: 0xFFF, writable: false, bites: None, fed: 0, hz: 32_000 }
    }
}

impl Watchdog {
    /// As after a reset: it stands.
    pub fn reset(&mut self) {
        *self = Watchdog { hz: self.hz, ..Watchdog::default() };
    }

    /// How long it waits.
    pub fn patience(&self) -> u64 {
        let divider = 4 << self.prescaler.min(6);
        u64::from(self.reload + 1) * divider * SECOND / self.hz
    }

    /// A load.
    pub fn read(&self, offset: u32) -> u32 {
        match offset {
            PR => self.prescaler,
            RLR => self.reload,
            _ => 0,
        }
    }

    /// A store.
    pub fn write(&mut self, offset: u32, value: u32, now: u64) {
        match (offset, value & 0xFFFF) {
            (KR, 0x5555) => self.writable = true,
            (KR, 0xCCCC) => self.bites = Some(now + self.patience()),
            (KR, 0xAAAA) => {
                self.fed += 1;
                self.writable = false;
                self.bites = self.bites.map(|_| now + self.patience());
            }
            (KR, _) => self.writable = false,
            (PR, value) if self.writable => self.prescaler = value & 7,
            (RLR, value) if self.writable => self.reload = value & 0xFFF,
            _ => {}
        }
    }
}
