//! A field of a CSV file.

/// `text` as a field, in quotes where it needs them: for tables whose other fields never do, and that are long.
///
/// # Errors
/// A text that cannot be written.
pub fn quoted(text: &str) -> Result<String, csv::Error> {
    let mut line = csv::Writer::from_writer(Vec::new());
    line.write_record([text])?;
    let mut field = line.into_inner().map_err(|error| error.into_error())?;
    // The end of the line.
    field.pop();
    Ok(String::from_utf8_lossy(&field).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_with_commas_are_quoted() {
        assert_eq!(quoted("pair (σ = 0.5)").unwrap(), "pair (σ = 0.5)");
        assert_eq!(quoted("a, \"b\"").unwrap(), "\"a, \"\"b\"\"\"");
    }
}
