//! USGS SMC files.
//!
//! Eleven text lines, 48 integers (8I10), 50 reals (5E15.7), as many comment lines as the 16th integer says, then
//! the samples in cm/s², eight per line in fields of ten characters that may touch. The 17th integer is the number
//! of samples, the 2nd real the samples per second, the 30th and 32nd the largest and smallest value.
//! Source: USGS Open-File Report "BAP: Basic strong-motion accelerogram processing software" (92-296A), SMC format.

use super::contents::{Contents, Format, Header, StatedStep, bad_field, reject_other_quantity};
use super::error::RecordError;
use super::number::append_numbers;
use super::units::Units;

const TEXT_LINES: usize = 11;
const INTEGER_LINES: usize = 6;
const INTEGERS: usize = 48;
const INTEGER_WIDTH: usize = 10;
const REAL_LINES: usize = 10;
const REALS: usize = 50;
const REAL_WIDTH: usize = 15;
const SAMPLE_WIDTH: usize = 10;
/// Reals at or above this mean "unknown" (the format writes 1.7E+38).
const UNKNOWN_REAL: f64 = 1e38;

const COMMENT_LINES: usize = 15;
const SAMPLES: usize = 16;
const RATE: usize = 1;
const LARGEST: usize = 29;
const SMALLEST: usize = 31;

/// Whether these lines are an SMC file: the first names the kind of data, the headers stand where they belong.
pub(super) fn recognises(lines: &[&str]) -> bool {
    let kind = lines.first().is_some_and(|line| {
        let upper = line.to_ascii_uppercase();
        ["ACCELEROGRAM", "VELOCITY", "DISPLACEMENT", "SPECTR"].iter().any(|word| upper.contains(word))
    });
    kind && numbers(lines, TEXT_LINES, INTEGER_LINES, INTEGER_WIDTH).is_ok_and(|values| values.len() == INTEGERS)
}

/// Reads the lines of an SMC file.
pub(super) fn read(name: &str, lines: &[&str]) -> Result<Contents, RecordError> {
    let first = lines.first().copied().unwrap_or("");
    if !first.to_ascii_uppercase().contains("ACCELEROGRAM") {
        reject_other_quantity(name, 0, first)?;
    }
    let malformed = |line: usize, problem: String| RecordError::Malformed { file: name.to_owned(), line, problem };
    let block = |start: usize, rows: usize, width: usize, due: usize| {
        let values = numbers(lines, start, rows, width).map_err(|(index, field)| bad_field(name, index, field))?;
        if values.len() == due {
            Ok(values)
        } else {
            Err(malformed(start + 1, format!("{} header numbers where the SMC format has {due}", values.len())))
        }
    };
    let integers = block(TEXT_LINES, INTEGER_LINES, INTEGER_WIDTH, INTEGERS)?;
    let reals = block(TEXT_LINES + INTEGER_LINES, REAL_LINES, REAL_WIDTH, REALS)?;
    let known = |value: f64| (value.abs() < UNKNOWN_REAL).then_some(value);
    let rate = known(reals[RATE]).filter(|rate| *rate > 0.0).ok_or_else(|| {
        malformed(TEXT_LINES + INTEGER_LINES + 1, format!("{} samples per second; more than 0 are due", reals[RATE]))
    })?;
    let comments = integers[COMMENT_LINES];
    if !(0.0..1e6).contains(&comments) {
        return Err(malformed(TEXT_LINES + 2, format!("{comments} comment lines; 0 or more are due")));
    }
    let first_data = TEXT_LINES + INTEGER_LINES + REAL_LINES + comments as usize;

    let mut contents = Contents::new(Format::UsgsSmc);
    contents.units = Some(Units::CentimetrePerSecondSquared);
    contents.header = Header {
        title: lines
            .iter()
            .take(TEXT_LINES)
            .map(|line| line.trim())
            .filter(|line| !line.is_empty() && *line != "*")
            .collect::<Vec<_>>()
            .join("; "),
        samples: (integers[SAMPLES] >= 0.0).then_some(integers[SAMPLES] as u64),
        peak_m_s2: match (known(reals[LARGEST]), known(reals[SMALLEST])) {
            (Some(largest), Some(smallest)) => Some(largest.abs().max(smallest.abs())),
            (one, other) => one.or(other).map(f64::abs),
        },
        // A single precision rate has about seven digits.
        time_step: Some(StatedStep { value_s: 1.0 / rate, resolution_s: 1e-6 / rate }),
    };
    for (index, line) in lines.iter().enumerate().skip(first_data) {
        append_numbers(line, Some(SAMPLE_WIDTH), &mut contents.values).map_err(|field| bad_field(name, index, field))?;
    }
    Ok(contents)
}

/// The numbers of `rows` lines from index `start`.
fn numbers(lines: &[&str], start: usize, rows: usize, width: usize) -> Result<Vec<f64>, (usize, super::number::BadField)> {
    let mut values = Vec::new();
    for (index, line) in lines.iter().enumerate().skip(start).take(rows) {
        append_numbers(line, Some(width), &mut values).map_err(|field| (index, field))?;
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{ReadOptions, Record, Warning};

    fn file(kind: &str, stated: usize, data: &str) -> String {
        let mut text = format!("{kind}\n{}", "*\n".repeat(10));
        for index in 0..INTEGERS {
            let value = [(COMMENT_LINES, 1), (SAMPLES, stated as i64)]
                .iter()
                .find(|(at, _)| *at == index)
                .map_or(-32768, |(_, value)| *value);
            text += &format!("{value:10}{}", if index % 8 == 7 { "\n" } else { "" });
        }
        for index in 0..REALS {
            let value = [(RATE, "0.2000000E+03"), (LARGEST, "0.3000000E+01")]
                .iter()
                .find(|(at, _)| *at == index)
                .map_or("0.1700000E+39", |(_, value)| *value);
            text += &format!("{value:>15}{}", if index % 5 == 4 { "\n" } else { "" });
        }
        text + "|a comment\n" + data
    }

    #[test]
    fn touching_columns_are_read_in_cm_s2() {
        let text = file("2 CORRECTED ACCELEROGRAM", 3, "-1.5057E+0-2.2223E+0 3.0000E+0\n");
        let record = Record::parse("a.smc", text.as_bytes(), &ReadOptions::default()).unwrap();
        assert_eq!(record.time_step_s, 0.005);
        for (found, expected) in record.acceleration_m_s2.iter().zip([-0.015057, -0.022223, 0.03]) {
            assert!((found - expected).abs() < 1e-12);
        }
        assert_eq!(record.header.peak_m_s2, Some(0.03));
        assert!(
            !record
                .warnings
                .iter()
                .any(|warning| matches!(warning, Warning::PeakDisagrees { .. } | Warning::SamplesDisagree { .. }))
        );
    }

    #[test]
    fn velocities_and_missing_headers_are_refused() {
        let text = file("3 VELOCITY", 3, " 1.0 2.0 3.0\n");
        let error = Record::parse("a.smc", text.as_bytes(), &ReadOptions::default()).unwrap_err();
        assert!(matches!(error, RecordError::NotAcceleration { line: 1, .. }), "{error}");
        let cut: String = file("2 CORRECTED ACCELEROGRAM", 3, "").lines().take(20).collect::<Vec<_>>().join("\n");
        let error = Record::parse("a.smc", cut.as_bytes(), &ReadOptions::default()).unwrap_err();
        assert!(matches!(error, RecordError::Malformed { line: 18, .. }), "{error}");
    }
}
