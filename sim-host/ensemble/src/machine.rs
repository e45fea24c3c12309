//! The widest registers of the machine, chosen when the program runs.
//!
//! The lanes are written once, over plain arrays. Built for AVX-512, for AVX2 and FMA, and for whatever every machine of the target has,
//! they do the same IEEE operations in the same order on every lane (nothing is fused: Rust never contracts), so results are the same
//! to the last bit; [`Registers::Baseline`] is there to show it.

use std::marker::PhantomData;

#[cfg(target_arch = "x86_64")]
use pulp::Arch;
use pulp::NullaryFnOnce;
use sprag_shared::equation::body::{FullBody, SlenderBody};
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;

use crate::Number;
use crate::alone::CaseError;
use crate::hybrid::body::LaneBody;
use crate::hybrid::{self, HybridBlock, HybridMotion, Kind};
use crate::model::{FullAlone, FullWithInerter, Model, Slender};
use crate::pulsed::{PulseResult, PulsedBlock};
use crate::pulses;
use crate::records;
use crate::shaken::{Shaken, ShakenBlock};
use crate::times::{PulseTimes, Timed};

/// Width of the SIMD registers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Registers {
    /// The widest registers of this machine.
    #[default]
    Widest,
    /// The registers that every machine of the target has.
    Baseline,
}

/// Work on blocks of one model and device.
trait Work {
    type Output;

    /// Does it; to be inlined, so that it is built for the registers of its caller.
    fn with<M: Model, const PAIR: bool>(self) -> Self::Output;
}

/// Work on blocks with devices of one type of body.
struct OnHybridBlocks<'a, 'b, B> {
    blocks: &'a [HybridBlock<'b>],
    results: &'a mut [Option<HybridMotion>],
    kind: Kind,
    body: PhantomData<B>,
}

impl<B: LaneBody> NullaryFnOnce for OnHybridBlocks<'_, '_, B> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        hybrid::lanes::run::<B>(self.kind, self.blocks, self.results);
    }
}

/// Work for a model and a clutch.
struct Resolved<W, M, const PAIR: bool>(W, PhantomData<M>);

impl<W: Work, M: Model, const PAIR: bool> NullaryFnOnce for Resolved<W, M, PAIR> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.0.with::<M, PAIR>()
    }
}

/// Does `work` on blocks of this geometry and device.
fn resolve<W: Work>((geometry, device): (Geometry, DeviceKind), registers: Registers, work: W) -> W::Output {
    match (geometry, device) {
        (Geometry::Full, DeviceKind::None) => go::<W, FullAlone, false>(work, registers),
        (Geometry::Full, DeviceKind::Inerter) => go::<W, FullWithInerter, false>(work, registers),
        (Geometry::Full, DeviceKind::ClutchedPair) => go::<W, FullWithInerter, true>(work, registers),
        (Geometry::Slender, DeviceKind::ClutchedPair) => go::<W, Slender, true>(work, registers),
        (Geometry::Slender, _) => go::<W, Slender, false>(work, registers),
    }
}

fn go<W: Work, M: Model, const PAIR: bool>(work: W, registers: Registers) -> W::Output {
    built_for(registers, Resolved::<_, _, PAIR>(work, PhantomData::<M>))
}

/// Does `resolved` as it is built for the registers.
fn built_for<F: NullaryFnOnce>(registers: Registers, resolved: F) -> F::Output {
    match registers {
        // Not `Arch::dispatch`: its way without wide registers would be a second copy of the one below.
        #[cfg(target_arch = "x86_64")]
        Registers::Widest => match Arch::new() {
            Arch::V4(registers) => registers.vectorize(resolved),
            Arch::V3(registers) => registers.vectorize(resolved),
            _ => baseline(resolved),
        },
        _ => baseline(resolved),
    }
}

#[inline(never)]
fn baseline<F: NullaryFnOnce>(work: F) -> F::Output {
    work.call()
}

struct UnderPulses<'a> {
    pulsed: &'a [PulsedBlock],
    results: &'a mut [PulseResult],
    timed: Option<Timed<'a>>,
}

impl Work for UnderPulses<'_> {
    type Output = Result<(), (usize, CaseError)>;

    #[inline(always)]
    fn with<M: Model, const PAIR: bool>(self) -> Self::Output {
        pulses::run::<M, PAIR>(self.pulsed, self.results, self.timed)
    }
}

struct UnderRecords<'a, 'b> {
    shaken: &'a [ShakenBlock<'b>],
    results: &'a mut [Option<Shaken>],
}

impl Work for UnderRecords<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with<M: Model, const PAIR: bool>(self) -> Self::Output {
        records::run::<M, PAIR>(self.shaken, self.results);
    }
}

/// Outcome of each of `pulsed`, in their order.
///
/// # Errors
/// The first [`CaseError`], with the number of its block.
pub fn run(pulsed: &[PulsedBlock], registers: Registers) -> Result<Vec<PulseResult>, (usize, CaseError)> {
    let mut results = vec![PulseResult::NO_ROCKING; pulsed.len()];
    let mut start = 0;
    for group in groups(pulsed) {
        let found = &mut results[start..start + group.len()];
        let work = UnderPulses { pulsed: group, results: found, timed: None };
        resolve(kind(&group[0]), registers, work).map_err(|(index, error)| (start + index, error))?;
        start += group.len();
    }
    Ok(results)
}

/// Outcome, impacts and times of each of `pulsed`, in their order, which move freely for `free_times` (1/p) after their pulses, one for
/// each; `None` for those that the core is to follow.
pub fn run_timed(pulsed: &[PulsedBlock], free_times: &[f64], registers: Registers) -> Vec<Option<(PulseResult, PulseTimes)>> {
    let mut results = vec![PulseResult::NO_ROCKING; pulsed.len()];
    let mut times = vec![None; pulsed.len()];
    let mut start = 0;
    for group in groups(pulsed) {
        let all = start..start + group.len();
        let timed = Timed { free_times: &free_times[all.clone()], times: &mut times[all.clone()] };
        let work = UnderPulses { pulsed: group, results: &mut results[all.clone()], timed: Some(timed) };
        // What fails is left to the core, which says why.
        _ = resolve(kind(&group[0]), registers, work);
        start = all.end;
    }
    results.into_iter().zip(times).map(|(result, times)| times.map(|times| (result, times))).collect()
}

fn kind(block: &PulsedBlock) -> (Geometry, DeviceKind) {
    (block.plain.geometry, block.plain.device)
}

/// Neighbours of one model and device, which go through the lanes together.
fn groups(pulsed: &[PulsedBlock]) -> impl Iterator<Item = &[PulsedBlock]> {
    pulsed.chunk_by(|a, b| kind(a) == kind(b))
}

/// What `work` makes of each of `blocks`, in their order; it is given those of one kind together, wherever they stand.
fn by_kind<B: Copy, K: Ord, T: Clone>(
    blocks: &[B],
    kind: impl Fn(&B) -> K,
    mut work: impl FnMut(K, &[B], &mut [Option<T>]),
) -> Vec<Option<T>> {
    let mut order: Vec<(K, usize)> = blocks.iter().map(kind).zip(0..).collect();
    order.sort_unstable();
    let mut results = vec![None; blocks.len()];
    let mut order = order.into_iter().peekable();
    while let Some((kind, first)) = order.next() {
        let mut places = vec![first];
        while let Some((_, place)) = order.next_if(|(next, _)| *next == kind) {
            places.push(place);
        }
        let group: Vec<B> = places.iter().map(|&place| blocks[place]).collect();
        let mut found = vec![None; group.len()];
        work(kind, &group, &mut found);
        for (place, found) in places.into_iter().zip(found) {
            results[place] = found;
        }
    }
    results
}

/// Final state of each of `shaken`, in their order; `None` for those that the core takes.
pub fn shake(shaken: &[ShakenBlock<'_>], registers: Registers) -> Vec<Option<Shaken>> {
    let kind = |block: &ShakenBlock<'_>| (block.plain.geometry, block.plain.device);
    by_kind(shaken, kind, |kind, shaken, results| resolve(kind, registers, UnderRecords { shaken, results }))
}

/// Motion of each of `blocks` up to the end of its record, in their order; `None` for those that the core takes.
pub fn shake_hybrid(blocks: &[HybridBlock<'_>], registers: Registers) -> Vec<Option<HybridMotion>> {
    by_kind(blocks, HybridBlock::kind, |kind, blocks, results| match kind.geometry {
        Geometry::Full => built_for(registers, OnHybridBlocks::<FullBody<Number>> { blocks, results, kind, body: PhantomData }),
        Geometry::Slender => {
            built_for(registers, OnHybridBlocks::<SlenderBody<Number>> { blocks, results, kind, body: PhantomData });
        }
    })
}
