//! Overturning maps and rocking spectra (Figures 8, 11-13): every device of a scene over a grid of two of its keys.
//!
//! [`grid`] turns a cell into a dimensionless block under a pulse where the scene is one, and those go through the lanes of
//! [`sprag_ensemble`]; any other scene is simulated cell by cell. [`study`] runs them, [`tally`] is what is kept of them in memory, [`table`] and
//! [`figures`] show them. [`boundaries`] are where outcomes change, found by [`refine`]; [`boundary_table`] and [`boundary_figure`] show those.

pub mod boundaries;
pub mod boundary_figure;
pub mod boundary_table;
pub mod figures;
pub mod grid;
pub mod refine;
mod regions;
pub mod study;
pub mod table;
pub mod tally;
