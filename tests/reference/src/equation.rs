//! Equations of motion: the block about its toe (Eq. 13 to 18 of the paper, and what effects add), flywheels, twists.
//!
//! (λ + (μ_g + nσ)ℓ²) θ̈ = −[(g + v̈_g) sin δ + ü_g cos δ + μ_g ℓ ü_g]/R − ℓF/R − (μ_g + nσ) ℓℓ′ θ̇²
//!
//! with n locked flywheels and F the friction of the rack, the bearings of locked flywheels and the forces of all other links. A flywheel
//! on a support that accelerates by ẍ_s against the ground, as travel of the rack, turns with ẍ − ẍ_s: locked, it pulls σ(ẍ − ẍ_s).
//! In the mesh of rack and pinion the rack also spends μ|F| on each locked flywheel: its force F counts (1 + μ) times where it is along
//! the motion, else (1 − μ) times, and of these two the one that gives F its own sign is true.
//!
//! Flywheels that are not locked: ẇ = F/σ − c w − D sgn w, D = d, and d + b while open. An open clutch drags, F = σ c_d (ẋ − w).

use crate::block::{Block, GRAVITY, Restitution};
use crate::device::{Coupling, Device};
use crate::ground::Ground;
use crate::mode::{BlockMode, Link, State, Wheel};
use crate::scatter::Scatter;
use crate::step::{BEARING, BRAKE, CLUTCH, INPUT, KINEMATICS, RACK, ROTATION, SIZE, SPIN, SUPPORT, TWIST, VELOCITY};
use crate::support::Support;

/// Block, device and ground.
#[derive(Clone, Debug)]
pub struct Model {
    /// The block with what rides on it.
    pub block: Block,
    /// The device.
    pub device: Device,
    /// Where η comes from.
    pub restitution: Restitution,
    /// How impacts differ.
    pub scatter: Scatter,
    /// θ̇⁻ from which an impact has a number, rad/s.
    pub counted: f64,
    /// θ̇ below which an impact may end in rest, rad/s.
    pub rest_speed: f64,
    /// |θ| from which the block does not come back, rad.
    pub overturned: f64,
    /// ü_g.
    pub horizontal: Ground,
    /// v̈_g.
    pub vertical: Ground,
    /// ü_s − ü_g.
    pub support: Support,
}

/// ü_g, v̈_g and ü_s − ü_g, m/s².
#[derive(Clone, Copy, Debug)]
pub struct Shaking {
    /// ü_g.
    pub horizontal: f64,
    /// v̈_g.
    pub vertical: f64,
    /// ü_s − ü_g.
    pub support: f64,
}

/// What a rotation decides.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// sin δ, or δ.
    pub sin: f64,
    /// cos δ, or 1.
    pub cos: f64,
    /// ℓ.
    pub lever: f64,
    /// dℓ/dθ.
    pub slope: f64,
}

impl Model {
    /// The ground at `time`, in the piece that holds `within`.
    pub fn shaking(&self, time: f64, within: f64) -> Shaking {
        let horizontal = self.horizontal.at(time, within);
        let support = self.support.at(time, within, horizontal);
        Shaking { horizontal, vertical: self.vertical.at(time, within), support }
    }

    /// The block at θ on side s.
    pub fn pose(&self, side: f64, rotation: f64) -> Pose {
        let delta = self.block.slenderness * side - rotation;
        let (sin, cos) = self.block.weight_arms(delta);
        let (lever, slope) = self.device.lever.at(side, delta);
        Pose { sin, cos, lever, slope }
    }

    /// Moment of weight and ground, over mR².
    pub fn push(&self, pose: &Pose, shaking: Shaking) -> f64 {
        let ground = shaking.horizontal * (pose.cos + self.device.guided * pose.lever);
        -((GRAVITY + shaking.vertical) * pose.sin + ground) / self.block.size
    }

    /// Moment of the rack and `locked` flywheels that the support drives, over mR². A rack on a support that outruns the ground by a is at
    /// a (1 − r) where the block does not move.
    pub fn support_push(&self, pose: &Pose, shaking: Shaking, locked: f64) -> f64 {
        let Device { inertance, guided, support: ratio, .. } = self.device;
        (locked * inertance * ratio - guided * (1.0 - ratio)) * pose.lever * shaking.support / self.block.size
    }

    /// Acceleration of the terminals against one another by weight, ground and support alone, over R: the `a` of Eq. 10. A flywheel that is
    /// engaged does not change its sign. Where the block stands only the support moves.
    pub fn drive(&self, state: &State, shaking: Shaking) -> f64 {
        let of_support = self.device.support * shaking.support / self.block.size;
        if state.block == BlockMode::Standing && self.support.moves() {
            return -of_support;
        }
        let pose = self.pose(state.side(), state.rotation());
        let centrifugal = self.device.consistent * pose.slope * state.velocity().powi(2);
        let push = self.push(&pose, shaking) + self.support_push(&pose, shaking, 0.0);
        let inertia = self.block.inertia + self.device.guided * pose.lever * pose.lever;
        let acceleration = (push - self.device.guided * pose.lever * centrifugal) / inertia;
        pose.lever * acceleration + centrifugal - of_support
    }

    /// ẋ, the speed of the rack, m/s.
    pub fn rack_speed(&self, pose: &Pose, velocity: f64) -> f64 {
        self.block.size * pose.lever * velocity
    }

    /// ẍ, the acceleration of the rack, m/s².
    pub fn rack_acceleration(&self, pose: &Pose, velocity: f64, acceleration: f64) -> f64 {
        self.block.size * (pose.lever * acceleration + self.device.consistent * pose.slope * velocity * velocity)
    }

    /// F_c and its growth at `time`.
    pub fn capacity(&self, wheel: &Wheel, time: f64) -> (f64, f64) {
        let since = time - wheel.command.engaged_at;
        let full = self.device.capacity;
        // The end of a line is a clock, so that no step sees two.
        let Some([(from, low), (to, high)]) = self.device.line(since) else { return (full, 0.0) };
        let growth = full * (high - low) / (to - from);
        (full * low + growth * (since - from), growth)
    }

    /// D of a flywheel that is not locked, m/s².
    pub fn dry(&self, link: Link) -> f64 {
        if link == Link::Open { self.device.bearing_dry + self.device.brake } else { self.device.bearing_dry }
    }

    /// Force of a link that is not locked on the rack, m/s², where the rack runs ahead of the flywheel by `relative`.
    pub fn link_force(&self, wheel: &Wheel, twist: f64, relative: f64, time: f64) -> f64 {
        match (wheel.link, self.device.coupling) {
            (Link::Slipping(sign) | Link::Saturated(_, sign), _) => sign * self.capacity(wheel, time).0,
            (Link::Contact(side), Coupling::Elastic { stiffness, damping, half_play }) => {
                stiffness * (twist - side * half_play) + damping * relative
            }
            (Link::Dragged, Coupling::Slip { damping, .. }) => damping * relative,
            (Link::Open, Coupling::Rigid | Coupling::Plates) => self.device.drag * relative,
            _ => 0.0,
        }
    }

    /// Rate of the twist at `time`, in a step that began at `start`: the capacity's growth is that of the step, also at its end.
    pub fn twist_rate(&self, wheel: &Wheel, twist: f64, relative: f64, time: f64, start: f64) -> f64 {
        let Coupling::Elastic { stiffness, damping, half_play } = self.device.coupling else { return 0.0 };
        match wheel.link {
            Link::Play | Link::Contact(_) => relative,
            Link::Saturated(side, sign) => {
                let (capacity, growth) = (self.capacity(wheel, time).0, self.capacity(wheel, start).1);
                if damping > 0.0 {
                    (sign * capacity - stiffness * (twist - side * half_play)) / damping
                } else {
                    sign * growth / stiffness
                }
            }
            _ => 0.0,
        }
    }

    /// Force of a locked flywheel on the rack, m/s².
    pub fn locked_force(&self, pose: &Pose, velocity: f64, acceleration: f64, direction: f64) -> f64 {
        let rack = self.rack_speed(pose, velocity);
        let inertia = self.rack_acceleration(pose, velocity, acceleration);
        self.device.inertance * (inertia + self.device.bearing_viscous * rack + self.device.bearing_dry * direction)
    }

    /// θ̈ of a block on its way in `direction`, with `locked` flywheels on the rack and `force` (m/s²) from the other links.
    pub fn acceleration(&self, pose: &Pose, velocity: f64, shaking: Shaking, direction: f64, locked: f64, force: f64) -> f64 {
        let with = |share: f64| self.acceleration_with(pose, velocity, (shaking, direction), locked * (1.0 + share), force);
        let driven = with(self.device.mesh);
        if self.device.mesh == 0.0 || direction * self.locked_force(pose, velocity, driven, direction) >= 0.0 {
            return driven;
        }
        with(-self.device.mesh)
    }

    /// θ̈ where the force of so many locked flywheels counts.
    fn acceleration_with(
        &self,
        pose: &Pose,
        velocity: f64,
        (shaking, direction): (Shaking, f64),
        locked: f64,
        force: f64,
    ) -> f64 {
        let device = &self.device;
        let rack = self.rack_speed(pose, velocity);
        let bearings = locked * device.inertance * (device.bearing_viscous * rack + device.bearing_dry * direction);
        let friction = device.rack_viscous * rack + device.rack_dry * direction;
        let moving = device.guided + locked * device.inertance;
        let centrifugal = device.consistent * moving * pose.lever * pose.slope * velocity * velocity;
        let push = self.push(pose, shaking) + self.support_push(pose, shaking, locked);
        let moment = push - pose.lever * (force + bearings + friction) / self.block.size - centrifugal;
        moment / (self.block.inertia + moving * pose.lever * pose.lever)
    }

    /// ẇ of a flywheel that is not locked, under `force` from its link.
    pub fn spin_rate(&self, wheel: &Wheel, spin: f64, force: f64) -> f64 {
        match wheel.turning {
            None => 0.0,
            Some(sign) => force / self.device.inertance - self.device.bearing_viscous * spin - self.dry(wheel.link) * sign,
        }
    }

    /// Rates of all that is integrated, in the modes of `state`.
    pub fn rates(&self, state: &State, time: f64, values: &[f64; SIZE], shaking: Shaking) -> [f64; SIZE] {
        let device = &self.device;
        let mut rates = [0.0; SIZE];
        let pose = self.pose(state.side(), values[ROTATION]);
        let velocity = values[VELOCITY];
        let rack = self.rack_speed(&pose, velocity);
        let over = 1.0 / (self.block.size * self.block.size);
        let (mut locked, mut total) = (0.0, 0.0);
        for (i, wheel) in state.wheels.iter().enumerate() {
            let (mut spin, twist) = (values[SPIN + i], values[TWIST + i]);
            if wheel.link == Link::Locked {
                (locked, spin) = (locked + 1.0, rack - values[SUPPORT]);
            } else if device.inertance > 0.0 {
                let relative = rack - spin;
                let force = self.link_force(wheel, twist, relative, time);
                let twisting = self.twist_rate(wheel, twist, relative, time, state.time);
                rates[SPIN + i] = self.spin_rate(wheel, spin, force);
                rates[TWIST + i] = twisting;
                rates[CLUTCH] += over * (force * relative - self.spring_force(wheel, twist) * twisting);
                total += force;
            }
            let dry = device.bearing_dry * spin.abs();
            rates[BEARING] += over * device.inertance * (device.bearing_viscous * spin * spin + dry);
            if wheel.link == Link::Open && spin != 0.0 {
                rates[BRAKE] += over * device.inertance * device.brake * spin.abs();
            }
        }
        if let BlockMode::Rocking { direction, .. } = state.block {
            rates[ROTATION] = velocity;
            rates[VELOCITY] = self.acceleration(&pose, velocity, shaking, direction, locked, total);
            let ground = shaking.horizontal * (pose.cos + device.guided * pose.lever) + shaking.vertical * pose.sin;
            rates[INPUT] = (self.support_push(&pose, shaking, 0.0) - ground / self.block.size) * velocity;
            rates[RACK] = over * (device.rack_viscous * rack + device.rack_dry * direction) * rack;
            if device.mesh > 0.0 && locked > 0.0 {
                let held = self.locked_force(&pose, velocity, rates[VELOCITY], direction);
                rates[RACK] += over * device.mesh * locked * held.abs() * rack.abs();
            }
            let moving = device.guided + locked * device.inertance;
            rates[KINEMATICS] = (1.0 - device.consistent) * moving * pose.lever * pose.slope * velocity.powi(3);
        }
        if self.support.moves() {
            // The support's power on the flywheels, whose speed is ẋ − z.
            let (pulled, speed) = (device.support * shaking.support, values[SUPPORT]);
            let held = locked * device.inertance * (self.rack_acceleration(&pose, velocity, rates[VELOCITY]) - pulled);
            rates[SUPPORT] = pulled;
            rates[INPUT] -= over * held * speed;
            let left_out = (1.0 - device.consistent) * locked * device.inertance * pose.slope * velocity * velocity;
            rates[KINEMATICS] -= left_out * speed / self.block.size;
        }
        rates
    }

    /// K (z − z₀) of a clutch on its spring.
    pub fn spring_force(&self, wheel: &Wheel, twist: f64) -> f64 {
        match (wheel.link, self.device.coupling) {
            (Link::Contact(side) | Link::Saturated(side, _), Coupling::Elastic { stiffness, half_play, .. }) => {
                stiffness * (twist - side * half_play)
            }
            _ => 0.0,
        }
    }
}
