//! A serial bus with one device, in frames of 16 bits: half as many to wait for as bytes.
//!
//! Libraries wait for room and for an answer to every frame, and look for four kinds of error each time. Here the next frame goes out when
//! the last has come back, so that no frame can be lost, and the select line is the program's own, so that nobody else can take the bus:
//! whether that has been so is asked once, after the last frame.

use embedded_hal::digital::OutputPin;
use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};

/// A port that is the master of a bus, in mode 3 and in frames of 16 bits.
pub trait Frames {
    /// Sends a frame and gives the one that came meanwhile.
    fn exchange(&self, frame: u16) -> u16;

    /// What has gone wrong, if anything has.
    fn error(&self) -> Option<ErrorKind>;
}

/// The bus and its device's select line, which selects while it is low.
pub struct Bus<F, S> {
    port: F,
    select: S,
}

impl<F: Frames, S: OutputPin> Bus<F, S> {
    /// With a line that is high.
    pub fn new(port: F, select: S) -> Bus<F, S> {
        Bus { port, select }
    }
}

impl<F: Frames, S: OutputPin> ErrorType for Bus<F, S> {
    type Error = ErrorKind;
}

impl<F: Frames, S: OutputPin> SpiDevice<u16> for Bus<F, S> {
    #[inline(always)]
    fn transaction(&mut self, operations: &mut [Operation<'_, u16>]) -> Result<(), ErrorKind> {
        let Bus { port, select } = self;
        // The pins of a chip do not fail.
        let _ = select.set_low();
        for operation in operations {
            match operation {
                Operation::Read(frames) => frames.iter_mut().for_each(|frame| *frame = port.exchange(0)),
                Operation::Write(frames) => frames.iter().for_each(|frame| _ = port.exchange(*frame)),
                Operation::Transfer(read, write) => {
                    for index in 0..read.len().max(write.len()) {
                        let answer = port.exchange(write.get(index).copied().unwrap_or(0));
                        if let Some(frame) = read.get_mut(index) {
                            *frame = answer;
                        }
                    }
                }
                Operation::TransferInPlace(frames) => frames.iter_mut().for_each(|frame| *frame = port.exchange(*frame)),
                // Somewhat longer than asked for.
                Operation::DelayNs(nanoseconds) => cortex_m::asm::delay(*nanoseconds / 5),
            }
        }
        let _ = select.set_high();
        port.error().map_or(Ok(()), Err)
    }
}
