//! Extremes found by the checks.

use crate::math::scalar::Real;

/// A largest or smallest value and its time from the origin, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme<S> {
    /// The value.
    pub value: S,
    /// s.
    pub time: S,
}

impl<S: Real> Extreme<S> {
    /// Puts `value` in the place of a smaller one; the first of equals stays.
    pub(super) fn raise(extreme: &mut Option<Extreme<S>>, value: S, time: S) {
        if extreme.is_none_or(|known| value > known.value) {
            *extreme = Some(Extreme { value, time });
        }
    }

    /// The larger of two; the first of equals.
    fn largest(extremes: [Option<Extreme<S>>; 2]) -> Option<Extreme<S>> {
        extremes.into_iter().flatten().reduce(|a, b| if b.value > a.value { b } else { a })
    }
}

/// Extremes over the time in which the block rocks; none where it never did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report<S> {
    /// Largest |H|/V while V > 0: the friction without which the toe would slide. At uplift it is tan α (slender: α) or
    /// more; before a loss of contact it grows without bound.
    pub friction: Option<Extreme<S>>,
    /// Smallest V/(mg). Negative where the ground would have to pull.
    pub vertical: Option<Extreme<S>>,
    /// When V first falls to 0, s: from there on the block would fly, and the motion is not one that it can have.
    pub contact_lost: Option<S>,
    /// Largest ratio of the impulses along and normal to the ground at an impact: the friction without which the toe would slide there.
    pub impact_friction: Option<Extreme<S>>,
    /// The same of jolts that press the toe down.
    pub jolt_friction: Option<Extreme<S>>,
    /// Largest impulse by which the ground would have to pull the toe down at a jolt, over the block's mass, m/s. None where no jolt
    /// would lift it.
    pub jolt_pull: Option<Extreme<S>>,
    /// Largest |F|/(mg) of each flywheel at the rack.
    pub force: [Option<Extreme<S>>; 2],
    /// Largest |F₁ + F₂|/(mg): what both together press on their support.
    pub support: Option<Extreme<S>>,
    /// Largest speed of a flywheel as that of a rack that turns it, m/s; looked for behind elastic clutches, where it is not the rack's own.
    pub flywheel_speed: Option<Extreme<S>>,
    /// Farthest travel of the terminals in the positive and in the negative direction, both positive, m.
    pub travel: [Option<Extreme<S>>; 2],
}

impl<S: Real> Report<S> {
    /// Farthest travel of the terminals, m: half the length that a rack needs between its stops.
    pub fn stroke(&self) -> Option<Extreme<S>> {
        Extreme::largest(self.travel)
    }

    /// Largest |F|/(mg) of one flywheel at the rack, where its teeth mesh with the drive.
    pub fn largest_force(&self) -> Option<Extreme<S>> {
        Extreme::largest(self.force)
    }

    /// The record of a quantity in the order of the readings: friction, −V, the forces of the flywheels, that on the support.
    pub(super) fn record(&self, quantity: usize) -> Option<S> {
        match quantity {
            0 => self.friction.map(|extreme| extreme.value),
            1 => self.vertical.map(|extreme| -extreme.value),
            2 | 3 => self.force[quantity & 1].map(|extreme| extreme.value),
            _ => self.support.map(|extreme| extreme.value),
        }
    }

    /// Raises such a record.
    pub(super) fn raise(&mut self, quantity: usize, value: S, time: S) {
        match quantity {
            0 => Extreme::raise(&mut self.friction, value, time),
            1 => {
                if self.vertical.is_none_or(|known| -value < known.value) {
                    self.vertical = Some(Extreme { value: -value, time });
                }
            }
            2 | 3 => Extreme::raise(&mut self.force[quantity & 1], value, time),
            _ => Extreme::raise(&mut self.support, value, time),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_equal_extremes_stays() {
        let mut extreme = None;
        for (value, time) in [(1.0, 0.5), (2.0, 1.0), (2.0, 1.5), (1.9, 2.0)] {
            Extreme::raise(&mut extreme, value, time);
        }
        assert_eq!(extreme, Some(Extreme { value: 2.0, time: 1.0 }));
        let both = |positive: f64, negative: f64| {
            let travel = [Some(Extreme { value: positive, time: 1.0 }), Some(Extreme { value: negative, time: 2.0 })];
            Report { travel, ..Report::default() }.stroke().map(|extreme| extreme.time)
        };
        assert_eq!((both(3.0, 2.0), both(2.0, 3.0), both(2.0, 2.0)), (Some(1.0), Some(2.0), Some(1.0)));
    }
}
