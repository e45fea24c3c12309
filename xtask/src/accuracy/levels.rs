//! What `--accuracy` means: errors, doubts and times over a grid of cells.

use super::{FOLDER, batch, quantile, read, scratch};
use crate::stop::Stop;
use std::{
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

/// Cells along each axis of a grid.
const CELLS: u32 = 16;

/// Options of the rows, and what they are called; the last is what the others are compared with.
const ROWS: [(&str, &[&str]); 8] = [
    ("no error reported, tolerance 1e-15", &["--tolerance", "1e-15"]),
    ("fast", &["--accuracy", "fast"]),
    ("1e-3", &["--accuracy", "1e-3"]),
    ("1e-6", &["--accuracy", "1e-6"]),
    ("normal", &["--accuracy", "normal"]),
    ("1e-9", &["--accuracy", "1e-9"]),
    ("1e-12", &["--accuracy", "1e-12"]),
    ("tight", &["--accuracy", "tight"]),
];

/// A result of `sprag batch`.
struct Found {
    outcome: String,
    peak: Option<f64>,
    /// Whether the outcome is certain, and the error of the peak.
    error: Option<(bool, Option<f64>)>,
}

/// Measures, writes `levels.csv`, and gives the table.
///
/// # Errors
/// If a run fails or a file cannot be written.
pub fn table(root: &Path, sprag: &Path) -> Result<String, Stop> {
    let folder = scratch(root)?;
    let cases = folder.join("cells.csv");
    let (text, count) = grid();
    fs::write(&cases, text).map_err(|error| Stop::failed(format!("{}: {error}", cases.display())))?;
    let mut measured = Vec::new();
    for (number, (name, options)) in ROWS.iter().enumerate() {
        let results: PathBuf = folder.join(format!("results-{number}.csv"));
        let seconds = batch(sprag, &cases, &results, options, 3)?;
        measured.push((*name, seconds / f64::from(count), found(&read(&results)?)));
    }
    let Some((_, base, _)) = measured.first() else { return Err(Stop::failed("there are no levels")) };
    let (base, tight) = (*base, &measured[measured.len() - 1].2);
    let mut table = String::from(
        "| `--accuracy` | time a case | median error | 95 % | largest | wrong outcomes | in doubt | estimates bound | estimate over error |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let mut csv = String::from(
        "accuracy,microseconds_per_case,error_median,error_95,error_largest,wrong_outcomes,in_doubt,bounded_percent,ratio_median\n",
    );
    for (name, seconds, results) in &measured {
        let mut errors: Vec<f64> = Vec::new();
        let mut ratios: Vec<f64> = Vec::new();
        let (mut wrong, mut doubt) = (0, 0);
        for (own, exact) in results.iter().zip(tight) {
            wrong += u32::from(own.outcome != exact.outcome);
            doubt += u32::from(own.error.is_some_and(|(certain, _)| !certain));
            let (Some(peak), Some(known)) = (own.peak, exact.peak) else { continue };
            let error = (peak / known - 1.0).abs();
            errors.push(error);
            if let Some((true, Some(estimate))) = own.error {
                ratios.push(estimate / known / error.max(f64::EPSILON));
            }
        }
        errors.sort_by(f64::total_cmp);
        ratios.sort_by(f64::total_cmp);
        // Tight results are what all are compared with.
        let reference = std::ptr::eq(results, tight);
        let bounded = 100.0 * ratios.iter().filter(|ratio| **ratio >= 1.0).count() as f64 / ratios.len().max(1) as f64;
        let [median, high, largest] = [0.5, 0.95, 1.0].map(|share| quantile(&errors, share));
        let error = |value: f64| match value {
            _ if reference => "–".to_owned(),
            0.0 => "0".to_owned(),
            _ => format!("{value:.0e}"),
        };
        let estimated = !ratios.is_empty() && !reference;
        let (bounds, factor) = if estimated {
            (format!("{bounded:.1} %"), format!("{:.1}", quantile(&ratios, 0.5)))
        } else {
            ("–".to_owned(), "–".to_owned())
        };
        let doubts = if ratios.is_empty() { "–".to_owned() } else { doubt.to_string() };
        let _ = writeln!(
            table,
            "| {name} | {:.1} µs ({:.1}) | {} | {} | {} | {wrong} | {doubts} | {bounds} | {factor} |",
            seconds * 1e6,
            seconds / base,
            error(median),
            error(high),
            error(largest),
        );
        let _ = writeln!(
            csv,
            "\"{name}\",{:.3},{median:e},{high:e},{largest:e},{wrong},{doubt},{bounded:.2},{:.2}",
            seconds * 1e6,
            quantile(&ratios, 0.5)
        );
    }
    let path = root.join(FOLDER).join("levels.csv");
    fs::write(&path, csv).map_err(|error| Stop::failed(format!("{}: {error}", path.display())))?;
    let _ = writeln!(table, "\n{count} cases; times on one thread, the reading and writing of tables included.");
    Ok(table)
}

/// Both geometries, all devices, both pulses, over ω_g/p and a_g.
fn grid() -> (String, u32) {
    let mut text = String::from(
        "id,geometry,slenderness_deg,device,mass_ratio,restitution,pulse,frequency_ratio,amplitude_ratio,free_time\n",
    );
    let mut count = 0;
    for geometry in ["full", "slender"] {
        for (device, sigma) in [("none", "0"), ("inerter", "0.5"), ("clutched-pair", "0.5")] {
            for pulse in ["sine", "cosine"] {
                for cell in 0..CELLS * CELLS {
                    let at = |index: u32, from: f64, to: f64| from + (to - from) * (f64::from(index) + 0.5) / f64::from(CELLS);
                    let (frequency, amplitude) = (at(cell % CELLS, 0.2, 8.0), at(cell / CELLS, 1.0, 10.0));
                    let _ = writeln!(text, "{count},{geometry},20,{device},{sigma},0.85,{pulse},{frequency},{amplitude},60");
                    count += 1;
                }
            }
        }
    }
    (text, count)
}

/// Reads a table of results.
fn found(text: &str) -> Vec<Found> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let column = |name: &str| header.iter().position(|known| *known == name);
    let (certain, error) = (column("outcome_certain"), column("peak_rotation_error"));
    lines
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let number = |at: Option<usize>| at.and_then(|at| fields.get(at)?.parse().ok());
            Found {
                outcome: fields.get(1).copied().unwrap_or_default().to_owned(),
                peak: number(Some(2)),
                error: certain.map(|at| (fields.get(at) == Some(&"true"), number(error))),
            }
        })
        .collect()
}
