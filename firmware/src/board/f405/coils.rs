//! The two coils: each between a high-side switch, on while the clutch is to be engaged, and a low-side switch that is modulated.
//!
//! With the high side on, the current goes round through the upper diode while the low side is off, and decays slowly: 20 kHz hold it
//! nearly constant. With both off it flows back into the supply through both diodes and dies in a few milliseconds.
//!
//! The feedback is the current. It proves that the coil is whole and driven, not that the clutch has closed. Comparators on both shunts that
//! pull the timer's break input low switch the low sides off by hardware, whatever the program does, until the next self-test.

mod currents;

use embedded_hal::digital::OutputPin;
use embedded_hal::pwm::SetDutyCycle;
use sprag_shared::control::monitor::coil::CoilReading;
use sprag_shared::device::coil::{FULL_SCALE, compare};
use sprag_shared::device::coil_test::{Coil, CoilDesign, Switches as Wanted};
use stm32f4xx_hal::gpio::{Alternate, Output, Pin, PinState, Pull};
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
    /// The timer's break input, low while a coil takes too much.
    pub trip: Pin<'A', 6>,
}

/// The switches of a coil.
pub struct Switches<L, H> {
    low: L,
    high: H,
    /// The share of the time in which the low side was last to conduct, and the timer's counts for it.
    share: f32,
    counts: u16,
}

/// The switches of the first coil.
pub type FirstSwitches = Switches<PwmChannel<pac::TIM8, 0>, Pin<'C', 8, Output>>;
/// The switches of the second coil.
pub type SecondSwitches = Switches<PwmChannel<pac::TIM8, 1>, Pin<'C', 9, Output>>;

/// The coils of this board.
pub type BoardCoils = DrivenCoils<FirstSwitches, SecondSwitches>;

/// Two coils, driven and watched.
pub struct DrivenCoils<A, B> {
    switches: (A, B),
    coils: [Coil; 2],
    currents: Currents,
    design: CoilDesign,
    tested: bool,
}

/// What drives a coil.
pub trait Drive {
    /// Both off takes the current away as fast as can be.
    fn drive(&mut self, wanted: Wanted);
}

impl<L: SetDutyCycle, H: OutputPin> Drive for Switches<L, H> {
    fn drive(&mut self, wanted: Wanted) {
        // The pins of a chip do not fail, and others would show in the feedback.
        let _ = if wanted.high { self.high.set_high() } else { self.high.set_low() };
        if wanted.low != self.share {
            (self.share, self.counts) = (wanted.low, compare(wanted.low, self.low.max_duty_cycle()));
        }
        let _ = self.low.set_duty_cycle(self.counts);
    }
}

/// Released.
pub fn begin(timer: pac::TIM8, outputs: Outputs, currents: Currents, design: CoilDesign, rcc: &mut Rcc) -> BoardCoils {
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
    let switches = (
        Switches { low: first, high: high.0.into_push_pull_output_in_state(PinState::Low), share: 0.0, counts: 0 },
        Switches { low: second, high: high.1.into_push_pull_output_in_state(PinState::Low), share: 0.0, counts: 0 },
    );
    DrivenCoils { switches, coils: Default::default(), currents, design, tested: false }
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

/// The break input has switched the low sides off.
fn tripped() -> bool {
    timer().sr().read().bif().bit_is_set()
}

impl<A: Drive, B: Drive> Coils for DrivenCoils<A, B> {
    fn read(&mut self) -> [CoilReading; 2] {
        // The comparators do not say which of them it was.
        let [first, second] = if tripped() { [FULL_SCALE; 2] } else { self.currents.read() };
        let [of_first, of_second] = &mut self.coils;
        [of_first.see(&self.design, first), of_second.see(&self.design, second)]
    }

    fn drive(&mut self, command: [bool; 2], tested: bool) {
        if tested && !self.tested {
            enable_break();
        }
        self.tested = tested;
        let low = supply::low();
        let [first, second] = if low { crate::control::safe_state() } else { command };
        let [of_first, of_second] = &mut self.coils;
        self.switches.0.drive(of_first.drive(&self.design, first, tested));
        self.switches.1.drive(of_second.drive(&self.design, second, tested));
        if !low && supply::low() {
            // It began to fall while this was written, and its interrupt has been overwritten.
            force(crate::control::safe_state());
        }
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
