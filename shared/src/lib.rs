//! The core of Sprag, shared by the simulator and the firmware: the dynamics of a rocking block with inerters, its event-driven integration,
//! and the controller of its clutches. No `std`, no allocation, no `unsafe`.
//!
//! Two wings stand on one foundation and never import each other. A room imports only rooms below it; `tests/rooms.rs` checks both.
//!
//! ```text
//!        motion wing                              controller wing
//!   case                                     device
//!   observers                                settings      link
//!   motion (ideal, hybrid, rest)             control (sensing, estimation, law, monitor, supervisor)
//!   method
//!   ground     drivetrain
//!   ---------------------------- structure ----------------------------
//!   ---------------------------- equation  ----------------------------
//!   ---------------------------- math      ----------------------------
//! ```
//!
//! Foundation:
//! - [`math`]: scalars, SIMD lanes, transcendental functions, power series, polynomials and their zeros;
//! - [`equation`]: the equations of motion, written once over any of these;
//! - [`structure`]: the parameters of block, device and drivetrain.
//!
//! Motion wing:
//! - [`ground`]: ground acceleration in smooth pieces; [`drivetrain`]: transmissions from the rack to a flywheel;
//! - [`method`]: integrators with dense output over one step;
//! - [`motion`]: event-driven integration, of ideal devices and of devices with a memory;
//! - [`observers`]: peaks, energy ledger, checks of forces, digests;
//! - [`case`]: a scene in words, which a board and its host run to the same bits.
//!
//! Controller wing:
//! - [`control`]: from sensor readings to clutch commands;
//! - [`settings`]: its parameters in words, which a board keeps in flash; [`link`]: the serial link;
//! - [`device`]: the device around the controller.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

// Modules that tests share with other crates name this one as those do.
#[cfg(test)]
extern crate self as sprag_shared;

pub mod case;
pub mod control;
pub mod device;
pub mod drivetrain;
pub mod equation;
pub mod ground;
pub mod link;
pub mod math;
pub mod method;
pub mod motion;
pub mod observers;
pub mod settings;
pub mod structure;
