//! The stage of the coils: TIM8 modulates the low sides, PC8 and PC9 are the high sides, the chip's comparators are at the break.

mod comparators;
mod currents;

use sprag_shared::device::coil_test::Switches;
use sprag_shared::settings::wiring::Wiring;
use stm32g4::stm32g474 as pac;

use super::pins::{self, FIRST_HIGH};
use super::supply;
use crate::board::parts::driver::{DrivenCoils, Duty, Stage};
use currents::Currents;

/// Of the modulation, 1/s: above hearing, and far above what a coil's current follows.
const MODULATION: u32 = 20_000;

/// Counts of a period of the modulation.
const PERIOD: u16 = (super::clock::HZ / MODULATION) as u16;

/// Of the break: six samples at an eighth of the timer's clock alike, 0.3 µs, for the edges of the drivers are on the currents, too.
const BREAK_FILTER: u8 = 0b1000;

/// The stage of this board.
pub struct BoardStage {
    currents: Currents,
    duties: [Duty; 2],
}

/// The coils of this board.
pub type BoardCoils = DrivenCoils<BoardStage>;

/// Released.
pub fn begin(chip: &pac::Peripherals, wiring: Wiring, period: f32) -> BoardCoils {
    let currents = Currents::new(chip);
    comparators::begin(chip);
    chip.RCC.apb2enr().modify(|_, w| w.tim8en().set_bit());
    let timer = timer();
    // SAFETY: the value is a period.
    timer.arr().write(|w| unsafe { w.bits(u32::from(PERIOD) - 1) });
    timer.ccmr1_output().write(|w| w.oc1m().pwm_mode1().oc1pe().set_bit().oc2m().pwm_mode1().oc2pe().set_bit());
    timer.ccer().write(|w| w.cc1e().set_bit().cc2e().set_bit());
    // The two comparators instead of the pin.
    timer.af1().write(|w| w.bkine().clear_bit().bkcmp1e().set_bit().bkcmp3e().set_bit());
    timer.egr().write(|w| w.ug().set_bit());
    timer.cr1().write(|w| w.arpe().set_bit().cen().set_bit());
    enable_break();
    DrivenCoils::new(BoardStage { currents, duties: Default::default() }, wiring, period)
}

fn timer() -> &'static pac::tim1::RegisterBlock {
    // SAFETY: the block lies at this address for ever; this module alone writes it, and `force` interrupts it for good.
    unsafe { &*pac::TIM8::ptr() }
}

/// Switches the outputs on, to be switched off for good by a comparator (RM0440, 28.3.16): to their idle level, which is low.
fn enable_break() {
    timer().sr().write(|w| w.bif().clear_bit());
    // SAFETY: every value of the field is a filter.
    timer().bdtr().write(|w| unsafe {
        let w = w.bke().set_bit().bkp().set_bit().bkf().bits(BREAK_FILTER);
        w.aoe().clear_bit().ossi().set_bit().ossr().set_bit().moe().set_bit()
    });
}

impl Stage for BoardStage {
    fn switch(&mut self, coil: usize, wanted: Switches) {
        let reset = if wanted.high { 0 } else { 16 };
        // SAFETY: BSRR has no reserved bits.
        pins::port(2).bsrr().write(|w| unsafe { w.bits(1 << (FIRST_HIGH + coil as u32 + reset)) });
        let counts = self.duties.get_mut(coil).map_or(0, |duty| duty.of(wanted.low, PERIOD));
        timer().ccr(coil).write(|w| w.ccr().set(counts.into()));
    }

    fn currents(&self) -> [f32; 2] {
        self.currents.read()
    }

    fn supply(&self) -> u16 {
        self.currents.supply()
    }

    fn arm(&mut self) {
        enable_break();
    }

    fn tripped(&self) -> bool {
        timer().sr().read().bif().bit_is_set()
    }

    fn supply_is_low(&self) -> bool {
        supply::low()
    }

    fn force(engaged: [bool; 2]) {
        force(engaged);
    }
}

/// Engages with the full voltage or releases, by nothing but registers. Where [`begin`] has not run, their clocks are off and nothing
/// happens: the coils are released then, by resistors.
pub fn force(engaged: [bool; 2]) {
    for (index, engaged) in engaged.into_iter().enumerate() {
        let reset = if engaged { 0 } else { 16 };
        // SAFETY: BSRR has no reserved bits.
        pins::port(2).bsrr().write(|w| unsafe { w.bits(1 << (FIRST_HIGH + index as u32 + reset)) });
        timer().ccr(index).write(|w| w.ccr().set(if engaged { u16::MAX.into() } else { 0 }));
    }
    // Takes the new values over at once instead of at the end of the modulation's period.
    timer().egr().write(|w| w.ug().set_bit());
}
