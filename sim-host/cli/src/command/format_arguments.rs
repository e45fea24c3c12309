//! Options that say in which formats a command writes its tables and pictures.

use clap::{ArgAction, Args};
use sprag_report::output::Formats;

/// Formats of a command that writes tables for programs.
#[derive(Args, Clone, Copy, Debug)]
pub struct FormatArguments {
    /// Formats of tables (csv, parquet) and pictures (svg, png), separated by commas; csv is always among them.
    #[arg(long, value_name = "LIST", default_value_t = Formats::ALL)]
    pub formats: Formats,
}

/// Formats of any other command that draws.
#[derive(Args, Clone, Copy, Debug)]
pub struct PictureArguments {
    /// Write pictures as PNG too.
    #[arg(long = "png", action = ArgAction::SetTrue, default_value = "csv,svg", default_missing_value = "csv,svg,png")]
    pub formats: Formats,
}
