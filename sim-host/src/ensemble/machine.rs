//! The widest registers of the machine, chosen when the program runs.
//!
//! The lanes are written once, over plain arrays. Built for AVX-512, for AVX2 and FMA, and for whatever every machine of the target has,
//! they do the same IEEE operations in the same order on every lane (nothing is fused: Rust never contracts), so results are the same
//! to the last bit; [`Registers::Baseline`] is there to show it.

use pulp::{Arch, NullaryFnOnce};
use sprag_shared::block::Geometry;
use sprag_shared::clutch::{Clutch, ClutchedPair, NoInerter, SingleInerter};
use sprag_shared::structure::DeviceKind;

use super::model::{FullAlone, FullWithInerter, Model, Slender};
use super::pulses::{self, PulseResult, PulsedBlock};
use crate::batch::case::CaseError;

/// Which registers the lanes are in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Registers {
    /// The widest that this machine has.
    #[default]
    Widest,
    /// Those that every machine of the target has.
    Baseline,
}

/// Blocks of one model and device.
struct Work<'a, M, C> {
    pulsed: &'a [PulsedBlock],
    results: &'a mut [PulseResult],
    kind: std::marker::PhantomData<(M, C)>,
}

impl<M: Model, C: Clutch> NullaryFnOnce for Work<'_, M, C> {
    type Output = Result<(), (usize, CaseError)>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        pulses::run::<M, C>(self.pulsed, self.results)
    }
}

/// What becomes of each of `pulsed`, in their order.
///
/// # Errors
/// The first [`CaseError`], with the number of its block.
pub fn run(pulsed: &[PulsedBlock], registers: Registers) -> Result<Vec<PulseResult>, (usize, CaseError)> {
    let mut results = vec![PulseResult::NO_ROCKING; pulsed.len()];
    // Neighbours of one model and device go through the lanes together.
    let kind = |block: &PulsedBlock| (block.geometry, block.device);
    let mut start = 0;
    for group in pulsed.chunk_by(|a, b| kind(a) == kind(b)) {
        let found = &mut results[start..start + group.len()];
        let ended = match kind(&group[0]) {
            (Geometry::Full, DeviceKind::None) => go::<FullAlone, NoInerter>(group, found, registers),
            (Geometry::Full, DeviceKind::Inerter) => go::<FullWithInerter, SingleInerter>(group, found, registers),
            (Geometry::Full, DeviceKind::ClutchedPair) => go::<FullWithInerter, ClutchedPair>(group, found, registers),
            (Geometry::Slender, DeviceKind::ClutchedPair) => go::<Slender, ClutchedPair>(group, found, registers),
            (Geometry::Slender, _) => go::<Slender, SingleInerter>(group, found, registers),
        };
        ended.map_err(|(index, error)| (start + index, error))?;
        start += group.len();
    }
    Ok(results)
}

fn go<M: Model, C: Clutch>(
    pulsed: &[PulsedBlock],
    results: &mut [PulseResult],
    registers: Registers,
) -> Result<(), (usize, CaseError)> {
    let work = Work { pulsed, results, kind: std::marker::PhantomData::<(M, C)> };
    match registers {
        Registers::Widest => Arch::new().dispatch(work),
        Registers::Baseline => work.call(),
    }
}
