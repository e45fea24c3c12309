//! Transmissions from the rack to a flywheel: ideal, rigid, overrunning, friction, elastic and viscous clutches, and friction that grows with load.
//!
//! [`transmission::Transmission`] is what each of them is to the integration; [`scaled_parameters`]: its parameters in the units of the
//! equations; [`clutch_state`]: what a device remembers. Parameters in SI units are in [`crate::structure::drivetrain`]. The room imports
//! `math`, `equation` and `structure`.

pub mod any_transmission;
pub mod clutch_state;
pub mod dashpot;
pub mod elastic;
pub mod friction;
pub mod ideal;
pub mod load_friction;
pub mod on_support;
pub mod overrunning;
pub mod rigid;
pub mod rise;
pub mod scaled_parameters;
pub mod transmission;
pub mod under_way;
pub mod viscous;
