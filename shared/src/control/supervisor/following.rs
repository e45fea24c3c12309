//! Biases that drift while the controller is armed: they are followed as slowly as temperature moves them.

use super::event_log::Kind;
use super::{Supervisor, SupervisorInput, SupervisorState, log};
use crate::control::sensing::calibration::Averaging;

/// Time in which a calibration follows a drift, s: a sensor warms up in minutes, a block moves within seconds.
pub(super) const FOLLOWING_TIME: f32 = 120.0;

/// Ticks of which one is averaged: rest has many.
pub(super) const EVERY: u32 = 8;

/// How far the biases have been followed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Following {
    /// Part of a count by which the encoder's zero is ahead of the whole number in the calibration.
    pub part: f32,
    /// Counts may have been lost, or nothing been measured at all: the first rest counts in full.
    pub unsure: bool,
    /// Ticks since one was averaged. Counted here, and not by the number of the tick, which shows how long ago the device was started.
    waited: u32,
}

impl Supervisor {
    /// One tick of an armed controller while nothing moves. The first sign of motion leaves this phase, and with it what has been averaged
    /// since the last step. Whether the calibration has changed.
    pub(super) fn follow(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) -> bool {
        state.following.waited += 1;
        if state.following.waited < EVERY {
            return false;
        }
        state.following.waited = 0;
        self.follow_on(state, input)
    }

    #[inline(never)]
    fn follow_on(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) -> bool {
        state.averaging.add(input.sample, state.monitor.findings().good());
        if state.averaging.ticks() < self.averaged {
            return false;
        }
        let (found, _) = state.averaging.finish(&state.calibration, &self.plausible, self.motion.gravity);
        state.averaging = Averaging::default();
        self.wait_for_proof(state, input);
        if state.following.unsure {
            state.following = Following::default();
            (state.calibration, state.calibrated) = (found, true);
            state.monitor.recalibrated();
            log(state, input, Kind::Calibrated);
        } else {
            state.calibration.follow(&found, self.followed, &mut state.following.part);
        }
        true
    }
}
