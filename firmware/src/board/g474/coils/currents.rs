//! The coils' currents and their supply: ADC1 converts all for ever by itself, and the latest are there to be read.

use sprag_shared::device::coil::current;
use stm32g4::stm32g474 as pac;

/// Channels of the two amplifiers, at PA1 and PC1.
const CHANNELS: [u8; 2] = [2, 7];

/// Of the supply's divider, at PC2.
const SUPPLY: u8 = 8;

/// The converter.
pub struct Currents(());

fn converter() -> &'static pac::adc1::RegisterBlock {
    // SAFETY: the block lies at this address for ever, and only this module uses it.
    unsafe { &*pac::ADC1::ptr() }
}

impl Currents {
    /// With the outputs of the amplifiers.
    pub fn new(chip: &pac::Peripherals) -> Currents {
        chip.RCC.ahb2enr().modify(|_, w| w.adc12en().set_bit());
        let converter = converter();
        // 42 MHz.
        chip.ADC12_COMMON.ccr().modify(|_, w| w.ckmode().sync_div4());
        // Out of deep power-down, the regulator, 20 µs, and the offset (RM0440, 21.4.6 to 21.4.9).
        converter.cr().write(|w| w.deeppwd().clear_bit());
        converter.cr().modify(|_, w| w.advregen().set_bit());
        cortex_m::asm::delay(super::super::clock::HZ / 50_000);
        converter.cr().modify(|_, w| w.adcal().set_bit());
        while converter.cr().read().adcal().bit_is_set() {}
        // Four of the converter's cycles must pass before it may be enabled.
        cortex_m::asm::delay(64);
        converter.cr().modify(|_, w| w.aden().set_bit());
        while converter.isr().read().adrdy().bit_is_clear() {}
        // Injected conversions have a register each, so no memory needs to be written. They follow every regular one, the supply's, which
        // follows them.
        converter.cfgr().modify(|_, w| w.jauto().set_bit().cont().set_bit().ovrmod().set_bit());
        converter.smpr1().write(|w| w.smp2().cycles640_5().smp7().cycles640_5().smp8().cycles640_5());
        // SAFETY: these channels exist.
        unsafe {
            converter.sqr1().write(|w| w.l().set(0).sq1().bits(SUPPLY));
            converter.jsqr().write(|w| w.jl().set(1).jsq1().bits(CHANNELS[0]).jsq2().bits(CHANNELS[1]));
        }
        converter.cr().modify(|_, w| w.adstart().set_bit());
        Currents(())
    }

    /// The latest, A. Both are converted every 47 µs.
    pub fn read(&self) -> [f32; 2] {
        [converter().jdr1().read().jdata().bits(), converter().jdr2().read().jdata().bits()].map(current)
    }

    /// The latest counts of the supply, of the same age.
    pub fn supply(&self) -> u16 {
        converter().dr().read().rdata().bits()
    }
}
