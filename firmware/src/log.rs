//! Logs by defmt where the feature `log` is on, and nothing at all where it is not.

#[cfg(feature = "log")]
use sprag_shared::control::controller::Decision;

#[cfg(feature = "log")]
pub use defmt::{debug, info, trace, warn};

#[cfg(all(feature = "log", feature = "board-f405"))]
use defmt_rtt as _;

/// Nothing.
#[cfg(not(feature = "log"))]
macro_rules! nothing {
    ($($anything:tt)*) => {{}};
}
#[cfg(not(feature = "log"))]
pub(crate) use {nothing as info, nothing as warn};

/// A tick at the level `trace`, a change of its commands at `debug`, of its phase at `info`, and a fault at `warn`.
#[cfg(feature = "log")]
pub fn decision(before: &Decision, now: &Decision) {
    let Decision { command, estimate, wish, phase, fault } = now;
    trace!("{}: {} for {}, rotation {}, velocity {}", phase, command, wish, estimate.rotation, estimate.velocity);
    if *command != before.command {
        debug!("clutches {} at rotation {}, velocity {}", command, estimate.rotation, estimate.velocity);
    }
    if *phase != before.phase {
        info!("{}", phase);
    }
    if let Some(fault) = fault.filter(|_| *fault != before.fault) {
        warn!("fault {}: {}", fault.code(), fault);
    }
}
