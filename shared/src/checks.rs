//! Checks of the assumptions behind a motion, and of what it asks of its parts: an effect that only watches.
//!
//! The toe must bear what block and device press on it. With the centre of mass at (−R sin δ, R cos δ) from the toe, x to
//! the right and positive rotation clockwise about the right-hand toe, Newton's second law gives per weight mg
//!
//! H = ü_g/g + (R/g)(cos δ θ̈ + sin δ θ̇²) + n F,  V = 1 + v̈_g/g + (R/g)(sin δ θ̈ − cos δ θ̇²)
//!
//! with a horizontal device, where F/(mg) is the force at the rack and n the pulley's ratio; a vertical device pulls the
//! raised corner down by n F, which adds s n F to V instead. Slender: sin δ → δ, cos δ → 1. The model does not slide while
//! |H|/V stays below the friction that there is, and keeps its toe on the ground while V > 0.
//!
//! The fall of a block that overturns begins where it passes |θ| = α without coming back. What it asks for from there on says nothing of
//! how it rocks, and grows without bound: [`Checks::before_fall`] leaves it out.

mod report;

pub use report::{Extreme, Report};

use crate::block::{Block, Geometry};
use crate::error::ParameterError;
use crate::ledger::{Account, Clutching};
use crate::lever::{LeverConstants, Mount};
use crate::locate::locate_by_value;
use crate::math;
use crate::observer::{Event, Stretch};
use crate::rocking::State;
use crate::scalar::{Real, Sign};
use crate::snapshot::{DeviceArc, DeviceObserver, Snapshot};

/// Instants at which a stretch is looked at, with its ends; a maximum between two of them is then sought out.
const LOOKS: usize = 10;

/// Steps of the search for a maximum, which shorten its bracket by 0.618 each.
const SEARCH_STEPS: u32 = 32;

/// Watches reactions, forces and travel. Its [`Report`] holds extremes while the block rocks; a block that stands asks for
/// a friction of |ü_g/g|/(1 + v̈_g/g), which is below tan α.
#[derive(Clone, Copy, Debug)]
pub struct Checks<S> {
    /// Time of the present piece's start from the origin, s; the caller sets it.
    pub origin: S,
    report: Report<S>,
    geometry: Geometry,
    slenderness: S,
    sin_slenderness: S,
    cos_slenderness: S,
    /// 1/p², s²: from F/(λmR) to F/(mg).
    per_weight: S,
    /// R/g, s².
    drop_time_squared: S,
    size: S,
    lever: [S; 2],
    pulley: S,
    vertical: bool,
    /// σ of a flywheel that takes part in impacts.
    mass_ratio: S,
    rack_mass_ratio: S,
    last: Option<Snapshot<S>>,
    impact: Option<Impact<S>>,
    /// What was found up to where |θ| last passed α; none below it.
    up_to_slenderness: Option<Report<S>>,
    overturned: bool,
}

/// An impact whose flywheels are not known yet.
#[derive(Clone, Copy, Debug)]
struct Impact<S> {
    time: S,
    before: Snapshot<S>,
    velocity: S,
}

impl<S: Real> Checks<S> {
    /// Of a device on `mount` with the clutch and masses of `account`. All are those that the equations see, with what the
    /// block carries ([`crate::structure::Structure::loaded`]).
    ///
    /// # Errors
    /// As [`Mount::lever`].
    pub fn new(block: &Block, geometry: Geometry, mount: &Mount, account: &Account) -> Result<Checks<S>, ParameterError> {
        let LeverConstants { along, across } = mount.lever(block)?;
        let slender = math::square_root(mount.slender_lever_squared(block)?);
        let p2 = block.frequency_parameter_squared();
        let alpha = block.slenderness();
        let (pulley, vertical) = match *mount {
            Mount::CentreOfMass => (1.0, false),
            Mount::TyingPoint { pulley_ratio, .. } => (pulley_ratio, false),
            Mount::BaseCorners { pulley_ratio } => (pulley_ratio, true),
        };
        let (sin, cos, lever) = match geometry {
            Geometry::Full => (math::sin(alpha), math::cos(alpha), [along, across]),
            Geometry::Slender => (alpha, 1.0, [slender, 0.0]),
        };
        // An impact stops the rack: the ideal clutch, which only resists, has let go then.
        let mass_ratio = if account.clutching == Clutching::Ideal { 0.0 } else { account.mass_ratio };
        Ok(Checks {
            origin: S::ZERO,
            report: Report::default(),
            geometry,
            slenderness: S::of(alpha),
            sin_slenderness: S::of(sin),
            cos_slenderness: S::of(cos),
            per_weight: S::of(1.0 / p2),
            drop_time_squared: S::of(1.0 / (p2 * block.inertia_ratio())),
            size: S::of(block.size()),
            lever: lever.map(S::of),
            pulley: S::of(pulley),
            vertical,
            mass_ratio: S::of(mass_ratio),
            rack_mass_ratio: S::of(account.rack_mass_ratio),
            last: None,
            impact: None,
            up_to_slenderness: None,
            overturned: false,
        })
    }

    /// What was found up to the last stretch or event.
    pub fn report(&self) -> Report<S> {
        let mut seen = *self;
        seen.settle_impact(None);
        seen.report
    }

    /// As [`Checks::report`]; of a block that has overturned, what was found before its fall.
    pub fn before_fall(&self) -> Report<S> {
        self.up_to_slenderness.filter(|_| self.overturned).unwrap_or_else(|| self.report())
    }

    /// sin δ and cos δ, or what stands for them in the slender model.
    fn direction(&self, side: Sign, rotation: S) -> (S, S) {
        let delta = side.times(self.slenderness) - rotation;
        match self.geometry {
            Geometry::Full => delta.sin_cos(),
            Geometry::Slender => (delta, S::ONE),
        }
    }

    /// H and V of the toe on `side` over the weight.
    pub fn reactions(&self, side: Sign, snapshot: &Snapshot<S>) -> [S; 2] {
        let (sin, cos) = self.direction(side, snapshot.motion.rotation);
        let (turn, pull) = (snapshot.motion.acceleration, snapshot.motion.velocity * snapshot.motion.velocity);
        let device = self.pulley * self.per_weight * (snapshot.force[0] + snapshot.force[1] + snapshot.rack_force);
        let horizontal = snapshot.ground[0] + self.drop_time_squared * (cos * turn + sin * pull);
        let vertical = S::ONE + snapshot.ground[1] + self.drop_time_squared * (sin * turn - cos * pull);
        if self.vertical { [horizontal, vertical + side.times(device)] } else { [horizontal + device, vertical] }
    }

    /// Travel of the terminals at θ: R∫ℓ dθ = R [ A (s sin α − sin δ) + s B (cos δ − cos α) ], slender Rℓθ; m.
    pub fn travel(&self, side: Sign, rotation: S) -> S {
        let (sin, cos) = self.direction(side, rotation);
        let [along, across] = self.lever;
        let straight = side.times(self.sin_slenderness) - sin;
        self.size * (along * straight + side.times(across) * (cos - self.cos_slenderness))
    }

    /// The four quantities whose largest values are sought: friction needed, −V, and each flywheel's |F|/(mg).
    fn readings(&self, side: Sign, snapshot: &Snapshot<S>) -> [S; 4] {
        let [horizontal, vertical] = self.reactions(side, snapshot);
        let friction = if vertical > S::ZERO { horizontal.abs() / vertical } else { S::ZERO };
        let force = snapshot.force.map(|force| (self.per_weight * force).abs());
        [friction, -vertical, force[0], force[1]]
    }

    /// Friction that the last impact's impulses needed: per mR, cos α Δ|θ̇| + n Σ σ Δ|w| to the side and
    /// sin α (|θ̇⁻| + |θ̇⁺|) upward, where flywheels that stay engaged and the rack change their speed w. A vertical device is
    /// left out: it adds to the upward impulse only.
    fn settle_impact(&mut self, after: Option<&Snapshot<S>>) {
        let Some(Impact { time, before, velocity }) = self.impact.take() else { return };
        let (incoming, outgoing) = (before.motion.velocity.abs(), velocity.abs());
        let mut sideways = self.cos_slenderness * (incoming - outgoing);
        if let (Some(after), false) = (after, self.vertical) {
            let rack = self.rack_mass_ratio * (before.terminal_velocity.abs() - after.terminal_velocity.abs());
            let flywheels = (0..2).filter(|&i| before.engaged[i] && after.engaged[i]);
            let change = flywheels.fold(S::ZERO, |sum, i| sum + before.spin[i].abs() - after.spin[i].abs());
            sideways = sideways + self.pulley * (self.mass_ratio * change + rack);
        }
        let upward = self.sin_slenderness * (incoming + outgoing);
        if upward > S::ZERO {
            Extreme::raise(&mut self.report.impact_friction, sideways.abs() / upward, time);
        }
    }
}

impl<S: Real> Checks<S> {
    /// Notes what was found up to where |θ| passes α, in case the block never comes back. `found` is what was found up to the stretch.
    fn note_fall(&mut self, found: Checks<S>, arc: &dyn DeviceArc<S>, stretch: &Stretch<S>) {
        let beyond = |rotation: S| stretch.side.times(rotation) - self.slenderness;
        let (first, last) = (beyond(stretch.first.rotation), beyond(stretch.last.rotation));
        if last <= S::ZERO {
            self.up_to_slenderness = None;
        } else if first >= S::ZERO {
            self.up_to_slenderness.get_or_insert(found.report());
        } else {
            let passes = locate_by_value(stretch.from, stretch.to, Sign::Negative, |t| beyond(arc.snapshot(t).motion.rotation));
            let mut up_to_it = found;
            up_to_it.watch(arc, &Stretch { to: passes, last: arc.snapshot(passes).motion, ..*stretch });
            self.up_to_slenderness = Some(up_to_it.report);
        }
    }

    fn watch(&mut self, arc: &dyn DeviceArc<S>, stretch: &Stretch<S>) {
        let side = stretch.side;
        let start = self.origin + stretch.start;
        let step = (stretch.to - stretch.from) / S::of(LOOKS as f64 - 1.0);
        let instant = |i: usize| if i + 1 == LOOKS { stretch.to } else { stretch.from + S::of(i as f64) * step };
        let first = arc.snapshot(stretch.from);
        self.settle_impact(Some(&first));
        let mut looks = self.readings(side, &first).map(|reading| [reading; LOOKS]);
        for i in 1..LOOKS {
            let readings = self.readings(side, &arc.snapshot(instant(i)));
            for (values, reading) in looks.iter_mut().zip(readings) {
                values[i] = reading;
            }
        }
        for (quantity, values) in looks.iter().enumerate() {
            let value = |i: usize| values[i];
            let highest = (1..LOOKS).fold(0, |best, i| if value(i) > value(best) { i } else { best });
            let (mut found, mut time) = (value(highest), instant(highest));
            // The parabola through the three nearest looks tells whether there may be a record between them.
            let centre = highest.clamp(1, LOOKS - 2);
            let [left, middle, right] = [centre - 1, centre, centre + 1].map(value);
            let bend = middle + middle - left - right;
            let lean = right - left;
            if bend > S::ZERO && lean.abs() < bend + bend {
                let top = middle + lean * lean / (S::of(8.0) * bend);
                if self.report.record(quantity).is_none_or(|record| top + (top - found) > record) {
                    let bracket = (instant(centre - 1), instant(centre + 1));
                    let (at, top) = largest(bracket, |t| self.readings(side, &arc.snapshot(t))[quantity]);
                    if top > found {
                        (found, time) = (top, at);
                    }
                }
            }
            self.report.raise(quantity, found, start + time);
        }
        if self.report.contact_lost.is_none()
            && let Some(lost) = (0..LOOKS).find(|&i| looks[1][i] >= S::ZERO)
        {
            let time = if lost == 0 {
                stretch.from
            } else {
                let upward = |t: S| self.reactions(side, &arc.snapshot(t))[1];
                locate_by_value(instant(lost - 1), instant(lost), Sign::Positive, upward)
            };
            self.report.contact_lost = Some(start + time);
        }
        // θ is monotone along a stretch, and so is the travel wherever ℓ keeps its sign.
        for (motion, time) in [(&stretch.first, stretch.from), (&stretch.last, stretch.to)] {
            let travel = self.travel(side, motion.rotation);
            let way = usize::from(travel < S::ZERO);
            Extreme::raise(&mut self.report.travel[way], travel.abs(), start + time);
        }
        self.last = Some(arc.snapshot(stretch.to));
    }
}

impl<S: Real> DeviceObserver<S> for Checks<S> {
    fn device_stretch(&mut self, arc: &dyn DeviceArc<S>, stretch: &Stretch<S>) {
        let found = *self;
        self.watch(arc, stretch);
        self.note_fall(found, arc, stretch);
    }

    fn device_event(&mut self, event: Event, time: S, state: &State<S>) {
        match (event, self.last) {
            (Event::Impact, Some(before)) => {
                self.settle_impact(None);
                self.impact = Some(Impact { time: self.origin + time, before, velocity: state.velocity });
            }
            (Event::Rest, _) => self.settle_impact(None),
            (Event::Overturned, _) => self.overturned = true,
            _ => {}
        }
    }
}

/// Time and value of the largest value of `function` within `bracket`, which holds one maximum: golden-section search.
fn largest<S: Real>((mut low, mut high): (S, S), mut function: impl FnMut(S) -> S) -> (S, S) {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let golden = S::of(GOLDEN);
    let (mut left, mut right) = (high - golden * (high - low), low + golden * (high - low));
    let (mut at_left, mut at_right) = (function(left), function(right));
    for _ in 0..SEARCH_STEPS {
        if at_left > at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - golden * (high - low);
            at_left = function(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + golden * (high - low);
            at_right = function(right);
        }
    }
    if at_left > at_right { (left, at_left) } else { (right, at_right) }
}

#[cfg(test)]
mod tests;
