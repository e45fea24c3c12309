//! Sensors that freeze, by the default settings.

use super::*;
use crate::control::monitor::fault::Fault;
use crate::control::sensing::sensor::Sensor;

/// At rest and in motion, and as soon as `docs/fmea.md` says: in 5 ms.
#[test]
fn a_ground_accelerometer_that_is_stuck_is_found_by_the_defaults() {
    for mut bench in [Bench::armed(), Bench::rocking()] {
        let frozen = bench.rig.sample().ground_accelerometer.map(|reading| reading.value);
        let found = (0..1000).find(|_| {
            let decision = bench.spoilt(|sample| {
                for (reading, value) in sample.ground_accelerometer.iter_mut().zip(frozen) {
                    reading.value = value;
                }
            });
            decision.fault == Some(Fault::Stuck(Sensor::GroundAccelerometer))
        });
        assert!(found.is_some_and(|tick| tick <= 10), "tick {found:?}: {:?}", bench.device.decision());
    }
}
