//! Figures as SVG text: responses, energies, sensitivities.
//!
//! plotters draws axes and curves; clip, dash patterns, tints and formula labels are SVG around its output.

mod curve;
mod decimate;
mod device_trace;
mod energy_figure;
mod engagement;
mod ground;
mod history_figure;
mod layer;
mod legend;
mod palette;
mod panel;
mod round_scale;
mod sensitivity_figure;
#[cfg(test)]
mod synthetic;
mod ticks;
mod time_axis;

pub use energy_figure::energy_figure;
pub use history_figure::history_figure;
pub use sensitivity_figure::{OwnMark, SensitivityLane, SensitivityRow, sensitivity_figure};
pub use time_axis::TimeAxis;

/// Why a figure could not be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlotError {
    /// The list of histories is empty.
    #[error("a history figure needs at least one response")]
    NoHistories,
    /// All samples lie at one instant, or there are fewer than two.
    #[error("the responses span no time, so there is no time axis to draw")]
    EmptyTimeSpan,
    /// A sample lies earlier than the one before it.
    #[error("the samples of `{device}` go back in time at {time_s} s")]
    TimeGoesBack {
        /// Name of the device.
        device: String,
        /// Time of the offending sample (s).
        time_s: f64,
    },
    /// A time or a plotted quantity is not a finite number.
    #[error("the response of `{device}` holds a number that is not finite near {time_s} s")]
    NotFinite {
        /// Name of the device.
        device: String,
        /// Time of the offending sample or impact (s).
        time_s: f64,
    },
    /// Slenderness or frequency parameter is not a positive finite number.
    #[error("the block of `{device}` needs a positive slenderness and frequency parameter")]
    InvalidBlock {
        /// Name of the device.
        device: String,
    },
    /// The drawing library refused.
    #[error("cannot draw the figure: {0}")]
    Drawing(String),
}
