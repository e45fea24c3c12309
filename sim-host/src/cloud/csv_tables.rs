//! The tables of a study as CSV, for programs: one row a run, and what the runs say.

use std::io;

use super::comparison::DemandRatio;
use super::demand::DemandModel;
use super::findings::Findings;
use super::measure::Measure;
use super::records::StudyRecord;
use super::runs::Runs;
use super::study::Study;

/// A number that reads back to the same f64; nothing for none.
fn exact(value: impl Into<Option<f64>>) -> String {
    value.into().map_or_else(String::new, |value| format!("{value:?}"))
}

/// Writes `runs.csv`: peaks are max |θ|/α and max |θ̈|/(p²α), empty when overturned; measures are dimensionless, of the scaled
/// record.
///
/// # Errors
/// When `out` does not take the bytes.
pub fn write_runs(study: &Study, records: &[StudyRecord], runs: &Runs, out: impl io::Write) -> Result<(), csv::Error> {
    let mut table = csv::Writer::from_writer(out);
    let mut titles: Vec<String> = ["record", "structure", "device", "scale", "level"].map(str::to_owned).to_vec();
    titles.extend(Measure::ALL.map(|measure| measure.name().replace('-', "_")));
    titles.extend(["outcome", "peak_rotation", "peak_acceleration", "impacts", "end_time_s", "failure"].map(str::to_owned));
    table.write_record(&titles)?;
    for run in &runs.all {
        let names = [&records[run.record].name, &study.structures[run.structure].name, &study.devices[run.device]];
        let mut row: Vec<String> = names.map(Clone::clone).to_vec();
        row.extend([exact(run.factor), exact(run.level)]);
        row.extend(run.measures.map(exact));
        match &run.answer {
            Ok(answer) => row.extend([
                answer.outcome.name().to_owned(),
                exact(answer.peak_rotation),
                exact(answer.peak_acceleration),
                answer.impacts.to_string(),
                exact(answer.end_time_s),
                String::new(),
            ]),
            Err(reason) => {
                row.extend(["failed", "", "", "", ""].map(str::to_owned));
                row.push(reason.clone());
            }
        }
        table.write_record(&row)?;
    }
    Ok(table.flush()?)
}

/// Writes `demand.csv`: one power law a row, with its ratios to that of the first device.
///
/// # Errors
/// When `out` does not take the bytes.
pub fn write_demand(findings: &Findings, out: impl io::Write) -> Result<(), csv::Error> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record([
        "structure",
        "demand",
        "device",
        "measure",
        "runs",
        "in_law",
        "no_rocking",
        "overturned",
        "zero",
        "failed",
        "a",
        "b",
        "ln_a_standard_error",
        "b_standard_error",
        "r_squared",
        "dispersion",
        "lowest_intensity",
        "highest_intensity",
        "ratio_middle",
        "ratio_low",
        "ratio_high",
        "pairs",
        "pair_ratio_median",
        "pair_ratio_p16",
        "pair_ratio_p84",
        "reason",
    ])?;
    for model in &findings.demand {
        let law = model.law.as_ref();
        let ratio = ratio_of(findings, model);
        let medians = ratio.and_then(|ratio| ratio.medians);
        let pairs = ratio.and_then(|ratio| ratio.pairs);
        let left_out = model.left_out;
        let counts = [model.runs, model.points.len(), left_out.no_rocking, left_out.overturned, left_out.zero, left_out.failed];
        let mut row = [&model.structure, model.demand.name(), &model.device, model.measure.name()].map(str::to_owned).to_vec();
        row.extend(counts.map(|count| count.to_string()));
        row.extend([
            exact(law.map(|law| law.a)),
            exact(law.map(|law| law.b)),
            exact(law.map(|law| law.ln_a_standard_error)),
            exact(law.map(|law| law.b_standard_error)),
            exact(law.and_then(|law| law.r_squared)),
            exact(law.map(|law| law.dispersion)),
            exact(model.intensity_range.map(|range| range[0])),
            exact(model.intensity_range.map(|range| range[1])),
            exact(medians.map(|medians| medians.middle)),
            exact(medians.map(|medians| medians.low)),
            exact(medians.map(|medians| medians.high)),
            ratio.map_or_else(String::new, |ratio| ratio.number_of_pairs.to_string()),
            exact(pairs.map(|pairs| pairs.median)),
            exact(pairs.map(|pairs| pairs.p16)),
            exact(pairs.map(|pairs| pairs.p84)),
            model.reason.clone().unwrap_or_default(),
        ]);
        table.write_record(&row)?;
    }
    Ok(table.flush()?)
}

/// The ratios of `model` to that of the first device.
pub(super) fn ratio_of<'a>(findings: &'a Findings, model: &DemandModel) -> Option<&'a DemandRatio> {
    let same =
        |ratio: &&DemandRatio| ratio.demand == model.demand && ratio.structure == model.structure && ratio.device == model.device;
    findings.demand_ratios.iter().find(same)
}

/// Writes `fragility.csv`: one curve a row, or why there is none.
///
/// # Errors
/// When `out` does not take the bytes.
pub fn write_fragility(findings: &Findings, out: impl io::Write) -> Result<(), csv::Error> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record([
        "structure",
        "device",
        "measure",
        "runs",
        "overturned",
        "failed",
        "zero",
        "mu",
        "beta",
        "median",
        "mu_standard_error",
        "beta_standard_error",
        "mu_low",
        "mu_high",
        "beta_low",
        "beta_high",
        "share_without_estimate",
        "median_ratio",
        "probability_at_first_10",
        "probability_at_first_50",
        "reason",
    ])?;
    for found in &findings.fragility {
        let curve = found.fragility.curve();
        let bands = found.bands.as_ref();
        let [mu, beta] = [bands.and_then(|bands| bands.mu), bands.and_then(|bands| bands.beta)];
        let mut row = [&found.structure, &found.device, found.measure.name()].map(str::to_owned).to_vec();
        row.extend([found.runs, found.overturned, found.failed, found.zero].map(|count| count.to_string()));
        row.extend([
            exact(curve.map(|curve| curve.mu)),
            exact(curve.map(|curve| curve.beta)),
            exact(curve.map(|curve| curve.median)),
            exact(curve.map(|curve| curve.mu_standard_error)),
            exact(curve.map(|curve| curve.beta_standard_error)),
            exact(mu.map(|band| band.low)),
            exact(mu.map(|band| band.high)),
            exact(beta.map(|band| band.low)),
            exact(beta.map(|band| band.high)),
            exact(bands.map(|bands| bands.share_without_estimate)),
            exact(found.median_ratio),
            exact(found.at_first.map(|at| at[0])),
            exact(found.at_first.map(|at| at[1])),
            found.reason.clone().unwrap_or_default(),
        ]);
        table.write_record(&row)?;
    }
    Ok(table.flush()?)
}

/// Writes `ranking.csv`: one measure a row, in the order of its rank.
///
/// # Errors
/// When `out` does not take the bytes.
pub fn write_ranking(findings: &Findings, out: impl io::Write) -> Result<(), csv::Error> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record([
        "structure",
        "demand",
        "device",
        "rank",
        "measure",
        "runs",
        "dispersion",
        "r_squared",
        "a",
        "b",
        "proficiency",
        "reason",
    ])?;
    for ranking in &findings.ranking {
        let start = [&ranking.structure, ranking.demand.name(), &ranking.device].map(str::to_owned);
        for measure in &ranking.efficiency.ranked {
            let mut row = start.to_vec();
            row.extend([measure.rank.to_string(), measure.name.clone(), ranking.runs.to_string()]);
            row.extend([
                exact(measure.law.dispersion),
                exact(measure.law.r_squared),
                exact(measure.law.a),
                exact(measure.law.b),
                exact(measure.proficiency),
                String::new(),
            ]);
            table.write_record(&row)?;
        }
        for measure in &ranking.efficiency.unfitted {
            let mut row = start.to_vec();
            row.extend([String::new(), measure.name.clone(), ranking.runs.to_string()]);
            row.extend(["", "", "", "", ""].map(str::to_owned));
            row.push(measure.reason.to_string());
            table.write_record(&row)?;
        }
    }
    Ok(table.flush()?)
}
