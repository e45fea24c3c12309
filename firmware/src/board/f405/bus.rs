//! A serial bus with one device, in frames of 16 bits: half as many to wait for as bytes.
//!
//! The library waits for room and for an answer to every frame, and looks for four kinds of error each time. Here the next frame goes out when
//! the last has come back, so that no frame can be lost, and the select line is the program's own, so that nobody else can take the bus:
//! whether that has been so is asked once, after the last frame.

use embedded_hal::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use stm32f4xx_hal::gpio::{Output, Pin, PinState};
use stm32f4xx_hal::pac::spi1::RegisterBlock;
use stm32f4xx_hal::spi::{Instance, Spi};

/// The bus and its device's select line.
pub struct Bus<SPI: Instance, const PORT: char, const SELECT: u8> {
    _frames: Spi<SPI, false, u16>,
    select: Pin<PORT, SELECT, Output>,
}

impl<SPI: Instance, const PORT: char, const SELECT: u8> Bus<SPI, PORT, SELECT> {
    /// Not selected.
    pub fn new(bytes: Spi<SPI>, select: Pin<PORT, SELECT>) -> Self {
        Bus { _frames: bytes.frame_size_16bit(), select: select.into_push_pull_output_in_state(PinState::High) }
    }
}

/// Sends a frame and gives the one that came meanwhile.
#[inline(always)]
fn exchange(registers: &RegisterBlock, frame: u16) -> u16 {
    registers.dr().write(|w| w.dr().set(frame));
    while registers.sr().read().rxne().bit_is_clear() {}
    registers.dr().read().dr().bits()
}

impl<SPI: Instance, const PORT: char, const SELECT: u8> ErrorType for Bus<SPI, PORT, SELECT> {
    type Error = ErrorKind;
}

impl<SPI: Instance, const PORT: char, const SELECT: u8> SpiDevice<u16> for Bus<SPI, PORT, SELECT> {
    #[inline(always)]
    fn transaction(&mut self, operations: &mut [Operation<'_, u16>]) -> Result<(), ErrorKind> {
        // SAFETY: the block lies at this address for ever, and this has the bus to itself.
        let registers = unsafe { &*SPI::ptr() };
        self.select.set_low();
        for operation in operations {
            match operation {
                Operation::Read(frames) => frames.iter_mut().for_each(|frame| *frame = exchange(registers, 0)),
                Operation::Write(frames) => frames.iter().for_each(|frame| _ = exchange(registers, *frame)),
                Operation::Transfer(read, write) => {
                    for index in 0..read.len().max(write.len()) {
                        let answer = exchange(registers, write.get(index).copied().unwrap_or(0));
                        if let Some(frame) = read.get_mut(index) {
                            *frame = answer;
                        }
                    }
                }
                Operation::TransferInPlace(frames) => frames.iter_mut().for_each(|frame| *frame = exchange(registers, *frame)),
                // Somewhat longer than asked for.
                Operation::DelayNs(nanoseconds) => cortex_m::asm::delay(*nanoseconds / 5),
            }
        }
        self.select.set_high();
        let status = registers.sr().read();
        if status.ovr().bit_is_set() {
            Err(ErrorKind::Overrun)
        } else if status.modf().bit_is_set() {
            Err(ErrorKind::ModeFault)
        } else {
            Ok(())
        }
    }
}
