//! A dimensionless block under one cycle of a pulse, and its outcome.

use sprag_shared::motion::rest::free_motion::FreeMotion;
use sprag_shared::structure::block::Block;

use crate::model::Model;
use crate::plain::PlainBlock;
use crate::shaken::Shaken;
use sprag_shared::observers::outcome::Outcome;

/// How far beyond the threshold a pulse must go to lift a block for certain: nearer, rounding decides.
const PLAIN_UPLIFT: f64 = 1.0 + 1e-9;

/// A one-cycle pulse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PulseShape {
    /// A sin ωt.
    Sine,
    /// A cos ωt.
    Cosine,
}

/// A dimensionless block under a one-cycle pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulsedBlock {
    /// The block.
    pub plain: PlainBlock,
    /// Shape of the pulse.
    pub pulse: PulseShape,
    /// Frequency ratio ω_g/p.
    pub frequency_ratio: f64,
    /// Amplitude ratio a_g/(g tan α), or a_g/(gα) for the slender model.
    pub amplitude_ratio: f64,
}

/// Outcome of a block, decided without a horizon: a block that stands is followed until it rests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseResult {
    /// Outcome.
    pub outcome: Outcome,
    /// max |θ|/α; NaN when overturned.
    pub peak_rotation: f64,
    /// max |θ̈|/(p²α); NaN when overturned.
    pub peak_acceleration: f64,
}

impl PulseResult {
    /// Never uplifted.
    pub const NO_ROCKING: PulseResult = PulseResult { outcome: Outcome::NoRocking, peak_rotation: 0.0, peak_acceleration: 0.0 };

    /// Of a block that a record has shaken.
    pub fn of_shaken(shaken: &Shaken, block: &Block) -> PulseResult {
        let (peak_rotation, peak_acceleration) = shaken.relative_peaks(block).unwrap_or((f64::NAN, f64::NAN));
        PulseResult { outcome: shaken.outcome(), peak_rotation, peak_acceleration }
    }

    pub(crate) fn overturned(impact: bool) -> PulseResult {
        let outcome = if impact { Outcome::OverturnedAfterImpact } else { Outcome::OverturnedWithoutImpact };
        PulseResult { outcome, peak_rotation: f64::NAN, peak_acceleration: f64::NAN }
    }
}

impl PulsedBlock {
    pub(crate) fn stands(&self, rotation: f64, acceleration: f64) -> PulseResult {
        let alpha = self.plain.slenderness;
        PulseResult { outcome: Outcome::Safe, peak_rotation: rotation / alpha, peak_acceleration: acceleration / alpha }
    }

    /// Its motion on quiet ground.
    #[inline]
    pub(crate) fn free_motion<M: Model, const PAIR: bool>(&self) -> FreeMotion<M::Integral> {
        let (outward, inward) = self.plain.couplings::<PAIR>();
        let PlainBlock { slenderness, restitution, .. } = self.plain;
        FreeMotion { slenderness, restitution, outward: M::integral(outward), inward: M::integral(inward) }
    }

    /// Outcome of a motion that the pulse leaves at |θ| = `rotation` with the outward `velocity` and these peaks.
    #[inline]
    pub(crate) fn settle<M: Model, const PAIR: bool>(
        &self,
        rotation: f64,
        velocity: f64,
        peaks: (f64, f64),
        impact: bool,
    ) -> PulseResult {
        let settled = self.free_motion::<M, PAIR>().settle(rotation, velocity);
        if settled.overturned {
            return PulseResult::overturned(impact || settled.impact);
        }
        self.stands(peaks.0.max(settled.rotation), peaks.1.max(settled.acceleration))
    }

    /// Parameters that the lanes may take, as the core would accept them.
    pub(crate) fn is_within_range(&self) -> bool {
        self.plain.is_within_range() && (1e-3..1e3).contains(&self.frequency_ratio) && self.amplitude_ratio.abs() < 1e4
    }

    /// Whether the pulse lifts it; none if rounding decides.
    pub(crate) fn uplifts(&self) -> Option<bool> {
        let amplitude = self.amplitude_ratio.abs();
        if amplitude <= 1.0 {
            return Some(false);
        }
        (amplitude >= PLAIN_UPLIFT).then_some(true)
    }
}
