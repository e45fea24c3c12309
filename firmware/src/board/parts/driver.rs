//! The two coils: each between a high-side switch, on while the clutch is to be engaged, and a low-side switch that is modulated.
//!
//! With the high side on, the current goes round through the upper diode while the low side is off, and decays slowly: 20 kHz hold it
//! nearly constant. With both off it flows back into the supply through both diodes and dies in a few milliseconds.
//!
//! The feedback is the current. It proves that the coil is whole and driven, not that the clutch has closed. Comparators on both shunts
//! at the timer's break input switch the low sides off by hardware, whatever the program does, until the next self-test.

use sprag_shared::control::monitor::coil::CoilReading;
use sprag_shared::device::coil::{FULL_SCALE, compare};
use sprag_shared::device::coil_test::{Coil, CoilDesign, Switches};
use sprag_shared::device::conditions;
use sprag_shared::settings::wiring::Wiring;

use crate::board::Coils;

/// What drives both coils, and looks at them.
pub trait Stage {
    /// Sets the switches of a coil, 0 or 1. Both off takes the current away as fast as can be.
    fn switch(&mut self, coil: usize, wanted: Switches);

    /// The latest currents, A.
    fn currents(&self) -> [f32; 2];

    /// The converter's latest counts of the coils' supply, behind its divider.
    fn supply(&self) -> u16;

    /// Lets the low sides be driven, until a comparator switches them off.
    fn arm(&mut self);

    /// A comparator has switched the low sides off.
    fn tripped(&self) -> bool;

    /// The supply is too low to rely on anything.
    fn supply_is_low(&self) -> bool;

    /// As [`crate::board::Board::force_coils`].
    fn force(engaged: [bool; 2]);
}

/// The share of the time in which a low side was last to conduct, and a timer's counts for it.
#[derive(Default)]
pub struct Duty {
    share: f32,
    counts: u16,
}

impl Duty {
    /// Counts for `share`, of `period` in all: always the same `period`.
    pub fn of(&mut self, share: f32, period: u16) -> u16 {
        if share != self.share {
            (self.share, self.counts) = (share, compare(share, period));
        }
        self.counts
    }
}

/// Two coils, driven and watched.
pub struct DrivenCoils<S> {
    stage: S,
    coils: [Coil; 2],
    wiring: Wiring,
    design: CoilDesign,
    tested: bool,
}

impl<S: Stage> DrivenCoils<S> {
    /// Released, by a stage that is armed; with a tick every `period` s.
    pub fn new(stage: S, wiring: Wiring, period: f32) -> DrivenCoils<S> {
        DrivenCoils { stage, coils: Default::default(), wiring, design: CoilDesign::of(&wiring, period), tested: false }
    }
}

impl<S: Stage> Coils for DrivenCoils<S> {
    fn read(&mut self) -> [CoilReading; 2] {
        // The comparators do not say which of them it was.
        let [first, second] = if self.stage.tripped() { [FULL_SCALE; 2] } else { self.stage.currents() };
        let [of_first, of_second] = &mut self.coils;
        [of_first.see(&self.design, first), of_second.see(&self.design, second)]
    }

    fn drive(&mut self, command: [bool; 2], tested: bool) {
        if tested && !self.tested {
            self.stage.arm();
        }
        self.tested = tested;
        let low = self.stage.supply_is_low();
        let [first, second] = if low { crate::control::safe_state() } else { command };
        let [of_first, of_second] = &mut self.coils;
        self.stage.switch(0, of_first.drive(&self.design, first, tested));
        self.stage.switch(1, of_second.drive(&self.design, second, tested));
        if !low && self.stage.supply_is_low() {
            // It began to fall while this was written, and its interrupt has been overwritten.
            S::force(crate::control::safe_state());
        }
    }

    #[inline(never)]
    fn set_period(&mut self, period: f32) {
        self.design = CoilDesign::of(&self.wiring, period);
    }

    #[inline]
    fn supply(&self) -> Option<f32> {
        Some(conditions::supply(self.stage.supply()))
    }
}
