//! Crests of |θ̈| that are looked for when their block has come to its end: not for blocks that overturn, and in full registers.

use super::Motion;
use super::crest::largest;
use crate::pulsed::PulseResult;
use crate::{WIDTH, number};

/// A step within which |θ̈| may have its largest value.
#[derive(Clone, Copy, Debug)]
struct Step {
    motion: [f64; 7],
    length: f64,
}

/// The steps of the blocks in the lanes, and of those that have come to their ends.
#[derive(Clone, Debug, Default)]
pub struct Pending {
    lanes: [Vec<Step>; WIDTH],
    ended: Vec<(usize, Step)>,
    unsolved: Vec<usize>,
}

impl Pending {
    /// A new block in `lane`.
    #[inline(always)]
    pub fn renew(&mut self, lane: usize) {
        self.lanes[lane].clear();
    }

    /// A step of the block in `lane`.
    #[inline(always)]
    pub fn add(&mut self, lane: usize, motion: &Motion, length: f64) {
        self.lanes[lane].push(Step { motion: motion.lane(lane), length });
    }

    /// The block in `lane` stands, as `results` have it under number `index`.
    #[inline(always)]
    pub fn stands(&mut self, lane: usize, index: usize, results: &mut [PulseResult]) {
        self.ended.extend(self.lanes[lane].drain(..).map(|step| (index, step)));
        while self.ended.len() >= WIDTH {
            self.solve(results);
        }
    }

    /// Puts what is left into `results`; returns the numbers of those whose peaks are not decided.
    #[inline(always)]
    pub fn finish(&mut self, results: &mut [PulseResult]) -> &[usize] {
        while !self.ended.is_empty() {
            self.solve(results);
        }
        &self.unsolved
    }

    /// The last of those that have ended.
    #[inline(always)]
    fn solve(&mut self, results: &mut [PulseResult]) {
        let from = self.ended.len().saturating_sub(WIDTH);
        let Some(&(_, any)) = self.ended.last() else { return };
        let mut motions = [any.motion; WIDTH];
        let (mut length, mut known) = (number(any.length), number(f64::INFINITY));
        for (lane, &(index, step)) in self.ended[from..].iter().enumerate() {
            motions[lane] = step.motion;
            length.0[lane] = step.length;
            let [slenderness, ..] = step.motion;
            known.0[lane] = results[index].peak_acceleration * slenderness;
        }
        let motion = Motion::of_lanes(&motions);
        let (found, unknown) = largest(&motion, (length, &motion.at(length)), known);
        for (lane, (index, _)) in self.ended.drain(from..).enumerate() {
            if unknown.at(lane) {
                self.unsolved.push(index);
            }
            let peak = &mut results[index].peak_acceleration;
            *peak = peak.max(found.0[lane] / motion.slenderness.0[lane]);
        }
    }
}
