//! 168 MHz from the crystal, or from the internal oscillator where the crystal does not start or stops; and the counter of time.

use cortex_m_rt::exception;
use sprag_shared::link::reset_cause::Cause;
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::{Config, Enable, Rcc, RccExt};
use stm32f4xx_hal::time::Hertz;

use crate::last_words;

/// Of the processor, 1/s.
pub const HZ: u32 = 168_000_000;

/// Of the counter of time, TIM5, 1/s: twice its bus, which is a quarter of the processor's.
pub const COUNTER_HZ: u32 = HZ / 2;

const CRYSTAL: Hertz = Hertz::from_raw(8_000_000);

/// Looks at the crystal, each at least 4 cycles of 16 MHz: some 50 ms at least, where a crystal takes 2 ms.
const PATIENCE: u32 = 200_000;

/// Starts clocks and counter. Says whether the crystal runs; where it does not, everything runs within the ±1 % (25 °C) of the internal
/// oscillator, which is no measure of time but a controller that works.
pub fn start(rcc: pac::RCC, counter: &pac::TIM5) -> (Rcc, bool) {
    // The library waits for the crystal for ever, so it is only asked to once the crystal has been seen to run.
    rcc.cr().modify(|_, w| w.hseon().set_bit());
    let crystal = (0..PATIENCE).any(|_| rcc.cr().read().hserdy().bit_is_set());
    let config = if crystal {
        Config::hse(CRYSTAL)
    } else {
        rcc.cr().modify(|_, w| w.hseon().clear_bit());
        Config::hsi()
    };
    let mut rcc = rcc.constrain().freeze(config.sysclk(Hertz::from_raw(HZ)));
    if crystal {
        rcc.cr().modify(|_, w| w.csson().set_bit());
    }
    // A timer, and not the processor's counter of cycles, which a probe that leaves may stop: then no tick would ever be late.
    pac::TIM5::enable(&mut rcc);
    counter.arr().write(|w| w.arr().set(u32::MAX));
    counter.cr1().write(|w| w.cen().set_bit());
    (rcc, crystal)
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
