//! The tables of a study for programs, as CSV and Parquet: one row a run, and what the runs say.

use sprag_report::columns::{Column, FieldTable, Fields, Shown, Table, Value};
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

/// A run and what it belongs to.
struct RunRow<'s> {
    study: &'s Study,
    records: &'s [StudyRecord],
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

/// `runs`: one run a row, with the names of records, structures and devices. Peaks are max |θ|/α and max |θ̈|/(p²α), empty when overturned;
/// measures are dimensionless, of the scaled record. Where an accuracy was asked for, the last columns are the absolute errors.
pub fn runs_table<'s>(study: &'s Study, records: &'s [StudyRecord], runs: &'s [Run]) -> impl Table + 's {
    FieldTable { fields: run_fields(study), rows: runs.iter().map(|run| RunRow { study, records, run }).collect() }
}

fn run_fields<'s>(study: &Study) -> Fields<RunRow<'s>> {
    let number = |name: &str| Column::number(name).or_nothing();
    let mut fields = Fields::<RunRow<'s>>::default()
        .with(Column::text("record"), |row| (&row.records[row.run.record].name).into())
        .with(Column::text("structure"), |row| (&row.study.structures[row.run.structure].name).into())
        .with(Column::text("device"), |row| (&row.study.devices[row.run.device]).into())
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
    fields
        .with(Column::text("outcome_certain").or_nothing(), |row| row.error().map(|error| error.outcome_certain).into())
        .with(number("peak_rotation_error"), |row| row.error().map(|error| error.peak_rotation).into())
        .with(number("peak_acceleration_error"), |row| row.error().map(|error| error.peak_acceleration).into())
        .with(number("first_impact_time_error_s"), |row| row.error().map(|error| error.first_impact_time).into())
}

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

/// `demand`: one power law a row, with its ratios to that of the first device.
pub fn demand_table(findings: &Findings) -> impl Table {
    let row = |model| DemandRow { model, ratio: ratio_of(findings, model) };
    FieldTable { fields: demand_fields(), rows: findings.demand.iter().map(row).collect() }
}

fn demand_fields<'s>() -> Fields<DemandRow<'s>> {
    let number = |name: &str| Column::number(name).or_nothing();
    Fields::<DemandRow<'s>>::default()
        .with(Column::text("structure").shown("structure", Shown::Digits(0)), |row| (&row.model.structure).into())
        .with(Column::text("demand").shown("demand", Shown::Digits(0)), |row| row.model.demand.name().into())
        .with(Column::text("device").shown("device", Shown::Digits(0)), |row| (&row.model.device).into())
        .with(Column::text("measure"), |row| row.model.measure.name().into())
        .with(Column::count("runs"), |row| row.model.runs.into())
        .with(Column::count("in_law").shown("in the law", Shown::Digits(0)), |row| row.model.points.len().into())
        .with(Column::count("no_rocking").shown("no rocking", Shown::Digits(0)), |row| row.model.left_out.no_rocking.into())
        .with(Column::count("overturned").shown("overturned", Shown::Digits(0)), |row| row.model.left_out.overturned.into())
        .with(Column::count("zero"), |row| row.model.left_out.zero.into())
        .with(Column::count("failed"), |row| row.model.left_out.failed.into())
        .with(number("a").shown("a", Shown::Figures(3)), |row| row.law(|law| Some(law.a)))
        .with(number("b").shown("b", Shown::Digits(3)), |row| row.law(|law| Some(law.b)))
        .with(number("ln_a_standard_error"), |row| row.law(|law| Some(law.ln_a_standard_error)))
        .with(number("b_standard_error"), |row| row.law(|law| Some(law.b_standard_error)))
        .with(number("r_squared").shown("R²", Shown::Digits(3)), |row| row.law(|law| law.r_squared))
        .with(number("dispersion").shown("β", Shown::Digits(3)), |row| row.law(|law| Some(law.dispersion)))
        .with(number("lowest_intensity"), |row| row.model.intensity_range.map(|range| range[0]).into())
        .with(number("highest_intensity"), |row| row.model.intensity_range.map(|range| range[1]).into())
        .with(number("ratio_middle").shown("change, medians", Shown::Change), |row| row.medians(|medians| medians.middle))
        .with(number("ratio_low"), |row| row.medians(|medians| medians.low))
        .with(number("ratio_high"), |row| row.medians(|medians| medians.high))
        .with(Column::count("pairs").or_nothing().shown("pairs", Shown::Digits(0)), |row| {
            row.ratio.map(|ratio| ratio.number_of_pairs).into()
        })
        .with(number("pair_ratio_median").shown("change, pairs", Shown::Change), |row| row.pairs(|pairs| pairs.median))
        .with(number("pair_ratio_p16"), |row| row.pairs(|pairs| pairs.p16))
        .with(number("pair_ratio_p84"), |row| row.pairs(|pairs| pairs.p84))
        .with(Column::text("reason").or_nothing(), |row| row.model.reason.as_ref().into())
}

/// The ratios of `model` to that of the first device.
fn ratio_of<'a>(findings: &'a Findings, model: &DemandModel) -> Option<&'a DemandRatio> {
    let same =
        |ratio: &&DemandRatio| ratio.demand == model.demand && ratio.structure == model.structure && ratio.device == model.device;
    findings.demand_ratios.iter().find(same)
}

fn curve<'v>(found: &DeviceFragility, value: impl FnOnce(&FragilityCurve) -> f64) -> Value<'v> {
    found.fragility.curve().map(value).into()
}

fn mu<'v>(found: &DeviceFragility, end: impl FnOnce(Band) -> f64) -> Value<'v> {
    found.bands.as_ref().and_then(|bands| bands.mu).map(end).into()
}

fn beta<'v>(found: &DeviceFragility, end: impl FnOnce(Band) -> f64) -> Value<'v> {
    found.bands.as_ref().and_then(|bands| bands.beta).map(end).into()
}

/// `fragility`: one curve a row, or why there is none.
pub fn fragility_table(findings: &Findings) -> impl Table {
    FieldTable { fields: fragility_fields(), rows: findings.fragility.iter().collect() }
}

fn fragility_fields<'s>() -> Fields<&'s DeviceFragility> {
    let number = |name: &str| Column::number(name).or_nothing();
    Fields::<&'s DeviceFragility>::default()
        .with(Column::text("structure").shown("structure", Shown::Digits(0)), |found| (&found.structure).into())
        .with(Column::text("device").shown("device", Shown::Digits(0)), |found| (&found.device).into())
        .with(Column::text("measure"), |found| found.measure.name().into())
        .with(Column::count("runs").shown("runs", Shown::Digits(0)), |found| found.runs.into())
        .with(Column::count("overturned").shown("overturned", Shown::Digits(0)), |found| found.overturned.into())
        .with(Column::count("failed"), |found| found.failed.into())
        .with(Column::count("zero"), |found| found.zero.into())
        .with(number("mu").shown("μ", Shown::Digits(3)), |found| curve(found, |curve| curve.mu))
        .with(number("beta").shown("β", Shown::Digits(3)), |found| curve(found, |curve| curve.beta))
        .with(number("median").shown("median", Shown::Figures(2)), |found| curve(found, |curve| curve.median))
        .with(number("mu_standard_error").shown("± of μ", Shown::Digits(3)), |found| {
            curve(found, |curve| curve.mu_standard_error)
        })
        .with(number("beta_standard_error").shown("± of β", Shown::Digits(3)), |found| {
            curve(found, |curve| curve.beta_standard_error)
        })
        .with(number("mu_low").shown("μ from", Shown::Digits(2)), |found| mu(found, |band| band.low))
        .with(number("mu_high").shown("to", Shown::Digits(2)), |found| mu(found, |band| band.high))
        .with(number("beta_low").shown("β from", Shown::Digits(2)), |found| beta(found, |band| band.low))
        .with(number("beta_high").shown("to", Shown::Digits(2)), |found| beta(found, |band| band.high))
        .with(number("share_without_estimate"), |found| found.bands.as_ref().map(|bands| bands.share_without_estimate).into())
        .with(number("median_ratio").shown("change", Shown::Change), |found| found.median_ratio.into())
        .with(number("probability_at_first_10").shown("P at 10 %", Shown::Digits(4)), |found| {
            found.at_first.map(|at| at[0]).into()
        })
        .with(number("probability_at_first_50").shown("P at 50 %", Shown::Digits(4)), |found| {
            found.at_first.map(|at| at[1]).into()
        })
        .with(Column::text("reason").or_nothing(), |found| found.reason.as_ref().into())
}

/// A measure in a ranking: fitted, or why not.
struct RankingRow<'s> {
    ranking: &'s Ranking,
    measure: &'s String,
    fitted: Option<&'s RankedMeasure>,
    reason: Option<String>,
}

/// `ranking`: one measure a row, in the order of its rank.
pub fn ranking_table(findings: &Findings) -> impl Table {
    ranking_rows(findings, |_| true)
}

/// The measures that were fitted.
pub(super) fn fitted_table(findings: &Findings) -> impl Table {
    ranking_rows(findings, |row| row.fitted.is_some())
}

fn ranking_rows<'s>(findings: &'s Findings, wanted: impl Fn(&RankingRow<'s>) -> bool) -> FieldTable<RankingRow<'s>> {
    let of_ranking = |ranking: &'s Ranking| {
        let Ranking { efficiency, .. } = ranking;
        let fitted = efficiency.ranked.iter().map(|fitted| (&fitted.name, Some(fitted), None));
        let unfitted = efficiency.unfitted.iter().map(|unfitted| (&unfitted.name, None, Some(unfitted.reason.to_string())));
        let row = move |(measure, fitted, reason)| RankingRow { ranking, measure, fitted, reason };
        fitted.chain(unfitted).map(row)
    };
    FieldTable { fields: ranking_fields(), rows: findings.ranking.iter().flat_map(of_ranking).filter(wanted).collect() }
}

impl RankingRow<'_> {
    fn law<'v>(&self, value: impl FnOnce(&PowerLaw) -> Option<f64>) -> Value<'v> {
        self.fitted.and_then(|measure| value(&measure.law)).into()
    }
}

fn ranking_fields<'s>() -> Fields<RankingRow<'s>> {
    let number = |name: &str| Column::number(name).or_nothing();
    Fields::<RankingRow<'s>>::default()
        .with(Column::text("structure").shown("structure", Shown::Digits(0)), |row| (&row.ranking.structure).into())
        .with(Column::text("demand").shown("demand", Shown::Digits(0)), |row| row.ranking.demand.name().into())
        .with(Column::text("device").shown("device", Shown::Digits(0)), |row| (&row.ranking.device).into())
        .with(Column::count("rank").or_nothing().shown("rank", Shown::Digits(0)), |row| {
            row.fitted.map(|measure| measure.rank).into()
        })
        .with(Column::text("measure").shown("measure", Shown::Digits(0)), |row| row.measure.into())
        .with(Column::count("runs").shown("runs", Shown::Digits(0)), |row| row.ranking.runs.into())
        .with(number("dispersion").shown("β", Shown::Digits(3)), |row| row.law(|law| Some(law.dispersion)))
        .with(number("r_squared").shown("R²", Shown::Digits(3)), |row| row.law(|law| law.r_squared))
        .with(number("a"), |row| row.law(|law| Some(law.a)))
        .with(number("b").shown("b", Shown::Digits(3)), |row| row.law(|law| Some(law.b)))
        .with(number("proficiency").shown("ζ", Shown::Digits(3)), |row| {
            row.fitted.and_then(|measure| measure.proficiency).into()
        })
        .with(Column::text("reason").or_nothing(), |row| row.reason.as_ref().into())
}
