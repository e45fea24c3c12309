//! Designs that have been tried, as rows of `tried.csv.unfinished`: what an interrupted search resumes from.

use std::collections::HashMap;
use std::path::Path;

use sprag_report::long_run::error::LongRunError;
use sprag_report::long_run::origin::Origin;
use sprag_report::long_run::row_fields::{FAILED, RowFields};
use sprag_report::long_run::rows::{Plan, Rows};
use sprag_report::long_run::shard::Shard;
use sprag_report::long_run::start::Start;
use sprag_sim::accuracy::ErrorEstimate;
use sprag_sim::simulation::RunError;

use super::design::{Candidate, Responses};
use super::response::Response;

/// More rows than any search makes: how many there will be is not known beforehand.
pub const MOST_ROWS: usize = 1 << 40;

const COLUMNS: [&str; 15] = [
    "curve",
    "mass_ratio",
    "delay_s",
    "motion",
    "outcome",
    "peak_rotation",
    "peak_force_ratio",
    "stroke_m",
    "tooth_stress_mpa",
    "coil_energy_j",
    "failure",
    "outcome_certain",
    "peak_rotation_error",
    "peak_acceleration_error",
    "first_impact_time_error",
];

/// What a search remembers of designs that were tried before, and where it leaves those that it tries.
pub trait Memory {
    /// Why it ends early.
    type Error: From<RunError>;

    /// The responses of a design that was tried before; `None` is the bare block.
    fn recall(&mut self, of: Option<Candidate>) -> Option<Responses>;

    /// Those of one that was tried now.
    ///
    /// # Errors
    /// When they cannot be kept.
    fn keep(&mut self, of: Option<Candidate>, responses: &Responses) -> Result<(), Self::Error>;
}

/// Nothing is remembered.
impl Memory for () {
    type Error = RunError;

    fn recall(&mut self, _of: Option<Candidate>) -> Option<Responses> {
        None
    }

    fn keep(&mut self, _of: Option<Candidate>, _responses: &Responses) -> Result<(), RunError> {
        Ok(())
    }
}

/// The rows of designs, one a motion.
#[derive(Debug)]
pub struct Tried {
    rows: Rows,
    known: HashMap<Place, Responses>,
}

/// Law and mount, and the bits of σ and of the delay; `None` for the bare block.
type Place = Option<(usize, u64, u64)>;

fn place(of: Option<Candidate>) -> Place {
    of.map(|Candidate { curve, mass_ratio, delay_s }| (curve, mass_ratio.to_bits(), delay_s.to_bits()))
}

/// A search that ended early.
#[derive(Debug, thiserror::Error)]
pub enum TriedError {
    /// A run, or an interrupt.
    #[error("{0}")]
    Run(#[from] RunError),
    /// Its rows.
    #[error("{0}")]
    Rows(#[from] LongRunError),
}

impl Tried {
    /// Opens the rows in `folder`, which come from `origin`, of designs under so many `motions`.
    pub fn begin(folder: &Path, origin: Origin, start: Start, motions: usize) -> Result<Tried, LongRunError> {
        let names = COLUMNS.map(str::to_owned);
        let plan = Plan {
            folder,
            shards: folder,
            name: "tried",
            columns: names.to_vec(),
            together: motions,
            shard: Shard::WHOLE,
            origin,
        };
        let mut known: HashMap<Place, Responses> = HashMap::new();
        let rows = Rows::begin(&plan, start, |row, record| {
            let mut fields = RowFields::new(&names, record);
            let place = match fields.text().parse() {
                Ok(curve) => Some((curve, fields.number::<f64>()?.to_bits(), fields.number::<f64>()?.to_bits())),
                Err(_) => {
                    fields.skip(2);
                    None
                }
            };
            fields.require(&(row % motions).to_string())?;
            known.entry(place).or_default().push(response(&mut fields)?);
            Ok(())
        })?;
        Ok(Tried { rows, known })
    }

    /// What to say of a search that was interrupted.
    pub fn interrupted(&self) -> LongRunError {
        LongRunError::Stopped { done: self.rows.done() }
    }

    /// Removes the rows: what they led to is written.
    pub fn discard(self) -> Result<(), LongRunError> {
        self.rows.discard()
    }
}

impl Memory for Tried {
    type Error = TriedError;

    fn recall(&mut self, of: Option<Candidate>) -> Option<Responses> {
        self.known.remove(&place(of))
    }

    fn keep(&mut self, of: Option<Candidate>, responses: &Responses) -> Result<(), TriedError> {
        let design = match of {
            None => [const { String::new() }; 3],
            Some(Candidate { curve, mass_ratio, delay_s }) => {
                [curve.to_string(), format!("{mass_ratio:?}"), format!("{delay_s:?}")]
            }
        };
        let row = |(motion, response): (usize, &Result<Response, String>)| {
            design.iter().cloned().chain([motion.to_string()]).chain(texts(response)).collect()
        };
        Ok(self.rows.append_fields(&responses.iter().enumerate().map(row).collect::<Vec<_>>())?)
    }
}

/// The fields of a response; numbers read back to the same bits.
fn texts(response: &Result<Response, String>) -> [String; 11] {
    let number = |value: f64| format!("{value:?}");
    let maybe = |value: Option<f64>| value.map_or_else(String::new, number);
    match response {
        Err(reason) => [FAILED, "", "", "", "", "", reason, "", "", "", ""].map(str::to_owned),
        Ok(Response { outcome, peak_rotation, force_ratio, stroke_m, tooth_stress_mpa, coil_energy_j, error }) => {
            let error = |value: fn(&ErrorEstimate) -> String| error.as_ref().map_or_else(String::new, value);
            [
                outcome.name().to_owned(),
                maybe(*peak_rotation),
                number(*force_ratio),
                number(*stroke_m),
                maybe(*tooth_stress_mpa),
                maybe(*coil_energy_j),
                String::new(),
                error(|error| error.outcome_certain.to_string()),
                error(|error| format!("{:?}", error.peak_rotation)),
                error(|error| format!("{:?}", error.peak_acceleration)),
                error(|error| format!("{:?}", error.first_impact_time)),
            ]
        }
    }
}

/// What [`texts`] has written.
fn response(fields: &mut RowFields<'_>) -> Result<Result<Response, String>, String> {
    let Some(outcome) = fields.outcome()? else {
        fields.skip(5);
        return Ok(Err(fields.text().to_owned()));
    };
    let (peak_rotation, force_ratio, stroke_m) = (fields.maybe()?, fields.number()?, fields.number()?);
    let (tooth_stress_mpa, coil_energy_j) = (fields.maybe()?, fields.maybe()?);
    fields.skip(1);
    let error = fields.error_estimate()?;
    Ok(Ok(Response { outcome, peak_rotation, force_ratio, stroke_m, tooth_stress_mpa, coil_energy_j, error }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprag_shared::observers::outcome::Outcome;

    fn origin(seed: u32) -> Origin {
        let subject = sprag_report::output::Subject::new("optimise", std::collections::BTreeMap::new());
        Origin::new(subject.with("seed", &seed).unwrap(), MOST_ROWS)
    }

    /// Everything that a run may answer, and what is left of a process that was killed in the middle of a row.
    #[test]
    fn designs_read_back_as_they_were_kept() {
        let folder = tempfile::tempdir().unwrap();
        let error = ErrorEstimate {
            outcome_certain: false,
            peak_rotation: f64::INFINITY,
            peak_acceleration: 1e-300,
            first_impact_time: 0.1,
        };
        let stands = Response {
            outcome: Outcome::Safe,
            peak_rotation: Some(0.1 + 0.2),
            force_ratio: 1.0 / 3.0,
            stroke_m: 5e-324,
            tooth_stress_mpa: Some(1.0 / 7.0),
            coil_energy_j: None,
            error: Some(error),
        };
        let falls = Response { outcome: Outcome::OverturnedAfterImpact, peak_rotation: None, error: None, ..stands };
        let designs = [
            (None, vec![Ok(stands), Ok(falls)]),
            (Some(Candidate { curve: 2, mass_ratio: 0.1, delay_s: 0.005 }), vec![Err("one, \"two\"".to_owned()), Ok(stands)]),
        ];
        let mut tried = Tried::begin(folder.path(), origin(1), Start::New, 2).unwrap();
        for (candidate, responses) in &designs {
            assert_eq!(tried.recall(*candidate), None);
            tried.keep(*candidate, responses).unwrap();
        }
        drop(tried);
        let path = folder.path().join("tried.csv.unfinished");
        let mut text = std::fs::read(&path).unwrap();
        // A design of which the second motion is missing, and half of a row.
        text.extend(b"2,0.2,0.0,0,safe,0.1,0.2,0.3,,,,,,,\n2,0.2,0.0,1,sa");
        std::fs::write(&path, &text).unwrap();

        assert!(matches!(Tried::begin(folder.path(), origin(1), Start::New, 2), Err(LongRunError::Unfinished { .. })));
        assert!(matches!(Tried::begin(folder.path(), origin(2), Start::Resume, 2), Err(LongRunError::OtherRun { .. })));
        let mut tried = Tried::begin(folder.path(), origin(1), Start::Resume, 2).unwrap();
        assert_eq!(tried.known.len(), 2);
        for (candidate, responses) in &designs {
            assert_eq!(tried.recall(*candidate).as_ref(), Some(responses));
        }
        assert_eq!(tried.recall(Some(Candidate { curve: 2, mass_ratio: 0.2, delay_s: 0.0 })), None);
        tried.discard().unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
