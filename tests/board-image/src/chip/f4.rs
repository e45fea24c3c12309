//! Where the registers of an F4 are (RM0090, section 2.3), beside those that a G4 has, too.

use super::Chip;

impl Chip {
    pub(super) fn load_f4(&mut self, address: u32) -> u32 {
        let (base, offset) = (address & !0x3FF, address & 0x3FC);
        match address {
            // Number of the chip, and its flash in KiB.
            0x1FFF_7A10..0x1FFF_7A1C => return 0x0042_0000 | address & 15,
            0x1FFF_7A20 => return 1024 << 16,
            _ => {}
        }
        match base {
            0x4000_2800 => self.backup.read(offset),
            0x4001_0400 => {
                self.advance_coils();
                self.modulation.read(offset)
            }
            0x4001_1000 => self.line.read(offset),
            0x4001_2000 if offset >= 0x300 => self.converters.get(offset),
            0x4001_2000 => {
                self.advance_coils();
                let value = self.converter.read(offset, self.converted_from());
                if let Some(coil) = self.converter.coil(offset) {
                    self.converted[coil] = value;
                }
                value
            }
            0x4001_3C00 => self.supply.read_lines(offset),
            0x4002_0000..=0x4002_2000 => self.ports[(base >> 10 & 15) as usize].read(offset),
            0x4002_3800 => self.rcc.read(offset, self.now),
            0x4002_3C00 => self.flash.read(offset),
            0x4002_4000..0x4002_5000 => self.backup.load(address & 0xFFC),
            0x4002_6000 => self.copier.read(offset),
            0x4002_6400 => self.line.read_stream(offset, &self.ram, self.now),
            _ => self.nobody(address),
        }
    }

    pub(super) fn store_f4(&mut self, address: u32, value: u32) {
        let (base, offset) = (address & !0x3FF, address & 0x3FC);
        match base {
            0x4000_2800 => self.backup.write(offset, value, self.supply.backup_writable()),
            0x4001_0400 => {
                self.advance_coils();
                let clock = self.timer_hz[1];
                self.modulation.write(offset, value, clock, self.now);
            }
            0x4001_1000 => self.line.write(offset, value),
            0x4001_2000 if offset >= 0x300 => self.converters.set(offset, value),
            0x4001_2000 => self.converter.write(offset, value),
            0x4001_3C00 => {
                self.supply.write_lines(offset, value);
                self.pend_detector();
            }
            0x4002_0000..=0x4002_2000 => {
                self.advance_coils();
                self.ports[(base >> 10 & 15) as usize].write(offset, value);
                self.select_sensors();
            }
            0x4002_3800 => {
                if let Some(base) = self.rcc.write(offset, value, self.now) {
                    self.reset_peripheral(base);
                }
                self.clock_changed();
            }
            0x4002_3C00 => {
                let work = self.flash.write(offset, value);
                self.work(work);
            }
            0x4002_4000..0x4002_5000 => self.backup.store(address & 0xFFC, value, self.supply.backup_writable()),
            0x4002_6000 => self.copier.write(offset, value),
            0x4002_6400 => self.line.write_stream(offset, value, &self.ram, self.peripheral_hz[1], self.now),
            _ => _ = self.nobody(address),
        }
    }

    pub(super) fn reset_peripheral(&mut self, base: u32) {
        match base {
            0x4000_0000 => self.counters[0].reset(),
            0x4000_0400 => self.counters[1].reset(),
            0x4000_0C00 => self.counters[2].reset(),
            0x4000_0800 => self.encoder.reset(),
            0x4000_3800 => self.buses[1].reset(),
            0x4001_0400 => self.modulation.reset(),
            0x4001_1000 => self.line.reset(),
            0x4001_2000 => self.converter.reset(self.model),
            0x4001_3000 => self.buses[0].reset(),
            0x4002_6000 => self.copier.reset(),
            0x4002_6400 => self.line.reset_streams(),
            0x4002_0000..=0x4002_2000 => {
                let index = base >> 10 & 15;
                self.ports[index as usize].reset(self.model, index);
            }
            _ => {}
        }
    }
}
