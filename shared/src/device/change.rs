//! Other settings, in three steps: what is asked for, what it comes to, and its taking effect.
//!
//! Checks, checksums and flash take milliseconds, so the second step is done while the control task runs; the other two copy words.

use super::answers::refusal;
use super::{Answer, Device};
use crate::control::controller::Controller;
use crate::control::monitor::fault::{Fault, Recovery};
use crate::link::{Done, Refusal, Reply};
use crate::settings::Settings;
use crate::settings::store::StoreError;
use crate::settings::wiring::Wiring;

/// Which settings are to be in force, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// The draft.
    Draft {
        /// What the sender believes its checksum to be.
        check: u32,
        /// Also into flash.
        store: bool,
    },
    /// Those in flash: the host that brought others is gone.
    Detach,
}

/// Settings that have been checked, and stored where they were to be.
#[derive(Clone, Debug)]
pub struct Prepared {
    settings: Settings,
    check: u32,
    controller: Controller,
}

impl Change {
    /// Checks `settings` for a board that ticks at most once in `least_period`, s, and has them put into flash by `store` if that was asked
    /// for.
    ///
    /// # Errors
    /// [`Refusal`] for settings that are not those that were sent, contradict each other, are too fast for the board, or that the flash does
    /// not take.
    pub fn prepare(
        self,
        settings: &Settings,
        least_period: f32,
        store: impl FnOnce(&Settings) -> Result<(), StoreError>,
    ) -> Result<Prepared, Refusal> {
        let own = settings.check();
        if let Change::Draft { check, .. } = self
            && check != own
        {
            return Err(Refusal::Check(own));
        }
        Wiring::check(settings).map_err(refusal)?;
        let controller = Controller::of(settings).map_err(refusal)?;
        let period = settings.period();
        if period < least_period {
            return Err(Refusal::TooFast { period, least: least_period });
        }
        if let Change::Draft { store: true, .. } = self {
            store(settings).map_err(|error| match error {
                StoreError::Full => Refusal::FlashFull,
                StoreError::Flash => Refusal::FlashFailed,
            })?;
        }
        Ok(Prepared { settings: *settings, check: own, controller })
    }
}

impl Device {
    /// The settings that a change is about.
    pub fn wanted(&self, change: Change) -> &Settings {
        match change {
            Change::Draft { .. } => &self.draft,
            Change::Detach => &self.kept,
        }
    }

    /// Continues after [`Answer::Change`].
    pub fn install(&mut self, change: Change, prepared: &Result<Prepared, Refusal>) -> Answer {
        let prepared = match prepared {
            Ok(prepared) => prepared,
            Err(refusal) => {
                if *refusal == Refusal::FlashFailed {
                    (self.lasting, self.doubtful) = (false, true);
                }
                return Answer::Reply(Reply::Refused(*refusal));
            }
        };
        match change {
            Change::Draft { store, .. } => self.install_draft(prepared, store),
            Change::Detach => {
                self.hear(None);
                self.resuming = None;
                self.adopt(prepared);
                (self.draft, self.lasting) = (self.settings, !self.doubtful);
                Answer::Restarted(Reply::Done(Done::AsAsked))
            }
        }
    }

    fn install_draft(&mut self, prepared: &Prepared, stored: bool) -> Answer {
        let differs = self.settings != prepared.settings;
        let mut barred = None;
        if stored {
            (self.kept, self.doubtful, self.lasting) = (prepared.settings, false, !differs);
            barred = self.barred.take_if(|barred| barred.recovery() == Recovery::ByStoring);
            if barred == Some(Fault::GivenUp) {
                self.restarts = 0;
            }
        }
        if differs && let Some(busy) = self.busy() {
            // It began to rock meanwhile: the next start will find what has been stored.
            return Answer::Reply(busy);
        }
        let done = Reply::Done(if stored { Done::Stored } else { Done::AsAsked });
        if differs {
            self.lasting = stored;
            self.adopt(prepared);
        } else if barred.is_some() && self.attached.is_none() {
            self.restart();
        } else {
            // Asked twice, or nothing new: the controller continues.
            return Answer::Reply(done);
        }
        Answer::Restarted(done)
    }

    /// From the beginning with other settings.
    fn adopt(&mut self, prepared: &Prepared) {
        (self.settings, self.check, self.controller) = (prepared.settings, prepared.check, prepared.controller);
        self.restart();
    }
}
