//! What each event does (`docs/modes.md`), and the way on from an instant.

use crate::consistent::{solve, way_of};
use crate::device::Coupling;
use crate::equation::{Model, Shaking};
use crate::guard::Guard;
use crate::ledger::energy;
use crate::mode::{BlockMode, Link, State};
use crate::step::{BRAKE, IMPACT, INPUT, ROTATION, SPIN, VELOCITY};

/// Answers to one instant: a jolt may change the signs that caused it.
const MOST_ANSWERS: usize = 8;
/// Ways on that are looked at where one clutch lets the block go and another stops it.
const MOST_TURNS: usize = 3;
/// Moments (1/s²) of links up to which they do not lift a block.
const NO_PUSH: f64 = 1e-12;

impl Model {
    /// A guard has reached zero.
    pub fn answer(&self, state: &mut State, guard: Guard, shaking: Shaking) {
        match guard {
            Guard::Impact => return self.impact(state, shaking),
            Guard::Turn => {
                state.values[VELOCITY] = 0.0;
                self.follow_rack(state);
            }
            Guard::Overturn => state.block = BlockMode::Overturned,
            Guard::Command => state.drive = -state.drive,
            Guard::Terminals => state.terminals = -state.terminals,
            Guard::Load => {
                state.load = -state.load;
                return;
            }
            Guard::Retire => self.part_at_rest(state),
            Guard::Join(i) => state.values[SPIN + i] = self.rack_now(state),
            Guard::Stop(i) => state.values[SPIN + i] = 0.0,
            Guard::Touch(i) => {
                // Beyond the edge by less than the clock resolves.
                let twist = state.twist(i);
                state.wheels[i].link = Link::Contact(twist.signum());
            }
            Guard::Loosen(i) => state.wheels[i].link = Link::Play,
            Guard::Slip(i) | Guard::Part(i) => state.slipped = Some(i),
            Guard::Leave | Guard::Start(_) | Guard::Saturate(_) | Guard::Hold(_) => {}
        }
        self.settle(state, shaking);
        state.slipped = None;
    }

    /// θ = 0, and what that loses: a flywheel that an ideal clutch lets go at the impact takes no part in it, so that its brake has all of
    /// its energy.
    fn impact(&self, state: &mut State, shaking: Shaking) {
        let before = state.clone();
        let taken = self.strike(state, shaking);
        for i in (0..2).filter(|&i| before.wheels[i].link == Link::Locked) {
            if state.wheels[i].link != Link::Open {
                // The impulse of the flywheel on its support, which has the speed z = ẋ − v, does work there.
                let impulse = self.device.inertance * (state.spin(i) - before.spin(i));
                let work = -impulse * (self.rack_now(&before) - before.spin(i)) / self.block.size.powi(2);
                state.values[IMPACT] += work;
                state.values[INPUT] += work;
            } else if self.device.coupling == Coupling::Ideal {
                state.values[IMPACT] -= taken[i];
                state.values[BRAKE] += taken[i];
            }
        }
    }

    /// θ̇⁺ = η θ̇⁻. What is locked by a clutch that only locks keeps the rack's speed, all else its own. Returns what each flywheel loses by
    /// that, 1/s².
    fn strike(&self, state: &mut State, shaking: Shaking) -> [f64; 2] {
        let spins = [state.spin(0), state.spin(1)];
        state.values[ROTATION] = 0.0;
        let locked = state.wheels.iter().filter(|wheel| wheel.link == Link::Locked).count();
        let before = energy(self, state);
        let direction = state.velocity().signum();
        let counted = if self.device.only_locks() { locked } else { 0 };
        let mut restitution = self.device.restitution(&self.block, self.restitution, counted);
        if state.velocity().abs() >= self.counted {
            state.impacts += 1;
            restitution = self.scatter.drawn(state.impacts, restitution);
        }
        state.values[VELOCITY] *= restitution;
        state.weak = state.velocity().abs() <= self.counted;
        state.block = BlockMode::Rocking { side: direction, direction };
        if self.device.only_locks() {
            self.follow_rack(state);
        } else if state.velocity() != 0.0 {
            for i in 0..2 {
                if state.wheels[i].link == Link::Locked {
                    state.wheels[i].link = match self.device.coupling {
                        Coupling::Overrunning => Link::Open,
                        _ => Link::Slipping(1.0),
                    };
                }
            }
        }
        state.values[IMPACT] += before - energy(self, state);
        let half = 0.5 * self.device.inertance / (self.block.size * self.block.size);
        let taken = [0, 1].map(|i| half * (spins[i] * spins[i] - state.spin(i) * state.spin(i)));
        self.take_terminals(state);
        self.look_at_drive(state, shaking);
        if state.velocity().abs() <= self.rest_speed {
            let mut rest = state.clone();
            let before = energy(self, &rest);
            rest.values[VELOCITY] = 0.0;
            rest.weak = false;
            self.follow_rack(&mut rest);
            rest.values[IMPACT] += before - energy(self, &rest);
            self.take_terminals(&mut rest);
            rest.block = BlockMode::Standing;
            self.part_at_rest(&mut rest);
            let mut parted = rest.clone();
            self.settle(&mut rest, shaking);
            if rest.block == BlockMode::Standing {
                *state = rest;
                if self.follows_terminals() && !self.device.is_late() {
                    // Within the bounces before rest they have let go.
                    self.part(&mut parted);
                    self.settle(&mut parted, shaking);
                    *state = parted;
                }
                return taken;
            }
        }
        self.settle(state, shaking);
        taken
    }

    /// Takes the sign of Eq. 10's acceleration as it is; where it is zero, as it was.
    pub fn look_at_drive(&self, state: &mut State, shaking: Shaking) {
        let drive = self.drive(state, shaking);
        if drive != 0.0 {
            state.drive = drive.signum();
        }
        state.armed = true;
    }

    /// Leaves a state in modes that are consistent with one another.
    pub fn settle(&self, state: &mut State, shaking: Shaking) {
        for _ in 0..MOST_ANSWERS {
            if state.block == BlockMode::Overturned {
                return;
            }
            // Commands need a direction of motion; those that were given before have their clocks.
            if state.direction().is_none() {
                self.command_at_rest(state, shaking);
                if state.direction().is_some() {
                    // A jolt has set a held block in motion.
                    self.look_at_drive(state, shaking);
                }
            }
            self.settle_springs(state);
            self.catch_up(state);
            if state.velocity() == 0.0 {
                self.way_on(state, shaking);
            }
            if let Some(direction) = state.direction() {
                let found = solve(self, state, shaking, direction);
                for i in 0..2 {
                    state.wheels[i].link = found.links[i];
                }
                self.follow_rack(state);
                self.look_at_load(state, found.acceleration, direction);
            } else {
                self.stick_at_rest(state);
            }
            self.settle_flywheels(state, shaking);
            let Some(direction) = state.direction().filter(|_| self.device.is_commanded()) else { return };
            let velocity = state.velocity();
            if !self.command(state) {
                return;
            }
            // A jolt that only slows the block down keeps the sign that asked for it.
            if state.direction() != Some(direction) {
                self.look_at_drive(state, shaking);
            } else if state.velocity() != velocity {
                state.armed = state.drive * self.drive(state, shaking) > 0.0;
            }
        }
    }

    /// The sign of the force of what is locked; a rack that sets out drives.
    fn look_at_load(&self, state: &mut State, acceleration: f64, direction: f64) {
        let pose = self.pose(state.side(), state.rotation());
        let force = self.locked_force(&pose, state.velocity(), acceleration, direction);
        state.load = if state.velocity() != 0.0 && direction * force < 0.0 { -1.0 } else { 1.0 };
    }

    /// Nothing slips on a rack that stands, once it stands too.
    fn stick_at_rest(&self, state: &mut State) {
        for i in 0..2 {
            if matches!(state.wheels[i].link, Link::Slipping(_)) && state.spin(i) == 0.0 {
                state.wheels[i].link = Link::Locked;
            }
        }
    }

    /// An overrunning clutch that the rack would overtake exchanges momentum: only at the start of a run with a velocity.
    fn catch_up(&self, state: &mut State) {
        if self.device.coupling != Coupling::Overrunning {
            return;
        }
        for i in 0..2 {
            if state.wheels[i].link == Link::Open && way_of(i) * (state.spin(i) - self.rack_now(state)) < 0.0 {
                if state.velocity() == 0.0 {
                    // A rack that stands has stopped it; what it had is rounding.
                    state.values[SPIN + i] = 0.0;
                } else {
                    self.jolt(state, i);
                }
            }
        }
    }

    /// From θ̇ = 0. The block goes where it accelerates, both with its clutches as they are and with what going there makes
    /// engage or release at once; where it goes nowhere it stands or is held. What a release sets free may go the other way:
    /// then that way is looked at, and a clutch that contradicts itself both ways holds the block as it was.
    fn way_on(&self, state: &mut State, shaking: Shaking) {
        let stands = state.rotation() == 0.0;
        state.block = if stands { BlockMode::Standing } else { BlockMode::Held { side: state.rotation().signum() } };
        if !stands {
            self.look_at_drive(state, shaking);
        }
        let mut now = state.clone();
        let mut way = self.way_of_block(&now, shaking);
        for _ in 0..MOST_TURNS {
            if way == 0.0 {
                break;
            }
            let going = self.going(&now, way, shaking);
            let next = self.way_of_block(&going, shaking);
            if going.velocity() != 0.0 || next == way {
                *state = going;
                return;
            }
            (now, way) = (going, next);
        }
        let engaged_and_slips = |i: usize| now.wheels[i].link != Link::Open && now.spin(i) != 0.0;
        // Held by the bearings of what has just engaged; on its base also by plates until they have stopped a flywheel that spins the
        // wrong way.
        if way == 0.0 || (stands && (engaged_and_slips(0) || engaged_and_slips(1))) {
            let block = state.block;
            *state = now;
            state.block = block;
        }
    }

    /// The direction in which a block at θ̇ = 0 accelerates, or 0.
    pub fn way_of_block(&self, state: &State, shaking: Shaking) -> f64 {
        let goes = |way: f64| way * solve(self, state, shaking, way).acceleration > 0.0;
        [1.0, -1.0].into_iter().find(|way| goes(*way)).unwrap_or(0.0)
    }

    /// `state` as it would be on its way in `direction`: with what that makes engage or release at once.
    fn going(&self, state: &State, direction: f64, shaking: Shaking) -> State {
        let mut going = state.clone();
        let mut side = state.side();
        if state.rotation() == 0.0 {
            (side, going.drive, going.armed) = (direction, direction, true);
        }
        going.block = BlockMode::Rocking { side, direction };
        if self.follows_terminals() {
            // What lifts the block is not what moves the terminals.
            going.drive = state.drive;
            self.look_at_drive(&mut going, shaking);
            self.look_at_terminals(&mut going, shaking);
        } else if state.rotation() == 0.0 && direction * self.link_push(&going) > NO_PUSH {
            // It may rise against the acceleration that weight and ground alone would give it.
            self.look_at_drive(&mut going, shaking);
        }
        if self.device.is_commanded() {
            self.command(&mut going);
            self.settle_springs(&mut going);
        }
        going
    }

    /// Moment of the links on a block at θ̇ = 0, over mR².
    fn link_push(&self, state: &State) -> f64 {
        let lever = self.pose(state.side(), state.rotation()).lever;
        let force = |i: usize| self.link_force(&state.wheels[i], state.twist(i), -state.spin(i), state.time);
        -lever * (force(0) + force(1)) / self.block.size
    }

    /// How much what pushes a standing block to one side exceeds its weight and the rack's friction, with open clutches.
    pub fn open_readiness(&self, state: &State, shaking: Shaking) -> f64 {
        let mut open = state.clone();
        for wheel in &mut open.wheels {
            wheel.link = Link::Open;
        }
        self.readiness(&open, shaking)
    }

    /// How much what pushes a block at rest exceeds what holds it, as the angular acceleration that it would have; negative
    /// while it stays.
    pub fn readiness(&self, state: &State, shaking: Shaking) -> f64 {
        let ready = |way: f64| way * solve(self, state, shaking, way).acceleration;
        ready(1.0).max(ready(-1.0))
    }
}
