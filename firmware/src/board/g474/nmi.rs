//! The interrupt that cannot be masked: a crystal that stops, or a word of flash that its check bits cannot mend.

use cortex_m_rt::exception;
use sprag_shared::link::reset_cause::Cause;
use stm32g4::stm32g474 as pac;

use super::storage;
use crate::last_words;

/// A word of the settings' that is broken, as after a power cut, is one that cannot be read. A broken word of the program is a fault. A
/// crystal that stopped leaves the chip at 16 MHz, so no deadline can be kept: it starts anew, without the crystal.
#[exception]
unsafe fn NonMaskableInt() {
    // SAFETY: reads a register.
    let stopped = unsafe { &*pac::RCC::ptr() }.cifr().read().cssf().bit_is_set();
    match storage::broken_word() {
        _ if stopped => last_words::leave(Cause::ClockFailure, 0, &[]),
        Some(address) if storage::holds(address) => storage::note_broken(),
        Some(address) => last_words::leave(Cause::HardFault, address, &[]),
        None => last_words::leave(Cause::HardFault, 0, &[]),
    }
}
