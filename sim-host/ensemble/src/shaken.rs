//! A block under a record: its parameters, its uplift and its outcome.

use sprag_shared::motion::state::{BlockState, Phase};
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::Block;

use crate::plain::PlainBlock;
use sprag_shared::observers::outcome::Outcome;

/// Distance to the threshold below which the core takes a ground acceleration that has jumped above it: there rounding decides whether the
/// block uplifts.
pub(crate) const DOUBTFUL_UPLIFT: f64 = 1e-9;

/// Ground acceleration of a record: straight lines between samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Interval between samples, s.
    pub(crate) step: f64,
    /// Samples of ü_g/g.
    pub(crate) values: Vec<f64>,
    /// max |ü_g/g| from each sample on.
    pub(crate) bounds: Vec<f64>,
}

impl Samples {
    /// Of ü_g/g every `step` (s, above 0).
    pub fn new(step: f64, values: Vec<f64>) -> Samples {
        let mut bounds = values.clone();
        let mut bound = 0.0_f64;
        for value in bounds.iter_mut().rev() {
            bound = bound.max(value.abs());
            *value = bound;
        }
        Samples { step, values, bounds }
    }

    /// ü_g/g at the samples.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Interval between samples, s.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Duration, s.
    pub fn duration(&self) -> f64 {
        self.step * self.values.len().saturating_sub(1) as f64
    }

    /// The first sample after `sample` beyond `threshold` (above 0).
    pub(crate) fn beyond(&self, sample: usize, threshold: f64) -> Option<usize> {
        let exceeds = |value: &f64| value.abs() > threshold;
        let first = sample + 1;
        let bound = self.bounds.get(first)?;
        if *bound <= threshold {
            return None;
        }
        // Registers compare many samples at once where none of them ends the search.
        const MANY: usize = 32;
        let quiet =
            self.values[first..].chunks(MANY).take_while(|samples| !samples.iter().fold(false, |any, a| any | exceeds(a)));
        let start = first + quiet.map(<[f64]>::len).sum::<usize>();
        self.values[start..].iter().position(exceeds).map(|place| start + place)
    }
}

/// A block under a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShakenBlock<'a> {
    /// The block and its device.
    pub plain: PlainBlock,
    /// p, 1/s.
    pub frequency_parameter: f64,
    /// The record.
    pub samples: &'a Samples,
    /// Factor on the record.
    pub factor: f64,
}

/// Final state and peaks of a block under a record, at its end or when it overturned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shaken {
    /// Rest, rocking or overturned.
    pub phase: Phase,
    /// θ, rad.
    pub rotation: f64,
    /// θ̇, rad/s.
    pub velocity: f64,
    /// Impacts that count.
    pub impacts: u32,
    /// Largest values and times, in rad and s from the record's start.
    pub peaks: Peaks<f64>,
}

impl Shaken {
    /// Its outcome, if the motion is over.
    pub fn outcome(&self) -> Outcome {
        Outcome::of(&BlockState { phase: self.phase, ..BlockState::default() }, &self.peaks)
    }

    /// max |θ|/α and max |θ̈|/(p²α) of `block`; none when overturned.
    pub fn relative_peaks(&self, block: &Block) -> Option<(f64, f64)> {
        let (alpha, p) = (block.slenderness(), block.frequency_parameter());
        (!self.outcome().overturned()).then_some((self.peaks.rotation / alpha, self.peaks.acceleration / (p * p * alpha)))
    }
}

/// Uplift of a block at rest: time and side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Uplift {
    /// Sample before the uplift.
    pub(crate) sample: usize,
    /// Time since that sample, in units of 1/p.
    pub(crate) time: f64,
    /// Side to which it uplifts, ±1.
    pub(crate) side: f64,
    /// The ground acceleration crosses the threshold, or has jumped above it.
    pub(crate) crossing: bool,
}

impl ShakenBlock<'_> {
    /// Whether the lanes may take it: parameters as the core would accept them.
    pub(crate) fn is_plain(&self) -> bool {
        let ShakenBlock { plain, frequency_parameter, samples, factor } = *self;
        plain.is_within_range()
            && (1e-3..1e3).contains(&frequency_parameter)
            && samples.values.len() > 1
            && (1e-9..1e3).contains(&samples.step)
            && (1e-9..1e4).contains(&(samples.bounds[0] * factor.abs()))
    }

    /// Interval between samples, in units of 1/p.
    pub(crate) fn step(&self) -> f64 {
        self.frequency_parameter * self.samples.step
    }

    /// ü_g/g at a sample.
    #[inline(always)]
    pub(crate) fn at(&self, sample: usize) -> f64 {
        self.factor * self.samples.values[sample]
    }

    /// ü_g/g at `sample` and its slope (p = 1) up to the next.
    pub(crate) fn line(&self, sample: usize) -> (f64, f64) {
        let start = self.at(sample);
        (start, (self.at(sample + 1) - start) / self.step())
    }

    /// The first uplift from `time` after `sample` on, where the ground acceleration is not above the `threshold`; or that it is there, hardly.
    pub(crate) fn next_uplift(&self, sample: usize, time: f64, threshold: f64) -> Result<Option<Uplift>, Doubtful> {
        let (start, slope) = self.line(sample);
        let now = start + slope * time;
        if now.abs() > threshold {
            let plain = now.abs() > threshold * (1.0 + DOUBTFUL_UPLIFT);
            return if plain { Ok(Some(Uplift { sample, time, side: -now.signum(), crossing: false })) } else { Err(Doubtful) };
        }
        let Some(beyond) = self.samples.beyond(sample, threshold / self.factor.abs()) else { return Ok(None) };
        let last = beyond - 1;
        let side = -self.at(beyond).signum();
        let (start, slope) = self.line(last);
        let crossing = (-side * threshold - start) / slope;
        let earliest = if last == sample { time } else { 0.0 };
        if self.step() - crossing <= self.step() * (4.0 * f64::EPSILON) {
            let next = beyond + 1 < self.samples.values.len();
            return Ok(next.then_some(Uplift { sample: beyond, time: 0.0, side, crossing: true }));
        }
        Ok(Some(Uplift { sample: last, time: crossing.max(earliest), side, crossing: true }))
    }
}

/// Rounding decides whether a block uplifts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Doubtful;
