//! Sensors that cannot be believed: which of them, and why.
//!
//! [`fault`]: the codes; [`actuator`]: clutches that do not follow; [`coil`]: what their currents say; `scale`: whether rest is 1 g. The
//! room imports `structure`, `control::sensing` and `control::ticks`.

pub mod actuator;
mod agreement;
pub mod coil;
pub mod fault;
mod parameters;
mod rest;
pub(in crate::control) mod scale;
mod watch;

pub(super) use parameters::duration;
pub use parameters::{EncoderLimits, FEWEST_WINDOW_TICKS, MonitorParameters, SensorLimits, stuck_time};

use crate::control::sensing::calibration::{Calibration, off_gravity};
use crate::control::sensing::sample::{Reading, Sample};
use crate::control::sensing::sensor::Sensor;
use agreement::{Agreement, AgreementLimits, Disagreement};
use fault::Fault;
use rest::Rest;
use watch::{Watch, WatchLimits};

/// Counts within the fast window that are more than an encoder at rest, between two of its lines, gives.
const MOVING_COUNTS: u32 = 3;

/// Watches the sensors, with times in ticks; made by the supervisor from [`MonitorParameters`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Monitor {
    gyroscope: WatchLimits,
    /// Block, ground.
    accelerometers: [WatchLimits; 2],
    encoder_stale: u32,
    travel: u32,
    agreement: AgreementLimits,
    counts_per_radian: f32,
    quiet_ticks: u32,
    rest_ticks: u32,
    rest_tolerance: f32,
    /// Of a gyroscope that has not, and that has been calibrated.
    rate_tolerances: [f32; 2],
    moving_rate: f32,
    gravity: f32,
}

/// State of the monitor of the sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MonitorState {
    gyroscope: Watch,
    accelerometers: [[Watch; 2]; 2],
    encoder: Watch,
    agreement: Agreement,
    rest: Rest,
    findings: Findings,
}

/// Inputs of the monitor from the rest of the controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Context<'a> {
    /// Biases.
    pub calibration: &'a Calibration,
    /// Whether the biases were measured.
    pub calibrated: bool,
    /// The block has been at rest for long.
    pub at_rest: bool,
    /// ℓ of the rack now over ℓ at |θ| = α/2; 0 where nobody knows it.
    pub lever: f32,
}

/// What was found, in the order of [`Sensor::ALL`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Findings {
    /// Every sensor may be believed, and nothing is wrong, whatever `faults` and `seen` say.
    clean: bool,
    faults: [Option<Fault>; 4],
    seen: [bool; 4],
    /// How far the ground's accelerometer, its bias subtracted, is from (0, g), m/s², where it may be believed.
    pub shaking: f32,
}

impl Findings {
    /// Of sensors of which each may be believed.
    const CLEAN: Findings = Findings { clean: true, faults: [None; 4], seen: [true; 4], shaking: 0.0 };

    /// What is wrong now, the plainest first.
    #[inline]
    pub fn faults(&self) -> [Option<Fault>; 4] {
        if self.clean { [None; 4] } else { self.faults }
    }

    /// Sensors that have given a complete reading.
    #[inline]
    pub fn seen(&self) -> [bool; 4] {
        if self.clean { [true; 4] } else { self.seen }
    }

    /// Sensors that may be believed.
    #[inline]
    pub fn good(&self) -> [bool; 4] {
        if self.clean {
            return [true; 4];
        }
        let [a, b, c, d] = self.faults.map(|fault| fault.is_none());
        [self.seen[0] && a, self.seen[1] && b, self.seen[2] && c, self.seen[3] && d]
    }

    /// Nothing is wrong with any sensor.
    #[inline]
    pub fn nothing(&self) -> bool {
        let [a, b, c, d] = &self.faults;
        self.clean || (a.is_none() && b.is_none() && c.is_none() && d.is_none())
    }
}

impl MonitorState {
    /// Of sensors that are there, those `required`, though nothing has been read yet: a reading is due.
    pub fn expecting(required: [bool; 4]) -> MonitorState {
        let [gyroscope, block, ground, encoder] =
            required.map(|required| if required { Watch::expecting() } else { Watch::default() });
        MonitorState { gyroscope, accelerometers: [[block; 2], [ground; 2]], encoder, ..MonitorState::default() }
    }

    /// What the last tick found.
    #[inline]
    pub fn findings(&self) -> &Findings {
        &self.findings
    }

    /// To be called when the biases change: what was seen with the old ones must not be held against the new.
    pub fn recalibrated(&mut self) {
        self.agreement = Agreement::default();
        self.rest.recalibrated();
    }
}

impl Monitor {
    /// One tick.
    // Has one caller, and much to hand over: what it finds stays where it is, for those who need it.
    #[inline]
    pub fn step<'a>(&self, state: &'a mut MonitorState, sample: &Sample, context: &Context<'_>) -> &'a Findings {
        let rate = sample.gyroscope.value - context.calibration.gyroscope;
        // NaN does not exceed anything.
        let moving = rate.abs() > self.moving_rate || state.agreement.travel() >= MOVING_COUNTS;
        let ([block_limits, ground_limits], [block, ground]) = (&self.accelerometers, &mut state.accelerometers);
        let (block, ground) =
            (block.iter_mut().zip(sample.block_accelerometer), ground.iter_mut().zip(sample.ground_accelerometer));
        let mut well = state.gyroscope.step(sample.gyroscope, &self.gyroscope, moving);
        for (watch, reading) in block {
            if !watch.step(reading, block_limits, moving) {
                well = false;
            }
        }
        for (watch, reading) in ground {
            if !watch.step(reading, ground_limits, moving) {
                well = false;
            }
        }
        if !state.encoder.arrival(sample.encoder.number, &self.encoder_limits()) {
            well = false;
        }
        if !(well && self.within_travel(sample, context)) {
            self.doubted(state, sample, context, rate);
        } else if self.compare(state, sample, context, rate, [true; 4]) {
            state.findings.clean = true;
        } else {
            state.findings = Findings { shaking: state.findings.shaking, ..Findings::CLEAN };
            self.contradicted(state);
        }
        &state.findings
    }

    fn within_travel(&self, sample: &Sample, context: &Context<'_>) -> bool {
        sample.encoder.counts.wrapping_sub(context.calibration.encoder_zero).unsigned_abs() <= self.travel
    }

    /// The same where something may be wrong with a sensor.
    #[inline(never)]
    fn doubted(&self, state: &mut MonitorState, sample: &Sample, context: &Context<'_>, rate: f32) {
        let MonitorState { gyroscope, accelerometers: [block, ground], encoder, .. } = state;
        let [block_limits, ground_limits] = &self.accelerometers;
        let number = [Reading { value: 0.0, number: sample.encoder.number }];
        let mut faults = [
            alone(Sensor::Gyroscope, &[*gyroscope], &[sample.gyroscope], &self.gyroscope),
            alone(Sensor::BlockAccelerometer, block, &sample.block_accelerometer, block_limits),
            alone(Sensor::GroundAccelerometer, ground, &sample.ground_accelerometer, ground_limits),
            alone(Sensor::Encoder, &[*encoder], &number, &self.encoder_limits()),
        ];
        let both = |watches: &[Watch; 2]| watches[0].seen() && watches[1].seen();
        let seen = [gyroscope.seen(), both(block), both(ground), encoder.seen()];
        if seen[3] && faults[3].is_none() && !self.within_travel(sample, context) {
            faults[3] = Some(Fault::Saturated(Sensor::Encoder));
        }
        state.findings = Findings { clean: false, faults, seen, shaking: 0.0 };
        let good = state.findings.good();
        if !self.compare(state, sample, context, rate, good) {
            self.contradicted(state);
        }
    }

    /// Looks at the `good` sensors together: whether none contradicts another. Takes down how far the ground's accelerometer is from (0, g).
    #[inline(always)]
    fn compare(&self, state: &mut MonitorState, sample: &Sample, context: &Context<'_>, rate: f32, good: [bool; 4]) -> bool {
        let off = |readings: [Reading; 2], bias| off_gravity(readings.map(|reading| reading.value), bias, self.gravity);
        let block = good[1].then(|| off(sample.block_accelerometer, context.calibration.block));
        let ground = good[2].then(|| off(sample.ground_accelerometer, context.calibration.ground));
        // An accelerometer whose bias has not been measured may be off by what a calibration takes.
        state.rest.step(context.at_rest && context.calibrated, block, ground, self.rest_tolerance);
        if good[0] && good[3] {
            let [uncalibrated, calibrated] = self.rate_tolerances;
            let tolerance = if context.calibrated { calibrated } else { uncalibrated };
            let scale = self.counts_per_radian * context.lever;
            state.agreement.step(&self.agreement, tolerance, rate, scale, sample.encoder.counts);
        } else {
            // What is missing must not look like a difference later.
            state.agreement = Agreement::default();
        }
        let alone = state.rest.block(self.rest_ticks) || state.rest.ground(self.rest_ticks);
        state.findings.shaking = ground.unwrap_or(0.0);
        !alone && state.agreement.found().is_none()
    }

    /// Adds to what each sensor shows by itself what they show together.
    #[inline(never)]
    fn contradicted(&self, state: &mut MonitorState) {
        state.findings.clean = false;
        let faults = &mut state.findings.faults;
        if state.rest.block(self.rest_ticks) {
            faults[1] = Some(Fault::Contradiction(Sensor::BlockAccelerometer));
        }
        if state.rest.ground(self.rest_ticks) {
            faults[2] = Some(Fault::Contradiction(Sensor::GroundAccelerometer));
        }
        // A block that rocks weighs on one toe, which its accelerometer shows at any rotation: the third witness.
        let gyroscope_alone = state.rest.quiet(self.quiet_ticks);
        match state.agreement.found() {
            Some(Disagreement::Standing | Disagreement::GyroscopeAhead) if gyroscope_alone => {
                faults[0] = Some(Fault::Contradiction(Sensor::Gyroscope));
            }
            Some(Disagreement::Standing) => faults[3] = Some(Fault::Stuck(Sensor::Encoder)),
            Some(_) => faults[3] = Some(Fault::Contradiction(Sensor::Encoder)),
            None => {}
        }
    }

    /// A count has no full scale, and one that repeats is judged with the gyroscope's help only.
    fn encoder_limits(&self) -> WatchLimits {
        use crate::control::ticks::NEVER;
        WatchLimits { stale: self.encoder_stale, stuck: NEVER, stuck_moving: NEVER, full_scale: f32::INFINITY, saturation: NEVER }
    }
}

/// What a sensor of `AXES` readings shows by itself: one axis that is wrong makes it wrong, but only all of them together are stuck, since
/// a sensor freezes as a whole and one axis may repeat by chance.
fn alone<const AXES: usize>(
    sensor: Sensor,
    watches: &[Watch; AXES],
    readings: &[Reading; AXES],
    limits: &WatchLimits,
) -> Option<Fault> {
    let wrong = |(watch, reading): (&Watch, &Reading)| watch.seen() && !reading.value.is_finite();
    if watches.iter().zip(readings).any(wrong) {
        Some(Fault::NotFinite(sensor))
    } else if watches.iter().any(|watch| watch.stale(limits)) {
        Some(Fault::Stale(sensor))
    } else if watches.iter().any(|watch| watch.saturated(limits)) {
        Some(Fault::Saturated(sensor))
    } else if watches.iter().all(|watch| watch.stuck(limits)) {
        Some(Fault::Stuck(sensor))
    } else {
        None
    }
}

#[cfg(test)]
mod tests;
