//! What every pin does.

use core::convert::Infallible;

use embedded_hal::digital::ErrorType;
use stm32g4::stm32g474 as pac;

/// What a pin does.
enum Does {
    /// A peripheral has it, by this alternate function.
    Function(u8),
    /// An output, high at first.
    High,
    /// An output, low at first.
    Low,
    /// It is read by a converter or a comparator.
    Analog,
    /// It is read by the program.
    Input,
}

/// What a pin is pulled to.
#[derive(Clone, Copy)]
enum Pulled {
    No = 0,
    Up = 1,
    Down = 2,
}

use Does::{Analog, Function, High, Input, Low};
use Pulled::{Down, No, Up};

/// Port from A on, number, what it does, what it is pulled to; alternate functions by DS12288, tables 13 to 15. PB6 and PB7 are
/// so already by the encoder's [first steps](super::encoder), and do not change while it counts.
const PINS: [(u32, u32, Does, Pulled); 21] = [
    // Block sensor: CS, SCK, MOSI, MISO. Without a sensor MISO reads low, which is no new reading.
    (0, 4, High, No),
    (0, 5, Function(5), No),
    (0, 7, Function(5), No),
    (1, 4, Function(5), Down),
    // Ground sensor: CS, SCK, MISO, MOSI.
    (1, 12, High, No),
    (1, 13, Function(5), No),
    (1, 14, Function(5), Down),
    (1, 15, Function(5), No),
    // Low sides, TIM8 CH1 and CH2.
    (2, 6, Function(4), No),
    (2, 7, Function(4), No),
    // High sides.
    (2, FIRST_HIGH, Low, No),
    (2, FIRST_HIGH + 1, Low, No),
    // Currents: ADC1 IN2 and COMP1, ADC1 IN7 and COMP3.
    (0, 1, Analog, No),
    (2, 1, Analog, No),
    // The coils' supply, behind its divider: ADC1 IN8.
    (2, 2, Analog, No),
    // USART1: out, in.
    (0, 9, Function(7), No),
    (0, 10, Function(7), Up),
    // Light.
    (LIGHT.port, LIGHT.number, High, No),
    // Commissioning jumper, to ground.
    (2, JUMPER, Input, Up),
    // Encoder: A, B.
    (1, 6, Function(2), Up),
    (1, 7, Function(2), Up),
];

/// Number of the first coil's high-side pin in port C; the second's is the next.
pub const FIRST_HIGH: u32 = 8;

/// The commissioning jumper's pin in port C, which it takes to ground.
const JUMPER: u32 = 13;

/// Whether the commissioning jumper is closed.
pub fn jumper_is_closed() -> bool {
    port(2).idr().read().bits() & 1 << JUMPER == 0
}

/// Selects the block's sensor while it is low.
pub const BLOCK_SELECT: OutputPin = OutputPin { port: 0, number: 4 };
/// Selects the ground's sensor while it is low.
pub const GROUND_SELECT: OutputPin = OutputPin { port: 1, number: 12 };
/// The light, lit by a low level.
pub const LIGHT: OutputPin = OutputPin { port: 2, number: 12 };

/// The registers of a port from A on.
pub fn port(index: u32) -> &'static pac::gpioa::RegisterBlock {
    // SAFETY: the ports lie one behind the other and differ in their reset values only. Several modules write them, each register that more
    // than one of them writes whole (BSRR) or before there are tasks.
    unsafe { &*((pac::GPIOA::ptr() as u32 + 0x400 * index) as *const pac::gpioa::RegisterBlock) }
}

/// Sets all pins, each in an order in which it never does anything else.
pub fn begin(rcc: &pac::RCC) {
    rcc.ahb2enr().modify(|_, w| w.gpioaen().set_bit().gpioben().set_bit().gpiocen().set_bit());
    for (index, number, does, pulled) in &PINS {
        let (port, double) = (port(*index), 2 * number);
        // SAFETY: each field of two or four bits holds one of its values.
        unsafe {
            port.pupdr().modify(|r, w| w.bits(r.bits() & !(3 << double) | (*pulled as u32) << double));
            let mode = match does {
                Function(function) => {
                    let (shift, function) = (4 * (number % 8), u32::from(*function));
                    if *number < 8 {
                        port.afrl().modify(|r, w| w.bits(r.bits() & !(15 << shift) | function << shift));
                    } else {
                        port.afrh().modify(|r, w| w.bits(r.bits() & !(15 << shift) | function << shift));
                    }
                    // Edges that the buses and the gate drivers need.
                    port.ospeedr().modify(|r, w| w.bits(r.bits() & !(3 << double) | 1 << double));
                    2
                }
                High => {
                    port.bsrr().write(|w| w.bits(1 << number));
                    1
                }
                Low => {
                    port.bsrr().write(|w| w.bits(1 << (number + 16)));
                    1
                }
                Analog => 3,
                Input => 0,
            };
            port.moder().modify(|r, w| w.bits(r.bits() & !(3 << double) | mode << double));
        }
    }
}

/// A pin that is an output.
#[derive(Clone, Copy)]
pub struct OutputPin {
    port: u32,
    number: u32,
}

impl OutputPin {
    fn set(self, high: bool) {
        let reset = if high { 0 } else { 16 };
        // SAFETY: BSRR has no reserved bits.
        port(self.port).bsrr().write(|w| unsafe { w.bits(1 << (self.number + reset)) });
    }
}

impl ErrorType for OutputPin {
    type Error = Infallible;
}

impl embedded_hal::digital::OutputPin for OutputPin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.set(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.set(true);
        Ok(())
    }
}
