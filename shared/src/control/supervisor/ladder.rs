//! What to do without a sensor or a clutch, from the top: another sensor stands in for the one that is lost, and the law continues; else one
//! clutch engaged, which needs no sensor; both open only where an engaged clutch is what is wrong.
//!
//! `docs/robustness.md` says why: one flywheel engaged for good costs a few percent of the peak, both open a half of it.

use super::{Phase, Supervisor, SupervisorState, enter};
use crate::control::monitor::fault::{Fault, Wheel};
use crate::control::sensing::sensor::Sensor;
use crate::control::supervisor::SupervisorInput;
use crate::control::ticks::Streak;

/// Which sensors others stand in for, and which clutches are not to be relied upon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ladder {
    /// In the order of [`Sensor::ALL`].
    trusted: [bool; 4],
    /// The fault of the one that is not.
    pub lost: Option<Fault>,
    /// An engaged clutch has been found to be wrong since the fault began.
    release: bool,
    /// Each clutch has been found not to engage since the fault began.
    missing: [bool; 2],
    /// All sensors have been good.
    good: Streak,
}

impl Default for Ladder {
    fn default() -> Ladder {
        Ladder { trusted: [true; 4], lost: None, release: false, missing: [false; 2], good: Streak::default() }
    }
}

impl Ladder {
    /// Notes a fault of a clutch, for as long as the fault lasts.
    pub fn note_clutch(&mut self, fault: Fault) {
        self.release |= fault.is_of_an_engaged_clutch();
        if let Some(wheel) = fault.missing_clutch() {
            let [first, second] = self.missing;
            self.missing = [first || wheel == Wheel::First, second || wheel == Wheel::Second];
        }
    }

    /// Trusts every sensor; what is known of the clutches stays.
    fn trust_all(&mut self) {
        *self = Ladder { release: self.release, missing: self.missing, ..Ladder::default() };
    }
}

impl SupervisorState {
    /// Sensors that the estimator may take, in the order of [`Sensor::ALL`].
    pub fn trusted(&self) -> [bool; 4] {
        self.ladder.trusted
    }
}

impl Supervisor {
    /// First rung. A sensor that fails while the law decides, and the others are good, is not taken any more until it has been good for
    /// the recovery time, an encoder until a calibration begins.
    #[inline]
    pub(super) fn stand_in(&self, state: &mut SupervisorState) {
        if state.findings().nothing() && state.ladder.lost.is_none() {
            return;
        }
        self.choose_stand_in(state);
    }

    #[inline(never)]
    fn choose_stand_in(&self, state: &mut SupervisorState) {
        let deciding = matches!(state.phase, Phase::Armed | Phase::Rocking);
        if !(self.required.has_substitutes() && deciding && state.calibrated) {
            state.ladder.trust_all();
            return;
        }
        let (good, faults) = (state.findings().good(), state.findings().faults());
        let ladder = &mut state.ladder;
        // Of two that contradict each other nobody knows which to take.
        let plain = |fault: &Fault| !matches!(fault, Fault::Contradiction(Sensor::Gyroscope | Sensor::Encoder));
        let required = self.required.flags();
        ladder.good.note(required.into_iter().zip(good).all(|(required, good)| good || !required));
        if ladder.lost.is_some() && ladder.good.lasted(self.recovery) && ladder.trusted[3] {
            (ladder.trusted, ladder.lost) = ([true; 4], None);
        }
        let faults = faults.iter().zip(required).zip(&mut ladder.trusted);
        for ((fault, _), trusted) in faults.filter(|((_, required), _)| *required) {
            if let Some(fault) = fault.filter(plain) {
                *trusted = false;
                ladder.lost = ladder.lost.or(Some(fault));
            }
        }
        let lost = ladder.trusted.iter().filter(|trusted| !**trusted).count();
        // Without the ground's accelerometer it takes the block's.
        if lost > 1 || (!ladder.trusted[2] && !good[1]) {
            ladder.trust_all();
        }
    }

    /// Another sensor stands in for the one of this fault, or for the one that it disagrees with.
    pub(super) fn is_spared(state: &SupervisorState, fault: Fault) -> bool {
        let [gyroscope, block, ground, encoder] = state.ladder.trusted;
        !match fault {
            Fault::Contradiction(Sensor::Gyroscope | Sensor::Encoder) => gyroscope && encoder,
            _ => match fault.sensor() {
                Some(Sensor::Gyroscope) => gyroscope,
                Some(Sensor::BlockAccelerometer) => block,
                Some(Sensor::GroundAccelerometer) => ground,
                Some(Sensor::Encoder) => encoder,
                None => true,
            },
        }
    }

    /// At rest, with all sensors good again: the calibration that all of them need. Whether it has begun.
    pub(super) fn calibrate_again(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) -> bool {
        let again = state.ladder.lost.is_some() && state.ladder.good.lasted(self.recovery);
        if again {
            state.ladder = Ladder::default();
            enter(state, input, Phase::Calibrate);
        }
        again
    }

    /// The lower rungs: [`Supervisor::safe`], but for what a fault of the clutches that lasts forbids.
    pub fn safe_now(&self, state: &SupervisorState) -> [bool; 2] {
        if state.ladder.release {
            return [false; 2];
        }
        match (self.safe, state.ladder.missing) {
            ([true, false], [true, _]) => [false, true],
            ([false, true], [_, true]) => [true, false],
            _ => self.safe,
        }
    }
}
