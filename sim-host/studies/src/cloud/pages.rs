//! The tables of a study as Markdown, for people.

use sprag_report::columns::TableError;
use sprag_report::text_table::TextTable;
use sprag_shared::structure::block::Geometry;

use super::findings::Findings;
use super::measure::Measure;
use super::overturning::DeviceFragility;
use super::structures::StudyStructure;
use super::study::Study;
use super::typed_tables::{demand_table, fitted_table, fragility_table};
use crate::statistics::Fragility;

/// A share in percent without needless decimals.
pub fn percent(share: f64) -> String {
    let text = format!("{:.2}", 100.0 * share);
    format!("{} %", text.trim_end_matches('0').trim_end_matches('.'))
}

/// The formula of `measure` by the models of the structures.
fn formula(study: &Study, measure: Measure) -> String {
    let [full, slender] = [false, true].map(|slender| measure.formula(slender));
    let is_slender = |structure: &StudyStructure| structure.scene.geometry() == Geometry::Slender;
    if study.slender() {
        slender
    } else if full != slender && study.structures.iter().any(is_slender) {
        format!("{full} (gα of slender blocks)")
    } else {
        full
    }
}

/// `demand.md`.
pub fn demand_page(study: &Study, findings: &Findings) -> Result<String, TableError> {
    let formula = formula(study, study.file.demand.measure);
    let mut page = format!("# {}: demand\n\n", heading(study));
    page += &format!(
        "Median demand a IM^b with IM = {formula}, fitted by least squares in the logarithms over the runs in which the block rocks\n\
         and stands. R²: variance explained; β: standard deviation of ln demand about the law. Changes against the first device\n\
         ({}): of the median at the middle (in ln IM) of the intensities common to both, which is also the mean of the logarithms over\n\
         that range; and the median over single motions under which both blocks rock and stand.\n\n",
        study.devices[0]
    );
    page += &TextTable::of(&demand_table(findings))?.markdown();
    for model in &findings.demand {
        if let Some(reason) = &model.reason {
            page += &format!("\n{}, {}, {}: no law, {reason}\n", model.structure, model.demand.name(), model.device);
        }
    }
    Ok(page)
}

/// `fragility.md`.
pub fn fragility_page(study: &Study, findings: &Findings) -> Result<String, TableError> {
    let formula = formula(study, study.file.fragility.measure);
    let mut page = format!("# {}: fragility\n\n", heading(study));
    let bands = findings.fragility.iter().find_map(|found| found.bands.as_ref());
    let level = bands.map_or_else(String::new, |bands| format!(" of {}", percent(bands.bootstrap.level.value())));
    page += &format!(
        "Probability of overturning Φ((ln IM − μ)/β) with IM = {formula}, by maximum likelihood over all runs. ±: standard error;\n\
         from, to: ends of the bands{level} by {} resamples; median: e^μ. Change: of the median against the first device ({}). P at 10 %\n\
         and 50 %: probability where that of the first device is 0.1 and 0.5.\n\n",
        study.bootstrap.resamples, study.devices[0]
    );
    page += &TextTable::of(&fragility_table(findings))?.markdown();
    for line in fragility_notes(&findings.fragility) {
        page += &format!("\n{line}\n");
    }
    Ok(page)
}

/// What curves cannot say, in a line each.
pub fn fragility_notes(fragilities: &[DeviceFragility]) -> Vec<String> {
    let mut notes = Vec::new();
    for found in fragilities {
        let names = format!("{}, {}", found.structure, found.device);
        if let Some(reason) = &found.reason {
            notes.push(format!("{names}: no curve; {reason}."));
        }
        if let Some(bands) = found.bands.as_ref().filter(|bands| bands.share_without_estimate > 0.02) {
            let share = percent(bands.share_without_estimate);
            notes.push(format!("{names}: {share} of the resamples have no curve, so that the bands are too narrow."));
        }
    }
    notes
}

/// What a panel of the figure says of a device without a curve.
pub fn short_reason(fragility: &Fragility) -> Option<&'static str> {
    match fragility {
        Fragility::Estimated(_) => None,
        Fragility::NeverOverturned { .. } => Some("never overturned"),
        Fragility::AlwaysOverturned { .. } => Some("always overturned"),
        Fragility::SingleIntensity { .. } => Some("one intensity only"),
        Fragility::Separated { .. } | Fragility::QuasiSeparated { .. } => Some("outcomes separated, no curve"),
        Fragility::SlopeNotPositive { .. } => Some("no rise with intensity, no curve"),
    }
}

/// `ranking.md`.
pub fn ranking_page(study: &Study, findings: &Findings) -> Result<String, TableError> {
    let mut page = format!("# {}: intensity measures\n\n", heading(study));
    page += "Measures by efficiency: the standard deviation β of ln demand about the power law of each, over the runs in which the block\n\
             rocks and stands; the smaller, the better. ζ = β/|b| is the proficiency.\n\n";
    for measure in Measure::ALL {
        page += &format!("- {}: {}\n", measure.name(), formula(study, measure));
    }
    page += &format!("\n{}", TextTable::of(&fitted_table(findings))?.markdown());
    for ranking in &findings.ranking {
        for measure in &ranking.efficiency.unfitted {
            let (demand, name) = (ranking.demand.name(), &measure.name);
            page += &format!("\n{}, {demand}, {}, {name}: {}\n", ranking.structure, ranking.device, measure.reason);
        }
    }
    Ok(page)
}

/// The title of pages and pictures.
pub fn heading(study: &Study) -> &str {
    if study.file.title.is_empty() { "Cloud analysis" } else { &study.file.title }
}
