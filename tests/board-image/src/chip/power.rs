//! The chip's supply and its crystal: when they go, when they come back, and what a reset leaves.

use super::{Chip, RAM, RAM_LENGTH};
use crate::model::Model;
use crate::peripheral::backup::Backup;
use crate::peripheral::capture::Capture;
use crate::peripheral::counter::Counter;
use crate::peripheral::crc::CrcUnit;
use crate::peripheral::processor::{FIRST_INTERRUPT, NMI, Private};
use crate::peripheral::rcc::{Cause, Rcc};
use crate::peripheral::registers::Registers;
use crate::peripheral::spi::Spi;
use crate::random::Random;

/// Number of the voltage detector's interrupt.
const DETECTOR: u32 = FIRST_INTERRUPT + 1;

impl Chip {
    /// Everything as after a reset for that cause. What is outside of the chip stays as it is.
    pub fn resets(&mut self, cause: Cause) {
        if cause == Cause::Power {
            let mut random = Random::new(self.now ^ 0x5EED);
            for memory in [&self.ram, &self.core_coupled] {
                let start = if memory.contains(RAM) { RAM } else { 0x1000_0000 };
                for place in 0..(if start == RAM { RAM_LENGTH } else { 64 << 10 }) as u32 / 8 {
                    memory.write(start + 8 * place, &random.number().to_le_bytes());
                }
            }
            for bus in &mut self.buses {
                bus.sensor.brown_out(self.now);
            }
        }
        self.rcc = Rcc::reset(self.model, Some(&self.rcc), cause);
        self.flash.reset();
        self.ports.iter_mut().zip(0..).for_each(|(port, index)| port.reset(self.model, index));
        self.buses.iter_mut().for_each(Spi::reset);
        self.encoder.reset();
        self.modulation.reset();
        self.converter.reset(self.model);
        self.comparators.reset();
        self.converters = Registers::default();
        self.counters.iter_mut().for_each(Counter::reset);
        self.capture = Capture::new(self.model);
        self.copier.reset();
        self.line.reset();
        self.line.reset_streams();
        self.supply.reset();
        self.watchdog.reset();
        self.private = Private::default();
        self.crc = CrcUnit::default();
        if cause == Cause::Power {
            self.debug = Registers::default();
            if self.model == Model::G474 {
                // VBAT is the supply.
                self.backup = Backup::default();
            }
        }
        (self.reset, self.stuck, self.powered) = (None, None, true);
        self.clock_changed();
        self.select_sensors();
        self.advance_coils();
    }

    /// The supply of 3.3 V becomes `volts`.
    pub fn set_volts(&mut self, volts: f64) {
        self.supply.set_volts(volts);
        self.pend_detector();
        if self.flash.brown_out().is_some_and(|level| volts < level) || volts < 1.7 {
            let cause = if volts < 1.7 { Cause::Power } else { Cause::BrownOut };
            self.resets(cause);
            (self.reset, self.powered) = (Some(cause), false);
        }
    }

    /// Whether the supply lets the chip run.
    pub fn powered(&self) -> bool {
        self.powered || self.supply.volts() > self.flash.brown_out().map_or(1.75, |level| level + 0.1)
    }

    pub(super) fn pend_detector(&mut self) {
        if self.supply.interrupts() {
            self.private.pend(DETECTOR);
        }
    }

    /// The crystal stops.
    pub fn crystal_stops(&mut self) {
        if self.rcc.crystal_stops() {
            self.private.pend(NMI);
            self.clock_changed();
        }
    }
}
