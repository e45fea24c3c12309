//! What pictures say of a scene: names of its keys on axes, and below the title what holds in all of the picture.

mod conditions;
mod quantity;

pub use conditions::{of_blocks, of_scene, of_scenes};
pub use quantity::axis_title;

use crate::plot::FigureTitle;
use sprag_sim::scene::Scene;

/// The title of a picture of `scene` as it is, and below it what holds in it.
pub fn title(scene: &Scene) -> FigureTitle {
    FigureTitle { text: scene.file.title.clone(), conditions: of_scene(scene) }
}
