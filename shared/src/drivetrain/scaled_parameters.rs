//! Drivetrain parameters in the units of the equations: forces over λmR, lengths over R, inertance over λm.

use super::clutch_state::{Coupling, DeviceState, FlywheelState, ModeCoefficients};
use super::rise::{Line, whole};
use crate::equation::Accelerations;
use crate::math::root::bisection;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::structure::block::Block;
use crate::structure::drivetrain::{Drivetrain, Engagement, Support};

/// Drivetrain parameters in the units of the equations; all zero without a device.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScaledParameters<S> {
    /// k = σ/λ of one flywheel.
    pub inertance: S,
    /// 1/k, or 0 without inertance.
    pub mobility: S,
    /// Guided rack: its mass ratio over λ …
    pub rack_coupling: S,
    /// … and its inertia force over ü_g/g while the block stands, 1/s².
    pub rack_push: S,
    /// Push of a support of its own motion, through a locked flywheel, on the rack: k n (ü_s − ü_g)/R over ü_g/g, which is
    /// σ n (f − 1) p²; 1/s².
    pub support_push: S,
    /// That of a support whose motion comes beside the ground's, over (ü_s − ü_g)/g: σ n p²; 1/s².
    pub relative_push: S,
    /// Viscous force of the rack, 1/s.
    pub rack_viscous: S,
    /// Dry friction of the rack, 1/s².
    pub rack_dry: S,
    /// Friction of rack and pinion over the force in the mesh.
    pub load_friction: S,
    /// Viscous rate of a flywheel, 1/s.
    pub bearing_rate: S,
    /// Dry deceleration of a flywheel, 1/s².
    pub bearing_dry: S,
    /// Deceleration by the brake, 1/s².
    pub brake: S,
    /// The brake stops a released flywheel at once.
    pub stops_at_once: bool,
    /// Capacity of the plates, 1/s²; infinite without plates.
    pub capacity: S,
    /// Their capacity at first contact, 1/s²: large enough to distinguish stick from slip there.
    pub contact: S,
    /// Time to full capacity, s.
    pub rise_time: S,
    /// Time constant of an exponential rise ([`super::rise`]), s; 0 of a linear one.
    pub time_constant: S,
    /// Stiffness of the clutch, 1/s².
    pub stiffness: S,
    /// Damping of an elastic clutch or of viscous slip, 1/s.
    pub damping: S,
    /// Drag of an open clutch over the difference of the speeds, 1/s.
    pub drag: S,
    /// Half the play over R.
    pub half_play: S,
}

/// A growing `value` (0 or more) where it is compared with what it shall exceed: the instant at which both are equal but for rounding
/// counts as past it.
fn rounded_up<S: Real>(value: S) -> S {
    value * (S::ONE + S::EPSILON * S::of(16.0))
}

impl<S: Real> ScaledParameters<S> {
    /// Of `block`, which weighs `heavier` times as much as the one that the drivetrain's ratios refer to, with σ of its own, on a support
    /// that moves with the ground.
    pub fn of(drivetrain: &Drivetrain, block: &Block, mass_ratio: f64, heavier: f64) -> ScaledParameters<S> {
        let (lambda, size, p2) = (block.inertia_ratio(), block.size(), block.frequency_parameter_squared());
        let k = mass_ratio / lambda;
        let Drivetrain { engagement, flywheel, rack, actuation, .. } = drivetrain;
        let stops_at_once = flywheel.brake_deceleration.is_infinite() || *engagement == Engagement::Ideal;
        let (mut capacity, mut stiffness, mut damping, mut half_play) = (f64::INFINITY, 0.0, 0.0, 0.0);
        match *engagement {
            Engagement::Friction { capacity_ratio } => capacity = capacity_ratio * p2 / heavier,
            Engagement::Elastic { stiffness: spring, damping: c, backlash, capacity_ratio } => {
                (stiffness, damping, half_play) = (spring / (lambda * heavier), c / (lambda * heavier), 0.5 * backlash / size);
                capacity = capacity_ratio * p2 / heavier;
            }
            Engagement::Viscous { corner_frequency } => damping = k * core::f64::consts::TAU * corner_frequency,
            Engagement::Ideal | Engagement::Rigid | Engagement::Overrunning => {}
        }
        let time_constant = S::of(actuation.time_constant);
        // ε^¾: far above rounding, far below what matters.
        let little = S::EPSILON.square_root() * S::EPSILON.square_root().square_root();
        ScaledParameters {
            inertance: S::of(k),
            mobility: S::of(if k > 0.0 { 1.0 / k } else { 0.0 }),
            rack_coupling: S::of(rack.guided_mass_ratio / (lambda * heavier)),
            rack_push: S::of(rack.guided_mass_ratio * p2 / heavier),
            support_push: S::ZERO,
            relative_push: S::ZERO,
            rack_viscous: S::of(rack.viscous / (lambda * heavier)),
            rack_dry: S::of(rack.dry_ratio * p2 / heavier),
            load_friction: S::of(rack.load_friction),
            bearing_rate: S::of(flywheel.viscous_rate),
            bearing_dry: S::of(flywheel.dry_deceleration / size),
            brake: S::of(if stops_at_once { 0.0 } else { flywheel.brake_deceleration / size }),
            stops_at_once,
            capacity: S::of(capacity),
            contact: S::of(if actuation.rise_time + actuation.time_constant > 0.0 { capacity } else { 0.0 }) * little,
            rise_time: if actuation.time_constant > 0.0 { whole(time_constant) } else { S::of(actuation.rise_time) },
            time_constant,
            stiffness: S::of(stiffness),
            damping: S::of(damping),
            drag: S::of(k * flywheel.drag_rate),
            half_play: S::of(half_play),
        }
    }

    /// On `support`, which moves horizontally; `ratio` is that of [`Mount::support_ratio`]. The rack rides on the support: with n of the
    /// ratio it accelerates by ü_s + n (ẍ − (ü_s − ü_g)).
    ///
    /// [`Mount::support_ratio`]: crate::structure::mount::Mount::support_ratio
    pub fn on_support(self, support: Support, mass_ratio: f64, ratio: f64, p2: f64) -> ScaledParameters<S> {
        ScaledParameters {
            rack_push: self.rack_push * S::of(1.0 + (1.0 - ratio) * (support.amplification - 1.0)),
            support_push: S::of(mass_ratio * ratio * (support.amplification - 1.0) * p2),
            relative_push: S::of(if support.given_apart { mass_ratio * ratio * p2 } else { 0.0 }),
            ..self
        }
    }

    /// Whether the support moves otherwise than the ground.
    pub fn support_moves(&self) -> bool {
        self.support_push != S::ZERO || self.relative_push != S::ZERO
    }

    /// Acceleration of the support's terminals against the ground, over ü_g/g and over (ü_s − ü_g)/g: n (f − 1) and n of g/R; 1/s².
    pub fn support_rates(&self) -> [S; 2] {
        [self.support_push * self.mobility, self.relative_push * self.mobility]
    }

    /// Push of the support through one locked flywheel, under the accelerations `ground`; 1/s².
    pub fn support_force(&self, ground: Accelerations<S>) -> S {
        let force = self.support_push * ground[0];
        if self.relative_push == S::ZERO { force } else { force + self.relative_push * ground[2] }
    }

    /// Capacity now and its growth.
    pub fn capacity_of(&self, wheel: &FlywheelState<S>) -> (S, S) {
        let Some(Line { time: [from, to], share: [low, high] }) = self.line_at(wheel.engaged_for) else {
            return (self.capacity, S::ZERO);
        };
        let all = self.capacity - self.contact;
        let growth = all * (high - low) / (to - from);
        (self.contact + all * low + growth * (wheel.engaged_for - from), growth)
    }

    /// Adds rack, bearings, brakes and plates to the coefficients of a direction.
    // Once for all kinds.
    #[inline(never)]
    pub fn complete(&self, law: &mut ModeCoefficients<S>, device: &DeviceState<S>) {
        (law.coupling, law.push.ground) = (self.rack_coupling, self.rack_push);
        (law.viscous, law.dry) = (self.rack_viscous, self.rack_dry);
        for (i, wheel) in device.wheels.iter().enumerate() {
            if wheel.coupling == Coupling::Locked {
                law.coupling = law.coupling + self.inertance;
                law.push.ground = law.push.ground - self.support_push;
                if self.relative_push != S::ZERO {
                    law.push.support = Some(law.push.support.unwrap_or(S::ZERO) - self.relative_push);
                }
                law.viscous = law.viscous + self.inertance * self.bearing_rate;
                law.dry = law.dry + self.inertance * self.bearing_dry;
                continue;
            }
            if let Some(turning) = wheel.turning {
                let brake = if wheel.coupling.is_engaged() { S::ZERO } else { self.brake };
                law.decay[i] = self.bearing_rate;
                law.drag[i] = turning.times(self.bearing_dry + brake);
                law.moves[i] = S::ONE;
            }
            if let Some(sign) = wheel.coupling.slip_sign() {
                let (capacity, growth) = self.capacity_of(wheel);
                (law.slip[i], law.slip_growth[i]) = (sign.times(capacity), sign.times(growth));
            }
        }
        law.dry = law.direction * law.dry;
    }

    /// Dry friction at the rack of a standing flywheel that is coupled to it, and its growth: that of the bearings, as far as the
    /// plates transmit it; 1/s² and 1/s³.
    pub fn standing_friction(&self, wheel: &FlywheelState<S>) -> (S, S) {
        if self.overcomes_bearings(wheel) { (self.inertance * self.bearing_dry, S::ZERO) } else { self.capacity_of(wheel) }
    }

    /// Whether plates transmit what starts a standing flywheel.
    pub fn overcomes_bearings(&self, wheel: &FlywheelState<S>) -> bool {
        self.inertance * self.bearing_dry <= rounded_up(self.capacity_of(wheel).0)
    }

    /// Deceleration of an idle or engaged flywheel by dry friction, 1/s².
    pub fn dry_of(&self, wheel: &FlywheelState<S>) -> S {
        if wheel.coupling.is_engaged() { self.bearing_dry } else { self.bearing_dry + self.brake }
    }

    /// Decides which way a flywheel turns on which `force` (1/s²) acts: a standing one starts only beyond its dry friction. Without any it
    /// is never held, or it would miss the first of a force that grows from zero.
    pub fn settle(&self, wheel: &mut FlywheelState<S>, force: S) {
        let dry = self.inertance * self.dry_of(wheel);
        wheel.turning = if wheel.spin > S::ZERO {
            Some(Sign::Positive)
        } else if wheel.spin < S::ZERO {
            Some(Sign::Negative)
        } else if force.abs() > dry || dry == S::ZERO {
            Some(Sign::of(force, Sign::Positive))
        } else {
            None
        };
    }

    /// When an idle flywheel stops (s), if that is within `time` (s) but not at its end; to the resolution of the clock.
    #[inline(never)]
    pub fn stops_within(&self, wheel: &FlywheelState<S>, time: S) -> Option<S> {
        let stopped = |after: S| {
            let mut wheel = *wheel;
            self.coast(&mut wheel, after);
            wheel.spin == S::ZERO
        };
        if wheel.spin == S::ZERO || !stopped(time) {
            return None;
        }
        let high = bisection(S::ZERO, time, S::ZERO, stopped);
        (high < time).then_some(high)
    }

    /// Dashpot between rack and flywheel, its force over the difference of their speeds: of viscous slip, or the drag of an open clutch; 1/s.
    pub fn dashpot(&self, wheel: &FlywheelState<S>) -> S {
        match wheel.coupling {
            Coupling::Open => self.drag,
            Coupling::Viscous => self.damping,
            Coupling::Locked | Coupling::Slipping(_) | Coupling::InPlay | Coupling::Elastic(_) | Coupling::Saturated(_) => {
                S::ZERO
            }
        }
    }

    /// Viscous rate of a flywheel while the rack stands, 1/s: its bearings, and its dashpot.
    pub fn slowing_rate(&self, wheel: &FlywheelState<S>) -> S {
        self.bearing_rate + self.dashpot(wheel) * self.mobility
    }

    /// What a flywheel has left of its speed after `time` (s) while the rack stands: ẇ = −c w − d sgn w in closed form, never past
    /// zero.
    #[inline(never)]
    pub fn coast(&self, wheel: &mut FlywheelState<S>, time: S) {
        if wheel.coupling == Coupling::Locked || wheel.spin == S::ZERO {
            return;
        }
        // The plates of a rack that stands brake it too.
        let slips = matches!(wheel.coupling, Coupling::Slipping(_));
        // A rising capacity counts with its mean.
        let halfway = FlywheelState { engaged_for: wheel.engaged_for + S::HALF * time, ..*wheel };
        let plates = if slips { self.capacity_of(&halfway).0 * self.mobility } else { S::ZERO };
        let (c, d) = (self.slowing_rate(wheel), self.dry_of(wheel) + plates);
        let speed = wheel.spin.abs();
        let x = c * time;
        // (1 − e^−x)/x, where the difference would lose its digits.
        let mean = if x < S::of(1e-3) {
            S::ONE - x * (S::HALF - x * (S::of(1.0 / 6.0) - x * S::of(1.0 / 24.0)))
        } else {
            (S::ONE - (-x).exp()) / x
        };
        let left = speed * (S::ONE - x * mean) - d * time * mean;
        let sign = Sign::of(wheel.spin, Sign::Positive);
        wheel.spin = if left > S::ZERO { sign.times(left) } else { S::ZERO };
        wheel.turning = if left > S::ZERO { Some(sign) } else { None };
        if slips && left <= S::ZERO {
            wheel.coupling = Coupling::Locked;
        }
    }
}
