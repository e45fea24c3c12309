//! A study as a table of every comparison, and as a page of what they have in common.

use std::io;

use super::motion::StudyMotion;
use super::statistics::{OwnMotion, Quantiles, Summary};
use super::study::{Findings, Flip, ROCKS_FROM};
use super::variants::{VARIANTS, Variant};

/// Columns of the table.
pub const COLUMNS: [&str; 9] = [
    "motion",
    "device",
    "effect",
    "variant",
    "outcome_base",
    "outcome_variant",
    "peak_rotation_base",
    "peak_rotation_variant",
    "relative_change",
];

/// Writes every comparison as a row; peaks are max |θ|/α, empty when overturned.
///
/// # Errors
/// When `out` does not take the bytes.
pub fn write_csv(
    findings: &Findings,
    motions: &[StudyMotion],
    devices: &[String],
    out: &mut impl io::Write,
) -> Result<(), csv::Error> {
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:?}"));
    let mut table = csv::Writer::from_writer(out);
    table.write_record(COLUMNS)?;
    for comparison in &findings.comparisons {
        let variant = &VARIANTS[comparison.variant];
        table.write_record([
            &motions[comparison.motion].name,
            &devices[comparison.device],
            variant.effect,
            variant.name,
            comparison.base.outcome.name(),
            comparison.answer.outcome.name(),
            &number(comparison.base.peak),
            &number(comparison.answer.peak),
            &number(comparison.change()),
        ])?;
    }
    table.flush()?;
    Ok(())
}

/// The page, as Markdown: what was asked, a table, and what was left out.
pub fn page(title: &str, summaries: &[Summary], records: usize, left_out: &[String]) -> String {
    let mut page = format!("# {}\n\n", if title.is_empty() { "Does it matter?" } else { title });
    page += &format!(
        "Change of the peak rotation max |θ|/α when one effect is turned on, relative to the scene as it is. Median, 16th and\n\
         84th percentile are over those of {records} records under which both blocks stand and the one of the scene as it is\n\
         reaches {ROCKS_FROM} α (their number: rocking). The last columns count records that change the outcome.\n\n"
    );
    page += &table(summaries);
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

/// The table of the page, its columns aligned.
pub fn table(summaries: &[Summary]) -> String {
    let titles =
        ["effect", "variant", "device", "own motion", "median", "16 %", "84 %", "rocking", "overturns instead", "stands instead"];
    let mut rows = vec![titles.map(str::to_owned)];
    for summary in summaries {
        let of = |pick: fn(&Quantiles) -> f64| summary.change.as_ref().map_or("-".to_owned(), |q| percent(pick(q)));
        rows.push([
            summary.effect.to_owned(),
            summary.variant.to_owned(),
            summary.device.replace('|', "\\|"),
            summary.own_motion.as_ref().map_or("-".to_owned(), own_motion),
            of(|quantiles| quantiles.median),
            of(|quantiles| quantiles.p16),
            of(|quantiles| quantiles.p84),
            summary.rocking.to_string(),
            summary.overturns_instead.to_string(),
            summary.stands_instead.to_string(),
        ]);
    }
    let widths: [usize; 10] =
        std::array::from_fn(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0).max(3));
    let mut table = String::new();
    for (index, row) in rows.iter().enumerate() {
        for (column, (cell, width)) in row.iter().zip(widths).enumerate() {
            // Words align left, numbers align right.
            table += &if column < 3 { format!("| {cell:<width$} ") } else { format!("| {cell:>width$} ") };
        }
        table += "|\n";
        if index == 0 {
            for (column, width) in widths.into_iter().enumerate() {
                table += &if column < 3 { format!("|{}", "-".repeat(width + 2)) } else { format!("|{}:", "-".repeat(width + 1)) };
            }
            table += "|\n";
        }
    }
    table
}

fn own_motion(own: &OwnMotion) -> String {
    match (own.flip, own.change) {
        (Some(Flip::ToOverturned), _) => "overturns".to_owned(),
        (Some(Flip::ToStanding), _) => "stands".to_owned(),
        (None, Some(change)) => percent(change),
        (None, None) if own.peak_base.is_none() => "both overturn".to_owned(),
        (None, None) => "-".to_owned(),
    }
}

/// `share` in percent with one decimal and a sign, both gone where it rounds to nothing.
pub fn percent(share: f64) -> String {
    let tenths = (1000.0 * share).round();
    if tenths == 0.0 { "0 %".to_owned() } else { format!("{:+.1} %", tenths / 10.0).replace('-', "\u{2212}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentages_have_a_sign_and_no_negative_zero() {
        assert_eq!(percent(0.1234), "+12.3 %");
        assert_eq!(percent(-0.5), "\u{2212}50.0 %");
        assert_eq!(percent(-0.0001), "0 %");
    }

    #[test]
    fn rows_of_the_table_have_one_width() {
        let summary = |device: &str, change| Summary {
            effect: "impact",
            variant: "momentum balance",
            device_index: 0,
            device: device.to_owned(),
            records: 3,
            changes: vec![0.1],
            rocking: 1,
            change: super::super::statistics::quantiles(&[change]),
            overturns_instead: 2,
            stands_instead: 0,
            own_motion: None,
        };
        let table = table(&[summary("none", 0.1), summary("a long name", -1.0)]);
        let width = table.lines().next().unwrap().chars().count();
        assert_eq!(table.lines().count(), 4);
        assert!(table.lines().all(|line| line.chars().count() == width), "{table}");
    }
}
