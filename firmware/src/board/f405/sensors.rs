//! The buses to the sensor on the block and to the sensor on the ground.

use embedded_hal::spi::MODE_3;
use stm32f4xx_hal::gpio::{Alternate, Pin, Pull, Speed};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::spi::Spi;
use stm32f4xx_hal::time::Hertz;

use super::bus::{self, BoardBus};
use super::encoder::Encoder;
use crate::board::parts::inertial::MountedSensors;

/// Of the bus to the block's sensor, 1/s at most.
const BLOCK_BUS: Hertz = Hertz::from_raw(10_500_000);
/// Of the bus to the ground's sensor, 1/s at most: its cable is the longer one.
const GROUND_BUS: Hertz = Hertz::from_raw(5_250_000);

/// The sensor on the block.
pub type BlockDevice = BoardBus<pac::SPI1, 'A', 4>;
/// The sensor on the ground.
pub type GroundDevice = BoardBus<pac::SPI2, 'B', 12>;

/// The bus to the sensor on the block: clock, input, output, select.
pub fn block(
    spi: pac::SPI1,
    clock: Pin<'A', 5>,
    input: Pin<'B', 4, Alternate<0>>,
    output: Pin<'A', 7>,
    select: Pin<'A', 4>,
    rcc: &mut Rcc,
) -> BlockDevice {
    // Without a sensor the line reads low, which is no new reading.
    let input = input.into_alternate().internal_resistor(Pull::Down);
    let pins =
        (Some(clock.into_alternate().speed(Speed::Medium)), Some(input), Some(output.into_alternate().speed(Speed::Medium)));
    bus::new(Spi::new(spi, pins, MODE_3, BLOCK_BUS, rcc), select)
}

/// The bus to the sensor on the ground: clock, input, output, select.
pub fn ground(
    spi: pac::SPI2,
    clock: Pin<'B', 13>,
    input: Pin<'B', 14>,
    output: Pin<'B', 15>,
    select: Pin<'B', 12>,
    rcc: &mut Rcc,
) -> GroundDevice {
    let input = input.into_alternate().internal_resistor(Pull::Down);
    let pins =
        (Some(clock.into_alternate().speed(Speed::Medium)), Some(input), Some(output.into_alternate().speed(Speed::Medium)));
    bus::new(Spi::new(spi, pins, MODE_3, GROUND_BUS, rcc), select)
}

/// All of them.
pub type BoardSensors = MountedSensors<BlockDevice, GroundDevice, Encoder>;
