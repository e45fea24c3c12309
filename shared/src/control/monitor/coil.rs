//! What the current through a clutch's coil says of the coil and its two switches.

use super::fault::{Fault, Wheel};

/// What a board says of a coil at a tick; one that does not measure its current says nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CoilReport {
    /// Nothing is wrong, as far as is known.
    #[default]
    Well,
    /// Its switches are being tried one by one: what its feedback says must wait.
    Testing,
    /// Something is wrong.
    Trouble(CoilTrouble),
}

/// What can be wrong with a coil.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoilTrouble {
    /// More than a whole coil takes.
    OverCurrent,
    /// A current though the high-side switch is off.
    HighSideClosed,
    /// A current though the low-side switch is off, or the full one where it shall hold.
    LowSideClosed,
    /// Full or holding current off by more than [`CURRENT_TOLERANCE`].
    WrongCurrent,
}

/// By which share of what it shall be a coil's current may be off in a test: supply ±10 %, copper from −20 °C to 70 °C, shunt, diodes.
pub const CURRENT_TOLERANCE: f32 = 0.3;

/// What a board reads of a coil at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CoilReading {
    /// Its clutch is engaged, as far as the current shows.
    pub engaged: bool,
    /// What else the current shows.
    pub report: CoilReport,
    /// The clutch has just been found to have closed so many ticks after the beginning of its pulse.
    pub closed: Option<u32>,
}

/// What two coils report.
pub type CoilReports = [CoilReport; 2];

/// The first trouble of two coils, as a fault.
pub fn trouble(reports: &CoilReports) -> Option<Fault> {
    Wheel::ALL.into_iter().zip(reports).find_map(|(wheel, report)| match report {
        CoilReport::Well | CoilReport::Testing => None,
        CoilReport::Trouble(trouble) => Some(match trouble {
            CoilTrouble::OverCurrent => Fault::OverCurrent(wheel),
            CoilTrouble::HighSideClosed => Fault::HighSideClosed(wheel),
            CoilTrouble::LowSideClosed => Fault::LowSideClosed(wheel),
            CoilTrouble::WrongCurrent => Fault::WrongCurrent(wheel),
        }),
    })
}
