//! Mode output: dense output over one step with the unknowns and guards of a device.

use super::HybridSystem;
use crate::drivetrain::any_transmission::each_flow;
use crate::drivetrain::clutch_state::{ModeCoefficients, UNKNOWNS};
use crate::drivetrain::transmission::{EvaluationPoint, PointOf, Transmission};
use crate::equation::Accelerations;
use crate::equation::any_body::AnyBody;
use crate::equation::body::Body;
use crate::ground::GroundSegment;
use crate::math::root::zero_shown;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::dense_output::DenseOutput;

/// Motion of the ground, and of a support, over one ground segment.
#[derive(Clone, Copy)]
pub struct Shaking<'a, S> {
    /// Horizontal.
    pub horizontal: &'a dyn GroundSegment<S>,
    /// Vertical, for a body that has it.
    pub vertical: Option<&'a dyn GroundSegment<S>>,
    /// Horizontal acceleration of the device's support relative to the ground, for a support of its own motion.
    pub support: Option<&'a dyn GroundSegment<S>>,
}

impl<'a, S: Real> Shaking<'a, S> {
    /// Horizontal motion alone.
    pub fn level(horizontal: &'a dyn GroundSegment<S>) -> Shaking<'a, S> {
        Shaking { horizontal, vertical: None, support: None }
    }

    /// The accelerations at the local time `time` (s).
    #[inline(always)]
    pub fn at(&self, time: S) -> Accelerations<S> {
        let value = |segment: Option<&dyn GroundSegment<S>>| segment.map_or(S::ZERO, |segment| segment.acceleration(time));
        [self.horizontal.acceleration(time), value(self.vertical), value(self.support)]
    }

    /// Into how many equal pieces to cut `time` (s), so that none lasts longer than a radian of the fastest wave.
    pub(super) fn pieces(&self, time: S) -> u32 {
        let segments = [Some(self.horizontal), self.vertical, self.support].into_iter().flatten();
        let fastest = segments.fold(S::ZERO, |fastest, segment| fastest.larger(segment.angular_frequency()));
        ((fastest * time).to_f64() as u32).saturating_add(1)
    }
}

/// Start of a step: state, mode and ground motion.
#[derive(Clone, Copy)]
pub struct ModeStart<'a, S> {
    /// The block on its device.
    pub system: &'a HybridSystem<S>,
    /// Coefficients of the mode.
    pub law: &'a ModeCoefficients<S>,
    /// The ground motion.
    pub shaking: Shaking<'a, S>,
    /// s = sgn θ.
    pub side: Sign,
    /// The state at the start.
    pub place: Place<S, UNKNOWNS>,
    /// Local time in the ground segment, s.
    pub time: S,
    /// Largest length of the step, s; above 0.
    pub length: S,
    /// The block has just been set free where what moves it passed what held it: θ̈ has the direction of the motion, or is zero.
    pub freed: bool,
    /// Friction holds the block: θ̈ = 0, whatever acts. Only devices with springs take steps then.
    pub held: bool,
}

/// A step of a block and a device whose types are known.
#[derive(Clone, Copy)]
pub struct KnownModeStart<'a, S, B, D, const X: usize, const G: usize> {
    /// Start of the step.
    pub start: &'a ModeStart<'a, S>,
    /// Block in its own type.
    pub body: &'a B,
    /// Transmission in its own type.
    pub transmission: &'a D,
}

/// Continuation that receives block and device in their own types.
pub trait WithModeStart<S: Real> {
    /// The result.
    type Output;

    /// Continues with `known`.
    fn with<B: Body<S>, D: Transmission<S, X, G>, const X: usize, const G: usize>(
        self,
        known: &KnownModeStart<'_, S, B, D, X, G>,
    ) -> Self::Output;
}

impl<S: Real> ModeStart<'_, S> {
    /// Continues with block and device in their own types: one choice for all that `next` evaluates.
    #[inline(always)]
    pub fn known<W: WithModeStart<S>>(&self, next: W) -> W::Output {
        let kind = self.system.transmission.kind;
        match &self.system.body {
            AnyBody::Slender(body) => {
                each_flow!(kind, transmission => next.with(&KnownModeStart { start: self, body, transmission }))
            }
            AnyBody::Full(body) => {
                each_flow!(kind, transmission => next.with(&KnownModeStart { start: self, body, transmission }))
            }
        }
    }

    /// The accelerations `time` after the start.
    #[inline(always)]
    pub fn ground_at(&self, time: S) -> Accelerations<S> {
        self.shaking.at(self.time + time)
    }

    /// θ̈ at the start, from the equation's `acceleration`: the rounding of a zero must not accelerate a freed block backwards.
    #[inline(always)]
    pub fn first(&self, acceleration: S) -> S {
        if self.freed && self.law.direction * acceleration < S::ZERO { S::ZERO } else { acceleration }
    }
}

impl<S: Real, B: Body<S>, D: Transmission<S, X, G>, const X: usize, const G: usize> KnownModeStart<'_, S, B, D, X, G> {
    /// Whether friction holds the block.
    #[inline(always)]
    pub fn is_held(&self) -> bool {
        D::SPRINGS && self.start.held
    }

    /// The evaluation point of `at`.
    #[inline(always)]
    pub fn point(&self, at: &Place<S, X>) -> PointOf<'_, S, B, S, X> {
        let ModeStart { law, side, system, .. } = *self.start;
        EvaluationPoint {
            body: self.body,
            parameters: &system.transmission.parameters,
            law,
            configuration: self.body.configuration(side.unit(), at.rotation),
            velocity: at.velocity,
            unknowns: at.unknowns,
            ground: at.ground,
            clock: at.time,
        }
    }

    /// θ̈ and the rates of the device's unknowns.
    #[inline(never)]
    pub fn rates(&self, at: &Place<S, X>) -> (S, [S; X]) {
        self.flow(&self.point(at))
    }

    /// [`Self::rates`] at a point.
    #[inline(always)]
    pub fn flow(&self, at: &PointOf<'_, S, B, S, X>) -> (S, [S; X]) {
        let (acceleration, rates) = self.transmission.flow(at);
        (if self.is_held() { S::ZERO } else { acceleration }, rates)
    }
}

/// State at one instant of a step.
#[derive(Clone, Copy, Debug)]
pub struct Place<S, const X: usize> {
    /// Time since the start, s.
    pub time: S,
    /// Accelerations of ground and support.
    pub ground: Accelerations<S>,
    /// θ, rad.
    pub rotation: S,
    /// θ̇, rad/s.
    pub velocity: S,
    /// The device's unknowns.
    pub unknowns: [S; X],
}

impl<S: Real, const X: usize> Place<S, X> {
    /// With other unknowns.
    #[inline(always)]
    pub fn map<const Y: usize>(&self, unknowns: impl FnOnce(&[S; X]) -> [S; Y]) -> Place<S, Y> {
        let Place { time, ground, rotation, velocity, .. } = *self;
        Place { time, ground, rotation, velocity, unknowns: unknowns(&self.unknowns) }
    }
}

/// Mode output: the motion from a [`ModeStart`] over times from 0 to [`DenseOutput::length`]. Zeros are sought in (0, `to`].
///
/// The defaults use the ends of the step; a method with a series overrides them and proves its answers.
pub trait ModeOutput<S: Real>: DenseOutput<S> {
    /// The device's unknowns at `time`.
    fn unknowns(&self, time: S) -> [S; UNKNOWNS];

    /// Guard `index` at `time`.
    fn guard(&self, index: usize, time: S) -> S;

    /// Known without a search: neither θ̇, which has the sign `direction` just after the start, nor a guard has a zero in the step.
    fn keeps_signs(&self, _direction: Sign) -> bool {
        false
    }

    /// First zero of θ̇, which has the sign `sign` just after the start, and is zero there with `from_zero`.
    fn velocity_zero(&self, to: S, sign: Sign, _from_zero: bool) -> Option<S> {
        zero_shown(S::ZERO, to, sign, |t| self.at(t).velocity)
    }

    /// First zero of guard `index`, positive just after the start.
    fn guard_zero(&self, index: usize, to: S, _from_zero: bool) -> Option<S> {
        zero_shown(S::ZERO, to, Sign::Positive, |t| self.guard(index, t))
    }

    /// First zero of the device's unknown `index`, of sign `sign` just after the start.
    fn unknown_zero(&self, index: usize, to: S, sign: Sign, _from_zero: bool) -> Option<S> {
        zero_shown(S::ZERO, to, sign, |t| self.unknowns(t).get(index).copied().unwrap_or(S::ZERO))
    }
}

/// Integrator of a block with a device.
pub trait ModeIntegrator<S: Real> {
    /// Mode output of its steps.
    type Output<'a>: ModeOutput<S>
    where
        Self: 'a;

    /// The step from `start`.
    fn integrate<'a>(&'a self, start: &'a ModeStart<'a, S>) -> Self::Output<'a>;

    /// Fixed step (s), if the method has one.
    fn step(&self) -> Option<S>;
}
