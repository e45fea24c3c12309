//! Simulation on the host: scenes and ground motions in, responses and closed loops through the shared core out. Nothing here starts a
//! thread or reads a clock, so that it also runs where there is neither.
//!
//! - [`scene`], [`record`], [`ground_motion`], [`synthesis`]: what is simulated.
//! - [`simulation`]: one scene, every device; [`batch`]: one dimensionless case; [`map`]: a scene over two of its keys; [`accuracy`]: as
//!   accurate as asked, and how accurate that is.
//! - [`sensor`], [`closed_loop`]: the controller that is flashed, with the sensors and the plant that it has on the host; [`clairvoyant`]: what
//!   no controller can surpass.
//! - [`effect`]: what a scene may ask for, and what follows from it; [`history`]: the response sampled in time; [`digest`]: whether two are
//!   the same to the last bit; [`csv_field`]: a name in a table; [`interrupt`]: a request to stop.

pub mod accuracy;
pub mod batch;
#[cfg(feature = "effects")]
pub mod clairvoyant;
#[cfg(feature = "effects")]
pub mod closed_loop;
pub mod csv_field;
pub mod digest;
pub mod effect;
pub mod ground_motion;
pub mod history;
pub mod interrupt;
pub mod keys;
pub mod map;
pub mod record;
pub mod scene;
pub mod sensor;
pub mod side_by_side;
pub mod simulation;
pub mod synthesis;
