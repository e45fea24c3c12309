//! 168 MHz from the crystal, or from the internal oscillator where the crystal does not start or stops; and the counter of cycles.

use cortex_m_rt::exception;
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::{Config, Rcc, RccExt};
use stm32f4xx_hal::time::Hertz;

use super::coils;

/// Of the processor and its counter, 1/s.
pub const HZ: u32 = 168_000_000;

const CRYSTAL: Hertz = Hertz::from_raw(8_000_000);

/// Looks at the crystal, each at least 4 cycles of 16 MHz: some 50 ms at least, where a crystal takes 2 ms.
const PATIENCE: u32 = 200_000;

/// Starts clocks and counter. Says whether the crystal runs; where it does not, everything runs within the ±1 % (25 °C) of the internal
/// oscillator, which is no measure of time but a controller that works.
pub fn start(mut core: cortex_m::Peripherals, rcc: pac::RCC, debug: &pac::DBGMCU) -> (Rcc, bool) {
    // The library waits for the crystal for ever, so it is only asked to once the crystal has been seen to run.
    rcc.cr().modify(|_, w| w.hseon().set_bit());
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
    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
    // Otherwise the counter stands still while the processor sleeps.
    debug.cr().modify(|_, w| w.dbg_sleep().set_bit());
    (rcc, crystal)
}

/// The crystal stopped: the chip now runs at 16 MHz, so no deadline can be kept. It starts anew, without the crystal.
#[exception]
unsafe fn NonMaskableInt() -> ! {
    coils::force(crate::control::safe_state());
    cortex_m::peripheral::SCB::sys_reset()
}
