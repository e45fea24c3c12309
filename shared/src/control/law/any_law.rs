//! A clutch law chosen at run time.

use super::costate::Costate;
use super::look_ahead::LookAhead;
use super::{AlwaysEngaged, GatedTable, Law, Passive, Resisting, SignTable, Situation, Wish};

/// The laws that a scene can choose from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClutchLaw {
    /// [`Passive`].
    Passive,
    /// [`AlwaysEngaged`].
    AlwaysEngaged,
    /// [`Resisting`] (Eq. 10) on the motion as it is now.
    Resisting,
    /// [`Resisting`] (Eq. 10) on the motion as it will be when the clutch moves.
    ResistingPredicted,
    /// [`SignTable`].
    SignTable(SignTable),
    /// [`GatedTable`].
    GatedTable(GatedTable),
    /// [`LookAhead`].
    LookAhead(LookAhead),
    /// [`Costate`].
    Costate(Costate),
}

impl Law for ClutchLaw {
    // Into the tick: what is asked need not go through memory then.
    #[inline(always)]
    fn wish(&self, at: &Situation<'_>) -> Wish {
        match self {
            ClutchLaw::Passive => Passive.wish(at),
            ClutchLaw::AlwaysEngaged => AlwaysEngaged.wish(at),
            ClutchLaw::Resisting | ClutchLaw::ResistingPredicted => Resisting.wish(at),
            ClutchLaw::SignTable(table) => table.wish(at),
            ClutchLaw::GatedTable(table) => table.wish(at),
            ClutchLaw::LookAhead(law) => law.wish(at),
            ClutchLaw::Costate(law) => law.wish(at),
        }
    }

    fn predicts(&self) -> bool {
        match self {
            ClutchLaw::Passive | ClutchLaw::AlwaysEngaged | ClutchLaw::Resisting => false,
            ClutchLaw::ResistingPredicted
            | ClutchLaw::SignTable(_)
            | ClutchLaw::GatedTable(_)
            | ClutchLaw::LookAhead(_)
            | ClutchLaw::Costate(_) => true,
        }
    }
}
