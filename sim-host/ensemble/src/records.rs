//! Blocks under records: each lane is at a sample of its own, and one whose record is over takes the next block.
//!
//! Between two samples the ground is a straight line, so a step goes no further than to the next one, and few terms do. A block at rest
//! costs nothing: the sample that lifts it again is looked up.

use std::array::from_fn;
use std::f64::consts::FRAC_PI_2;

use sprag_shared::math::scalar::Scalar;
use sprag_shared::motion::state::Phase;
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::Geometry;

use crate::blocks::{Blocks, Bounds};
use crate::model::Model;
use crate::rest::tail;
use crate::series::Series;
use crate::shaken::{DOUBTFUL_UPLIFT, Doubtful, Samples, Shaken, ShakenBlock, Uplift};
use crate::{Mask, Number, WIDTH, number};

/// Coefficients of θ: as many as reach from one sample to the next.
const SERIES_TERMS: usize = 9;

/// Steps within one sample before the core takes a block.
const MOST_STEPS: f64 = 5_000.0;

/// Data of a lane's block beside the numbers.
#[derive(Clone, Copy, Debug)]
struct Place {
    index: usize,
    sample: usize,
    threshold: f64,
    impacts: u32,
    /// Times, in s from the record's start. The largest values are the lanes'.
    peaks: Peaks<f64>,
}

/// The ground under the blocks in the lanes: straight lines since their last samples.
struct Lines {
    /// Time since the sample.
    time: Number,
    /// Interval between samples.
    step: Number,
    /// Sampling rate, per unit of time.
    rate: Number,
    /// ü_g/g at the sample.
    start: Number,
    /// ü_g/g at the next.
    end: Number,
}

impl Lines {
    /// ü_g/g now, and its slope.
    #[inline(always)]
    fn now(&self) -> (Number, Number) {
        let slope = (self.end - self.start) * self.rate;
        (self.start + slope * self.time, slope)
    }
}

/// Decision after a weak impact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AfterWeakImpact {
    /// It continues to rock.
    Rocks,
    /// It rests to the end of the record.
    Rests,
    /// It rests, and was put to the instant at which it uplifts again.
    Uplifts,
}

/// Blocks of one model and device in the lanes.
struct Lanes<'a, 'b> {
    shaken: &'a [ShakenBlock<'b>],
    blocks: Blocks,
    bounds: Bounds,
    lines: Lines,
    at: [Option<Place>; WIDTH],
    next: usize,
}

impl<'a, 'b> Lanes<'a, 'b> {
    fn new(shaken: &'a [ShakenBlock<'b>]) -> Self {
        let (zero, one) = (number(0.0), number(1.0));
        Lanes {
            shaken,
            blocks: Blocks::default(),
            bounds: Bounds::harmless(),
            lines: Lines { time: zero, step: one, rate: one, start: zero, end: zero },
            at: [None; WIDTH],
            next: 0,
        }
    }

    /// Puts the next block that rocks into `lane`; what happens to those before it is known at once.
    fn refill<M: Model>(&mut self, lane: usize, results: &mut [Option<Shaken>]) {
        self.at[lane] = None;
        while let Some(block) = self.shaken.get(self.next) {
            let index = self.next;
            self.next += 1;
            if !block.is_plain() {
                continue;
            }
            let threshold = M::GEOMETRY.uplift_threshold(block.plain.slenderness);
            let first = match block.next_uplift(0, 0.0, threshold) {
                Err(Doubtful) => continue,
                Ok(None) => {
                    results[index] =
                        Some(Shaken { phase: Phase::Rest, rotation: 0.0, velocity: 0.0, impacts: 0, peaks: Peaks::default() });
                    continue;
                }
                Ok(Some(uplift)) => uplift,
            };
            self.bounds.renew(lane, &block.plain, FRAC_PI_2);
            self.lines.step.0[lane] = block.step();
            self.lines.rate.0[lane] = 1.0 / block.step();
            self.at[lane] =
                Some(Place { index, sample: 0, threshold, impacts: 0, peaks: Peaks { rocked: true, ..Peaks::default() } });
            self.blocks.renew(lane);
            self.uplift::<M>(lane, first);
            return;
        }
        // Nothing left: whatever the lane continues with is plain.
        self.blocks.hard.set(lane, true);
    }

    fn uplift<M: Model>(&mut self, lane: usize, uplift: Uplift) {
        self.blocks.uplift(lane, uplift.side, uplift.crossing);
        self.stand_at::<M>(lane, uplift.sample, uplift.time);
    }

    /// Moves `lane` to `time` after `sample`.
    fn stand_at<M: Model>(&mut self, lane: usize, sample: usize, time: f64) {
        let Some(place) = &mut self.at[lane] else { return };
        place.sample = sample;
        let block = &self.shaken[place.index];
        self.lines.time.0[lane] = time;
        (self.lines.start.0[lane], self.lines.end.0[lane]) = (block.at(sample), block.at(sample + 1));
        self.bound::<M>(lane, block, sample);
    }

    /// A slender block has no ground to lie on: it has overturned when no ground acceleration still to come brings it back.
    #[inline(always)]
    fn bound<M: Model>(&mut self, lane: usize, block: &ShakenBlock<'_>, sample: usize) {
        if M::GEOMETRY == Geometry::Slender {
            let no_return = block.plain.slenderness + block.factor.abs() * block.samples.bounds[sample];
            self.bounds.overturned.0[lane] = block.plain.overturned_at(no_return);
        }
    }

    /// Moves the lanes that are `over` to their next samples. Returns those whose records end there.
    #[inline(always)]
    fn next_samples<M: Model>(&mut self, over: Mask) -> Mask {
        let mut last = Mask::NONE;
        // In registers: a vector whose numbers have been stored one by one makes the processor wait.
        let end: [f64; WIDTH] = from_fn(|lane| {
            let end = self.lines.end.0[lane];
            let (true, Some(place)) = (over.at(lane), &mut self.at[lane]) else { return end };
            let block = &self.shaken[place.index];
            let Samples { values, bounds, .. } = block.samples;
            let sample = place.sample + 1;
            if sample + 1 >= values.len() {
                last.set(lane, true);
                return end;
            }
            place.sample = sample;
            if bounds[sample] != bounds[sample - 1] {
                self.bound::<M>(lane, block, sample);
            }
            block.at(sample + 1)
        });
        let moves = over & !last;
        self.lines.start = moves.choose(self.lines.end, self.lines.start);
        self.lines.time = moves.choose(number(0.0), self.lines.time);
        self.lines.end.0 = end;
        last
    }

    /// s since the start of the record.
    fn seconds(&self, place: &Place, time: f64) -> f64 {
        let block = &self.shaken[place.index];
        block.samples.step * place.sample as f64 + time / block.frequency_parameter
    }

    /// Notes impacts, of which `first` are the first ones, and lets blocks rest that hardly move any more: those that rest to the end of
    /// their records, and those that were put to their next uplift.
    fn after_impacts<M: Model, const PAIR: bool>(&mut self, first: Mask) -> (Mask, Mask) {
        let (mut rest, mut uplift) = (Mask::NONE, Mask::NONE);
        let (counted, weak) = (self.blocks.counted, self.blocks.weak);
        let notable = counted | weak | first;
        for lane in (0..WIDTH).filter(|&lane| notable.at(lane)) {
            let Some(mut place) = self.at[lane] else { continue };
            if first.at(lane) {
                place.peaks.first_impact = Some(self.seconds(&place, self.lines.time.0[lane]));
            }
            if counted.at(lane) {
                place.impacts += 1;
                if place.peaks.first_counted_impact.is_none() {
                    place.peaks.first_counted_impact = Some(self.seconds(&place, self.lines.time.0[lane]));
                }
            }
            self.at[lane] = Some(place);
            if weak.at(lane) {
                match self.weak_impact::<M, PAIR>(lane, place) {
                    AfterWeakImpact::Rocks => {}
                    AfterWeakImpact::Rests => rest.set(lane, true),
                    AfterWeakImpact::Uplifts => uplift.set(lane, true),
                }
            }
        }
        (rest, uplift)
    }

    /// As the core's impact: those that accumulate after a weak one, in closed form.
    fn weak_impact<M: Model, const PAIR: bool>(&mut self, lane: usize, mut place: Place) -> AfterWeakImpact {
        let block = &self.shaken[place.index];
        let (time, step) = (self.lines.time.0[lane], self.lines.step.0[lane]);
        let (start, slope) = block.line(place.sample);
        let push_at = |time: f64| (start + slope * time) / place.threshold;
        let push = push_at(time) * self.blocks.side.0[lane];
        let speed = self.blocks.velocity.0[lane].abs();
        let negligible = speed <= self.bounds.weak.0[lane] * f64::EPSILON;
        if push.abs() >= 1.0 {
            if push.abs() <= 1.0 + DOUBTFUL_UPLIFT {
                self.blocks.hard.set(lane, true);
            } else if negligible {
                // The push ends impacts that are too weak to distinguish.
                let side = -push_at(time).signum();
                self.uplift::<M>(lane, Uplift { sample: place.sample, time, side, crossing: false });
                return AfterWeakImpact::Uplifts;
            }
            return AfterWeakImpact::Rocks;
        }
        let tail = tail::<M, PAIR>(push, speed, &block.plain);
        let rest = tail.rest(time, step, negligible, |at| push_at(at).abs() < 1.0);
        let Some(ends) = rest else { return AfterWeakImpact::Rocks };
        self.blocks.peak_acceleration.0[lane] = tail.raise(self.blocks.peak_acceleration.0[lane]);
        place.impacts += tail.impacts;
        place.peaks.ended = Some(self.seconds(&place, ends));
        self.at[lane] = Some(place);
        match block.next_uplift(place.sample, ends, place.threshold) {
            Err(Doubtful) => {
                self.blocks.hard.set(lane, true);
                AfterWeakImpact::Rocks
            }
            Ok(None) => AfterWeakImpact::Rests,
            Ok(Some(uplift)) => {
                place.peaks.ended = None;
                self.at[lane] = Some(place);
                self.uplift::<M>(lane, uplift);
                AfterWeakImpact::Uplifts
            }
        }
    }

    /// Outcome of the block in `lane`.
    fn shaken(&self, place: &Place, lane: usize, phase: Phase) -> Shaken {
        let (p, side) = (self.shaken[place.index].frequency_parameter, self.blocks.side.0[lane]);
        let moves = if phase == Phase::Rest { 0.0 } else { side };
        Shaken {
            phase,
            rotation: moves * self.blocks.rotation.0[lane],
            velocity: moves * self.blocks.velocity.0[lane] * p,
            impacts: place.impacts,
            peaks: Peaks {
                rotation: self.blocks.peak_rotation.0[lane],
                acceleration: self.blocks.peak_acceleration.0[lane] * p * p,
                ..place.peaks
            },
        }
    }
}

/// Runs all `shaken` blocks, which have the model `M` and the clutch `C`, into `results`, one each; those left `None` are for the core.
#[inline(always)]
pub(crate) fn run<M: Model, const PAIR: bool>(shaken: &[ShakenBlock<'_>], results: &mut [Option<Shaken>]) {
    let (zero, one) = (number(0.0), number(1.0));
    let mut series = Series::<SERIES_TERMS>::default();
    let mut lanes = Lanes::new(shaken);
    for lane in 0..WIDTH {
        lanes.refill::<M>(lane, results);
    }
    let mut steps = zero;
    while lanes.at.iter().any(Option::is_some) {
        let Lanes { blocks, lines, bounds, .. } = &mut lanes;
        let (now, slope) = lines.now();
        (series.ground[0], series.ground[1]) = (now * blocks.side, slope * blocks.side);
        let left = lines.step - lines.time;
        let before = blocks.impact;
        let modes = M::modes(bounds.slenderness, bounds.coupling);
        let went = blocks.step::<M::Equation, PAIR, SERIES_TERMS>(&modes, bounds, &mut series, left);
        lines.time = lines.time + went;
        let mut over = !left.exceeds(went);
        steps = over.choose(zero, steps + one);
        blocks.hard = blocks.hard | steps.exceeds(number(MOST_STEPS));
        let first = blocks.impact & !before;
        let mut rest = Mask::NONE;
        if (first | blocks.counted | blocks.weak).any() {
            let uplift;
            (rest, uplift) = lanes.after_impacts::<M, PAIR>(first);
            over = over & !uplift;
        }
        let ended = lanes.blocks.overturned | lanes.blocks.hard | rest;
        let over = lanes.next_samples::<M>(over & !ended);
        for lane in (0..WIDTH).filter(|&lane| ended.at(lane) || over.at(lane)) {
            let Some(mut place) = lanes.at[lane] else { continue };
            let phase = if lanes.blocks.hard.at(lane) {
                None
            } else if lanes.blocks.overturned.at(lane) {
                let start = lanes.lines.time.0[lane] - went.0[lane];
                let passed = series.passes(lane, went.0[lane], lanes.bounds.overturned.0[lane]);
                place.peaks.ended = Some(lanes.seconds(&place, start + passed));
                Some(Phase::Overturned)
            } else if rest.at(lane) {
                Some(Phase::Rest)
            } else {
                Some(Phase::Rocking)
            };
            results[place.index] = phase.map(|phase| lanes.shaken(&place, lane, phase));
            lanes.refill::<M>(lane, results);
            steps.0[lane] = 0.0;
        }
    }
}
