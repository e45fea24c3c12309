//! The stage of the coils: TIM8 modulates the low sides, PC8 and PC9 are the high sides, comparators are at the break input.

mod currents;

use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;
use sprag_shared::device::coil_test::Switches as Wanted;
use sprag_shared::settings::wiring::Wiring;
use stm32f4xx_hal::gpio::{Alternate, Output, Pin, PinState, Pull};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::time::Hertz;
use stm32f4xx_hal::timer::{PwmChannel, PwmExt};

pub use currents::Currents;

use super::supply;
use crate::board::parts::driver::{DrivenCoils, Duty, Stage};

/// Of the modulation, 1/s: above hearing, and far above what a coil's current follows.
const MODULATION: Hertz = Hertz::from_raw(20_000);

/// Number of the first coil's high-side pin in port C; the second's is the next.
const FIRST_HIGH: u32 = 8;

/// Pins of the drivers, a pair a coil.
pub struct Outputs {
    /// Low sides.
    pub low: (Pin<'C', 6>, Pin<'C', 7>),
    /// High sides.
    pub high: (Pin<'C', 8>, Pin<'C', 9>),
    /// The timer's break input, low while a coil takes too much.
    pub trip: Pin<'A', 6>,
}

/// The switches of a coil.
struct Switches<L, H> {
    low: L,
    high: H,
    duty: Duty,
}

impl<L: SetDutyCycle, H: OutputPin> Switches<L, H> {
    fn drive(&mut self, wanted: Wanted) {
        // The pins of a chip do not fail, and others would show in the feedback.
        let _ = if wanted.high { self.high.set_high() } else { self.high.set_low() };
        let _ = self.low.set_duty_cycle(self.duty.of(wanted.low, self.low.max_duty_cycle()));
    }
}

/// The stage of this board.
pub struct BoardStage {
    first: Switches<PwmChannel<pac::TIM8, 0>, Pin<'C', 8, Output>>,
    second: Switches<PwmChannel<pac::TIM8, 1>, Pin<'C', 9, Output>>,
    currents: Currents,
}

/// The coils of this board.
pub type BoardCoils = DrivenCoils<BoardStage>;

/// Released.
pub fn begin(timer: pac::TIM8, outputs: Outputs, currents: Currents, wiring: Wiring, period: f32, rcc: &mut Rcc) -> BoardCoils {
    // Pulled up, so that a board without comparators is never stopped by them.
    let _: Pin<'A', 6, Alternate<3>> = outputs.trip.into_alternate::<3>().internal_resistor(Pull::Up);
    let (_, (first, second, ..)) = timer.pwm_hz(MODULATION, rcc);
    let (mut first, mut second) = (first.with(outputs.low.0), second.with(outputs.low.1));
    first.set_duty(0);
    second.set_duty(0);
    first.enable();
    second.enable();
    let high = outputs.high;
    enable_break();
    let stage = BoardStage {
        first: Switches { low: first, high: high.0.into_push_pull_output_in_state(PinState::Low), duty: Duty::default() },
        second: Switches { low: second, high: high.1.into_push_pull_output_in_state(PinState::Low), duty: Duty::default() },
        currents,
    };
    DrivenCoils::new(stage, wiring, period)
}

fn timer() -> &'static pac::tim8::RegisterBlock {
    // SAFETY: the block lies at this address for ever; this module alone writes it once the channels are running, and `force`
    // interrupts it for good.
    unsafe { &*pac::TIM8::ptr() }
}

/// Switches the outputs on, to be switched off for good by a low break input (RM0090, 17.3.12): to their idle level, which is low.
fn enable_break() {
    timer().sr().write(|w| w.bif().clear_bit());
    timer()
        .bdtr()
        .write(|w| w.bke().set_bit().bkp().clear_bit().aoe().clear_bit().ossi().set_bit().ossr().set_bit().moe().set_bit());
}

impl Stage for BoardStage {
    fn switch(&mut self, coil: usize, wanted: Wanted) {
        if coil == 0 { self.first.drive(wanted) } else { self.second.drive(wanted) }
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
    // SAFETY: the block lies at this address for ever, and each register is written whole: whoever is interrupted by this finds his own
    // write done or undone.
    let (timer, port) = (timer(), unsafe { &*pac::GPIOC::ptr() });
    for (index, engaged) in engaged.into_iter().enumerate() {
        let reset = if engaged { 0 } else { 16 };
        // SAFETY: BSRR has no reserved bits.
        port.bsrr().write(|w| unsafe { w.bits(1 << (FIRST_HIGH + index as u32 + reset)) });
        timer.ccr(index).write(|w| w.ccr().set(if engaged { u16::MAX } else { 0 }));
    }
    // Takes the new values over at once instead of at the end of the modulation's period.
    timer.egr().write(|w| w.ug().set_bit());
}
