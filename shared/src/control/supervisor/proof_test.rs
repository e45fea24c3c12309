//! The clutches tried while the controller is armed and nothing moves, one at a time, again and again over the years: a clutch or a coil that
//! has failed shows nothing until it is used.

use super::event_log::Kind;
use super::{Supervisor, SupervisorInput, SupervisorState, log};
use crate::control::monitor::coil::CoilReport;
use crate::control::monitor::fault::{Fault, Wheel};

/// Part of the interval after which a test that has been ended is tried again.
const AGAIN: u32 = 100;

/// Where the proof tests stand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ProofTest {
    /// Averages of an armed controller at rest since the last one, up to the interval.
    pub waited: u32,
    /// 0 while none runs; then each clutch opens and engages, one after the other, while the other one is as the law wishes.
    step: u8,
}

impl ProofTest {
    /// After the steps of [`ProofTest::command`].
    const PASSED: u8 = 5;

    pub fn goes_on(self) -> bool {
        self.step > 0
    }

    /// What is to be sent in the place of what the law wishes.
    pub fn command(self, wish: [bool; 2]) -> [bool; 2] {
        let [first, second] = wish;
        match self.step {
            1 => [false, second],
            2 => [true, second],
            3 => [first, false],
            4 => [first, true],
            _ => wish,
        }
    }
}

/// Ends the test that runs, which counts as none, and tries it again later.
#[inline(never)]
pub(super) fn put_off(state: &mut SupervisorState, input: &SupervisorInput<'_>) {
    let ProofTest { waited, .. } = state.proof;
    state.proof = ProofTest { waited: waited.saturating_sub((waited / AGAIN).max(1)), step: 0 };
    log(state, input, Kind::Warning(Fault::SelfTestAbandoned.code()));
}

impl Supervisor {
    /// An average of an armed controller at rest has passed.
    pub(super) fn wait_for_proof(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) {
        state.proof.waited = state.proof.waited.saturating_add(1).min(self.proof_interval);
        if self.self_test && state.proof.waited >= self.proof_interval && input.standing && state.motion.still(self.quiet) {
            state.proof.step = 1;
        }
    }

    /// One tick of a test that runs. The first reading that moves ends it; a clutch that does not follow is a fault as in operation.
    #[inline(never)]
    pub(super) fn prove(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) {
        if !(input.standing && state.motion.still(1)) {
            put_off(state, input);
            return;
        }
        let followed = state.sent == state.proof.command(input.wish)
            && input.sample.engaged == state.sent
            && input.coils == [CoilReport::Well; Wheel::ALL.len()];
        if followed {
            state.proof.step += 1;
            if state.proof.step == ProofTest::PASSED {
                state.proof = ProofTest::default();
                log(state, input, Kind::Tested);
            }
        }
    }
}
