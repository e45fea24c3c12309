//! Figures as SVG text: responses, energies, sensitivities, closed loops, recordings of devices, maps of outcomes, clouds of runs,
//! trade-offs, comparisons, charts of lines.
//!
//! Figures are SVG, written element by element (`layer`). [`png()`] makes dots of it.

mod axis_ticks;
mod cell;
mod cell_map;
mod chart;
mod cloud_figure;
mod curve;
mod decimate;
mod device_trace;
#[cfg_attr(not(feature = "png"), path = "no_drawn.rs")]
mod drawn;
mod energy_figure;
mod engagement;
mod fault_mark;
mod figure_title;
mod formula;
mod ground;
mod history_figure;
mod interval_figure;
mod lane;
mod layer;
mod legend;
mod loop_figure;
#[cfg(feature = "effects")]
mod loop_trace;
mod map_curve;
mod marker;
mod palette;
mod panel;
mod panel_grid;
mod panel_heading;
#[cfg_attr(not(feature = "png"), path = "no_png.rs")]
mod png;
mod recording_figure;
mod rug;
mod sensitivity_figure;
mod stack;
#[cfg(test)]
mod synthetic;
mod text_width;
mod ticks;
mod time_axis;
mod trade_off_figure;

pub use cell::{Cell, Class, band};
pub use cell_map::{CellMap, CellMaps, cell_map_figure};
pub use chart::{Chart, ChartKey, ChartPanel, Line, LineLook, chart_figure};
pub use cloud_figure::{BandPoint, CloudFigure, CloudPanel, CloudSeries, cloud_figure};
pub use drawn::assert_drawn;
pub use energy_figure::energy_figure;
pub use figure_title::FigureTitle;
pub use formula::literal;
pub use history_figure::history_figure;
pub use interval_figure::{Interval, interval_figure};
pub use loop_figure::{LoopTrace, loop_figure};
pub use map_curve::MapCurve;
pub use png::{Png, PngError, png};
pub use recording_figure::{RecordingTrace, recording_figure};
pub use rug::Rug;
pub use sensitivity_figure::{OwnMark, SensitivityLane, SensitivityRow, sensitivity_figure};
pub use ticks::Scale;
pub use time_axis::TimeAxis;
pub use trade_off_figure::{TradeOffFigure, TradeOffMark, TradeOffPanel, TradeOffPoint, trade_off_figure};

/// Reasons why a figure could not be drawn.
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
    /// There are no panels, no maps, or no points that the axes can show.
    #[error("the figure `{title}` has nothing to draw")]
    NothingToDraw {
        /// Title of the figure.
        title: String,
    },
    /// Peaks are drawn of blocks that do not overturn, and there is none.
    #[error("every block overturns, so that there is no peak to draw")]
    AllOverturn,
    /// A value to draw is not a finite number.
    #[error("`{name}` holds a number that is not finite")]
    NotFiniteValue {
        /// Name of the line, or title of the axis.
        name: String,
    },
    /// A series or a grid has another number of values than it should have.
    #[error("`{name}` has {found} values instead of {expected}")]
    WrongLength {
        /// Name of the series or grid.
        name: String,
        /// How many values it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// The last cell of an axis does not lie beyond the first.
    #[error("the axis `{title}` does not increase")]
    EmptyAxis {
        /// Title of the axis.
        title: String,
    },
}
