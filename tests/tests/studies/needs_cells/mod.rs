//! Comparisons with the reference cells.

mod maps;
