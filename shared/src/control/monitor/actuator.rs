//! Clutches that do not follow their command, as their feedback shows.

use super::fault::{Fault, Wheel};
use crate::control::ticks::Streak;

/// How long feedback may disagree, in ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ActuatorMonitor {
    /// After a change of the command: the clutch moves then, or still moves as an older command asked.
    pub actuator_ticks: u32,
    /// After that: nothing should move any more, but a position switch may bounce.
    pub feedback_ticks: u32,
    /// Whether both may be engaged at once.
    pub both_allowed: bool,
}

/// State of the monitor of the clutches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ActuatorState {
    clutches: [Clutch; 2],
    /// The command that has been sent and followed for so long that nothing changes as long as it is.
    calm: Option<[bool; 2]>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Clutch {
    commanded: bool,
    /// The command has not changed.
    steady: Streak,
    disagrees: Streak,
}

impl Clutch {
    /// Whether `engaged` has disagreed with `command` for too long.
    fn step(&mut self, monitor: &ActuatorMonitor, command: bool, engaged: bool) -> bool {
        if command != self.commanded {
            // A new command gets its whole time, or one that is taken back at the last moment would look like a fault.
            *self = Clutch { commanded: command, ..Clutch::default() };
        }
        self.steady.note(true);
        if command == engaged {
            self.disagrees = Streak::default();
            return false;
        }
        self.disagrees.note(true);
        self.disagrees.lasted(monitor.feedback_ticks) && self.steady.lasted(monitor.actuator_ticks)
    }
}

impl ActuatorState {
    /// A tick with this would change nothing and find nothing.
    #[inline]
    pub fn is_calm(&self, sent: [bool; 2], engaged: [bool; 2]) -> bool {
        engaged == sent && self.calm == Some(sent)
    }
}

impl ActuatorMonitor {
    /// One tick: `engaged` is the feedback, `sent` the command of the last tick, which is the newest that the clutches can know.
    pub fn step(&self, state: &mut ActuatorState, sent: [bool; 2], engaged: [bool; 2]) -> Option<Fault> {
        let [first, second] = &mut state.clutches;
        let late = [first.step(self, sent[0], engaged[0]), second.step(self, sent[1], engaged[1])];
        let calm = engaged == sent && first.steady.lasted(self.actuator_ticks) && second.steady.lasted(self.actuator_ticks);
        state.calm = calm.then_some(sent);
        if late == [false; 2] {
            return None;
        }
        // The worst that it can mean goes first.
        if engaged == [true; 2] && !self.both_allowed {
            return Some(Fault::BothClutches);
        }
        let (wheel, commanded) = if late[0] { (Wheel::First, sent[0]) } else { (Wheel::Second, sent[1]) };
        Some(if commanded { Fault::ClutchRefuses(wheel) } else { Fault::ClutchEngagedUnbidden(wheel) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MONITOR: ActuatorMonitor = ActuatorMonitor { actuator_ticks: 20, feedback_ticks: 4, both_allowed: false };

    /// The tick at which the fault comes while command and feedback stay, and which.
    fn found(state: &mut ActuatorState, monitor: &ActuatorMonitor, sent: [bool; 2], engaged: [bool; 2]) -> Option<(u32, Fault)> {
        (0..100).find_map(|tick| monitor.step(state, sent, engaged).map(|fault| (tick, fault)))
    }

    #[test]
    fn a_clutch_has_its_time_to_follow() {
        for wheel in Wheel::ALL {
            let mut state = ActuatorState::default();
            assert_eq!(found(&mut state, &MONITOR, [false; 2], [false; 2]), None);
            assert_eq!(found(&mut state, &MONITOR, wheel.alone(), [false; 2]), Some((20, Fault::ClutchRefuses(wheel))));
            assert_eq!(found(&mut state, &MONITOR, wheel.alone(), wheel.alone()), None);
            assert_eq!(found(&mut state, &MONITOR, [false; 2], wheel.alone()), Some((20, Fault::ClutchEngagedUnbidden(wheel))));
        }
    }

    #[test]
    fn one_that_moves_by_itself_is_found_sooner() {
        for wheel in Wheel::ALL {
            let mut state = ActuatorState::default();
            assert_eq!(found(&mut state, &MONITOR, [false; 2], [false; 2]), None);
            assert_eq!(found(&mut state, &MONITOR, [false; 2], wheel.alone()), Some((4, Fault::ClutchEngagedUnbidden(wheel))));
            let mut state = ActuatorState::default();
            assert_eq!(found(&mut state, &MONITOR, wheel.alone(), wheel.alone()), None);
            assert_eq!(found(&mut state, &MONITOR, wheel.alone(), [false; 2]), Some((4, Fault::ClutchRefuses(wheel))));
        }
    }

    #[test]
    fn a_switch_may_bounce_and_a_command_may_be_taken_back() {
        let mut state = ActuatorState::default();
        assert_eq!(found(&mut state, &MONITOR, [false; 2], [false; 2]), None);
        for _ in 0..50 {
            for engaged in [true, true, true, true, false] {
                assert_eq!(MONITOR.step(&mut state, [false; 2], [engaged, false]), None);
            }
        }
        for _ in 0..50 {
            for tick in 0..30 {
                // Engaged 18 ticks after the command, which then goes back.
                assert_eq!(MONITOR.step(&mut state, [tick < 15, false], [(18..29).contains(&tick), false]), None, "{tick}");
            }
        }
    }

    /// Any commands and feedback, to one that leaves out calm ticks and one that does not.
    #[test]
    fn a_calm_tick_may_be_left_out() {
        let (mut short, mut long) = (ActuatorState::default(), ActuatorState::default());
        let (mut sent, mut engaged, mut random, mut calm) = ([false; 2], [false; 2], 1_u32, 0);
        for tick in 0..100_000 {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            match random >> 22 {
                wheel @ 0..=1 => sent[wheel as usize] ^= true,
                wheel @ 2..=3 => engaged[wheel as usize - 2] ^= true,
                4..=50 => engaged = sent,
                _ => {}
            }
            let expected = MONITOR.step(&mut long, sent, engaged);
            let is_calm = short.is_calm(sent, engaged);
            calm += u32::from(is_calm);
            assert_eq!(if is_calm { None } else { MONITOR.step(&mut short, sent, engaged) }, expected, "{tick}");
        }
        assert!(calm > 20_000, "{calm}");
    }

    #[test]
    fn both_engaged_only_where_allowed() {
        // A change of hands, during which they overlap.
        let mut state = ActuatorState::default();
        assert_eq!(found(&mut state, &MONITOR, [true, false], [true, false]), None);
        for _ in 0..15 {
            assert_eq!(MONITOR.step(&mut state, [false, true], [true, true]), None);
        }
        assert_eq!(found(&mut state, &MONITOR, [false, true], [false, true]), None);
        assert_eq!(found(&mut state, &MONITOR, [false, true], [true, true]), Some((4, Fault::BothClutches)));
        let both = ActuatorMonitor { both_allowed: true, ..MONITOR };
        let mut state = ActuatorState::default();
        assert_eq!(found(&mut state, &both, [true; 2], [true; 2]), None);
        assert_eq!(found(&mut state, &both, [true; 2], [true, false]), Some((4, Fault::ClutchRefuses(Wheel::Second))));
    }
}
