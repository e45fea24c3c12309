//! A status light that a low level lights.

use embedded_hal::digital::{OutputPin, PinState};
use sprag_shared::device::light::{Shown, lit, lit_without_crystal};

use crate::board::Light;

/// The light.
pub struct PinLight<P> {
    pin: P,
    crystal: bool,
}

impl<P: OutputPin> PinLight<P> {
    /// At a pin that is high, of a chip that runs with or without its crystal.
    pub fn new(pin: P, crystal: bool) -> PinLight<P> {
        PinLight { pin, crystal }
    }
}

impl<P: OutputPin> Light for PinLight<P> {
    fn show(&mut self, shown: Shown, slot: u32) {
        let pattern = if self.crystal { lit } else { lit_without_crystal };
        // The pins of a chip do not fail.
        let _ = self.pin.set_state(PinState::from(!pattern(shown, slot)));
    }
}
