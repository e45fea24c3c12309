//! The seal of the image: which stretches of flash the program takes, and a CRC-32 over them. `xtask/src/seal.rs` writes it once the program
//! is linked; the program is held against it at the start, before it drives a coil, and word by word ever after.

use core::ptr::addr_of;
use core::slice;

use crate::board::{Board, Selected};

/// The first word of a seal, …
const SEALED: u32 = 0x5EA1_ED01;
/// … and of a place that none has been written to.
const UNSEALED: u32 = !SEALED;

/// Where a program may lie.
const FLASH: core::ops::Range<u32> = 0x0800_0000..0x0804_0000;

/// Stretches of a seal.
const STRETCHES: usize = 4;

/// Mark, first and last address of each stretch, CRC-32 of all words before it and then of the stretches'.
type Seal = [u32; 2 + 2 * STRETCHES];

/// Found by its name, and written to by nobody but `xtask`.
#[used]
#[unsafe(no_mangle)]
static SPRAG_SEAL: Seal = [UNSEALED, 0, 0, 0, 0, 0, 0, 0, 0, 0];

/// The program under its seal, looked through word by word, again and again.
pub struct Program {
    head: [u32; 1 + 2 * STRETCHES],
    check: u32,
    stretch: usize,
    at: u32,
    crc: u32,
}

/// What has come of looking.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Seen {
    /// Not through yet.
    More,
    /// The whole program is as it was sealed.
    Whole,
    /// It is not.
    Damaged,
}

impl Program {
    /// At its first word; `None` where nobody has sealed it.
    pub fn sealed() -> Option<Program> {
        // SAFETY: the place is there for ever; volatile, for the compiler knows only what was there before it was written to.
        let [head @ .., check] = unsafe { addr_of!(SPRAG_SEAL).read_volatile() };
        if head == [UNSEALED, 0, 0, 0, 0, 0, 0, 0, 0] && check == 0 { None } else { Some(Program::begin(head, check)) }
    }

    fn begin(head: [u32; 1 + 2 * STRETCHES], check: u32) -> Program {
        let mut program = Program { head, check, stretch: 0, at: 0, crc: Selected::crc(u32::MAX, &head) };
        program.at = program.bounds().map_or(0, |(start, _)| start);
        program
    }

    /// First and last address of the present stretch.
    fn bounds(&self) -> Option<(u32, u32)> {
        let &[start, end] = self.head.get(1 + 2 * self.stretch..3 + 2 * self.stretch)? else { return None };
        Some((start, end))
    }

    /// The address behind the program.
    pub fn end(&self) -> u32 {
        self.head.iter().skip(1).copied().fold(FLASH.start + 1, u32::max)
    }

    /// Looks at `most` words more.
    #[inline(never)]
    pub fn look(&mut self, most: u32) -> Seen {
        let Some((start, end)) = self.bounds() else {
            let whole = self.crc == self.check;
            *self = Program::begin(self.head, self.check);
            return if whole { Seen::Whole } else { Seen::Damaged };
        };
        if start < end {
            let inside = self.head[0] == SEALED && FLASH.contains(&start) && end <= FLASH.end && (start | end).is_multiple_of(4);
            if !inside {
                *self = Program::begin(self.head, self.check);
                return Seen::Damaged;
            }
            let words = most.min(end.saturating_sub(self.at) / 4);
            // SAFETY: within the flash, which holds any bits and does not change under the program.
            self.crc = Selected::crc(self.crc, unsafe { slice::from_raw_parts(self.at as *const u32, words as usize) });
            self.at += 4 * words;
        }
        if start >= end || self.at >= end {
            self.stretch += 1;
            self.at = self.bounds().map_or(0, |(start, _)| start);
        }
        Seen::More
    }

    /// Looks at all of it.
    pub fn look_through(&mut self) -> Seen {
        loop {
            match self.look(u32::MAX) {
                Seen::More => {}
                seen => return seen,
            }
        }
    }
}
