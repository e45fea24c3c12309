//! What a study finds in its runs.

use serde::Serialize;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::interrupt::Interrupt;

use super::comparison::DemandRatio;
use super::demand::{Demand, DemandModel};
use super::overturning::{DeviceFragility, OverturningError};
use super::ranking::Ranking;
use super::runs::{Run, Runs};
use super::study::Study;

/// How the runs of one structure and device end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcomes {
    /// The structure.
    pub structure: String,
    /// The device.
    pub device: String,
    /// Number of all runs.
    pub runs: usize,
    /// Those in which the block never uplifts.
    pub no_rocking: usize,
    /// It rocks and stands.
    pub safe: usize,
    /// It overturns before any impact.
    pub overturned_without_impact: usize,
    /// It overturns after one or more.
    pub overturned_after_impact: usize,
    /// Number of runs that failed.
    pub failed: usize,
}

/// Everything that a study finds.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Findings {
    /// By structure and device.
    #[serde(rename = "runs")]
    pub outcomes: Vec<Outcomes>,
    /// By structure, demand and device.
    pub demand: Vec<DemandModel>,
    /// By structure, demand and device, from the second on.
    pub demand_ratios: Vec<DemandRatio>,
    /// By structure and device.
    pub fragility: Vec<DeviceFragility>,
    /// By structure, demand and device.
    pub ranking: Vec<Ranking>,
}

impl Findings {
    /// What `study` finds in `runs`.
    ///
    /// # Errors
    /// [`OverturningError`] once `interrupt` is set; another is not known to happen.
    pub fn of(study: &Study, runs: &Runs, interrupt: &Interrupt) -> Result<Findings, OverturningError> {
        let mut found = Findings::default();
        let measure = study.file.fragility.measure;
        let asked = |names: &[String], name: &String| names.is_empty() || names.contains(name);
        let fragile = |run: &Run| asked(&study.file.fragility.structures, &study.structures[run.structure].name);
        let highest = runs.all.iter().filter(|run| fragile(run)).map(|run| run.measure(measure)).fold(0.0, f64::max);
        for (number, structure) in study.structures.iter().enumerate() {
            let name = (number, structure.name.as_str());
            let of_device = |device: usize| -> Vec<&Run> {
                runs.all.iter().filter(|run| run.structure == number && run.device == device).collect()
            };
            let by_device: Vec<Vec<&Run>> = (0..study.devices.len()).map(of_device).collect();
            let devices = || study.devices.iter().map(String::as_str).enumerate().zip(&by_device);
            found.outcomes.extend(devices().map(|((_, device), runs)| outcomes(&structure.name, device, runs)));
            if asked(&study.file.demand.structures, &structure.name) {
                for demand in Demand::ALL {
                    let first = found.demand.len();
                    for (device, runs) in devices() {
                        found.demand.push(DemandModel::fit(runs, name, device, demand, study.file.demand.measure));
                        found.ranking.push(Ranking::of(runs, name.1, device.1, demand, &study.file.measures));
                    }
                    for (offset, runs) in by_device.iter().enumerate().skip(1) {
                        let models = &found.demand[first..];
                        found.demand_ratios.push(DemandRatio::of(&models[offset], runs, &models[0], &by_device[0]));
                    }
                }
            }
            if asked(&study.file.fragility.structures, &structure.name) {
                let mut fragilities: Vec<DeviceFragility> = Vec::new();
                for (device, runs) in devices() {
                    let fit = DeviceFragility::fit(runs, name, device, measure, study.bootstrap, highest, interrupt)?;
                    fragilities.extend(fit);
                }
                if let Some(first) = fragilities.first().filter(|first| first.device_index == 0).cloned() {
                    fragilities.iter_mut().skip(1).for_each(|fragility| fragility.compare(&first));
                }
                found.fragility.append(&mut fragilities);
            }
        }
        Ok(found)
    }
}

fn outcomes(structure: &str, device: &str, runs: &[&Run]) -> Outcomes {
    let count = |outcome: Option<Outcome>| {
        runs.iter().filter(|run| run.answer.as_ref().ok().map(|answer| answer.outcome) == outcome).count()
    };
    Outcomes {
        structure: structure.to_owned(),
        device: device.to_owned(),
        runs: runs.len(),
        no_rocking: count(Some(Outcome::NoRocking)),
        safe: count(Some(Outcome::Safe)),
        overturned_without_impact: count(Some(Outcome::OverturnedWithoutImpact)),
        overturned_after_impact: count(Some(Outcome::OverturnedAfterImpact)),
        failed: count(None),
    }
}
