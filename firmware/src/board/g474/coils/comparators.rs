//! COMP1 at PA1 and COMP3 at PC1 compare the amplifiers' outputs with 3.1 V of DAC3, which is 1.24 A.

use sprag_shared::device::coil::AMPERES_PER_COUNT;
use stm32g4::stm32g474 as pac;

/// A coil that takes more than this is switched off, A.
const MOST: f32 = 1.24;

/// The same in counts of the converter, which are those of DAC3.
const LEVEL: u16 = (MOST / AMPERES_PER_COUNT) as u16;

/// Channel 1 of DAC3, among the negative inputs of both (RM0440, table 196).
const DAC3_CHANNEL_1: u8 = 0b100;

/// 30 mV.
const HYSTERESIS: u8 = 0b011;

/// PC1 among the positive inputs of COMP3; PA1 is COMP1's other one.
const AT_PC1: bool = true;

/// Starts both.
pub fn begin(chip: &pac::Peripherals) {
    chip.RCC.ahb2enr().modify(|_, w| w.dac3en().set_bit());
    chip.RCC.apb2enr().modify(|_, w| w.syscfgen().set_bit());
    let source = &chip.DAC3;
    source.mcr().modify(|_, w| w.hfsel().more160mhz().mode1().normal_chip_no_buffer());
    source.cr().modify(|_, w| w.en1().set_bit());
    source.dhr12r1().write(|w| w.daccdhr().set(LEVEL));
    // 8 µs until it is there.
    cortex_m::asm::delay(super::super::clock::HZ / 100_000);
    // SAFETY: the inputs and the hysteresis exist.
    unsafe {
        chip.COMP.c1csr().write(|w| w.inmsel().bits(DAC3_CHANNEL_1).inpsel().bit(!AT_PC1).hyst().bits(HYSTERESIS).en().set_bit());
        chip.COMP.c3csr().write(|w| w.inmsel().bits(DAC3_CHANNEL_1).inpsel().bit(AT_PC1).hyst().bits(HYSTERESIS).en().set_bit());
    }
    // 5 µs until they compare.
    cortex_m::asm::delay(super::super::clock::HZ / 200_000);
}
