//! A standing block that nothing can lift over a piece of ground motion, and whose device waits.

use super::mode_output::Shaking;
use super::{HybridState, HybridSystem};
use crate::drivetrain::clutch_state::Coupling;
use crate::equation::Accelerations;
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::state::Phase;

/// Share of the threshold below which a push certainly stays below it, whatever the rounding.
const CERTAIN: f64 = 0.999;

/// What the ground must exceed to lift a block from its base: with friction it must exceed more.
#[derive(Clone, Copy, Debug)]
pub struct Footing<S> {
    /// Factor of |ü_g/g|, 1/s²; the larger of both sides.
    push: S,
    /// Factor of 1 + v̈_g/g, 1/s²; the smaller of both sides.
    weight: S,
    /// Factor of |ü_s − ü_g|/g, 1/s²; the larger of both sides.
    support: S,
}

impl<S: Real> HybridSystem<S> {
    /// Footing of the block.
    pub fn footing(&self) -> Footing<S> {
        let parameters = &self.transmission.parameters;
        let [(push, weight, arm), (other, light, lever)] = [Sign::Positive, Sign::Negative].map(|side| {
            let configuration = self.body.configuration(side.unit(), S::ZERO);
            let (horizontal, vertical) = self.body.factors(&configuration);
            let arm = self.body.arm(&configuration);
            // However many flywheels a controller has engaged.
            let pushes = [0, 1, 2].map(|locked| parameters.rack_push - S::count(locked) * parameters.support_push);
            let push = pushes.map(|push| (horizontal - arm * push).abs());
            (push[0].larger(push[1]).larger(push[2]), -side.times(vertical), arm.abs())
        });
        let support = S::of(2.0) * parameters.relative_push.abs() * arm.larger(lever);
        Footing { push: push.larger(other), weight: weight.smaller(light), support }
    }

    /// Lets a block stand through `duration` (s) of a ground segment where that is all that can happen: to the same bits as
    /// [`HybridSystem::advance`], which is to be called where it answers `false`.
    #[inline]
    pub fn stands_through(&self, footing: &Footing<S>, state: &mut HybridState<S>, shaking: Shaking<'_, S>, duration: S) -> bool {
        if !self.waits(state, duration) {
            return false;
        }
        let Some(last) = footing.holds(shaking, duration) else { return false };
        self.stay(state, last, duration);
        true
    }

    /// Whether the block stands, and nothing of its device will move for `duration` (s) unless the block does.
    #[inline]
    pub fn waits(&self, state: &HybridState<S>, duration: S) -> bool {
        let waits = state.device.wheels.iter().all(|wheel| {
            wheel.spin == S::ZERO
                && matches!(wheel.coupling, Coupling::Open | Coupling::Locked | Coupling::Viscous)
                && (wheel.pending < S::ZERO || wheel.pending > duration)
        });
        let carried = state.device.terminals.is_some();
        state.motion.phase == Phase::Rest
            && waits
            && !carried
            && self.transmission.parameters.rise_time <= S::ZERO
            && duration > S::ZERO
    }

    /// Lets `duration` (s) pass for a block that [`HybridSystem::waits`] on ground that [`Footing::holds`], up to where the ground has the
    /// accelerations `last`.
    #[inline]
    pub fn stay(&self, state: &mut HybridState<S>, last: Accelerations<S>, duration: S) {
        state.device.elapse(duration);
        state.ground = last;
    }
}

impl<S: Real> Footing<S> {
    /// The accelerations at the end of `duration` (s) of a ground segment, if that certainly lifts no block that stands.
    pub fn holds(&self, shaking: Shaking<'_, S>, duration: S) -> Option<Accelerations<S>> {
        let (first, last) = (shaking.at(S::ZERO), shaking.at(duration));
        let bow = |curvature: S| curvature * duration * duration * S::of(0.125);
        let push = first[0].abs().larger(last[0].abs()) + bow(shaking.horizontal.curvature_bound());
        let lift = match shaking.vertical {
            Some(vertical) => first[1].smaller(last[1]) - bow(vertical.curvature_bound()),
            None => S::ZERO,
        };
        let mut push = self.push * push;
        if let Some(support) = shaking.support {
            push = push + self.support * (first[2].abs().larger(last[2].abs()) + bow(support.curvature_bound()));
        }
        (push <= S::of(CERTAIN) * self.weight * (S::ONE + lift)).then_some(last)
    }
}
