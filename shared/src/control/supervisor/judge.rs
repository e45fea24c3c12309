//! Which faults there are at a tick, which of them are news, and which must be acted upon.

use core::cmp::Ordering;

use super::event_log::Kind;
use super::{Phase, Supervisor, SupervisorInput, SupervisorState, log};
use crate::control::monitor::coil::{CoilReport, trouble};
use crate::control::monitor::fault::{Fault, Recovery};

/// Sources of faults: four sensors, clutches and their coils, timing, estimate, the law.
pub(super) const SOURCES: usize = 8;

impl Supervisor {
    /// Asks every source, logs what is new, and returns the first fault that must be acted upon, and whether any of them takes a request.
    #[inline]
    pub(super) fn judge(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) -> (Option<Fault>, bool) {
        let deciding = matches!(state.phase, Phase::Armed | Phase::Rocking);
        let calm = input.coils == [CoilReport::Well; 2] && state.actuator.is_calm(state.sent, input.sample.engaged);
        let clutch = if calm { None } else { self.of_clutches(state, input) };
        // NaN is late, by any measure.
        let later_than = |time: f32| !matches!(input.lateness.partial_cmp(&time), Some(Ordering::Less | Ordering::Equal));
        let late = later_than(0.0);
        state.late.note(late);
        let overrun = late && (later_than(self.overrun_limit) || state.late.length() >= self.overrun_ticks);
        let (rotation, velocity) = input.estimate;
        let sick = || state.findings().faults().into_iter().flatten().any(|fault| self.acted_upon(state, fault));
        // An estimate from a bad sensor is that sensor's fault. What an estimator has bounded does not add up to infinity.
        let lost = deciding && !(rotation.abs() + velocity.abs()).is_finite() && !sick();
        let both = deciding && self.too_many(input);
        if state.findings().nothing() && clutch.is_none() && !overrun && !lost && !both && !state.any_active {
            return (None, false);
        }
        let [gyroscope, block, ground, encoder] = state.findings().faults();
        self.weigh(
            state,
            input,
            [
                gyroscope,
                block,
                ground,
                encoder,
                clutch,
                overrun.then_some(Fault::Overrun),
                lost.then_some(Fault::EstimateNotFinite),
                both.then_some(Fault::BothClutches),
            ],
        )
    }

    /// The fault of the clutches or their coils.
    #[inline(never)]
    fn of_clutches(&self, state: &mut SupervisorState, input: &SupervisorInput<'_>) -> Option<Fault> {
        // The feedback of a coil whose switches are being tried says nothing of its clutch.
        let [first, second] = input.coils.map(|report| report == CoilReport::Testing);
        let engaged = input.sample.engaged;
        let engaged = [if first { state.sent[0] } else { engaged[0] }, if second { state.sent[1] } else { engaged[1] }];
        let moved = self.actuator.step(&mut state.actuator, state.sent, engaged);
        let clutch = moved.map(|fault| match fault {
            Fault::ClutchRefuses(wheel) | Fault::ClutchEngagedUnbidden(wheel) if state.phase == Phase::SelfTest => {
                Fault::SelfTestFailed(wheel)
            }
            other => other,
        });
        let coil = trouble(&input.coils);
        for fault in [moved, coil].into_iter().flatten() {
            state.ladder.note_clutch(fault);
        }
        coil.or(clutch)
    }

    /// What the sources say now, beside what they said before.
    #[inline(never)]
    fn weigh(
        &self,
        state: &mut SupervisorState,
        input: &SupervisorInput<'_>,
        now: [Option<Fault>; SOURCES],
    ) -> (Option<Fault>, bool) {
        let before = state.active;
        state.active = now;
        state.any_active = now != [None; SOURCES];
        let (mut first, mut latches) = (None, false);
        for (source, (before, now)) in before.into_iter().zip(now).enumerate() {
            // The law's wish is the last one: it is not followed, so it does no harm.
            let acted_upon = now.filter(|fault| source + 1 < SOURCES && self.acted_upon(state, *fault));
            if let Some(fault) = now.filter(|_| before != now) {
                let code = fault.code();
                log(state, input, if acted_upon.is_some() { Kind::Fault(code) } else { Kind::Warning(code) });
            }
            first = first.or(acted_upon);
            latches |= acted_upon.is_some_and(|fault| fault.recovery() == Recovery::OnRequest);
        }
        (first, latches)
    }

    /// A fault of a sensor that is not required, or that another stands in for, is only a warning.
    pub(super) fn acted_upon(&self, state: &SupervisorState, fault: Fault) -> bool {
        fault.sensor().is_none_or(|sensor| self.required.contains(sensor) && !Supervisor::is_spared(state, fault))
    }
}
