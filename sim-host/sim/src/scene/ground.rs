//! `[[ground]]` and `[[vertical]]`: the motions whose sums shake the block.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;
use sprag_shared::ground::harmonic::MavroeidisPapageorgiou;
use sprag_shared::ground::{AnySegment, Harmonics, Linear, Ricker};
use sprag_shared::structure::block::GRAVITY;

use super::Scene;
use super::error::{KeyPath, SceneError};
use super::schema::KeyOf;
use crate::ground_motion::Component;
use crate::record::{Component as RecordComponent, ReadOptions, Record, RecordError, RecordSummary, TIME_STEP_RANGE_S, Units};

/// One `[[ground]]` or `[[vertical]]` table.
#[skip_serializing_none]
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroundTable {
    /// Kind of motion.
    pub motion: Motion,
    /// Amplitude a_g/(g tan α), or a_g/(gα) for the slender model; of horizontal motions.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub amplitude_ratio: Option<f64>,
    /// Amplitude a_g.
    #[schemars(range(min = -1e3, max = 1e3))]
    pub amplitude_g: Option<f64>,
    /// Amplitude a_g.
    #[schemars(range(min = -1e4, max = 1e4))]
    pub amplitude_m_s2: Option<f64>,
    /// Velocity amplitude A of a Mavroeidis-Papageorgiou pulse.
    #[schemars(range(min = -100.0, max = 100.0))]
    pub velocity_amplitude_m_s: Option<f64>,
    /// Frequency ω_g/p; or give `frequency_hz`.
    #[schemars(range(min = 1e-3, max = 1e4))]
    pub frequency_ratio: Option<f64>,
    /// Frequency; or give `frequency_ratio`.
    #[schemars(range(min = 1e-3, max = 1e3))]
    pub frequency_hz: Option<f64>,
    /// Length of a rectangular pulse; or give `duration_ratio`.
    #[schemars(range(min = 1e-6, max = 1e4))]
    pub duration_s: Option<f64>,
    /// Length of a rectangular pulse, in 1/p; or give `duration_s`.
    #[schemars(range(min = 1e-6, max = 1e4))]
    pub duration_ratio: Option<f64>,
    /// Oscillations γ of a Mavroeidis-Papageorgiou pulse.
    #[schemars(extend("exclusiveMinimum" = 1.0), range(max = 100.0), example = 2.0)]
    pub oscillations: Option<f64>,
    /// Phase ν of a Mavroeidis-Papageorgiou pulse.
    #[schemars(range(min = -360.0, max = 360.0))]
    pub phase_deg: Option<f64>,
    /// File of a record, relative to the scene.
    #[schemars(example = &"near_fault.csv")]
    pub file: Option<PathBuf>,
    /// Whether the file is one of the command line, whose paths are relative to where the user stands.
    #[serde(skip)]
    pub of_command_line: bool,
    /// Units of a record that does not state its own: g, m/s2, cm/s2 (gal), mm/s2, in/s2 or ft/s2.
    #[schemars(example = &"g")]
    pub units: Option<String>,
    /// Time step of a record that does not state its own.
    #[schemars(range(min = TIME_STEP_RANGE_S.0, max = TIME_STEP_RANGE_S.1))]
    pub time_step_s: Option<f64>,
    /// Component of a record file with several.
    #[schemars(example = &"NS")]
    pub component: Option<String>,
    /// Time step to which a record is resampled linearly.
    #[schemars(range(min = TIME_STEP_RANGE_S.0, max = TIME_STEP_RANGE_S.1))]
    pub resample_to_s: Option<f64>,
    /// Factor on the whole motion.
    #[serde(default = "one")]
    #[schemars(range(min = -1e3, max = 1e3))]
    pub scale: f64,
    /// Start.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1e4))]
    pub start_s: f64,
}

fn one() -> f64 {
    1.0
}

/// The motions of DESIGN section 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Motion {
    /// One cycle of a sine: an amplitude and a frequency.
    Sine,
    /// One cycle of a cosine: an amplitude and a frequency.
    Cosine,
    /// Half a cycle of a sine: an amplitude and a frequency.
    HalfSine,
    /// Constant for a while: an amplitude and a duration.
    Rectangular,
    /// Symmetric Ricker wavelet: an amplitude and a frequency.
    Ricker,
    /// Near-fault velocity pulse: a velocity amplitude, a frequency, `oscillations`, `phase_deg`.
    MavroeidisPapageorgiou,
    /// Recorded motion: `file`, or `--record FILE`.
    Record,
}

/// Which way a motion goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// `[[ground]]`.
    Horizontal,
    /// `[[vertical]]`, positive upwards.
    Vertical,
}

/// A record in memory.
#[derive(Clone, Debug)]
pub struct GivenRecord {
    /// The file, as a motion names it.
    pub file: PathBuf,
    /// What the motion says of its record beside the file; none of a record that is so whatever the motion says.
    pub options: Option<ReadOptions>,
    /// What was read.
    pub record: Record,
}

impl From<Record> for GivenRecord {
    /// The record that motions name by its name.
    fn from(record: Record) -> GivenRecord {
        GivenRecord { file: PathBuf::from(&record.name), options: None, record }
    }
}

impl GivenRecord {
    /// Whether `motion` means this one.
    pub fn is_of(&self, motion: &GroundTable) -> bool {
        motion.file.as_ref() == Some(&self.file) && self.options.as_ref().is_none_or(|options| *options == motion.read_options())
    }
}

/// Why a scene's ground motion cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum GroundError {
    /// The scene.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// A record.
    #[error("{error}{}", key.as_ref().map_or_else(String::new, |KeyPath { origin, key }| format!(", or {key} in {origin}")))]
    Record {
        /// What is wrong with it.
        error: RecordError,
        /// The key of the scene that repairs it, if one does.
        key: Option<KeyPath>,
    },
}

/// x of the Ricker wavelet's first and last instant: e^{-x²} is 1e-16 there.
const RICKER_REACH: f64 = 6.0;

impl GroundTable {
    /// A motion of this kind, without its numbers yet.
    pub fn of(motion: Motion) -> GroundTable {
        GroundTable {
            motion,
            amplitude_ratio: None,
            amplitude_g: None,
            amplitude_m_s2: None,
            velocity_amplitude_m_s: None,
            frequency_ratio: None,
            frequency_hz: None,
            duration_s: None,
            duration_ratio: None,
            oscillations: None,
            phase_deg: None,
            file: None,
            of_command_line: false,
            units: None,
            time_step_s: None,
            component: None,
            resample_to_s: None,
            scale: one(),
            start_s: 0.0,
        }
    }

    /// # Errors
    /// [`SceneError`] for a key that the motion does not have, one that it needs, or a value outside its range.
    pub fn check(&self, direction: Direction, key: &KeyOf<'_>) -> Result<(), SceneError> {
        if direction == Direction::Vertical && self.amplitude_ratio.is_some() {
            let reason = "a vertical motion has no uplift threshold to be a ratio of: give amplitude_g or amplitude_m_s2";
            return Err(key("amplitude_ratio").conflict(reason));
        }
        let given = [
            ("amplitude_ratio", self.amplitude_ratio.is_some()),
            ("amplitude_g", self.amplitude_g.is_some()),
            ("amplitude_m_s2", self.amplitude_m_s2.is_some()),
            ("velocity_amplitude_m_s", self.velocity_amplitude_m_s.is_some()),
            ("frequency_ratio", self.frequency_ratio.is_some()),
            ("frequency_hz", self.frequency_hz.is_some()),
            ("duration_s", self.duration_s.is_some()),
            ("duration_ratio", self.duration_ratio.is_some()),
            ("oscillations", self.oscillations.is_some()),
            ("phase_deg", self.phase_deg.is_some()),
            ("file", self.file.is_some()),
            ("units", self.units.is_some()),
            ("time_step_s", self.time_step_s.is_some()),
            ("component", self.component.is_some()),
            ("resample_to_s", self.resample_to_s.is_some()),
        ];
        const AMPLITUDES: [&str; 3] = ["amplitude_ratio", "amplitude_g", "amplitude_m_s2"];
        let amplitude = if direction == Direction::Vertical { &AMPLITUDES[1..] } else { &AMPLITUDES[..] };
        const FREQUENCY: [&str; 2] = ["frequency_ratio", "frequency_hz"];
        const DURATION: [&str; 2] = ["duration_s", "duration_ratio"];
        let (one_of_each, optional): (&[&[&str]], &[&str]) = match self.motion {
            Motion::Sine | Motion::Cosine | Motion::HalfSine | Motion::Ricker => (&[amplitude, &FREQUENCY], &[]),
            Motion::Rectangular => (&[amplitude, &DURATION], &[]),
            Motion::MavroeidisPapageorgiou => (&[&["velocity_amplitude_m_s"], &FREQUENCY, &["oscillations"]], &["phase_deg"]),
            Motion::Record => (&[], &["file", "units", "time_step_s", "component", "resample_to_s"]),
        };
        for (name, is_given) in given {
            if is_given && !optional.contains(&name) && !one_of_each.iter().any(|group| group.contains(&name)) {
                return Err(key(name).conflict(&format!("a motion of kind {:?} has no such key", self.kind())));
            }
        }
        for group in one_of_each {
            let count = given.iter().filter(|(name, is_given)| *is_given && group.contains(name)).count();
            if count == 0 {
                return Err(key(group[0]).missing(&group.join(" or ")));
            }
            if count > 1 {
                return Err(key(group[0]).conflict(&format!("give only one of {}", group.join(", "))));
            }
        }
        if let Some(units) = &self.units
            && units.parse::<Units>().is_err()
        {
            return Err(key("units").outside(format!("{units:?}"), Units::ALLOWED));
        }
        Ok(())
    }

    /// Its motion as scenes name it.
    pub fn kind(&self) -> String {
        serde_json::to_value(self.motion).ok().and_then(|value| value.as_str().map(str::to_owned)).unwrap_or_default()
    }

    /// The motion's smooth pieces, for the block of `scene`; what was read of a record goes to `records`.
    pub(super) fn component(
        &self,
        scene: &Scene,
        direction: Direction,
        key: &dyn Fn(&str) -> KeyPath,
        records: &mut Vec<RecordSummary>,
    ) -> Result<Component, GroundError> {
        let (p, uplift) = (scene.block.frequency_parameter(), scene.uplift_threshold());
        let amplitude = self.scale
            * self.amplitude_ratio.map_or_else(
                || self.amplitude_g.unwrap_or_else(|| self.amplitude_m_s2.unwrap_or_default() / GRAVITY),
                |ratio| ratio * uplift,
            );
        let frequency = self
            .frequency_ratio
            .map_or_else(|| self.frequency_hz.unwrap_or_default() * core::f64::consts::TAU, |ratio| ratio * p);
        let one = |duration: f64, segment| Component::pulse(self.start_s, duration, segment);
        let cycle = core::f64::consts::TAU / frequency;
        Ok(match self.motion {
            Motion::Sine => one(cycle, AnySegment::Sine(Harmonics::sine(amplitude, frequency))),
            Motion::HalfSine => one(cycle / 2.0, AnySegment::Sine(Harmonics::sine(amplitude, frequency))),
            Motion::Cosine => one(cycle, AnySegment::Sine(Harmonics::cosine(amplitude, frequency))),
            Motion::Rectangular => {
                let duration = self.duration_s.unwrap_or_else(|| self.duration_ratio.unwrap_or_default() / p);
                one(duration, AnySegment::Linear(Linear::constant(amplitude)))
            }
            Motion::Ricker => {
                let rate = frequency / 2.0;
                let centre = RICKER_REACH / rate;
                one(2.0 * centre, AnySegment::Ricker(Ricker { amplitude, rate, centre }))
            }
            Motion::MavroeidisPapageorgiou => {
                let wavelet = MavroeidisPapageorgiou {
                    velocity_amplitude: self.scale * self.velocity_amplitude_m_s.unwrap_or_default(),
                    frequency: frequency / core::f64::consts::TAU,
                    oscillations: self.oscillations.unwrap_or_default(),
                    phase: self.phase_deg.unwrap_or_default().to_radians(),
                };
                one(wavelet.duration(), AnySegment::ThreeSines(wavelet.harmonics()))
            }
            Motion::Record => {
                let record = self.record(scene, direction, key)?;
                records.extend(self.file.as_ref().map(|file| RecordSummary::of(&record, file.display())));
                Component::record(
                    self.start_s,
                    record.time_step_s,
                    record.acceleration_m_s2.iter().map(|a| self.scale * a / GRAVITY),
                )
            }
        })
    }

    /// Where the file of a record is, for a scene in `folder`.
    pub fn path(&self, folder: &Path) -> Option<PathBuf> {
        self.file.as_ref().map(|file| if self.of_command_line { file.clone() } else { folder.join(file) })
    }

    /// What it says of its record beside the file.
    pub fn read_options(&self) -> ReadOptions {
        ReadOptions {
            units: self.units.as_ref().and_then(|units| units.parse().ok()),
            time_step_s: self.time_step_s,
            component: self.component.as_deref().map(RecordComponent::from),
            resample_to_s: self.resample_to_s,
        }
    }

    /// The record of a motion of kind "record", before it is scaled: of those in memory, or else of its file.
    ///
    /// # Errors
    /// [`GroundError`] when no file is named, or it cannot be read.
    pub fn record(&self, scene: &Scene, direction: Direction, key: &KeyOf<'_>) -> Result<Record, GroundError> {
        let needed = match direction {
            Direction::Horizontal => "a record file here, or --record FILE",
            Direction::Vertical => "a record file here, or --record-vertical FILE",
        };
        let file = self.path(&scene.folder).ok_or_else(|| key("file").missing(needed))?;
        let record = match scene.given.iter().find(|given| given.is_of(self)) {
            Some(given) => given.record.clone(),
            None => Record::read(file, &self.read_options())
                .map_err(|error| GroundError::Record { key: error.key().map(key), error })?,
        };
        Ok(if direction == Direction::Horizontal { record.as_horizontal() } else { record })
    }
}
