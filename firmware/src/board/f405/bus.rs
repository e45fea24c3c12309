//! A port of SPI in frames of 16 bits, set up by the library.

use embedded_hal::spi::ErrorKind;
use stm32f4xx_hal::gpio::{Output, Pin, PinState};
use stm32f4xx_hal::spi::{Instance, Spi};

use crate::board::parts::bus::{Bus, Frames};

/// The port.
pub struct Port<SPI: Instance>(Spi<SPI, false, u16>);

/// A bus, and its device's select line.
pub type BoardBus<SPI, const PORT: char, const SELECT: u8> = Bus<Port<SPI>, Pin<PORT, SELECT, Output>>;

/// Not selected.
pub fn new<SPI: Instance, const PORT: char, const SELECT: u8>(
    bytes: Spi<SPI>,
    select: Pin<PORT, SELECT>,
) -> BoardBus<SPI, PORT, SELECT> {
    Bus::new(Port(bytes.frame_size_16bit()), select.into_push_pull_output_in_state(PinState::High))
}

impl<SPI: Instance> Frames for Port<SPI> {
    #[inline(always)]
    fn exchange(&self, frame: u16) -> u16 {
        // SAFETY: the block lies at this address for ever, and this has the bus to itself.
        let registers = unsafe { &*SPI::ptr() };
        registers.dr().write(|w| w.dr().set(frame));
        while registers.sr().read().rxne().bit_is_clear() {}
        registers.dr().read().dr().bits()
    }

    #[inline(always)]
    fn error(&self) -> Option<ErrorKind> {
        // SAFETY: as in `exchange`.
        let status = unsafe { &*SPI::ptr() }.sr().read();
        if status.ovr().bit_is_set() {
            Some(ErrorKind::Overrun)
        } else if status.modf().bit_is_set() {
            Some(ErrorKind::ModeFault)
        } else {
            None
        }
    }
}
