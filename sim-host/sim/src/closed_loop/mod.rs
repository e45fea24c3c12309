//! The closed loop: a plant with any effects, sensors as they are, and the controller that is flashed.

pub mod answered;
pub mod assemble;
mod bounds;
pub mod decisions;
mod design;
pub mod disturbance;
pub mod driver;
pub mod failing;
pub mod feedback;
mod gains;
pub mod loop_scene;
mod measured;
mod path;
pub mod plant;
pub mod report;
pub mod run;
mod supervision;
#[cfg(test)]
mod tests;
mod truth;

pub use assemble::{LoopFailure, LoopTask};
pub use loop_scene::LoopScene;
