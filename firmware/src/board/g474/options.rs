//! Option bytes: what a chip keeps for ever, until the whole of it is erased.

use sprag_shared::link::Protection;
use stm32g4::stm32g474 as pac;

/// Keys of the flash's registers, and of the option bytes.
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];
const OPTION_KEYS: [u32; 2] = [0x0819_2A3B, 0x4C5D_6E7F];

/// RDP for no protection against reading; any other value but 0xCC is level 1, and 0xCC can never be undone.
const OPEN: u8 = 0xAA;
const LEVEL_1: u8 = 0x55;

/// Bits of a page's address.
const PAGE: u32 = 11;

fn flash() -> &'static pac::flash::RegisterBlock {
    // SAFETY: the block lies at this address for ever. The options' registers are used at the start, and by the link's task.
    unsafe { &*pac::FLASH::ptr() }
}

/// Programs the option bytes with a `change` of their registers. The chip takes them over by a reset.
pub fn program(change: impl FnOnce(&pac::flash::RegisterBlock)) {
    let flash = flash();
    // SAFETY: the keys are what the registers take.
    unsafe {
        for key in KEYS {
            flash.keyr().write(|w| w.bits(key));
        }
        for key in OPTION_KEYS {
            flash.optkeyr().write(|w| w.bits(key));
        }
    }
    change(flash);
    flash.cr().modify(|_, w| w.optstrt().set_bit());
    while flash.sr().read().bsy().bit_is_set() {}
}

/// Locks the registers again.
fn lock() {
    flash().cr().modify(|_, w| w.optlock().set_bit().lock().set_bit());
}

/// The last page of a program that ends before `end`, all of it in bank 1.
fn last_page(end: u32) -> u32 {
    (end.saturating_sub(1) & 0x0003_FFFF) >> PAGE
}

/// Of a program that ends before `end`: the first area of bank 1 begins with page 0 and has its last one.
pub fn protection(end: u32) -> Protection {
    let area = flash().wrp1ar().read().bits();
    Protection {
        reading: flash().optr().read().rdp().bits() != OPEN,
        writing: area & 0x7F == 0 && area >> 16 & 0x7F >= last_page(end),
    }
}

/// Protects it. A level 2 that somebody has set stays.
pub fn protect(end: u32) -> bool {
    program(|flash| {
        // SAFETY: the level and the pages are ones that there are.
        unsafe {
            flash.optr().modify(|r, w| w.rdp().bits(if r.rdp().bits() == OPEN { LEVEL_1 } else { r.rdp().bits() }));
            flash.wrp1ar().modify(|r, w| w.bits(r.bits() & !0x007F_007F | last_page(end) << 16));
        }
    });
    lock();
    protection(end) == Protection { reading: true, writing: true }
}
