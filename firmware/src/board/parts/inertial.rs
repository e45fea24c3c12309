//! The sensor on the block, the sensor on the ground, and the encoder at the rack.

use embedded_hal::spi::SpiDevice;
use sprag_drivers::icm42688::{Icm42688, Verdict, test_duration};
use sprag_shared::control::monitor::fault::{Fault, Place};
use sprag_shared::control::sensing::sample::{Reading, Sample};
use sprag_shared::device::inertial::Component;
use sprag_shared::settings::wiring::{Axis, Wiring};

use crate::board::Sensors;

/// An encoder's counter.
pub trait Counter {
    /// Counts, wrapping.
    fn read(&mut self) -> i32;
}

/// Two inertial sensors and an encoder, mounted in some way.
pub struct MountedSensors<B, G, E> {
    block: Icm42688<B>,
    ground: Icm42688<G>,
    encoder: E,
    wiring: Wiring,
    rate: Component,
    /// Along and up.
    of_block: [Component; 2],
    of_ground: [Component; 2],
    /// There was no time for a test.
    untested: bool,
}

impl<B: SpiDevice<u16>, G: SpiDevice<u16>, E: Counter> MountedSensors<B, G, E> {
    /// At their buses.
    pub fn new(block: B, ground: G, encoder: E, wiring: Wiring) -> MountedSensors<B, G, E> {
        let (block, ground) = (Icm42688::new(block), Icm42688::new(ground));
        let accelerations = |axes: [Axis; 2]| axes.map(Component::of_acceleration);
        let (of_block, of_ground) = (accelerations(wiring.block), accelerations(wiring.ground));
        let rate = Component::of_rate(wiring.block_gyroscope);
        MountedSensors { block, ground, encoder, wiring, rate, of_block, of_ground, untested: false }
    }
}

impl<B: SpiDevice<u16>, G: SpiDevice<u16>, E: Counter> Sensors for MountedSensors<B, G, E> {
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

    #[inline(never)]
    fn test(&mut self, period: f32, patience: f32) {
        self.untested = test_duration(period) > patience;
        if !self.untested {
            self.block.test(period);
            self.ground.test(period);
        }
    }

    #[inline(never)]
    fn untrue(&mut self) -> Option<Fault> {
        if core::mem::take(&mut self.untested) {
            return Some(Fault::PartsUntested);
        }
        let (place, verdict) = match self.block.verdict() {
            Some(verdict) => (Place::Block, verdict),
            None => (Place::Ground, self.ground.verdict()?),
        };
        match verdict {
            Verdict::Undecided => Some(Fault::PartsUntested),
            // The gyroscope on the ground is not used.
            Verdict::Failed { gyroscope, accelerometer } if accelerometer || gyroscope && place == Place::Block => {
                Some(Fault::AnswersWrongly(place))
            }
            Verdict::Failed { .. } | Verdict::Passed => None,
        }
    }

    fn temperature(&self) -> Option<f32> {
        self.block.temperature()
    }
}

fn note(reading: &mut Reading, value: f32) {
    *reading = Reading { value, number: reading.number.wrapping_add(1) };
}

fn note_both([along, up]: &mut [Reading; 2], [of_along, of_up]: &[Component; 2], counts: [i16; 3]) {
    note(along, of_along.of(counts));
    note(up, of_up.of(counts));
}
