//! The unmodified image of the board between models of the board's parts.
//!
//! Needs the image that `SPRAG_BOARD_ELF` names; `cargo xtask test` builds it. `-- --nocapture` shows the numbers.

mod coils;
mod commissioning;
mod conditional;
mod conditions;
mod faults;
mod integrity;
mod link;
mod parts;
mod proof_test;
mod recorder;
mod registers;
mod resets;
mod sensors;
mod start;
mod storage;
mod supply;
