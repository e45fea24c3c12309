//! The emulator's link: standard streams of the host by semihosting, or USART1.

use core::mem::MaybeUninit;
use core::sync::atomic::Ordering;

use super::TICKED;
use semihosting::io::{self, Read as _, Write as _};
use semihosting::process;
use semihosting::sys::arm_compat;
use stm32f4xx_hal::pac;

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
        usart.cr1().write(|w| w.ue().set_bit().te().set_bit().re().set_bit());
        Line::Usart(usart)
    }
}

impl super::super::Line for Line {
    fn read(&mut self, bytes: &mut [u8]) -> usize {
        match self {
            Line::Streams(streams) => streams.read(bytes),
            Line::Usart(usart) => {
                let mut count = 0;
                for byte in bytes {
                    if !usart.sr().read().rxne().bit_is_set() {
                        break;
                    }
                    *byte = usart.dr().read().bits() as u8;
                    count += 1;
                }
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
}

impl Streams {
    fn new() -> Option<&'static mut Streams> {
        let (input, output) = (io::stdin().ok()?, io::stdout().ok()?);
        let out = cortex_m::singleton!(: [u8; CHUNK + 2] = [0; CHUNK + 2])?;
        let come = cortex_m::singleton!(: [u8; CHUNK + 2] = [0; CHUNK + 2])?;
        cortex_m::singleton!(: Streams = Streams { input, output, out, filled: 0, come, next: 0, end: 0 })
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
        let room = self.out.get_mut(self.filled + 2..).unwrap_or_default();
        let count = room.len().min(bytes.len());
        for (place, byte) in room.iter_mut().zip(bytes) {
            *place = *byte;
        }
        self.filled += count;
        count
    }

    /// Time stands still meanwhile.
    fn exchange(&mut self) {
        let count = (self.filled as u16).to_le_bytes();
        self.out[..2].copy_from_slice(&count);
        let sent = self.output.write_all(&self.out[..self.filled + 2]);
        self.filled = 0;
        (self.next, self.end) = (2, 2);
        let mut have = 0;
        while sent.is_ok() && have < self.end {
            match self.input.read(&mut self.come[have..]) {
                Ok(0) | Err(_) => break,
                Ok(more) => have += more,
            }
            if have >= 2 {
                self.end = 2 + usize::from(u16::from_le_bytes([self.come[0], self.come[1]])).min(CHUNK);
            }
        }
        if have < self.end {
            // The host has closed its end.
            process::exit(0);
        }
    }
}
