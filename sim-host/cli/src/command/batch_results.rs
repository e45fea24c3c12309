//! The results of `sprag batch`: rows of CSV or Parquet.

use std::fs::File;
use std::io::{self, Write};

use csv::StringRecord;
use sprag_report::columns::{Column, CsvWriter, ParquetWriter, RowWriter, TableError, TextRows, Value, metadata_of};
use sprag_report::output::Maker;
use sprag_sim::accuracy::ErrorEstimate;
use sprag_sim::batch::case::CaseResult;
use sprag_sim::batch::table::{ERROR_COLUMNS, RESULT_COLUMNS};

use super::batch_cases::Cases;

/// A result, with its error where that is asked for.
pub type Found = (CaseResult, Option<ErrorEstimate>);

/// The columns of results.
pub fn columns(with_errors: bool) -> Vec<Column> {
    let titles = RESULT_COLUMNS.split(',').chain(ERROR_COLUMNS.split(',').filter(|_| with_errors));
    let column = |title| match title {
        "id" | "outcome" | "outcome_certain" => Column::text(title),
        "impacts" => Column::count(title),
        "end_time" => Column::number(title),
        // Peaks of an overturned block and the impact of one that had none, and so their errors.
        _ => Column::number(title).or_nothing(),
    };
    titles.map(column).collect()
}

/// Gives the row of the case `id` to `writer`.
fn write(writer: &mut dyn RowWriter, id: &str, (result, error): &Found) -> Result<(), TableError> {
    let peak = |value: f64| Value::from((!result.outcome.overturned()).then_some(value));
    let plain = [
        Value::Text(id),
        Value::Text(result.outcome.name()),
        peak(result.peak_rotation),
        peak(result.peak_acceleration),
        result.impacts.into(),
        result.first_impact_time.into(),
        result.end_time.into(),
    ];
    let Some(error) = error else { return writer.row(&plain) };
    let errors = [
        error.outcome_certain.into(),
        peak(error.peak_rotation),
        peak(error.peak_acceleration),
        result.first_impact_time.map(|_| error.first_impact_time).into(),
    ];
    writer.row(&[plain.as_slice(), &errors].concat())
}

/// Neighbouring results on their way from the thread that has worked them out.
pub enum Chunk {
    /// As rows of CSV.
    Text(Vec<u8>),
    /// As they are.
    Rows(Vec<(String, Found)>),
}

impl Chunk {
    /// Of the results `rows`, for a file with these columns.
    ///
    /// # Errors
    /// Values that are not those of the columns.
    pub fn of(rows: &[(&str, Found)], columns: &[Column], as_text: bool) -> Result<Chunk, TableError> {
        if !as_text {
            return Ok(Chunk::Rows(rows.iter().map(|(id, found)| ((*id).to_owned(), *found)).collect()));
        }
        let mut writer = CsvWriter::resumed(columns.to_vec(), Vec::new());
        rows.iter().try_for_each(|(id, found)| write(&mut writer, id, found))?;
        Ok(Chunk::Text(writer.finish()?))
    }
}

/// Where results go.
pub enum Sink<'a> {
    /// Rows of CSV, and whether the titles are written.
    Csv(&'a mut dyn Write, bool),
    /// Parquet.
    Parquet(Box<ParquetWriter<&'a mut (dyn Write + Send)>>),
}

impl<'a> Sink<'a> {
    /// CSV in `out`.
    pub fn csv(out: &'a mut dyn Write) -> Sink<'a> {
        Sink::Csv(out, false)
    }

    /// Parquet in `out`, which says what made it.
    ///
    /// # Errors
    /// When `out` does not take the first bytes.
    pub fn parquet(columns: &[Column], out: &'a mut (dyn Write + Send)) -> io::Result<Sink<'a>> {
        let metadata = metadata_of(&Maker::new("batch", serde_json::Map::new()))?;
        Ok(Sink::Parquet(Box::new(ParquetWriter::new(columns.to_vec(), &metadata, out)?)))
    }

    /// Writes neighbouring results, the first of them below the titles.
    ///
    /// # Errors
    /// When the file does not take them.
    pub fn take(&mut self, columns: &[Column], chunk: Chunk) -> io::Result<()> {
        match (self, chunk) {
            (Sink::Csv(out, titled), Chunk::Text(text)) if !text.is_empty() => {
                if !*titled {
                    *titled = true;
                    out.write_all(&CsvWriter::new(columns.to_vec(), Vec::new())?.finish()?)?;
                }
                out.write_all(&text)
            }
            (Sink::Parquet(writer), Chunk::Rows(rows)) => {
                Ok(rows.iter().try_for_each(|(id, found)| write(&mut **writer, id, found))?)
            }
            // Chunks are made for their sink.
            _ => Ok(()),
        }
    }

    /// Hands on what is written, as far as the format lets it.
    ///
    /// # Errors
    /// When the file does not take it.
    pub fn flush(&mut self) -> io::Result<()> {
        if let Sink::Csv(out, _) = self { out.flush() } else { Ok(()) }
    }

    /// Writes what is left.
    ///
    /// # Errors
    /// When the file does not take it.
    pub fn finish(self) -> io::Result<()> {
        match self {
            Sink::Csv(out, _) => out.flush(),
            Sink::Parquet(writer) => Ok(writer.finish().map(drop)?),
        }
    }
}

/// Whether `file` has results in these columns, of these cases by their ids.
///
/// # Errors
/// Those of the cases.
pub fn are_of(file: File, parquet: bool, columns: &[Column], cases: &mut Cases) -> anyhow::Result<bool> {
    let rows = if parquet { TextRows::of_parquet(file) } else { Ok(TextRows::of_csv(file)) };
    let Ok(mut rows) = rows else { return Ok(false) };
    if !rows.titles().is_ok_and(|titles| titles.iter().eq(columns.iter().map(|column| &column.name))) {
        return Ok(false);
    }
    let mut row = StringRecord::new();
    let all = cases.each(|id, _| rows.read(&mut row).is_ok_and(|read| read) && row.get(0) == Some(id))?;
    Ok(all && rows.read(&mut row).is_ok_and(|more| !more))
}
