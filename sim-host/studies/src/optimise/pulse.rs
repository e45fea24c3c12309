//! Pulses among the motions of a choice: those of a scene's `[[ground]]`, over several amplitudes and frequencies.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_with::skip_serializing_none;
use sprag_sim::scene::error::KeyPath;
use sprag_sim::scene::ground::{Direction, GroundError, GroundTable, Motion as Kind};
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::scene::schema::KeyOf;
use sprag_sim::scene::{Scene, SceneError};

/// Most pulses of a study.
pub const MOST_PULSES: usize = 10_000;

/// `[[optimise.pulse]]`: the keys of a scene's `[[ground]]`, each with all of its values; every combination is a motion.
#[skip_serializing_none]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PulseTable {
    /// Kind of pulse; records are `records` of the study.
    pub motion: Kind,
    /// Amplitudes a_g/(g tan α), or a_g/(gα) for the slender model.
    #[schemars(inner(range(min = -1e6, max = 1e6)), length(min = 1))]
    pub amplitude_ratio: Option<Vec<f64>>,
    /// Amplitudes a_g.
    #[schemars(inner(range(min = -1e3, max = 1e3)), length(min = 1))]
    pub amplitude_g: Option<Vec<f64>>,
    /// Amplitudes a_g.
    #[schemars(inner(range(min = -1e4, max = 1e4)), length(min = 1))]
    pub amplitude_m_s2: Option<Vec<f64>>,
    /// Velocity amplitudes A of a Mavroeidis-Papageorgiou pulse.
    #[schemars(inner(range(min = -100.0, max = 100.0)), length(min = 1))]
    pub velocity_amplitude_m_s: Option<Vec<f64>>,
    /// Frequencies ω_g/p; or give `frequency_hz`.
    #[schemars(inner(range(min = 1e-3, max = 1e4)), length(min = 1))]
    pub frequency_ratio: Option<Vec<f64>>,
    /// Frequencies; or give `frequency_ratio`.
    #[schemars(inner(range(min = 1e-3, max = 1e3)), length(min = 1))]
    pub frequency_hz: Option<Vec<f64>>,
    /// Lengths of a rectangular pulse; or give `duration_ratio`.
    #[schemars(inner(range(min = 1e-6, max = 1e4)), length(min = 1))]
    pub duration_s: Option<Vec<f64>>,
    /// Lengths of a rectangular pulse, in 1/p; or give `duration_s`.
    #[schemars(inner(range(min = 1e-6, max = 1e4)), length(min = 1))]
    pub duration_ratio: Option<Vec<f64>>,
    /// Oscillations γ of a Mavroeidis-Papageorgiou pulse.
    #[schemars(inner(range(max = 100.0)), transform = crate::cloud::study_file::each_above_one, length(min = 1))]
    pub oscillations: Option<Vec<f64>>,
    /// Phases ν of a Mavroeidis-Papageorgiou pulse.
    #[schemars(inner(range(min = -360.0, max = 360.0)), length(min = 1))]
    pub phase_deg: Option<Vec<f64>>,
}

/// A pulse.
#[derive(Clone, Debug)]
pub struct Pulse {
    /// Its kind and its numbers.
    pub name: String,
    /// The motion of the ground.
    pub ground: GroundMotions,
}

/// Where a value of a pulse goes.
type Place = fn(&mut GroundTable) -> &mut Option<f64>;

impl PulseTable {
    /// Its keys, with their values and where they belong in a scene.
    fn keys(&self) -> [(&'static str, &Option<Vec<f64>>, Place); 10] {
        [
            ("frequency_ratio", &self.frequency_ratio, |table| &mut table.frequency_ratio),
            ("frequency_hz", &self.frequency_hz, |table| &mut table.frequency_hz),
            ("duration_s", &self.duration_s, |table| &mut table.duration_s),
            ("duration_ratio", &self.duration_ratio, |table| &mut table.duration_ratio),
            ("oscillations", &self.oscillations, |table| &mut table.oscillations),
            ("phase_deg", &self.phase_deg, |table| &mut table.phase_deg),
            ("amplitude_ratio", &self.amplitude_ratio, |table| &mut table.amplitude_ratio),
            ("amplitude_g", &self.amplitude_g, |table| &mut table.amplitude_g),
            ("amplitude_m_s2", &self.amplitude_m_s2, |table| &mut table.amplitude_m_s2),
            ("velocity_amplitude_m_s", &self.velocity_amplitude_m_s, |table| &mut table.velocity_amplitude_m_s),
        ]
    }

    fn number(&self) -> usize {
        self.keys().iter().filter_map(|(_, values, _)| values.as_ref()).map(Vec::len).fold(1, usize::saturating_mul)
    }

    /// Its pulses, each with its name.
    fn tables(&self) -> Vec<(String, GroundTable)> {
        let table = GroundTable::of(self.motion);
        let mut all = vec![(table.kind(), table)];
        for (key, values, place) in self.keys() {
            let Some(values) = values else { continue };
            let with = |(name, table): &(String, GroundTable), value: f64| {
                let mut table = table.clone();
                *place(&mut table) = Some(value);
                (format!("{name} {key}={value}"), table)
            };
            all = all.iter().flat_map(|one| values.iter().map(move |&value| with(one, value))).collect();
        }
        all
    }
}

/// The pulses of `tables` for the block of `scene`, in the order of their keys; `key` makes the place of a key of `optimise`.
///
/// # Errors
/// [`SceneError`] for keys that the pulse does not have or needs, and for more than [`MOST_PULSES`].
pub(super) fn pulses(tables: &[PulseTable], scene: &Scene, key: &KeyOf<'_>) -> Result<Vec<Pulse>, SceneError> {
    let number = tables.iter().map(PulseTable::number).fold(0, usize::saturating_add);
    if number > MOST_PULSES {
        return Err(key("pulse").range(number as f64, "at most 10000 pulses"));
    }
    let mut pulses = Vec::with_capacity(number);
    for (index, table) in tables.iter().enumerate() {
        let of_pulse = |name: &str| -> KeyPath { key(&format!("pulse.{index}.{name}")) };
        if table.motion == Kind::Record {
            return Err(of_pulse("motion").conflict("records are `records` of the study"));
        }
        for (name, values, _) in table.keys() {
            of_pulse(name).once(values.as_deref().unwrap_or_default())?;
        }
        for (name, ground) in table.tables() {
            ground.check(Direction::Horizontal, &of_pulse)?;
            let mut shaken = scene.clone();
            shaken.file.ground = vec![ground];
            let ground = shaken.ground_motions().map_err(|error| match error {
                GroundError::Scene(error) => error,
                error => of_pulse("motion").conflict(&error.to_string()),
            })?;
            pulses.push(Pulse { name, ground });
        }
    }
    Ok(pulses)
}
