//! The control task's interrupt: SysTick, which every Cortex-M has and every emulator knows.

use crate::board::{Board, Selected};
use cortex_m::peripheral::{SCB, SYST};

/// Counts that SysTick can hold.
const MOST: u32 = 0x00FF_FFFF;

const ENABLE: u32 = 1;
const INTERRUPT: u32 = 1 << 1;
const PROCESSOR_CLOCK: u32 = 1 << 2;
/// Set when the count has wrapped since the register was last read.
const WRAPPED: u32 = 1 << 16;

/// Makes the period of the control task `counts` of the processor's clock, from now on.
pub fn set_period(counts: u32) {
    // SAFETY: only this module uses the timer, and any count is a period.
    unsafe {
        let timer = &*SYST::PTR;
        timer.csr.write(0);
        timer.rvr.write(counts.saturating_sub(1).clamp(1, MOST));
        timer.cvr.write(0);
        timer.csr.write(ENABLE | INTERRUPT | PROCESSOR_CLOCK);
    }
}

/// In the interrupt: whether it is the timer's, or pended.
#[inline]
pub fn by_timer() -> bool {
    // SAFETY: reading the register clears its flag, which nobody else asks for.
    let due = unsafe { (*SYST::PTR).csr.read() } & WRAPPED != 0;
    if due {
        Selected::ticked();
    }
    due
}

/// Whether the timer's next interrupt is further away than this, µs.
pub fn is_further_than(microseconds: u32) -> bool {
    // SAFETY: reading the count has no side effect.
    let left = unsafe { (*SYST::PTR).cvr.read() };
    left > Selected::CORE_HZ / 1_000_000 * microseconds
}

/// Lets the control task run as soon as nothing more urgent does.
pub fn pend() {
    SCB::set_pendst();
}
