//! PEER acceleration files (`.AT2`) of every era.
//!
//! A few title lines, a line with the units, a line with the number of samples and the time step in either order
//! (`NPTS=   7817, DT=   .0050 SEC`, `12400    0.0050    NPTS, DT`), then the samples row by row, usually five per
//! line in fields of 15 characters.

use super::contents::{Contents, Format, Header, StatedStep, bad_field, header_units, reject_other_quantity};
use super::error::RecordError;
use super::number::{append_numbers, last_digit, leading_number};
use super::text::comment;
use super::warning::Warning;

/// Characters per sample in PEER files; only used where fields touch.
const FIELD_WIDTH: usize = 15;
/// A header longer than this is none.
const MAXIMUM_HEADER_LINES: usize = 20;

/// Samples and step in a header line, each optional.
#[derive(Debug, Default, PartialEq)]
struct Counts {
    samples: Option<f64>,
    step: Option<StatedStep>,
}

/// Index of the line with NPTS, if these are the lines of an AT2 file.
pub(super) fn counts_line(lines: &[&str]) -> Option<usize> {
    lines.iter().take(MAXIMUM_HEADER_LINES).position(|line| {
        let upper = line.to_ascii_uppercase();
        comment(line).is_none() && word_at(&upper, "NPTS").is_some()
    })
}

/// Reads the lines of an AT2 file whose NPTS stand in line `counts_index` (from 0).
pub(super) fn read(name: &str, lines: &[&str], counts_index: usize) -> Result<Contents, RecordError> {
    let mut contents = Contents::new(Format::PeerAt2);
    let mut counts = counts_in(lines[counts_index]);
    let mut first_data = counts_index + 1;
    while let Some(line) = lines.get(first_data).filter(|_| first_data < MAXIMUM_HEADER_LINES) {
        let mut values = Vec::new();
        if append_numbers(line, Some(FIELD_WIDTH), &mut values).is_ok_and(|count| count > 0) {
            break;
        }
        if line.trim().starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '+' | '.')) && counts.step.is_some() {
            break;
        }
        let more = counts_in(line);
        counts.samples = counts.samples.or(more.samples);
        counts.step = counts.step.or(more.step);
        first_data += 1;
    }
    let header: Vec<(usize, &str)> = lines[..first_data].iter().copied().enumerate().collect();
    contents.units = header_units(name, &header)?;
    if counts.samples.and_then(whole_number).is_none() {
        contents.warnings.extend(unreadable_samples(lines[counts_index]));
    }
    for (index, line) in header.iter().filter(|(_, line)| line.to_ascii_uppercase().contains("TIME ")) {
        reject_other_quantity(name, *index, line)?;
    }
    contents.header = Header {
        title: header.iter().take(2).map(|(_, line)| line.trim()).collect::<Vec<_>>().join("; "),
        samples: counts.samples.and_then(whole_number),
        peak_m_s2: None,
        time_step: counts.step,
    };
    for (index, line) in lines.iter().enumerate().skip(first_data) {
        append_numbers(line, Some(FIELD_WIDTH), &mut contents.values).map_err(|field| bad_field(name, index, field))?;
    }
    Ok(contents)
}

/// Number of samples and time step that a line of text states with the words NPTS and DT.
pub(super) fn stated_counts(line: &str) -> (Option<u64>, Option<StatedStep>) {
    let counts = counts_in(line);
    (counts.samples.and_then(whole_number), counts.step)
}

/// A warning, if the line says NPTS and then no number of samples: `NPTS= ****, DT= .0050 SEC`.
pub(super) fn unreadable_samples(line: &str) -> Option<Warning> {
    const LONGEST: usize = 20;
    let upper = line.to_ascii_uppercase();
    let after = &line[word_at(&upper, "NPTS")? + "NPTS".len()..];
    let word = after.trim_start_matches([' ', '\t', '=', ':']).split([' ', '\t', ',', ';']).next().unwrap_or_default();
    let unreadable = stated_counts(line).0.is_none();
    unreadable.then(|| Warning::SamplesUnreadable { text: word.chars().take(LONGEST).collect() })
}

fn whole_number(value: f64) -> Option<u64> {
    (0.0..1e15).contains(&value).then_some(value as u64)
}

/// Byte position of a word that is not part of a longer one.
fn word_at(upper: &str, word: &str) -> Option<usize> {
    upper.match_indices(word).map(|(at, _)| at).find(|at| {
        let before = upper[..*at].chars().next_back();
        let after = upper[at + word.len()..].chars().next();
        !before.is_some_and(char::is_alphanumeric) && !after.is_some_and(|c| c.is_alphabetic())
    })
}

fn counts_in(line: &str) -> Counts {
    let upper = line.to_ascii_uppercase();
    let after = |word: &str| word_at(&upper, word).map(|at| &upper[at + word.len()..]);
    let stated = |(value_s, text): (f64, &str)| StatedStep { value_s, resolution_s: last_digit(text) };
    let mut counts = Counts {
        samples: after("NPTS").and_then(leading_number).map(|(value, _)| value),
        step: after("DT").and_then(leading_number).map(stated),
    };
    // `NPTS= ****, DT= .0050`: what stands there is the number of samples, unreadable as it is.
    let unreadable = |text: &str| {
        text.trim_start_matches([' ', '\t', '=', ':']).starts_with(|c: char| !c.is_alphabetic() && !matches!(c, ',' | ';'))
    };
    let apart = after("NPTS").is_none_or(unreadable);
    if counts.samples.is_some() || (counts.step.is_some() && apart) {
        return counts;
    }
    // `12400 0.0050 NPTS, DT` or `NPTS, DT: 12400, 0.0050`: two numbers in the order of the words.
    let numbers: Vec<(f64, &str)> = upper.split([' ', '\t', ',', ';', '=', ':']).filter_map(leading_number).collect();
    if let (Some(_), [samples, rest @ ..]) = (after("NPTS"), numbers.as_slice()) {
        counts.samples = Some(samples.0);
        if after("DT").is_some() {
            counts.step = rest.first().copied().map(stated);
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{ReadOptions, Record};

    fn counts(line: &str) -> (Option<f64>, Option<f64>) {
        let counts = counts_in(line);
        (counts.samples, counts.step.map(|step| step.value_s))
    }

    #[test]
    fn every_header_variant_gives_samples_and_step() {
        for line in [
            "NPTS=   4000, DT=   .0050 SEC,       ",
            "NPTS=  4000, DT= .00500 SEC",
            "NPTS= 4000,\tDT=\t0.0050\tSEC",
            "NPTS= 4000, DT= 0.0050 ",
            "4000    0.0050    NPTS, DT",
            "4000,0.0050,npts,dt",
            "npts=4000 dt=0.005",
            "NPTS, DT: 4000, .0050",
            "NPTS=  4000, DT= .00500 SEC, 4 POLE @ 40.00000 HZ, -5 POLE @ .10000",
        ] {
            assert_eq!(counts(line), (Some(4000.0), Some(0.005)), "{line}");
        }
        assert_eq!(counts("NPTS= 4000"), (Some(4000.0), None));
        assert_eq!(counts("DT= .005 SEC"), (None, Some(0.005)));
    }

    fn read_text(text: &str) -> Result<Record, RecordError> {
        Record::parse("test.AT2", text.as_bytes(), &ReadOptions::default())
    }

    #[test]
    fn header_lines_may_be_more_or_fewer_and_fields_may_touch() {
        let data = "  -.5000000E-01000.1000000E+00-00.2000000E+00\n   .5000000E-01\n";
        for header in [
            "PEER\nEvent, station, 90\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 4, DT= .0050 SEC\n",
            "Event, station, 90\nACCELERATION TIME HISTORY IN UNITS OF G\n4 0.0050 NPTS, DT\n",
            "PEER\nEvent\nStation\nACCELERATION TIME HISTORY IN UNITS OF G\nnpts= 4\ndt= .005\n",
            "PEER\r\nEvent\r\nAcceleration in units of g\r\nNPTS= 4, DT= .005 SEC\r\nextra line\r\n",
        ] {
            let record = read_text(&format!("{header}{data}")).unwrap_or_else(|error| panic!("{header}: {error}"));
            let in_g: Vec<f64> = record.acceleration_m_s2.iter().map(|a| a / 9.80665).collect();
            for (found, expected) in in_g.iter().zip([-0.05, 0.1, -0.2, 0.05]) {
                assert!((found - expected).abs() < 1e-15);
            }
            assert_eq!((record.acceleration_m_s2.len(), record.time_step_s, record.header.samples), (4, 0.005, Some(4)));
        }
    }

    #[test]
    fn an_unreadable_number_of_samples_is_said() {
        let text = |counts: &str| format!("PEER\nE\nACCELERATION IN UNITS OF G\n{counts}\n .1 .2\n");
        for (counts, shown) in [
            ("NPTS=  ****, DT= .005 SEC", "****"),
            ("NPTS= 99999999999999999999, DT= .005 SEC", "99999999999999999999"),
            ("NPTS= -4, DT= .005", "-4"),
        ] {
            let record = read_text(&text(counts)).unwrap();
            assert!(
                record.warnings.contains(&Warning::SamplesUnreadable { text: shown.into() }),
                "{counts}: {:?}",
                record.warnings
            );
        }
        for counts in ["NPTS= 2, DT= .005", "2 .005 NPTS, DT", "npts= 2\ndt= .005", "2 NPTS\n.005 DT"] {
            let options = ReadOptions { time_step_s: Some(0.005), ..ReadOptions::default() };
            let record = Record::parse("test.AT2", text(counts).as_bytes(), &options).unwrap();
            assert!(!record.warnings.iter().any(|warning| matches!(warning, Warning::SamplesUnreadable { .. })), "{counts}");
        }
        let comment = "# NPTS = ****, DT = 0.005, units: g\n0.1\n0.2\n";
        assert!(read_text(comment).unwrap().warnings.contains(&Warning::SamplesUnreadable { text: "****".into() }));
    }

    #[test]
    fn velocity_files_are_refused() {
        let error = read_text("PEER\nE\nVELOCITY TIME SERIES IN UNITS OF CM/S\nNPTS= 2, DT= .01 SEC\n1 2\n").unwrap_err();
        assert_eq!(error.to_string(), "test.AT2: line 3: the header says velocity; only acceleration histories are read");
    }

    #[test]
    fn a_bad_sample_is_named_with_its_line() {
        let text = "PEER\nE\nACCELERATION IN UNITS OF G\nNPTS= 4, DT= .01 SEC\n.1 .2\n.3 NaN\n";
        assert_eq!(
            read_text(text).unwrap_err().to_string(),
            "test.AT2: line 6: `NaN` is not finite; every sample must be a finite number"
        );
        let text = "PEER\nE\nACCELERATION IN UNITS OF G\nNPTS= 4, DT= .01 SEC\n.1 .2\n.3 ****\n";
        assert_eq!(read_text(text).unwrap_err().to_string(), "test.AT2: line 6: `****` where a number is due");
    }
}
