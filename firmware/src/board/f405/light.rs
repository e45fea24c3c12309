//! The status light at PC12, lit by a low level.

use sprag_shared::device::light::{Shown, lit, lit_without_crystal};
use stm32f4xx_hal::gpio::{Output, Pin, PinState};

use crate::board::Light;

/// The light.
pub struct BoardLight {
    pin: Pin<'C', 12, Output>,
    crystal: bool,
}

impl BoardLight {
    /// Dark, at its pin, of a chip that runs with or without its crystal.
    pub fn new(pin: Pin<'C', 12>, crystal: bool) -> BoardLight {
        BoardLight { pin: pin.into_push_pull_output_in_state(PinState::High), crystal }
    }
}

impl Light for BoardLight {
    fn show(&mut self, shown: Shown, slot: u32) {
        let pattern = if self.crystal { lit } else { lit_without_crystal };
        self.pin.set_state(PinState::from(!pattern(shown, slot)));
    }
}
