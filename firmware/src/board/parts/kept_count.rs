//! An encoder's counter that runs on through a reset.
//!
//! A reset of the chip sets it to 0. So its count is copied into memory that a reset leaves alone, many times a second and without the
//! processor. The first instructions of the next start, which are [`count_on!`]'s, put it back and let it count. What the rack moves in
//! between, some 70 µs, is all that is lost.

use crate::memory::Lasting;

/// Where the count is copied to: its low half.
#[unsafe(link_section = ".uninit.ENCODER")]
pub static COUNT: Lasting<u32> = Lasting::new();

/// Has the start-up code, before it fills the memory, store each value of a table at its address (up to the address 0), put
/// [`COUNT`] back into the counter of the timer whose registers begin at an address, and let it count. The timer is one of
/// ST's: CR1 at 0, CNT at 0x24. Rust has nothing to say yet: every register holds its reset value, and the memory nothing.
macro_rules! count_on {
    ($steps:path, $timer:literal) => {
        core::arch::global_asm!(
            ".section .text.__pre_init, \"ax\"",
            ".global __pre_init",
            ".type __pre_init, %function",
            ".thumb_func",
            "__pre_init:",
            "ldr r0, ={steps}",
            "2: ldm r0!, {{r1, r2}}",
            "cbz r1, 3f",
            "str r2, [r1]",
            "b 2b",
            // CNT, then CEN of CR1.
            "3: ldr r0, ={count}",
            "ldr r0, [r0]",
            "ldr r1, ={timer}",
            "str r0, [r1, #0x24]",
            "movs r0, #1",
            "str r0, [r1]",
            "bx lr",
            ".pool",
            steps = sym $steps,
            count = sym $crate::board::parts::kept_count::COUNT,
            timer = const $timer,
        );
    };
}

pub(crate) use count_on;
