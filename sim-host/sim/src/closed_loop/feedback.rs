//! What shows the controller which clutches are engaged: a switch at the armature, or the current, which goes before it.

/// How clutches report where they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feedback {
    /// By switches at the armatures.
    Position,
    /// By the currents: so many ticks after a command to engage, and after one to release.
    Current {
        /// At least 1.
        engaging: u32,
        /// At least 1.
        releasing: u32,
    },
}

impl Feedback {
    /// By currents of clutches that take `delays` (engaging, releasing; from the command, s), of which the last `lags` come after the current.
    pub fn by_current(delays: [f64; 2], lags: [f64; 2], period: f64) -> Feedback {
        let ticks = |delay: f64, lag: f64| ((delay - lag) / period - 1e-6).ceil().max(1.0) as u32;
        Feedback::Current { engaging: ticks(delays[0], lags[0]), releasing: ticks(delays[1], lags[1]) }
    }
}

/// Two currents.
#[derive(Clone, Copy, Debug)]
pub struct Currents {
    /// Which are enough to engage.
    pub engaged: [bool; 2],
    commanded: [bool; 2],
    /// Ticks of the present command.
    held: [u32; 2],
}

impl Currents {
    /// With a command that has been in force for long.
    pub fn settled(command: [bool; 2]) -> Currents {
        Currents { engaged: command, commanded: command, held: [u32::MAX; 2] }
    }

    /// A tick with a command.
    pub fn step(&mut self, feedback: Feedback, command: [bool; 2]) {
        let Feedback::Current { engaging, releasing } = feedback else { return };
        let wheels = self.engaged.iter_mut().zip(&mut self.commanded).zip(&mut self.held).zip(command);
        for (((engaged, commanded), held), command) in wheels {
            *held = if command == *commanded { held.saturating_add(1) } else { 1 };
            *commanded = command;
            if *held >= if command { engaging } else { releasing } {
                *engaged = command;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_current_goes_before_the_clutch() {
        // 21 and 6 ms with the latency, of which the armature takes 15 and 3.
        let feedback = Feedback::by_current([0.021, 0.006], [0.015, 0.003], 0.0005);
        assert_eq!(feedback, Feedback::Current { engaging: 12, releasing: 6 });
        let mut currents = Currents::settled([false; 2]);
        let after = |currents: &mut Currents, command: bool| {
            (1..100).find(|_| {
                currents.step(feedback, [command, false]);
                currents.engaged[0] == command
            })
        };
        assert_eq!((after(&mut currents, true), after(&mut currents, false)), (Some(12), Some(6)));
    }
}
