//! The formats in which a command writes its tables and pictures.

use std::fmt;
use std::str::FromStr;

use crate::part::{Missing, Part};

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
    /// All that the program was built with.
    pub const ALL: Formats = Formats { parquet: Part::PARQUET.is_built(), svg: true, png: Part::PNG.is_built() };
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
    /// A format that the program was built without.
    #[error("{0}")]
    Missing(#[from] Missing),
}

impl FromStr for Formats {
    type Err = FormatsError;

    fn from_str(list: &str) -> Result<Formats, FormatsError> {
        let mut formats = Formats { parquet: false, svg: false, png: false };
        let mut csv = false;
        for name in list.split(',').map(str::trim) {
            match name {
                "csv" => csv = true,
                "parquet" => formats.parquet = Part::PARQUET.allow(true)?,
                "svg" => formats.svg = true,
                "png" => formats.png = Part::PNG.allow(true)?,
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
        for formats in [Formats::PLAIN, Formats::ALL, Formats { svg: false, ..Formats::PLAIN }] {
            assert_eq!(formats.to_string().parse(), Ok(formats));
        }
        assert_eq!(" svg, csv".parse(), Ok(Formats::PLAIN));
    }

    #[test]
    fn what_the_program_was_built_without_is_refused() {
        for (name, part) in [("parquet", Part::PARQUET), ("png", Part::PNG)] {
            let list = format!("csv,{name}");
            match list.parse::<Formats>() {
                Ok(formats) => assert!(part.is_built() && formats.to_string() == list, "{formats}"),
                Err(refused) => {
                    assert!(!part.is_built() && refused.to_string().ends_with(&format!("`--features {name}`")), "{refused}")
                }
            }
        }
    }

    #[test]
    fn lists_without_csv_and_other_names_are_refused() {
        assert_eq!("svg".parse::<Formats>(), Err(FormatsError::WithoutCsv));
        assert_eq!("csv,pdf".parse::<Formats>(), Err(FormatsError::Unknown("pdf".to_owned())));
        assert_eq!("".parse::<Formats>(), Err(FormatsError::Unknown(String::new())));
    }
}
