//! The two coils: each between a high-side switch, on while the clutch is to be engaged, and a low-side switch that is modulated.
//!
//! With the high side on, the current goes round through the upper diode while the low side is off, and decays slowly: 20 kHz hold it
//! nearly constant. With both off it flows back into the supply through both diodes and dies in a few milliseconds.
//!
//! The feedback is the current. It proves that the coil is whole and driven, not that the clutch has closed.

mod currents;

use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;
use sprag_shared::device::coil::{Feedback, PeakHold, PeakHoldState, compare};
use stm32f4xx_hal::gpio::{Output, Pin, PinState};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::time::Hertz;
use stm32f4xx_hal::timer::{PwmChannel, PwmExt};

pub use currents::Currents;

use super::supply;
use crate::board::Coils;

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
}

/// The switches of a coil.
pub struct Switches<L, H> {
    low: L,
    high: H,
}

/// The switches of the first coil.
pub type FirstSwitches = Switches<PwmChannel<pac::TIM8, 0>, Pin<'C', 8, Output>>;
/// The switches of the second coil.
pub type SecondSwitches = Switches<PwmChannel<pac::TIM8, 1>, Pin<'C', 9, Output>>;

/// The coils of this board.
pub type BoardCoils = DrivenCoils<FirstSwitches, SecondSwitches>;

/// Two coils, driven and watched.
pub struct DrivenCoils<A, B> {
    coils: (A, B),
    states: [PeakHoldState; 2],
    feedback: [Feedback; 2],
    currents: Currents,
    peak_hold: PeakHold,
    threshold: f32,
}

/// What drives a coil.
pub trait Drive {
    /// With a duty of 0 to 1, where 0 takes the current away as fast as can be.
    fn drive(&mut self, duty: f32);
}

impl<L: SetDutyCycle, H: OutputPin> Drive for Switches<L, H> {
    fn drive(&mut self, duty: f32) {
        // The pins of a chip do not fail, and others would show in the feedback.
        let _ = if duty > 0.0 { self.high.set_high() } else { self.high.set_low() };
        let _ = self.low.set_duty_cycle(compare(duty, self.low.max_duty_cycle()));
    }
}

/// Released, with how to drive them and from which current, A, on they count as engaged.
pub fn begin(timer: pac::TIM8, outputs: Outputs, currents: Currents, how: (PeakHold, f32), rcc: &mut Rcc) -> BoardCoils {
    let (_, (first, second, ..)) = timer.pwm_hz(MODULATION, rcc);
    let (mut first, mut second) = (first.with(outputs.low.0), second.with(outputs.low.1));
    first.set_duty(0);
    second.set_duty(0);
    first.enable();
    second.enable();
    let high = outputs.high;
    let coils = (
        Switches { low: first, high: high.0.into_push_pull_output_in_state(PinState::Low) },
        Switches { low: second, high: high.1.into_push_pull_output_in_state(PinState::Low) },
    );
    let (peak_hold, threshold) = how;
    DrivenCoils { coils, states: Default::default(), feedback: Default::default(), currents, peak_hold, threshold }
}

impl<A: Drive, B: Drive> Coils for DrivenCoils<A, B> {
    fn engaged(&mut self) -> [bool; 2] {
        let [first, second] = self.currents.read();
        let [of_first, of_second] = &mut self.feedback;
        [of_first.engaged(first, self.threshold), of_second.engaged(second, self.threshold)]
    }

    fn drive(&mut self, command: [bool; 2]) {
        let [first, second] = if supply::low() { crate::control::safe_state() } else { command };
        let [of_first, of_second] = &mut self.states;
        self.coils.0.drive(self.peak_hold.step(of_first, first));
        self.coils.1.drive(self.peak_hold.step(of_second, second));
    }
}

/// Engages with the full voltage or releases, by nothing but registers. Where [`begin`] has not run, their clocks are off and nothing
/// happens: the coils are released then, by resistors.
pub fn force(engaged: [bool; 2]) {
    // SAFETY: the blocks lie at these addresses for ever, and each register is written whole: whoever is interrupted by this finds
    // his own write done or undone.
    let (timer, port) = unsafe { (&*pac::TIM8::ptr(), &*pac::GPIOC::ptr()) };
    for (index, engaged) in engaged.into_iter().enumerate() {
        let reset = if engaged { 0 } else { 16 };
        // SAFETY: BSRR has no reserved bits.
        port.bsrr().write(|w| unsafe { w.bits(1 << (FIRST_HIGH + index as u32 + reset)) });
        timer.ccr(index).write(|w| w.ccr().set(if engaged { u16::MAX } else { 0 }));
    }
    // Takes the new values over at once instead of at the end of the modulation's period.
    timer.egr().write(|w| w.ug().set_bit());
}
