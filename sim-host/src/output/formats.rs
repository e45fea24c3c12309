//! The formats in which a command writes its tables and pictures.

use std::fmt;
use std::str::FromStr;

/// Formats of tables and pictures. Tables are always written as CSV: they are the record of the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Formats {
    /// Tables as Parquet too.
    pub parquet: bool,
    /// Pictures as SVG.
    pub svg: bool,
    /// Pictures as PNG.
    pub png: bool,
}

impl Formats {
    /// What every command writes: tables as CSV, pictures as SVG.
    pub const PLAIN: Formats = Formats { parquet: false, svg: true, png: false };
    /// All there are.
    pub const ALL: Formats = Formats { parquet: true, svg: true, png: true };
}

/// A list of formats that cannot be followed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FormatsError {
    /// CSV is not in the list.
    #[error("csv cannot be left out, since it is the record of the run")]
    WithoutCsv,
    /// A name that no format has.
    #[error("`{0}` is not a format; there are csv, parquet, svg and png")]
    Unknown(String),
}

impl FromStr for Formats {
    type Err = FormatsError;

    fn from_str(list: &str) -> Result<Formats, FormatsError> {
        let mut formats = Formats { parquet: false, svg: false, png: false };
        let mut csv = false;
        for name in list.split(',').map(str::trim) {
            match name {
                "csv" => csv = true,
                "parquet" => formats.parquet = true,
                "svg" => formats.svg = true,
                "png" => formats.png = true,
                other => return Err(FormatsError::Unknown(other.to_owned())),
            }
        }
        if csv { Ok(formats) } else { Err(FormatsError::WithoutCsv) }
    }
}

impl fmt::Display for Formats {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("csv")?;
        for (chosen, name) in [(self.parquet, ",parquet"), (self.svg, ",svg"), (self.png, ",png")] {
            if chosen {
                out.write_str(name)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_read_back() {
        for formats in [Formats::PLAIN, Formats::ALL, Formats { parquet: true, svg: false, png: false }] {
            assert_eq!(formats.to_string().parse(), Ok(formats));
        }
        assert_eq!("png, csv,svg,parquet".parse(), Ok(Formats::ALL));
    }

    #[test]
    fn lists_without_csv_and_other_names_are_refused() {
        assert_eq!("svg,png".parse::<Formats>(), Err(FormatsError::WithoutCsv));
        assert_eq!("csv,pdf".parse::<Formats>(), Err(FormatsError::Unknown("pdf".to_owned())));
        assert_eq!("".parse::<Formats>(), Err(FormatsError::Unknown(String::new())));
    }
}
