//! The host side of Sprag: scenes and records in, simulations through the shared core, tables and pictures out.
//!
//! - [`scene`], [`record`], [`ground_motion`], [`synthesis`]: what is simulated.
//! - [`simulation`]: one scene, every device; [`batch`]: many dimensionless cases; [`accuracy`]: as accurate as asked, and how accurate that is.
//! - [`cloud`], [`statistics`]: demands and fragilities over many records; [`optimise`]: the device that overturns least;
//!   [`sensitivity`]: what each effect changes.
//! - [`history`], [`outcome`], [`plot`], [`summary_table`], [`columns`], [`output`]: what comes out.
//! - [`part`]: what the program may be built without.
//! - [`long_run`]: work that is split, interrupted and resumed.
//! - [`progress`], [`interrupt`], [`streams`]: what a user sees of a command while it runs.
//! - [`closed_loop`], [`device`]: the controller on the host, and the firmware in its place.
//! - [`effect`]: what a scene may ask for, and what follows from it; [`command`]: the subcommands of `sprag`.

pub mod accuracy;
#[cfg(feature = "effects")]
pub mod accuracy_study;
pub mod batch;
#[cfg(feature = "effects")]
pub mod closed_loop;
pub mod cloud;
pub mod columns;
pub mod command;
#[cfg(feature = "effects")]
pub mod device;
pub mod effect;
pub mod ground_motion;
pub mod heading;
pub mod history;
pub mod interrupt;
pub mod long_run;
#[cfg(feature = "effects")]
pub mod loop_study;
pub mod map;
pub mod optimise;
pub mod output;
pub mod part;
pub mod plot;
pub mod progress;
pub mod record;
pub mod scene;
pub mod sensitivity;
pub mod sensor;
pub mod similarity;
pub mod simulation;
pub mod statistics;
pub mod streams;
pub mod summary_table;
pub mod synthesis;

pub use sprag_ensemble as ensemble;
pub use sprag_shared::observers::outcome;
