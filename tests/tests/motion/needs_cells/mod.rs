//! Comparisons with the reference cells.

mod error_estimates;
mod reference_cells;
