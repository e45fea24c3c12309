//! The program on the chip: its blocks of instructions, its loads and stores, and the time that they take.

use super::{Chip, LENGTHS};
use crate::engine::{Guest, Processor};
use crate::model::Model;
use crate::peripheral::processor::IDLE;

/// Half cycles that an instruction takes, as an estimate: most take one cycle, loads and taken branches two or three, divisions and
/// square roots fourteen.
const HALF_CYCLES_PER_INSTRUCTION: u64 = 3;

/// Blocks that the trail goes back.
const TRAIL: usize = 32;

impl Chip {
    /// Whether the processor shall stop before the next block.
    fn stops(&self, processor: &Processor) -> bool {
        if self.reset.is_some() || self.now >= self.until {
            return true;
        }
        self.private.waits() && self.private.next(self.active).is_some() && self.private.next(self.threshold(processor)).is_some()
    }

    /// A stuck bit is as it always is.
    fn stick(&self) {
        let Some(stuck) = self.stuck_bit else { return };
        let mut byte = [0];
        self.ram.read(stuck.address, &mut byte);
        let mask = 1 << stuck.bit;
        self.ram.write(stuck.address, &[if stuck.set { byte[0] | mask } else { byte[0] & !mask }]);
    }

    /// Instructions between `address` and `address + size`.
    fn length(&mut self, address: u32, size: u32) -> u64 {
        let place = (address >> 1) as usize % LENGTHS;
        let (known, length, count) = self.lengths[place];
        if (known, length) == (address, size) {
            return count.into();
        }
        let count = self.instructions_of(address, size).count() as u32;
        self.lengths[place] = (address, size, count);
        count.into()
    }

    /// Addresses of the instructions of a block: those that begin with 0b11101 to 0b11111 have two half words.
    pub fn instructions_of(&self, address: u32, size: u32) -> impl Iterator<Item = u32> {
        let memory = if self.ram.contains(address) { &self.ram } else { &self.flash.memory };
        let within = move |place: &u32| place.wrapping_sub(address) < size && memory.contains(*place);
        let next = move |place: &u32| {
            let mut half = [0; 2];
            memory.read(*place, &mut half);
            Some(place + if half[1] >> 3 >= 0b11101 { 4 } else { 2 }).filter(within)
        };
        std::iter::successors(Some(address).filter(within), next)
    }
}

/// The address and bit behind an address at which single bits of registers can be reached.
fn bit_band(address: u32) -> Option<(u32, u32)> {
    (0x4200_0000..0x4400_0000).contains(&address).then(|| {
        let offset = address - 0x4200_0000;
        (0x4000_0000 + (offset >> 7 << 2), offset >> 2 & 31)
    })
}

impl Guest for Chip {
    fn read(&mut self, address: u32, size: u32) -> u32 {
        if let Some((word, bit)) = bit_band(address) {
            return self.load(word) >> bit & 1;
        }
        if self.ram.contains(address) {
            let mut bytes = [0; 4];
            self.ram.read(address, &mut bytes[..size as usize]);
            return u32::from_le_bytes(bytes);
        }
        if self.flash.memory.contains(address) {
            let mut bytes = [0; 4];
            match self.model {
                Model::F405 => self.flash.memory.read(address, &mut bytes[..size as usize]),
                Model::G474 => self.load_checked(address, &mut bytes[..size as usize]),
            }
            return u32::from_le_bytes(bytes);
        }
        let word = self.load(address & !3) >> (8 * (address & 3));
        if size == 4 { word } else { word & ((1 << (8 * size)) - 1) }
    }

    fn write(&mut self, address: u32, size: u32, value: u32) {
        if let Some((word, bit)) = bit_band(address) {
            let old = self.load(word);
            return self.store(word, old & !(1 << bit) | (value & 1) << bit);
        }
        if self.ram.contains(address) {
            self.ram.write(address, &value.to_le_bytes()[..size as usize]);
            return self.stick();
        }
        if self.flash.memory.contains(address) {
            let work = self.flash.store(address, size, value);
            return self.work(work);
        }
        // Data registers and the watchdog's keys take what is written as it is; of others the rest of the word stays.
        let whole = size == 4 || matches!(address & !3, 0x4001_300C | 0x4000_380C);
        if whole {
            return self.store(address & !3, value);
        }
        let shift = 8 * (address & 3);
        let mask = ((1 << (8 * size)) - 1) << shift;
        let old = self.load(address & !3);
        self.store(address & !3, old & !mask | value << shift & mask);
    }

    fn block(&mut self, processor: &Processor, address: u32, size: u32) -> bool {
        // The first block since the processor continued is carried out in any case: whoever asks for steps gets on.
        if !std::mem::take(&mut self.continues) && self.stops(processor) {
            return true;
        }
        if self.trail.len() == TRAIL {
            self.trail.pop_front();
        }
        self.trail.push_back(address);
        let instructions = self.length(address, size);
        self.instructions += instructions;
        if let Some(profile) = self.profile.as_mut().filter(|_| self.active != IDLE) {
            *profile.entry((address, size)).or_default() += 1;
        }
        self.pass_cycles(HALF_CYCLES_PER_INSTRUCTION * instructions);
        false
    }

    fn returned(&mut self) {
        self.returned = true;
    }

    fn stuck(&mut self, address: Option<u32>) {
        self.stuck = Some(address);
        self.faults.push(address);
        self.private.fault(address);
    }
}
