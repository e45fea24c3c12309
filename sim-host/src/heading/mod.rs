//! What pictures say of a scene: names of its keys on axes, and below the title what holds in all of the picture.

mod conditions;
mod quantity;

pub use conditions::{of_scene, of_scenes};
pub use quantity::axis_title;
