//! Where the registers of a G4 are (RM0440, memory map), beside those that an F4 has, too.

use super::Chip;
use crate::peripheral::flash::g4::BANK_2;
use crate::peripheral::processor::NMI;
use crate::peripheral::rcc::Cause;

/// The first of TAMP's backup registers, and that of an F4's RTC, from their bases.
const BACKUP: u32 = 0x100;
const BACKUP_OF_F4: u32 = 0x50;

impl Chip {
    /// A load of the processor's from the flash that is not mapped: bank 2, which waits for what is done there.
    pub(super) fn load_checked(&mut self, address: u32, bytes: &mut [u8]) {
        if let Some(at) = self.flash.ends() {
            self.pass(at.saturating_sub(self.now));
        }
        debug_assert!(address >= BANK_2);
        if self.flash.load_checked(address, bytes) {
            self.private.pend(NMI);
        }
    }

    pub(super) fn load_g4(&mut self, address: u32) -> u32 {
        let (base, offset) = (address & !0x3FF, address & 0x3FC);
        match address {
            // Number of the chip, and its flash in KiB.
            0x1FFF_7590..0x1FFF_759C => return 0x0047_0000 | address & 15,
            0x1FFF_75E0 => return 512,
            _ => {}
        }
        match base {
            0x4000_2400 if offset >= BACKUP => self.backup.read(offset - BACKUP + BACKUP_OF_F4),
            0x4001_0000 => self.comparators.registers.get(offset),
            0x4001_0400 => self.supply.read_lines(offset),
            0x4001_3400 => {
                self.advance_coils();
                self.modulation.read(offset)
            }
            0x4001_3800 => self.line.read(offset),
            // Channel 1 copies the encoder's count, 2 and 3 are the line's.
            0x4002_0000 if (0x08..0x18).contains(&offset) => self.copier.read(offset),
            0x4002_0000 => self.line.read_stream(offset, &self.ram, self.now),
            0x4002_0800 => self.line.multiplexer.get(offset),
            0x4002_1000 => self.rcc.read(offset, self.now),
            0x4002_2000 => self.flash.read(offset),
            0x4800_0000..=0x4800_1800 => self.ports[(base >> 10 & 15) as usize].read(offset),
            0x5000_0000 if offset >= 0x300 => self.converters.get(offset),
            0x5000_0000 => {
                self.advance_coils();
                self.converter.read_g4(offset, self.converted_from())
            }
            0x5000_1000 => self.comparators.read_source(offset),
            _ => self.nobody(address),
        }
    }

    pub(super) fn store_g4(&mut self, address: u32, value: u32) {
        let (base, offset) = (address & !0x3FF, address & 0x3FC);
        match base {
            0x4000_2400 if offset >= BACKUP => {
                self.backup.write(offset - BACKUP + BACKUP_OF_F4, value, self.supply.backup_writable());
            }
            0x4001_0000 => {
                self.advance_coils();
                self.comparators.registers.set(offset, value);
            }
            0x4001_0400 => {
                self.supply.write_lines(offset, value);
                self.pend_detector();
            }
            0x4001_3400 => {
                self.advance_coils();
                let clock = self.timer_hz[1];
                self.modulation.write(offset, value, clock, self.now);
            }
            0x4001_3800 => self.line.write(offset, value),
            0x4002_0000 if (0x08..0x18).contains(&offset) => self.copier.write(offset, value),
            0x4002_0000 => self.line.write_stream(offset, value, &self.ram, self.peripheral_hz[1], self.now),
            0x4002_0800 => self.line.multiplexer.set(offset, value),
            0x4002_1000 => {
                if let Some(base) = self.rcc.write(offset, value, self.now) {
                    self.reset_peripheral_g4(base);
                }
                self.clock_changed();
            }
            0x4002_2000 => {
                let work = self.flash.write(offset, value);
                self.work(work);
                if self.flash.take_reload() {
                    self.reset = Some(Cause::OptionReload);
                }
            }
            0x4800_0000..=0x4800_1800 => {
                self.advance_coils();
                self.ports[(base >> 10 & 15) as usize].write(offset, value);
                self.select_sensors();
            }
            0x5000_0000 if offset >= 0x300 => self.converters.set(offset, value),
            0x5000_0000 => self.converter.write_g4(offset, value),
            0x5000_1000 => {
                self.advance_coils();
                self.comparators.write_source(offset, value);
            }
            _ => _ = self.nobody(address),
        }
    }

    fn reset_peripheral_g4(&mut self, base: u32) {
        match base {
            0x4001_3400 => self.modulation.reset(),
            0x4001_3800 => self.line.reset(),
            0x4800_0000..=0x4800_1800 => {
                let index = base >> 10 & 15;
                self.ports[index as usize].reset(self.model, index);
            }
            // The others are where those of an F4 are.
            _ => self.reset_peripheral(base),
        }
    }
}
