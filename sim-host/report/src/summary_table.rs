//! The terminal table that compares the devices of one scene.

use sprag_sim::history::History;

/// One device's line in the summary table.
#[derive(Debug, Clone, PartialEq)]
pub struct SummaryRow {
    /// Name of the device.
    pub device: String,
    /// How the run ended, in words.
    pub outcome: String,
    /// Peak |θ|/α (dimensionless); `None` when the block overturned and a peak means nothing.
    pub peak_rotation_ratio: Option<f64>,
    /// Peak |angular acceleration|/(p²α) (dimensionless); `None` when there is none to report.
    pub peak_acceleration_ratio: Option<f64>,
    /// Number of impacts.
    pub impacts: usize,
    /// Time of the first impact (s), if there was one.
    pub first_impact_s: Option<f64>,
    /// Peak transferred force over block weight (dimensionless); `None` without an inerter.
    pub peak_force_ratio: Option<f64>,
}

impl SummaryRow {
    /// The line of one response.
    ///
    /// The peak rotation is left out when the response ends at or beyond the slenderness angle.
    pub fn of(history: &History) -> Self {
        Self {
            device: history.device.clone(),
            outcome: history.outcome.clone(),
            peak_rotation_ratio: (!history.ends_overturned()).then(|| history.peak_rotation_ratio()),
            peak_acceleration_ratio: Some(history.peak_acceleration_ratio()),
            impacts: history.impacts_s.len(),
            first_impact_s: history.impacts_s.iter().copied().reduce(f64::min),
            peak_force_ratio: history.has_inerter().then(|| history.peak_force_ratio()),
        }
    }
}

/// What a cell shows when there is no number.
const ABSENT: &str = "-";

/// Space between two columns.
const GAP: &str = "  ";

/// Renders `rows` as aligned columns under one header line; ends with a line break.
///
/// The first row is the reference: the last column gives every other device's peak rotation relative to it, in
/// percent. It shows `-` where either block overturned or the reference did not rock. Without rows only the header is
/// rendered.
pub fn summary_table(rows: &[SummaryRow]) -> String {
    let reference = rows.first().and_then(|row| row.peak_rotation_ratio);
    let mut lines = vec![header(rows)];
    lines.extend(rows.iter().enumerate().map(|(index, row)| {
        let relative = if index == 0 { None } else { change(reference, row.peak_rotation_ratio) };
        cells(row, relative)
    }));

    let widths: [usize; 8] =
        std::array::from_fn(|column| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0));
    let mut table = String::new();
    for line in &lines {
        let mut text = String::new();
        for (column, (cell, width)) in line.iter().zip(widths).enumerate() {
            let padding = " ".repeat(width - cell.chars().count());
            if column > 0 {
                text.push_str(GAP);
            }
            // Words align left, numbers align right.
            if column < 2 {
                text.push_str(cell);
                text.push_str(&padding);
            } else {
                text.push_str(&padding);
                text.push_str(cell);
            }
        }
        table.push_str(text.trim_end());
        table.push('\n');
    }
    table
}

fn header(rows: &[SummaryRow]) -> [String; 8] {
    let reference = rows.first().map_or("first", |row| row.device.as_str());
    [
        "device".into(),
        "outcome".into(),
        "peak θ/α".into(),
        "peak |θ''|/(p²α)".into(),
        "impacts".into(),
        "first impact (s)".into(),
        "peak F/(mg)".into(),
        format!("peak θ vs {reference}"),
    ]
}

fn cells(row: &SummaryRow, relative: Option<f64>) -> [String; 8] {
    [
        row.device.clone(),
        row.outcome.clone(),
        number(row.peak_rotation_ratio),
        number(row.peak_acceleration_ratio),
        row.impacts.to_string(),
        number(row.first_impact_s),
        number(row.peak_force_ratio),
        relative.map_or_else(|| ABSENT.into(), percent),
    ]
}

fn number(value: Option<f64>) -> String {
    match value {
        Some(value) if value.is_finite() => format!("{value:.3}"),
        _ => ABSENT.into(),
    }
}

fn change(reference: Option<f64>, value: Option<f64>) -> Option<f64> {
    let (reference, value) = (reference?, value?);
    let change = (value / reference - 1.0) * 100.0;
    (reference > 0.0 && change.is_finite()).then_some(change)
}

fn percent(change: f64) -> String {
    // Rounded first, so that a change of -0.3 does not read "-0 %".
    let rounded = change.round();
    if rounded == 0.0 { "0 %".into() } else { format!("{rounded:+.0} %") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(device: &str, outcome: &str, peak: Option<f64>) -> SummaryRow {
        SummaryRow {
            device: device.into(),
            outcome: outcome.into(),
            peak_rotation_ratio: peak,
            peak_acceleration_ratio: Some(1.25),
            impacts: 12,
            first_impact_s: Some(2.5),
            peak_force_ratio: None,
        }
    }

    #[test]
    fn changes_are_relative_to_the_first_row() {
        let table = summary_table(&[
            row("none", "safe", Some(0.7)),
            row("clutched pair", "safe", Some(0.4)),
            row("single inerter", "safe", Some(0.77)),
            row("heavy", "overturned at 2.10 s", None),
            row("same", "safe", Some(0.699)),
        ]);
        println!("{table}");
        let lines: Vec<&str> = table.lines().collect();
        assert!(lines[0].ends_with("peak θ vs none"));
        assert!(lines[1].ends_with('-'));
        assert!(lines[2].ends_with("-43 %"));
        assert!(lines[3].ends_with("+10 %"));
        assert!(lines[4].ends_with('-'));
        assert!(lines[5].ends_with(" 0 %"));
        let width = lines[0].chars().count();
        assert!(lines.iter().all(|line| line.chars().count() == width));
    }

    #[test]
    fn a_reference_at_rest_gives_no_percentages() {
        let table = summary_table(&[row("none", "safe", Some(0.0)), row("pair", "safe", Some(0.1))]);
        assert!(!table.contains('%') && !table.contains("inf") && !table.contains("NaN"));
        assert_eq!(summary_table(&[]).lines().count(), 1);
    }
}
