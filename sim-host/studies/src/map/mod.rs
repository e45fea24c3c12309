//! Overturning maps and rocking spectra (Figures 8, 11-13) on all cores, and how they are shown.
//!
//! [`study`] runs the cells of a [`sprag_sim::map`], [`tally`] is what is kept of them in memory, [`table`] and [`figures`] show them.
//! [`boundaries`] are where outcomes change; [`boundary_table`] and [`boundary_figure`] show those.

pub mod boundaries;
pub mod boundary_figure;
pub mod boundary_table;
pub mod figures;
mod regions;
pub mod study;
pub mod table;
pub mod tally;
