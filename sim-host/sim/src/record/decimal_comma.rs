//! Decimal commas, as spreadsheets of many countries write them: `0,01;0,1499`.
//!
//! A comma also parts fields, so that commas are taken for decimal marks only where they can be nothing else.

use super::columns::{is_acceleration, is_time};
use super::error::RecordError;
use super::text::comment;

/// The lines of a file with decimal commas, with points in their place; `None` if its commas are none, or may part fields.
///
/// # Errors
///
/// [`RecordError::DecimalCommas`] where commas seem to be decimal marks, but cannot be distinguished from commas between fields, or points
/// stand beside them (`1.234,5`).
pub(super) fn with_points(name: &str, lines: &[&str]) -> Result<Option<Vec<String>>, RecordError> {
    let (mut first_comma, mut parted, mut all_decimal, mut leading_zero) = (None, false, true, false);
    for (index, line) in lines.iter().enumerate().filter(|(_, line)| is_numbers(line)) {
        let fields = || line.split([' ', '\t', ';', '"']).filter(|field| !field.is_empty() && !is_date(field));
        if fields().any(|field| field.contains('.')) {
            return beside_points(name, lines);
        }
        for (number, field) in fields().enumerate() {
            parted |= number > 0;
            if !field.contains(',') {
                continue;
            }
            first_comma = first_comma.or(Some(index));
            all_decimal &= is_decimal(field);
            leading_zero |= field.split(',').skip(1).any(is_fraction_only) || field.starts_with("-0,");
        }
    }
    let Some(first) = first_comma else { return Ok(None) };
    let refused = || RecordError::DecimalCommas { file: name.to_owned(), line: first + 1 };
    match (all_decimal, parted || leading_zero, leading_zero) {
        (true, true, _) => Ok(Some(lines.iter().map(|line| points(line)).collect())),
        // One comma a line, as between two columns of whole numbers: a line of names distinguishes them.
        (true, false, _) if lines[..first].iter().any(|line| names_two_columns(line)) => Ok(None),
        (true, false, _) | (false, _, true) => Err(refused()),
        (false, _, false) => Ok(None),
    }
}

/// Lines of which a number has a point: their commas part fields, unless semicolons or tabs do.
fn beside_points(name: &str, lines: &[&str]) -> Result<Option<Vec<String>>, RecordError> {
    let parted = |line: &str| line.trim_end_matches([';', ' ', '\t']).contains([';', '\t']);
    let decimal = |line: &str| {
        line.contains(',')
            && parted(line)
            && is_numbers(line)
            && line.split([';', '\t']).any(|field| is_grouped_decimal(field.trim().trim_matches('"')))
    };
    let first = lines.iter().position(|line| decimal(line));
    first.map_or(Ok(None), |index| Err(RecordError::DecimalCommas { file: name.to_owned(), line: index + 1 }))
}

/// `1.234,5` and `0,5`: a decimal comma, and before it points in the place of thousands only.
fn is_grouped_decimal(field: &str) -> bool {
    let Some((whole, fraction)) = field.split_once(',') else { return false };
    let grouped = whole.split('.').skip(1).all(|group| group.len() == 3);
    grouped && !fraction.contains('.') && is_decimal(&field.replace('.', ""))
}

/// Whether a line has nothing but numbers, at least one.
fn is_numbers(line: &str) -> bool {
    let allowed =
        |c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ',' | ';' | ' ' | '\t' | '"' | 'e' | 'E' | 'd' | 'D');
    line.trim_start().starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | ',' | '"'))
        && line.contains(|c: char| c.is_ascii_digit())
        && line.chars().all(allowed)
}

/// `12.03.1999`.
fn is_date(field: &str) -> bool {
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    field.split('.').count() == 3 && field.split('.').all(digits)
}

/// `time_ms,acc_gal`.
fn names_two_columns(line: &str) -> bool {
    let names: Vec<&str> = comment(line).unwrap_or(line).split(',').collect();
    names.len() == 2 && names.iter().any(|name| is_time(name) || is_acceleration(name))
}

/// `-0,1499`, `,5E-03`: one comma before a digit, and no sign behind it but that of an exponent.
fn is_decimal(field: &str) -> bool {
    let unsigned = field.strip_prefix(['+', '-']).unwrap_or(field);
    let Some((whole, rest)) = unsigned.split_once(',') else { return false };
    let (fraction, exponent) = rest.split_once(['e', 'E', 'd', 'D']).unwrap_or((rest, "0"));
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let exponent = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
    digits(whole) && !fraction.is_empty() && digits(fraction) && !exponent.is_empty() && digits(exponent)
}

/// Digits that no whole number has: `05`, with a zero before other digits.
fn is_fraction_only(text: &str) -> bool {
    matches!(text.as_bytes(), [b'0', b'0'..=b'9', ..])
}

/// The line with its decimal commas as points. In a line of text they are the commas between two digits.
fn points(line: &str) -> String {
    let numbers = is_numbers(line);
    let digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
    let mut before = None;
    let mut characters = line.chars().peekable();
    let mut text = String::with_capacity(line.len());
    while let Some(c) = characters.next() {
        let decimal = c == ',' && (numbers || (digit(before) && digit(characters.peek().copied())));
        text.push(if decimal { '.' } else { c });
        before = Some(c);
    }
    text
}

#[cfg(test)]
mod tests {
    use crate::record::{ReadOptions, Record, RecordError, Units, Warning};

    fn read(text: &str) -> Result<Record, RecordError> {
        let options =
            ReadOptions { units: Some(Units::MetrePerSecondSquared), time_step_s: Some(0.01), ..ReadOptions::default() };
        Record::parse("t.csv", text.as_bytes(), &options)
    }

    #[test]
    fn decimal_commas_between_other_separators_are_decimal_marks() {
        for separator in [";", "\t", "  ", " ; "] {
            for header in ["", "12.03.1999\n", "Zeit (s);Beschleunigung (m/s^2)\n", "# NPTS=4, DT=0,01\n"] {
                let rows = [("0,00", "0,0000"), ("0,01", "0,1499"), ("0,02", "-1,5E-1"), ("0,03", "1")];
                let body: String = rows.iter().map(|(time, value)| format!("{time}{separator}{value}\n")).collect();
                let record = read(&format!("{header}{body}")).unwrap_or_else(|error| panic!("{header}{body}: {error}"));
                assert_eq!((record.time_step_s, &record.acceleration_m_s2[..]), (0.01, &[0.0, 0.1499, -0.15, 1.0][..]), "{body}");
                assert!(record.warnings.contains(&Warning::DecimalCommas), "{:?}", record.warnings);
            }
        }
    }

    #[test]
    fn one_value_a_line_is_read_or_refused_by_name() {
        assert_eq!(read("0,0000\n0,1499\n-0,2000\n12,5\n").unwrap().acceleration_m_s2, [0.0, 0.1499, -0.2, 12.5]);
        // It may be a table of whole numbers as well.
        let error = read("0,1\n1,2\n2,1\n").unwrap_err();
        assert!(matches!(error, RecordError::DecimalCommas { line: 1, .. }), "{error}");
        // A comma between the fields, and another in each.
        let error = read("time,acc\n0,00,0,0000\n0,01,0,1499\n").unwrap_err().to_string();
        assert!(error.starts_with("t.csv: line 2: decimal commas: "), "{error}");
        assert!(matches!(read("0,00, 0,0000\n0,01, 0,1499\n"), Err(RecordError::DecimalCommas { .. })));
    }

    #[test]
    fn points_beside_decimal_commas_are_refused() {
        for (text, line) in [
            ("t;a\n999;999,5\n1.000;1.234,5\n", 2),
            ("t;a\n0,000;0.0\n0,005;0,1\n", 2),
            ("Export\n1.0\nt;a\n0,000;0,1\n0,005;-1,5E-1\n", 4),
            ("t\ta\n1\t2\n2\t-12.345.678,5\n", 3),
            ("t;a\n0.005;1,234\n", 2),
        ] {
            let error = read(text).unwrap_err();
            assert!(matches!(error, RecordError::DecimalCommas { line: found, .. } if found == line), "{text}: {error}");
        }
        for text in [
            "0.0,0.5;\n0.01,0.6;\n",
            "0.0, 5;\n0.01, 6;\n",
            "0.0,0.5;0.01,0.6\n",
            "0.0;0.5\n0.01;0.6\n",
            "0.00,5 ;\t\n0.01,6 ;\t\n",
        ] {
            let record = read(text).unwrap_or_else(|error| panic!("{text}: {error}"));
            assert!(!record.warnings.contains(&Warning::DecimalCommas), "{text}");
        }
    }

    #[test]
    fn commas_between_fields_stay_what_they_are() {
        let whole = read("time_ms,acc_gal\n0,1\n10,2\n20,1\n").unwrap();
        assert_eq!((whole.time_step_s, &whole.acceleration_m_s2[..]), (0.01, &[0.01, 0.02, 0.01][..]));
        assert_eq!(read("0,1,2\n3,-4,5\n").unwrap().acceleration_m_s2, [0.0, 1.0, 2.0, 3.0, -4.0, 5.0]);
        assert_eq!(read("1, 2, 3\n").unwrap().acceleration_m_s2, [1.0, 2.0, 3.0]);
        assert_eq!(read("0,00.5,1\n2,0,3\n").unwrap().acceleration_m_s2.len(), 6);
        for text in ["0,1\n1,-2\n2,1\n", "1E-3,2E-3\n2E-3,-1E-3\n"] {
            assert!(!read(text).is_ok_and(|record| record.warnings.contains(&Warning::DecimalCommas)), "{text}");
        }
    }
}
