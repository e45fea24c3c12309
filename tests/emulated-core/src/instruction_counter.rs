//! Counting instructions, where the emulator makes that possible.
//!
//! Under QEMU with `-icount shift=0` every instruction takes one virtual nanosecond and TIM2 counts at 1 GHz, so the
//! timer's difference is a number of instructions, the same in every run. (On silicon it would be timer ticks.)

/// The counter; the reads themselves do not count.
#[derive(Debug)]
pub struct InstructionCounter {
    overhead_per_read: u32,
    overhead_so_far: u32,
}

impl InstructionCounter {
    /// Starts the timer and measures what one read costs.
    pub fn start() -> Self {
        timer::start();
        let mut counter = Self { overhead_per_read: 0, overhead_so_far: 0 };
        let before = counter.read();
        let after = counter.read();
        counter.overhead_per_read = after.wrapping_sub(before);
        counter
    }

    /// The count. Only wrapping differences mean something, over less than 2³² instructions; on the host they are 0.
    // Never inlined: a read must cost the same wherever it stands.
    #[inline(never)]
    pub fn read(&mut self) -> u32 {
        self.overhead_so_far = self.overhead_so_far.wrapping_add(self.overhead_per_read);
        timer::count().wrapping_sub(self.overhead_so_far)
    }
}

#[cfg(target_os = "none")]
mod timer {
    //! TIM2, the board's 32-bit timer.

    const RCC_APB1ENR: *mut u32 = 0x4002_3840 as *mut u32;
    const TIM2_CR1: *mut u32 = 0x4000_0000 as *mut u32;
    const TIM2_EGR: *mut u32 = 0x4000_0014 as *mut u32;
    const TIM2_CNT: *mut u32 = 0x4000_0024 as *mut u32;
    const TIM2_PSC: *mut u32 = 0x4000_0028 as *mut u32;
    const TIM2_ARR: *mut u32 = 0x4000_002c as *mut u32;

    /// Lets the timer run freely over all 32 bits, without prescaler and without interrupt.
    pub fn start() {
        // SAFETY: these are the addresses of the STM32F405's reference manual, aligned and always mapped; nothing else
        // in this single-threaded program touches them, and no interrupt is enabled.
        unsafe {
            RCC_APB1ENR.write_volatile(RCC_APB1ENR.read_volatile() | 1);
            // The first access after enabling the clock must come two cycles later; a read back waits for it.
            RCC_APB1ENR.read_volatile();
            TIM2_PSC.write_volatile(0);
            TIM2_ARR.write_volatile(u32::MAX);
            TIM2_EGR.write_volatile(1);
            TIM2_CR1.write_volatile(1);
        }
    }

    /// The timer's count.
    #[inline(always)]
    pub fn count() -> u32 {
        // SAFETY: as in `start`; reading the count has no side effect.
        unsafe { TIM2_CNT.read_volatile() }
    }
}

#[cfg(not(target_os = "none"))]
mod timer {
    //! The host has no such timer.

    pub fn start() {}

    pub fn count() -> u32 {
        0
    }
}
