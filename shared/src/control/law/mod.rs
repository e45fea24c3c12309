//! Clutch laws: when a flywheel shall resist.
//!
//! All fit one signature, [`Law`], so that a law of one's own can be put in the place of these: it sees a [`Situation`] and says what it
//! wants. Which of the two flywheels that is, and when a clutch may move, is decided after it ([`turn_taking`], [`minimum_dwell`]).
//!
//! [`look_ahead`]: a law that runs the equation of motion ahead; [`costate`]: a linear costate of optimal control; [`any_law`]: a law
//! chosen at run time; [`signs`]: hysteresis.
//!
//! A new law goes into a file of its own here and into [`any_law`]; to be chosen by settings, into `settings::{table, parts}`; by
//! a scene, into the `LawName` of the host.
//!
//! The room imports `math`, `equation`, `control::model` and `control::estimation`.

pub mod any_law;
pub mod costate;
pub mod look_ahead;
pub mod minimum_dwell;
pub mod signs;
pub mod turn_taking;

use crate::control::estimation::estimate::Estimate;
use crate::control::model::Model;
use serde::{Deserialize, Serialize};
use signs::Signs;

/// Inputs of a law.
#[derive(Clone, Copy, Debug)]
pub struct Situation<'a> {
    /// The structure as the controller believes it to be.
    pub model: &'a Model,
    /// The motion at the instant at which a command given now takes effect (or now, for a law that does not predict).
    pub estimate: Estimate,
    /// Signs of the motion, with hysteresis.
    pub signs: Signs,
    /// Which clutches are engaged.
    pub engaged: [bool; 2],
    /// Speeds of the flywheels over R as a rack that moved with them, 1/s.
    pub spins: [f32; 2],
    /// Velocity that the ground has lately gained, g/p: the integral of its acceleration, fading within 3/p ([`DRIFT_TIME`]).
    pub ground_drift: f32,
}

/// Fading time of [`Situation::ground_drift`], 1/p.
pub const DRIFT_TIME: f32 = 3.0;

/// Request of a law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Wish {
    /// Both clutches open.
    #[default]
    Release,
    /// The flywheel whose turn it is resists.
    Resist,
    /// The first flywheel stays on the rack, whatever it does there.
    Hold,
}

/// A rule for the clutches.
pub trait Law {
    /// Request of the law in a situation.
    fn wish(&self, at: &Situation<'_>) -> Wish;

    /// It is to be asked about the instant at which its answer takes effect, and not about now.
    fn predicts(&self) -> bool {
        true
    }
}

/// No flywheel ever.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passive;

/// One flywheel always: the plain inerter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AlwaysEngaged;

/// Eq. 10: engaged while acceleration and velocity of the terminals have one sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resisting;

/// Any rule over the signs of θ·v, a·v and ü_g·v: bit 4 [θ·v > 0] + 2 [a·v > 0] + [ü_g·v > 0] of `table` says whether to engage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SignTable(pub u8);

impl SignTable {
    /// Engaged when exactly one of a·v > 0 and ü_g·v > 0.
    pub const EITHER: SignTable = SignTable(0b0110_0110);
    /// Eq. 10 as a table.
    pub const RESISTING: SignTable = SignTable(0b1100_1100);
}

/// A table of signs, one row of which counts only while the ground has gained velocity: the row of a block that is braked on its way out
/// while the ground moves against it. Under a pulse, engaging there saves blocks; under the many reversals of a record it costs them, and what
/// distinguishes the two is how long the ground has gone one way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GatedTable {
    /// Rows, as in [`SignTable`].
    pub table: u8,
    /// The row that is gated.
    pub row: u8,
    /// |ground drift| over the uplift threshold beyond which it counts.
    pub threshold: f32,
}

impl GatedTable {
    /// Rows 1, 2, 3 and 6, and row 5 beyond 0.8.
    pub const DEFAULT: GatedTable = GatedTable { table: 0b0100_1110, row: 5, threshold: 0.8 };

    /// Whether a row engages.
    #[inline]
    pub fn engages(&self, row: u8, drift: f32, uplift: f32) -> bool {
        self.table >> row & 1 == 1 || (row == self.row && drift.abs() > self.threshold * uplift)
    }
}

/// Row of a table: 4 [θ·v > 0] + 2 [a·v > 0] + [ü_g·v > 0].
#[inline]
pub fn sign_row(signs: &Signs) -> u8 {
    let Signs { rotation, velocity, push, ground, quiet } = *signs;
    4 * u8::from(rotation == velocity) + 2 * u8::from(push == velocity) + u8::from(ground == velocity && !quiet)
}

impl Law for Passive {
    #[inline]
    fn wish(&self, _at: &Situation<'_>) -> Wish {
        Wish::Release
    }
}

impl Law for AlwaysEngaged {
    #[inline]
    fn wish(&self, _at: &Situation<'_>) -> Wish {
        Wish::Hold
    }
}

impl Law for Resisting {
    #[inline]
    fn wish(&self, at: &Situation<'_>) -> Wish {
        if at.signs.push == at.signs.velocity { Wish::Resist } else { Wish::Release }
    }
}

impl Law for SignTable {
    #[inline]
    fn wish(&self, at: &Situation<'_>) -> Wish {
        if self.0 >> sign_row(&at.signs) & 1 == 1 { Wish::Resist } else { Wish::Release }
    }
}

impl Law for GatedTable {
    #[inline]
    fn wish(&self, at: &Situation<'_>) -> Wish {
        if self.engages(sign_row(&at.signs), at.ground_drift, at.model.parameters.uplift) { Wish::Resist } else { Wish::Release }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::tests::{example_model, situation};

    /// Every law over all 16 combinations of signs.
    #[test]
    fn laws_of_signs_are_mirror_symmetric_and_tables_read_their_bits() {
        let model = example_model();
        for bits in 0..16_u8 {
            let at = situation(&model, bits);
            let mirrored = situation(&model, !bits & 15);
            for table in [SignTable(0), SignTable(255), SignTable::EITHER, SignTable::RESISTING, SignTable(0b1000_0001)] {
                assert_eq!(table.wish(&at), table.wish(&mirrored), "{bits:04b}");
            }
            assert_eq!(SignTable::RESISTING.wish(&at), Resisting.wish(&at));
            let Signs { velocity, push, ground, .. } = at.signs;
            let either = (push == velocity) != (ground == velocity);
            assert_eq!(SignTable::EITHER.wish(&at) == Wish::Resist, either);
        }
        for row in 0..8_u8 {
            assert!(GatedTable::DEFAULT.engages(row, 0.0, 0.2) == [1, 2, 3, 6].contains(&row));
            assert!(GatedTable::DEFAULT.engages(row, -0.17, 0.2) == [1, 2, 3, 5, 6].contains(&row));
        }
        assert_eq!(Passive.wish(&situation(&model, 0)), Wish::Release);
        assert_eq!(AlwaysEngaged.wish(&situation(&model, 5)), Wish::Hold);
    }
}
