//! Whether accelerometers at rest measure 1 g: an absolute check of their scale, which biases cannot hide.
//!
//! What a good ICM-42688-P measures at rest is within a tenth of g (DS-000347 rev. 1.7, table 2): scale ±0.5 % at 25 °C, ±0.005 %/K over
//! 65 K and ±0.1 % of nonlinearity are 0.93 %; zero ±20 mg on a board and ±0.15 mg/K over 65 K are 30 mg. All of these are typical values,
//! so three times as much is allowed for, 12 %, and a mounting that leans by 0.1 rad out of its plane takes 0.5 %. The ranges of such parts
//! differ by factors of 2. [`TOLERANCE`] lies between the two.
//!
//! A gyroscope at rest measures nothing, so its scale cannot be checked like this.

use crate::control::sensing::sample::{Reading, Sample};

/// Share of g by which the mean length of the specific force at rest may be off.
pub const TOLERANCE: f32 = 0.2;

/// Ticks of which one is looked at, a power of two: rest has many.
const EVERY: u32 = 256;

/// Readings that are averaged, over 8 s at 2 kHz: for so long no earthquake pushes the ground by [`TOLERANCE`] of g to one side.
const AVERAGED: u16 = 64;

/// Sums over a rest; the default is before one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::control) struct Scale {
    /// In the order of [`Place::ALL`](super::fault::Place::ALL).
    forces: [Force; 2],
    /// Found wrong, and reported.
    wrong: [bool; 2],
}

/// Specific force along and up, summed, m/s².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Force {
    sums: [f32; 2],
    count: u16,
}

impl Scale {
    /// Whether this `tick` is one to look at.
    #[inline]
    pub fn is_due(tick: u32) -> bool {
        tick.is_multiple_of(EVERY)
    }

    /// A look at accelerometers that are at rest or not, where `gravity` is this, m/s²: which of them, in the order of
    /// [`Place::ALL`](super::fault::Place::ALL), has just been found to be wrong.
    #[inline(never)]
    pub fn look(&mut self, sample: &Sample, at_rest: bool, gravity: f32) -> [bool; 2] {
        if !at_rest {
            self.forces = [Force::default(); 2];
            return [false; 2];
        }
        let before = self.wrong;
        let readings = [sample.block_accelerometer, sample.ground_accelerometer];
        for ((force, wrong), axes) in self.forces.iter_mut().zip(&mut self.wrong).zip(readings) {
            *wrong = force.add(axes, gravity).unwrap_or(*wrong);
        }
        [self.wrong[0] && !before[0], self.wrong[1] && !before[1]]
    }
}

impl Force {
    /// Adds a reading. Once there are enough of them: whether their mean is too long or too short.
    fn add(&mut self, axes: [Reading; 2], gravity: f32) -> Option<bool> {
        // A number of 0 says that nothing has been read; NaN is another fault.
        if axes.iter().any(|axis| axis.number == 0 || !axis.value.is_finite()) {
            return None;
        }
        for (sum, axis) in self.sums.iter_mut().zip(axes) {
            *sum += axis.value;
        }
        self.count += 1;
        if self.count < AVERAGED {
            return None;
        }
        let Force { sums: [along, up], .. } = core::mem::take(self);
        let whole = f32::from(AVERAGED) * gravity;
        let [along, up] = [along / whole, up / whole];
        let square = along * along + up * up;
        let within = (1.0 - TOLERANCE) * (1.0 - TOLERANCE)..=(1.0 + TOLERANCE) * (1.0 + TOLERANCE);
        Some(!within.contains(&square))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRAVITY: f32 = 9.806_65;

    /// A part on the block that measures `force` (g), and one on the ground that is right, after so many looks.
    fn looks(scale: &mut Scale, force: [f32; 2], count: usize) -> usize {
        let of = |value: f32| Reading { value: GRAVITY * value, number: 1 };
        let sample = Sample { block_accelerometer: force.map(of), ground_accelerometer: [of(0.0), of(1.0)], ..Sample::default() };
        let found = (0..count).map(|_| scale.look(&sample, true, GRAVITY));
        found.inspect(|[_, ground]| assert!(!ground)).filter(|[block, _]| *block).count()
    }

    #[test]
    fn a_range_of_twice_or_half_is_found_whatever_the_tilt_and_reported_once() {
        for factor in [0.25, 0.5, 2.0, 4.0] {
            // Upright, and leaning to either side by a right-angled triangle of 3, 4 and 5.
            for upright in [[0.0, 1.0], [0.6, 0.8], [-0.8, 0.6]] {
                let force = upright.map(|share| factor * share);
                let mut scale = Scale::default();
                assert_eq!(looks(&mut scale, force, 63), 0);
                assert_eq!(looks(&mut scale, force, 1), 1, "{factor} {upright:?}");
                assert_eq!(looks(&mut scale, force, 2048), 0, "reported once");
                // What has been right again is reported anew.
                assert_eq!(looks(&mut scale, [0.0, 1.0], 64), 0);
                assert_eq!(looks(&mut scale, force, 64), 1);
            }
        }
    }

    /// Three times what the data sheet calls typical, over its whole range of temperatures, all of it to one side.
    #[test]
    fn the_worst_good_part_is_within() {
        let scale = 3.0 * (0.005 + 0.00005 * 65.0 + 0.001);
        let zero: f32 = 3.0 * (0.020 + 0.000_15 * 65.0);
        for sign in [1.0, -1.0] {
            let force = [zero, 0.995 * (1.0 + sign * scale) + sign * zero];
            assert!((force[1] - 1.0).abs() < 0.13, "{force:?}");
            assert_eq!(looks(&mut Scale::default(), force, 2000), 0, "{force:?}");
        }
    }

    #[test]
    fn motion_begins_anew_and_what_was_never_read_says_nothing() {
        let mut scale = Scale::default();
        for _ in 0..100 {
            assert_eq!(looks(&mut scale, [0.0, 2.0], 63), 0);
            assert_eq!(scale.look(&Sample::default(), false, GRAVITY), [false; 2]);
        }
        for value in [0.0, f32::NAN] {
            let axes = [Reading { value, number: u32::from(value.is_nan()) }; 2];
            let sample = Sample { block_accelerometer: axes, ground_accelerometer: axes, ..Sample::default() };
            assert!((0..2000).all(|_| scale.look(&sample, true, GRAVITY) == [false; 2]));
        }
    }
}
