//! Impulses at the toe: impacts, and jolts of a rigid clutch that closes at speed.

use super::Extreme;
use super::report::Report;
use super::toe::Toe;
use crate::math::scalar::Real;
use crate::motion::observer::Event;
use crate::motion::state::{BlockState, Phase};

/// Impulse across the base over that along it below which it is rounding.
const OVER_TOE: f64 = 1e-9;

/// State of the block just before an event.
#[derive(Clone, Copy, Debug)]
pub(super) struct Impulses<S> {
    /// θ̇, rad/s; none before the first interval.
    pub velocity: Option<S>,
    /// Flywheels that are engaged.
    pub engaged: u32,
    /// A change of θ̇ (rad/s) that matters. Smaller ones are rounding, and the ratio of their impulses is that of large ones.
    matters: S,
}

impl<S: Real> Impulses<S> {
    /// Of a motion in which changes of θ̇ by `matters` (rad/s) or more count.
    pub fn new(matters: S) -> Impulses<S> {
        Impulses { velocity: None, engaged: 0, matters }
    }

    /// Raises what `report` has of impulses by those of an event at `time` (s from the origin) that leaves `state`.
    pub fn event(&mut self, toe: &Toe<S>, report: &mut Report<S>, event: Event, time: S, state: &BlockState<S>) {
        let Some(before) = self.velocity.replace(state.velocity) else { return };
        match event {
            Event::Impact => {
                let [along, normal] = toe.impact(before.abs(), state.velocity.abs(), self.engaged);
                if normal > S::ZERO {
                    Extreme::raise(&mut report.impact_friction, along.abs() / normal, time);
                }
            }
            Event::Switch | Event::Coupling if state.phase == Phase::Rocking => {
                let jump = state.velocity - before;
                if jump.abs() < self.matters {
                    return;
                }
                let [along, normal] = toe.jolt(state.side, state.rotation, jump);
                // A block that stands over its toe is pushed along the base alone, and only rounding says whether it is pressed on it.
                if normal.abs() <= along.abs() * S::of(OVER_TOE) {
                } else if normal > S::ZERO {
                    Extreme::raise(&mut report.jolt_friction, along.abs() / normal, time);
                } else {
                    Extreme::raise(&mut report.jolt_pull, -normal * toe.size, time);
                }
            }
            _ => {}
        }
    }
}
