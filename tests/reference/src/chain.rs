//! What an instant does to the clutches: commands carried out, springs and plates settled, flywheels started and held.

use crate::actuation::give;
use crate::device::Coupling;
use crate::equation::{Model, Shaking};
use crate::ledger::energy;
use crate::mode::{BlockMode, Link, State, wheel_for};
use crate::step::{BRAKE, CLUTCH, CREATED, SPIN, TWIST, VELOCITY};

impl Model {
    /// Speed of the rack now.
    pub fn rack_now(&self, state: &State) -> f64 {
        self.rack_speed(&self.pose(state.side(), state.rotation()), state.velocity())
    }

    /// Locked flywheels have the rack's speed, against that of the support.
    pub fn follow_rack(&self, state: &mut State) {
        let speed = self.terminals_now(state);
        for i in 0..2 {
            if state.wheels[i].link == Link::Locked {
                state.values[SPIN + i] = speed;
            }
        }
    }

    /// Commands by Eq. 10 for the present direction of block or terminals, and all that is due. Returns whether a clutch moved.
    pub fn command(&self, state: &mut State) -> bool {
        let followed = if self.follows_terminals() { Some(state.terminals) } else { state.direction() };
        let speed = state.velocity().abs().max(state.rotation().abs() * self.block.frequency_parameter());
        state.weak &= speed <= self.counted;
        if !state.weak {
            state.wheels.iter_mut().for_each(|wheel| wheel.lent = 0.0);
        }
        if let Some(direction) = followed {
            let resists = state.drive == direction;
            for i in 0..2 {
                give(&self.device, state, i, resists && i == wheel_for(direction));
            }
        }
        self.carry_out(state)
    }

    /// Commands whose time has come. Releases first, so that two that change places are never both engaged.
    pub fn carry_out(&self, state: &mut State) -> bool {
        let mut moved = false;
        // By a transport delay several commands to one clutch may be due at once.
        let due = |state: &State| state.wheels.iter().any(|wheel| wheel.command.arrives(&self.device, state.time).is_some());
        while due(state) {
            for engage in [false, true] {
                for i in 0..2 {
                    let wheel = &mut state.wheels[i];
                    if wheel.command.arrives(&self.device, state.time) != Some(engage) {
                        continue;
                    }
                    let moves = engage == (wheel.link == Link::Open);
                    wheel.command.done(&self.device, state.time, moves);
                    match (moves, engage) {
                        (false, _) => continue,
                        (true, true) => self.engage(state, i),
                        (true, false) => self.release(state, i),
                    }
                    moved = true;
                }
            }
        }
        moved
    }

    fn engage(&self, state: &mut State, i: usize) {
        let before = energy(self, state);
        match self.device.coupling {
            Coupling::Ideal => {
                state.wheels[i].link = Link::Locked;
                self.follow_rack(state);
                let created = energy(self, state) - before;
                state.values[CREATED] += created;
                state.wheels[i].lent = if state.weak { created } else { 0.0 };
            }
            Coupling::Plates => state.wheels[i].link = Link::Slipping((self.rack_now(state) - state.spin(i)).signum()),
            Coupling::Elastic { half_play, .. } => {
                state.values[TWIST + i] = 0.0;
                state.wheels[i].link = if half_play > 0.0 { Link::Play } else { Link::Contact(1.0) };
            }
            Coupling::Slip { .. } => state.wheels[i].link = Link::Dragged,
            _ => self.jolt(state, i),
        }
    }

    /// Block and flywheel exchange momentum: (λ + (K + σ)ℓ²) θ̇⁺ = (λ + Kℓ²) θ̇⁻ + σℓ w/R, K what is locked already.
    pub fn jolt(&self, state: &mut State, i: usize) {
        let before = energy(self, state);
        let pose = self.pose(state.side(), state.rotation());
        let locked = state.wheels.iter().filter(|wheel| wheel.link == Link::Locked).count() as f64;
        let square = pose.lever * pose.lever;
        let inertia = self.block.inertia + (self.device.guided + locked * self.device.inertance) * square;
        let momentum = inertia * state.velocity() + self.device.inertance * pose.lever * state.spin(i) / self.block.size;
        let mut velocity = momentum / (inertia + self.device.inertance * square);
        if self.device.mesh > 0.0 {
            velocity = self.rack_after_impulses(pose.lever * self.block.size * state.velocity(), state.spin(i), locked, square)
                / (pose.lever * self.block.size);
        }
        state.values[VELOCITY] = velocity;
        state.wheels[i].link = Link::Locked;
        if let (BlockMode::Rocking { side, .. } | BlockMode::Held { side }, true) = (state.block, velocity != 0.0) {
            let direction = velocity.signum();
            let side = if state.rotation() == 0.0 { direction } else { side };
            state.block = BlockMode::Rocking { side, direction };
        }
        self.follow_rack(state);
        state.values[CLUTCH] += before - energy(self, state);
    }

    /// ẋ once a flywheel of speed `spin` has the speed of the rack, with the friction of the mesh: impulse by impulse, each until the speeds are
    /// equal or the rack stops and its friction turns. `square` is ℓ².
    fn rack_after_impulses(&self, rack: f64, spin: f64, locked: f64, square: f64) -> f64 {
        let (mut rack, mut spin) = (rack, spin);
        for _ in 0..3 {
            let relative = rack - spin;
            if relative == 0.0 {
                break;
            }
            let way = if rack != 0.0 { rack.signum() } else { spin.signum() };
            // The flywheel that joins loads the rack along its way or against it, and those that move with the rack do the opposite.
            let load = self.device.mesh * way * relative.signum();
            let mass = self.block.inertia / square + self.device.guided + locked * self.device.inertance * (1.0 - load);
            let (slows, speeds) = ((1.0 + load) / mass, 1.0 / self.device.inertance);
            let equal = relative.abs() / (slows + speeds);
            let stop = if rack * relative > 0.0 { rack.abs() / slows } else { f64::INFINITY };
            let impulse = relative.signum() * equal.min(stop);
            spin += impulse * speeds;
            rack = if stop < equal { 0.0 } else { rack - impulse * slows };
            if stop >= equal {
                break;
            }
        }
        rack
    }

    fn release(&self, state: &mut State, i: usize) {
        let before = energy(self, state);
        state.values[TWIST + i] = 0.0;
        state.wheels[i].link = Link::Open;
        state.values[CLUTCH] += before - energy(self, state);
        if self.device.coupling == Coupling::Ideal || self.device.brake.is_infinite() {
            let before = energy(self, state);
            state.values[SPIN + i] = 0.0;
            let gone = before - energy(self, state);
            let lent = std::mem::take(&mut state.wheels[i].lent).min(gone);
            state.values[CREATED] -= lent;
            state.values[BRAKE] += gone - lent;
        }
    }

    /// The clutches of a standing block are open and not commanded, but for those that follow the terminals.
    pub fn part_at_rest(&self, state: &mut State) {
        if !self.follows_terminals() {
            self.part(state);
        }
    }

    /// Opens the clutches, and withdraws their commands.
    pub fn part(&self, state: &mut State) {
        for i in 0..2 {
            if self.device.is_commanded() {
                let command = &mut state.wheels[i].command;
                command.withdraw();
                if state.wheels[i].link != Link::Open {
                    self.release(state, i);
                }
            } else if self.device.coupling == Coupling::Overrunning {
                state.wheels[i].link = Link::Open;
            }
        }
    }

    /// Springs and the plates in series with them: the force without slip decides.
    pub fn settle_springs(&self, state: &mut State) {
        let Coupling::Elastic { stiffness, damping, half_play } = self.device.coupling else { return };
        let rack = self.rack_now(state);
        for i in 0..2 {
            let relative = rack - state.spin(i);
            let twist = state.twist(i);
            let (capacity, growth) = self.capacity(&state.wheels[i], state.time);
            let side = match state.wheels[i].link {
                Link::Contact(side) | Link::Saturated(side, _) => side,
                Link::Play if twist.abs() >= half_play && twist * relative > 0.0 => twist.signum(),
                _ => continue,
            };
            let force = stiffness * (twist - side * half_play) + damping * relative;
            let slips = if damping > 0.0 {
                force.abs() > capacity
            } else {
                // Without a damper the force at the limit is the capacity itself: the rates decide.
                force.abs() >= capacity * (1.0 - 1e-12) && force.signum() * stiffness * relative > growth
            };
            let sign = force.signum();
            state.wheels[i].link = match slips {
                false => Link::Contact(side),
                // Teeth that a damper pulls apart with such a force have parted.
                true if half_play > 0.0 && sign != side => {
                    let before = energy(self, state);
                    state.values[TWIST + i] = side * half_play;
                    state.wheels[i].link = Link::Play;
                    state.values[CLUTCH] += before - energy(self, state);
                    Link::Play
                }
                true => Link::Saturated(side, sign),
            };
        }
    }

    /// Which way flywheels turn that are not locked, and which are held by their friction.
    pub fn settle_flywheels(&self, state: &mut State, _shaking: Shaking) {
        let rack = self.rack_now(state);
        for i in 0..2 {
            let wheel = state.wheels[i];
            let (spin, dry) = (state.spin(i), self.dry(wheel.link));
            if wheel.link == Link::Locked {
                continue;
            }
            let force = self.link_force(&wheel, state.twist(i), rack - spin, state.time);
            let idle = wheel.link == Link::Open && (self.device.coupling == Coupling::Ideal || dry.is_infinite());
            state.wheels[i].turning = if spin != 0.0 {
                Some(spin.signum())
            } else if idle || self.device.inertance == 0.0 || (dry > 0.0 && force.abs() <= self.device.inertance * dry) {
                None
            } else {
                Some(if force == 0.0 { 1.0 } else { force.signum() })
            };
        }
    }
}
