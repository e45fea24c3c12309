//! Numbers of a study as its tables print them.

/// A number for a table with `digits` decimals; a dash for none and for one that is not finite.
pub fn cell(value: impl Into<Option<f64>>, digits: usize) -> String {
    match value.into() {
        Some(value) if value.is_finite() => format!("{value:.digits$}"),
        _ => "-".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_a_dash() {
        assert_eq!([cell(1.25, 1), cell(Some(-2.0), 2)], ["1.2", "-2.00"]);
        assert_eq!([cell(None, 1), cell(f64::NAN, 1), cell(f64::INFINITY, 1)], ["-", "-", "-"]);
    }
}
