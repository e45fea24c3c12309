//! Integrators of one smooth step, each with dense output: θ, θ̇ and θ̈ at any time of the step.
//!
//! [`fixed`]: semi-implicit Euler and Runge-Kutta with fixed steps; [`taylor`]: Taylor series of variable order and step; [`closed_form`]:
//! the slender block's hyperbolic motion; [`dense_output`]: what they have in common. The room imports `math`, `equation` and `ground`.

pub mod closed_form;
pub mod dense_output;
pub mod fixed;
pub mod motion_series;
pub mod step_grid;
pub mod taylor;
