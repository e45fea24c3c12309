//! Why the program stopped, kept over the reset that follows; and stopping itself: the coils first.

use core::panic::PanicInfo;

use crate::board::{Board, Selected};
use crate::control::safe_state;
use crate::memory::Lasting;
use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
use sprag_shared::link::reset_cause::Cause;

/// Bytes of a file's name that are kept.
pub const NAME: usize = 32;

/// What is told after the start.
#[derive(Clone, Copy)]
pub struct LastWords {
    /// Why the program started.
    pub cause: Cause,
    /// Line of a panic or address of a fault.
    pub place: u32,
    /// How much of the name counts.
    pub length: u8,
    /// End of the name of the file that panicked.
    pub file: [u8; NAME],
}

#[derive(Clone, Copy)]
#[repr(C)]
struct Record {
    /// Which cause, combined with a number that memory does not hold by chance.
    mark: u32,
    place: u32,
    length: u32,
    file: [u8; NAME],
}

const MARK: u32 = 0x5A17_0000;

#[unsafe(link_section = ".uninit.LAST_WORDS")]
static RECORD: Lasting<Record> = Lasting::new();

/// What the program left before the reset, or else what the chip knows of its cause.
pub fn take(chip: Cause) -> LastWords {
    // SAFETY: numbers and bytes hold any bits.
    let record = unsafe { RECORD.read() };
    RECORD.write(Record { mark: 0, ..record });
    let cause = match record.mark.wrapping_sub(MARK) {
        1 => Cause::Software,
        2 => Cause::Panic,
        3 => Cause::HardFault,
        4 => Cause::Watchdog,
        5 => Cause::BrownOut,
        _ => return LastWords { cause: chip, place: 0, length: 0, file: [0; NAME] },
    };
    if !chip.keeps_memory() {
        return LastWords { cause: chip, place: 0, length: 0, file: [0; NAME] };
    }
    LastWords { cause, place: record.place, length: record.length.min(NAME as u32) as u8, file: record.file }
}

/// Coils to the safe state, reason kept, reset.
pub fn leave(cause: Cause, place: u32, file: &[u8]) -> ! {
    cortex_m::interrupt::disable();
    Selected::force_coils(safe_state());
    let mark = match cause {
        Cause::Software => 1,
        Cause::Panic => 2,
        Cause::HardFault => 3,
        Cause::Watchdog => 4,
        Cause::BrownOut => 5,
        Cause::PowerOn | Cause::Pin => 0,
    };
    let mut kept = [0; NAME];
    let end = file.get(file.len().saturating_sub(NAME)..).unwrap_or_default();
    for (kept, byte) in kept.iter_mut().zip(end) {
        *kept = *byte;
    }
    RECORD.write(Record { mark: MARK + mark, place, length: end.len() as u32, file: kept });
    SCB::sys_reset()
}

/// Nothing can be done: the coils stay in the safe state.
pub fn stop() -> ! {
    cortex_m::interrupt::disable();
    loop {
        Selected::force_coils(safe_state());
    }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    let (place, file) = info.location().map_or((0, ""), |location| (location.line(), location.file()));
    leave(Cause::Panic, place, file.as_bytes())
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    leave(Cause::HardFault, frame.pc(), &[])
}
