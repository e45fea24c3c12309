//! Records as tables of numbers: a time column and accelerations, or accelerations alone with the step given by the scene.
//!
//! Only what the comparison needs: a header or the scene says the units, the steps are equal.

use std::path::Path;

use crate::block::GRAVITY;
use crate::scene::MotionTable;

/// Time step (s) and samples (m/s²) of a record.
///
/// # Errors
/// What is missing or cannot be read, in words.
pub fn read(file: &Path, table: &MotionTable) -> Result<(f64, Vec<f64>), String> {
    if table.resample_to_s.is_some() {
        return Err("resampled records are not read here".to_owned());
    }
    let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
    parse(&text, table)
}

/// As [`read`], from its text.
///
/// # Errors
/// As there.
pub fn parse(text: &str, table: &MotionTable) -> Result<(f64, Vec<f64>), String> {
    let mut names: Vec<String> = Vec::new();
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for line in text.lines().map(|line| line.trim().trim_start_matches('#').trim()).filter(|line| !line.is_empty()) {
        let fields: Vec<&str> = line.split([',', ';', '\t', ' ']).filter(|field| !field.is_empty()).collect();
        let numbers: Vec<f64> = fields.iter().filter_map(|field| field.parse().ok()).collect();
        if numbers.len() == fields.len() {
            rows.push(numbers);
        } else if rows.is_empty() {
            names = fields.iter().map(|field| field.to_lowercase()).collect();
        }
    }
    if rows.len() < 2 {
        return Err("a record of at least two rows".to_owned());
    }
    let columns = rows[0].len();
    let named = names.len() == columns;
    let has_time = named && names[0].starts_with('t');
    let column = match &table.component {
        None => usize::from(has_time),
        Some(word) => match word.parse::<usize>() {
            Ok(number) => number - 1 + usize::from(has_time),
            Err(_) => names.iter().position(|name| name.contains(&word.to_lowercase())).ok_or("component")?,
        },
    };
    let unit = match (named.then(|| names.get(column)).flatten(), table.units.as_deref()) {
        (Some(name), None) if name.ends_with("_g") => GRAVITY,
        (Some(name), None) if name.ends_with("m_s2") => 1.0,
        (_, Some("g")) => GRAVITY,
        (_, Some("m/s2")) => 1.0,
        (name, units) => return Err(format!("units of {name:?}, {units:?}")),
    };
    let step = match table.time_step_s {
        Some(step) => step,
        None if has_time => (rows[rows.len() - 1][0] - rows[0][0]) / (rows.len() - 1) as f64,
        None => return Err("time_step_s".to_owned()),
    };
    Ok((step, rows.iter().map(|row| unit * row[column]).collect()))
}
