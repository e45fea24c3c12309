//! Comparisons with the reference cells.

mod batches;
mod error_estimates;
mod reference_cells;
