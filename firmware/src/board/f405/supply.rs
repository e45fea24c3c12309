//! What happens when the supply sags: at 2.9 V the coils go to the safe state, and below some 2.8 V the chip is held in reset.

use cortex_m::peripheral::NVIC;
use stm32f4xx_hal::pac::{self, interrupt};
use stm32f4xx_hal::rcc::{Enable, Rcc};

use super::clock::HZ;
use super::{coils, options};

/// PLS of the voltage detector for 2.9 V.
const DETECTOR_LEVEL: u8 = 7;
/// Its line of EXTI.
const DETECTOR_LINE: u8 = 16;

/// Level 3, as its [option](options::brown_out) says it. The names that the register library has for the levels are upside down.
const BROWN_OUT_LEVEL_3: u32 = 0;

/// Sets the brown-out reset to level 3, below which 168 MHz are out of the flash's reach, unless it already is. That is once in the life
/// of a chip, for the option bytes keep it; every other option stays as it is. Needs a supply above the detector's level.
pub fn set_brown_out(power: &pac::PWR, rcc: &mut Rcc) {
    if options::brown_out() == BROWN_OUT_LEVEL_3 {
        return;
    }
    pac::PWR::enable(rcc);
    detect(power);
    // The detector needs some time to settle: a millisecond.
    cortex_m::asm::delay(HZ / 1000);
    if power.csr().read().pvdo().bit_is_set() {
        return;
    }
    options::set_brown_out(BROWN_OUT_LEVEL_3);
}

/// Watches the supply from now on, with the state that the coils go to.
pub fn watch(power: pac::PWR, lines: &pac::EXTI, rcc: &mut Rcc) {
    pac::PWR::enable(rcc);
    detect(&power);
    lines.rtsr().modify(|_, w| w.tr(DETECTOR_LINE).set_bit());
    lines.imr().modify(|_, w| w.mr(DETECTOR_LINE).set_bit());
    // SAFETY: its handler shares nothing with the tasks but registers that are written whole and the flags above.
    unsafe {
        cortex_m::Peripherals::steal().NVIC.set_priority(pac::Interrupt::PVD, 0);
        NVIC::unmask(pac::Interrupt::PVD);
    }
}

/// Whether the supply is too low to rely on anything.
pub fn low() -> bool {
    // SAFETY: reads a register.
    unsafe { &*pac::PWR::ptr() }.csr().read().pvdo().bit_is_set()
}

fn detect(power: &pac::PWR) {
    power.cr().modify(|_, w| w.pls().set(DETECTOR_LEVEL).pvde().set_bit());
}

/// The supply fell below the detector's level.
#[interrupt]
fn PVD() {
    // SAFETY: writes 1 to clear one flag; the others are not affected.
    unsafe { &*pac::EXTI::ptr() }.pr().write(|w| w.pr(DETECTOR_LINE).clear_bit_by_one());
    coils::force(crate::control::safe_state());
}
