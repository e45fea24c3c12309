//! The sensor on the block, the sensor on the ground, and the encoder at the rack.

use embedded_hal::spi::{MODE_3, SpiDevice};
use sprag_drivers::icm42688::Icm42688;
use sprag_shared::control::sensing::sample::{Reading, Sample};
use sprag_shared::device::inertial::Component;
use sprag_shared::settings::wiring::{Axis, Wiring};
use stm32f4xx_hal::gpio::{Alternate, Pin, Pull, Speed};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::Rcc;
use stm32f4xx_hal::spi::Spi;
use stm32f4xx_hal::time::Hertz;

use super::bus::Bus;
use super::encoder::Encoder;
use crate::board::Sensors;

/// Of the bus to the block's sensor, 1/s at most.
const BLOCK_BUS: Hertz = Hertz::from_raw(10_500_000);
/// Of the bus to the ground's sensor, 1/s at most: its cable is the longer one.
const GROUND_BUS: Hertz = Hertz::from_raw(5_250_000);

/// The sensor on the block.
pub type BlockDevice = Bus<pac::SPI1, 'A', 4>;
/// The sensor on the ground.
pub type GroundDevice = Bus<pac::SPI2, 'B', 12>;

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
    Bus::new(Spi::new(spi, pins, MODE_3, BLOCK_BUS, rcc), select)
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
    Bus::new(Spi::new(spi, pins, MODE_3, GROUND_BUS, rcc), select)
}

/// All of them.
pub type BoardSensors = MountedSensors<BlockDevice, GroundDevice>;

/// Two inertial sensors and an encoder, mounted in some way.
pub struct MountedSensors<B, G> {
    block: Icm42688<B>,
    ground: Icm42688<G>,
    encoder: Encoder,
    wiring: Wiring,
    rate: Component,
    /// Along and up.
    of_block: [Component; 2],
    of_ground: [Component; 2],
}

impl<B: SpiDevice<u16>, G: SpiDevice<u16>> MountedSensors<B, G> {
    /// At their buses.
    pub fn new(block: B, ground: G, encoder: Encoder, wiring: Wiring) -> MountedSensors<B, G> {
        let (block, ground) = (Icm42688::new(block), Icm42688::new(ground));
        let accelerations = |axes: [Axis; 2]| axes.map(Component::of_acceleration);
        let (of_block, of_ground) = (accelerations(wiring.block), accelerations(wiring.ground));
        let rate = Component::of_rate(wiring.block_gyroscope);
        MountedSensors { block, ground, encoder, wiring, rate, of_block, of_ground }
    }
}

impl<B: SpiDevice<u16>, G: SpiDevice<u16>> Sensors for MountedSensors<B, G> {
    fn read(&mut self, sample: &mut Sample) {
        if let Some(reading) = self.block.tick() {
            note(&mut sample.gyroscope, self.rate.of(reading.rate));
            note_both(&mut sample.block_accelerometer, &self.of_block, reading.acceleration);
        }
        if let Some(reading) = self.ground.tick() {
            note_both(&mut sample.ground_accelerometer, &self.of_ground, reading.acceleration);
        }
        sample.encoder.counts = self.wiring.travel(self.encoder.read());
        sample.encoder.number = sample.encoder.number.wrapping_add(1);
    }
}

fn note(reading: &mut Reading, value: f32) {
    *reading = Reading { value, number: reading.number.wrapping_add(1) };
}

fn note_both([along, up]: &mut [Reading; 2], [of_along, of_up]: &[Component; 2], counts: [i16; 3]) {
    note(along, of_along.of(counts));
    note(up, of_up.of(counts));
}
