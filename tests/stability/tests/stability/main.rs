//! Hard cases that must stay numerically stable.

mod accumulating_impacts;
mod coincidences;
mod denormals;
mod large_steps;
mod long_runs;
mod overturning_boundaries;
mod parameter_corners;
mod properties;
mod stiff_clutches;
mod target_cases;
mod unstable_equilibrium;
mod uplift;
