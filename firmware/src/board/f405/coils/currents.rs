//! The coils' currents and their supply: ADC1 converts all for ever by itself, and the latest are there to be read.

use sprag_shared::device::coil::current;
use stm32f4xx_hal::gpio::Pin;
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::{Enable, Rcc, Reset};

/// Channels of the two amplifiers.
const CHANNELS: [u8; 2] = [10, 11];

/// Of the supply's divider.
const SUPPLY: u8 = 12;

/// The converter.
pub struct Currents(pac::ADC1);

/// Of the two amplifiers and of the divider.
type Pins = (Pin<'C', 0>, Pin<'C', 1>, Pin<'C', 2>);

impl Currents {
    /// With the outputs of the amplifiers, and of the divider.
    pub fn new(converter: pac::ADC1, common: &pac::ADC_COMMON, pins: Pins, rcc: &mut Rcc) -> Currents {
        let _: (Pin<'C', 0, _>, Pin<'C', 1, _>, Pin<'C', 2, _>) =
            (pins.0.into_analog(), pins.1.into_analog(), pins.2.into_analog());
        pac::ADC1::enable(rcc);
        pac::ADC1::reset(rcc);
        // 21 MHz.
        common.ccr().modify(|_, w| w.adcpre().div4());
        // Injected conversions have a register each, so no memory needs to be written. They follow every regular one, the supply's, which
        // follows them.
        converter.cr1().write(|w| w.scan().set_bit().jauto().set_bit());
        converter.smpr1().write(|w| w.smp10().cycles480().smp11().cycles480().smp12().cycles480());
        // SAFETY: these channels exist.
        unsafe {
            converter.sqr3().write(|w| w.sq1().bits(SUPPLY));
            // Two are the last two of four.
            converter.jsqr().write(|w| w.jl().set(1).jsq3().bits(CHANNELS[0]).jsq4().bits(CHANNELS[1]));
        }
        converter.cr2().write(|w| w.adon().set_bit().cont().set_bit());
        // 3 µs until it is stable.
        cortex_m::asm::delay(super::super::clock::HZ / 300_000);
        converter.cr2().modify(|_, w| w.swstart().set_bit());
        Currents(converter)
    }

    /// The latest, A. Both are converted every 70 µs.
    pub fn read(&self) -> [f32; 2] {
        [self.0.jdr1().read().jdata().bits(), self.0.jdr2().read().jdata().bits()].map(current)
    }

    /// The latest counts of the supply, of the same age.
    pub fn supply(&self) -> u16 {
        self.0.dr().read().data().bits()
    }
}
