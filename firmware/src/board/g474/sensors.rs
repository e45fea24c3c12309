//! The buses to the sensor on the block and to the sensor on the ground.

use core::ops::Deref;

use embedded_hal::spi::ErrorKind;
use stm32g4::stm32g474::{self as pac, spi1::RegisterBlock};

use super::encoder::Encoder;
use super::pins::{BLOCK_SELECT, GROUND_SELECT, OutputPin};
use crate::board::parts::bus::{Bus, Frames};
use crate::board::parts::inertial::MountedSensors;

/// BR for a sixteenth of the bus's clock: 10.5 MHz.
const BLOCK_RATE: u8 = 3;
/// BR for a thirty-second: 5.25 MHz, for the cable to the ground's sensor is the longer one.
const GROUND_RATE: u8 = 4;

/// A bus, and its device's select line.
pub type Device<P> = Bus<Port<P>, OutputPin>;
/// All sensors.
pub type BoardSensors = MountedSensors<Device<pac::SPI1>, Device<pac::SPI2>, Encoder>;

/// The bus to the sensor on the block.
pub fn block(port: pac::SPI1, rcc: &pac::RCC) -> Device<pac::SPI1> {
    rcc.apb2enr().modify(|_, w| w.spi1en().set_bit());
    device(port, BLOCK_RATE, BLOCK_SELECT)
}

/// The bus to the sensor on the ground.
pub fn ground(port: pac::SPI2, rcc: &pac::RCC) -> Device<pac::SPI2> {
    rcc.apb1enr1().modify(|_, w| w.spi2en().set_bit());
    device(port, GROUND_RATE, GROUND_SELECT)
}

fn device<P: Deref<Target = RegisterBlock>>(port: P, rate: u8, select: OutputPin) -> Device<P> {
    // Mode 3.
    port.cr2().write(|w| w.ds().sixteen_bit());
    // SAFETY: every value of the field is a divider.
    port.cr1().write(|w| unsafe {
        w.br().bits(rate).mstr().set_bit().ssm().set_bit().ssi().set_bit().cpol().set_bit().cpha().set_bit().spe().set_bit()
    });
    Bus::new(Port(port), select)
}

/// A port.
pub struct Port<P>(P);

impl<P: Deref<Target = RegisterBlock>> Frames for Port<P> {
    #[inline(always)]
    fn exchange(&self, frame: u16) -> u16 {
        self.0.dr().write(|w| w.dr().set(frame));
        while self.0.sr().read().rxne().bit_is_clear() {}
        self.0.dr().read().dr().bits()
    }

    #[inline(always)]
    fn error(&self) -> Option<ErrorKind> {
        let status = self.0.sr().read();
        if status.ovr().bit_is_set() {
            Some(ErrorKind::Overrun)
        } else if status.modf().bit_is_set() {
            Some(ErrorKind::ModeFault)
        } else {
            None
        }
    }
}
