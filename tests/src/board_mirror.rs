//! What the board's program is around the controller, on the host: the same shared code, given what the board's own parts have read.

use sprag_shared::control::sensing::sample::Reading;
use sprag_shared::device::beginning::Beginning;
use sprag_shared::device::coil::current;
use sprag_shared::device::coil_test::{Coil, CoilDesign};
use sprag_shared::device::counter::Extended;
use sprag_shared::device::inertial::Component;
use sprag_shared::device::{Device, Surroundings};
use sprag_shared::link::{Request, TickReport};
use sprag_shared::settings::Settings;
use sprag_shared::settings::wiring::{Axis, Wiring};

/// What the board read in a tick, as its parts gave it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Read {
    /// Of the block's sensor, if it had something new: acceleration and rate along x, y, z.
    pub block: Option<[i16; 6]>,
    /// Of the ground's sensor.
    pub ground: Option<[i16; 6]>,
    /// Of the encoder's counter.
    pub counter: u16,
    /// Of the converter, a coil each.
    pub converted: [u16; 2],
}

/// A device with the parts around it as numbers.
pub struct Mirror {
    device: Device,
    wiring: Wiring,
    design: CoilDesign,
    coils: [Coil; 2],
    travel: Extended,
}

fn note(reading: &mut Reading, value: f32) {
    *reading = Reading { value, number: reading.number.wrapping_add(1) };
}

fn note_both([along, up]: &mut [Reading; 2], axes: [Axis; 2], counts: [i16; 3]) {
    note(along, Component::of_acceleration(axes[0]).of(counts));
    note(up, Component::of_acceleration(axes[1]).of(counts));
}

impl Mirror {
    /// A device that begins with `settings`.
    pub fn new(settings: &Settings) -> Mirror {
        let mut device = Device::new(&Beginning::of(Some(settings), None, 0.0).unwrap(), None);
        device.answer(&Request::Stream { every: 1 }, &Surroundings::default());
        let wiring = Wiring::of(settings);
        let design = CoilDesign::of(&wiring, settings.period());
        Mirror { device, wiring, design, coils: Default::default(), travel: Extended::default() }
    }

    /// One tick in time.
    pub fn tick(&mut self, read: &Read) -> TickReport {
        let Mirror { device, wiring, design, coils, travel } = self;
        let [first, second] = coils;
        let [of_first, of_second] = read.converted.map(current);
        let seen = [first.see(design, of_first), second.see(design, of_second)];
        device.note_coils(seen);
        device.tick(
            |sample| {
                if let Some([ax, ay, az, gx, gy, gz]) = read.block {
                    note(&mut sample.gyroscope, Component::of_rate(wiring.block_gyroscope).of([gx, gy, gz]));
                    note_both(&mut sample.block_accelerometer, wiring.block, [ax, ay, az]);
                }
                if let Some([ax, ay, az, ..]) = read.ground {
                    note_both(&mut sample.ground_accelerometer, wiring.ground, [ax, ay, az]);
                }
                sample.encoder.counts = wiring.travel(travel.read(read.counter));
                sample.encoder.number = sample.encoder.number.wrapping_add(1);
                sample.engaged = seen.map(|coil| coil.engaged);
            },
            0.0,
        );
        let (command, tested) = (device.decision().command, device.tests_coils());
        first.drive(design, command[0], tested);
        second.drive(design, command[1], tested);
        device.report(0, 0).unwrap()
    }
}
