//! Blocks with real devices (coasting flywheels, losses, delays, capacity, vertical ground motion), or any device whose force is asked for, side
//! by side.
//!
//! Between events lanes follow the block's mode by its power series, eight at a time (`hybrid/stretch.rs`): under a record from one sample to the
//! next, under any other motion as far as the series reaches. On a step in which something may happen the series goes to the core
//! (`hybrid/located.rs`): its own loop finds the first event in it, answers it, and hands the block back (`hybrid/seat.rs`). So every event is
//! located and answered by the one source there is. Flywheels coast in closed form from one to the next.

pub(crate) mod body;
mod expansion;
pub mod ground;
pub(crate) mod lanes;
mod located;
mod seat;
mod stretch;
mod watch;

use std::f64::consts::FRAC_PI_2;

use sprag_loops::{Method, hybrid};
use sprag_shared::drivetrain::any_transmission::TransmissionKind;
use sprag_shared::equation::any_body::AnyBody;
use sprag_shared::ground::Harmonics;
use sprag_shared::math::sign::Sign;
use sprag_shared::motion::hybrid::mode_output::Shaking;
use sprag_shared::motion::hybrid::{HybridState, HybridSystem};
use sprag_shared::motion::state::{BlockState, Limits, Phase, Stopped};
use sprag_shared::observers::checks::Checks;
use sprag_shared::observers::coil_use::CoilUse;
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::Geometry;

use crate::alone::TIGHT;
use crate::shaken::Shaken;
use expansion::{LEAST_TERMS, RECORD_TERMS, TERMS};
use ground::{Ground, Sampled};
use watch::Watch;

/// Steps and events that the core may take in one interval or segment of the ground, or after a record.
pub const MOST_EVENTS: u32 = 2_000_000;

/// A block with a device on moving ground, at rest at first.
#[derive(Clone, Copy, Debug)]
pub struct HybridBlock<'a> {
    /// Equations, modes and guards.
    pub system: &'a HybridSystem<f64>,
    /// Counts as overturned when |θ| reaches α, even if the ground would bring it back.
    pub overturned_at_slenderness: bool,
    /// How the ground moves.
    pub ground: Ground<'a>,
    /// Who looks at the device's forces; nobody where they are not asked for.
    pub checks: Option<&'a Checks<f64>>,
    /// Who looks at its coils, likewise.
    pub coils: Option<CoilUse>,
}

/// Motion of a block with a device to the end of its ground motion, or until it overturned.
#[derive(Clone, Copy, Debug)]
pub struct HybridMotion {
    /// State of block and device.
    pub state: HybridState<f64>,
    /// Largest values and times, in rad and s from the start of the ground motion.
    pub peaks: Peaks<f64>,
    /// Whoever looked at the forces ([`HybridMotion::support_force_ratio`]).
    checks: Option<Checks<f64>>,
    /// What its coils did; none where nobody looked.
    pub coils: Option<CoilUse>,
    /// Steps that it took.
    pub steps: Steps,
}

/// Numbers of the steps of a block that rocked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Steps {
    /// Without an event, in lanes.
    pub plain: u32,
    /// In lanes, with an event that the core located and answered.
    pub located: u32,
    /// By the core alone.
    pub by_core: u32,
}

impl HybridBlock<'_> {
    /// Whether lanes know the equations of `system`: no guided rack, a support that moves with the ground, open clutches without drag that no
    /// controller commands.
    pub fn knows(system: &HybridSystem<f64>) -> bool {
        let parameters = &system.transmission.parameters;
        parameters.rack_push == 0.0 && !parameters.support_moves() && parameters.drag == 0.0 && !system.actuator.controlled
    }

    /// Whether lanes may take it.
    pub(crate) fn is_plain(&self) -> bool {
        HybridBlock::knows(self.system) && self.ground.is_plain()
    }

    pub(crate) fn kind(&self) -> Kind {
        Kind {
            geometry: self.system.geometry(),
            consistent: matches!(self.system.body, AnyBody::Full(body) if body.consistent),
            vertical: self.ground.is_vertical(),
            curved: matches!(self.ground, Ground::Pieces(_)),
            plates: self.system.transmission.kind == TransmissionKind::Friction,
            forces: self.checks.is_some(),
            flywheels: self.checks.is_some_and(Checks::looks_at_flywheels),
            coils: self.coils.is_some(),
            terms: self.terms(),
        }
    }

    /// Coefficients of θ that reach to the next sample, or far.
    fn terms(&self) -> usize {
        /// The first term left out, over α, by the block's own rate: so far below rounding that it never shows, however strong the ground and
        /// however the motion magnifies it.
        const LEFT_OUT: f64 = 1e-22;
        let Ground::Record(Sampled { samples, .. }) = self.ground else { return TERMS };
        let step = samples.step * self.system.speed / self.system.slenderness;
        let mut term = 1.0;
        for order in 1..RECORD_TERMS {
            term *= step / order as f64;
            if term < LEFT_OUT {
                return order.max(LEAST_TERMS);
            }
        }
        RECORD_TERMS
    }

    /// |θ| (rad) at which an outward motion counts as overturned, while the ground stays within ±`bound` (in g).
    fn overturned(&self, bound: f64) -> f64 {
        match self.system.geometry() {
            _ if self.overturned_at_slenderness => self.system.slenderness,
            // It lies on the ground.
            Geometry::Full => FRAC_PI_2,
            Geometry::Slender => Geometry::Slender
                .point_of_no_return(self.system.slenderness, self.system.push_bound(bound, 0.0, self.ground.lightest())),
        }
    }
}

/// What blocks in the lanes have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Kind {
    /// Slender or full.
    pub(crate) geometry: Geometry,
    /// Consistent kinematics of a full block.
    pub(crate) consistent: bool,
    /// The ground moves vertically too.
    pub(crate) vertical: bool,
    /// The ground moves in pieces of any shape, and steps are as long as their series reach.
    pub(crate) curved: bool,
    /// Clutches with plates.
    pub(crate) plates: bool,
    /// The force on the support is looked at.
    pub(crate) forces: bool,
    /// So are those of the flywheels.
    pub(crate) flywheels: bool,
    /// Coils are looked at.
    pub(crate) coils: bool,
    /// Coefficients of θ.
    pub(crate) terms: usize,
}

impl HybridMotion {
    /// The end of `block`, on ground that has come to rest, `free_time` (s) after its ground motion.
    ///
    /// # Errors
    /// The core's.
    pub fn after(mut self, block: &HybridBlock<'_>, free_time: f64) -> Result<HybridMotion, Stopped> {
        let system = block.system;
        let (state, mut watch) = self.watched(block.ground.duration());
        if state.motion.phase != Phase::Overturned && free_time > 0.0 {
            let limits = Limits { overturned: block.overturned(0.0), events: MOST_EVENTS };
            let quiet = Shaking::level(&Harmonics::QUIET);
            hybrid(Method::Adaptive(TIGHT)).advance(system, state, quiet, free_time, &limits, &mut watch)?;
        }
        system.end(state, free_time, &mut watch);
        Ok(self)
    }

    /// Largest |F₁ + F₂|/(mg) of both flywheels together on their support, of the block with what it carries; none where nobody looked.
    pub fn support_force_ratio(&self) -> Option<f64> {
        self.checks.map(|checks| checks.report.support.map_or(0.0, |largest| largest.value))
    }

    /// Largest |F|/(mg) of one flywheel at the rack, likewise; of checks that [look](Checks::of_flywheels) at it.
    pub fn flywheel_force_ratio(&self) -> Option<f64> {
        self.checks.map(|checks| checks.report.largest_force().map_or(0.0, |largest| largest.value))
    }

    /// Farthest travel of the terminals to one side, m, the fall of a block that overturns included; none where nobody looked.
    pub fn stroke(&self) -> Option<f64> {
        self.checks.map(|checks| checks.travel(Sign::Positive, self.peaks.rotation).abs())
    }

    /// The state, and those who watch it from `origin` (s) on.
    fn watched(&mut self, origin: f64) -> (&mut HybridState<f64>, Watch<'_>) {
        let HybridMotion { state, peaks, checks, coils, .. } = self;
        peaks.origin = origin;
        if let Some(checks) = checks {
            checks.origin = origin;
        }
        (state, Watch { peaks, checks: checks.as_mut(), coils: coils.as_mut(), pressed: true })
    }
}

impl From<HybridMotion> for Shaken {
    /// Without its device.
    fn from(HybridMotion { state, peaks, .. }: HybridMotion) -> Shaken {
        let BlockState { phase, rotation, velocity, impacts, .. } = state.motion;
        Shaken { phase, rotation, velocity, impacts, peaks }
    }
}
