//! A plotters scale with given ticks, since the ones plotters picks may crowd neighbouring panels.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::Ranged;

/// A linear scale over a range, with its tick values.
#[derive(Clone)]
pub(super) struct RoundScale {
    inner: RangedCoordf64,
    ticks: Vec<f64>,
}

impl RoundScale {
    /// A scale over `range` that has exactly these `ticks`.
    pub(super) fn new(range: &Range<f64>, ticks: &[f64]) -> Self {
        Self { inner: RangedCoordf64::from(range.clone()), ticks: ticks.to_vec() }
    }
}

impl Ranged for RoundScale {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.inner.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.inner.range()
    }
}
