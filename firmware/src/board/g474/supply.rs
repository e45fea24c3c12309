//! What happens when the supply sags: at 2.9 V the coils go to the safe state, and below some 2.8 V the chip is held in reset.

use cortex_m::peripheral::NVIC;
use stm32g4::stm32g474::{self as pac, interrupt};

use super::clock::HZ;
use super::{coils, options};

/// Of the voltage detector, for 2.9 V.
const DETECTOR_LEVEL: u8 = 6;

/// BOR_LEV for some 2.8 V.
const BROWN_OUT_LEVEL_4: u8 = 4;

/// Sets the brown-out reset to level 4, unless it already is. That is once in the life of a chip, for the option bytes keep it; every other
/// option stays as it is. The chip takes them over by a reset, which this ends in. Needs a supply above the detector's level.
pub fn set_brown_out(chip: &pac::Peripherals) {
    let flash = &chip.FLASH;
    if flash.optr().read().bor_lev().bits() == BROWN_OUT_LEVEL_4 {
        return;
    }
    detect(chip);
    // The detector needs some time to settle: a millisecond.
    cortex_m::asm::delay(HZ / 1000);
    if low() {
        return;
    }
    // SAFETY: the level is one that there is.
    options::program(|flash| _ = flash.optr().modify(|_, w| unsafe { w.bor_lev().bits(BROWN_OUT_LEVEL_4) }));
    flash.cr().modify(|_, w| w.obl_launch().set_bit());
    cortex_m::asm::delay(HZ / 1000);
}

/// Watches the supply from now on, with the state that the coils go to.
pub fn watch(chip: &pac::Peripherals) {
    detect(chip);
    chip.EXTI.rtsr1().modify(|_, w| w.rt16().set_bit());
    chip.EXTI.imr1().modify(|_, w| w.im16().set_bit());
    // SAFETY: its handler shares nothing with the tasks but registers that are written whole and the flags above.
    unsafe {
        cortex_m::Peripherals::steal().NVIC.set_priority(pac::Interrupt::PVD_PVM, 0);
        NVIC::unmask(pac::Interrupt::PVD_PVM);
    }
}

/// Whether the supply is too low to rely on anything.
pub fn low() -> bool {
    // SAFETY: reads a register.
    unsafe { &*pac::PWR::ptr() }.sr2().read().pvdo().bit_is_set()
}

fn detect(chip: &pac::Peripherals) {
    // SAFETY: the level is one that there is.
    chip.PWR.cr2().modify(|_, w| unsafe { w.pvdls().bits(DETECTOR_LEVEL).pvde().set_bit() });
}

/// The supply fell below the detector's level.
#[interrupt]
fn PVD_PVM() {
    // SAFETY: writes 1 to clear one flag; the others are not affected.
    unsafe { &*pac::EXTI::ptr() }.pr1().write(|w| w.pif16().clear_bit_by_one());
    coils::force(crate::control::safe_state());
}
