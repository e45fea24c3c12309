//! The tables of a study for programs, as CSV and Parquet: one row a run, and what the runs say.

use sprag_report::columns::{Column, Fields, RowWriter, Table, TableError, Value};
use sprag_report::long_run::row_fields::FAILED;
use sprag_sim::accuracy::ErrorEstimate;

use super::comparison::DemandRatio;
use super::demand::DemandModel;
use super::findings::Findings;
use super::measure::Measure;
use super::overturning::DeviceFragility;
use super::ranking::Ranking;
use super::records::StudyRecord;
use super::runs::{Answer, Run};
use super::study::Study;
use crate::statistics::{Band, FragilityCurve, PowerLaw, RankedMeasure};

/// `runs`: one run a row. Peaks are max |θ|/α and max |θ̈|/(p²α), empty when overturned; measures are dimensionless, of the scaled
/// record. Where an accuracy was asked for, the last columns are the absolute errors.
#[derive(Clone, Copy)]
pub struct RunsTable<'s> {
    /// Names of structures and devices.
    pub study: &'s Study,
    /// Names of records.
    pub records: &'s [StudyRecord],
    /// The rows.
    pub runs: &'s [Run],
}

/// A run and what it belongs to.
struct RunRow<'s> {
    table: RunsTable<'s>,
    run: &'s Run,
}

impl RunRow<'_> {
    fn answer(&self) -> Option<&Answer> {
        self.run.answer.as_ref().ok()
    }

    fn error(&self) -> Option<&ErrorEstimate> {
        self.answer()?.error.as_ref()
    }
}

fn run_fields<'s>(study: &Study) -> Fields<RunRow<'s>> {
    let number = |name: &str| Column::number(name).or_nothing();
    let mut fields = Fields::<RunRow<'s>>::default()
        .with(Column::text("record"), |row| (&row.table.records[row.run.record].name).into())
        .with(Column::text("structure"), |row| (&row.table.study.structures[row.run.structure].name).into())
        .with(Column::text("device"), |row| (&row.table.study.devices[row.run.device]).into())
        .with(Column::number("scale"), |row| row.run.factor.into())
        .with(number("level"), |row| row.run.level.into());
    for (index, measure) in Measure::ALL.into_iter().enumerate() {
        fields = fields.with(Column::number(measure.name().replace('-', "_")), move |row| row.run.measures[index].into());
    }
    fields = fields
        .with(Column::text("outcome"), |row| row.answer().map_or(FAILED, |answer| answer.outcome.name()).into())
        .with(number("peak_rotation"), |row| row.answer().and_then(|answer| answer.peak_rotation).into())
        .with(number("peak_acceleration"), |row| row.answer().and_then(|answer| answer.peak_acceleration).into())
        .with(Column::count("impacts").or_nothing(), |row| row.answer().map(|answer| answer.impacts).into())
        .with(number("end_time_s"), |row| row.answer().map(|answer| answer.end_time_s).into())
        .with(Column::text("failure").or_nothing(), |row| row.run.answer.as_ref().err().into());
    if !study.asks_for_errors() {
        return fields;
    }
    let certain = |certain: bool| if certain { "true" } else { "false" };
    fields
        .with(Column::text("outcome_certain").or_nothing(), move |row| {
            row.error().map(|error| certain(error.outcome_certain)).into()
        })
        .with(number("peak_rotation_error"), |row| row.error().map(|error| error.peak_rotation).into())
        .with(number("peak_acceleration_error"), |row| row.error().map(|error| error.peak_acceleration).into())
        .with(number("first_impact_time_error_s"), |row| row.error().map(|error| error.first_impact_time).into())
}

impl Table for RunsTable<'_> {
    fn columns(&self) -> Vec<Column> {
        run_fields(self.study).columns()
    }

    fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        let fields = run_fields(self.study);
        self.runs.iter().try_for_each(|run| fields.row(&RunRow { table: *self, run }, writer))
    }
}

/// `demand`: one power law a row, with its ratios to that of the first device.
pub struct DemandTable<'s>(pub &'s Findings);

/// A power law and its ratios.
struct DemandRow<'s> {
    model: &'s DemandModel,
    ratio: Option<&'s DemandRatio>,
}

impl DemandRow<'_> {
    fn law<'v>(&self, value: impl FnOnce(&PowerLaw) -> Option<f64>) -> Value<'v> {
        self.model.law.as_ref().and_then(value).into()
    }

    fn medians<'v>(&self, value: impl FnOnce(super::comparison::MedianRatio) -> f64) -> Value<'v> {
        self.ratio.and_then(|ratio| ratio.medians).map(value).into()
    }

    fn pairs<'v>(&self, value: impl FnOnce(super::comparison::PairRatio) -> f64) -> Value<'v> {
        self.ratio.and_then(|ratio| ratio.pairs).map(value).into()
    }
}

fn demand_fields<'s>() -> Fields<DemandRow<'s>> {
    let number = |name: &str| Column::number(name).or_nothing();
    Fields::<DemandRow<'s>>::default()
        .with(Column::text("structure"), |row| (&row.model.structure).into())
        .with(Column::text("demand"), |row| row.model.demand.name().into())
        .with(Column::text("device"), |row| (&row.model.device).into())
        .with(Column::text("measure"), |row| row.model.measure.name().into())
        .with(Column::count("runs"), |row| row.model.runs.into())
        .with(Column::count("in_law"), |row| row.model.points.len().into())
        .with(Column::count("no_rocking"), |row| row.model.left_out.no_rocking.into())
        .with(Column::count("overturned"), |row| row.model.left_out.overturned.into())
        .with(Column::count("zero"), |row| row.model.left_out.zero.into())
        .with(Column::count("failed"), |row| row.model.left_out.failed.into())
        .with(number("a"), |row| row.law(|law| Some(law.a)))
        .with(number("b"), |row| row.law(|law| Some(law.b)))
        .with(number("ln_a_standard_error"), |row| row.law(|law| Some(law.ln_a_standard_error)))
        .with(number("b_standard_error"), |row| row.law(|law| Some(law.b_standard_error)))
        .with(number("r_squared"), |row| row.law(|law| law.r_squared))
        .with(number("dispersion"), |row| row.law(|law| Some(law.dispersion)))
        .with(number("lowest_intensity"), |row| row.model.intensity_range.map(|range| range[0]).into())
        .with(number("highest_intensity"), |row| row.model.intensity_range.map(|range| range[1]).into())
        .with(number("ratio_middle"), |row| row.medians(|medians| medians.middle))
        .with(number("ratio_low"), |row| row.medians(|medians| medians.low))
        .with(number("ratio_high"), |row| row.medians(|medians| medians.high))
        .with(Column::count("pairs").or_nothing(), |row| row.ratio.map(|ratio| ratio.number_of_pairs).into())
        .with(number("pair_ratio_median"), |row| row.pairs(|pairs| pairs.median))
        .with(number("pair_ratio_p16"), |row| row.pairs(|pairs| pairs.p16))
        .with(number("pair_ratio_p84"), |row| row.pairs(|pairs| pairs.p84))
        .with(Column::text("reason").or_nothing(), |row| row.model.reason.as_ref().into())
}

impl Table for DemandTable<'_> {
    fn columns(&self) -> Vec<Column> {
        demand_fields().columns()
    }

    fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        let fields = demand_fields();
        self.0.demand.iter().try_for_each(|model| fields.row(&DemandRow { model, ratio: ratio_of(self.0, model) }, writer))
    }
}

/// The ratios of `model` to that of the first device.
pub(super) fn ratio_of<'a>(findings: &'a Findings, model: &DemandModel) -> Option<&'a DemandRatio> {
    let same =
        |ratio: &&DemandRatio| ratio.demand == model.demand && ratio.structure == model.structure && ratio.device == model.device;
    findings.demand_ratios.iter().find(same)
}

/// `fragility`: one curve a row, or why there is none.
pub struct FragilityTable<'s>(pub &'s Findings);

fn curve<'v>(found: &DeviceFragility, value: impl FnOnce(&FragilityCurve) -> f64) -> Value<'v> {
    found.fragility.curve().map(value).into()
}

fn mu<'v>(found: &DeviceFragility, end: impl FnOnce(Band) -> f64) -> Value<'v> {
    found.bands.as_ref().and_then(|bands| bands.mu).map(end).into()
}

fn beta<'v>(found: &DeviceFragility, end: impl FnOnce(Band) -> f64) -> Value<'v> {
    found.bands.as_ref().and_then(|bands| bands.beta).map(end).into()
}

fn fragility_fields() -> Fields<DeviceFragility> {
    let number = |name: &str| Column::number(name).or_nothing();
    Fields::<DeviceFragility>::default()
        .with(Column::text("structure"), |found| (&found.structure).into())
        .with(Column::text("device"), |found| (&found.device).into())
        .with(Column::text("measure"), |found| found.measure.name().into())
        .with(Column::count("runs"), |found| found.runs.into())
        .with(Column::count("overturned"), |found| found.overturned.into())
        .with(Column::count("failed"), |found| found.failed.into())
        .with(Column::count("zero"), |found| found.zero.into())
        .with(number("mu"), |found| curve(found, |curve| curve.mu))
        .with(number("beta"), |found| curve(found, |curve| curve.beta))
        .with(number("median"), |found| curve(found, |curve| curve.median))
        .with(number("mu_standard_error"), |found| curve(found, |curve| curve.mu_standard_error))
        .with(number("beta_standard_error"), |found| curve(found, |curve| curve.beta_standard_error))
        .with(number("mu_low"), |found| mu(found, |band| band.low))
        .with(number("mu_high"), |found| mu(found, |band| band.high))
        .with(number("beta_low"), |found| beta(found, |band| band.low))
        .with(number("beta_high"), |found| beta(found, |band| band.high))
        .with(number("share_without_estimate"), |found| found.bands.as_ref().map(|bands| bands.share_without_estimate).into())
        .with(number("median_ratio"), |found| found.median_ratio.into())
        .with(number("probability_at_first_10"), |found| found.at_first.map(|at| at[0]).into())
        .with(number("probability_at_first_50"), |found| found.at_first.map(|at| at[1]).into())
        .with(Column::text("reason").or_nothing(), |found| found.reason.as_ref().into())
}

impl Table for FragilityTable<'_> {
    fn columns(&self) -> Vec<Column> {
        fragility_fields().columns()
    }

    fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        let fields = fragility_fields();
        self.0.fragility.iter().try_for_each(|found| fields.row(found, writer))
    }
}

/// `ranking`: one measure a row, in the order of its rank.
pub struct RankingTable<'s>(pub &'s Findings);

/// A measure in a ranking: fitted, or why not.
struct RankingRow<'s> {
    ranking: &'s Ranking,
    measure: &'s str,
    fitted: Option<&'s RankedMeasure>,
    reason: Option<String>,
}

impl RankingRow<'_> {
    fn law<'v>(&self, value: impl FnOnce(&PowerLaw) -> Option<f64>) -> Value<'v> {
        self.fitted.and_then(|measure| value(&measure.law)).into()
    }
}

fn ranking_fields<'s>() -> Fields<RankingRow<'s>> {
    let number = |name: &str| Column::number(name).or_nothing();
    Fields::<RankingRow<'s>>::default()
        .with(Column::text("structure"), |row| (&row.ranking.structure).into())
        .with(Column::text("demand"), |row| row.ranking.demand.name().into())
        .with(Column::text("device"), |row| (&row.ranking.device).into())
        .with(Column::count("rank").or_nothing(), |row| row.fitted.map(|measure| measure.rank).into())
        .with(Column::text("measure"), |row| row.measure.into())
        .with(Column::count("runs"), |row| row.ranking.runs.into())
        .with(number("dispersion"), |row| row.law(|law| Some(law.dispersion)))
        .with(number("r_squared"), |row| row.law(|law| law.r_squared))
        .with(number("a"), |row| row.law(|law| Some(law.a)))
        .with(number("b"), |row| row.law(|law| Some(law.b)))
        .with(number("proficiency"), |row| row.fitted.and_then(|measure| measure.proficiency).into())
        .with(Column::text("reason").or_nothing(), |row| row.reason.as_ref().into())
}

impl Table for RankingTable<'_> {
    fn columns(&self) -> Vec<Column> {
        ranking_fields().columns()
    }

    fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        let fields = ranking_fields();
        for ranking in &self.0.ranking {
            for fitted in &ranking.efficiency.ranked {
                let row = RankingRow { ranking, measure: &fitted.name, fitted: Some(fitted), reason: None };
                fields.row(&row, writer)?;
            }
            for unfitted in &ranking.efficiency.unfitted {
                let reason = Some(unfitted.reason.to_string());
                fields.row(&RankingRow { ranking, measure: &unfitted.name, fitted: None, reason }, writer)?;
            }
        }
        Ok(())
    }
}
