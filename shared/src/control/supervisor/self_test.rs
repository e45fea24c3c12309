//! One pulse to each clutch, to see that its feedback follows. Whether it follows in time is the actuator monitor's business; a board that
//! measures currents takes each pulse as the occasion to try the coil's switches one by one ([`crate::device::coil_test`]).

use crate::control::monitor::coil::{CoilReport, CoilReports};

/// Where the test stands: each step is a command whose feedback is awaited.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SelfTest {
    step: u8,
}

impl SelfTest {
    /// After the steps of [`SelfTest::command`].
    const PASSED: u8 = 5;

    /// Open, first, open, second, open.
    pub fn command(&self) -> [bool; 2] {
        [self.step == 1, self.step == 3]
    }

    /// One tick: `sent` is the command of the last one, `engaged` the feedback. From the beginning again where `still` is not given.
    /// Whether it has been passed.
    pub fn step(&mut self, sent: [bool; 2], engaged: [bool; 2], coils: CoilReports, still: bool) -> bool {
        if !still {
            self.step = 0;
        } else if self.step < Self::PASSED && sent == self.command() && engaged == sent && coils == [CoilReport::Well; 2] {
            self.step += 1;
        }
        self.step == Self::PASSED
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WELL: CoilReports = [CoilReport::Well; 2];

    #[test]
    fn both_clutches_move_one_after_the_other() {
        let (mut test, mut sent, mut engaged) = (SelfTest::default(), [true, false], [true, false]);
        let mut seen = [false; 2];
        for tick in 0..60 {
            let passed = test.step(sent, engaged, WELL, true);
            sent = test.command();
            // A clutch that takes a few ticks.
            if tick % 4 == 3 {
                engaged = sent;
            }
            assert!(engaged != [true; 2]);
            seen = [seen[0] || engaged[0], seen[1] || engaged[1]];
            if passed {
                assert_eq!((seen, engaged, sent), ([true; 2], [false; 2], [false; 2]));
                return;
            }
        }
        panic!("never passed");
    }

    #[test]
    fn it_waits_for_a_clutch_for_its_coil_and_for_stillness() {
        let mut test = SelfTest::default();
        for _ in 0..100 {
            assert!(!test.step(test.command(), [false; 2], WELL, true));
        }
        assert_eq!(test.command(), [true, false]);
        for _ in 0..100 {
            assert!(!test.step([true, false], [true, false], [CoilReport::Testing, CoilReport::Well], true));
        }
        assert_eq!(test.command(), [true, false]);
        assert!(!test.step([true, false], [true, false], WELL, true));
        assert_eq!(test.command(), [false; 2]);
        assert!(!test.step([false; 2], [false; 2], WELL, true));
        assert!(!test.step([false, true], [false, true], WELL, false));
        assert_eq!(test.command(), [false; 2]);
    }
}
