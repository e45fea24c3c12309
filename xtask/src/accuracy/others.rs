//! The same cells by what people use today, and by `sprag`, in one run.

use super::{FOLDER, batch, quantile, read, scratch};
use crate::{process::output, stop::Stop};
use std::{fmt::Write as _, fs, path::Path, process::Command};

/// Copies of the cells, so that starting the program counts for little.
const COPIES: usize = 2000;

/// Settings of `sprag batch`.
const OWN: [(&str, &[&str]); 4] = [
    ("1e-3", &["--tolerance", "1e-3"]),
    ("1e-6", &["--tolerance", "1e-6"]),
    ("1e-9", &["--tolerance", "1e-9"]),
    ("1e-15", &["--tolerance", "1e-15"]),
];

/// Measures, writes `others.csv`, and gives the table.
///
/// # Errors
/// If Python or a run fails, or a file cannot be written.
pub fn table(root: &Path, sprag: &Path) -> Result<String, Stop> {
    let folder = scratch(root)?;
    let cells = root.join(FOLDER).join("cells.csv");
    let exact = folder.join("exact.csv");
    batch(sprag, &cells, &exact, &["--tolerance", "1e-17"], 1)?;
    let script = root.join(FOLDER).join("compare.py");
    let csv = output(Command::new("python3").arg(&script).arg("--cases").arg(&cells).arg("--reference").arg(&exact))?;
    let path = root.join(FOLDER).join("others.csv");
    fs::write(&path, &csv).map_err(|error| Stop::failed(format!("{}: {error}", path.display())))?;
    let mut rows = String::new();
    for (method, setting) in in_order(&csv) {
        let of: Vec<Vec<&str>> = csv
            .lines()
            .skip(1)
            .map(|line| line.split(',').collect())
            .filter(|row: &Vec<&str>| row[1..3] == [&*method, &*setting])
            .collect();
        let mut errors: Vec<f64> = of.iter().filter_map(|row| row[3].parse().ok()).collect();
        let mut seconds: Vec<f64> = of.iter().filter_map(|row| row[6].parse().ok()).collect();
        let wrong = of.iter().filter(|row| row[5] == "true").count();
        row(&mut rows, &method, &setting, &mut errors, mean(&mut seconds), (wrong, of.len()));
    }
    let text = read(&cells)?;
    let (header, body) = text.split_once('\n').ok_or_else(|| Stop::failed("cells.csv is empty"))?;
    let many = folder.join("copies.csv");
    let copies = format!("{header}\n{}", body.repeat(COPIES));
    fs::write(&many, copies).map_err(|error| Stop::failed(format!("{}: {error}", many.display())))?;
    let answers = read(&exact)?;
    for (setting, options) in OWN {
        let results = folder.join("own.csv");
        let seconds = batch(sprag, &many, &results, options, 3)? / (COPIES * body.lines().count()) as f64;
        let found = read(&results)?;
        let pairs = || found.lines().skip(1).zip(answers.lines().skip(1)).map(|(own, exact)| (fields(own), fields(exact)));
        let mut errors: Vec<f64> = pairs()
            .filter_map(|(own, exact)| Some((own[2].parse::<f64>().ok()? / exact[2].parse::<f64>().ok()? - 1.0).abs()))
            .collect();
        let wrong = pairs().filter(|(own, exact)| own[1] != exact[1]).count();
        row(&mut rows, "`sprag batch`", setting, &mut errors, seconds, (wrong, body.lines().count()));
    }
    Ok(format!(
        "| method | tolerance or step | median error of the peak | largest | wrong outcomes | time a case |\n\
         | --- | --- | --- | --- | --- | --- |\n{rows}"
    ))
}

fn fields(line: &str) -> Vec<&str> {
    line.split(',').collect()
}

/// Methods and settings in the order of their first rows.
fn in_order(csv: &str) -> Vec<(String, String)> {
    let mut known: Vec<(String, String)> = Vec::new();
    for row in csv.lines().skip(1).map(fields) {
        let pair = (row[1].to_owned(), row[2].to_owned());
        if !known.contains(&pair) {
            known.push(pair);
        }
    }
    known
}

fn mean(values: &mut [f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// A row of the table.
fn row(rows: &mut String, method: &str, setting: &str, errors: &mut [f64], seconds: f64, wrong: (usize, usize)) {
    errors.sort_by(f64::total_cmp);
    let time = if seconds < 1e-3 { format!("{:.1} µs", seconds * 1e6) } else { format!("{:.1} ms", seconds * 1e3) };
    let (median, largest) = (quantile(errors, 0.5), quantile(errors, 1.0));
    let _ = writeln!(rows, "| {method} | {setting} | {median:.0e} | {largest:.0e} | {} of {} | {time} |", wrong.0, wrong.1);
}
