//! One step of several blocks in their modes, of those on which nothing can happen in between.

use std::cell::Cell;

use sprag_shared::drivetrain::clutch_state::{Coupling, DeviceState, Guard, ModeCoefficients};
use sprag_shared::drivetrain::friction::{below_capacity, plate_force, slip, spin_rates};
use sprag_shared::drivetrain::scaled_parameters::ScaledParameters;
use sprag_shared::drivetrain::transmission::{PointOf, driving_moment, locked_force, rack_friction, resisted_acceleration};
use sprag_shared::math::RECIPROCALS;
use sprag_shared::math::scalar::Scalar;
use sprag_shared::math::sign::Sign;
use sprag_shared::method::motion_series::MotionSeries;
use sprag_shared::motion::hybrid::HybridSystem;

use super::body::LaneBody;
use super::expansion::{Expansion, RATES, TERMS, bend_of};
use super::seat::Seat;
use super::{HybridMotion, Kind};
use crate::polynomial::{largest_in_lane, value};
use crate::series::along;
use crate::{Mask, Number, WIDTH, number};

/// Largest of the last terms of θ and of the one before, over α. The first one that θ̇ leaves out, over pα, is as large as the last one of θ:
/// no more than some rounding.
const LAST: f64 = 1e-15;
const LAST_BUT_ONE: f64 = 1e-13;

/// The plates of both flywheels.
#[derive(Debug)]
struct Plates {
    /// Capacity, 1/s².
    capacity: Number,
    /// The plates of the flywheel stick.
    stick: [Mask; 2],
    /// Sign of the force of plates that slip; 0 where none do.
    slip: [Number; 2],
    /// Speed of a flywheel whose plates slip, 1/s.
    spin: [Number; 2],
    /// The way it turns.
    turning: [Number; 2],
}

/// Blocks after a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stepped {
    /// Those that are at the end of their steps.
    pub(super) plain: Mask,
    /// Those whose series hold up to there.
    pub(super) converged: Mask,
    /// Those of which it is shown that they do not turn before.
    pub(super) goes_on: Mask,
    /// Those of which it is shown that no guard is reached before.
    pub(super) guarded: Mask,
    /// Those of which a force that is looked at may be larger than ever.
    pub(super) pressed: Mask,
    /// Lengths of the steps, s.
    pub(super) time: Number,
}

/// Blocks in their modes, one in each lane; SI units.
#[derive(Debug)]
pub(super) struct Stretch<B> {
    pub(super) kind: Kind,
    body: B,
    parameters: ScaledParameters<Number>,
    law: ModeCoefficients<Number>,
    /// Flywheels that are locked.
    locked: Number,
    plates: Plates,
    /// s.
    side: Number,
    /// Sign of the switching function; 0 where nobody watches it.
    watched: Number,
    /// α, rad.
    slenderness: Number,
    /// 1/p, s.
    unit: Number,
    /// θ, rad.
    pub(super) rotation: Number,
    /// θ̇, rad/s.
    pub(super) velocity: Number,
    /// Coefficients of the ground acceleration about now, in g, horizontal and vertical.
    ground: [[Number; RATES]; 2],
    /// Time to the end of the interval, s.
    length: Number,
    /// Time since the core had the block, s.
    pub(super) elapsed: Number,
    /// Time until something is due, s.
    due: Number,
    /// |θ| at which an outward motion counts as overturned, rad.
    overturned: Number,
    /// Largest force on the support so far, 1/s².
    largest_force: Number,
    /// Largest force of one flywheel so far, 1/s².
    largest_on_wheel: Number,
    /// Largest force of plates that slip in this mode, 1/s².
    slip_force: Number,
    /// max |θ̇| since the core had the block, rad/s, where coils are looked at.
    pub(super) fastest: Number,
    /// max |θ|, rad.
    pub(super) peak_rotation: Number,
    /// max |θ̈|, rad/s².
    pub(super) peak_acceleration: Number,
}

impl<B: LaneBody> Stretch<B> {
    pub(super) fn new(kind: Kind) -> Stretch<B> {
        let (zero, one) = (number(0.0), number(1.0));
        Stretch {
            kind,
            body: B::harmless(),
            parameters: ScaledParameters::default(),
            law: ModeCoefficients::default(),
            locked: zero,
            plates: Plates { capacity: zero, stick: [Mask::NONE; 2], slip: [zero; 2], spin: [zero; 2], turning: [zero; 2] },
            side: one,
            watched: zero,
            slenderness: one,
            unit: one,
            rotation: zero,
            velocity: zero,
            ground: [[zero; RATES]; 2],
            length: one,
            elapsed: zero,
            due: number(f64::INFINITY),
            overturned: one,
            largest_force: zero,
            largest_on_wheel: zero,
            slip_force: zero,
            fastest: zero,
            peak_rotation: zero,
            peak_acceleration: zero,
        }
    }

    /// Another block in `lane`.
    pub(super) fn renew(&mut self, lane: usize, system: &HybridSystem<f64>) {
        self.body.renew(lane, &system.body);
        (self.slenderness.0[lane], self.unit.0[lane]) = (system.slenderness, system.slenderness / system.speed);
        let ScaledParameters { inertance, mobility, bearing_rate, bearing_dry, .. } = system.transmission.parameters;
        (self.parameters.inertance.0[lane], self.parameters.mobility.0[lane]) = (inertance, mobility);
        (self.parameters.bearing_rate.0[lane], self.parameters.bearing_dry.0[lane]) = (bearing_rate, bearing_dry);
    }

    /// The block in `lane` is now in the mode `law`, where the core has it.
    pub(super) fn set_mode(&mut self, lane: usize, seat: &Seat<'_>, law: &ModeCoefficients<f64>) {
        let HybridMotion { state, peaks, checks, .. } = &seat.motion;
        (self.rotation.0[lane], self.velocity.0[lane]) = (state.motion.rotation, state.motion.velocity);
        self.side.0[lane] = state.motion.side.unit();
        self.law.direction.0[lane] = law.direction;
        self.law.coupling.0[lane] = law.coupling;
        (self.law.viscous.0[lane], self.law.dry.0[lane]) = (law.viscous, law.dry);
        self.watched.0[lane] = if let Guard::Command(sign) = law.watch[0] { sign } else { 0.0 };
        self.locked.0[lane] = f64::from(state.device.locked());
        if self.kind.plates {
            self.set_plates(lane, &state.device, law);
        }
        self.largest_force.0[lane] = checks.and_then(|checks| checks.largest_support_force()).unwrap_or(0.0);
        self.largest_on_wheel.0[lane] = checks.and_then(|checks| checks.largest_flywheel_force()).unwrap_or(0.0);
        self.slip_force.0[lane] = law.slip[0].abs().max(law.slip[1].abs());
        (self.elapsed.0[lane], self.fastest.0[lane]) = (0.0, state.motion.velocity.abs());
        self.due.0[lane] = seat.block.system.next_due(state).unwrap_or(f64::INFINITY);
        (self.peak_rotation.0[lane], self.peak_acceleration.0[lane]) = (peaks.rotation, peaks.acceleration);
        self.stand_at(lane, seat);
    }

    fn set_plates(&mut self, lane: usize, device: &DeviceState<f64>, law: &ModeCoefficients<f64>) {
        let plates = &mut self.plates;
        for (i, wheel) in device.wheels.iter().enumerate() {
            plates.stick[i].set(lane, wheel.coupling == Coupling::Locked);
            if let Guard::Capacity(capacity, _) = law.watch[i + 1] {
                plates.capacity.0[lane] = capacity;
            }
            plates.slip[i].0[lane] = wheel.coupling.slip_sign().map_or(0.0, Sign::unit);
            plates.turning[i].0[lane] = wheel.turning.map_or(0.0, Sign::unit);
            plates.spin[i].0[lane] = wheel.spin;
            self.law.slip[i].0[lane] = law.slip[i];
            self.law.moves[i].0[lane] = law.moves[i];
            (self.law.decay[i].0[lane], self.law.drag[i].0[lane]) = (law.decay[i], law.drag[i]);
        }
    }

    /// Speeds of the flywheels in `lane` whose plates slip, 1/s.
    pub(super) fn spins(&self, lane: usize) -> [f64; 2] {
        self.plates.spin.map(|spin| spin.0[lane])
    }

    /// The block in `lane` is where its `seat` is in its ground motion.
    #[inline(always)]
    pub(super) fn stand_at(&mut self, lane: usize, seat: &Seat<'_>) {
        let (ground, rates) = (&mut self.ground, self.kind.terms - 2);
        seat.block.ground.series(seat.interval, seat.progress.time, rates, |way, order, coefficient| {
            ground[way][order].0[lane] = coefficient;
        });
        self.length.0[lane] = seat.left();
        self.overturned.0[lane] = seat.overturned();
    }

    /// Follows every block to its next sample, or as far as its series reaches. Those on which an event may lie before that are left where they
    /// are.
    #[inline(always)]
    pub(super) fn step(&mut self, expansion: &mut Expansion) -> Stepped {
        let nothing = number(0.0);
        self.expand(expansion);
        let Expansion { motion: series, guards, spins, force, on_wheel, .. } = &*expansion;
        let time = if self.kind.curved { self.length.smaller(self.reach(&*expansion)) } else { self.length };
        let half_square = number(0.125) * (time * time);

        // Bounds of the second derivatives of θ̈ and θ̇ over the step.
        let terms = self.kind.terms;
        let in_use = terms - 2;
        let rates = &series.acceleration[..in_use];
        let bend = bend_of(rates, time);
        let rate_slope = rates[1].abs();
        let swing = rate_slope + bend * time;

        let end = (value(&series.rotation[..terms], time), value(&series.velocity[..terms - 1], time), value(rates, time));
        let direction = self.law.direction;
        let slowest = (self.velocity * direction).smaller(end.1 * direction);
        let goes_on = slowest.exceeds(half_square * swing);
        let tilted = (end.0 * self.side).exceeds(nothing);
        let outward = (self.side * direction).exceeds(nothing);
        let stays = !(outward & (end.0 * self.side).exceeds(self.overturned));
        let in_time = self.due.exceeds(time);
        let watched = self.watched.abs().exceeds(nothing);
        let holds = |guard: &[Number; RATES]| {
            let guard = &guard[..in_use];
            guard[0].smaller(value(guard, time)).exceeds(half_square * bend_of(guard, time))
        };
        let mut guarded = holds(&guards[0]) | !watched;
        let mut spin_ends = [nothing; 2];
        if self.kind.plates {
            let Plates { stick, slip, turning, .. } = &self.plates;
            for (i, end) in spin_ends.iter_mut().enumerate() {
                let slips = slip[i].abs().exceeds(nothing);
                guarded = guarded & (holds(&guards[i + 1]) | !(stick[i] | slips));
                let spin = &spins[i][..terms - 1];
                *end = value(spin, time);
                let slowest = (spin[0] * turning[i]).smaller(*end * turning[i]);
                guarded = guarded & (slowest.exceeds(half_square * bend_of(spin, time)) | !slips);
            }
        }
        // A larger force than ever is for the core's observer.
        let largest = |force: &[Number; RATES]| {
            let force = &force[..in_use];
            let ends = force[0].abs().larger(value(force, time).abs());
            ends + half_square * bend_of(force, time)
        };
        let mut pressed = Mask::NONE;
        if self.kind.forces {
            pressed = largest(force).exceeds(self.largest_force);
        }
        if self.kind.flywheels {
            pressed = pressed | largest(on_wheel).larger(self.slip_force).exceeds(self.largest_on_wheel);
        }
        let converged = self.converges(series, time);
        let clean = !pressed & converged & goes_on & tilted & stays & in_time & guarded;

        let sag = half_square * bend;
        let ends = rates[0].abs().larger(end.2.abs());
        let open = clean & (ends + sag).exceeds(self.peak_acceleration) & !rate_slope.exceeds(bend * time);
        self.peak_acceleration = clean.choose(self.peak_acceleration.larger(ends), self.peak_acceleration);
        if open.any() {
            for lane in (0..WIDTH).filter(|&lane| open.at(lane)) {
                let peak = &mut self.peak_acceleration.0[lane];
                *peak = largest_in_lane::<RATES>(rates, lane, (time.0[lane], end.2.0[lane]), *peak);
            }
        }
        self.peak_rotation = clean.choose(self.peak_rotation.larger(end.0.abs()), self.peak_rotation);
        self.rotation = clean.choose(end.0, self.rotation);
        self.velocity = clean.choose(end.1, self.velocity);
        if self.kind.coils {
            self.fastest = clean.choose(self.fastest.larger(end.1.abs()), self.fastest);
        }
        if self.kind.plates {
            for (spin, end) in self.plates.spin.iter_mut().zip(spin_ends) {
                *spin = clean.choose(end, *spin);
            }
        }
        self.elapsed = clean.choose(self.elapsed + time, self.elapsed);
        self.due = clean.choose(self.due - time, self.due);
        Stepped { plain: clean, converged, goes_on, guarded, pressed, time }
    }

    /// The series of the motion and of the guard.
    #[inline(always)]
    fn expand(&self, expansion: &mut Expansion) {
        // θ, θ̇, the ground twice, the clock and two flywheels.
        const GIVEN: usize = 7;
        let zero = number(0.0);
        let Expansion { tape, motion: series, guards, spins, force, on_wheel, .. } = expansion;
        let tape = &*tape;
        let body = self.body.known(self.kind);
        let next = Cell::new(GIVEN);
        series.start(tape, self.rotation, self.velocity);
        for (i, spin) in spins.iter_mut().enumerate() {
            spin[0] = self.plates.spin[i];
            tape.set(5 + i, 0, spin[0]);
        }
        // Of a flywheel that is locked; of none without one.
        let one_locked = self.locked.smaller(number(1.0));
        for (k, (force, on_wheel)) in force.iter_mut().zip(on_wheel).enumerate() {
            for way in 0..2 {
                tape.set(2 + way, k, self.ground[way][k]);
            }
            tape.set(4, k, if k == 1 { number(1.0) } else { zero });
            next.set(GIVEN);
            let given = |slot| tape.given(&next, k, slot);
            let at = PointOf::<Number, B, _, 2> {
                body: &body,
                parameters: &self.parameters,
                law: &self.law,
                configuration: body.configuration(self.side, given(0)),
                velocity: given(1),
                unknowns: [given(5), given(6)],
                // The third is not looked at: supports move with the ground here.
                ground: [given(2), given(3), given(2)],
                clock: given(4),
            };
            let moment = driving_moment(&at, None);
            let mut resistance = rack_friction(&at);
            if self.kind.plates {
                resistance = resistance + plate_force(&at);
            }
            let acceleration = resisted_acceleration(&at, moment, resistance);
            series.extend(tape, k, acceleration.last());
            guards[0][k] = body.switching(&at.configuration, at.velocity, moment).last() * self.watched;
            if self.kind.plates || self.kind.forces {
                let locked = locked_force(&at, acceleration);
                *force = locked.last() * self.locked;
                if self.kind.flywheels {
                    *on_wheel = locked.last() * one_locked;
                }
                if self.kind.plates {
                    let Plates { capacity, stick, slip: signs, .. } = &self.plates;
                    let sticks = below_capacity(&at, locked, (*capacity, zero)).last();
                    for (i, rate) in spin_rates(&at).into_iter().enumerate() {
                        guards[i + 1][k] = stick[i].choose(sticks, slip(&at, signs[i], i).last());
                        let coefficient = rate.last() * number(RECIPROCALS[(k + 1) & 63]);
                        spins[i][k + 1] = coefficient;
                        tape.set(5 + i, k + 1, coefficient);
                    }
                    if k == 0 {
                        *force = *force + self.law.slip[0] + self.law.slip[1];
                    }
                }
            }
            if k + 3 == self.kind.terms {
                break;
            }
        }
    }

    /// How far the last two terms of θ, and of the speeds of plates that slip, stay small (Jorba and Zou's two-term rule).
    #[inline(always)]
    fn reach(&self, expansion: &Expansion) -> Number {
        let last = self.kind.terms - 1;
        let tolerance = number(LAST) * self.slenderness.larger(self.rotation.abs());
        let rotation = &expansion.motion.rotation;
        let mut reach = along(rotation[last], last, tolerance).smaller(along(rotation[last - 1], last - 1, tolerance));
        if self.kind.plates {
            for spin in &expansion.spins {
                // A speed that matters is pα.
                reach = reach.smaller(along(spin[last - 1] * self.unit, last - 1, tolerance));
            }
        }
        reach * number(0.9)
    }

    /// Whether the last two terms of θ are so small that the first one left out does not matter.
    #[inline(always)]
    fn converges(&self, series: &MotionSeries<Number, TERMS>, time: Number) -> Mask {
        let last = self.kind.terms - 1;
        let mut power = time;
        for _ in 2..last {
            power = power * time;
        }
        let size = self.slenderness.larger(self.rotation.abs());
        let before = (number(LAST_BUT_ONE) * size).exceeds(series.rotation[last - 1].abs() * power);
        power = power * time;
        before & (number(LAST) * size).exceeds(series.rotation[last].abs() * power)
    }
}
