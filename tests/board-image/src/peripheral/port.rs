//! A port of GPIO (RM0090 section 8).

use super::registers::Registers;
use crate::model::Model;

const MODER: u32 = 0x00;
const PUPDR: u32 = 0x0C;
const IDR: u32 = 0x10;
/// Offset of ODR.
pub const ODR: u32 = 0x14;
/// Offset of BSRR.
pub const BSRR: u32 = 0x18;

/// Sixteen pins.
#[derive(Clone, Debug)]
pub struct Port {
    registers: Registers,
    /// Levels that something outside puts on the pins.
    pub outside: [Option<bool>; 16],
}

impl Port {
    /// Port `index` from A on, after a reset.
    pub fn new(model: Model, index: u32) -> Port {
        let mut port = Port { registers: Registers::default(), outside: [None; 16] };
        port.reset(model, index);
        port
    }

    /// Registers as after a reset.
    pub fn reset(&mut self, model: Model, index: u32) {
        // The pins of a G4 are analog at first (RM0440, GPIOx_MODER).
        self.registers = match index {
            0 if model == Model::G474 => Registers::of(&[(MODER, 0xABFF_FFFF), (0x08, 0x0C00_0000), (PUPDR, 0x6400_0000)]),
            1 if model == Model::G474 => Registers::of(&[(MODER, 0xFFFF_FEBF), (PUPDR, 0x100)]),
            _ if model == Model::G474 => Registers::of(&[(MODER, u32::MAX)]),
            0 => Registers::of(&[(MODER, 0xA800_0000), (0x08, 0x0C00_0000), (PUPDR, 0x6400_0000)]),
            1 => Registers::of(&[(MODER, 0x280), (0x08, 0xC0), (PUPDR, 0x100)]),
            _ => Registers::default(),
        };
    }

    fn mode(&self, pin: u32) -> u32 {
        self.registers.get(MODER) >> (2 * pin) & 3
    }

    /// What the pin drives, where it is an output.
    pub fn output(&self, pin: u32) -> Option<bool> {
        (self.mode(pin) == 1).then(|| self.registers.get(ODR) >> pin & 1 == 1)
    }

    /// The alternate function that has the pin, if one has.
    pub fn function(&self, pin: u32) -> Option<u32> {
        (self.mode(pin) == 2).then(|| self.registers.get(0x20 + 4 * (pin / 8)) >> (4 * (pin % 8)) & 15)
    }

    fn level(&self, pin: u32) -> bool {
        let pulled_up = self.registers.get(PUPDR) >> (2 * pin) & 3 == 1;
        self.output(pin).or(self.outside[pin as usize]).unwrap_or(pulled_up)
    }

    /// A load.
    pub fn read(&self, offset: u32) -> u32 {
        match offset {
            IDR => (0..16).map(|pin| u32::from(self.level(pin)) << pin).sum(),
            BSRR => 0,
            _ => self.registers.get(offset),
        }
    }

    /// A store.
    pub fn write(&mut self, offset: u32, value: u32) {
        match offset {
            IDR => {}
            BSRR => self.registers.set(ODR, self.registers.get(ODR) & !(value >> 16) | value & 0xFFFF),
            _ => self.registers.set(offset, value),
        }
    }
}
