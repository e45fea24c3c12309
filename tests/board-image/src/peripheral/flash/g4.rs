//! The flash of the G4 and its controller (RM0440, FLASH): two banks of 128 pages of 2 KiB, of double words with eight check bits each.
//!
//! The processor runs from bank 1, so that work in bank 2 holds up nothing but loads from bank 2.

use super::super::registers::Registers;
use super::{Flash, KEYS, OPTION_KEYS, Pace, START, WRITE_PROTECTED, Work};
use crate::model::Model;

const KEYR: u32 = 0x08;
const OPTKEYR: u32 = 0x0C;
const SR: u32 = 0x10;
const CR: u32 = 0x14;
const ECCR: u32 = 0x18;
const OPTR: u32 = 0x20;
const WRP1AR: u32 = 0x2C;

const PROGRAM: u32 = 1;
const PAGE_ERASE: u32 = 1 << 1;
const BANK: u32 = 1 << 11;
const START_BIT: u32 = 1 << 16;
const OPTION_START: u32 = 1 << 17;
const RELOAD: u32 = 1 << 27;
const OPTION_LOCK: u32 = 1 << 30;
const LOCK: u32 = 1 << 31;

const BUSY: u32 = 1 << 16;
const PROGRAMMING_ERROR: u32 = 1 << 3;
const SIZE_ERROR: u32 = 1 << 6;
const SEQUENCE_ERROR: u32 = 1 << 7;

const CORRECTED: u32 = 1 << 30;
const DETECTED: u32 = 1 << 31;
const IN_BANK_2: u32 = 1 << 21;

/// Option bytes of a new chip: two banks, no protection, brown-out reset at its lowest.
pub(super) const NEW_OPTIONS: u32 = 0xFFEF_F8AA;
/// WRP1AR of it: the first page is behind the last.
const NO_PAGE: u32 = 0x7F;

/// First address of bank 2.
pub const BANK_2: u32 = 0x0804_0000;
/// Bytes of a page.
const PAGE: u32 = 2048;
/// Bytes of a copy of the settings, of which each word takes a double word.
const COPY: u32 = 0x8000;

/// What a G4 has beside what every flash has.
#[derive(Clone, Debug)]
pub(super) struct Banks {
    /// Check bits of bank 2.
    checks: Vec<u8>,
    /// The first half of a double word.
    half: Option<(u32, u32)>,
    /// What is done, whether the supply cuts it short, and when it ends.
    going: Option<(Work, bool, u64)>,
    /// The options are to come into force.
    reload: bool,
    /// In force from the next reset on.
    options: u32,
    /// The pages of bank 1 that are protected against writing, from the first to the last: likewise.
    protected: u32,
}

impl Default for Banks {
    fn default() -> Banks {
        Banks {
            checks: vec![0xFF; (BANK_2 - START) as usize / 8],
            half: None,
            going: None,
            reload: false,
            options: NEW_OPTIONS,
            protected: NO_PAGE,
        }
    }
}

/// What an error of each of the 64 bits does to the check bits: words of odd weight, so that two errors are never taken for one.
fn columns() -> impl Iterator<Item = u8> {
    let of_weight = |weight| (0..=u8::MAX).filter(move |column| column.count_ones() == weight);
    of_weight(3).chain(of_weight(5)).take(64)
}

/// The check bits; a blank double word has blank ones. The manual does not state the code, only that it mends one error and finds two.
fn check_bits(double: u64) -> u8 {
    columns().enumerate().filter(|(bit, _)| double >> bit & 1 == 0).fold(0xFF, |check, (_, column)| check ^ column)
}

/// What is read of a double word, and whether it was mended; nothing where it cannot be.
fn decoded(double: u64, check: u8) -> Option<(u64, bool)> {
    let syndrome = check_bits(double) ^ check;
    match syndrome.count_ones() {
        0 => Some((double, false)),
        1 => Some((double, true)),
        _ => columns().position(|column| column == syndrome).map(|bit| (double ^ 1 << bit, true)),
    }
}

impl Flash {
    /// The double word at an address, as its cells are.
    pub fn double(&self, address: u32) -> u64 {
        let mut bytes = [0; 8];
        self.memory.read(address & !7, &mut bytes);
        u64::from_le_bytes(bytes)
    }

    fn check_at(&mut self, address: u32) -> &mut u8 {
        &mut self.banks.checks[((address - BANK_2) / 8) as usize]
    }

    /// Programs a double word in no time, as the host does.
    pub(super) fn put(&mut self, address: u32, double: u64) {
        self.memory.write(address, &double.to_le_bytes());
        *self.check_at(address) = check_bits(double);
    }

    /// Bits of a double word turn, as cells do that lose their charge.
    pub fn turn(&mut self, address: u32, bits: u64) {
        self.memory.write(address, &(self.double(address) ^ bits).to_le_bytes());
    }

    /// Where a word of the settings is: beside its complement.
    pub(super) fn place_of_setting(offset: u32) -> u32 {
        BANK_2 + 2 * offset
    }

    pub(super) fn reset_g4(&mut self) {
        if let Some((work, _, _)) = self.banks.going.take() {
            self.finish(work, true);
        }
        (self.banks.half, self.banks.reload) = (None, false);
        let before = self.memory.word(START);
        self.adopt(self.banks.options);
        if self.memory.word(START) != before {
            self.banks.checks.fill(0xFF);
        }
        let protected = self.banks.protected;
        self.registers = Registers::of(&[(0, 0x0004_0600), (CR, LOCK | OPTION_LOCK), (OPTR, self.options), (WRP1AR, protected)]);
    }

    /// Level of the brown-out reset, V, falling (DS12288, typical), if it is above the lowest.
    pub(super) fn brown_out_g4(&self) -> Option<f64> {
        [None, Some(2.0), Some(2.2), Some(2.5), Some(2.8)][(self.options >> 8 & 7).min(4) as usize]
    }

    /// A load of the processor's from bank 2; whether it was mended, or is broken, is noted. Whether it is broken.
    pub fn load_checked(&mut self, address: u32, bytes: &mut [u8]) -> bool {
        let check = *self.check_at(address);
        let decoded = decoded(self.double(address), check);
        let double = decoded.map_or_else(|| self.double(address), |(double, _)| double);
        bytes.copy_from_slice(&double.to_le_bytes()[(address & 7) as usize..][..bytes.len()]);
        let flag = match decoded {
            Some((_, false)) => return false,
            Some((_, true)) => CORRECTED,
            None => DETECTED,
        };
        // The address is that of the first since the flags were cleared.
        if self.registers.get(ECCR) & (CORRECTED | DETECTED) == 0 {
            self.registers.set(ECCR, self.registers.get(ECCR) & 1 << 24 | ((address & !7) - BANK_2) | IN_BANK_2);
        }
        self.registers.set(ECCR, self.registers.get(ECCR) | flag);
        flag == DETECTED
    }

    /// When what is done ends.
    pub fn ends(&self) -> Option<u64> {
        self.banks.going.map(|(_, _, at)| at)
    }

    /// Work that is done beside the processor.
    pub fn start(&mut self, work: Work, now: u64) {
        let cut = self.begin(work);
        let time = self.duration(work);
        self.banks.going = Some((work, cut, now + if cut { time / 2 } else { time }));
    }

    /// Ends what is due; whether the supply has failed.
    pub fn advance(&mut self, now: u64) -> bool {
        match self.banks.going {
            Some((work, cut, at)) if now >= at => {
                self.banks.going = None;
                self.finish(work, cut);
                cut
            }
            _ => false,
        }
    }

    /// Whether the chip is to be reset for the options.
    pub fn take_reload(&mut self) -> bool {
        std::mem::take(&mut self.banks.reload)
    }

    pub(super) fn read_g4(&self, offset: u32) -> u32 {
        match offset {
            KEYR | OPTKEYR => 0,
            SR => self.registers.get(SR) | if self.banks.going.is_some() { BUSY } else { 0 },
            _ => self.registers.get(offset),
        }
    }

    fn fails(&mut self, error: u32) -> Option<Work> {
        self.registers.set(SR, self.registers.get(SR) | error);
        None
    }

    pub(super) fn write_g4(&mut self, offset: u32, value: u32) -> Option<Work> {
        let set = self.registers.get(CR);
        match offset {
            KEYR => {
                self.unlocked = if KEYS.get(self.unlocked) == Some(&value) { self.unlocked + 1 } else { usize::MAX };
                if self.unlocked == KEYS.len() {
                    self.registers.set(CR, set & !LOCK);
                }
            }
            OPTKEYR if set & LOCK == 0 => {
                let next = OPTION_KEYS.get(self.options_unlocked) == Some(&value);
                self.options_unlocked = if next { self.options_unlocked + 1 } else { usize::MAX };
                if self.options_unlocked == OPTION_KEYS.len() {
                    self.registers.set(CR, set & !OPTION_LOCK);
                }
            }
            SR => self.registers.set(SR, self.registers.get(SR) & !value),
            ECCR => {
                let flags = CORRECTED | DETECTED;
                let found = self.registers.get(ECCR);
                self.registers.set(ECCR, found & !(value & flags) & !(1 << 24) | value & 1 << 24);
            }
            CR if set & LOCK != 0 || self.banks.going.is_some() => {}
            CR => {
                if value & LOCK != 0 {
                    (self.unlocked, self.options_unlocked) = (0, 0);
                }
                let locks = (value | set) & OPTION_LOCK;
                self.registers.set(CR, value & !(START_BIT | OPTION_START | RELOAD) | locks);
                let options_open = set & OPTION_LOCK == 0;
                self.banks.reload |= value & RELOAD != 0 && options_open;
                if value & OPTION_START != 0 && options_open {
                    return Some(Work::Options(self.registers.get(OPTR)));
                }
                // In one bank, pages are of 4 KiB and BKER does nothing; the program refuses to store then.
                if value & (START_BIT | PAGE_ERASE) == START_BIT | PAGE_ERASE {
                    let bank = if value & BANK != 0 { BANK_2 } else { START };
                    let (page, area) = (value >> 3 & 127, self.banks.protected);
                    if bank == START && (area & 127..=area >> 16 & 127).contains(&page) {
                        return self.fails(WRITE_PROTECTED);
                    }
                    return Some(Work::ErasePage(bank + PAGE * (value >> 3 & 127)));
                }
            }
            OPTR | WRP1AR if set & (LOCK | OPTION_LOCK) != 0 => {}
            _ => self.registers.set(offset, value),
        }
        None
    }

    /// A store to bank 2, and what work it starts: the second half of a double word.
    pub(super) fn store_g4(&mut self, address: u32, size: u32, value: u32) -> Option<Work> {
        let set = self.registers.get(CR);
        if set & LOCK != 0 || set & PROGRAM == 0 || self.registers.get(SR) & 0xFA != 0 {
            return self.fails(SEQUENCE_ERROR);
        }
        if size != 4 {
            return self.fails(SIZE_ERROR);
        }
        match self.banks.half.take() {
            None if address.is_multiple_of(8) => {
                self.banks.half = Some((address, value));
                None
            }
            Some((first, low)) if address == first + 4 => {
                let double = u64::from(value) << 32 | u64::from(low);
                if double != 0 && (self.double(first) != u64::MAX || *self.check_at(first) != 0xFF) {
                    return self.fails(PROGRAMMING_ERROR);
                }
                Some(Work::ProgramDouble(first, double))
            }
            _ => self.fails(SEQUENCE_ERROR),
        }
    }

    pub(super) fn duration_g4(&self, work: Work) -> u64 {
        let [program, erase, options] = Model::g4_flash_times(self.pace == Pace::Slowest);
        match work {
            Work::Options(_) => options,
            Work::Erase(_) | Work::ErasePage(_) => erase,
            Work::Program(..) | Work::ProgramDouble(..) => program,
        }
    }

    /// Any bits, of which the supply has left a part where it failed.
    fn part(&mut self, cut: bool) -> (u64, u8) {
        if cut { (self.random.number(), self.random.byte()) } else { (u64::MAX, u8::MAX) }
    }

    pub(super) fn finish_double(&mut self, address: u32, double: u64, cut: bool) {
        let (reached, checks_reached) = self.part(cut);
        let (old, check) = (self.double(address), *self.check_at(address));
        self.memory.write(address, &(old & (double | !reached)).to_le_bytes());
        *self.check_at(address) = check & (check_bits(double) | !checks_reached);
    }

    pub(super) fn finish_page(&mut self, page: u32, cut: bool) {
        for address in (page..page + PAGE).step_by(8) {
            let (reached, checks_reached) = self.part(cut);
            self.memory.write(address, &(self.double(address) | reached).to_le_bytes());
            *self.check_at(address) |= checks_reached;
        }
    }

    pub(super) fn finish_options(&mut self, value: u32) {
        (self.banks.options, self.banks.protected) = (value, self.registers.get(WRP1AR));
    }

    /// Pages of a copy of the settings.
    pub(super) fn pages_of_copy(copy: u32) -> impl Iterator<Item = u32> {
        (BANK_2 + COPY * copy..BANK_2 + COPY * (copy + 1)).step_by(PAGE as usize)
    }
}
