//! Impacts that accumulate to rest under a pulse, and the ground acceleration that uplifts the block again.

use std::f64::consts::PI;

use sprag_shared::math;
use sprag_shared::motion::rest::impact_accumulation::Accumulation;
use sprag_shared::structure::{COUNTED_SPEED, REST_SPEED};

use crate::model::Model;
use crate::plain::PlainBlock;

/// θ̇/(pα) after an impact below which the next ones are summed.
pub const WEAK_IMPACT: f64 = REST_SPEED;

/// A sine A sin(ωt + φ), in units of the uplift threshold, as long as it lasts.
#[derive(Clone, Copy, Debug)]
pub struct Sine {
    /// |A|, above 1.
    pub amplitude: f64,
    /// Angular frequency ω.
    pub frequency: f64,
    /// Phase φ, rad.
    pub phase: f64,
    /// End of the sine.
    pub duration: f64,
}

/// Decision after a weak impact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AfterWeakImpact {
    /// It rests until the pulse is over.
    Rests,
    /// It uplifts again at `time`.
    Uplifts {
        /// Time from the start of the pulse.
        time: f64,
        /// Whole half-cycles of the sine before that; if their number is even, to the side to which it lifts first.
        half_cycles: f64,
    },
    /// The ground acceleration prevents rest.
    Unsettled,
}

/// Impact accumulation after a weak impact, which leaves `block` with `speed` (rad; p = 1) on a side where the ground acceleration is `push`
/// (in units of the threshold, positive inward, below 1).
pub fn tail<M: Model, const PAIR: bool>(push: f64, speed: f64, block: &PlainBlock) -> Accumulation<f64> {
    let PlainBlock { slenderness: alpha, restitution, .. } = *block;
    let (outward, inward) = block.couplings::<PAIR>();
    let rates = |push: f64| {
        let held = 1.0 + push;
        (held * M::rate(alpha, outward), held * M::rate(alpha, inward))
    };
    Accumulation::of(rates(push), rates(-push), restitution, speed, COUNTED_SPEED * alpha)
}

impl Sine {
    /// Decision after an impact at `time`, with the time of the rest, and the impacts ([`tail`]) until then.
    pub fn after_weak_impact<M: Model, const PAIR: bool>(
        &self,
        time: f64,
        push: f64,
        speed: f64,
        block: &PlainBlock,
    ) -> (AfterWeakImpact, f64, Option<Accumulation<f64>>) {
        if push.abs() >= 1.0 {
            return (AfterWeakImpact::Unsettled, time, None);
        }
        let tail = tail::<M, PAIR>(push, speed, block);
        let rested = time + tail.duration;
        let angle = self.frequency * rested + self.phase;
        if rested > self.duration || (self.amplitude * math::sin(angle)).abs() >= 1.0 {
            return (AfterWeakImpact::Unsettled, rested, None);
        }
        let first = math::asin(1.0 / self.amplitude);
        let half_cycles = ((angle - first) / PI).ceil().max(0.0);
        let time = (first + half_cycles * PI - self.phase) / self.frequency;
        let next = if time >= self.duration { AfterWeakImpact::Rests } else { AfterWeakImpact::Uplifts { time, half_cycles } };
        (next, rested, Some(tail))
    }
}
