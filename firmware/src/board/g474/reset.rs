//! Why the chip was reset.

use sprag_shared::link::reset_cause::Cause;
use stm32g4::stm32g474 as pac;

/// In the first backup register from the first start on. It is lost with the supply, and not by a sag.
const SUPPLIED: u32 = 0x5A17_0474;

/// Reads the flags of the last reset and clears them. Every reset pulls the reset pin, so the pin counts only when nothing else does. The
/// supply's coming and its sagging set the same flag; a backup register distinguishes them.
pub fn cause(chip: &pac::Peripherals) -> Cause {
    let rcc = &chip.RCC;
    let flags = rcc.csr().read();
    rcc.csr().modify(|_, w| w.rmvf().set_bit());
    rcc.apb1enr1().modify(|_, w| w.pwren().set_bit().rtcapben().set_bit());
    chip.PWR.cr1().modify(|_, w| w.dbp().set_bit());
    let mark = chip.TAMP.bkpr(0);
    let supplied = mark.read().bits() == SUPPLIED;
    // SAFETY: the register holds any bits.
    mark.write(|w| unsafe { w.bits(SUPPLIED) });
    chip.PWR.cr1().modify(|_, w| w.dbp().clear_bit());
    if flags.borrstf().bit_is_set() {
        if supplied { Cause::BrownOut } else { Cause::PowerOn }
    } else if flags.iwdgrstf().bit_is_set() || flags.wwdgrstf().bit_is_set() {
        Cause::Watchdog
    } else if flags.oblrstf().bit_is_set() {
        // New option bytes, in the first start of a chip's life.
        Cause::PowerOn
    } else if flags.sftrstf().bit_is_set() {
        Cause::Software
    } else {
        Cause::Pin
    }
}
