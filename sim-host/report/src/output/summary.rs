//! `summary.json`: what results were made of and by, and what was found.

use std::collections::BTreeMap;

use serde::Serialize;
use sprag_sim::record::RecordSummary;

use super::Digest;

/// Version of the layout of `summary.json` and of `--json`; it grows when a key changes its meaning or goes.
pub const SCHEMA_VERSION: u32 = 1;

/// Version of the program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Command, version and input that made a result: what a Parquet file says of itself.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Maker<'a, I> {
    command: &'a str,
    version: &'a str,
    #[serde(flatten)]
    input: I,
}

impl<'a, I> Maker<'a, I> {
    /// This version of the program as the maker.
    pub fn new(command: &'a str, input: I) -> Maker<'a, I> {
        Maker { command, version: VERSION, input }
    }
}

/// The document of `summary.json`: `input` is the scene or study as resolved.
#[derive(Clone, Debug, Serialize)]
pub struct Summary<'a, I, F> {
    /// Subcommand.
    pub command: &'a str,
    /// Version of the program.
    pub version: &'a str,
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// Scene or study as resolved.
    #[serde(flatten)]
    pub input: I,
    /// Records that were read.
    pub records: &'a [RecordSummary],
    /// Warnings of scene and records.
    pub warnings: &'a [String],
    /// Contents of the files that were read.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub files: &'a BTreeMap<String, Digest>,
    /// What the command found.
    #[serde(flatten)]
    pub findings: F,
}

/// An object that `--json` prints, with [`SCHEMA_VERSION`].
#[derive(Clone, Debug, Serialize)]
pub struct Versioned<T> {
    schema_version: u32,
    #[serde(flatten)]
    object: T,
}

impl<T> Versioned<T> {
    /// The object in this version of its layout.
    pub fn new(object: T) -> Versioned<T> {
        Versioned { schema_version: SCHEMA_VERSION, object }
    }
}
