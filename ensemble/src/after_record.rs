//! A block after its record: some time on quiet ground, by the core.

use sprag_shared::block::Geometry;
use sprag_shared::clutch::Clutch;
use sprag_shared::detected::Switched;
use sprag_shared::equation::Equation;
use sprag_shared::ground::Quiet;
use sprag_shared::rocking::{Limits, Phase, Stopped, System};
use sprag_shared::structure::{Structure, WithSystem};
use sprag_shared::taylor::Taylor;

use crate::alone::{CaseError, TERMS, TIGHT};
use crate::shaken::Shaken;

/// Swings that the free time may have; from their first impact on they are summed in closed form.
const MOST_EVENTS: u32 = 1_000_000;

struct FreeTime<'a> {
    structure: &'a Structure,
    shaken: Shaken,
    free_time: f64,
}

impl WithSystem<f64> for FreeTime<'_> {
    type Output = Result<Shaken, Stopped>;

    fn with<R: Equation<f64>, E: Switched<f64>, C: Clutch>(self, system: System<f64, R, E, C>) -> Self::Output {
        let Shaken { rotation, velocity, impacts, mut peaks, .. } = self.shaken;
        let mut state = system.released_at(rotation, velocity, 0.0);
        state.impacts = impacts;
        let overturned = match self.structure.geometry {
            Geometry::Full => core::f64::consts::FRAC_PI_2,
            Geometry::Slender => self.structure.geometry.point_of_no_return(&self.structure.block, 0.0),
        };
        let method = Taylor::<f64, TERMS>::adaptive(TIGHT);
        system.advance(&method, &mut state, &Quiet, self.free_time, &Limits { overturned, events: MOST_EVENTS }, &mut peaks)?;
        Ok(Shaken { phase: state.phase, rotation: state.rotation, velocity: state.velocity, impacts: state.impacts, peaks })
    }
}

impl Shaken {
    /// What has become of it `free_time` (s) after its record, which ended at `duration` (s).
    ///
    /// # Errors
    /// The core's.
    pub fn after(mut self, structure: &Structure, duration: f64, free_time: f64) -> Result<Shaken, CaseError> {
        if self.phase != Phase::Rocking {
            return Ok(self);
        }
        self.peaks.origin = duration;
        Ok(structure.resolve(FreeTime { structure, shaken: self, free_time })??)
    }
}
