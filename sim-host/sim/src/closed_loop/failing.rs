//! Parts that fail in mid-run: sensors, ticks and clutches.

use std::fmt;

use sprag_shared::control::controller::Circumstances;
use sprag_shared::control::sensing::sample::Sample;

use super::disturbance::Disturbance;

/// What goes wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failing {
    /// No new readings.
    Stale(Part),
    /// The same reading again and again.
    Stuck(Part),
    /// Full scale.
    Saturated(Part),
    /// NaN.
    NotFinite(Part),
    /// A reading that is off.
    Contradicts(Part),
    /// Ticks that come late.
    Overrun,
    /// Clutches that stay open.
    Refuses,
    /// A clutch that stays engaged.
    Sticks,
}

/// A sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Gyroscope.
    Gyroscope,
    /// Ground accelerometer.
    Ground,
    /// Encoder.
    Encoder,
}

/// All failures that are tried.
pub const ALL: [Failing; 16] = [
    Failing::Stale(Part::Gyroscope),
    Failing::Stale(Part::Ground),
    Failing::Stale(Part::Encoder),
    Failing::Stuck(Part::Gyroscope),
    Failing::Stuck(Part::Ground),
    Failing::Stuck(Part::Encoder),
    Failing::Saturated(Part::Gyroscope),
    Failing::Saturated(Part::Ground),
    Failing::NotFinite(Part::Gyroscope),
    Failing::NotFinite(Part::Ground),
    Failing::Contradicts(Part::Gyroscope),
    Failing::Contradicts(Part::Ground),
    Failing::Contradicts(Part::Encoder),
    Failing::Overrun,
    Failing::Refuses,
    Failing::Sticks,
];

impl fmt::Display for Part {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Part::Gyroscope => "gyroscope",
            Part::Ground => "ground accelerometer",
            Part::Encoder => "encoder",
        })
    }
}

impl fmt::Display for Failing {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failing::Stale(part) => write!(formatter, "{part} delivers nothing new"),
            Failing::Stuck(part) => write!(formatter, "{part} is stuck"),
            Failing::Saturated(part) => write!(formatter, "{part} is saturated"),
            Failing::NotFinite(part) => write!(formatter, "{part} reads NaN"),
            Failing::Contradicts(part) => write!(formatter, "{part} is off"),
            Failing::Overrun => formatter.write_str("ticks come late"),
            Failing::Refuses => formatter.write_str("clutches stay open"),
            Failing::Sticks => formatter.write_str("a clutch stays engaged"),
        }
    }
}

/// A fault from an instant on.
#[derive(Clone, Copy, Debug)]
pub struct Injected {
    failing: Failing,
    from: f64,
    held: Option<Sample>,
}

impl Injected {
    /// `failing` begins at `from` (s).
    pub fn new(failing: Failing, from: f64) -> Injected {
        Injected { failing, from, held: None }
    }
}

impl Disturbance for Injected {
    fn disturb(&mut self, time: f64, sample: &mut Sample, circumstances: &mut Circumstances) {
        if time < self.from {
            return;
        }
        let held = *self.held.get_or_insert(*sample);
        match self.failing {
            Failing::Stale(Part::Gyroscope) => sample.gyroscope = held.gyroscope,
            Failing::Stale(Part::Ground) => sample.ground_accelerometer = held.ground_accelerometer,
            Failing::Stale(Part::Encoder) => sample.encoder = held.encoder,
            Failing::Stuck(Part::Gyroscope) => sample.gyroscope.value = held.gyroscope.value,
            Failing::Stuck(Part::Ground) => {
                for (now, held) in sample.ground_accelerometer.iter_mut().zip(held.ground_accelerometer) {
                    now.value = held.value;
                }
            }
            Failing::Stuck(Part::Encoder) => sample.encoder.counts = held.encoder.counts,
            Failing::Saturated(Part::Gyroscope) => sample.gyroscope.value = 1e3,
            Failing::Saturated(Part::Ground) => sample.ground_accelerometer[0].value = 1e4,
            Failing::Saturated(Part::Encoder) | Failing::NotFinite(Part::Encoder) => {}
            Failing::NotFinite(Part::Gyroscope) => sample.gyroscope.value = f32::NAN,
            Failing::NotFinite(Part::Ground) => sample.ground_accelerometer[0].value = f32::NAN,
            Failing::Contradicts(Part::Gyroscope) => sample.gyroscope.value += 0.5,
            Failing::Contradicts(Part::Ground) => sample.ground_accelerometer[0].value += 3.0,
            Failing::Contradicts(Part::Encoder) => {
                sample.encoder.counts = sample.encoder.counts.wrapping_sub(held.encoder.counts).wrapping_neg();
            }
            Failing::Overrun => circumstances.lateness = 0.001,
            Failing::Refuses | Failing::Sticks => {}
        }
    }

    fn clutches(&mut self, time: f64, command: [bool; 2], last: [bool; 2]) -> [bool; 2] {
        match self.failing {
            _ if time < self.from => command,
            Failing::Refuses => [false; 2],
            Failing::Sticks if last == [false; 2] && command == [false; 2] => [true, false],
            Failing::Sticks => {
                if last == [false; 2] {
                    command
                } else {
                    last
                }
            }
            _ => command,
        }
    }
}
