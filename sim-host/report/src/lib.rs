//! How results reach people and programs: tables, figures, files, and what a user sees of a run.
//!
//! - [`columns`], [`text_table`], [`page`]: tables for programs and for people, and pages of them.
//! - [`plot`], [`heading`], [`band`]: figures, and what they say of a scene.
//! - [`output`]: files, whole or not at all; [`long_run`]: work that is split, interrupted and resumed.
//! - [`progress`], [`streams`], [`signals`]: what a user sees of a command while it runs, and how it is stopped.
//! - [`part`]: what the program may be built without.

pub mod band;
pub mod columns;
pub mod heading;
pub mod long_run;
pub mod output;
pub mod page;
pub mod part;
pub mod plot;
pub mod progress;
pub mod signals;
pub mod streams;
pub mod text_table;
