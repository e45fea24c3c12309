//! Why a device started.

use serde::{Deserialize, Serialize};

/// Cause of a reset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Cause {
    /// The supply came.
    #[default]
    PowerOn,
    /// The supply sagged below what the chip needs.
    BrownOut,
    /// The reset pin.
    Pin,
    /// The control task missed its deadline for too long.
    Watchdog,
    /// The program asked for it.
    Software,
    /// The program panicked.
    Panic,
    /// The processor met something that it cannot carry out.
    HardFault,
    /// The processor's clock stopped.
    ClockFailure,
}

impl Cause {
    /// Each, in the order of their numbers on the link.
    pub const ALL: [Cause; 8] = [
        Cause::PowerOn,
        Cause::BrownOut,
        Cause::Pin,
        Cause::Watchdog,
        Cause::Software,
        Cause::Panic,
        Cause::HardFault,
        Cause::ClockFailure,
    ];

    /// Whether the memory still holds what it held before: a controller may resume where it was.
    pub fn keeps_memory(self) -> bool {
        !matches!(self, Cause::PowerOn | Cause::BrownOut)
    }
}
