//! What goes into a supervisor and comes out of it at every tick.

use crate::control::monitor::coil::CoilReports;
use crate::control::monitor::fault::{Fault, Wheel};
use crate::control::sensing::sample::Sample;
use serde::{Deserialize, Serialize};

/// Phase of the controller.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Phase {
    /// Waits for the first reading of every required sensor.
    #[default]
    Boot,
    /// Waits for stillness, then pulses the clutches.
    SelfTest,
    /// Waits for stillness, then averages biases.
    Calibrate,
    /// The law decides; nothing moves.
    Armed,
    /// The law decides; the block rocks or the ground shakes.
    Rocking,
    /// The safe state, until recovered.
    Fault,
}

impl Phase {
    /// Each, in the order of their numbers.
    pub const ALL: [Phase; 6] = [Phase::Boot, Phase::SelfTest, Phase::Calibrate, Phase::Armed, Phase::Rocking, Phase::Fault];
}

/// Requests of an operator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Requests {
    /// Leave Fault, through a new self-test. Taken where it begins, and only at rest: one that comes in motion must be made again.
    pub clear: bool,
}

/// Inputs of the supervisor at a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupervisorInput<'a> {
    /// Sensors and feedback.
    pub sample: &'a Sample,
    /// Clutches that the law wants engaged.
    pub wish: [bool; 2],
    /// The block stands, by the estimate: both clutches may be engaged, because nothing turns.
    pub standing: bool,
    /// θ, rad, and θ̇, rad/s, as last estimated.
    pub estimate: (f32, f32),
    /// ℓ of the rack now over ℓ at |θ| = α/2; 0 where nobody knows it.
    pub lever: f32,
    /// How late this tick came, s; 0 or less where it was in time.
    pub lateness: f32,
    /// Requests of an operator.
    pub requests: Requests,
    /// Reports of the coils' currents.
    pub coils: CoilReports,
    /// The time in which this clutch closes has just been found to have changed too far.
    pub slower: Option<Wheel>,
}

/// What a tick makes of the biases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Biases {
    /// Biases as before.
    Kept,
    /// They have been measured, and the controller armed: estimators must start anew, from rest.
    Measured,
    /// Biases that have followed a drift.
    Followed,
}

/// Verdict of the supervisor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Phase of the controller.
    pub phase: Phase,
    /// While it stands in Fault, the first cause; else that of the sensor that another one stands in for.
    pub fault: Option<Fault>,
    /// To be sent to the clutches.
    pub command: [bool; 2],
    /// What has become of the biases that the estimators subtract.
    pub biases: Biases,
}
