//! One case of a batch: a dimensionless block under one cycle of a pulse.

use sprag_shared::ground::Harmonics;
use sprag_shared::motion::state::{BlockState, Limits};
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind};
use sprag_shared::structure::error::ParameterError;
use sprag_shared::structure::{REST_SPEED, Restitution, Structure};

pub use sprag_ensemble::alone::{CaseError, TIGHT};
use sprag_ensemble::plain::PlainBlock;
pub use sprag_ensemble::pulsed::PulseShape;
use sprag_ensemble::pulsed::PulsedBlock;
use sprag_loops::{IdealLoop, Method, Precision};

use crate::accuracy::answer::{Answer, Comparable, Steps, answer};
use crate::accuracy::{Accuracy, Compared};
use sprag_shared::observers::outcome::Outcome;

/// The columns of DESIGN section 5, resolved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// Full or slender.
    pub geometry: Geometry,
    /// α, rad.
    pub slenderness: f64,
    /// The device, at the centre of mass.
    pub device: DeviceKind,
    /// σ.
    pub mass_ratio: f64,
    /// η.
    pub restitution: f64,
    /// Shape of the pulse.
    pub pulse: PulseShape,
    /// ω_g/p.
    pub frequency_ratio: f64,
    /// a_g/(g tan α), or a_g/(gα) for the slender model.
    pub amplitude_ratio: f64,
    /// How long the motion is followed after the pulse, in 1/p.
    pub free_time: f64,
    /// θ̇/(pα) below which an impact may end in rest.
    pub rest_speed: f64,
}

/// What became of a case; times in 1/p from the pulse's start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaseResult {
    /// Outcome.
    pub outcome: Outcome,
    /// max |θ|/α.
    pub peak_rotation: f64,
    /// max |θ̈|/(p²α).
    pub peak_acceleration: f64,
    /// Impacts that came in with more than 1e-6 pα.
    pub impacts: u32,
    /// The first of them, if any.
    pub first_impact_time: Option<f64>,
    /// Rest, the proof of overturning, or the end of the free time.
    pub end_time: f64,
}

impl Default for Case {
    fn default() -> Case {
        Case {
            geometry: Geometry::Full,
            slenderness: 20.0_f64.to_radians(),
            device: DeviceKind::None,
            mass_ratio: 0.5,
            restitution: 0.85,
            pulse: PulseShape::Sine,
            frequency_ratio: 2.0,
            amplitude_ratio: 2.0,
            free_time: 60.0,
            rest_speed: REST_SPEED,
        }
    }
}

impl Case {
    /// The block and its device, in units of 1/p.
    ///
    /// # Errors
    /// [`ParameterError`] for a slenderness outside its range.
    pub fn structure(&self) -> Result<Structure, ParameterError> {
        let block = Block::of_unit_frequency(self.slenderness, RECTANGLE_INERTIA_RATIO)?;
        Ok(Structure {
            geometry: self.geometry,
            device: Device { kind: self.device, mass_ratio: self.mass_ratio, ..Device::NONE },
            rest_speed: self.rest_speed,
            ..Structure::new(block, Restitution::Constant(self.restitution))
        })
    }

    /// Runs the case by `method`.
    ///
    /// # Errors
    /// [`CaseError`] for a parameter outside its range, or a motion that cannot be followed.
    pub fn run(&self, method: &dyn IdealLoop<f64>) -> Result<CaseResult, CaseError> {
        let structure = self.structure()?;
        let system = structure.resolve::<f64>()?;
        let amplitude = self.amplitude_ratio * system.uplift;
        let pulse = match self.pulse {
            PulseShape::Sine => Harmonics::sine(amplitude, self.frequency_ratio),
            PulseShape::Cosine => Harmonics::cosine(amplitude, self.frequency_ratio),
        };
        let duration = core::f64::consts::TAU / self.frequency_ratio;
        let mut state = BlockState::default();
        let mut peaks = Peaks::default();
        let limits = |bound| Limits {
            overturned: self.geometry.point_of_no_return(structure.block.slenderness(), bound),
            events: 1_000_000,
        };
        method.advance(&system, &mut state, &pulse, duration, &limits(amplitude.abs()), &mut peaks)?;
        peaks.origin = duration;
        method.advance(&system, &mut state, &Harmonics::QUIET, self.free_time, &limits(0.0), &mut peaks)?;
        state.end(limits(0.0).overturned, self.free_time, &mut peaks);
        let outcome = Outcome::of(&state, &peaks);
        Ok(CaseResult {
            outcome,
            peak_rotation: peaks.rotation / self.slenderness,
            peak_acceleration: peaks.acceleration / self.slenderness,
            impacts: state.impacts,
            first_impact_time: peaks.first_counted_impact,
            end_time: peaks.ended.unwrap_or(if peaks.rocked { duration + self.free_time } else { duration }),
        })
    }

    /// Runs the case as accurately as asked, and gives the error.
    ///
    /// # Errors
    /// The errors of [`Case::run`].
    pub fn answer(&self, accuracy: Accuracy) -> Result<Answer<CaseResult>, CaseError> {
        answer(accuracy, Steps::Free, |closeness| self.run(&*f64::ideal(Method::Adaptive(closeness.tolerance))))
    }
}

impl Comparable for CaseResult {
    type Outcome = Outcome;

    fn compared(&self) -> Compared<Outcome> {
        // The peaks of a block that overturns end with the proof that it does.
        let peak = |value: f64| (!self.outcome.overturned()).then_some(value);
        Compared {
            outcome: self.outcome,
            peak_rotation: peak(self.peak_rotation),
            peak_acceleration: peak(self.peak_acceleration),
            first_impact_time: self.first_impact_time,
        }
    }
}

impl From<&Case> for PulsedBlock {
    fn from(case: &Case) -> PulsedBlock {
        let plain = PlainBlock {
            geometry: case.geometry,
            device: case.device,
            slenderness: case.slenderness,
            coupling: if case.device == DeviceKind::None { 0.0 } else { case.mass_ratio / RECTANGLE_INERTIA_RATIO },
            restitution: case.restitution,
            overturned_at_slenderness: false,
        };
        let Case { pulse, frequency_ratio, amplitude_ratio, .. } = *case;
        PulsedBlock { plain, pulse, frequency_ratio, amplitude_ratio }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Short pulses, where no tolerance of the levels limits what ends the series. Slender, the largest |θ̈|/(p²α) comes as the ground turns, where
    /// that of the block is 3 + 1 − |θ|/α; that of the full block is by DOP853 at 3e-14. Its runs at 1e-4 and 1e-10 differ by 2e-16.
    #[test]
    fn errors_of_short_pulses_are_those_that_are_there() {
        let slender = Case {
            geometry: Geometry::Slender,
            slenderness: 10.0_f64.to_radians(),
            device: DeviceKind::None,
            mass_ratio: 0.0,
            restitution: 0.0,
            pulse: PulseShape::Cosine,
            frequency_ratio: 1e4,
            amplitude_ratio: -3.0,
            free_time: 20.0,
            rest_speed: 1e-6,
        };
        let full = Case {
            geometry: Geometry::Full,
            slenderness: 26.72_f64.to_radians(),
            device: DeviceKind::Inerter,
            mass_ratio: 15.0,
            restitution: 1.0,
            frequency_ratio: 40.72,
            amplitude_ratio: 3.759,
            free_time: 0.0,
            ..slender
        };
        for (case, peak) in [(slender, 3.999_999_989_35), (full, 0.459_928_365_651_9)] {
            for accuracy in [Accuracy::Fast, Accuracy::Error(1e-3), Accuracy::Error(1e-6), Accuracy::Normal, Accuracy::Tight] {
                let found = case.answer(accuracy).unwrap();
                let error = (found.result.peak_acceleration - peak).abs();
                assert!(error <= found.error.peak_acceleration + 1e-11, "{accuracy}: {error:e} {:?}", found.error);
            }
        }
    }

    /// A block that moves outward beyond α as the ground stops has overturned, whether it is followed further or not.
    #[test]
    fn a_block_that_falls_as_its_pulse_ends_has_overturned() {
        let falls = Case {
            geometry: Geometry::Slender,
            slenderness: 10.0_f64.to_radians(),
            restitution: 0.9,
            frequency_ratio: 3.562,
            amplitude_ratio: 7.1,
            ..Case::default()
        };
        for free_time in [0.0, 0.5] {
            let found = Case { free_time, ..falls }.answer(Accuracy::Normal).unwrap();
            assert_eq!(found.result.outcome, Outcome::OverturnedWithoutImpact, "{free_time}");
        }
    }
}
