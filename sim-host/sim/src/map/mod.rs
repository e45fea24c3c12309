//! Overturning maps and rocking spectra (Figures 8, 11-13): a scene's devices over two of its keys.
//!
//! [`grid`] turns a cell into a dimensionless block under a pulse where the scene is one; [`cell`] follows those side by side in the lanes of
//! [`sprag_ensemble`], and any other cell as the scene that it is. [`boundaries`] are where outcomes change, found by [`refine`].

pub mod boundaries;
pub mod cell;
pub mod grid;
mod pulse;
pub mod refine;
