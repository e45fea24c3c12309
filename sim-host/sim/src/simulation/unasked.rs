//! In a program without effects a scene can ask for nothing beyond history, peaks, and what is always checked.

use std::marker::PhantomData;

use sprag_shared::math::scalar::Real;
use sprag_shared::motion::observer::Observer;
use sprag_shared::observers::coil_use::CoilUses;
use sprag_shared::structure::Structure;

use super::drive::Segmented;
use super::energy::EnergyReport;
use super::run::{Failure, Task};
use crate::ground_motion::Segment;

/// Nothing.
#[derive(Debug)]
pub struct Asked<S>(PhantomData<S>);

impl<S: Real> Asked<S> {
    /// Refuses a scene that asks for more.
    pub(super) fn of(task: &Task<'_>, _loaded: &Structure) -> Result<Asked<S>, Failure> {
        let file = &task.scene.file;
        if file.output.energy || file.checks.is_some() { Err(Failure::NoEffects) } else { Ok(Asked(PhantomData)) }
    }

    /// Nothing.
    pub(super) fn coils(&self) -> Option<CoilUses> {
        None
    }

    /// Nothing.
    pub(super) fn energy(self) -> Option<EnergyReport> {
        None
    }
}

impl<S: Real> Observer<S> for Asked<S> {}

impl<S: Real> Segmented for Asked<S> {
    fn segment(&mut self, _start: f64, _segment: Option<&Segment>) {}
}
