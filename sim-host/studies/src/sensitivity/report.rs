//! A study as a table of every comparison, and as a page of what they have in common.

use sprag_report::columns::{Column, FieldTable, Fields, Table};
use sprag_report::text_table::{TextTable, change_in_tenths};

use super::motion::StudyMotion;
use super::statistics::{OwnMotion, Quantiles, Summary};
use super::study::{Comparison, Findings, Flip, ROCKS_FROM};
use super::variants::{VARIANTS, Variant};

/// A comparison with its names.
struct ComparisonRow<'s> {
    motion: &'s str,
    device: &'s str,
    comparison: &'s Comparison,
}

/// `sensitivity`: one comparison a row, with the names of motions and devices; peaks are max |θ|/α, empty when overturned.
pub fn comparison_table<'s>(findings: &'s Findings, motions: &'s [StudyMotion], devices: &'s [String]) -> impl Table + 's {
    let row = |comparison: &'s Comparison| {
        let Comparison { motion, device, .. } = *comparison;
        ComparisonRow { motion: &motions[motion].name, device: &devices[device], comparison }
    };
    FieldTable { fields: fields(), rows: findings.comparisons.iter().map(row).collect() }
}

fn fields<'s>() -> Fields<ComparisonRow<'s>> {
    let number = |name: &str| Column::number(name).or_nothing();
    Fields::<ComparisonRow<'s>>::default()
        .with(Column::text("motion"), |row| row.motion.into())
        .with(Column::text("device"), |row| row.device.into())
        .with(Column::text("effect"), |row| VARIANTS[row.comparison.variant].effect.into())
        .with(Column::text("variant"), |row| VARIANTS[row.comparison.variant].name.into())
        .with(Column::text("outcome_base"), |row| row.comparison.base.outcome.name().into())
        .with(Column::text("outcome_variant"), |row| row.comparison.answer.outcome.name().into())
        .with(number("peak_rotation_base"), |row| row.comparison.base.peak.into())
        .with(number("peak_rotation_variant"), |row| row.comparison.answer.peak.into())
        .with(number("relative_change"), |row| row.comparison.change().into())
}

/// The page, as Markdown: what was asked, a table, and what was left out.
pub fn page(title: &str, summaries: &[Summary], records: usize, left_out: &[String]) -> String {
    let mut page = format!("# {}\n\n", if title.is_empty() { "Does it matter?" } else { title });
    page += &format!(
        "Change of the peak rotation max |θ|/α when one effect is turned on, relative to the scene as it is. Median, 16th and\n\
         84th percentile are over those of {records} records under which both blocks stand and the one of the scene as it is\n\
         reaches {ROCKS_FROM} α (their number: rocking). The last columns count records that change the outcome.\n\n"
    );
    page += &table(summaries).markdown();
    page += &settings(summaries);
    if !left_out.is_empty() {
        page += "\nLeft out:\n\n";
        for line in left_out {
            page += &format!("- {line}\n");
        }
    }
    page
}

/// What each variant of the table sets, as `--set` has it, with `N` for the number of the device.
fn settings(summaries: &[Summary]) -> String {
    let used = |variant: &&Variant| {
        let of = |summary: &Summary| (summary.effect, summary.variant) == (variant.effect, variant.name);
        summaries.iter().any(of)
    };
    let mut page =
        String::from("\nWhat each variant sets (flywheels with a speed of their own also move by consistent kinematics):\n\n");
    for variant in VARIANTS.iter().filter(used) {
        let keys = variant.changes.iter().map(|change| format!("`{change}`"));
        let of_pair = variant.of_pair.iter().map(|change| format!("`{change}` (clutched pair)"));
        let vertical = variant.vertical.then(|| "`[[vertical]]`".to_owned());
        let all: Vec<String> = vertical.into_iter().chain(keys).chain(of_pair).collect();
        page += &format!("- {}: {}\n", variant.label(), all.join(", "));
    }
    page
}

/// The table of the page.
pub fn table(summaries: &[Summary]) -> TextTable {
    let headings =
        ["effect", "variant", "device", "own motion", "median", "16 %", "84 %", "rocking", "overturns instead", "stands instead"];
    let mut table = TextTable::new(3, headings);
    for summary in summaries {
        let of = |pick: fn(&Quantiles) -> f64| change_in_tenths(summary.change.as_ref().map(pick));
        table.row(vec![
            summary.effect.to_owned(),
            summary.variant.to_owned(),
            summary.device.clone(),
            summary.own_motion.as_ref().map_or("-".to_owned(), own_motion),
            of(|quantiles| quantiles.median),
            of(|quantiles| quantiles.p16),
            of(|quantiles| quantiles.p84),
            summary.rocking.to_string(),
            summary.overturns_instead.to_string(),
            summary.stands_instead.to_string(),
        ]);
    }
    table
}

fn own_motion(own: &OwnMotion) -> String {
    match (own.flip, own.change) {
        (Some(Flip::ToOverturned), _) => "overturns".to_owned(),
        (Some(Flip::ToStanding), _) => "stands".to_owned(),
        (None, Some(change)) => change_in_tenths(change),
        (None, None) if own.peak_base.is_none() => "both overturn".to_owned(),
        (None, None) => "-".to_owned(),
    }
}
