//! The host side of Sprag.
pub mod batch;
pub mod history;
pub mod outcome;
pub mod plot;
pub mod record;
pub mod summary_table;
