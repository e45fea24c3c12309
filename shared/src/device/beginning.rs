//! With which settings a device begins, and whether it may run by itself with them.

use super::retained::Retained;
use crate::control::controller::Controller;
use crate::control::monitor::fault::Fault;
use crate::settings::{Item, Settings};

/// Resets in a row after which the settings in flash are given up: they may be what resets it.
pub const MOST_STARTS: u8 = 10;

/// Settings, the controller that they describe, and why it may not run without a host.
#[derive(Clone, Debug)]
pub struct Beginning {
    /// Settings in flash, or the defaults.
    pub settings: Settings,
    /// Theirs.
    pub controller: Controller,
    /// [`Fault::NotCommissioned`] or [`Fault::GivenUp`]: by defaults it must not arm, for they are those of another structure.
    pub barred: Option<Fault>,
}

impl Beginning {
    /// With the settings `found` in flash, after the resets that `retained` counts, on a board that ticks at most once in `least_period`, s.
    ///
    /// Settings that the board cannot run count as none. Those that are given up leave their safe state behind. `None` if the defaults are
    /// no controller, which is not so.
    pub fn of(found: Option<&Settings>, retained: Option<&Retained>, least_period: f32) -> Option<Beginning> {
        let able = found.filter(|settings| settings.period() >= least_period);
        let own = able.and_then(|settings| Some((settings, Controller::of(settings).ok()?)));
        let given_up = retained.is_some_and(|retained| retained.restarts >= MOST_STARTS);
        let mut defaults = Settings::default();
        let barred = match own {
            Some((settings, controller)) if !given_up => {
                return Some(Beginning { settings: *settings, controller, barred: None });
            }
            Some((settings, _)) => {
                let safe = Item::SafeState.index();
                let _ = defaults.set(safe, settings.get(safe)?);
                Fault::GivenUp
            }
            None => Fault::NotCommissioned,
        };
        Some(Beginning { settings: defaults, controller: Controller::of(&defaults).ok()?, barred: Some(barred) })
    }
}
