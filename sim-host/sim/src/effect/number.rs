//! Numbers for people: five significant digits.

/// `value` with at most five significant digits.
pub fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return if value > 0.0 { "∞".to_owned() } else { format!("{value}") };
    }
    let (mantissa, exponent) = scientific(value, 5);
    if !(-4..6).contains(&exponent) {
        return format!("{}e{exponent}", trimmed(&mantissa));
    }
    let decimals = usize::try_from(4 - exponent).unwrap_or(0);
    trimmed(&format!("{value:.decimals$}")).to_owned()
}

/// A finite `value`, rounded to so many significant `digits`, as a number of one digit before the point and the power of ten that it is of.
pub fn scientific(value: f64, digits: usize) -> (String, i32) {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    (mantissa.to_owned(), exponent.parse().unwrap_or(0))
}

/// The number with a true minus sign, as tables and pages have it; a dash stays one.
pub fn true_minus(number: &str) -> String {
    match number {
        "-" => number.to_owned(),
        _ => number.replace('-', "\u{2212}"),
    }
}

/// Without the zeros at the end of its fraction.
fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_digits_and_no_zeros() {
        for (value, text) in [
            (0.0, "0"),
            (0.5, "0.5"),
            (4.0 / 3.0, "1.3333"),
            (-9.806_65, "-9.8066"),
            (123_456.7, "123457"),
            (1e7, "1e7"),
            (2.5e-7, "2.5e-7"),
            (9.999_99, "10"),
            (f64::INFINITY, "∞"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
