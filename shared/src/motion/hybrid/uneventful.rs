//! Stretches of a motion without an event, for those who integrate many blocks side by side: they take the mode, follow its equations as far
//! as no guard, nor θ, nor θ̇, reaches zero and nothing is due, and hand the state back.

use super::{HybridState, HybridSystem};
use crate::drivetrain::any_transmission::TransmissionKind;
use crate::drivetrain::clutch_state::{Coupling, FlywheelState, GUARDS, ModeCoefficients};
use crate::equation::any_body::AnyBody;
use crate::equation::body::Body;
use crate::equation::clutch_rule::wheel_for;
use crate::math;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::observer::Observer;
use crate::motion::state::Phase;
use crate::structure::block::Geometry;

impl<S: Real> HybridSystem<S> {
    /// Completes the coefficients of the direction of `state`, with the command that is watched: its opposite while a jolt's sign holds.
    // In the caller's place: a step that copied them would pay as much as for their sum.
    pub(super) fn complete_watching(&self, law: &mut ModeCoefficients<S>, state: &HybridState<S>) {
        let sign = state.motion.terminal_acceleration_sign;
        let watched = if state.jolted { sign.opposite() } else { sign };
        self.transmission.complete(law, watched, &state.device);
    }

    /// Mode in which a rocking block continues until a guard, θ or θ̇ reaches zero, or something is due ([`HybridSystem::next_due`]). None
    /// where more is to be known: at rest, where friction holds it or has just set it free, and where springs stretch.
    pub fn mode(&self, state: &HybridState<S>) -> Option<ModeCoefficients<S>> {
        let plain = state.motion.phase == Phase::Rocking && !state.held && !state.free;
        let firm = state
            .device
            .wheels
            .iter()
            .all(|wheel| matches!(wheel.coupling, Coupling::Open | Coupling::Locked | Coupling::Slipping(_)));
        (plain && firm).then(|| {
            let mut law = ModeCoefficients::of(state.motion.direction);
            self.complete_watching(&mut law, state);
            law
        })
    }

    /// The block has moved for `time` (s) without an event in its [`HybridSystem::mode`] to θ (`rotation`, rad) and θ̇ (`velocity`, rad/s),
    /// under ground that accelerates by `ground` (in g, horizontally and vertically) now; its support moves with that. Open flywheels have
    /// coasted; those whose plates slip have the speeds `spins` (1/s).
    pub fn has_moved(&self, state: &mut HybridState<S>, (rotation, velocity): (S, S), spins: [S; 2], time: S, ground: [S; 2]) {
        (state.motion.rotation, state.motion.velocity) = (rotation, velocity);
        (state.fresh, state.free, state.ground) = ([false; GUARDS], false, [ground[0], ground[1], S::ZERO]);
        let configuration = self.body.configuration(state.motion.side.unit(), rotation);
        let rack = self.body.to_terminal(&configuration, velocity);
        for (wheel, spin) in state.device.wheels.iter_mut().zip(spins) {
            match wheel.coupling {
                Coupling::Locked => wheel.spin = rack,
                Coupling::Slipping(_) => wheel.spin = spin,
                _ => self.transmission.parameters.coast(wheel, time),
            }
        }
        state.device.elapse(time);
    }

    /// The block has stood for `time` (s) under ground that accelerates by `ground` (in g, horizontally and vertically) now; flywheels have
    /// coasted, and the support moves with the ground.
    pub fn has_stood(&self, state: &mut HybridState<S>, time: S, ground: [S; 2]) {
        self.idle(state, time);
        state.ground = [ground[0], ground[1], S::ZERO];
    }

    /// Smallest horizontal ground acceleration, to either side (in g), that lifts the standing block of `state` while 1 + v̈_g/g is at least
    /// `lightest` (above 0).
    pub fn least_uplift(&self, state: &HybridState<S>, lightest: S) -> S {
        let least = |side| self.breakaway(state, side, side).least_horizontal(lightest);
        least(Sign::Positive).smaller(least(Sign::Negative))
    }

    /// Bound of the push on the block, over its weight at its lightest, that decides where it can no longer return
    /// ([`crate::structure::block::Geometry::point_of_no_return`]), under ground accelerations within ±`bound` (in g), accelerations of a
    /// support of its own motion relative to the ground within ±`support` (in g), and a 1 + v̈_g/g of at least `lightest`: a light block
    /// falls under a weaker push, guided racks and flywheels on a support of its own motion are pushed too, and friction of rack, bearings
    /// and plates may hold the block beyond. A spring without a capacity counts for nothing.
    pub fn push_bound(&self, bound: f64, support: f64, lightest: f64) -> f64 {
        let parameters = &self.transmission.parameters;
        let (p2, lever) = (self.body.frequency_squared().to_f64(), self.longest_lever());
        let capacity = parameters.capacity.to_f64();
        let plates = if capacity.is_finite() { capacity } else { 0.0 };
        let bearing = parameters.inertance.to_f64() * parameters.bearing_dry.to_f64();
        let dry = (parameters.rack_dry.to_f64() + 2.0 * (bearing + plates)) * (1.0 + parameters.load_friction.to_f64());
        let at_rack = parameters.rack_push.to_f64() + 2.0 * parameters.support_push.to_f64().abs();
        let (held, pushed) = (lever * dry / p2, lever * at_rack / p2);
        let by_support = 2.0 * lever * parameters.relative_push.to_f64().abs() / p2 * support;
        (bound * (1.0 + pushed) + by_support + held) / lightest
    }

    /// Largest lever of the rack about the toe, over R.
    fn longest_lever(&self) -> f64 {
        match self.body {
            AnyBody::Slender(body) => body.lever.to_f64(),
            AnyBody::Full(body) => {
                let (along, across) = (body.lever.along.to_f64(), body.lever.across.to_f64());
                math::square_root(along * along + across * across)
            }
        }
    }

    /// Largest dry friction at the rack (1/s²) that may stop the fall of `state`: that of the rack, and of each flywheel that is engaged, or about to be,
    /// what holds once it sticks. Only one that turns against the fall brakes it with the capacity of its plates, and so does any behind a spring.
    fn stopping_friction(&self, state: &HybridState<S>) -> S {
        let parameters = &self.transmission.parameters;
        let falls = state.motion.direction;
        let one_way = self.transmission.kind == TransmissionKind::Overrunning;
        let sticking =
            parameters.capacity.smaller(parameters.inertance * parameters.bearing_dry * (S::ONE + parameters.load_friction));
        let of = |(index, wheel): (usize, &FlywheelState<S>)| {
            let holds = if one_way { index == wheel_for(falls) } else { wheel.coupling.is_engaged() || wheel.pending >= S::ZERO };
            let against = wheel.coupling != Coupling::Locked && falls.times(wheel.spin) < S::ZERO;
            match holds {
                false => S::ZERO,
                true if parameters.capacity.is_finite() && (against || self.transmission.traits().springs) => parameters.capacity,
                true => sticking,
            }
        };
        state.device.wheels.iter().enumerate().map(of).fold(parameters.rack_dry, |sum, friction| sum + friction)
    }

    /// Slender or full.
    pub fn geometry(&self) -> Geometry {
        match self.body {
            AnyBody::Slender(_) => Geometry::Slender,
            AnyBody::Full(_) => Geometry::Full,
        }
    }

    /// Ends a motion at `time` (s), on ground that has come to rest ([`crate::motion::state::BlockState::end`]): outward from where
    /// friction holds the block no more. Springs may bring a full block back from anywhere.
    pub fn end(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) {
        if self.geometry() == Geometry::Slender || !self.transmission.traits().springs {
            let bound = self.longest_lever() * (self.stopping_friction(state) / self.body.frequency_squared()).to_f64();
            let no_return = self.geometry().point_of_no_return(self.slenderness.to_f64(), bound);
            state.motion.end(S::of(no_return), time, observer);
        }
    }
}
