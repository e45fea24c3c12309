//! 168 MHz from the crystal, or from the internal oscillator where the crystal does not start; and the counter of time.
//!
//! The chip could do 170 MHz. With 168 every bus and every timer has the rates that the F405 has, or twice those.

use sprag_shared::device::clock_check::ClockCheck;
use stm32g4::stm32g474 as pac;

use crate::board::parts::slow_clock::Channel;

/// Of the processor, of both peripheral buses and of all timers, 1/s.
pub const HZ: u32 = 168_000_000;

/// Looks at the crystal, each at least 4 cycles of 16 MHz: some 50 ms at least, where a crystal takes 2 ms.
const PATIENCE: u32 = 200_000;

/// Of the oscillator that feeds the PLL, crystal or internal, its divider makes 4 MHz, …
const CRYSTAL_DIVIDER: u8 = 8 / 4;
const INTERNAL_DIVIDER: u8 = 16 / 4;
/// … of which this is a multiple that, halved, is the processor's.
const MULTIPLIER: u8 = (2 * HZ / 4_000_000) as u8;

/// Channel 1 of TIM5, whose input TIM5_TISEL makes the slow oscillator (RM0440, TIM2 to TIM5).
pub const SLOW: Channel = Channel { source: (0x5C, 1), mode: (0x18, 0x000D), on: 1, edge: 0x34, came: 1 << 1, missed: 1 << 9 };

/// Starts clocks and counter. Says whether the crystal runs, and what its rate is to be held against; where it does not run, everything
/// runs within the ±1 % (25 °C) of the internal oscillator, which is no measure of time but a controller that works.
pub fn start(chip: &pac::Peripherals) -> (bool, ClockCheck) {
    let rcc = &chip.RCC;
    rcc.cr().modify(|_, w| w.hseon().set_bit());
    // A timer, and not the processor's counter of cycles, which a probe that leaves may stop: then no tick would ever be late.
    rcc.apb1enr1().modify(|_, w| w.tim5en().set_bit());
    // SAFETY: every value of the register is a period.
    chip.TIM5.arr().write(|w| unsafe { w.bits(u32::MAX) });
    chip.TIM5.cr1().write(|w| w.cen().set_bit());
    // The crystal takes longer to start than this.
    rcc.csr().modify(|_, w| w.lsion().set_bit());
    SLOW.begin();
    let check = SLOW.check(HZ);
    let crystal = (0..PATIENCE).any(|_| rcc.cr().read().hserdy().bit_is_set());
    if !crystal {
        rcc.cr().modify(|_, w| w.hseon().clear_bit());
    }
    // Above 150 MHz the regulator must be in its range 1 boost mode, and the flash has four wait states (RM0440, 3.3.3 and 6.1.5).
    rcc.apb1enr1().modify(|_, w| w.pwren().set_bit());
    chip.PWR.cr5().modify(|_, w| w.r1mode().clear_bit());
    chip.FLASH.acr().modify(|_, w| w.latency().wait4().prften().set_bit().icen().set_bit().dcen().set_bit());
    while !chip.FLASH.acr().read().latency().is_wait4() {}
    let divider = if crystal { CRYSTAL_DIVIDER } else { INTERNAL_DIVIDER };
    // SAFETY: the fields hold the divider less 1, and the multiplier, within what they may be.
    rcc.pllcfgr().write(|w| unsafe {
        let w = if crystal { w.pllsrc().hse() } else { w.pllsrc().hsi16() };
        w.pllm().bits(divider - 1).plln().bits(MULTIPLIER).pllr().div2().pllren().set_bit()
    });
    rcc.cr().modify(|_, w| w.pllon().set_bit());
    while rcc.cr().read().pllrdy().bit_is_clear() {}
    // By way of half the rate, for at least a microsecond (RM0440, 7.2.7).
    rcc.cfgr().modify(|_, w| w.hpre().div2());
    rcc.cfgr().modify(|_, w| w.sw().pll());
    while !rcc.cfgr().read().sws().is_pll() {}
    cortex_m::asm::delay(HZ / 1_000_000);
    rcc.cfgr().modify(|_, w| w.hpre().div1());
    if crystal {
        rcc.cr().modify(|_, w| w.csson().set_bit());
    }
    (crystal, check)
}

/// Time, in counts of [`HZ`].
#[inline(always)]
pub fn now() -> u32 {
    // SAFETY: reading a counter has no side effect.
    unsafe { (*pac::TIM5::ptr()).cnt().read().bits() }
}
