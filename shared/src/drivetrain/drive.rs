//! What every kind of device is to the engine: forces between events, functions to watch, and what to do at an event.

use super::clutch_state::{Coupling, Device, Law, Watch};
use super::gears::Gears;
use super::power_loss::Spent;
use crate::equation::any_body::AnyBody;
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::value::Value;

/// The forces on one instant of a smooth motion, as an equation sees them: `V` is a number or a power series.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a, S, B, P, V, const X: usize> {
    /// The block.
    pub body: &'a B,
    /// The mode.
    pub law: &'a Law<S>,
    /// What θ decides.
    pub posture: P,
    /// θ̇.
    pub velocity: V,
    /// The device's own unknowns: speeds of the flywheels, then twists of the clutches.
    pub extra: [V; X],
    /// Ground acceleration in g, horizontal and vertical.
    pub ground: [V; 2],
    /// Time since the mode's numbers were taken, s.
    pub clock: V,
}

/// [`Moment`] of a body.
pub type MomentOf<'a, S, B, V, const X: usize> = Moment<'a, S, B, <B as Body<S>>::Posture<V>, V, X>;

/// [`Moment`] in numbers, of a body chosen at run time: what events and observers look at.
pub type AnyMoment<'a, S, const X: usize> = MomentOf<'a, S, AnyBody<S>, S, X>;

/// An event that a device has to answer, in numbers.
#[derive(Debug)]
pub struct Instant<'a, S> {
    /// The block.
    pub body: &'a AnyBody<S>,
    /// s.
    pub side: Sign,
    /// Sign of θ̇, or the one it is about to take.
    pub direction: Sign,
    /// θ, rad.
    pub rotation: S,
    /// θ̇, rad/s; a jolt changes it.
    pub velocity: S,
    /// Ground acceleration in g, horizontal and vertical.
    pub ground: [S; 2],
    /// What the device remembers.
    pub device: &'a mut Device<S>,
}

impl<S: Real> Instant<'_, S> {
    /// Speed of the rack over R, 1/s.
    pub fn rack_speed(&self) -> S {
        let posture = self.body.posture(self.side.unit(), self.rotation);
        self.body.along(&posture, self.velocity)
    }
}

/// A kind of device. `X` unknowns of its own, `G` functions to watch. It is a type, so that what a scene does not ask for is
/// not in its loop.
pub trait Drive<S: Real, const X: usize, const G: usize>: Copy {
    /// The clutch obeys Eq. 10, so that changes of its command are events.
    const COMMANDED: bool;
    /// Friction of rack and bearings may hold the block at a turn.
    const HOLDS: bool;
    /// Clutches may stretch or play, so that flywheels swing while the block is held.
    const SPRINGS: bool = false;

    /// The numbers of the present mode; `drive` is the sign of the terminals' acceleration.
    fn law(&self, direction: Sign, drive: Sign, device: &Device<S>) -> Law<S>;

    /// θ̈ and the rates of the device's unknowns.
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &MomentOf<'_, S, B, V, X>) -> (V, [V; X]);

    /// The function of `watch`, where θ̈ is `acceleration`; positive while the mode lasts.
    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &MomentOf<'_, S, B, V, X>, acceleration: V, watch: Watch<S>) -> V {
        let _ = (at, watch);
        acceleration
    }

    /// The parameters, where there are any.
    fn gears(&self) -> Option<&Gears<S>>;

    /// The device's unknowns at the start of an arc: speeds of the flywheels, then twists of the clutches.
    #[inline(always)]
    fn load(&self, device: &Device<S>) -> [S; X] {
        let [a, b] = &device.wheels;
        let unknowns = [a.spin, b.spin, a.twist, b.twist];
        core::array::from_fn(|i| unknowns[i % UNKNOWNS])
    }

    /// And at its end, where the rack has the speed `rack` (over R).
    #[inline(always)]
    fn store(&self, device: &mut Device<S>, extra: &[S; X], rack: S) {
        for (i, wheel) in device.wheels.iter_mut().enumerate() {
            if let Some(&spin) = extra.get(i) {
                wheel.spin = if wheel.coupling == Coupling::Locked { rack } else { spin };
            }
            if let Some(&twist) = extra.get(i + 2) {
                wheel.twist = twist;
            }
        }
    }

    /// Size of each unknown that matters, for tolerances, where θ̇ of that size is `speed` (rad/s).
    #[inline(always)]
    fn scales(&self, speed: S) -> [S; X] {
        [speed; X]
    }

    /// A command to engage takes effect.
    #[inline(always)]
    fn engage(&self, at: &mut Instant<'_, S>, wheel: usize) {
        let _ = (at, wheel);
    }

    /// A command to release takes effect.
    #[inline(always)]
    fn release(&self, at: &mut Instant<'_, S>, wheel: usize) {
        if let Some(gears) = self.gears() {
            open(gears, at, wheel);
        }
    }

    /// The watched function of `watch` has reached zero.
    #[inline(always)]
    fn reached(&self, at: &mut Instant<'_, S>, watch: Watch<S>) {
        let _ = (at, watch);
    }

    /// The velocity has jumped, or passed zero: modes that this ends are left.
    #[inline(always)]
    fn settle(&self, at: &mut Instant<'_, S>) {
        let _ = at;
    }

    /// An impact, at which the rack's speed jumps from `before` to what it is now; called before [`Drive::settle`].
    #[inline(always)]
    fn impact(&self, at: &mut Instant<'_, S>, before: S) {
        let _ = (at, before);
    }

    /// Flywheels that take part in the change of moment of momentum at an impact.
    #[inline(always)]
    fn engaged_at_impact(&self, device: &Device<S>) -> usize {
        let _ = device;
        0
    }

    /// Σ k engaged while a block without ground motion falls back (`inward`) or rises.
    #[inline(always)]
    fn swing_coupling(&self, inward: bool) -> S {
        self.gears().map_or(S::ZERO, |gears| if inward { gears.inertance + gears.rack_coupling } else { gears.rack_coupling })
    }

    /// Forces of the two flywheels on the rack, of the rack itself, energy stored, and power lost.
    #[inline(always)]
    fn account(&self, at: &AnyMoment<'_, S, X>, acceleration: S, device: &Device<S>) -> Account<S> {
        self.gears().map_or(Account::default(), |gears| account(at, gears, acceleration, device))
    }
}

/// Most unknowns that a device has of its own.
pub const UNKNOWNS: usize = 4;

/// What watchers ask of a device at an instant ([`crate::motion::device_snapshot::Snapshot`]).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account<S> {
    /// Force of each flywheel's drive on the rack, 1/s².
    pub force: [S; 2],
    /// Of the rack itself, 1/s².
    pub rack_force: S,
    /// Which are coupled.
    pub engaged: [bool; 2],
    /// Speeds of the flywheels, 1/s.
    pub spin: [S; 2],
    /// Energy in flywheels, rack and springs, 1/s².
    pub stored: S,
    /// What of it is in springs, 1/s².
    pub sprung: S,
    /// Power lost, 1/s³; the paper's kinematics are not in it.
    pub spent: Spent<S>,
}

/// θ̈ of a block with `resistance` at the rack beside the law's own: the weight and ground, the rack's inertia and friction.
#[inline(always)]
pub fn acceleration<S: Real, V: Value<S>, B: Body<S>, const X: usize, const FRICTION: bool>(
    at: &MomentOf<'_, S, B, V, X>,
    push: S,
    resistance: Option<V>,
) -> V {
    let mut moment = drive::<S, V, B, X, FRICTION>(at, push);
    if FRICTION {
        let own = at.body.along(&at.posture, at.velocity).scale(at.law.viscous).offset(at.law.dry);
        let resistance = match resistance {
            Some(other) => own + other,
            None => own,
        };
        moment = moment - at.body.along(&at.posture, resistance);
    } else if let Some(resistance) = resistance {
        moment = moment - at.body.along(&at.posture, resistance);
    }
    at.body.over_inertia(&at.posture, moment, at.law.coupling, at.velocity)
}

/// D, with the push of the ground on a guided rack.
#[inline(always)]
pub fn drive<S: Real, V: Value<S>, B: Body<S>, const X: usize, const RACK: bool>(at: &MomentOf<'_, S, B, V, X>, push: S) -> V {
    let drive = at.body.drive(&at.posture, at.ground);
    if RACK { drive - at.body.along(&at.posture, at.ground[0].scale(push)) } else { drive }
}

/// sign · switching function of Eq. 10.
#[inline(always)]
pub fn command<S: Real, V: Value<S>, B: Body<S>, const X: usize, const RACK: bool>(
    at: &MomentOf<'_, S, B, V, X>,
    push: S,
    sign: S,
) -> V {
    let drive = drive::<S, V, B, X, RACK>(at, push);
    at.body.switching(&at.posture, at.velocity, drive).scale(sign)
}

/// Force of a locked flywheel on the rack: its inertia and its bearing's friction, dry friction with the sign of the motion.
#[inline(always)]
pub fn locked_force<S: Real, V: Value<S>, B: Body<S>, const X: usize>(
    at: &MomentOf<'_, S, B, V, X>,
    gears: &Gears<S>,
    acceleration: V,
) -> V {
    let inertia = at.body.terminal_acceleration(&at.posture, at.velocity, acceleration);
    let bearing = at.body.along(&at.posture, at.velocity).scale(gears.bearing_rate);
    (inertia + bearing).offset(at.law.direction * gears.bearing_dry).scale(gears.inertance)
}

/// The force that a wheel would have to carry if it were locked now, on a block whose other wheels stay as they are.
pub fn force_if_locked<S: Real, D: Drive<S, X, G>, const X: usize, const G: usize>(
    drive: &D,
    gears: &Gears<S>,
    at: &Instant<'_, S>,
    wheel: usize,
) -> S {
    let mut device = *at.device;
    device.wheels[wheel].coupling = Coupling::Locked;
    let law = drive.law(at.direction, at.direction, &device);
    let moment = moment(drive, at.body, &law, at, &device);
    let (acceleration, _) = drive.flow(&moment);
    locked_force(&moment, gears, acceleration)
}

/// The numbers of an instant as an equation sees them.
pub fn moment<'a, S: Real, D: Drive<S, X, G>, const X: usize, const G: usize>(
    drive: &D,
    body: &'a AnyBody<S>,
    law: &'a Law<S>,
    at: &Instant<'_, S>,
    device: &Device<S>,
) -> AnyMoment<'a, S, X> {
    Moment {
        body,
        law,
        posture: body.posture(at.side.unit(), at.rotation),
        velocity: at.velocity,
        extra: drive.load(device),
        ground: at.ground,
        clock: S::ZERO,
    }
}

/// A rigid clutch closes: block and flywheel exchange momentum,
/// (1 + (K + k) ℓ²) θ̇⁺ = (1 + K ℓ²) θ̇⁻ + k ℓ w, where K is what was locked already.
pub fn jolt<S: Real>(gears: &Gears<S>, at: &mut Instant<'_, S>, wheel: usize) {
    let posture = at.body.posture(at.side.unit(), at.rotation);
    let arm = at.body.arm(&posture);
    let locked = at.device.wheels.iter().filter(|wheel| wheel.coupling == Coupling::Locked).count();
    let before = S::ONE + (gears.rack_coupling + S::count(locked as u32) * gears.inertance) * arm * arm;
    let after = before + gears.inertance * arm * arm;
    let closing = at.device.wheels[wheel].spin;
    at.velocity = (before * at.velocity + gears.inertance * arm * closing) / after;
    at.device.wheels[wheel].coupling = Coupling::Locked;
}

/// A wheel lets go of the rack, with the rack's speed if it was locked.
pub fn open<S: Real>(gears: &Gears<S>, at: &mut Instant<'_, S>, wheel: usize) {
    let rack = at.rack_speed();
    let wheel = &mut at.device.wheels[wheel];
    if wheel.coupling == Coupling::Locked {
        wheel.spin = rack;
    }
    if gears.stops_at_once {
        wheel.spin = S::ZERO;
    }
    wheel.coupling = Coupling::Open;
    wheel.twist = S::ZERO;
    gears.settle(wheel, S::ZERO);
}

/// Energy and losses that all kinds share: rack, bearings, brakes, and flywheels at their speeds.
pub fn account<S: Real, const X: usize>(
    at: &AnyMoment<'_, S, X>,
    gears: &Gears<S>,
    acceleration: S,
    device: &Device<S>,
) -> Account<S> {
    let rack = at.body.along(&at.posture, at.velocity);
    let rack_acceleration = at.body.terminal_acceleration(&at.posture, at.velocity, acceleration);
    let mut account = Account::default();
    let dry = at.law.direction * gears.rack_dry;
    account.rack_force = gears.rack_coupling * rack_acceleration
        + gears.rack_push * at.ground[0]
        + gears.rack_viscous * rack
        + if rack == S::ZERO { S::ZERO } else { dry };
    account.spent.rack = (gears.rack_viscous * rack + dry) * rack;
    account.stored = S::HALF * gears.rack_coupling * rack * rack;
    for (i, wheel) in device.wheels.iter().enumerate() {
        account.engaged[i] = wheel.coupling != Coupling::Open;
        let locked = wheel.coupling == Coupling::Locked;
        let spin = if locked { rack } else { at.extra.get(i).copied().unwrap_or(S::ZERO) };
        account.spin[i] = spin;
        account.stored = account.stored + S::HALF * gears.inertance * spin * spin;
        account.spent.bearing =
            account.spent.bearing + gears.inertance * (gears.bearing_rate * spin.abs() + gears.bearing_dry) * spin.abs();
        if wheel.coupling == Coupling::Open {
            account.spent.brake = account.spent.brake + gears.inertance * gears.brake * spin.abs();
        }
        if locked {
            account.force[i] = locked_force(at, gears, acceleration);
        }
    }
    account
}
