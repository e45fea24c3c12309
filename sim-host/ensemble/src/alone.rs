//! Blocks one at a time, by the core: what the lanes cannot settle, and what they are compared with.

use std::f64::consts::TAU;

use sprag_shared::ground::Harmonics;
pub use sprag_shared::method::taylor::TERMS;
use sprag_shared::method::taylor::Taylor;
use sprag_shared::motion::state::{BlockState, Limits, Phase, Stopped};
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::{Block, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::Device;
use sprag_shared::structure::error::ParameterError;
use sprag_shared::structure::{Restitution, Structure};

use crate::model::Model;
use crate::pulsed::{PulseResult, PulseShape, PulsedBlock};

/// Tolerance of the series' last terms that stands for "to rounding".
pub const TIGHT: f64 = 1e-15;

/// Error of a case without a result.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CaseError {
    /// A parameter outside its range.
    #[error("{0}")]
    Parameter(#[from] ParameterError),
    /// The motion could not be followed to its end.
    #[error("{0}")]
    Stopped(#[from] Stopped),
}

impl PulsedBlock {
    /// The block in units of 1/p.
    pub(crate) fn structure(&self) -> Result<Structure, CaseError> {
        let block = Block::of_unit_frequency(self.plain.slenderness, RECTANGLE_INERTIA_RATIO)?;
        Ok(Structure {
            geometry: self.plain.geometry,
            device: Device { kind: self.plain.device, mass_ratio: self.plain.coupling * RECTANGLE_INERTIA_RATIO, ..Device::NONE },
            ..Structure::new(block, Restitution::Constant(self.plain.restitution))
        })
    }

    /// Its outcome by the core: one step of one block at a time.
    ///
    /// # Errors
    /// [`CaseError`] for a parameter outside its range, or a motion that cannot be followed.
    pub fn follow<M: Model, const PAIR: bool>(&self, method: &Taylor<f64, TERMS>) -> Result<PulseResult, CaseError> {
        let structure = self.structure()?;
        let (state, peaks) = self.over_the_pulse(&structure, method)?;
        if !peaks.rocked {
            return Ok(PulseResult::NO_ROCKING);
        }
        let impact = peaks.first_impact.is_some();
        Ok(match state.phase {
            Phase::Overturned => PulseResult::overturned(impact),
            Phase::Rest => self.stands(peaks.rotation, peaks.acceleration),
            Phase::Rocking => {
                let (rotation, velocity) = (state.side.times(state.rotation), state.side.times(state.velocity));
                self.settle::<M, PAIR>(rotation, velocity, (peaks.rotation, peaks.acceleration), impact)
            }
        })
    }

    /// Integration of the block by the core to the end of its pulse.
    fn over_the_pulse(
        &self,
        structure: &Structure,
        method: &Taylor<f64, TERMS>,
    ) -> Result<(BlockState<f64>, Peaks<f64>), CaseError> {
        let system = structure.resolve::<f64>()?;
        let PulsedBlock { pulse, frequency_ratio, amplitude_ratio, .. } = *self;
        let amplitude = amplitude_ratio * system.uplift;
        let ground = match pulse {
            PulseShape::Sine => Harmonics::sine(amplitude, frequency_ratio),
            PulseShape::Cosine => Harmonics::cosine(amplitude, frequency_ratio),
        };
        let no_return = structure.geometry.point_of_no_return(structure.block.slenderness(), amplitude.abs());
        let overturned = self.plain.overturned_at(no_return);
        let (mut state, mut peaks) = (BlockState::default(), Peaks::default());
        let limits = Limits { overturned, events: 1_000_000 };
        system.advance(method, &mut state, &ground, TAU / frequency_ratio, &limits, &mut peaks)?;
        Ok((state, peaks))
    }
}
