//! The two scales of the shared time axis.

use std::ops::Range;

use sprag_sim::history::History;
use sprag_sim::scene::schema::TimeAxisName;

use super::PlotError;
use super::ticks::drawable;

/// The scale of a figure's time axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TimeAxis {
    /// Time in seconds.
    #[default]
    Seconds,
    /// Time multiplied by the block's frequency parameter, p t (dimensionless).
    TimesFrequencyParameter,
}

impl From<TimeAxisName> for TimeAxis {
    fn from(name: TimeAxisName) -> TimeAxis {
        match name {
            TimeAxisName::Seconds => TimeAxis::Seconds,
            TimeAxisName::FrequencyParameter => TimeAxis::TimesFrequencyParameter,
        }
    }
}

impl TimeAxis {
    /// What a time in seconds is multiplied by, for a block with frequency parameter `p` (1/s).
    pub(super) fn scale(self, p: f64) -> f64 {
        match self {
            Self::Seconds => 1.0,
            Self::TimesFrequencyParameter => p,
        }
    }

    /// The same for the block of `device`, which is refused where no axis comes of its `p`.
    pub(super) fn scale_of(self, device: &str, p: f64) -> Result<f64, PlotError> {
        let scale = self.scale(p);
        if scale > 0.0 && drawable(scale) { Ok(scale) } else { Err(PlotError::InvalidBlock { device: device.to_owned() }) }
    }

    /// The axis title, in the markup of [`super::layer::formula`].
    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Seconds => "time (s)",
            Self::TimesFrequencyParameter => "*p* *t*",
        }
    }
}

/// From the first to the last sample of all responses, on the scale of the axis.
///
/// Fails with [`PlotError::EmptyTimeSpan`] when there is no time between them.
pub(super) fn time_span(histories: &[History], axes: TimeAxis) -> Result<Range<f64>, PlotError> {
    span_of(histories.iter().flat_map(|history| {
        let scale = axes.scale(history.frequency_parameter_1_s);
        history.samples.iter().map(move |sample| scale * sample.time_s)
    }))
}

/// Refuses what cannot be drawn of a trace over `time`: `values` and `lengths` of another length, numbers too large, and times out of
/// order.
pub(super) fn check_trace(
    device: &str,
    time: &[f64],
    values: &[(&str, &[f64])],
    lengths: &[(&str, usize)],
    faults: &[(f64, String)],
) -> Result<(), PlotError> {
    let expected = time.len();
    let mut lengths = values.iter().map(|(name, values)| (*name, values.len())).chain(lengths.iter().copied());
    if let Some((name, found)) = lengths.find(|(_, found)| *found != expected) {
        return Err(PlotError::WrongLength { name: name.to_owned(), found, expected });
    }
    let not_finite = |time_s: f64| Err(PlotError::NotFinite { device: device.to_owned(), time_s });
    for (index, &time_s) in time.iter().enumerate() {
        if !drawable(time_s) || !values.iter().all(|(_, values)| drawable(values[index])) {
            return not_finite(time_s);
        }
    }
    match faults.iter().find(|(time, _)| !drawable(*time)) {
        Some(&(time_s, _)) => not_finite(time_s),
        None => check_order(device, time.iter().copied()),
    }
}

/// Refuses `times` out of order.
pub(super) fn check_order(device: &str, times: impl Iterator<Item = f64>) -> Result<(), PlotError> {
    let mut before = f64::NEG_INFINITY;
    for time_s in times {
        if time_s < before {
            return Err(PlotError::TimeGoesBack { device: device.to_owned(), time_s });
        }
        before = time_s;
    }
    Ok(())
}

/// From the first to the last of `times`.
///
/// Fails with [`PlotError::EmptyTimeSpan`] when there is no time between them.
pub(super) fn span_of(times: impl Iterator<Item = f64>) -> Result<Range<f64>, PlotError> {
    let (start, end) = times.fold((f64::INFINITY, f64::NEG_INFINITY), |(start, end), time| (start.min(time), end.max(time)));
    if end > start { Ok(start..end) } else { Err(PlotError::EmptyTimeSpan) }
}
