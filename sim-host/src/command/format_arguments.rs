//! Options that say in which formats a command writes its tables and pictures.

use clap::Args;

use crate::output::Formats;

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
    #[arg(long)]
    pub png: bool,
}

impl PictureArguments {
    /// The formats that follow.
    pub fn formats(self) -> Formats {
        Formats { png: self.png, ..Formats::PLAIN }
    }
}
