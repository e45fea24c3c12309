//! The flash and its controller (RM0090 section 3): one MiB in twelve sectors.
//!
//! The processor runs from the flash, so it stands while the flash erases or programs. Programming only takes bits from 1 to 0. What is cut
//! short by a reset or by the supply is left half done: of a sector being erased some cells are erased and some are not, of a word being
//! programmed some bits are.

pub mod g4;

use super::registers::Registers;
use crate::engine::Memory;
use crate::model::Model;
use crate::random::Random;
use crate::time::{microseconds, milliseconds};

/// First address.
pub const START: u32 = 0x0800_0000;

const KEYR: u32 = 0x04;
const OPTKEYR: u32 = 0x08;
const SR: u32 = 0x0C;
/// Offset of FLASH_CR.
pub const CR: u32 = 0x10;
/// Offset of FLASH_OPTCR.
pub const OPTCR: u32 = 0x14;

const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];
const OPTION_KEYS: [u32; 2] = [0x0819_2A3B, 0x4C5D_6E7F];

const PROGRAM: u32 = 1;
const SECTOR_ERASE: u32 = 2;
const START_BIT: u32 = 1 << 16;
const LOCK: u32 = 1 << 31;
const OPTION_LOCK: u32 = 1;
const OPTION_START: u32 = 2;
const WRITE_PROTECTED: u32 = 1 << 4;
const PARALLELISM_ERROR: u32 = 1 << 6;
const SEQUENCE_ERROR: u32 = 1 << 7;

/// RDP of a flash that a probe may read, and of one that it never may again.
const OPEN: u32 = 0xAA;
const FOR_EVER: u32 = 0xCC;

/// Option bytes of a new chip: no protection, brown-out reset off.
const NEW_OPTIONS: u32 = 0x0FFF_AAEC;

/// How long the flash takes (DS8626, table 45).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Typical times.
    Typical,
    /// The longest.
    Slowest,
}

/// What a store starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// A sector, by its number.
    Erase(u32),
    /// So many bytes from an address on.
    Program(u32, u32, u32),
    /// The page of a G4 at an address.
    ErasePage(u32),
    /// A double word of a G4 at an address.
    ProgramDouble(u32, u64),
    /// The option bytes.
    Options(u32),
}

/// Flash and controller.
#[derive(Clone, Debug)]
pub struct Flash {
    model: Model,
    banks: g4::Banks,
    /// What it holds.
    pub memory: Memory,
    registers: Registers,
    options: u32,
    unlocked: usize,
    options_unlocked: usize,
    /// How long it takes.
    pub pace: Pace,
    /// Every erasing, programming and writing of options so far.
    pub works: Vec<Work>,
    /// So many works from now on the next one is cut short by the supply.
    pub cut_after: Option<usize>,
    random: Random,
}

impl Flash {
    /// A new chip.
    pub fn new(model: Model) -> Flash {
        let memory = Memory::new(START, model.flash_length() as usize, 0xFF);
        let (options, pace, random) = (NEW_OPTIONS, Pace::Typical, Random::new(405));
        let mut flash = Flash {
            model,
            banks: g4::Banks::default(),
            memory,
            registers: Registers::default(),
            options,
            unlocked: 0,
            options_unlocked: 0,
            pace,
            works: Vec::new(),
            cut_after: None,
            random,
        };
        flash.reset();
        flash
    }

    /// Registers as after a reset.
    pub fn reset(&mut self) {
        (self.unlocked, self.options_unlocked) = (0, 0);
        match self.model {
            Model::F405 => self.registers = Registers::of(&[(CR, LOCK), (OPTCR, self.options | OPTION_LOCK)]),
            Model::G474 => self.reset_g4(),
        }
    }

    /// Level of the brown-out reset, V, if it is on.
    pub fn brown_out(&self) -> Option<f64> {
        if self.model == Model::G474 {
            return self.brown_out_g4();
        }
        [Some(2.83), Some(2.53), Some(2.23), None][(self.options >> 2 & 3) as usize]
    }

    /// A load from the controller.
    pub fn read(&self, offset: u32) -> u32 {
        if self.model == Model::G474 {
            return self.read_g4(offset);
        }
        match offset {
            KEYR | OPTKEYR => 0,
            _ => self.registers.get(offset),
        }
    }

    /// A store to the controller, and what work it starts.
    pub fn write(&mut self, offset: u32, value: u32) -> Option<Work> {
        if self.model == Model::G474 {
            return self.write_g4(offset, value);
        }
        match offset {
            KEYR => {
                self.unlocked = if KEYS.get(self.unlocked) == Some(&value) { self.unlocked + 1 } else { usize::MAX };
                if self.unlocked == KEYS.len() {
                    self.registers.set(CR, self.registers.get(CR) & !LOCK);
                }
            }
            OPTKEYR => {
                let next = OPTION_KEYS.get(self.options_unlocked) == Some(&value);
                self.options_unlocked = if next { self.options_unlocked + 1 } else { usize::MAX };
                if self.options_unlocked == OPTION_KEYS.len() {
                    self.registers.set(OPTCR, self.registers.get(OPTCR) & !OPTION_LOCK);
                }
            }
            SR => self.registers.set(SR, self.registers.get(SR) & !value),
            CR if self.registers.has(CR, LOCK) => {}
            CR => {
                if value & LOCK != 0 {
                    self.unlocked = 0;
                }
                self.registers.set(CR, value & !START_BIT);
                if value & (START_BIT | SECTOR_ERASE) == START_BIT | SECTOR_ERASE {
                    let sector = value >> 3 & 15;
                    if self.writable(sector) {
                        return Some(Work::Erase(sector));
                    }
                    self.registers.set(SR, self.registers.get(SR) | WRITE_PROTECTED);
                }
            }
            OPTCR if self.registers.has(OPTCR, OPTION_LOCK) => {}
            OPTCR => {
                if value & OPTION_LOCK != 0 {
                    self.options_unlocked = 0;
                }
                self.registers.set(OPTCR, value & !OPTION_START);
                if value & OPTION_START != 0 {
                    return Some(Work::Options(value));
                }
            }
            _ => self.registers.set(offset, value),
        }
        None
    }

    /// A store to the flash itself, and what work it starts.
    pub fn store(&mut self, address: u32, size: u32, value: u32) -> Option<Work> {
        if self.model == Model::G474 {
            return self.store_g4(address, size, value);
        }
        let width = 1 << (self.registers.get(CR) >> 8 & 3);
        let error = if self.registers.has(CR, LOCK) || !self.registers.has(CR, PROGRAM) {
            SEQUENCE_ERROR
        } else if size != width {
            PARALLELISM_ERROR
        } else if !self.writable(sector_of(address)) {
            WRITE_PROTECTED
        } else {
            return Some(Work::Program(address, size, value));
        };
        self.registers.set(SR, self.registers.get(SR) | error);
        None
    }

    /// Whether a sector of an F4 may be erased and programmed: its nWRP.
    fn writable(&self, sector: u32) -> bool {
        self.options >> (16 + sector) & 1 == 1
    }

    /// RDP of option bytes.
    fn reading(&self, options: u32) -> u32 {
        options >> if self.model == Model::G474 { 0 } else { 8 } & 0xFF
    }

    /// What a probe reads, where the protection in force lets it.
    pub fn by_probe(&self, address: u32) -> Option<u32> {
        (self.reading(self.options) == OPEN).then(|| self.memory.word(address))
    }

    /// Takes new option bytes over: level 2 is for ever, and going back to no protection erases everything.
    fn adopt(&mut self, options: u32) {
        let (before, after) = (self.reading(self.options), self.reading(options));
        if before == FOR_EVER {
            return;
        }
        if before != OPEN && after == OPEN {
            let blank = vec![0xFF; self.model.flash_length() as usize];
            self.memory.write(START, &blank);
        }
        self.options = options;
    }

    /// How long a work takes.
    pub fn duration(&self, work: Work) -> u64 {
        if self.model == Model::G474 {
            return self.duration_g4(work);
        }
        let slow = self.pace == Pace::Slowest;
        match work {
            Work::Program(..) => microseconds(if slow { 100 } else { 16 }),
            Work::Options(_) => milliseconds(if slow { 20 } else { 10 }),
            Work::ProgramDouble(..) | Work::ErasePage(_) => 0,
            Work::Erase(sector) => {
                // By the parallelism: of 16 KiB, of 64 KiB, of 128 KiB; typical times, of which the longest are twice.
                let parallelism = (self.registers.get(CR) >> 8 & 3) as usize;
                let row = match sector {
                    0..4 => [400, 300, 250, 250],
                    4 => [1200, 700, 550, 550],
                    _ => [2000, 1300, 1000, 1000],
                };
                milliseconds(row[parallelism] * if slow { 2 } else { 1 })
            }
        }
    }

    /// Notes a work that begins. Whether the supply cuts it short.
    pub fn begin(&mut self, work: Work) -> bool {
        self.works.push(work);
        let cut = self.cut_after == Some(0);
        self.cut_after = self.cut_after.and_then(|left| left.checked_sub(1));
        cut
    }

    /// Does a work, or half of it where it is cut short.
    pub fn finish(&mut self, work: Work, cut: bool) {
        match work {
            Work::Program(address, size, value) => {
                for (address, byte) in (address..).zip(value.to_le_bytes()).take(size as usize) {
                    let mut old = [0];
                    self.memory.read(address, &mut old);
                    let missed = if cut { self.random.byte() } else { 0 };
                    self.memory.write(address, &[old[0] & (byte | missed)]);
                }
            }
            Work::Erase(sector) => {
                let (start, length) = sector_range(sector);
                for address in start..start + length {
                    let mut old = [0];
                    self.memory.read(address, &mut old);
                    let reached = if cut { self.random.byte() } else { 0xFF };
                    self.memory.write(address, &[old[0] | reached]);
                }
            }
            Work::ProgramDouble(address, double) => self.finish_double(address, double, cut),
            Work::ErasePage(page) => self.finish_page(page, cut),
            Work::Options(_) if cut => {}
            Work::Options(value) if self.model == Model::G474 => self.finish_options(value),
            Work::Options(value) => self.adopt(value & 0x0FFF_FFEC),
        }
    }

    /// A copy of the settings, 0 or 1, is half erased.
    pub fn half_erase_copy(&mut self, copy: u32) {
        match self.model {
            Model::F405 => self.finish(Work::Erase(1 + copy), true),
            Model::G474 => {
                let pages: Vec<u32> = Flash::pages_of_copy(copy).collect();
                pages[..7].iter().for_each(|page| self.finish(Work::ErasePage(*page), false));
                self.finish(Work::ErasePage(pages[7]), true);
            }
        }
    }

    /// The words of the settings at an offset, as the program's store sees them.
    pub fn settings(&self, offset: u32, bytes: &mut [u8]) {
        for (offset, word) in (offset..).step_by(4).zip(bytes.chunks_mut(4)) {
            let place = match self.model {
                Model::F405 => sector_range(1).0 + offset,
                Model::G474 => Flash::place_of_setting(offset),
            };
            self.memory.read(place, word);
        }
    }

    /// The host programs words of the settings, or blank ones.
    pub fn set_settings(&mut self, offset: u32, bytes: &[u8]) {
        if self.model == Model::F405 {
            return self.memory.write(sector_range(1).0 + offset, bytes);
        }
        for (offset, bytes) in (offset..).step_by(4).zip(bytes.chunks_exact(4)) {
            let word = bytes.iter().rev().fold(0, |word, byte| word << 8 | u64::from(*byte));
            let blank = word == u64::from(u32::MAX);
            self.put(Flash::place_of_setting(offset), if blank { u64::MAX } else { !word << 32 | word });
        }
    }
}

/// Number of the sector that has `address`.
pub fn sector_of(address: u32) -> u32 {
    let offset = address - START;
    match offset >> 14 {
        number @ 0..4 => number,
        4..8 => 4,
        _ => 4 + (offset >> 17),
    }
}

/// First address and bytes of a sector.
pub fn sector_range(sector: u32) -> (u32, u32) {
    match sector {
        0..4 => (START + 0x4000 * sector, 0x4000),
        4 => (START + 0x1_0000, 0x1_0000),
        _ => (START + 0x2_0000 * (sector - 4), 0x2_0000),
    }
}
