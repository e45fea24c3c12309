//! The core of Sprag, shared by the simulator and the firmware: the dynamics of a rocking block with inerters, its event-driven integration,
//! and the controller of its clutches. No `std`, no allocation, no `unsafe`.
//!
//! Two wings stand on one foundation and never import each other. A room imports only rooms below it; `xtask/src/rooms.rs` checks both.
//!
//! ```text
//!        motion wing                              controller wing
//!                                            device
//!   observers                                settings      link
//!   motion (ideal, hybrid, sliding,          control (sensing, estimation, law, monitor, supervisor)
//!           compliant, rest)
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
//! - [`ground`]: ground acceleration in smooth segments; [`drivetrain`]: transmissions from the rack to a flywheel;
//! - [`method`]: integrators with dense output over one step;
//! - [`motion`]: event-driven integration, of ideal devices, of devices with a memory, of a block that slides, and of one on a compliant base;
//! - [`observers`]: peaks, energy ledger, checks of forces, digests;
//!
//! Controller wing:
//! - [`control`]: from sensor readings to clutch commands;
//! - [`settings`]: its parameters in words, which a board keeps in flash; [`link`]: the serial link;
//! - [`device`]: the device around the controller.
//!
//! Where a new integrator, clutch, wavelet, law or observer goes: [docs/architecture.md](../../docs/architecture.md#where-a-new-one-goes).
//!
//! # Glossary
//!
//! | symbol | in the code | term |
//! | --- | --- | --- |
//! | θ, θ̇, θ̈ | `rotation`, `velocity`, `acceleration` ([`equation::motion::Motion`]) | rotation, angular velocity, angular acceleration |
//! | s = sgn θ | `side` ([`motion::state::BlockState`]) | toe about which the block turns |
//! | α | [`structure::block::Block::slenderness`] | slenderness |
//! | δ = αs − θ | [`equation::body::Body::Configuration`] | angle from the vertical to the line toe–centre of mass |
//! | R | [`structure::block::Block::size`] | toe to centre of mass (half diagonal) |
//! | λ | [`structure::block::Block::inertia_ratio`] | inertia ratio I_O/(mR²) |
//! | p, p² | [`structure::block::Block::frequency_parameter`], `frequency_squared` | frequency parameter, p² = g/(λR) |
//! | m_r | [`structure::inertance::inertance_of_train`] | inertance (apparent mass), Eq. 8-9 |
//! | σ | [`structure::device::Device::mass_ratio`] | mass ratio m_r/m |
//! | κ k, k = σ/λ | `coupling` ([`equation::FullInerter`]) | inertial coupling; κ = 1 while engaged, 0 while released |
//! | ℓ, ℓ' | [`equation::lever::Lever::arm`], `arm_rate` | lever of the inerter's terminals, per R, and dℓ/dθ |
//! | η | `restitution` ([`structure::Structure`], [`motion::ideal::IdealSystem`]) | restitution θ̇⁺/θ̇⁻ of an impact |
//! | ü_g/g, v̈_g/g | `horizontal`, `vertical` ([`motion::hybrid::mode_output::Shaking`]) | ground acceleration in g |
//! | tan α | [`structure::block::Geometry::uplift_threshold`] | uplift threshold in g, Eq. 1; α for the slender block |
//! | p²(1 − cos α) | [`observers::ledger::Ledger::barrier`] | energy barrier to overturning over λmR² |
//! | w | `spin` ([`drivetrain::clutch_state::FlywheelState`]) | flywheel's speed at the rack, over R |
//! | z | `twist` ([`drivetrain::clutch_state::FlywheelState`]) | twist of an elastic clutch as travel of the rack, over R |
//! | K, C, F_c | `stiffness`, `damping`, `capacity` ([`drivetrain::scaled_parameters::ScaledParameters`]) | stiffness, damping and capacity of a clutch: K/(λm), C/(λm), F_c/(λmR) |
//! | Eq. 10 | [`equation::clutch_rule::ClutchRule::Resisting`] | clutch rule: engaged while acceleration and velocity have one sign |
//! | Eq. 11 | `consistent` ([`equation::body::FullBody`]) | kinematics of the terminals, without or with ℓ'θ̇² |
//! | - | [`ground::GroundSegment`] | ground segment: smooth ground motion between two kinks |
//! | - | [`method::dense_output::DenseOutput`] | dense output: θ, θ̇, θ̈ at any time of a step |
//! | - | [`motion::hybrid::mode_output::ModeOutput`] | mode output: dense output with a device's unknowns and guards |
//! | - | [`drivetrain::clutch_state::Guard`] | guard: a function whose zero ends a mode |
//! | - | [`motion::observer::MonotoneInterval`] | monotone interval: θ and θ̇ are monotone over it |
//! | - | [`motion::rest::impact_accumulation`], [`motion::rest::free_decay`] | impact accumulation (Zeno), free decay |
//! | - | [`motion::step_end`] | time stepping: events are noticed at the ends of steps, not located |
//! | - | `dwell` ([`structure::drivetrain::Actuation`]) | dwell: least time between two moves of a clutch |
//! | - | [`device::retained::Retained`] | retained state: what a board keeps through a reset |
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

// Modules that tests share with other crates name this one as those do.
#[cfg(test)]
extern crate self as sprag_shared;

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
