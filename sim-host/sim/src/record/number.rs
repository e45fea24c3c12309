//! Numbers as Fortran, spreadsheets and people write them.

use sprag_shared::math;

/// A piece of text that should have been a number.
#[derive(Debug, PartialEq)]
pub(super) struct BadField {
    /// The text, shortened to 40 characters.
    pub text: String,
    /// The text is a NaN, an infinity, or beyond f64.
    pub not_finite: bool,
}

impl BadField {
    fn new(text: &str, not_finite: bool) -> BadField {
        BadField { text: text.trim().chars().take(40).collect(), not_finite }
    }
}

/// Reads one number: `-.8877145E-03`, `1.5D+02`, `"0.1"`, and Fortran's three-digit exponents without a letter
/// (`.1234567-102`).
fn number(text: &str) -> Result<f64, BadField> {
    let token = text.trim().trim_matches('"');
    let unsigned = token.strip_prefix(['+', '-']).unwrap_or(token);
    if !unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        let lower = unsigned.to_ascii_lowercase();
        return Err(BadField::new(text, matches!(lower.as_str(), "nan" | "inf" | "infinity")));
    }
    let value = token
        .parse::<f64>()
        .ok()
        .or_else(|| token.replace(['D', 'd'], "E").parse::<f64>().ok())
        .or_else(|| exponent_without_letter(token).and_then(|spelled| spelled.parse::<f64>().ok()));
    match value {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(BadField::new(text, true)),
        None => Err(BadField::new(text, false)),
    }
}

/// `.1234567-102` with its `E`, if that is what the token is.
fn exponent_without_letter(token: &str) -> Option<String> {
    let at = token.rfind(['+', '-']).filter(|at| *at > 0)?;
    let (mantissa, exponent) = (token.get(..at)?, token.get(at..)?);
    let plain = mantissa.contains('.') && mantissa.chars().skip(1).all(|c| c.is_ascii_digit() || c == '.');
    (plain && exponent.len() == 4).then(|| format!("{mantissa}E{exponent}"))
}

/// Appends the numbers of one line to `values` and returns how many there were.
///
/// Fields are parted by blanks, tabs, commas or semicolons. Where they are not parted at all, because a Fortran
/// field is filled to the brim, the line is cut in fields of `width` characters, and if that fails at the sign that
/// follows a complete number.
///
/// # Errors
///
/// The first field that is no finite number; `values` is then as it was.
pub(super) fn append_numbers(line: &str, width: Option<usize>, values: &mut Vec<f64>) -> Result<usize, BadField> {
    let before = values.len();
    let first_problem = match append_separated(line, values) {
        Ok(()) => return Ok(values.len() - before),
        Err(problem) => problem,
    };
    values.truncate(before);
    if first_problem.not_finite {
        return Err(first_problem);
    }
    if width.is_some_and(|width| append_fixed_width(line, width, values).is_some()) {
        return Ok(values.len() - before);
    }
    values.truncate(before);
    if append_touching(line, values).is_some() {
        return Ok(values.len() - before);
    }
    values.truncate(before);
    Err(first_problem)
}

fn append_separated(line: &str, values: &mut Vec<f64>) -> Result<(), BadField> {
    let line = line.trim();
    let line = line.strip_suffix([',', ';']).unwrap_or(line);
    if line.is_empty() {
        return Ok(());
    }
    for piece in line.split([',', ';']) {
        if piece.trim().is_empty() {
            return Err(BadField::new(piece, false));
        }
        for token in piece.split_whitespace() {
            values.push(number(token)?);
        }
    }
    Ok(())
}

fn append_fixed_width(line: &str, width: usize, values: &mut Vec<f64>) -> Option<()> {
    let line = line.trim_end();
    // Fields are filled from the right, so a full line ends where a field ends; otherwise the cuts would be elsewhere.
    if !line.is_ascii() || line.is_empty() || !line.len().is_multiple_of(width) {
        return None;
    }
    for start in (0..line.len()).step_by(width) {
        let field = &line[start..start + width];
        values.push(number(field).ok()?);
    }
    Some(())
}

/// Splits `1.5057E+0-2.2223E+0` at signs that do not belong to an exponent.
fn append_touching(line: &str, values: &mut Vec<f64>) -> Option<()> {
    for token in line.split_whitespace() {
        let mut start = 0;
        let bytes = token.as_bytes();
        for at in 1..=bytes.len() {
            let cut =
                at == bytes.len() || (matches!(bytes[at], b'+' | b'-') && !matches!(bytes[at - 1], b'E' | b'e' | b'D' | b'd'));
            if cut {
                values.push(number(token.get(start..at)?).ok()?);
                start = at;
            }
        }
    }
    Some(())
}

/// Value of the last printed digit of a number: 0.0001 for `12.3450`, 1e-7 for `1.2345E-03`, 1 for `12`.
pub(super) fn last_digit(text: &str) -> f64 {
    let (mantissa, exponent) = text.split_once(['E', 'e', 'D', 'd']).unwrap_or((text, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, digits)| digits.chars().filter(char::is_ascii_digit).count());
    let exponent = exponent.trim().parse::<f64>().unwrap_or(0.0).clamp(-300.0, 300.0);
    math::pow(10.0, exponent - decimals.min(300) as f64)
}

/// Value of the last printed digit of a column. Some programs leave trailing zeros out, so numbers with fewer digits than others say nothing.
pub(super) fn column_resolution<'a>(fields: impl Iterator<Item = &'a str>) -> f64 {
    let printed = fields.map(|field| (significant_digits(field), last_digit(field)));
    printed
        .fold(
            (0, 0.0),
            |most: (usize, f64), field| if field.0 > most.0 || (field.0 == most.0 && field.1 > most.1) { field } else { most },
        )
        .1
}

/// Digits of a number from its first one that is not zero: 3 of `0.0120`.
fn significant_digits(text: &str) -> usize {
    let mantissa = text.split(['E', 'e', 'D', 'd']).next().unwrap_or_default();
    mantissa.chars().filter(char::is_ascii_digit).skip_while(|digit| *digit == '0').count()
}

/// First number in a piece of header text, with the text it was written as. Leading blanks, `=` and `:` are skipped.
pub(super) fn leading_number(text: &str) -> Option<(f64, &str)> {
    let text = text.trim_start_matches([' ', '\t', '=', ':']);
    let end =
        text.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '+' | '-' | 'E' | 'e' | 'D' | 'd'))).unwrap_or(text.len());
    let token = &text[..end];
    number(token).ok().map(|value| (value, token))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(line: &str, width: Option<usize>) -> Result<Vec<f64>, BadField> {
        let mut values = Vec::new();
        append_numbers(line, width, &mut values).map(|_| values)
    }

    #[test]
    fn separated_fields() {
        assert_eq!(numbers("  .8877145E-03\t-.5D+01, 3 ;+4.", None), Ok(vec![0.8877145e-3, -5.0, 3.0, 4.0]));
        assert_eq!(numbers(".1234567-102", None), Ok(vec![0.1234567e-102]));
        assert_eq!(numbers("", None), Ok(vec![]));
    }

    #[test]
    fn touching_fields() {
        assert_eq!(numbers("-0.123456789E-03-0.234567890E-03", Some(16)), Ok(vec![-0.123456789e-3, -0.23456789e-3]));
        assert_eq!(
            numbers("00.1234567E-0300.2345678E-03  .3456789E-03", Some(15)).unwrap_err().text,
            "00.1234567E-0300.2345678E-03"
        );
        assert_eq!(
            numbers("000.1234567E-03000.2345678E-03   .3456789E-03", Some(15)),
            Ok(vec![0.1234567e-3, 0.2345678e-3, 0.3456789e-3])
        );
        assert_eq!(numbers(" 1.5057E+0-2.2223E+0-5.0138E-1 1.9171E+0", Some(10)), Ok(vec![1.5057, -2.2223, -0.50138, 1.9171]));
        assert_eq!(numbers("1.5E+0-2.2E+0-3", None), Ok(vec![1.5, -2.2, -3.0]));
    }

    #[test]
    fn what_is_no_number_is_named() {
        assert_eq!(numbers("0.1 abc", None).unwrap_err(), BadField { text: "abc".into(), not_finite: false });
        assert!(numbers("0.1 NaN", None).unwrap_err().not_finite);
        assert!(numbers("-inf", None).unwrap_err().not_finite);
        assert!(numbers("1e999", None).unwrap_err().not_finite);
        assert!(numbers("0.1,,0.2", None).is_err());
        assert!(numbers("é-é", Some(15)).is_err());
    }

    #[test]
    fn a_column_is_as_exact_as_its_longest_numbers() {
        for (fields, expected) in [
            ("0 0.005 0.01 0.015 0.1 1", 1e-3),
            ("0.000 0.005 10.005", 1e-3),
            ("0 1 999.999 1000.01", 0.01),
            ("0.00E+00 5.00E-03 1.00E-02", 1e-4),
            ("0 5 10", 1.0),
        ] {
            let found = column_resolution(fields.split(' '));
            assert!((found / expected - 1.0).abs() < 1e-12, "{fields}: {found}");
        }
    }

    #[test]
    fn last_digit_is_the_printed_resolution() {
        for (text, expected) in [("12.3450", 1e-4), ("1.2345E-03", 1e-7), ("12", 1.0), (".0050", 1e-4), ("1.0E+02", 10.0)] {
            assert!((last_digit(text) / expected - 1.0).abs() < 1e-12, "{text}");
        }
    }
}
