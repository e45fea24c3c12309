//! What a table has in each column.

use std::fmt;

use super::error::TableError;
use super::value::Value;

/// What the values of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// f64; in CSV as short as it reads back to the same f64, in Parquet DOUBLE.
    Number,
    /// u64; in Parquet INT64 of the logical type INTEGER(64, unsigned).
    Count,
    /// UTF-8; in Parquet STRING.
    Text,
}

impl fmt::Display for Kind {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Kind::Number => "a number",
            Kind::Count => "a whole number from 0 to 2^64 - 1",
            Kind::Text => "a text",
        })
    }
}

/// How people read the values of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// As they are; numbers with so many decimals.
    Digits(usize),
    /// Numbers of any size, with so many decimals, or as many figures where these would be fewer.
    Figures(usize),
    /// A share, in percent with one decimal.
    Percent,
    /// A ratio, as the change in percent that it is.
    Change,
}

/// A column of a table. Names differ within a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name: the title in CSV.
    pub name: String,
    /// What its values are.
    pub kind: Kind,
    /// Whether there may be no value: an empty field in CSV, null in Parquet. An empty text is none then.
    pub nullable: bool,
    /// The heading above it and how it is shown, in tables for people that have it.
    pub shown: Option<(&'static str, Shown)>,
}

impl Column {
    /// A column with a number in every row.
    pub fn number(name: impl Into<String>) -> Column {
        Column { name: name.into(), kind: Kind::Number, nullable: false, shown: None }
    }

    /// A column with a whole number from 0 in every row.
    pub fn count(name: impl Into<String>) -> Column {
        Column { kind: Kind::Count, ..Column::number(name) }
    }

    /// A column with a text in every row.
    pub fn text(name: impl Into<String>) -> Column {
        Column { kind: Kind::Text, ..Column::number(name) }
    }

    /// The column, in which rows may have no value.
    #[must_use]
    pub fn or_nothing(self) -> Column {
        Column { nullable: true, ..self }
    }

    /// The column, which tables for people have under `heading`.
    #[must_use]
    pub fn shown(self, heading: &'static str, shown: Shown) -> Column {
        Column { shown: Some((heading, shown)), ..self }
    }

    /// `value` as every format has it: no empty texts where there may be nothing, and one NaN, since CSV knows no other.
    ///
    /// # Errors
    /// [`TableError::WrongKind`] and [`TableError::Missing`]; `row` counts from 1.
    pub(super) fn taken<'a>(&self, value: Value<'a>, row: u64) -> Result<Value<'a>, TableError> {
        match (self.kind, value) {
            (Kind::Text, Value::Text("")) | (_, Value::Nothing) if self.nullable => Ok(Value::Nothing),
            (Kind::Number, Value::Number(number)) if number.is_nan() => Ok(Value::Number(f64::NAN)),
            (Kind::Number, Value::Number(_)) | (Kind::Count, Value::Count(_)) | (Kind::Text, Value::Text(_)) => Ok(value),
            (_, Value::Nothing) => Err(TableError::Missing { row, column: self.name.clone() }),
            (kind, _) => Err(TableError::WrongKind { row, column: self.name.clone(), kind, value: format!("{value:?}") }),
        }
    }

    /// The value that `field` of a CSV file says; `None` when it is none of this column.
    pub(super) fn parsed<'a>(&self, field: &'a str) -> Option<Value<'a>> {
        if field.is_empty() && self.nullable {
            return Some(Value::Nothing);
        }
        match self.kind {
            Kind::Number => field.parse().ok().map(Value::Number),
            Kind::Count => field.parse().ok().map(Value::Count),
            Kind::Text => Some(Value::Text(field)),
        }
    }
}
