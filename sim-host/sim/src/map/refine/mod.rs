//! Boundaries between the outcomes of a grid, traced by dividing only the squares that a boundary crosses; knows nothing of scenes.
//!
//! The points of the grid are the corners of squares. A change of outcome on an edge is bisected (`crossing`); a square with crossings
//! is divided into quarters (`square`, `tree`) until the boundary inside is straight to within the tolerance (`chord`) or the square
//! is no larger than that, which is what becomes of squares in which three outcomes meet. Pieces inside squares are joined to polylines
//! (`polyline`). All points lie on a `lattice` of whole numbers, so that none is evaluated twice and neighbouring squares agree about
//! the edge between them.

mod chord;
mod crossing;
mod lattice;
mod polyline;
mod square;
mod strands;
#[cfg(test)]
mod tests;
mod trace;
mod tree;

pub use lattice::{Position, Tolerance};
pub use trace::{Evaluate, Polyline, Traced, Unresolved, trace};
