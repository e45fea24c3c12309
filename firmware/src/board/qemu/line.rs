//! The emulator's link: standard streams of the host by semihosting, or USART1.

use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU8, AtomicUsize, Ordering};

use super::TICKED;
use cortex_m::peripheral::NVIC;
use semihosting::io::{self, Read as _, Write as _};
use semihosting::process;
use semihosting::sys::arm_compat;
use stm32f4xx_hal::pac::{self, Interrupt, interrupt};

/// Bytes in a chunk at most, beside the two that say how many.
const CHUNK: usize = 1022;

/// Bytes of a command line that are looked at.
const COMMAND_LINE: usize = 64;

/// The link.
pub enum Line {
    /// By semihosting.
    Streams(&'static mut Streams),
    /// By USART1.
    Usart(pac::USART1),
}

impl Line {
    /// As the command line says. To be called once.
    pub fn new(usart: pac::USART1) -> Line {
        let mut line = [MaybeUninit::uninit(); COMMAND_LINE];
        let asked = arm_compat::sys_get_cmdline_uninit(&mut line).is_ok_and(|line| line.windows(5).any(|word| word == b"usart"));
        if !asked && let Some(streams) = Streams::new() {
            return Line::Streams(streams);
        }
        usart.cr1().write(|w| w.ue().set_bit().te().set_bit().re().set_bit().rxneie().set_bit());
        // SAFETY: the interrupt's task has all that it uses for itself.
        unsafe { NVIC::unmask(Interrupt::USART1) };
        Line::Usart(usart)
    }
}

impl super::super::Line for Line {
    fn read(&mut self, bytes: &mut [u8]) -> usize {
        match self {
            Line::Streams(streams) => streams.read(bytes),
            Line::Usart(_) => {
                let (first, last) = (FIRST.load(Ordering::Relaxed), LAST.load(Ordering::Acquire));
                let count = last.wrapping_sub(first).min(bytes.len());
                for (byte, place) in bytes.iter_mut().zip((0..count).map(|index| first.wrapping_add(index))) {
                    *byte = RING[place % RING.len()].load(Ordering::Relaxed);
                }
                FIRST.store(first.wrapping_add(count), Ordering::Release);
                count
            }
        }
    }

    fn write(&mut self, bytes: &[u8]) -> usize {
        match self {
            Line::Streams(streams) => streams.write(bytes),
            Line::Usart(usart) => {
                let mut count = 0;
                for byte in bytes {
                    if !usart.sr().read().txe().bit_is_set() {
                        break;
                    }
                    // SAFETY: every byte can be sent.
                    usart.dr().write(|w| unsafe { w.bits((*byte).into()) });
                    count += 1;
                }
                count
            }
        }
    }
}

/// Bytes that have come by USART1, which holds one, and how many were taken out and put in.
static RING: [AtomicU8; 256] = [const { AtomicU8::new(0) }; 256];
static FIRST: AtomicUsize = AtomicUsize::new(0);
static LAST: AtomicUsize = AtomicUsize::new(0);

/// A byte wakes the processor: without that the emulator brings one for every control period.
#[interrupt]
fn USART1() {
    // SAFETY: nobody else reads this register, and reading it makes room for the next byte.
    let byte = unsafe { (*pac::USART1::ptr()).dr().read().bits() } as u8;
    let last = LAST.load(Ordering::Relaxed);
    if last.wrapping_sub(FIRST.load(Ordering::Acquire)) < RING.len() {
        RING[last % RING.len()].store(byte, Ordering::Relaxed);
        LAST.store(last.wrapping_add(1), Ordering::Release);
    }
}

/// A chunk each way for every control period: the number of bytes in two, the low one first, and they.
pub struct Streams {
    input: io::Stdin,
    output: io::Stdout,
    /// Bytes that are ready to go, after two for their number.
    out: &'static mut [u8; CHUNK + 2],
    filled: usize,
    /// Bytes that have come.
    come: &'static mut [u8; CHUNK + 2],
    next: usize,
    end: usize,
    /// Chunks that have been written and not been answered yet.
    owed: u32,
}

impl Streams {
    fn new() -> Option<&'static mut Streams> {
        let (input, output) = (io::stdin().ok()?, io::stdout().ok()?);
        let out = cortex_m::singleton!(: [u8; CHUNK + 2] = [0; CHUNK + 2])?;
        let come = cortex_m::singleton!(: [u8; CHUNK + 2] = [0; CHUNK + 2])?;
        cortex_m::singleton!(: Streams = Streams { input, output, out, filled: 0, come, next: 0, end: 0, owed: 0 })
    }

    fn read(&mut self, bytes: &mut [u8]) -> usize {
        if self.next >= self.end {
            if !TICKED.swap(false, Ordering::Relaxed) {
                return 0;
            }
            self.exchange();
        }
        let waiting = self.come.get(self.next..self.end).unwrap_or_default();
        let count = waiting.len().min(bytes.len());
        for (byte, come) in bytes.iter_mut().zip(waiting) {
            *byte = *come;
        }
        self.next += count;
        count
    }

    fn write(&mut self, bytes: &[u8]) -> usize {
        // Where much is asked at once, answers must go before all of it has been heard.
        if self.filled == CHUNK && TICKED.swap(false, Ordering::Relaxed) {
            self.put();
        }
        let room = self.out.get_mut(self.filled + 2..).unwrap_or_default();
        let count = room.len().min(bytes.len());
        for (place, byte) in room.iter_mut().zip(bytes) {
            *place = *byte;
        }
        self.filled += count;
        count
    }

    /// Sends what is ready.
    fn put(&mut self) {
        let count = (self.filled as u16).to_le_bytes();
        self.out[..2].copy_from_slice(&count);
        if self.output.write_all(&self.out[..self.filled + 2]).is_err() {
            process::exit(0);
        }
        self.filled = 0;
        self.owed += 1;
    }

    /// Time stands still meanwhile.
    fn exchange(&mut self) {
        if self.owed == 0 {
            self.put();
        }
        self.owed -= 1;
        (self.next, self.end) = (2, 2);
        let mut have = 0;
        while have < self.end {
            match self.input.read(&mut self.come[have..self.end]) {
                Ok(0) | Err(_) => break,
                Ok(more) => have += more,
            }
            if have == 2 {
                self.end = 2 + usize::from(u16::from_le_bytes([self.come[0], self.come[1]])).min(CHUNK);
            }
        }
        if have < self.end {
            // The host has closed its end.
            process::exit(0);
        }
    }
}
