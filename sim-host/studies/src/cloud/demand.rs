//! Demand models: the power law of each structure and device, and the runs that it leaves out.

use serde::Serialize;
use sprag_shared::observers::outcome::Outcome;

use super::measure::Measure;
use super::runs::Run;
use crate::statistics::{DemandPoint, PowerLaw};

/// What is demanded of a block that stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Demand {
    /// max |θ|/α.
    PeakRotation,
    /// max |θ̈|/(p²α).
    PeakAcceleration,
}

impl Demand {
    /// Both, as in the two parts of Figure 15.
    pub const ALL: [Demand; 2] = [Demand::PeakRotation, Demand::PeakAcceleration];

    /// Name of the demand in tables.
    pub fn name(self) -> &'static str {
        match self {
            Demand::PeakRotation => "peak-rotation",
            Demand::PeakAcceleration => "peak-acceleration",
        }
    }

    /// Its formula in the markup of axis titles.
    pub fn axis_title(self) -> &'static str {
        match self {
            Demand::PeakRotation => "max |θ|/α",
            Demand::PeakAcceleration => "max |θ''|/(*p*²α)",
        }
    }

    /// Its value in `run`, positive where the block rocks and stands.
    pub fn of(self, run: &Run) -> Option<f64> {
        let answer = run.answer.as_ref().ok().filter(|answer| answer.outcome == Outcome::Safe)?;
        match self {
            Demand::PeakRotation => answer.peak_rotation,
            Demand::PeakAcceleration => answer.peak_acceleration,
        }
        .filter(|demand| *demand > 0.0)
    }
}

/// Runs that have no place in a power law, by reason; the first that applies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// They failed.
    pub failed: usize,
    /// The block never uplifts.
    pub no_rocking: usize,
    /// It overturns.
    pub overturned: usize,
    /// The measure is 0, or the demand is.
    pub zero: usize,
}

/// The demand of one structure and device as a power of an intensity measure (Eq. 24-25), over the runs in which the block rocks
/// and stands.
#[derive(Clone, Debug, Serialize)]
pub struct DemandModel {
    /// Number of the structure.
    #[serde(skip)]
    pub structure_index: usize,
    /// The structure.
    pub structure: String,
    /// Number of the device.
    #[serde(skip)]
    pub device_index: usize,
    /// The device.
    pub device: String,
    /// Demand of the law.
    pub demand: Demand,
    /// IM.
    pub measure: Measure,
    /// Number of all runs.
    pub runs: usize,
    /// Runs that are not in the law.
    pub left_out: LeftOut,
    /// The law; null where there is none.
    pub law: Option<PowerLaw>,
    /// Reason why there is no law.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Smallest and largest intensity in it.
    pub intensity_range: Option<[f64; 2]>,
    /// What it was fitted to.
    #[serde(skip)]
    pub points: Vec<DemandPoint>,
}

impl DemandModel {
    /// The model of `runs`, which are all those of structure and device number `structure.0` and `device.0`.
    pub fn fit(runs: &[&Run], structure: (usize, &str), device: (usize, &str), demand: Demand, measure: Measure) -> DemandModel {
        let mut left_out = LeftOut::default();
        let mut points = Vec::new();
        for run in runs {
            let intensity = run.measure(measure);
            match (&run.answer, demand.of(run)) {
                (Err(_), _) => left_out.failed += 1,
                (Ok(answer), _) if answer.outcome == Outcome::NoRocking => left_out.no_rocking += 1,
                (Ok(answer), _) if answer.outcome.overturned() => left_out.overturned += 1,
                (_, Some(demand)) if intensity > 0.0 => points.push(DemandPoint { intensity, demand }),
                _ => left_out.zero += 1,
            }
        }
        let law = PowerLaw::fit(&points);
        let intensities = || points.iter().map(|point| point.intensity);
        let range = [intensities().fold(f64::INFINITY, f64::min), intensities().fold(0.0, f64::max)];
        DemandModel {
            structure_index: structure.0,
            structure: structure.1.to_owned(),
            device_index: device.0,
            device: device.1.to_owned(),
            demand,
            measure,
            runs: runs.len(),
            left_out,
            reason: law.as_ref().err().map(ToString::to_string),
            law: law.ok(),
            intensity_range: (!points.is_empty()).then_some(range),
            points,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(outcome: Outcome, intensity: f64, peak: f64) -> Run {
        Run::of(0, intensity, outcome, peak)
    }

    #[test]
    fn only_blocks_that_rock_and_stand_are_in_the_law() {
        let mut runs: Vec<Run> = (1..=8).map(f64::from).map(|im| run(Outcome::Safe, im, 0.01 * im * im)).collect();
        runs.push(run(Outcome::NoRocking, 0.1, 0.0));
        runs.push(run(Outcome::OverturnedAfterImpact, 9.0, 0.0));
        runs.push(run(Outcome::OverturnedWithoutImpact, 9.0, 0.0));
        runs.push(run(Outcome::Safe, 0.0, 0.3));
        runs.push(run(Outcome::Safe, 0.3, 0.0));
        runs.push(Run { answer: Err("it failed".to_owned()), ..run(Outcome::Safe, 1.0, 1.0) });
        let all: Vec<&Run> = runs.iter().collect();
        let model = DemandModel::fit(&all, (0, "pier"), (0, "none"), Demand::PeakRotation, Measure::Pgv);
        assert_eq!((model.runs, model.points.len()), (14, 8));
        assert_eq!(model.left_out, LeftOut { failed: 1, no_rocking: 1, overturned: 2, zero: 2 });
        let law = model.law.unwrap();
        assert!((law.b - 2.0).abs() < 1e-12 && (law.a - 0.01).abs() < 1e-14);
        assert_eq!(model.intensity_range, Some([1.0, 8.0]));
    }

    #[test]
    fn too_few_points_have_a_reason_and_no_law() {
        let runs = [run(Outcome::Safe, 1.0, 1.0), run(Outcome::NoRocking, 1.0, 0.0)];
        let all: Vec<&Run> = runs.iter().collect();
        let model = DemandModel::fit(&all, (0, "pier"), (0, "none"), Demand::PeakAcceleration, Measure::Pgv);
        assert!(model.law.is_none() && model.reason.unwrap().starts_with("1 points"));
    }
}
