//! Why the program stopped, retained over the reset that follows; and stopping itself: the coils first.

use core::arch::global_asm;
use core::panic::PanicInfo;

use crate::board::{Board, Selected};
use crate::control::safe_state;
use crate::memory::Lasting;
use crate::stack;
use cortex_m::peripheral::SCB;
use sprag_shared::device::Device;
use sprag_shared::link::Started;
use sprag_shared::link::reset_cause::Cause;

/// Bytes of a file's name that are retained.
pub const NAME: usize = 32;

/// What is reported after the start.
#[derive(Clone, Copy)]
pub struct LastWords {
    /// Why the program started.
    pub cause: Cause,
    /// Line of a panic or address of a fault.
    pub place: u32,
    /// How much of the name counts.
    pub length: u8,
    /// End of the name of the file that panicked; of a fault the registers CFSR, HFSR, BFAR and LR, eight digits each.
    pub file: [u8; NAME],
}

impl LastWords {
    /// How a `device` started that reported this; its settings are `stored` ones.
    pub fn started(&self, device: &Device, stored: bool) -> Started {
        let LastWords { cause, place, length, file } = *self;
        Started { cause, resumed: device.resumes(), stored, restarts: device.restarts(), length, place, file }
    }
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
        6 => Cause::ClockFailure,
        _ => return LastWords { cause: chip, place: 0, length: 0, file: [0; NAME] },
    };
    if !chip.keeps_memory() {
        return LastWords { cause: chip, place: 0, length: 0, file: [0; NAME] };
    }
    LastWords { cause, place: record.place, length: record.length.min(NAME as u32) as u8, file: record.file }
}

/// Coils to the safe state, reason retained, reset.
pub fn leave(cause: Cause, place: u32, file: &[u8]) -> ! {
    cortex_m::interrupt::disable();
    Selected::force_coils(safe_state());
    let mark = match cause {
        Cause::Software => 1,
        Cause::Panic => 2,
        Cause::HardFault => 3,
        Cause::Watchdog => 4,
        Cause::BrownOut => 5,
        Cause::ClockFailure => 6,
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

/// Words of the stack on which faults are handled.
const FAULT_STACK_WORDS: usize = 128;

#[unsafe(link_section = ".uninit.FAULT_STACK")]
static FAULT_STACK: Lasting<[u64; FAULT_STACK_WORDS / 2]> = Lasting::new();

// A stack that has grown beyond the memory bears no handler, so the first thing is another one.
global_asm!(
    ".section .text.HardFault, \"ax\"",
    ".global HardFault",
    ".type HardFault, %function",
    ".thumb_func",
    "HardFault:",
    "mrs r0, msp",
    "ldr r1, ={stack}",
    "add.w r1, r1, #{bytes}",
    "mov sp, r1",
    "b {handler}",
    ".pool",
    stack = sym FAULT_STACK,
    bytes = const 4 * FAULT_STACK_WORDS,
    handler = sym hard_fault,
);

/// What a fault stacks, if it can: r0 to r3, r12, LR, PC, xPSR.
const FRAME_WORDS: usize = 8;

/// The coils first, and nothing is read that may not be there: a fault in here would lock the processor up.
extern "C" fn hard_fault(frame: *const u32) -> ! {
    cortex_m::interrupt::disable();
    Selected::force_coils(safe_state());
    // SAFETY: the registers are always there, and read without effect; the frame lies within the stack's memory.
    let (place, lr, registers) = unsafe {
        let scb = &*SCB::PTR;
        let (place, lr) =
            if stack::holds(frame, FRAME_WORDS) { (frame.add(6).read_volatile(), frame.add(5).read_volatile()) } else { (0, 0) };
        (place, lr, [scb.cfsr.read(), scb.hfsr.read(), scb.bfar.read()])
    };
    let [cfsr, hfsr, bfar] = registers;
    let mut text = [0; NAME];
    for (digits, word) in text.chunks_exact_mut(8).zip([cfsr, hfsr, bfar, lr]) {
        for (place, digit) in digits.iter_mut().rev().enumerate() {
            let value = (word >> (4 * place) & 0xF) as u8;
            *digit = if value < 10 { b'0' + value } else { b'a' + value - 10 };
        }
    }
    leave(Cause::HardFault, place, &text)
}
