//! Parameters of a supervisor, in SI units.

use super::Supervisor;
use super::following::{EVERY, FOLLOWING_TIME};
use super::motion::MotionLimits;
use crate::control::monitor::actuator::ActuatorMonitor;
use crate::control::monitor::fault::Wheel;
use crate::control::monitor::{MonitorParameters, duration};
use crate::control::sensing::calibration::Plausible;
use crate::control::sensing::required::Required;
use crate::control::ticks::{ticks, ticks_or_never};
use crate::structure::error::{ParameterError, require};

/// What the clutches do while the controller does not decide: before it is armed, and on a fault, unless an engaged clutch is the fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SafeState {
    /// Both open: a block without an inerter.
    Released,
    /// One engaged for good: a plain inerter.
    Engaged(Wheel),
}

impl SafeState {
    /// Commands of the safe state.
    pub fn command(self) -> [bool; 2] {
        match self {
            SafeState::Released => [false; 2],
            SafeState::Engaged(wheel) => wheel.alone(),
        }
    }
}

/// All of it. The defaults are for 2 kHz, with sensors that are read once a millisecond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// From tick to tick, s; 1e-5 to 0.01. Default 0.5 ms.
    pub period: f32,
    /// Limits of the sensors.
    pub monitor: MonitorParameters,
    /// Default: all.
    pub required: Required,
    /// Default: the first engaged. See `docs/robustness.md`.
    pub safe_state: SafeState,
    /// Whether both clutches may be engaged at once while the block moves. Default: no.
    pub both_allowed: bool,
    /// Whether the clutches are pulsed before the controller is armed. Default: yes.
    pub self_test_clutches: bool,
    /// For the first reading of every required sensor, s; above 0, up to 10. Default 1: a sensor's start-up, with room.
    pub boot_time: f32,
    /// From a command to the feedback that it has been followed, s; above 0, up to 10: no less than delay and dwell of the clutch, whose
    /// capacity may still rise. Default 30 ms.
    pub actuator_time: f32,
    /// Feedback that changes though the command does not, for this long, s; above 0, up to 10. Default 3 ms: a switch bounces for less.
    pub feedback_time: f32,
    /// Nothing has moved for this long before a clutch is pulsed, s; above 0, up to 10. Default 0.1.
    pub stillness_time: f32,
    /// Over which biases are averaged, s; above 0, up to 3600. Default 1: noise of 0.005 rad/s at 1 kHz leaves 0.0002 rad/s.
    pub calibration_time: f32,
    /// For which stillness is waited before self-test and calibration are given up, s; above `calibration_time`, up to 3600. Default 3:
    /// an earthquake must not find the controller waiting.
    pub calibration_patience: f32,
    /// Without motion for this long the block is at rest, s; above 0, up to 3600. Default 2: longer than a block stays near the end of a
    /// swing.
    pub quiet_time: f32,
    /// Of good readings before a sensor's fault is over, s; above 0, up to 3600. Default 1.
    pub recover_after: f32,
    /// What a new bias may be; each above 0. Default 0.2 rad/s (10°/s) and 1 m/s² (0.1 g, or 0.1 rad of mounting), beyond what any
    /// sensor's sheet allows.
    pub plausible: Plausible,
    /// The ground shakes when its acceleration exceeds this, m/s²; above 0. Default 0.3: a tenth of what makes a stocky block rock, and
    /// above noise.
    pub shaking: f32,
    /// The block moves when the encoder's count changes by more than this; at least 0. Default 2: a count at rest goes to and fro by one.
    pub moving_counts: i32,
    /// Late ticks in a row that are a fault; at least 1. Default 3: 1.5 ms, while sensors stay fresh for 3 ms.
    pub overrun_ticks: u32,
    /// Lateness of a single tick that is one, s; above 0, up to 1. Default 2 ms, for the same reason.
    pub overrun_limit: f32,
    /// Of rest while armed from one proof test of the clutches to the next, s; 0, which is never, to 1e9. Default 30 days: a clutch or a coil
    /// that has failed shows nothing until it is used.
    pub proof_test_interval: f32,
}

impl Default for Parameters {
    fn default() -> Parameters {
        Parameters {
            period: 0.0005,
            monitor: MonitorParameters::default(),
            required: Required::ALL,
            safe_state: SafeState::Engaged(Wheel::First),
            both_allowed: false,
            self_test_clutches: true,
            boot_time: 1.0,
            actuator_time: 0.03,
            feedback_time: 0.003,
            stillness_time: 0.1,
            calibration_time: 1.0,
            calibration_patience: 3.0,
            quiet_time: 2.0,
            recover_after: 1.0,
            plausible: Plausible { gyroscope: 0.2, accelerometer: 1.0 },
            shaking: 0.3,
            moving_counts: 2,
            overrun_ticks: 3,
            overrun_limit: 0.002,
            proof_test_interval: 2_592_000.0,
        }
    }
}

impl Parameters {
    pub(super) fn check(&self) -> Result<(), ParameterError> {
        let period = self.period;
        require("period", period.into(), (1e-5..=0.01).contains(&period), "from 1e-5 s to 0.01 s")?;
        for (name, time) in [
            ("boot_time", self.boot_time),
            ("actuator_time", self.actuator_time),
            ("feedback_time", self.feedback_time),
            ("stillness_time", self.stillness_time),
        ] {
            duration(name, time, 10.0)?;
        }
        for (name, time) in [
            ("calibration_time", self.calibration_time),
            ("calibration_patience", self.calibration_patience),
            ("quiet_time", self.quiet_time),
            ("recover_after", self.recover_after),
        ] {
            duration(name, time, 3600.0)?;
        }
        let patience = self.calibration_patience;
        require("calibration_patience", patience.into(), patience > self.calibration_time, "above calibration_time")?;
        for (name, value) in [
            ("plausible.gyroscope", self.plausible.gyroscope),
            ("plausible.accelerometer", self.plausible.accelerometer),
            ("shaking", self.shaking),
        ] {
            require(name, value.into(), value > 0.0, "above 0")?;
        }
        require("moving_counts", self.moving_counts.into(), self.moving_counts >= 0, "at least 0")?;
        require("overrun_ticks", self.overrun_ticks.into(), self.overrun_ticks >= 1, "at least 1")?;
        let late = self.overrun_limit;
        require("overrun_limit", late.into(), late > 0.0 && late <= 1.0, "above 0 s, up to 1 s")?;
        let interval = self.proof_test_interval;
        require("proof_test_interval", interval.into(), (0.0..=1e9).contains(&interval), "from 0 s to 1e9 s")?;
        self.monitor.check(period)
    }

    /// What cannot fail, without the names of what can.
    pub(super) fn resolve(&self) -> Supervisor {
        let period = self.period;
        let of = |seconds| ticks(seconds, period);
        let share = self.calibration_time / FOLLOWING_TIME;
        Supervisor {
            monitor: self.monitor.resolve(period, self.plausible.gyroscope),
            actuator: ActuatorMonitor {
                actuator_ticks: of(self.actuator_time),
                feedback_ticks: of(self.feedback_time),
                both_allowed: self.both_allowed,
            },
            motion: MotionLimits {
                rate: self.monitor.moving_rate,
                shaking: self.shaking,
                counts: self.moving_counts.unsigned_abs(),
                gravity: self.monitor.gravity,
            },
            required: self.required,
            safe: self.safe_state.command(),
            both_allowed: self.both_allowed,
            self_test: self.self_test_clutches,
            boot: of(self.boot_time),
            stillness: of(self.stillness_time),
            calibration: of(self.calibration_time).max(1),
            patience: of(self.calibration_patience),
            quiet: of(self.quiet_time),
            recovery: of(self.recover_after),
            plausible: self.plausible,
            overrun_ticks: self.overrun_ticks,
            overrun_limit: self.overrun_limit,
            second: of(1.0),
            averaged: of(self.calibration_time / EVERY as f32).max(1),
            followed: if share < 1.0 { share } else { 1.0 },
            proof_interval: ticks_or_never(self.proof_test_interval, self.calibration_time).max(1),
        }
    }
}
