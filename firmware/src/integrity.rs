//! What the board finds out about itself while the link's task has nothing else to do: program, memory, settings and clock, a little at a
//! time. What is wrong is a fault until a new start.

use core::arch::asm;
use core::sync::atomic::{AtomicU32, Ordering};

use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::device::Device;
use sprag_shared::device::clock_check::ClockCheck;

use crate::board::{Board, Edge, Selected};
use crate::memory_test::MemoryTest;
use crate::seal::{Program, Seen};

/// Words of the program that are looked at in a turn.
const WORDS: u32 = 8;

/// Turns, some two thousand a second, from one measurement of the clock to the next, and from one audit of the settings to the next.
const MEASURED: u16 = 2048;
const AUDITED: u16 = 8192;

/// CRC-32 of what must not change in the device, as it came into force.
static IN_FORCE: AtomicU32 = AtomicU32::new(0);

/// Words that are read at once.
const BLOCK: usize = 8;

/// A word of the memory, whatever it holds: between the fields of a structure nothing need ever have been written.
fn word_at(place: usize) -> u32 {
    let word;
    // SAFETY: reads a word of the device, which is there for ever.
    unsafe {
        asm!("ldr {word}, [{place}]", place = in(reg) place, word = lateout(reg) word, options(nostack, readonly, preserves_flags))
    };
    word
}

#[inline(never)]
fn constants_of(device: &Device) -> u32 {
    device.constants().into_iter().fold(u32::MAX, |crc, (first, bytes)| {
        (first..first + bytes).step_by(4 * BLOCK).fold(crc, |crc, place| {
            let words: [u32; BLOCK] = core::array::from_fn(|word| word_at((place + 4 * word).min(first + bytes - 4)));
            Selected::crc(crc, &words)
        })
    })
}

/// What the device has now is in force: to be called with every other controller.
pub fn put_in_force(device: &Device) {
    IN_FORCE.store(constants_of(device), Ordering::Relaxed);
}

/// Whether it is still as it was, which takes 10 µs.
pub fn is_in_force(device: &Device) -> bool {
    constants_of(device) == IN_FORCE.load(Ordering::Relaxed)
}

/// Turns in which two edges of the slow oscillator must have come: some 30 ms, where they take 1.
const PATIENCE: u16 = 4096;

/// What remains to be done after a turn.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Next {
    /// Nothing until something happens.
    Sleep,
    /// The next turn, at once: an edge is waited for.
    Turn,
    /// The settings are to be audited.
    Audit,
}

/// Where all of it stands.
pub struct Integrity {
    program: Option<Program>,
    memory: MemoryTest,
    clock: Option<ClockCheck>,
    turn: u16,
    /// For how many turns the clock has been measured; 0 while it is not.
    measuring: u16,
    edge: Option<u32>,
}

impl Integrity {
    /// Of a `program` that has been looked through, on a board with a second clock, if it has one.
    pub fn new(program: Option<Program>, clock: Option<ClockCheck>) -> Integrity {
        Integrity { program, memory: MemoryTest::new(), clock, turn: 0, measuring: 1, edge: None }
    }

    /// A turn: tens of microseconds at most. What is wrong goes to `accuse`.
    #[inline(never)]
    pub fn turn(&mut self, accuse: &mut dyn FnMut(Fault)) -> Next {
        if let Some(program) = &mut self.program
            && program.look(WORDS) == Seen::Damaged
        {
            accuse(Fault::ImageDamaged);
        }
        if !self.memory.turn() {
            accuse(Fault::MemoryDamaged);
        }
        if self.measuring > 0 {
            if self.measure() {
                accuse(Fault::ClockWrong);
            }
            if self.measuring > 0 {
                return Next::Turn;
            }
        }
        self.turn = self.turn.wrapping_add(1);
        if self.turn.is_multiple_of(MEASURED) {
            self.measuring = 1;
        }
        if self.turn.is_multiple_of(AUDITED) { Next::Audit } else { Next::Sleep }
    }

    /// Continues to measure the clock. Whether it is wrong.
    #[inline(never)]
    fn measure(&mut self) -> bool {
        let Some(clock) = &mut self.clock else {
            self.measuring = 0;
            return false;
        };
        self.measuring += 1;
        let counts = match (Selected::slow_edge(), self.edge) {
            (Edge::At(now), Some(before)) => now.wrapping_sub(before),
            // A slow oscillator that stands keeps no watchdog, either.
            _ if self.measuring > PATIENCE => 0,
            (Edge::At(now), None) => {
                self.edge = Some(now);
                return false;
            }
            (Edge::Missed, _) => {
                self.edge = None;
                return false;
            }
            (Edge::None, _) => return false,
        };
        (self.measuring, self.edge) = (0, None);
        clock.is_off(counts)
    }
}
