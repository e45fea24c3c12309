//! How deep the stack has been: what was painted at the start and has changed since.

use core::ptr;

/// What nobody writes by chance.
const PAINT: u32 = 0xA5C3_5A3C;

/// Bytes below the stack pointer that are left alone, for interrupts and for painting itself.
const MARGIN: usize = 128;

unsafe extern "C" {
    static _stack_end: u32;
    static _stack_start: u32;
}

/// Whether so many `words` from `place` on lie in the stack's memory.
pub fn holds(place: *const u32, words: usize) -> bool {
    let (end, start) = (&raw const _stack_end as usize, &raw const _stack_start as usize);
    let place = place as usize;
    place.is_multiple_of(4) && place >= end && place.checked_add(4 * words).is_some_and(|above| above <= start)
}

/// Paints what is not used yet.
pub fn paint() {
    let mut place = (&raw const _stack_end).cast_mut();
    let end = cortex_m::register::msp::read() as usize - MARGIN;
    while (place as usize) < end {
        // SAFETY: between the end of the stack and its pointer nobody has anything.
        unsafe {
            ptr::write_volatile(place, PAINT);
            place = place.add(1);
        }
    }
}

/// Bytes that have been used at the deepest.
pub fn deepest() -> u32 {
    let (mut place, start) = (&raw const _stack_end, &raw const _stack_start);
    // SAFETY: the stack's memory is always there, aligned, and holds any bits.
    unsafe {
        while place < start && ptr::read_volatile(place) == PAINT {
            place = place.add(1);
        }
    }
    (start as usize - place as usize) as u32
}
