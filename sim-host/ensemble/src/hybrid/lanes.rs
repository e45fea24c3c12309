//! The lanes: each block is where it is in its ground motion, and one whose motion is over gives its lane to the next.

use std::array::from_fn;

use sprag_loops::{HybridLoop, Method, hybrid};
use sprag_shared::motion::state::Stopped;

use super::body::LaneBody;
use super::expansion::Expansion;
use super::seat::Seat;
use super::stretch::{Stepped, Stretch};
use super::{HybridBlock, HybridMotion, Kind, MOST_EVENTS};
use crate::WIDTH;
use crate::alone::TIGHT;

/// Blocks of one type of body in the lanes.
struct Lanes<'a, 'b, B> {
    blocks: &'b [HybridBlock<'a>],
    method: &'b dyn HybridLoop<f64>,
    stretch: Stretch<B>,
    /// Block of each lane, with its number.
    seats: [Option<(usize, Seat<'a>)>; WIDTH],
    next: usize,
}

impl<B: LaneBody> Lanes<'_, '_, B> {
    /// Gives `lane` to the next block that lanes can follow; what becomes of those before it is known at once.
    #[inline(never)]
    fn refill(&mut self, lane: usize, results: &mut [Option<HybridMotion>]) {
        while let Some(block) = self.blocks.get(self.next) {
            let index = self.next;
            self.next += 1;
            if !block.is_plain() {
                continue;
            }
            self.stretch.renew(lane, block.system);
            self.seats[lane] = Some((index, Seat::new(*block)));
            if self.seat(lane, results, |_, _| Ok(())) {
                return;
            }
        }
    }

    /// Does `first` with the block in `lane` and finds the mode from which its lane takes it on. False where its motion is over, and its
    /// result is there.
    fn seat(
        &mut self,
        lane: usize,
        results: &mut [Option<HybridMotion>],
        first: impl FnOnce(&mut Seat<'_>, &dyn HybridLoop<f64>) -> Result<(), Stopped>,
    ) -> bool {
        let Some((index, seat)) = &mut self.seats[lane] else { return false };
        let mode = first(seat, self.method).and_then(|()| seat.next_mode(self.method));
        if let Ok(Some(law)) = mode {
            self.stretch.set_mode(lane, seat, &law);
            return true;
        }
        // Of an error the core says more, to whoever asks it for this block alone.
        if mode.is_ok() {
            results[*index] = Some(seat.motion);
        }
        self.seats[lane] = None;
        false
    }

    /// The core looks for the event in the step that `lane` has expanded, or takes one of its own where that series has not converged.
    #[inline(never)]
    fn locate(&mut self, lane: usize, expansion: &mut Expansion, stepped: &Stepped, results: &mut [Option<HybridMotion>]) {
        self.hand_over(lane);
        if stepped.converged.at(lane) {
            expansion.take_out(lane, self.stretch.kind, stepped);
        }
        let step = |seat: &mut Seat<'_>, method: &dyn HybridLoop<f64>| {
            if stepped.converged.at(lane) {
                seat.locate(&expansion.one, stepped.pressed.at(lane))
            } else {
                seat.step_by_core(method)
            }
        };
        if !self.seat(lane, results, step) {
            self.refill(lane, results);
        }
    }

    /// The block in `lane` is at the end of its record, or of a piece of any other motion.
    #[inline(never)]
    fn end(&mut self, lane: usize, results: &mut [Option<HybridMotion>]) {
        self.hand_over(lane);
        let next = |seat: &mut Seat<'_>, _: &dyn HybridLoop<f64>| {
            if !seat.is_over() {
                seat.go_on();
            }
            Ok(())
        };
        if !self.seat(lane, results, next) {
            self.refill(lane, results);
        }
    }

    /// What the lane knows of its block, to the core's state.
    fn hand_over(&mut self, lane: usize) {
        let Some((_, seat)) = &mut self.seats[lane] else { return };
        let stretch = &self.stretch;
        if stretch.elapsed.0[lane] > 0.0 {
            let place = (stretch.rotation.0[lane], stretch.velocity.0[lane]);
            seat.take(place, stretch.fastest.0[lane], stretch.spins(lane), stretch.elapsed.0[lane]);
        }
        seat.motion.peaks.rotation = stretch.peak_rotation.0[lane];
        seat.motion.peaks.acceleration = stretch.peak_acceleration.0[lane];
    }
}

/// Runs all `blocks`, whose bodies are of the type `B` and whose [`Kind`] is `kind`, into `results`, one each; those left `None` are for the
/// core.
#[inline(always)]
pub(crate) fn run<B: LaneBody>(kind: Kind, blocks: &[HybridBlock<'_>], results: &mut [Option<HybridMotion>]) {
    let method = hybrid(Method::Adaptive(TIGHT));
    let mut expansion = Expansion::default();
    let mut lanes = Lanes { blocks, method: &*method, stretch: Stretch::<B>::new(kind), seats: from_fn(|_| None), next: 0 };
    for lane in 0..WIDTH {
        lanes.refill(lane, results);
    }
    while lanes.seats.iter().any(Option::is_some) {
        let stepped = lanes.stretch.step(&mut expansion);
        for lane in 0..WIDTH {
            let Some((_, seat)) = &mut lanes.seats[lane] else { continue };
            if !stepped.plain.at(lane) {
                lanes.locate(lane, &mut expansion, &stepped, results);
                continue;
            }
            seat.motion.steps.plain += 1;
            if kind.curved && seat.motion.steps.plain > MOST_EVENTS {
                // The core says of it that it does not end.
                lanes.seats[lane] = None;
                lanes.refill(lane, results);
            } else if seat.moves(stepped.time.0[lane]) {
                lanes.stretch.stand_at(lane, seat);
            } else {
                lanes.end(lane, results);
            }
        }
    }
}
