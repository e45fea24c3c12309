//! The fall of a block that overturns: it begins where the block passes |θ| = α without coming back.

use crate::math::root::illinois;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::device_snapshot::DeviceOutput;
use crate::motion::observer::{Event, MonotoneInterval};
use crate::motion::state::as_good_as;

/// What an observer had found where |θ| last passed α, in case the block never comes back.
#[derive(Clone, Copy, Debug)]
pub struct Fall<S, T> {
    slenderness: S,
    /// None below α.
    found: Option<T>,
    overturned: bool,
}

/// When |θ| passes `slenderness` (rad) along `interval`, s after the start of its step.
#[inline(never)]
fn passing<S: Real>(output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>, slenderness: S) -> S {
    let beyond = |t: S| interval.side.times(output.motion().at(t).rotation) - slenderness;
    illinois(interval.from, interval.to, Sign::Negative, beyond)
}

impl<S: Real, T: Copy> Fall<S, T> {
    /// Of a block of α = `slenderness` (rad), where clutches switch and a free block's θ̈ is 0.
    pub fn beyond(slenderness: S) -> Fall<S, T> {
        Fall { slenderness: as_good_as(slenderness), found: None, overturned: false }
    }

    /// What was found before the fall of a block that has overturned; none of any other.
    pub fn before(&self) -> Option<T> {
        self.found.filter(|_| self.overturned)
    }

    /// What to keep at the end of `interval`: of one along which |θ| passes α, what is `found` at the end of its part up to there; before one
    /// that begins beyond α there is no such part.
    pub fn passed(
        &self,
        output: &dyn DeviceOutput<S>,
        interval: &MonotoneInterval<S>,
        found: impl FnOnce(Option<&MonotoneInterval<S>>) -> T,
    ) -> Option<T> {
        let beyond = |rotation: S| interval.side.times(rotation) - self.slenderness;
        if beyond(interval.last.rotation) <= S::ZERO {
            return None;
        }
        if beyond(interval.first.rotation) >= S::ZERO {
            return self.found.or_else(|| Some(found(None)));
        }
        let passes = passing(output, interval, self.slenderness);
        Some(found(Some(&MonotoneInterval { to: passes, last: output.motion().at(passes), ..*interval })))
    }

    /// Keeps what there was where it [`Fall::passed`].
    pub fn keep(&mut self, found: Option<T>) {
        // Below α, where there is nothing to keep, without a copy.
        match found {
            None => self.found = None,
            found => self.found = found,
        }
    }

    /// Looks whether the block overturns.
    pub fn event(&mut self, event: Event) {
        self.overturned |= event == Event::Overturned;
    }
}
