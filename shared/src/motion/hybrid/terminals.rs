//! The terminals of a device on a support that moves otherwise than the ground ([`crate::drivetrain::on_support`]).

use super::mode_output::Shaking;
use super::{HybridState, HybridSystem};
use crate::drivetrain::clutch_state::{Guard, ModeCoefficients, Terminals};
use crate::equation::Accelerations;
use crate::equation::body::Body;
use crate::ground::GroundSegment;
use crate::math::polynomial::first_zero_of;
use crate::math::root::zero_shown;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::observer::Observer;

/// Roundings of a speed within which it counts as zero.
const ROUNDINGS: f64 = 64.0;

/// Time for which a standing block's clutches are commanded at once where the support is all but still, over 1/p.
const STRETCH: f64 = 1.0 / 32.0;

/// Sign of a number that is not zero.
fn nonzero<S: Real>(value: S) -> Option<Sign> {
    (value != S::ZERO).then(|| Sign::of(value, Sign::Positive))
}

impl<S: Real> HybridSystem<S> {
    /// What the support's speed gains on the ground between two local times of a segment, as that of the terminals over R; 1/s.
    pub(super) fn support_gain(&self, state: &HybridState<S>, shaking: Shaking<'_, S>, from: S, to: S) -> S {
        if state.device.terminals.is_none() {
            return S::ZERO;
        }
        let gain = |segment: &dyn GroundSegment<S>| segment.gain(to) - segment.gain(from);
        let [ground, support] = self.transmission.parameters.support_rates();
        ground * gain(shaking.horizontal) + shaking.support.map_or(S::ZERO, |segment| support * gain(segment))
    }

    /// Rate of that speed at a local time, 1/s², and its slope.
    fn support_rate(&self, shaking: Shaking<'_, S>, time: S) -> (S, S) {
        let [ground, support] = self.transmission.parameters.support_rates();
        let of = |rate: S, segment: &dyn GroundSegment<S>| (rate * segment.acceleration(time), rate * segment.slope(time));
        let (value, slope) = of(ground, shaking.horizontal);
        let (own, steeper) = shaking.support.map_or((S::ZERO, S::ZERO), |segment| of(support, segment));
        (value + own, slope + steeper)
    }

    /// Carries the support on from `from` to `to`, while the block stands.
    pub(super) fn carry(&self, state: &mut HybridState<S>, shaking: Shaking<'_, S>, from: S, to: S) {
        let gain = self.support_gain(state, shaking, from, to);
        if let Some(terminals) = &mut state.device.terminals {
            let now = terminals.support + gain;
            // Where it turns about, what is left of it is rounding.
            let rate = self.support_rate(shaking, to).0;
            let rounding = S::of(ROUNDINGS) * S::EPSILON * (gain.abs() + rate.abs() * to);
            terminals.support = if now.abs() <= rounding { S::ZERO } else { now };
        }
    }

    /// Whether the support of a block that hits its base moves, or begins to. Where it does not, the rounding that is left of its speed is gone.
    pub(super) fn support_goes(&self, standing: &mut HybridState<S>) -> bool {
        let [ground, support] = self.transmission.parameters.support_rates();
        let accelerates = ground * standing.ground[0] + support * standing.ground[2] != S::ZERO;
        let Some(terminals) = &mut standing.device.terminals else { return false };
        if !accelerates && self.stands_still(terminals) {
            terminals.support = S::ZERO;
        }
        accelerates || terminals.support != S::ZERO
    }

    /// Whether what there is of the support's speed is rounding.
    fn stands_still(&self, terminals: &Terminals<S>) -> bool {
        terminals.support.abs() <= S::of(ROUNDINGS) * S::EPSILON * self.speed
    }

    /// Whether the support stands on the ground between two local times of a segment. Its terminals then turn with the block, and `law` does not
    /// watch them: what rounding has left of its speed may turn them about once more.
    pub(super) fn spare_standing_support(
        &self,
        law: &mut ModeCoefficients<S>,
        state: &HybridState<S>,
        shaking: Shaking<'_, S>,
        (from, to): (S, S),
    ) -> bool {
        let stands = state.device.terminals.is_some_and(|terminals| self.stands_still(&terminals))
            && self.support_rate(shaking, from) == (S::ZERO, S::ZERO)
            && self.support_gain(state, shaking, from, to) == S::ZERO;
        if stands {
            law.watch[1] = Guard::Nothing;
        }
        stands
    }

    /// The block turns, and its terminals with it if their support `stands`.
    pub(super) fn turn_terminals(&self, state: &mut HybridState<S>, stands: bool) {
        if let (true, Some(terminals)) = (stands, &mut state.device.terminals) {
            terminals.direction = state.motion.direction;
        }
    }

    /// Commands of Eq. 10 to the clutches of a standing block, whose terminals move with the support alone. Returns until when its speed and
    /// acceleration keep their signs; `to` where it moves with the ground.
    pub(super) fn drive_at_rest(
        &self,
        state: &mut HybridState<S>,
        shaking: Shaking<'_, S>,
        (from, to): (S, S),
        observer: &mut dyn Observer<S>,
    ) -> S {
        let Some(terminals) = state.device.terminals else { return to };
        if self.lifts_now(state, shaking.at(from)) {
            return to;
        }
        let unit = self.slenderness / self.speed;
        let [ground, support] = self.transmission.parameters.support_rates();
        let rate = |t: S| self.support_rate(shaking, t);
        let (value, slope) = rate(from);
        let own = shaking.support.map_or(S::ZERO, |segment| support.abs() * segment.curvature_bound_from(from));
        let curvature = ground.abs() * shaking.horizontal.curvature_bound() + own;
        // Zeros within rounding of one another are passed together.
        let apart = from + S::of(ROUNDINGS) * S::EPSILON * (from + unit);
        // Where a wavelet fades in, its zeros are lost in the bound of its curvature over more than this.
        let to = if curvature > S::ZERO {
            let waves = (value.abs() / curvature).square_root().larger(slope.abs() / curvature);
            to.smaller((from + waves.larger(S::of(STRETCH) * unit)).larger(apart))
        } else {
            to
        };
        // Until its next zero, and whether one is here. What a zero just passed leaves, or a wavelet has where it begins, is rounding, in which
        // there is another at once.
        let next = |sign: Sign, here: bool| first_zero_of(rate, curvature, (from, to, rate(to).0), sign, here).unwrap_or(to);
        let rounding = S::of(ROUNDINGS) * S::EPSILON * slope.abs() * (from + unit);
        let as_it_is = nonzero(value).filter(|_| value.abs() > rounding).map(|sign| (sign, next(sign, false)));
        let (accelerates, mut until) = match as_it_is.filter(|(_, until)| *until > from) {
            Some((sign, until)) => (Some(sign), until),
            None => (nonzero(slope), nonzero(slope).map_or(to, |sign| next(sign, true))),
        };
        let mut moves = nonzero(terminals.support);
        if let Some(sign) = moves {
            // Its speed is monotone until then.
            let speed = |at: S| terminals.support + self.support_gain(state, shaking, from, at);
            match zero_shown(from, until, sign, speed) {
                Some(turns) if turns > from => until = turns,
                Some(_) => moves = None,
                None => {}
            }
        }
        until = until.larger(apart).smaller(to);
        let moves = moves.or(accelerates);
        let way = moves.map(Sign::opposite);
        if let (Some(way), Some(terminals)) = (way, &mut state.device.terminals) {
            terminals.direction = way;
        }
        if let Some(sign) = accelerates {
            state.motion.terminal_acceleration_sign = sign.opposite();
        }
        if self.transmission.traits().commanded {
            self.ask(state, way.filter(|_| accelerates == moves));
            self.carry_out_at_rest(state, from, observer);
        }
        until
    }

    /// Whether the block of `state` rises at once under `ground`, with its clutches as they are and as they are commanded on its way.
    fn lifts_now(&self, state: &HybridState<S>, ground: Accelerations<S>) -> bool {
        let (side, threshold) = self.lifted(state, ground);
        if !threshold.is_exceeded(ground) {
            return false;
        }
        self.breakaway(&self.sets_out(state, side, ground), side, side).is_exceeded(ground)
    }

    /// The standing block of `state` as it sets out to `side`, with its clutches as they are commanded on its way.
    pub(super) fn sets_out(&self, state: &HybridState<S>, side: Sign, ground: Accelerations<S>) -> HybridState<S> {
        let mut started = HybridState { motion: state.motion.uplifted(side), ground, ..*state };
        self.leave_base(&mut started, S::ZERO, &mut ());
        self.command(&mut started, S::ZERO, &mut ());
        started
    }

    /// Takes the direction of the terminals as it is now; where they stand, the one in which they accelerate.
    pub(super) fn look_at_terminals(&self, state: &mut HybridState<S>) {
        let configuration = self.body.configuration(state.motion.side.unit(), state.motion.rotation);
        let rack = self.body.to_terminal(&configuration, state.motion.velocity);
        if let Some(terminals) = &mut state.device.terminals {
            let speed = rack - terminals.support;
            terminals.direction = Sign::of(speed, state.motion.terminal_acceleration_sign);
            state.fresh[1] = speed == S::ZERO;
        }
    }

    /// The accelerations have jumped: terminals that `stood` go where they accelerate now.
    pub(super) fn terminals_after_jump(&self, state: &mut HybridState<S>, stood: bool) {
        if let (Some(terminals), true) = (&mut state.device.terminals, stood) {
            (terminals.direction, state.fresh[1]) = (state.motion.terminal_acceleration_sign, true);
        }
    }
}
