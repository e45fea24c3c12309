//! Self-similarity (Figures 6 and 7): blocks of equal dimensionless groups, their responses over p t laid over one another.
//!
//! By Eq. 20-23 the rotation θ/α of a slender block with an inerter is a function of p t, ω_g/p, a_g/(gα), η and σ alone; of a full block
//! with a single inerter nearly so, with a clutched pair less. [`groups`] has the groups of a scene, [`compare`] the departures.

pub mod compare;
pub mod groups;
mod keys;
