//! How results reach people and programs: tables, figures, files, and what a user sees of a run.
//!
//! - [`columns`], [`text_table`], [`page`]: tables for programs and for people, and pages of them.
//! - [`plot`], [`heading`], [`band`]: figures, and what they say of a scene.
//! - [`output`]: files, whole or not at all; [`long_run`]: work that is split, interrupted and resumed.
//! - [`progress`], [`streams`], [`terminal`], [`signals`]: what a user sees of a command while it runs, and how it is stopped.
//! - [`part`]: what the program may be built without.
//!
//! Without the feature `host` there are only tables in memory and figures, which need neither files nor threads nor a terminal.

pub mod band;
pub mod columns;
pub mod heading;
mod lines;
#[cfg(feature = "host")]
pub mod long_run;
#[cfg(feature = "host")]
pub mod output;
#[cfg(feature = "host")]
pub mod page;
pub mod part;
pub mod plot;
#[cfg(feature = "host")]
pub mod progress;
#[cfg(feature = "host")]
pub mod signals;
#[cfg(feature = "host")]
pub mod streams;
#[cfg(feature = "host")]
pub mod terminal;
#[cfg(feature = "host")]
pub mod text_table;
