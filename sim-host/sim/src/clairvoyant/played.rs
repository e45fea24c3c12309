//! A schedule of the clutches in the place of a controller.

use sprag_shared::control::controller::{Circumstances, Decision};
use sprag_shared::control::law::Wish;
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::supervisor::event_log::Entry;
use sprag_shared::motion::state::Phase;

use super::Rocker;
use super::rocker::Engaged;
use super::search::{Found, Grid, search};
use crate::closed_loop::driver::Driver;
use crate::closed_loop::plant::{Extremes, Whereabouts};
use crate::closed_loop::{LoopFailure, LoopTask};

/// Plays a schedule that was found, whatever the sensors say.
pub struct Played<'a> {
    found: &'a Found,
    /// Of a tick, s.
    period: f64,
    /// When the next tick's command has moved the clutches, s from the beginning of the ground motion.
    time: f64,
}

impl<'a> Played<'a> {
    /// With commands `lead` (s) before the clutches shall move, at the ticks of a loop that waits `prelude` (s) for the ground to move.
    pub fn new(found: &'a Found, period: f64, prelude: f64, lead: f64) -> Played<'a> {
        let ticks = (prelude / period).round();
        Played { found, period, time: lead - ticks * period }
    }

    fn command(&self) -> Engaged {
        // A tick that comes a rounding error early belongs to the interval that begins.
        let index = ((self.time / self.found.interval + 1e-6).floor()).max(0.0) as usize;
        self.found.schedule.get(index).copied().unwrap_or_default()
    }
}

impl Driver for Played<'_> {
    fn tick(&mut self, _sample: &Sample, _circumstances: Circumstances) -> Decision {
        let command = self.command();
        self.time += self.period;
        Decision::before(command)
    }

    fn ideal(&mut self, _plant: &Whereabouts, _asked: bool) -> Wish {
        Wish::Release
    }

    fn log(&self) -> Vec<Entry> {
        Vec::new()
    }
}

/// The bound of one loop.
#[derive(Clone, Debug)]
pub struct Bound {
    /// By the search.
    pub found: Found,
    /// Peak |θ|/α of the plant of the loop under the schedule that was found; none if it overturns or there is none.
    pub played: Option<f64>,
}

impl LoopTask<'_> {
    /// What the clutches could do for the block of this loop if the ground motion were known, from rest and under level ground; none for a
    /// device that is neither an ideal clutched pair nor a rigid one. Sensors and delays do not matter.
    pub fn clairvoyant(&self, grid: &Grid) -> Result<Option<Bound>, LoopFailure> {
        let Some(rocker) = Rocker::of(&self.machine()?, self.scene.geometry()) else { return Ok(None) };
        let found = search(&rocker, &self.ground.horizontal, grid);
        if found.peak.is_none() {
            return Ok(Some(Bound { found, played: None }));
        }
        let clock = self.clock();
        let mut driver = Played::new(&found, clock.period, clock.prelude, clock.actuation);
        let mut extremes = Extremes::default();
        let ending = self.run_with(&mut driver, &mut (), &mut extremes, &mut ())?;
        let stands = ending.motion.phase != Phase::Overturned;
        let played = stands.then(|| extremes.peaks.rotation / rocker.slenderness());
        Ok(Some(Bound { found, played }))
    }
}
