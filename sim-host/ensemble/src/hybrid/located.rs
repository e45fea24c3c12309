//! A lane's series as the core's dense output: the core looks for the first event in it and answers that.

use sprag_shared::drivetrain::clutch_state::{Coupling, DeviceState, UNKNOWNS};
use sprag_shared::drivetrain::scaled_parameters::ScaledParameters;
use sprag_shared::equation::motion::Motion;
use sprag_shared::math::polynomial::{curvature_bound, first_zero, largest_magnitude, value};
use sprag_shared::math::root::newton_bracketed;
use sprag_shared::math::sign::Sign;
use sprag_shared::method::dense_output::DenseOutput;
use sprag_shared::method::motion_series::{MotionSeries, StepSeries};
use sprag_shared::motion::hybrid::mode_output::{ModeIntegrator, ModeOutput, ModeStart};

use super::expansion::{LANE_GUARDS, RATES, TERMS};

/// Series of the step of one lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaneSeries {
    pub(super) motion: StepSeries<f64, TERMS>,
    /// Coefficients of the guards.
    pub(super) guards: [[f64; RATES]; LANE_GUARDS],
    /// Coefficients of the speeds of flywheels whose plates slip.
    pub(super) spins: [[f64; TERMS]; 2],
    /// It is shown that θ̇ has no zero.
    pub(super) goes_on: bool,
    /// It is shown that no guard has one.
    pub(super) guarded: bool,
}

/// The dense output of a step that a lane has expanded.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaneOutput<'a> {
    series: &'a LaneSeries,
    length: f64,
    parameters: &'a ScaledParameters<f64>,
    /// At the start.
    device: &'a DeviceState<f64>,
}

/// The integrator that has taken this step already.
pub(super) struct Expanded<'a> {
    pub(super) series: &'a LaneSeries,
    pub(super) device: DeviceState<f64>,
}

impl ModeIntegrator<f64> for Expanded<'_> {
    type Output<'a>
        = LaneOutput<'a>
    where
        Self: 'a;

    fn integrate<'a>(&'a self, start: &'a ModeStart<'a, f64>) -> LaneOutput<'a> {
        LaneOutput {
            series: self.series,
            length: start.length.min(self.series.motion.length),
            parameters: &start.system.transmission.parameters,
            device: &self.device,
        }
    }

    fn step(&self) -> Option<f64> {
        None
    }
}

impl DenseOutput<f64> for LaneOutput<'_> {
    fn length(&self) -> f64 {
        self.length
    }

    fn at(&self, time: f64) -> Motion<f64> {
        self.series.motion.at(time)
    }

    /// As in the default, but without θ̈, which the search does not use.
    fn crossing(&self, level: f64, before: Sign, (from, to): (f64, f64)) -> f64 {
        let StepSeries { motion: MotionSeries { rotation, velocity, .. }, terms, .. } = &self.series.motion;
        newton_bracketed(from, to, before, 0.5 * (from + to), |time| {
            (value(&rotation[..*terms], time) - level, value(&velocity[..terms - 1], time))
        })
    }

    fn largest_acceleration(&self, from: (f64, f64), to: (f64, f64), floor: f64) -> f64 {
        let rates = self.series.motion.acceleration();
        largest_magnitude(rates, curvature_bound(rates, self.length), from, to, floor)
    }
}

fn zero(coefficients: &[f64], to: f64, sign: Sign, from_zero: bool) -> Option<f64> {
    first_zero(coefficients, curvature_bound(coefficients, to), 0.0, to, sign, from_zero)
}

impl ModeOutput<f64> for LaneOutput<'_> {
    /// Flywheels coast that are neither locked nor driven by slipping plates.
    fn unknowns(&self, time: f64) -> [f64; UNKNOWNS] {
        let mut unknowns = self.device.unknowns();
        for (i, wheel) in self.device.wheels.iter().enumerate() {
            unknowns[i] = match wheel.coupling {
                Coupling::Slipping(_) => value(&self.series.spins[i], time),
                _ => {
                    let mut wheel = *wheel;
                    self.parameters.coast(&mut wheel, time);
                    wheel.spin
                }
            };
        }
        unknowns
    }

    fn guard(&self, index: usize, time: f64) -> f64 {
        self.series.guards.get(index).map_or(1.0, |guard| value(guard, time))
    }

    fn velocity_zero(&self, to: f64, sign: Sign, from_zero: bool) -> Option<f64> {
        if self.series.goes_on {
            return None;
        }
        zero(self.series.motion.velocity(), to, sign, from_zero)
    }

    fn guard_zero(&self, index: usize, to: f64, from_zero: bool) -> Option<f64> {
        if self.series.guarded {
            return None;
        }
        zero(self.series.guards.get(index)?, to, Sign::Positive, from_zero)
    }

    fn unknown_zero(&self, index: usize, to: f64, sign: Sign, from_zero: bool) -> Option<f64> {
        let (wheel, spin) = (self.device.wheels.get(index)?, self.series.spins.get(index)?);
        match wheel.coupling {
            Coupling::Slipping(_) => zero(spin, to, sign, from_zero),
            _ => self.parameters.stops_within(wheel, to),
        }
    }
}
