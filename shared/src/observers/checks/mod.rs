//! Checks of the model's assumptions (no sliding, no free flight) and of the forces on the parts, by an observer.
//!
//! The toe must bear what block and device press on it, with the forces and impulses that `checks/toe.rs` derives. The model does not slide
//! while |H|/V stays below the friction that there is, and keeps its toe on the ground while V > 0.
//!
//! The fall of a block that overturns begins where it passes |θ| = α without coming back. What it asks for from there on says nothing of
//! how it rocks, and grows without bound: [`Checks::before_fall`] leaves it out.

mod impulse;
mod report;
mod search;
mod toe;

pub use report::{Extreme, Report};

use crate::math::root::illinois;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::rest::impact_accumulation::is_new;
use crate::motion::state::BlockState;
use crate::observers::fall::Fall;
use crate::observers::ledger::Account;
use crate::structure::COUNTED_SPEED;
use crate::structure::block::{Block, Geometry};
use crate::structure::error::ParameterError;
use crate::structure::mount::Mount;
use impulse::Impulses;
use search::{LOOKS, instant, largest};
use toe::Toe;

/// The quantities whose largest values are sought along every interval: friction, −V, the force of each flywheel, that on the support.
const QUANTITIES: usize = 5;

/// The first of the device.
const FORCES: usize = 2;

/// The last of them.
const SUPPORT: usize = 4;

/// Observer of reactions, impulses, forces and travel. Its [`Report`] holds extremes while the block rocks, and of the device's forces and the
/// friction under them those at rest too, which a support of its own motion causes. Without it one that stands asks for a friction of
/// |ü_g/g|/(1 + v̈_g/g), which grows to tan α before it rocks.
#[derive(Clone, Copy, Debug)]
pub struct Checks<S> {
    /// Time of the present ground segment's start from the origin, s; the caller sets it.
    pub origin: S,
    /// What was found up to the last interval or event.
    pub report: Report<S>,
    toe: Toe<S>,
    impulses: Impulses<S>,
    /// The support moves otherwise than the ground.
    on_support: bool,
    /// Open clutches pass forces too.
    drags: bool,
    /// Clutches are elastic.
    springs: bool,
    /// The first quantity that is looked at.
    first: usize,
    /// The travel of the terminals is looked at.
    travels: bool,
    fall: Fall<S, Report<S>>,
}

impl<S: Real> Checks<S> {
    /// Of a device on `mount` with the clutch and masses of `account`. All are those that the equations see, with what the
    /// block carries ([`crate::structure::Structure::loaded`]).
    ///
    /// # Errors
    /// The errors of [`Mount::lever`].
    pub fn new(block: &Block, geometry: Geometry, mount: &Mount, account: &Account) -> Result<Checks<S>, ParameterError> {
        let speed = block.frequency_parameter() * block.slenderness();
        let toe = Toe::new(block, geometry, mount, account)?;
        Ok(Checks {
            origin: S::ZERO,
            report: Report::default(),
            fall: Fall::beyond(toe.slenderness),
            toe,
            impulses: Impulses::new(S::of(COUNTED_SPEED * speed)),
            on_support: account.on_support,
            drags: account.drags,
            springs: account.springs,
            first: 0,
            travels: true,
        })
    }

    /// Looks at the force on the support and at impulses only: what every history is reported with.
    pub fn brief(self) -> Checks<S> {
        Checks { travels: false, ..self.of_device() }
    }

    /// Looks at the force on the support, the travel and impulses only: what a device asks for.
    pub fn of_device(self) -> Checks<S> {
        Checks { first: SUPPORT, ..self }
    }

    /// Looks at the force of each flywheel, that on the support, the travel and impulses only: what a device and its gears ask for.
    pub fn of_flywheels(self) -> Checks<S> {
        Checks { first: FORCES, ..self }
    }

    /// The force of each flywheel is looked at.
    pub fn looks_at_flywheels(&self) -> bool {
        self.first <= FORCES
    }

    /// Largest force of both flywheels together on their support so far, as a snapshot has it; |F|/(λmR), 1/s². None where none was ever
    /// engaged, or dragged along.
    pub fn largest_support_force(&self) -> Option<S> {
        self.in_snapshot(self.report.support)
    }

    /// Largest force of one flywheel so far, likewise.
    pub fn largest_flywheel_force(&self) -> Option<S> {
        self.in_snapshot(self.report.largest_force())
    }

    fn in_snapshot(&self, largest: Option<Extreme<S>>) -> Option<S> {
        largest.map(|largest| largest.value / self.toe.over_weight(S::ONE))
    }

    /// Travel of the terminals (m) at θ (rad) on `side`, from where they are at rest.
    pub fn travel(&self, side: Sign, rotation: S) -> S {
        self.toe.travel(side, rotation)
    }

    /// As [`Checks::report`]; of a block that has overturned, what was found before its fall.
    pub fn before_fall(&self) -> Report<S> {
        self.fall.before().unwrap_or(self.report)
    }

    /// The quantities at an instant; those that are not looked at are 0.
    fn readings(&self, side: Sign, snapshot: &Snapshot<S>) -> [S; QUANTITIES] {
        let weigh = |force: S| self.toe.over_weight(force).abs();
        let support = weigh(snapshot.support_force());
        if self.first == SUPPORT {
            return [S::ZERO, S::ZERO, S::ZERO, S::ZERO, support];
        }
        let [horizontal, vertical] = self.toe.reactions(side, snapshot);
        let friction = if vertical > S::ZERO { horizontal.abs() / vertical } else { S::ZERO };
        [friction, -vertical, weigh(snapshot.device.force[0]), weigh(snapshot.device.force[1]), support]
    }

    /// Whether an interval with forces may hold a new record of one. It is a step, which follows at most half a swing of a stiff clutch, or a piece of
    /// one ([`DeviceOutput::pieces`]), so that of three looks one shows more than half of what lies between; and where a parabola through them
    /// also meets a fourth, no more lies between than they and its curvature show.
    fn may_press_harder(&self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) -> bool {
        let forces = |share: S| {
            let snapshot = output.snapshot(interval.from + share * (interval.to - interval.from));
            let [first, second] = snapshot.device.force;
            [first, second, snapshot.support_force()].map(|force| self.toe.over_weight(force))
        };
        let [first, middle, last] = [S::ZERO, S::HALF, S::ONE].map(forces);
        let seen = |i: usize| first[i].abs().larger(middle[i].abs()).larger(last[i].abs());
        let record = |i: usize| self.report.record(FORCES + i).unwrap_or(-S::ONE);
        let near = |i: &usize| seen(*i) > S::HALF * record(*i);
        let looked_at = self.first.max(FORCES) - FORCES..QUANTITIES - FORCES;
        if !looked_at.clone().any(|i| near(&i)) {
            return false;
        }
        let quarter = forces(S::of(0.25));
        let rounding = S::ONE + S::EPSILON * S::of(64.0);
        looked_at.filter(near).any(|i| {
            let curvature = (first[i] - middle[i] - middle[i] + last[i]).abs();
            let parabola = S::of(0.375) * first[i] + S::of(0.75) * middle[i] - S::of(0.125) * last[i];
            let missed = (quarter[i] - parabola).abs();
            seen(i) + curvature + S::of(8.0) * missed > record(i) * rounding
        })
    }

    fn look(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        let of_toe = self.first < FORCES;
        if of_toe || interval.engaged || self.drags {
            let pieces = output.pieces();
            let length = (interval.to - interval.from) / S::count(pieces);
            let end = |i: u32| if i == pieces { interval.to } else { interval.from + S::count(i) * length };
            for i in 0..pieces {
                let piece = MonotoneInterval { from: end(i), to: end(i + 1), ..*interval };
                if of_toe || self.may_press_harder(output, &piece) {
                    self.watch(output, &piece);
                }
            }
        }
        if self.travels {
            self.follow_terminals(interval);
        }
    }

    /// θ is monotone along an interval, and so is the travel wherever ℓ keeps its sign.
    fn follow_terminals(&mut self, interval: &MonotoneInterval<S>) {
        let start = self.origin + interval.start;
        for (motion, time) in [(&interval.first, interval.from), (&interval.last, interval.to)] {
            let travel = self.toe.travel(interval.side, motion.rotation);
            let way = usize::from(travel < S::ZERO);
            Extreme::raise(&mut self.report.travel[way], travel.abs(), start + time);
        }
    }

    fn watch(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        let side = interval.side;
        let start = self.origin + interval.start;
        let span = (interval.from, interval.to);
        let flywheel_speed = |snapshot: &Snapshot<S>| {
            let [first, second] = snapshot.device.spin;
            self.toe.size * first.abs().larger(second.abs())
        };
        let (mut looks, mut speeds) = ([[S::ZERO; LOOKS]; QUANTITIES], [S::ZERO; LOOKS]);
        for i in 0..LOOKS {
            let snapshot = output.snapshot(instant(span, i));
            for (values, reading) in looks.iter_mut().zip(self.readings(side, &snapshot)) {
                values[i] = reading;
            }
            if self.springs {
                speeds[i] = flywheel_speed(&snapshot);
            }
        }
        for (quantity, values) in looks.iter().enumerate().skip(self.first) {
            let reading = |t: S| self.readings(side, &output.snapshot(t))[quantity];
            let (time, value) = largest(span, values, self.report.record(quantity), &reading);
            self.report.raise(quantity, value, start + time);
        }
        if self.first >= FORCES {
            return;
        }
        if self.springs {
            let record = self.report.flywheel_speed.map(|known| known.value);
            let (time, value) = largest(span, &speeds, record, &|t| flywheel_speed(&output.snapshot(t)));
            Extreme::raise(&mut self.report.flywheel_speed, value, start + time);
        }
        if self.report.contact_lost.is_none()
            && let Some(lost) = (0..LOOKS).find(|&i| looks[1][i] >= S::ZERO)
        {
            let time = if lost == 0 {
                interval.from
            } else {
                let upward = |t: S| self.toe.reactions(side, &output.snapshot(t))[1];
                illinois(instant(span, lost - 1), instant(span, lost), Sign::Positive, upward)
            };
            self.report.contact_lost = Some(start + time);
        }
    }
}

impl<S: Real> Observer<S> for Checks<S> {
    // Out of line in every program: in line, it would cost those with one loop less.
    #[inline(never)]
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        let passed = self.fall.passed(output, interval, |up_to_it| {
            let mut before = *self;
            if let Some(interval) = up_to_it {
                before.look(output, interval);
            }
            before.report
        });
        self.look(output, interval);
        self.fall.keep(passed);
        let engaged = if interval.engaged { output.snapshot(interval.to).device.engaged } else { [false; 2] };
        self.impulses.velocity = Some(interval.last.velocity);
        self.impulses.engaged = engaged.map(u32::from).iter().sum();
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        let bears = interval.engaged || self.drags || self.on_support;
        if bears && interval.to > interval.from {
            let first = if self.on_support { self.first } else { self.first.max(FORCES) };
            let mut standing = Checks { first, travels: false, ..*self };
            standing.look(output, interval);
            let Report { vertical, contact_lost, .. } = self.report;
            self.report = Report { vertical, contact_lost, ..standing.report };
        }
    }

    fn device_bounce(&mut self, side: Sign, time: S, snapshot: &dyn Fn() -> Snapshot<S>) {
        let readings = self.readings(side, &snapshot());
        for (quantity, value) in readings.into_iter().enumerate().skip(self.first) {
            if is_new(value, self.report.record(quantity).unwrap_or(S::ZERO)) {
                self.report.raise(quantity, value, self.origin + time);
            }
        }
        if self.first < FORCES && readings[1] >= S::ZERO {
            self.report.contact_lost.get_or_insert(self.origin + time);
        }
    }

    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        self.fall.event(event);
        self.impulses.event(&self.toe, &mut self.report, event, self.origin + time, state);
    }
}

#[cfg(test)]
mod tests;
