//! The memory, tested word by word beside everything else that runs: each bit takes both values and both steps between them, with its
//! neighbours alike and unlike, and the word is as before when the interrupts come back, some 0.2 µs later. Stuck bits and bits of a word
//! that pull each other are found; a wrong address is not.

use core::arch::asm;

use crate::board::{Board, Selected};

/// First address of the memory, its words, and the pattern beside all and none.
const START: u32 = 0x2000_0000;
const WORDS: u32 = 32 << 10;
const UNLIKE: u32 = 0x5555_5555;

/// Words of a turn, until all have been tested once, which is before the controller arms; …
const AT_FIRST: u32 = 64;
/// … and later.
const LATER: u32 = 4;

/// Where the test stands.
pub struct MemoryTest {
    next: u32,
    at_once: u32,
}

impl MemoryTest {
    /// At the first word.
    pub const fn new() -> MemoryTest {
        MemoryTest { next: 0, at_once: AT_FIRST }
    }

    /// Some words more. Whether they held what was written to them.
    #[inline(never)]
    pub fn turn(&mut self) -> bool {
        let mut held = true;
        for _ in 0..self.at_once {
            let place = START + 4 * self.next;
            held &= Selected::moves_by_itself(place) || holds(place);
            self.next += 1;
            if self.next >= WORDS {
                (self.next, self.at_once) = (0, LATER);
            }
        }
        held
    }
}

/// Whether the word at an address of the memory holds what is written to it.
fn holds(place: u32) -> bool {
    let wrong: u32;
    // SAFETY: nothing sees the word while the interrupts are masked but a fault, and it is as before afterwards.
    unsafe {
        asm!(
            "mrs {mask}, primask",
            "cpsid i",
            "ldr {old}, [{place}]",
            "mvn {new}, {old}",
            "str {new}, [{place}]",
            "ldr {wrong}, [{place}]",
            "eor {wrong}, {wrong}, {new}",
            "eor {new}, {old}, {unlike}",
            "str {new}, [{place}]",
            "ldr {read}, [{place}]",
            "eor {read}, {read}, {new}",
            "orr {wrong}, {wrong}, {read}",
            "mvn {new}, {new}",
            "str {new}, [{place}]",
            "ldr {read}, [{place}]",
            "eor {read}, {read}, {new}",
            "orr {wrong}, {wrong}, {read}",
            "str {old}, [{place}]",
            "ldr {read}, [{place}]",
            "eor {read}, {read}, {old}",
            "orr {wrong}, {wrong}, {read}",
            "msr primask, {mask}",
            place = in(reg) place,
            unlike = in(reg) UNLIKE,
            mask = out(reg) _,
            old = out(reg) _,
            new = out(reg) _,
            read = out(reg) _,
            wrong = out(reg) wrong,
            options(nostack, preserves_flags),
        );
    }
    wrong == 0
}
