//! Minimum dwell: a clutch that has just been commanded is left alone for a while.

/// The least time between two commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gate {
    /// Ticks for which a command stands.
    pub dwell: u16,
}

/// What the gate remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GateState {
    /// The command that stands.
    pub command: [bool; 2],
    left: u16,
}

impl Gate {
    /// The command of this tick, given the one that is wanted. Both engaged are left alone only while the block is `standing`.
    #[inline]
    pub fn step(&self, state: &mut GateState, wanted: [bool; 2], standing: bool) -> [bool; 2] {
        state.left = state.left.saturating_sub(1);
        if (state.left == 0 || (!standing && state.command == [true; 2])) && wanted != state.command {
            state.command = wanted;
            state.left = self.dwell;
        }
        state.command
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_change_at_most_once_a_dwell() {
        let gate = Gate { dwell: 5 };
        let mut state = GateState::default();
        let mut last = [false; 2];
        let mut changed = -10;
        for tick in 0..200 {
            // Wants something else every tick.
            let command = gate.step(&mut state, [tick % 2 == 0, false], false);
            if command != last {
                assert!(tick - changed >= 5, "{tick} after {changed}");
                (last, changed) = (command, tick);
            }
        }
        assert!(changed > 190);
    }

    #[test]
    fn both_dwell_only_at_rest() {
        let gate = Gate { dwell: 5 };
        let mut state = GateState::default();
        assert_eq!(gate.step(&mut state, [true; 2], true), [true; 2]);
        assert_eq!(gate.step(&mut state, [true, false], true), [true; 2]);
        assert_eq!(gate.step(&mut state, [true, false], false), [true, false]);
        // The one that is left has its time again.
        let changed = (1..100).find(|_| gate.step(&mut state, [false; 2], false) == [false; 2]);
        assert_eq!(changed, Some(5));
    }

    #[test]
    fn without_a_dwell_a_command_is_what_is_wanted() {
        let (gate, mut state) = (Gate::default(), GateState::default());
        for wanted in [[true, false], [false, true], [false, false]] {
            assert_eq!(gate.step(&mut state, wanted, false), wanted);
        }
    }
}
