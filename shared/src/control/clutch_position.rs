//! Where the clutches are, by the currents through their coils.
//!
//! A board without limit switches reports that the current has passed a threshold. The armature has closed some time after that, and opens some
//! time after the current has died; with a limit switch both lags are 0. The time from the beginning of a pulse to the dip that a closing
//! armature makes in its current grows with wear, cold and a low supply: it is averaged, and what it differs from the expected one by is added
//! to the horizon over which the motion is predicted.

use crate::control::monitor::fault::Wheel;

/// Share of a newly measured time in the average.
const SHARE: f32 = 0.25;

/// Share of the expected time by which the average may have moved.
const MOST_MOVED: f32 = 0.3;

/// How a board's feedback goes before the clutches, and how long these take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClutchLag {
    /// Ticks after the feedback says engaged until the clutch is.
    pub closing: u16,
    /// Ticks after it says released.
    pub opening: u16,
    /// From the beginning of a pulse to a closed clutch, s; 0 where it is not followed.
    pub closing_time: f32,
}

/// State of the clutches' positions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClutchPositions {
    engaged: [bool; 2],
    /// Ticks for which the feedback has said otherwise.
    otherwise: [u16; 2],
    /// Average closing time over the expected one, less 1.
    moved: [f32; 2],
}

impl ClutchPositions {
    /// Of clutches that are where the feedback says.
    pub fn met(engaged: [bool; 2]) -> ClutchPositions {
        ClutchPositions { engaged, ..ClutchPositions::default() }
    }

    /// Clutches that are engaged.
    pub fn engaged(&self) -> [bool; 2] {
        self.engaged
    }

    /// s, by which the slower clutch closes later than expected; negative where both are faster.
    pub fn late(&self, lag: &ClutchLag) -> f32 {
        let [first, second] = self.moved;
        lag.closing_time * if first > second { first } else { second }
    }
}

impl ClutchLag {
    /// One tick of `feedback`.
    #[inline]
    pub fn step(&self, state: &mut ClutchPositions, feedback: [bool; 2]) {
        let ClutchPositions { engaged, otherwise, moved: _ } = state;
        if *engaged == feedback {
            *otherwise = [0; 2];
            return;
        }
        for ((engaged, otherwise), feedback) in engaged.iter_mut().zip(otherwise).zip(feedback) {
            let lag = if feedback { self.closing } else { self.opening };
            if *engaged == feedback {
                *otherwise = 0;
            } else if *otherwise >= lag {
                (*engaged, *otherwise) = (feedback, 0);
            } else {
                *otherwise += 1;
            }
        }
    }

    /// Takes the times, s, that clutches have just been seen to take to close. The first whose average has now moved too far.
    #[inline(never)]
    pub fn follow(&self, state: &mut ClutchPositions, closed: [Option<f32>; 2]) -> Option<Wheel> {
        let mut news = None;
        for ((wheel, moved), closed) in Wheel::ALL.into_iter().zip(&mut state.moved).zip(closed) {
            let Some(time) = closed.filter(|_| self.closing_time > 0.0) else { continue };
            let before = moved.abs() > MOST_MOVED;
            let off = (time / self.closing_time - 1.0).clamp(-1.0, 1.0);
            *moved += SHARE * (off - *moved);
            if moved.abs() > MOST_MOVED && !before {
                news = news.or(Some(wheel));
            }
        }
        news
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clutch_follows_its_current_by_the_lags() {
        let lag = ClutchLag { closing: 8, opening: 3, closing_time: 0.0 };
        let mut state = ClutchPositions::default();
        let mut after = |feedback: bool| {
            let before = state.engaged()[1];
            (0..100).find(|_| {
                lag.step(&mut state, [false, feedback]);
                state.engaged()[1] != before
            })
        };
        assert_eq!((after(true), after(true), after(false), after(false)), (Some(8), None, Some(3), None));
        // One that is taken back is none.
        for tick in 0..100 {
            lag.step(&mut state, [tick % 8 < 7, false]);
            assert_eq!(state.engaged(), [false; 2]);
        }
        ClutchLag::default().step(&mut state, [true, false]);
        assert_eq!(state.engaged(), [true, false]);
    }

    #[test]
    fn a_closing_time_that_has_moved_is_reported_once_and_added() {
        let lag = ClutchLag { closing: 0, opening: 0, closing_time: 0.02 };
        let mut state = ClutchPositions::default();
        assert_eq!(lag.follow(&mut state, [Some(0.02), None]), None);
        assert_eq!(state.late(&lag), 0.0);
        // A single one says little.
        assert_eq!(lag.follow(&mut state, [None, Some(0.03)]), None);
        assert!((state.late(&lag) - 0.0025).abs() < 1e-6);
        let reported: std::vec::Vec<_> = (0..20).filter_map(|_| lag.follow(&mut state, [None, Some(0.03)])).collect();
        assert_eq!(reported, [Wheel::Second]);
        assert!((state.late(&lag) - 0.01).abs() < 1e-4);
        let mut unknown = ClutchPositions::default();
        assert_eq!(ClutchLag::default().follow(&mut unknown, [Some(1.0); 2]), None);
        assert_eq!(unknown.late(&ClutchLag::default()), 0.0);
    }
}
