//! Blocks under one cycle of a sine or a cosine, as many as there are: a lane whose block is done takes the next.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::marker::PhantomData;

use sprag_shared::math::scalar::Scalar;
use sprag_shared::math::{self, RECIPROCALS};
use sprag_shared::method::taylor::Taylor;

use crate::alone::{CaseError, TERMS, TIGHT};
use crate::blocks::{Blocks, Bounds};
use crate::model::Model;
use crate::pulsed::{PulseResult, PulseShape, PulsedBlock};
use crate::rest::{AfterWeakImpact, Sine};
use crate::series::Series;
use crate::times::{End, Timed, Watch};
use crate::{Mask, Number, WIDTH, number};
use sprag_shared::observers::outcome::Outcome;

/// Coefficients of θ: with more, steps hardly get longer, because events cut them.
const SERIES_TERMS: usize = 18;

/// Steps of one block before the core takes it; most take a dozen.
const MOST_STEPS: u32 = 400;

/// The pulses of the blocks in the lanes, each in its block's mirror: ü_g/g = A sin(ωt + φ).
#[derive(Clone, Copy, Debug)]
pub struct Pulses {
    /// A on the side to which the pulse first lifts the block.
    pub amplitude: Number,
    /// Angular frequency ω.
    pub frequency: Number,
    /// Phase φ, 0 or π/2.
    pub phase: Number,
    /// Time t from the start of the pulse.
    pub time: Number,
    /// End of the pulse.
    pub duration: Number,
}

/// Integrator of blocks under pulses.
pub trait Stepping: Default {
    /// A new block in `lane`.
    fn renew(&mut self, _lane: usize) {}

    /// The block in `lane` uplifts after so many whole half-cycles of its sine.
    fn uplift(&mut self, _lane: usize, _half_cycles: f64) {}

    /// Blocks will be asked when they overturn.
    fn watch(&mut self) {}

    /// When, in (0, `length`] of the last step, the block in `lane` passes |θ| = `limit` (rad), at which it overturns.
    fn passes(&self, lane: usize, length: f64, limit: f64) -> f64;

    /// The block in `lane` has come to its end and stands, as `results` have it under number `index`; its peak may be found later.
    fn stands(&mut self, _lane: usize, _index: usize, _results: &mut [PulseResult]) {}

    /// Finds what peaks are left; returns the numbers of those that are for the core.
    fn finish(&mut self, _results: &mut [PulseResult]) -> &[usize] {
        &[]
    }

    /// One step of blocks, at most up to the end of their pulses; returns how far each went.
    fn step<const PAIR: bool>(&mut self, blocks: &mut Blocks, bounds: &Bounds, pulses: &Pulses) -> Number;
}

/// Steps by power series.
pub struct BySeries<M> {
    series: Series<SERIES_TERMS>,
    model: PhantomData<M>,
}

impl<M> Default for BySeries<M> {
    fn default() -> Self {
        BySeries { series: Series::default(), model: PhantomData }
    }
}

impl<M: Model> Stepping for BySeries<M> {
    fn passes(&self, lane: usize, length: f64, limit: f64) -> f64 {
        self.series.passes(lane, length, limit)
    }

    #[inline(always)]
    fn step<const PAIR: bool>(&mut self, blocks: &mut Blocks, bounds: &Bounds, pulses: &Pulses) -> Number {
        pulses.series(blocks.side, &mut self.series.ground[..SERIES_TERMS - 2]);
        let modes = M::modes(bounds.slenderness, bounds.coupling);
        blocks.step::<M::Equation, PAIR, SERIES_TERMS>(&modes, bounds, &mut self.series, pulses.left())
    }
}

impl Pulses {
    /// Time left of each pulse.
    #[inline(always)]
    pub fn left(&self) -> Number {
        self.duration - self.time
    }

    /// The pulse of one lane, in units of the threshold.
    fn sine(&self, lane: usize, block: &PulsedBlock) -> Sine {
        let (frequency, phase, duration) = (self.frequency.0[lane], self.phase.0[lane], self.duration.0[lane]);
        Sine { amplitude: block.amplitude_ratio.abs(), frequency, phase, duration }
    }

    /// ü_g/g about the present time: c_{k+2} = −ω² c_k/((k+1)(k+2)).
    #[inline(always)]
    fn series(&self, side: Number, coefficients: &mut [Number]) {
        let angle = self.frequency * self.time + self.phase;
        let angle = angle.exceeds(number(PI)).choose(angle - number(TAU), angle);
        let (sine, cosine) = Scalar::sin_cos(angle);
        let amplitude = self.amplitude * side;
        let mut next = [amplitude * sine, amplitude * cosine * self.frequency];
        let factor = -(self.frequency * self.frequency);
        for (k, coefficient) in coefficients.iter_mut().enumerate() {
            let value = &mut next[k & 1];
            *coefficient = *value;
            *value = *value * factor * number(RECIPROCALS[(k + 1) & 63] * RECIPROCALS[(k + 2) & 63]);
        }
    }
}

/// Runs all `pulsed` blocks, which have the model `M` and the clutch `C`, into `results`, one each. Where they are `timed`, what the lanes
/// cannot settle is left there.
///
/// # Errors
/// The first [`CaseError`], with the number of its block; parameters are checked by the core when it is asked to follow a block.
#[inline(always)]
pub(crate) fn run<M: Model, const PAIR: bool>(
    pulsed: &[PulsedBlock],
    results: &mut [PulseResult],
    timed: Option<Timed<'_>>,
) -> Result<(), (usize, CaseError)> {
    let zero = number(0.0);
    let one = number(1.0);
    let method = Taylor::<f64, TERMS>::adaptive(TIGHT);
    let mut watch = timed.map(Watch::<M>::new);
    let follow = |index: usize, watch: &mut Option<Watch<'_, M>>| match watch {
        Some(watch) => {
            watch.leave(index);
            Ok(PulseResult::NO_ROCKING)
        }
        None => pulsed[index].follow::<M, PAIR>(&method).map_err(|error| (index, error)),
    };
    let mut stepping = M::Stepping::default();
    if watch.is_some() {
        stepping.watch();
    }
    let mut blocks = Blocks::default();
    let mut pulses = Pulses { amplitude: zero, frequency: one, phase: zero, time: zero, duration: one };
    let mut bounds = Bounds::harmless();
    let mut at = [None; WIDTH];
    let mut steps = [0_u32; WIDTH];
    let mut rests = Mask::NONE;
    let mut done = Mask::ALL;
    let mut next = 0;
    let mut went = zero;
    // Neighbours are mostly of one slenderness.
    let mut threshold = (f64::NAN, f64::NAN);
    loop {
        if done.any() {
            for lane in (0..WIDTH).filter(|&lane| done.at(lane)) {
                if let Some(index) = at[lane] {
                    let block: &PulsedBlock = &pulsed[index];
                    let peaks = (blocks.peak_rotation.0[lane], blocks.peak_acceleration.0[lane]);
                    results[index] = if blocks.hard.at(lane) {
                        follow(index, &mut watch)?
                    } else if blocks.overturned.at(lane) {
                        PulseResult::overturned(blocks.impact.at(lane))
                    } else if rests.at(lane) {
                        block.stands(peaks.0, peaks.1)
                    } else {
                        block.settle::<M, PAIR>(blocks.rotation.0[lane], blocks.velocity.0[lane], peaks, blocks.impact.at(lane))
                    };
                    if !blocks.hard.at(lane) && results[index].outcome == Outcome::Safe {
                        stepping.stands(lane, index, results);
                    }
                    if let Some(watch) = &mut watch
                        && !blocks.hard.at(lane)
                    {
                        let time = pulses.time.0[lane];
                        let end = if blocks.overturned.at(lane) {
                            let last = went.0[lane];
                            End::Overturned(time - last + stepping.passes(lane, last, bounds.overturned.0[lane]))
                        } else if rests.at(lane) {
                            End::Rest
                        } else {
                            End::PulseOver(pulses.duration.0[lane])
                        };
                        watch.ends::<PAIR>((index, block), lane, end, &blocks);
                    }
                }
                at[lane] = None;
                while at[lane].is_none() && next < pulsed.len() {
                    let block = &pulsed[next];
                    let uplifts = if block.is_within_range() { block.uplifts() } else { None };
                    if uplifts == Some(true) {
                        at[lane] = Some(next);
                        let alpha = block.plain.slenderness;
                        if threshold.0 != alpha {
                            threshold = (alpha, M::GEOMETRY.uplift_threshold(alpha));
                        }
                        // A positive ground acceleration uplifts the block to the negative side; the sign of the pulse only mirrors the motion.
                        let amplitude = block.amplitude_ratio.abs() * threshold.1;
                        let sine = block.pulse == PulseShape::Sine;
                        pulses.amplitude.0[lane] = -amplitude;
                        pulses.frequency.0[lane] = block.frequency_ratio;
                        pulses.phase.0[lane] = if sine { 0.0 } else { FRAC_PI_2 };
                        pulses.duration.0[lane] = TAU / block.frequency_ratio;
                        let uplift = || math::asin(1.0 / block.amplitude_ratio.abs()) / block.frequency_ratio;
                        pulses.time.0[lane] = if sine { uplift() } else { 0.0 };
                        bounds.renew(lane, &block.plain, M::GEOMETRY.point_of_no_return(alpha, amplitude));
                        blocks.renew(lane);
                        blocks.uplift(lane, 1.0, sine);
                        stepping.renew(lane);
                        if let Some(watch) = &mut watch {
                            watch.renew(lane);
                        }
                        stepping.uplift(lane, 0.0);
                        rests.set(lane, false);
                        steps[lane] = 0;
                    } else if uplifts == Some(false) {
                        results[next] = PulseResult::NO_ROCKING;
                        if let Some(watch) = &mut watch {
                            watch.stays(next, TAU / block.frequency_ratio);
                        }
                    } else {
                        results[next] = follow(next, &mut watch)?;
                    }
                    next += 1;
                }
                if at[lane].is_none() {
                    // Nothing left: whatever the lane continues with is plain.
                    blocks.hard.set(lane, true);
                }
            }
            if at.iter().all(Option::is_none) {
                for &index in stepping.finish(results) {
                    results[index] = follow(index, &mut watch)?;
                }
                return Ok(());
            }
        }
        let left = pulses.left();
        went = stepping.step::<PAIR>(&mut blocks, &bounds, &pulses);
        pulses.time = pulses.time + went;
        if let Some(watch) = &mut watch {
            watch.step(&blocks, pulses.time);
        }
        for (lane, count) in steps.iter_mut().enumerate() {
            *count += 1;
            if *count > MOST_STEPS {
                blocks.hard.set(lane, true);
            }
        }
        let weak = blocks.weak;
        if weak.any() {
            for lane in (0..WIDTH).filter(|&lane| weak.at(lane)) {
                let Some(block) = at[lane].map(|index: usize| &pulsed[index]) else { continue };
                let sine = pulses.sine(lane, block);
                let push = sine.amplitude * math::sin(sine.frequency * pulses.time.0[lane] + sine.phase) * -blocks.side.0[lane];
                let speed = blocks.velocity.0[lane];
                let (next, rested, tail) = sine.after_weak_impact::<M, PAIR>(pulses.time.0[lane], push, speed, &block.plain);
                if let Some(tail) = tail {
                    blocks.peak_acceleration.0[lane] = tail.raise(blocks.peak_acceleration.0[lane]);
                    if let Some(watch) = &mut watch {
                        watch.rests(lane, rested, tail.impacts);
                    }
                }
                match next {
                    AfterWeakImpact::Rests => rests.set(lane, true),
                    AfterWeakImpact::Uplifts { time, half_cycles } => {
                        pulses.time.0[lane] = time;
                        blocks.uplift(lane, if half_cycles % 2.0 == 0.0 { 1.0 } else { -1.0 }, true);
                        stepping.uplift(lane, half_cycles);
                    }
                    AfterWeakImpact::Unsettled => blocks.hard.set(lane, true),
                }
            }
        }
        done = !left.exceeds(went) | blocks.overturned | blocks.hard | rests;
    }
}
