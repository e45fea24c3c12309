//! 168 MHz from the crystal, or from the internal oscillator where the crystal does not start or stops; and the counter of time.

use cortex_m_rt::exception;
use sprag_shared::device::clock_check::ClockCheck;
use sprag_shared::link::reset_cause::Cause;
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::{Config, Rcc, RccExt};
use stm32f4xx_hal::time::Hertz;

use crate::board::parts::slow_clock::Channel;
use crate::last_words;

/// Of the processor, 1/s.
pub const HZ: u32 = 168_000_000;

/// Of the counter of time, TIM5, 1/s: twice its bus, which is a quarter of the processor's.
pub const COUNTER_HZ: u32 = HZ / 2;

const CRYSTAL: Hertz = Hertz::from_raw(8_000_000);

/// Looks at the crystal, each at least 4 cycles of 16 MHz: some 50 ms at least, where a crystal takes 2 ms.
const PATIENCE: u32 = 200_000;

/// Channel 4 of TIM5, whose input TIM5_OR makes the slow oscillator (RM0090, 18.4.21).
pub const SLOW: Channel =
    Channel { source: (0x50, 1 << 6), mode: (0x1C, 0x0D00), on: 1 << 12, edge: 0x40, came: 1 << 4, missed: 1 << 12 };

/// Starts clocks and counter. Says whether the crystal runs, and what its rate is to be held against; where it does not run, everything
/// runs within the ±1 % (25 °C) of the internal oscillator, which is no measure of time but a controller that works.
pub fn start(rcc: pac::RCC, counter: &pac::TIM5) -> (Rcc, bool, ClockCheck) {
    // The library waits for the crystal for ever, so it is only asked to once the crystal has been seen to run.
    rcc.cr().modify(|_, w| w.hseon().set_bit());
    // A timer, and not the processor's counter of cycles, which a probe that leaves may stop: then no tick would ever be late.
    rcc.apb1enr().modify(|_, w| w.tim5en().set_bit());
    counter.arr().write(|w| w.arr().set(u32::MAX));
    counter.cr1().write(|w| w.cen().set_bit());
    // The crystal takes longer to start than this.
    rcc.csr().modify(|_, w| w.lsion().set_bit());
    SLOW.begin();
    let check = SLOW.check(COUNTER_HZ);
    let crystal = (0..PATIENCE).any(|_| rcc.cr().read().hserdy().bit_is_set());
    let config = if crystal {
        Config::hse(CRYSTAL)
    } else {
        rcc.cr().modify(|_, w| w.hseon().clear_bit());
        Config::hsi()
    };
    let rcc = rcc.constrain().freeze(config.sysclk(Hertz::from_raw(HZ)));
    if crystal {
        rcc.cr().modify(|_, w| w.csson().set_bit());
    }
    (rcc, crystal, check)
}

/// Time, in counts of [`COUNTER_HZ`].
#[inline(always)]
pub fn now() -> u32 {
    // SAFETY: reading a counter has no side effect.
    unsafe { (*pac::TIM5::ptr()).cnt().read().bits() }
}

/// The crystal stopped: the chip now runs at 16 MHz, so no deadline can be kept. It starts anew, without the crystal.
#[exception]
unsafe fn NonMaskableInt() -> ! {
    last_words::leave(Cause::ClockFailure, 0, &[])
}
