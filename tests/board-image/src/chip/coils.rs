//! How the coils are driven: ports and timer on the way there, their currents on the way back.

use super::Chip;
use crate::model::Model;
use crate::peripheral::converter::Inputs;
use crate::time::microseconds;

/// Of the comparators on the board with an F4, A (docs/board.md).
const BREAK: f64 = 1.24;

impl Chip {
    /// Whether the high side of a coil is commanded on, and for which share of the time its low side.
    pub fn drive(&self, coil: usize) -> (bool, f64) {
        let port = &self.ports[2];
        let high = port.output(8 + coil as u32).unwrap_or(false);
        let function = if self.model == Model::G474 { 4 } else { 3 };
        let modulated = port.function(6 + coil as u32) == Some(function);
        (high, if modulated { self.modulation.duty(coil as u32) } else { 0.0 })
    }

    /// Whether a coil's current asks the timer for a break: by the comparators on an F4's board, at pin PA6, or by those of a G4.
    fn asks_for_break(&self) -> bool {
        let mut currents = self.coils.iter().map(|coil| coil.current).enumerate();
        match self.model {
            Model::F405 => {
                let wired = self.ports[0].function(6) == Some(3) && self.modulation.breaks_at(false);
                wired && currents.any(|(_, current)| current > BREAK)
            }
            Model::G474 => currents.any(|(coil, current)| {
                let level = self.comparators.level(coil).filter(|(number, _)| self.modulation.has_comparator(*number));
                self.modulation.breaks_at(true) && level.is_some_and(|(_, level)| current > level)
            }),
        }
    }

    /// Brings the coils' currents up to now.
    pub fn advance_coils(&mut self) {
        self.modulation.advance(self.now);
        let before = self.coils.clone();
        let from = std::mem::replace(&mut self.coils_at, self.now);
        self.let_flow(self.now);
        let mut asks = self.asks_for_break();
        if asks && !self.broken {
            // Closer, when.
            self.coils = before;
            asks = false;
            for at in (from..self.now).step_by(microseconds(1) as usize).skip(1) {
                self.let_flow(at);
                if self.asks_for_break() {
                    self.modulation.set_break(true);
                    self.let_flow(self.now);
                    break;
                }
            }
            self.let_flow(self.now);
            asks |= self.asks_for_break();
        }
        self.broken = asks;
        self.modulation.set_break(asks);
    }

    /// What is at the converter's pins: both coils have one supply.
    pub(super) fn converted_from(&self) -> Inputs {
        Inputs { currents: self.coils.each_ref().map(|coil| coil.current), supply: self.coils[0].supply }
    }

    fn let_flow(&mut self, until: u64) {
        for index in 0..2 {
            let (high, duty) = self.drive(index);
            self.coils[index].advance(high, duty, until);
        }
    }
}
