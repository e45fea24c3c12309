//! A block after its record: some time on quiet ground, by the core.

use sprag_shared::ground::Harmonics;
use sprag_shared::method::taylor::Taylor;
use sprag_shared::motion::state::{Limits, Phase};
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;

use crate::alone::{CaseError, TERMS, TIGHT};
use crate::plain::PlainBlock;
use crate::shaken::Shaken;

/// Swings that the free time may have; from their first impact on they are summed in closed form.
const MOST_EVENTS: u32 = 1_000_000;

impl Shaken {
    /// Its state, that of `plain`, whose structure is `structure`, `free_time` (s) after its record, which ended at `duration` (s).
    ///
    /// # Errors
    /// The core's.
    pub fn after(
        mut self,
        plain: &PlainBlock,
        structure: &Structure,
        duration: f64,
        free_time: f64,
    ) -> Result<Shaken, CaseError> {
        if self.phase != Phase::Rocking {
            return Ok(self);
        }
        self.peaks.origin = duration;
        let system = structure.resolve::<f64>()?;
        let Shaken { rotation, velocity, impacts, mut peaks, .. } = self;
        let mut state = system.released_at(rotation, velocity, 0.0);
        state.impacts = impacts;
        let no_return = structure.geometry.point_of_no_return(structure.block.slenderness(), 0.0);
        let overturned = plain.overturned_at(match structure.geometry {
            Geometry::Full => core::f64::consts::FRAC_PI_2,
            Geometry::Slender => no_return,
        });
        let method = Taylor::<f64, TERMS>::adaptive(TIGHT);
        system.advance(
            &method,
            &mut state,
            &Harmonics::QUIET,
            free_time,
            &Limits { overturned, events: MOST_EVENTS },
            &mut peaks,
        )?;
        state.end(no_return, free_time, &mut peaks);
        Ok(Shaken { phase: state.phase, rotation: state.rotation, velocity: state.velocity, impacts: state.impacts, peaks })
    }
}
