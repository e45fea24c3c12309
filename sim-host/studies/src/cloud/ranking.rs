//! Intensity measures ranked by efficiency, for each structure, device and demand.

use serde::Serialize;

use super::demand::Demand;
use super::measure::Measure;
use super::runs::Run;
use crate::statistics::{Efficiency, IntensityMeasure, rank};

/// How well each measure predicts one demand.
#[derive(Clone, Debug, Serialize)]
pub struct Ranking {
    /// The structure.
    pub structure: String,
    /// The device.
    pub device: String,
    /// Demand that the measures are ranked by.
    pub demand: Demand,
    /// Runs in it: those in which the block rocks and stands and no measure is 0, so that all measures predict the same demands.
    pub runs: usize,
    /// Measures in order.
    #[serde(flatten)]
    pub efficiency: Efficiency,
}

impl Ranking {
    /// Ranking of `measures` by `runs`.
    pub fn of(runs: &[&Run], structure: &str, device: &str, demand: Demand, measures: &[Measure]) -> Ranking {
        let usable = |run: &&Run| measures.iter().all(|measure| run.measure(*measure) > 0.0);
        let (runs, demands): (Vec<&Run>, Vec<f64>) =
            runs.iter().copied().filter(usable).filter_map(|run| Some((run, demand.of(run)?))).unzip();
        let values = |measure: &Measure| IntensityMeasure {
            name: measure.name().to_owned(),
            values: runs.iter().map(|run| run.measure(*measure)).collect(),
        };
        let measures: Vec<IntensityMeasure> = measures.iter().map(values).collect();
        Ranking {
            structure: structure.to_owned(),
            device: device.to_owned(),
            demand,
            runs: runs.len(),
            efficiency: rank(&demands, &measures),
        }
    }
}
