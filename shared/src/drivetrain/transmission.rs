//! Contract of a transmission: rates between events, guards, and answers to events.

use super::clutch_state::{Coupling, DeviceState, Guard, ModeCoefficients, Push, UNKNOWNS};
use super::scaled_parameters::ScaledParameters;
use crate::equation::Accelerations;
use crate::equation::any_body::AnyBody;
use crate::equation::body::Body;
use crate::math::scalar::{Real, Scalar};
use crate::math::sign::Sign;
use crate::math::value::Value;

/// Point at which a mode's equations are evaluated: `V` is a number or a power series.
#[derive(Clone, Copy, Debug)]
pub struct EvaluationPoint<'a, S, B, P, V, const X: usize> {
    /// The block.
    pub body: &'a B,
    /// Parameters of the transmission.
    pub parameters: &'a ScaledParameters<S>,
    /// Coefficients of the mode.
    pub law: &'a ModeCoefficients<S>,
    /// The body's configuration at θ.
    pub configuration: P,
    /// θ̇, rad/s.
    pub velocity: V,
    /// The device's own unknowns: speeds of the flywheels, then twists of the clutches.
    pub unknowns: [V; X],
    /// Accelerations of ground and support.
    pub ground: Accelerations<V>,
    /// Time since the mode's numbers were taken, s.
    pub clock: V,
}

/// [`EvaluationPoint`] of a body.
pub type PointOf<'a, S, B, V, const X: usize> = EvaluationPoint<'a, S, B, <B as Body<S>>::Configuration<V>, V, X>;

/// [`EvaluationPoint`] in numbers, of a body chosen at run time, for events and observers.
pub type AnyPoint<'a, S, const X: usize> = PointOf<'a, S, AnyBody<S>, S, X>;

/// Event context: block and device at an event that the device answers.
#[derive(Debug)]
pub struct EventContext<'a, S> {
    /// The block.
    pub body: &'a AnyBody<S>,
    /// Parameters of the transmission.
    pub parameters: &'a ScaledParameters<S>,
    /// s.
    pub side: Sign,
    /// Sign of θ̇, or the one it is about to take.
    pub direction: Sign,
    /// θ, rad.
    pub rotation: S,
    /// θ̇, rad/s; a jolt changes it.
    pub velocity: S,
    /// Accelerations of ground and support.
    pub ground: Accelerations<S>,
    /// State of the device.
    pub device: &'a mut DeviceState<S>,
}

impl<'a, S: Real> EventContext<'a, S> {
    /// Speed of the rack over R, 1/s.
    pub fn rack_speed(&self) -> S {
        let configuration = self.body.configuration(self.side.unit(), self.rotation);
        self.body.to_terminal(&configuration, self.velocity)
    }

    /// The [`EvaluationPoint`] of the instant, in the mode `law` of `device`.
    pub fn point<const X: usize>(&self, law: &'a ModeCoefficients<S>, device: &DeviceState<S>) -> AnyPoint<'a, S, X> {
        EvaluationPoint {
            body: self.body,
            parameters: self.parameters,
            law,
            configuration: self.body.configuration(self.side.unit(), self.rotation),
            velocity: self.velocity,
            unknowns: first(&device.unknowns()),
            ground: self.ground,
            clock: S::ZERO,
        }
    }

    /// Plastic impact of a rigid clutch that closes: block and flywheel exchange momentum,
    /// (1 + (K + k) ℓ²) θ̇⁺ = (1 + K ℓ²) θ̇⁻ + k ℓ w, where K is what was locked already.
    pub fn jolt(&mut self, wheel: usize) {
        let ScaledParameters { rack_coupling, inertance, .. } = *self.parameters;
        let configuration = self.body.configuration(self.side.unit(), self.rotation);
        let arm = self.body.arm(&configuration);
        let before = S::ONE + (rack_coupling + S::count(self.device.locked()) * inertance) * arm * arm;
        let after = before + inertance * arm * arm;
        let closing = self.device.wheels[wheel].spin;
        self.velocity = (before * self.velocity + inertance * arm * closing) / after;
        self.device.wheels[wheel].coupling = Coupling::Locked;
    }

    /// Release of a wheel, with the rack's speed if it was locked.
    pub fn open(&mut self, wheel: usize) {
        let rack = self.rack_speed();
        let wheel = &mut self.device.wheels[wheel];
        if wheel.coupling == Coupling::Locked {
            wheel.spin = rack;
        }
        if self.parameters.stops_at_once {
            wheel.spin = S::ZERO;
        }
        wheel.coupling = Coupling::Open;
        wheel.twist = S::ZERO;
        self.parameters.settle(wheel, self.parameters.drag * (rack - wheel.spin));
    }
}

/// Transmission of one kind, with `X` unknowns and `G` guards. It is a type, so that what a scene does not ask for is
/// not in its loop.
pub trait Transmission<S: Real, const X: usize, const G: usize> {
    /// The clutch obeys Eq. 10, so that changes of its command are events.
    const COMMANDED: bool;
    /// Friction of rack and bearings may hold the block at a turn.
    const HOLDS: bool;
    /// Elastic clutches, so that flywheels may swing while the block is held.
    const SPRINGS: bool = false;
    /// Locked flywheels take part in the change of moment of momentum at an impact.
    const THROUGH_IMPACTS: bool = false;
    /// The first flywheel is always locked.
    const PERMANENT: bool = false;
    /// The support moves otherwise than the ground, and its speed is an unknown.
    const ON_SUPPORT: bool = false;

    /// Coefficients of the present mode.
    fn law(
        &self,
        parameters: &ScaledParameters<S>,
        direction: Sign,
        terminal_acceleration_sign: Sign,
        device: &DeviceState<S>,
    ) -> ModeCoefficients<S> {
        let mut law = ModeCoefficients::of(direction);
        self.complete(&mut law, parameters, terminal_acceleration_sign, device);
        law
    }

    /// Adds what moves with the rack, the command and what else the kind has to the coefficients of a direction.
    #[inline(always)]
    fn complete(
        &self,
        law: &mut ModeCoefficients<S>,
        parameters: &ScaledParameters<S>,
        terminal_acceleration_sign: Sign,
        device: &DeviceState<S>,
    ) {
        parameters.complete(law, device);
        if Self::COMMANDED {
            law.watch[0] = Guard::Command(terminal_acceleration_sign.unit());
        }
        self.extend(law, parameters, device);
    }

    /// What the kind adds to the coefficients of a mode: its guards beside the command, and forces of its clutches.
    fn extend(&self, _law: &mut ModeCoefficients<S>, _parameters: &ScaledParameters<S>, _device: &DeviceState<S>) {}

    /// θ̈ and the rates of the device's unknowns. In the default flywheels that are not locked coast, ẇ = −c w − d sgn w.
    #[inline(always)]
    fn flow<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, X>) -> (V, [V; X]) {
        let rates = core::array::from_fn(|i| at.unknowns[i].scale(-at.law.decay[i & 1]).offset(-at.law.drag[i & 1]));
        (acceleration(at, Self::HOLDS, None), rates)
    }

    /// Value of the guard `watch`, where θ̈ is `acceleration`; positive while the mode lasts. The default knows the command alone.
    #[inline(always)]
    fn guard<V: Value<S>, B: Body<S>>(&self, at: &PointOf<'_, S, B, V, X>, acceleration: V, watch: Guard<S>) -> V {
        match watch {
            Guard::Command(sign) if Self::COMMANDED => command(at, Self::HOLDS, sign),
            _ => acceleration,
        }
    }

    /// Size of each unknown that matters, for tolerances, where θ̇ of that size is `speed` (rad/s).
    fn scales(&self, _parameters: &ScaledParameters<S>, speed: S) -> [S; X] {
        [speed; X]
    }

    /// A command to engage takes effect; in the default without a loss of momentum.
    fn engage(&self, at: &mut EventContext<'_, S>, wheel: usize) {
        at.device.wheels[wheel].coupling = Coupling::Locked;
    }

    /// The guard `watch` has reached zero.
    fn reached(&self, _at: &mut EventContext<'_, S>, _watch: Guard<S>) {}

    /// The velocity has jumped, or passed zero: modes that this ends are left.
    fn settle(&self, _at: &mut EventContext<'_, S>) {}

    /// An impact, at which the rack's speed jumps from `before` to what it is now; called before [`Transmission::settle`].
    fn impact(&self, _at: &mut EventContext<'_, S>, _before: S) {}

    /// Forces of the two flywheels on the rack, of the rack itself, energy stored, and power lost.
    fn account(&self, at: &AnyPoint<'_, S, X>, acceleration: S, device: &DeviceState<S>) -> Account<S> {
        account(at, acceleration, device)
    }
}

/// The first `X` of the unknowns.
pub fn first<S: Copy, const X: usize>(unknowns: &[S; UNKNOWNS]) -> [S; X] {
    core::array::from_fn(|i| unknowns[i % UNKNOWNS])
}

/// Energy losses by cause, or their rates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spent<S> {
    /// Slip and damping of the clutches.
    pub clutch: S,
    /// Brakes of idle flywheels.
    pub brake: S,
    /// Bearings of the flywheels.
    pub bearing: S,
    /// Friction of the rack.
    pub rack: S,
    /// What the paper's kinematics take away without a physical cause (negative: create).
    pub kinematics: S,
}

/// Forces, speeds, energies and losses of a device at an instant ([`crate::motion::device_snapshot::Snapshot`]).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account<S> {
    /// Force of each flywheel on the rack, with the friction of their mesh, positive where it resists positive motion; F/(λmR), 1/s².
    pub force: [S; 2],
    /// Friction and inertia of the rack itself, the same way; from a transmission, without the dry friction of a rack that stands.
    pub rack_force: S,
    /// Whether each flywheel is coupled.
    pub engaged: [bool; 2],
    /// Speed of each flywheel as that of a rack on its support moving with it, over R; 1/s.
    pub spin: [S; 2],
    /// Kinetic energy of flywheels and rack, and of springs; E/(λmR²), 1/s².
    pub stored: S,
    /// Energy of the springs alone.
    pub sprung: S,
    /// Power lost, 1/s³; from a transmission, without what the paper's kinematics take.
    pub spent: Spent<S>,
}

impl<S: Real> Account<S> {
    /// That of no device: a constant, for a default is a call for each of its arrays.
    pub const NOTHING: Account<S> = {
        let (zero, none) = (S::ZERO, [S::ZERO; 2]);
        let spent = Spent { clutch: zero, brake: zero, bearing: zero, rack: zero, kinematics: zero };
        Account { force: none, rack_force: zero, engaged: [false; 2], spin: none, stored: zero, sprung: zero, spent }
    };
}

/// θ̈ of a block under its weight, the ground and the rack's inertia; with `friction` also that of the rack, and `resistance` there.
#[inline(always)]
pub fn acceleration<S: Real, V: Value<S>, B: Body<S>, const X: usize>(
    at: &PointOf<'_, S, B, V, X>,
    friction: bool,
    resistance: Option<V>,
) -> V {
    let moment = driving_moment(at, friction.then_some(at.law.push));
    if friction {
        let own = rack_friction(at);
        let resistance = match resistance {
            Some(other) => own + other,
            None => own,
        };
        return resisted_acceleration(at, moment, resistance);
    }
    at.body.solve_acceleration(&at.configuration, moment, at.law.coupling, at.velocity)
}

/// Friction at the rack, of its guides and of the bearings of what is locked to it; 1/s².
#[inline(always)]
pub fn rack_friction<S: Scalar, V: Value<S>, B: Body<S>, const X: usize>(at: &PointOf<'_, S, B, V, X>) -> V {
    at.body.to_terminal(&at.configuration, at.velocity).scale(at.law.viscous).offset(at.law.dry)
}

/// θ̈ under the moment D = `moment` (1/s²) against the force `resistance` at the rack.
#[inline(always)]
pub fn resisted_acceleration<S: Scalar, V: Value<S>, B: Body<S>, const X: usize>(
    at: &PointOf<'_, S, B, V, X>,
    moment: V,
    resistance: V,
) -> V {
    let moment = moment - at.body.to_terminal(&at.configuration, resistance);
    at.body.solve_acceleration(&at.configuration, moment, at.law.coupling, at.velocity)
}

/// D, with the inertia force `push` of the motions of ground and support at the rack.
#[inline(always)]
pub fn driving_moment<S: Scalar, V: Value<S>, B: Body<S>, const X: usize>(
    at: &PointOf<'_, S, B, V, X>,
    push: Option<Push<S>>,
) -> V {
    let [horizontal, vertical, support] = at.ground;
    let moment = at.body.driving_moment(&at.configuration, [horizontal, vertical]);
    let Some(push) = push else { return moment };
    let mut force = horizontal.scale(push.ground);
    if let Some(push) = push.support {
        force = force + support.scale(push);
    }
    moment - at.body.to_terminal(&at.configuration, force)
}

/// sign · switching function of Eq. 10, on a support that moves with the ground.
#[inline(always)]
pub fn command<S: Real, V: Value<S>, B: Body<S>, const X: usize>(at: &PointOf<'_, S, B, V, X>, rack: bool, sign: S) -> V {
    let driving_moment = driving_moment(at, rack.then_some(Push { ground: at.parameters.rack_push, support: None }));
    at.body.switching(&at.configuration, at.velocity, driving_moment).scale(sign)
}

/// Force of a locked flywheel on the rack: its inertia and its bearing's friction, dry friction with the sign of the motion.
#[inline(always)]
pub fn locked_force<S: Scalar, V: Value<S>, B: Body<S>, const X: usize>(at: &PointOf<'_, S, B, V, X>, acceleration: V) -> V {
    let parameters = at.parameters;
    let inertia = at.body.terminal_acceleration(&at.configuration, at.velocity, acceleration);
    let bearing = at.body.to_terminal(&at.configuration, at.velocity).scale(parameters.bearing_rate);
    (inertia + bearing).offset(at.law.direction * parameters.bearing_dry).scale(parameters.inertance)
}

/// The force on a wheel if it were locked now, on a block whose other wheels stay as they are.
pub fn force_if_locked<S: Real, D: Transmission<S, X, G>, const X: usize, const G: usize>(
    transmission: &D,
    at: &EventContext<'_, S>,
    wheel: usize,
) -> S {
    let mut device = *at.device;
    device.wheels[wheel].coupling = Coupling::Locked;
    let law = transmission.law(at.parameters, at.direction, at.direction, &device);
    let point = at.point(&law, &device);
    let (acceleration, _) = transmission.flow(&point);
    locked_force(&point, acceleration)
}

/// Energy and losses that all kinds share: rack, bearings, brakes, and flywheels at their speeds.
pub fn account<S: Real, const X: usize>(at: &AnyPoint<'_, S, X>, acceleration: S, device: &DeviceState<S>) -> Account<S> {
    let parameters = at.parameters;
    let rack = at.body.to_terminal(&at.configuration, at.velocity);
    let rack_acceleration = at.body.terminal_acceleration(&at.configuration, at.velocity, acceleration);
    let mut account = Account::NOTHING;
    let support = device.terminals.and_then(|_| at.unknowns.first().copied());
    let dry = at.law.direction * parameters.rack_dry;
    account.rack_force = parameters.rack_coupling * rack_acceleration
        + parameters.rack_push * at.ground[0]
        + parameters.rack_viscous * rack
        + if rack == S::ZERO { S::ZERO } else { dry };
    account.spent.rack = (parameters.rack_viscous * rack + dry) * rack;
    account.stored = S::HALF * parameters.rack_coupling * rack * rack;
    for (i, wheel) in device.wheels.iter().enumerate() {
        account.engaged[i] = wheel.coupling.is_engaged();
        let locked = wheel.coupling == Coupling::Locked;
        let spin = match (locked, support) {
            (true, support) => rack - support.unwrap_or(S::ZERO),
            (false, Some(_)) => S::ZERO,
            (false, None) => at.unknowns.get(i).copied().unwrap_or(S::ZERO),
        };
        account.spin[i] = spin;
        account.stored = account.stored + S::HALF * parameters.inertance * spin * spin;
        account.spent.bearing = account.spent.bearing
            + parameters.inertance * (parameters.bearing_rate * spin.abs() + parameters.bearing_dry) * spin.abs();
        if !wheel.coupling.is_engaged() {
            account.spent.brake = account.spent.brake + parameters.inertance * parameters.brake * spin.abs();
        }
        if locked {
            account.force[i] = locked_force(at, acceleration);
            if parameters.support_moves() {
                account.force[i] = account.force[i] - parameters.support_force(at.ground);
            }
        }
    }
    account
}
