//! Option bytes: what a chip keeps for ever, until the whole of it is erased.

use sprag_shared::link::Protection;
use stm32f4xx_hal::pac;

/// Keys of the option bytes.
const KEYS: [u32; 2] = [0x0819_2A3B, 0x4C5D_6E7F];

/// Of OPTCR (RM0090, 3.9.9): the level of the protection against reading, a bit for each sector that may be written, and the
/// level of the brown-out reset.
const READING: u32 = 0xFF << 8;
const WRITABLE: u32 = 16;
const BROWN_OUT: u32 = 3 << 2;

/// READING for none; any other value but 0xCC is level 1, and 0xCC can never be undone.
const OPEN: u32 = 0xAA << 8;
const LEVEL_1: u32 = 0x55 << 8;

fn flash() -> &'static pac::flash::RegisterBlock {
    // SAFETY: the block lies at this address for ever. The options' registers are used at the start, and by the link's task.
    unsafe { &*pac::FLASH::ptr() }
}

fn options() -> u32 {
    flash().optcr().read().bits()
}

/// Programs the option bytes: of those that `which` names, these `values`. The processor stands meanwhile.
fn program(which: u32, values: u32) {
    let flash = flash();
    for key in KEYS {
        flash.optkeyr().write(|w| w.optkeyr().set(key));
    }
    // SAFETY: the other options stay as they are, and these are ones that there are.
    flash.optcr().modify(|r, w| unsafe { w.bits(r.bits() & !which | values) });
    flash.optcr().modify(|_, w| w.optstrt().set_bit());
    while flash.sr().read().bsy().bit_is_set() {}
    flash.optcr().modify(|_, w| w.optlock().set_bit());
}

/// The level of the brown-out reset: RM0090 counts downward, 3 (off) to 0.
pub fn brown_out() -> u32 {
    (options() & BROWN_OUT) >> 2
}

/// Sets it.
pub fn set_brown_out(level: u32) {
    program(BROWN_OUT, level << 2);
}

/// The sectors of a program that ends before `end`, as their bits: the vectors', and from number 4 on.
fn sectors(end: u32) -> u32 {
    let last = match end.saturating_sub(1) & 0x000F_FFFF {
        0..0x2_0000 => 4,
        place => 4 + (place >> 17),
    };
    ((1 << (last + 1)) - (1 << 4) + 1) << WRITABLE
}

/// Of a program that ends before `end`.
pub fn protection(end: u32) -> Protection {
    Protection { reading: options() & READING != OPEN, writing: options() & sectors(end) == 0 }
}

/// Protects it. A level 2 that somebody has set stays. Whether the options are now so.
pub fn protect(end: u32) -> bool {
    let level = if options() & READING == OPEN { LEVEL_1 } else { options() & READING };
    program(READING | sectors(end), level);
    protection(end) == Protection { reading: true, writing: true }
}
