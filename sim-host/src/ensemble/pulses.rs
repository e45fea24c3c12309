//! Blocks under one cycle of a sine or a cosine, as many as there are: a lane whose block is done takes the next.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use sprag_shared::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::carried::Carried;
use sprag_shared::clutch::Clutch;
use sprag_shared::equation::Equation;
use sprag_shared::free_motion::{FreeMotion, Legs};
use sprag_shared::ground::Harmonics;
use sprag_shared::lever::Mount;
use sprag_shared::math::{self, RECIPROCALS};
use sprag_shared::observer::Peaks;
use sprag_shared::rocking::{Limits, Phase, State, System};
use sprag_shared::scalar::Scalar;
use sprag_shared::structure::{Device, DeviceKind, KinematicsKind, REST_SPEED, Restitution, Structure, WithSystem};
use sprag_shared::taylor::Taylor;

use super::blocks::{Blocks, Bounds};
use super::model::Model;
use super::rest::{AfterWeakImpact, Sine, WEAK_IMPACT};
use super::series::Series;
use super::shaken::Shaken;
use super::{Mask, Number, WIDTH, number};
use crate::batch::case::{Case, CaseError, PulseShape, TERMS, TIGHT};
use crate::outcome::Outcome;

/// Coefficients of θ: with more, steps hardly get longer, because events cut them.
const SERIES_TERMS: usize = 18;

/// Size of the last terms of a step's series over α.
pub const TOLERANCE: f64 = 3e-15;

/// Steps of one block before it is left to the core; most take a dozen.
const MOST_STEPS: u32 = 400;

/// How far beyond the threshold a pulse must go for the lanes: nearer, rounding decides whether the block uplifts.
const PLAIN_UPLIFT: f64 = 1.0 + 1e-9;

/// A dimensionless block under a one-cycle pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulsedBlock {
    /// Full or slender.
    pub geometry: Geometry,
    /// Its device, at the centre of mass, paper kinematics.
    pub device: DeviceKind,
    /// α, rad.
    pub slenderness: f64,
    /// k = σ/λ; for the slender model kℓ², with any mount.
    pub coupling: f64,
    /// η.
    pub restitution: f64,
    /// Shape of the pulse.
    pub pulse: PulseShape,
    /// ω_g/p.
    pub frequency_ratio: f64,
    /// a_g/(g tan α), or a_g/(gα) for the slender model.
    pub amplitude_ratio: f64,
}

/// What becomes of it, decided without a horizon: a block that stands goes on until it rests.
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

    fn overturned(impact: bool) -> PulseResult {
        let outcome = if impact { Outcome::OverturnedAfterImpact } else { Outcome::OverturnedWithoutImpact };
        PulseResult { outcome, peak_rotation: f64::NAN, peak_acceleration: f64::NAN }
    }
}

impl From<&Case> for PulsedBlock {
    fn from(case: &Case) -> PulsedBlock {
        PulsedBlock {
            geometry: case.geometry,
            device: case.device,
            slenderness: case.slenderness,
            coupling: if case.device == DeviceKind::None { 0.0 } else { case.mass_ratio / RECTANGLE_INERTIA_RATIO },
            restitution: case.restitution,
            pulse: case.pulse,
            frequency_ratio: case.frequency_ratio,
            amplitude_ratio: case.amplitude_ratio,
        }
    }
}

impl PulsedBlock {
    /// The block in units of 1/p.
    fn structure(&self) -> Result<Structure, CaseError> {
        Ok(Structure {
            block: Block::of_unit_frequency(self.slenderness, RECTANGLE_INERTIA_RATIO)?,
            geometry: self.geometry,
            device: Device {
                kind: self.device,
                mass_ratio: self.coupling * RECTANGLE_INERTIA_RATIO,
                mount: Mount::CentreOfMass,
                kinematics: KinematicsKind::Paper,
            },
            carried: Carried::NONE,
            restitution: Restitution::Constant(self.restitution),
            rest_speed: REST_SPEED,
        })
    }

    /// What becomes of it, by the core: one step of one block at a time.
    ///
    /// # Errors
    /// [`CaseError`] for a parameter outside its range, or a motion that cannot be followed.
    pub fn follow<M: Model, C: Clutch>(&self, method: &Taylor<f64, TERMS>) -> Result<PulseResult, CaseError> {
        let structure = self.structure()?;
        let (state, peaks) = structure.resolve(OverThePulse { pulsed: self, structure: &structure, method })??;
        if !peaks.rocked {
            return Ok(PulseResult::NO_ROCKING);
        }
        let impact = peaks.first_impact.is_some();
        Ok(match state.phase {
            Phase::Overturned => PulseResult::overturned(impact),
            Phase::Rest => self.stands(peaks.rotation, peaks.acceleration),
            Phase::Rocking => {
                let (rotation, velocity) = (state.side.times(state.rotation), state.side.times(state.velocity));
                self.settle::<M, C>(rotation, velocity, (peaks.rotation, peaks.acceleration), impact)
            }
        })
    }

    /// κ k on quiet ground while it moves outward and while it moves inward.
    fn couplings<C: Clutch>(&self) -> (f64, f64) {
        (if C::FOLLOWS_SIGNS { 0.0 } else { self.coupling }, self.coupling)
    }

    fn stands(&self, rotation: f64, acceleration: f64) -> PulseResult {
        let alpha = self.slenderness;
        PulseResult { outcome: Outcome::Safe, peak_rotation: rotation / alpha, peak_acceleration: acceleration / alpha }
    }

    /// What becomes of a motion that the pulse leaves at |θ| = `rotation` with the outward `velocity` and these peaks.
    #[inline]
    fn settle<M: Model, C: Clutch>(&self, rotation: f64, velocity: f64, peaks: (f64, f64), impact: bool) -> PulseResult {
        let (outward, inward) = self.couplings::<C>();
        let legs = Legs { outward: M::integral(outward), returning: M::integral(outward), inward: M::integral(inward) };
        let motion = FreeMotion { slenderness: self.slenderness, restitution: self.restitution, legs };
        let settled = motion.settle(rotation, velocity);
        if settled.overturned {
            return PulseResult::overturned(impact || settled.impact);
        }
        self.stands(peaks.0.max(settled.rotation), peaks.1.max(settled.acceleration))
    }
}

/// Follows a block by the core to the end of its pulse.
struct OverThePulse<'a> {
    pulsed: &'a PulsedBlock,
    structure: &'a Structure,
    method: &'a Taylor<f64, TERMS>,
}

impl WithSystem<f64> for OverThePulse<'_> {
    type Output = Result<(State<f64>, Peaks<f64>), CaseError>;

    fn with<R: Equation<f64>, E: Equation<f64>, C: Clutch>(self, system: System<f64, R, E, C>) -> Self::Output {
        let PulsedBlock { pulse, frequency_ratio, amplitude_ratio, .. } = *self.pulsed;
        let amplitude = amplitude_ratio * system.uplift;
        let ground = match pulse {
            PulseShape::Sine => Harmonics::sine(amplitude, frequency_ratio),
            PulseShape::Cosine => Harmonics::cosine(amplitude, frequency_ratio),
        };
        let overturned = self.structure.geometry.point_of_no_return(&self.structure.block, amplitude.abs());
        let (mut state, mut peaks) = (State::default(), Peaks::default());
        let limits = Limits { overturned, events: 1_000_000 };
        system.advance(self.method, &mut state, &ground, TAU / frequency_ratio, &limits, &mut peaks)?;
        Ok((state, peaks))
    }
}

/// The pulses of the blocks in the lanes, each in its block's mirror.
struct Pulses {
    amplitude: Number,
    frequency: Number,
    phase: Number,
    time: Number,
    duration: Number,
}

impl Pulses {
    /// The pulse of one lane, in units of the threshold.
    fn sine(&self, lane: usize, block: &PulsedBlock) -> Sine {
        let (frequency, phase, duration) = (self.frequency.0[lane], self.phase.0[lane], self.duration.0[lane]);
        Sine { amplitude: block.amplitude_ratio.abs(), frequency, phase, duration }
    }

    /// ü_g/g about the present time: c_{k+2} = −ω² c_k/((k+1)(k+2)).
    #[inline(always)]
    fn series(&self, side: Number, coefficients: &mut [Number]) {
        let angle = self.frequency * self.time + self.phase;
        let angle = angle.exceeds(number(PI)).choose(angle - number(TAU), angle);
        let (sine, cosine) = Scalar::sin_cos(angle);
        let amplitude = self.amplitude * side;
        let mut next = [amplitude * sine, amplitude * cosine * self.frequency];
        let factor = -(self.frequency * self.frequency);
        for (k, coefficient) in coefficients.iter_mut().enumerate() {
            let value = &mut next[k & 1];
            *coefficient = *value;
            *value = *value * factor * number(RECIPROCALS[(k + 1) & 63] * RECIPROCALS[(k + 2) & 63]);
        }
    }
}

/// Runs all `pulsed` blocks, which have the model `M` and the clutch `C`, into `results`, one each.
///
/// # Errors
/// The first [`CaseError`], with the number of its block; parameters are checked by the core when it is asked to follow a block.
#[inline(always)]
pub(super) fn run<M: Model, C: Clutch>(pulsed: &[PulsedBlock], results: &mut [PulseResult]) -> Result<(), (usize, CaseError)> {
    let zero = number(0.0);
    let one = number(1.0);
    let method = Taylor::<f64, TERMS>::adaptive(TIGHT);
    let mut series = Series::<SERIES_TERMS>::default();
    let mut blocks = Blocks::default();
    // Idle lanes go through the motions of a harmless block.
    let (mut slenderness, mut coupling) = (one, zero);
    let mut pulses = Pulses { amplitude: zero, frequency: one, phase: zero, time: zero, duration: one };
    let mut bounds = Bounds { restitution: zero, no_return: one, weak: zero, counted: zero, tolerance: one };
    let mut at = [None; WIDTH];
    let mut steps = [0_u32; WIDTH];
    let mut rests = Mask::NONE;
    let mut done = Mask::ALL;
    let mut next = 0;
    // Neighbours are mostly of one slenderness.
    let mut threshold = (f64::NAN, f64::NAN);
    loop {
        if done.any() {
            for lane in (0..WIDTH).filter(|&lane| done.at(lane)) {
                if let Some(index) = at[lane] {
                    let block: &PulsedBlock = &pulsed[index];
                    results[index] = if blocks.hard.at(lane) {
                        block.follow::<M, C>(&method).map_err(|error| (index, error))?
                    } else if blocks.overturned.at(lane) {
                        PulseResult::overturned(blocks.impact.at(lane))
                    } else if rests.at(lane) {
                        block.stands(blocks.peak_rotation.0[lane], blocks.peak_acceleration.0[lane])
                    } else {
                        let peaks = (blocks.peak_rotation.0[lane], blocks.peak_acceleration.0[lane]);
                        block.settle::<M, C>(blocks.rotation.0[lane], blocks.velocity.0[lane], peaks, blocks.impact.at(lane))
                    };
                }
                at[lane] = None;
                while at[lane].is_none() && next < pulsed.len() {
                    let block = &pulsed[next];
                    if plain(block) {
                        at[lane] = Some(next);
                        if threshold.0 != block.slenderness {
                            threshold = (block.slenderness, M::uplift_threshold(block.slenderness));
                        }
                        // A push to the positive side lifts the block to the other; the sign of the pulse only mirrors the motion.
                        let amplitude = block.amplitude_ratio.abs() * threshold.1;
                        let sine = block.pulse == PulseShape::Sine;
                        slenderness.0[lane] = block.slenderness;
                        coupling.0[lane] = block.coupling;
                        pulses.amplitude.0[lane] = -amplitude;
                        pulses.frequency.0[lane] = block.frequency_ratio;
                        pulses.phase.0[lane] = if sine { 0.0 } else { FRAC_PI_2 };
                        pulses.duration.0[lane] = TAU / block.frequency_ratio;
                        let uplift = || math::asin(1.0 / block.amplitude_ratio.abs()) / block.frequency_ratio;
                        pulses.time.0[lane] = if sine { uplift() } else { 0.0 };
                        bounds.restitution.0[lane] = block.restitution;
                        bounds.no_return.0[lane] = match M::GEOMETRY {
                            Geometry::Full => (block.slenderness + math::atan(amplitude)).min(FRAC_PI_2),
                            Geometry::Slender => block.slenderness + amplitude,
                        };
                        bounds.weak.0[lane] = WEAK_IMPACT * block.slenderness;
                        bounds.tolerance.0[lane] = TOLERANCE * block.slenderness;
                        blocks.renew(lane);
                        blocks.uplift(lane, 1.0, sine);
                        rests.set(lane, false);
                        steps[lane] = 0;
                    } else {
                        results[next] = block.follow::<M, C>(&method).map_err(|error| (next, error))?;
                    }
                    next += 1;
                }
                if at[lane].is_none() {
                    // Nothing left: whatever the lane goes on with is plain.
                    blocks.hard.set(lane, true);
                }
            }
            if at.iter().all(Option::is_none) {
                return Ok(());
            }
        }
        pulses.series(blocks.side, &mut series.ground[..SERIES_TERMS - 2]);
        let left = pulses.duration - pulses.time;
        let went = blocks.step::<M::Equation, C, SERIES_TERMS>(&M::modes(slenderness, coupling), &bounds, &mut series, left);
        pulses.time = pulses.time + went;
        for (lane, count) in steps.iter_mut().enumerate() {
            *count += 1;
            if *count > MOST_STEPS {
                blocks.hard.set(lane, true);
            }
        }
        let weak = blocks.weak;
        if weak.any() {
            for lane in (0..WIDTH).filter(|&lane| weak.at(lane)) {
                let Some(block) = at[lane].map(|index: usize| &pulsed[index]) else { continue };
                let sine = pulses.sine(lane, block);
                let push = sine.amplitude * math::sin(sine.frequency * pulses.time.0[lane] + sine.phase) * -blocks.side.0[lane];
                let motion = (blocks.velocity.0[lane], block.restitution, block.slenderness);
                let couplings = block.couplings::<C>();
                match sine.after_weak_impact::<M>(pulses.time.0[lane], push, motion, couplings) {
                    AfterWeakImpact::Rests => rests.set(lane, true),
                    AfterWeakImpact::Uplifts { time, first_side } => {
                        pulses.time.0[lane] = time;
                        blocks.uplift(lane, if first_side { 1.0 } else { -1.0 }, true);
                    }
                    AfterWeakImpact::Unsettled => blocks.hard.set(lane, true),
                }
            }
        }
        done = !left.exceeds(went) | blocks.overturned | blocks.hard | rests;
    }
}

/// The lanes may take it: parameters as the core would accept them, and no doubt whether it uplifts.
fn plain(block: &PulsedBlock) -> bool {
    let PulsedBlock { slenderness, coupling, restitution, frequency_ratio, amplitude_ratio, .. } = *block;
    (1e-4..1.5).contains(&slenderness)
        && (0.0..=1e3).contains(&coupling)
        && (0.0..=1.0).contains(&restitution)
        && (1e-3..1e3).contains(&frequency_ratio)
        && (PLAIN_UPLIFT..1e4).contains(&amplitude_ratio.abs())
}
