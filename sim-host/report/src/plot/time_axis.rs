//! The two scales of the shared time axis.

use std::ops::Range;

use sprag_sim::history::History;

use super::PlotError;

/// The scale of a figure's time axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TimeAxis {
    /// Time in seconds.
    #[default]
    Seconds,
    /// Time multiplied by the block's frequency parameter, p t (dimensionless).
    TimesFrequencyParameter,
}

impl TimeAxis {
    /// What a time in seconds is multiplied by, for a block with frequency parameter `p` (1/s).
    pub(super) fn scale(self, p: f64) -> f64 {
        match self {
            Self::Seconds => 1.0,
            Self::TimesFrequencyParameter => p,
        }
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

/// From the first to the last of `times`.
///
/// Fails with [`PlotError::EmptyTimeSpan`] when there is no time between them.
pub(super) fn span_of(times: impl Iterator<Item = f64>) -> Result<Range<f64>, PlotError> {
    let (start, end) = times.fold((f64::INFINITY, f64::NEG_INFINITY), |(start, end), time| (start.min(time), end.max(time)));
    if end > start { Ok(start..end) } else { Err(PlotError::EmptyTimeSpan) }
}
