//! Why the chip was reset.

use sprag_shared::link::reset_cause::Cause;
use stm32f4xx_hal::pac;

/// Reads the flags of the last reset and clears them. Every reset pulls the reset pin, so the pin counts only when nothing else does, and
/// the supply's coming sets the flag of its sagging, too.
pub fn cause(rcc: &pac::RCC) -> Cause {
    let flags = rcc.csr().read();
    rcc.csr().modify(|_, w| w.rmvf().set_bit());
    if flags.porrstf().bit_is_set() {
        Cause::PowerOn
    } else if flags.borrstf().bit_is_set() {
        Cause::BrownOut
    } else if flags.wdgrstf().bit_is_set() || flags.wwdgrstf().bit_is_set() {
        Cause::Watchdog
    } else if flags.sftrstf().bit_is_set() {
        Cause::Software
    } else {
        Cause::Pin
    }
}
