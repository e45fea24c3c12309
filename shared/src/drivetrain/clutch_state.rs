//! State of a device, coefficients of its mode, and guards.

use super::under_way::UnderWay;
use crate::math::scalar::Real;
use crate::math::sign::Sign;

/// Connection of one flywheel to the rack: the discrete state of its clutch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coupling {
    /// No connection: the clutch is open.
    #[default]
    Open,
    /// Rigid connection: one speed.
    Locked,
    /// Friction of slipping plates: force on the flywheel with this sign.
    Slipping(Sign),
    /// Viscous slip: force by the difference of the speeds.
    Viscous,
    /// Engaged within the gear play: no force.
    InPlay,
    /// Spring and damper in contact on this side of the play.
    Elastic(Sign),
    /// Spring and damper in contact, force at the capacity of slipping plates, with this sign.
    Saturated(Sign),
}

// Every variant is named, so that a new one is placed in each set.
impl Coupling {
    /// Engaged clutch: any connection of rack and flywheel, the gear play included.
    pub fn is_engaged(self) -> bool {
        match self {
            Coupling::Open => false,
            Coupling::Locked
            | Coupling::Slipping(_)
            | Coupling::Viscous
            | Coupling::InPlay
            | Coupling::Elastic(_)
            | Coupling::Saturated(_) => true,
        }
    }

    /// Engaged elastic clutch, whose twist is a state: within its play, in contact or saturated.
    pub fn has_twist(self) -> bool {
        match self {
            Coupling::Open | Coupling::Locked | Coupling::Slipping(_) | Coupling::Viscous => false,
            Coupling::InPlay | Coupling::Elastic(_) | Coupling::Saturated(_) => true,
        }
    }

    /// Sign of the force of plates that slip; none while they stick or are open.
    pub fn slip_sign(self) -> Option<Sign> {
        match self {
            Coupling::Slipping(sign) | Coupling::Saturated(sign) => Some(sign),
            Coupling::Open | Coupling::Locked | Coupling::Viscous | Coupling::InPlay | Coupling::Elastic(_) => None,
        }
    }

    /// Side of the play on which an elastic clutch is in contact; none within the play and for other clutches.
    pub fn contact_side(self) -> Option<Sign> {
        match self {
            Coupling::Elastic(side) | Coupling::Saturated(side) => Some(side),
            Coupling::Open | Coupling::Locked | Coupling::Slipping(_) | Coupling::Viscous | Coupling::InPlay => None,
        }
    }
}

/// State of one flywheel and its clutch.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlywheelState<S> {
    /// Speed of a rack that would move with it, over R, 1/s. Of a locked flywheel it is stale: the rack's counts.
    pub spin: S,
    /// Twist of its clutch as travel of the rack over R.
    pub twist: S,
    /// Coupling.
    pub coupling: Coupling,
    /// The way it turns; none while friction holds it.
    pub turning: Option<Sign>,
    /// The controller wants it engaged.
    pub commanded: bool,
    /// It obeyed the last command to engage (it may have missed it).
    pub obeys: bool,
    /// Time until the pending command takes effect, s; negative without one.
    pub pending: S,
    /// The commands that take effect by a transport delay, that one included.
    pub under_way: UnderWay<S>,
    /// Time for which it may not move again, s.
    pub dwell: S,
    /// Time since it began to engage, s.
    pub engaged_for: S,
}

/// Motion of a device's terminals against a support that moves otherwise than the ground: what Eq. 10 looks at there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Terminals<S> {
    /// Speed that the support has gained on the ground, as that of the terminals, over R; 1/s.
    pub support: S,
    /// Sign of the rack's speed on the support.
    pub direction: Sign,
}

/// State of both flywheels. A device with one uses the first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeviceState<S> {
    /// The one for positive motion, and the one for negative.
    pub wheels: [FlywheelState<S>; 2],
    /// Commands to engage so far, in swings that count.
    pub engagements: u32,
    /// Engagements missed so far.
    pub missed: u32,
    /// What is locked drives the rack: its force is against the motion. Friction that grows with load asks for it.
    pub drives: bool,
    /// The terminals on a support that moves otherwise than the ground; none on another.
    pub terminals: Option<Terminals<S>>,
}

impl<S: Real> DeviceState<S> {
    /// A device at rest.
    pub fn at_rest() -> DeviceState<S> {
        let wheel = FlywheelState { pending: -S::ONE, ..FlywheelState::default() };
        DeviceState { wheels: [wheel; 2], ..DeviceState::default() }
    }

    /// Flywheels that are locked.
    pub fn locked(&self) -> u32 {
        self.wheels.iter().map(|wheel| u32::from(wheel.coupling == Coupling::Locked)).sum()
    }

    /// The device's unknowns at the start of a step: speeds of the flywheels, then twists of the clutches; on a support of its own motion that
    /// support's speed alone.
    pub fn unknowns(&self) -> [S; UNKNOWNS] {
        if let Some(terminals) = self.terminals {
            return [terminals.support, S::ZERO, S::ZERO, S::ZERO];
        }
        let [a, b] = &self.wheels;
        [a.spin, b.spin, a.twist, b.twist]
    }

    /// Stores the unknowns at the end of a step, where the rack has the speed `rack` (over R).
    pub fn store(&mut self, unknowns: &[S], rack: S) {
        if let (Some(terminals), Some(&support)) = (&mut self.terminals, unknowns.first()) {
            terminals.support = support;
            return;
        }
        for (i, wheel) in self.wheels.iter_mut().enumerate() {
            if let Some(&spin) = unknowns.get(i) {
                wheel.spin = if wheel.coupling == Coupling::Locked { rack } else { spin };
            }
            if let Some(&twist) = unknowns.get(i + 2) {
                wheel.twist = twist;
            }
        }
    }

    /// Time until something happens by the clock alone, s; none if nothing is due.
    pub fn next_due(&self) -> Option<S> {
        self.wheels.iter().map(|wheel| wheel.pending).filter(|pending| *pending >= S::ZERO).reduce(S::smaller)
    }

    /// Lets the clocks run for `time` (s).
    pub fn elapse(&mut self, time: S) {
        for wheel in &mut self.wheels {
            if wheel.pending >= S::ZERO {
                wheel.pending = (wheel.pending - time).larger(S::ZERO);
            }
            wheel.dwell = (wheel.dwell - time).larger(S::ZERO);
            wheel.engaged_for = wheel.engaged_for + time;
        }
    }
}

/// Coefficients of an inertia force at the rack, with the sign of a resistance; 1/s².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Push<S> {
    /// Over ü_g/g.
    pub ground: S,
    /// Over (ü_s − ü_g)/g, through flywheels on a support of its own motion.
    pub support: Option<S>,
}

/// Coefficients of one mode: the equations between two events are smooth with them. What a device does not have is zero here
/// and not looked at by its type.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ModeCoefficients<S> {
    /// Sign of θ̇.
    pub direction: S,
    /// Σ k of what moves rigidly with the rack.
    pub coupling: S,
    /// Inertia force of ground and support on what moves rigidly with the rack.
    pub push: Push<S>,
    /// Viscous resistance at the rack, 1/s.
    pub viscous: S,
    /// Dry resistance at the rack with the sign of the motion, 1/s².
    pub dry: S,
    /// Viscous rate of each flywheel, 1/s.
    pub decay: [S; 2],
    /// Dry deceleration of each flywheel with its sign, 1/s².
    pub drag: [S; 2],
    /// 1 while forces move the flywheel, 0 while friction holds it.
    pub moves: [S; 2],
    /// Force of slipping plates, 1/s².
    pub slip: [S; 2],
    /// Growth of the force of slipping plates, 1/s³.
    pub slip_growth: [S; 2],
    /// Stiffness of a clutch in contact, 1/s².
    pub stiffness: [S; 2],
    /// Damping of a clutch in contact, of viscous slip, or of the drag of an open clutch, 1/s.
    pub damping: [S; 2],
    /// Twist at which a clutch in contact is without force.
    pub rest_twist: [S; 2],
    /// 1 while the twist follows the relative motion, else 0.
    pub follows: [S; 2],
    /// Rate at which the twist of a saturated clutch relaxes, 1/s.
    pub relaxation: [S; 2],
    /// Guards of the mode.
    pub watch: [Guard<S>; GUARDS],
}

/// Guard of a mode: a function that is positive while the mode lasts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Guard<S> {
    /// Nothing.
    #[default]
    Nothing,
    /// sign · switching function: the command of Eq. 10.
    Command(S),
    /// sign · speed of the rack on a support of its own motion: the velocity of Eq. 10 there.
    Terminals(S),
    /// sign · (speed of the flywheel − speed of the rack): it runs ahead.
    Ahead(S, usize),
    /// sign · (force on a locked flywheel): what an overrunning clutch holds, or who drives whom.
    Held(S),
    /// capacity² − (force on a locked flywheel)², with the capacity and its growth.
    Capacity(S, S),
    /// sign · (speed of the rack − speed of the flywheel − rate of its twist): plates slip.
    Slip(S, usize),
    /// (half the play)² − twist².
    Play(S, usize),
    /// sign · (twist − contact): in contact.
    Contact(S, usize),
    /// bound² − force² of a clutch in contact or of a dashpot, with the bound and its growth.
    Below(S, S, usize),
    /// friction² − θ̈² of a tilted block that friction holds, with the θ̈ that it would have without.
    Stuck(S),
    /// friction − sign · θ̈ of a block that its clutches hold on its base, likewise.
    HeldDown(S, S),
}

/// Largest number of a device's own unknowns.
pub const UNKNOWNS: usize = 4;

/// Largest number of guards of a device: the command, and two of each flywheel.
pub const GUARDS: usize = 5;

impl<S: Real> ModeCoefficients<S> {
    /// Nothing engaged, nothing lost, motion in `direction`.
    #[expect(
        clippy::field_reassign_with_default,
        reason = "made in its place: a copy makes the processor wait for the support that is not there"
    )]
    pub fn of(direction: Sign) -> ModeCoefficients<S> {
        let mut law = ModeCoefficients::default();
        law.direction = direction.unit();
        law
    }
}
