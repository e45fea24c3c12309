//! Impact of a block with a device, and the decision between rocking and rest after it.

use super::mode_output::Shaking;
use super::{Actuator, HybridState, HybridSystem};
use crate::drivetrain::any_transmission::Traits;
use crate::drivetrain::clutch_state::{Coupling, DeviceState, FlywheelState, GUARDS};
use crate::drivetrain::scaled_parameters::ScaledParameters;
use crate::equation::Accelerations;
use crate::equation::body::Body;
use crate::equation::clutch_rule::wheel_for;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::observer::{Event, Observer};
use crate::motion::rest::impact_accumulation::{Accumulation, ways};
use crate::motion::state::{BlockState, Phase};

/// How many times as fast as the rack a support is under whose motion the block's own is too slow to switch clutches.
const SLOW: f64 = 1e3;

/// Share of the speed that counts from which on swings that flywheels may speed up are followed. An engagement in one that does not count is not
/// missed, so that within two of them a clutch that locks has closed.
const FOLLOWED: f64 = 1e-2;

/// Speed of a swing over that of the one before from which on plates that drive the block may make it count, or many after it.
const GAIN: f64 = 0.9;

/// Pairs of swings up to which plates that drive the block until their flywheel has slowed down are followed.
const MOST_DRIVEN: f64 = 2e3;

/// How many flywheels.
fn count(wheels: [bool; 2]) -> u32 {
    wheels.map(u32::from).iter().sum()
}

fn is_locked<S>(wheel: &FlywheelState<S>) -> bool {
    wheel.coupling == Coupling::Locked
}

impl<S: Real> HybridSystem<S> {
    /// Impact at θ = 0. Returns the time, which rest moves on to the end of the impacts that it stands for.
    pub(super) fn impact(
        &self,
        state: &mut HybridState<S>,
        shaking: Shaking<'_, S>,
        time: S,
        duration: S,
        observer: &mut dyn Observer<S>,
    ) -> S {
        let motion = &mut state.motion;
        let incoming = motion.velocity;
        let counts = incoming.abs() >= self.counted_speed;
        if counts {
            motion.impacts += 1;
        }
        // A turn and a hit in one ulp leave the direction of before the turn.
        motion.direction = Sign::of(incoming, motion.direction);
        let before = {
            let configuration = self.body.configuration(motion.side.unit(), S::ZERO);
            self.body.to_terminal(&configuration, incoming)
        };
        let engaged = if self.transmission.traits().through_impacts { state.device.locked() } else { 0 };
        let mut restitution = self.restitution[engaged.min(2) as usize];
        // Those that do not count have no number, and nothing to scatter.
        if counts && self.scatter.is_on() {
            restitution = S::of(self.scatter.draw(motion.impacts, restitution.to_f64()));
        }
        motion.velocity = restitution * incoming;
        motion.side = motion.direction;
        self.look_at_drive(state);
        let velocity = state.motion.velocity;
        state.weak = velocity.abs() <= self.counted_speed;
        observer.event(Event::Impact, time, &state.motion);
        self.with_instant(state, time, observer, |transmission, at| {
            transmission.impact(at, before);
            transmission.settle(at);
        });
        if velocity.abs() > self.rest_speed {
            return time;
        }
        let mut standing = self.standing(state, time, &mut ());
        let carried = self.support_goes(&mut standing);
        if self.uplifting(&standing, state.ground) > S::ZERO || self.swings(&standing) {
            self.stay_on_base(state, time, observer);
            return time;
        }
        let negligible = self.negligible(velocity);
        if !negligible && carried && self.moves_its_clutches(&standing, velocity) {
            return time;
        }
        let stuck = self.stuck(&standing, &state.device);
        let tail = self.accumulation(&standing, stuck, velocity.abs());
        let followed = (self.counted_speed * S::of(FOLLOWED)).larger(self.speed * S::EPSILON);
        if velocity.abs() > followed && self.speeds_up(&standing, &tail) {
            return time;
        }
        let stands = |at| self.uplifting(&standing, shaking.at(at)) < S::ZERO;
        let Some(ends) = tail.rest(time, duration, negligible, stands) else { return time };
        observer.accumulation(&tail);
        if tail.acceleration > S::ZERO {
            self.show_bounces(&standing, stuck, time, observer);
        }
        *state = standing;
        state.motion.impacts += tail.impacts;
        state.device.engagements += tail.closings;
        observer.event(Event::Rest, ends, &state.motion);
        if self.follows_swings() {
            // Whichever side the last impact that was followed left them on, they have let go since.
            self.open_clutches(state, ends, observer);
        }
        // What its clutches let go shows at once, and what coasts until then after it.
        self.show_instant(state, time, observer);
        self.drive_at_rest(state, shaking, (time, ends), observer);
        self.stand(state, shaking, time, ends, observer);
        ends
    }

    /// On a support that moves otherwise than the ground: whether a block that leaves its base at `velocity` is fast enough to switch clutches.
    fn moves_its_clutches(&self, standing: &HybridState<S>, velocity: S) -> bool {
        let Some(terminals) = standing.device.terminals.filter(|_| self.transmission.traits().commanded) else { return false };
        let rack = self.body.to_terminal(&self.body.configuration(standing.motion.side.unit(), S::ZERO), velocity);
        terminals.support.abs() < S::of(SLOW) * rack.abs()
    }

    /// Whether the flywheel for the motion `way` turns that way faster than the rack of a block at the θ̇ of `speed` (rad/s).
    fn is_ahead(&self, standing: &HybridState<S>, way: Sign, speed: S) -> bool {
        let configuration = self.body.configuration(standing.motion.side.unit(), S::ZERO);
        let rack = self.body.to_terminal(&configuration, speed).abs();
        way.times(standing.device.wheels[wheel_for(way)].spin) > rack
    }

    /// Whether flywheels that coast ahead may make the swings of a block that is as in `standing` after them, and whose sums are `tail`, fast enough
    /// to count: a clutch that locks shares its flywheel's speed at once; plates have to make up for nearly all that an impact takes, and drive the
    /// block for w k/F_c.
    fn speeds_up(&self, standing: &HybridState<S>, tail: &Accumulation<S>) -> bool {
        let Actuator { engagement_delay, controlled, .. } = self.actuator;
        let Traits { commanded, springs, .. } = self.transmission.traits();
        let slips = self.transmission.slips_viscously();
        if !commanded || controlled || springs || slips || standing.device.terminals.is_some() {
            return false;
        }
        let plates = self.plates();
        [Sign::Positive, Sign::Negative].into_iter().any(|way| {
            let wheel = &standing.device.wheels[wheel_for(way)];
            let closes = engagement_delay.larger(wheel.dwell) <= S::ZERO && self.is_ahead(standing, way, self.counted_speed);
            let slows = wheel.spin.abs() * self.transmission.parameters.inertance / plates;
            closes && (!plates.is_finite() || (tail.gain > S::of(GAIN) && slows < tail.swing * S::of(MOST_DRIVEN)))
        })
    }

    /// The flywheels that stay engaged through the swings of a block that is as in `standing` after them: those that a controller holds,
    /// or where swings are too short for what delays their clutches, which are as in `device` before them; none where clutches follow every swing.
    fn stuck(&self, standing: &HybridState<S>, device: &DeviceState<S>) -> Option<[bool; 2]> {
        let Actuator { engagement_delay, release_delay, controlled, .. } = self.actuator;
        let Traits { commanded, springs, .. } = self.transmission.traits();
        // Springs give way.
        if !commanded || springs || self.is_carried(standing) {
            return None;
        }
        // Swings that are summed end in the piece that is followed, before its next command.
        if controlled {
            return Some(standing.device.wheels.each_ref().map(is_locked));
        }
        if !self.actuator.is_late() {
            return None;
        }
        let stays = |wheel: &FlywheelState<S>| match wheel.coupling {
            Coupling::Locked | Coupling::Slipping(_) => release_delay.larger(wheel.dwell) > S::ZERO,
            // Once it is engaged it stays so.
            _ => engagement_delay.larger(wheel.dwell) <= S::ZERO,
        };
        Some(device.wheels.each_ref().map(stays))
    }

    /// Capacity of plates as they meet; infinite of clutches that lock.
    fn plates(&self) -> S {
        self.transmission.parameters.capacity_of(&FlywheelState::default()).0
    }

    /// Whether the terminals of a block that is `standing` have a support that moves otherwise than the ground: clutches stay as they are while such
    /// a block is on one side.
    fn is_carried(&self, standing: &HybridState<S>) -> bool {
        let moves = standing.device.terminals.is_some_and(|terminals| terminals.support != S::ZERO);
        moves && self.transmission.traits().commanded
    }

    /// Impact accumulation: the infinitely many impacts that follow a weak one ([`crate::motion::rest::impact_accumulation`]), with `stuck`
    /// flywheels ([`HybridSystem::stuck`]).
    fn accumulation(&self, standing: &HybridState<S>, stuck: Option<[bool; 2]>, speed: S) -> Accumulation<S> {
        let [(out, starts), (back, _), (farther, _), (home, _)] = ways(standing.motion.side).map(|way| {
            let (rate, starts, _) = self.bounce(standing, stuck, way);
            (rate, starts)
        });
        // As it hits, the block has the flywheels that it has as it falls.
        let hits = if self.transmission.traits().through_impacts { stuck.map_or(1, count) } else { 0 };
        let restitution = self.restitution[hits.min(2) as usize];
        let mut tail = Accumulation::of((out, back), (farther, home), restitution, speed, self.counted_speed);
        if tail.acceleration > S::ZERO {
            tail.acceleration = tail.acceleration.larger(starts.abs());
        }
        if self.follows_swings() && !self.is_carried(standing) { tail } else { tail.without_closings() }
    }

    /// Whether its clutches follow every swing, however short it is.
    fn follows_swings(&self) -> bool {
        self.transmission.traits().commanded && !self.actuator.controlled && !self.actuator.is_late()
    }

    /// A way of such impacts: |θ̈| (rad/s²; inward, 0 where friction holds the block at the top), θ̈ towards the base as it begins, and block and
    /// device then.
    fn bounce(
        &self,
        standing: &HybridState<S>,
        stuck: Option<[bool; 2]>,
        (side, direction): (Sign, Sign),
    ) -> (S, S, HybridState<S>) {
        let ScaledParameters { inertance, rack_coupling, rack_dry, bearing_dry, load_friction, .. } =
            self.transmission.parameters;
        let traits = self.transmission.traits();
        let (carried, inward) = (self.is_carried(standing), direction != side);
        let mut state = if carried { self.sets_out(standing, side, standing.ground) } else { *standing };
        let arm = self.body.arm(&self.body.configuration(side.unit(), S::ZERO));
        let threshold = self.breakaway(&state, side, side);
        // What holds the block without dry friction, which acts against either way of motion.
        let held = -threshold.at(standing.ground) - threshold.dry;
        let locked = match carried {
            true => state.device.wheels.each_ref().map(is_locked),
            // Swings as short as these leave a flywheel behind that slips viscously or hangs on a spring.
            false if self.transmission.slips_viscously() || traits.springs => [false; 2],
            false if traits.permanent => [true, false],
            false => stuck.unwrap_or_else(|| [0, 1].map(|wheel| inward && wheel == wheel_for(direction))),
        };
        let engaged = S::count(count(locked));
        let plates = self.plates();
        // Plates resist the fall, unless their flywheel coasts ahead of it.
        let fastest = self.rest_speed.larger(self.counted_speed);
        let clutched = !carried && stuck.is_none() && plates.is_finite();
        let driven_in = inward && clutched && self.is_ahead(standing, direction, fastest);
        let over = |load: S| {
            let rate = |inertance: S, bearings: S| {
                let inertia = S::ONE + (inertance * (S::ONE + load) + rack_coupling) * arm * arm;
                let dry = arm * (rack_dry + bearings * (S::ONE + load));
                (if inward { held - dry } else { held + dry }) / inertia
            };
            let inertance = engaged * inertance;
            let sticks = rate(inertance, inertance * bearing_dry);
            // Plates pass no more than they can as they meet; outward they push the block.
            let slips = if engaged > S::ZERO && plates.is_finite() {
                rate(S::ZERO, engaged * if inward && !driven_in { plates } else { -plates })
            } else {
                sticks
            };
            (sticks.larger(slips).larger(if inward { S::ZERO } else { S::EPSILON * S::EPSILON }), slips, slips > sticks)
        };
        let (loaded, slips, slip) = over(load_friction);
        // Flywheels keep the speed that an impact takes from the rack, so that plates that are still engaged then slip.
        let struck = !inward && stuck.is_some() && engaged > S::ZERO && plates.is_finite() && self.restitution[0] < S::ONE;
        let slip = slip || struck;
        // Outward the flywheel drives the rack, unless its bearings slow it down faster than the weight does the block.
        let driven = if inward { loaded } else { over(-load_friction).0 };
        for (wheel, locked) in state.device.wheels.iter_mut().zip(locked) {
            wheel.coupling = match wheel.coupling {
                _ if locked && slip => Coupling::Slipping(if driven_in { side } else { side.opposite() }),
                _ if locked => Coupling::Locked,
                Coupling::Locked => Coupling::Open,
                other => other,
            };
            wheel.engaged_for = if slip { S::ZERO } else { wheel.engaged_for };
        }
        state.device.drives = driven > loaded;
        // Friction has the sign of a speed that is nothing beside all others.
        let velocity = direction.times(self.rest_speed * S::EPSILON);
        state.motion = BlockState { direction, velocity, ..standing.motion.uplifted(side) };
        let rate = loaded.larger(driven);
        (rate, if struck { slips } else { rate }, state)
    }

    /// Observation of the ways of impacts that accumulate, up to the one on which friction holds the block.
    fn show_bounces(&self, standing: &HybridState<S>, stuck: Option<[bool; 2]>, time: S, observer: &mut dyn Observer<S>) {
        for (side, direction) in ways(standing.motion.side) {
            let (rate, starts, state) = self.bounce(standing, stuck, (side, direction));
            if rate == S::ZERO {
                return;
            }
            let acceleration = side.opposite().times(starts);
            observer.device_bounce(side, time, &|| self.snapshot(&self.law(&state), &state, &self.place(&state), acceleration));
        }
    }

    /// Signs and modes of a block that has just been released.
    pub(super) fn start(&self, state: &mut HybridState<S>) {
        let inward = state.motion.side.opposite();
        state.motion.terminal_acceleration_sign = inward;
        if state.device.wheels[0].coupling == Coupling::Viscous {
            // What is always engaged has moved with the rack.
            let configuration = self.body.configuration(state.motion.side.unit(), state.motion.rotation);
            state.device.wheels[0].spin = self.body.to_terminal(&configuration, state.motion.velocity);
        }
        self.look_at_drive(state);
        self.look_at_terminals(state);
        if state.motion.velocity == S::ZERO {
            self.turned(state);
        }
        self.settle(state, S::ZERO, &mut ());
        self.command(state, S::ZERO, &mut ());
        if state.motion.velocity == S::ZERO {
            self.turned(state);
        }
    }

    /// A ground segment begins, with the accelerations `ground`: they may have jumped between two of them.
    pub fn ground_at_start(&self, state: &mut HybridState<S>, ground: Accelerations<S>, observer: &mut dyn Observer<S>) {
        let largest = |of: Accelerations<S>| of[0].abs().larger(of[1].abs()).larger(of[2].abs());
        let jump = largest(core::array::from_fn(|i| ground[i % 3] - state.ground[i % 3]));
        state.ground = ground;
        let size = largest(ground).larger(S::EPSILON);
        if state.motion.phase == Phase::Rocking && jump > size * S::EPSILON * S::of(4096.0) {
            self.look_at_drive(state);
            let stood = state.fresh[1];
            state.fresh = [false; GUARDS];
            self.terminals_after_jump(state, stood);
            if state.motion.velocity == S::ZERO {
                self.try_to_set_off(state, S::ZERO, observer);
            }
            self.settle(state, S::ZERO, observer);
            self.command(state, S::ZERO, observer);
        }
    }

    /// Time passes for an idle device.
    pub(super) fn idle(&self, state: &mut HybridState<S>, time: S) {
        for wheel in &mut state.device.wheels {
            self.transmission.parameters.coast(wheel, time);
        }
        state.device.elapse(time);
    }
}
