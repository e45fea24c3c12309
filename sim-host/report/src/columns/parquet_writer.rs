//! Rows as Parquet.

use std::io::Write;
use std::sync::Arc;

use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as PhysicalType, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
pub use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{ColumnPath, Type};

use super::column::{Column, Kind};
use super::error::TableError;
use super::metadata::Metadata;
use super::table::RowWriter;
use super::value::Value;

/// Rows that are held in memory, and that a reader can take alone.
pub(super) const GROUP: usize = 65_536;

/// Writes rows as Parquet: in groups of 65,536 rows, compressed by zstd, texts by dictionaries, numbers by the streams of their bytes,
/// which compress better than whole numbers do.
///
/// Memory is that of one group. The bytes depend on nothing but columns, metadata, rows and the version of the program.
pub struct ParquetWriter<W: Write + Send> {
    columns: Vec<Group>,
    file: SerializedFileWriter<W>,
    /// Rows so far, and those that wait for their group to be full.
    rows: u64,
    held: usize,
}

impl<W: Write + Send> ParquetWriter<W> {
    /// Begins a file with `columns` in `out`.
    ///
    /// # Errors
    /// [`TableError::Parquet`] when `out` does not take the first bytes.
    pub fn new(columns: Vec<Column>, metadata: &Metadata, out: W) -> Result<ParquetWriter<W>, TableError> {
        let fields = columns.iter().map(|column| Ok(Arc::new(field(column)?))).collect::<Result<_, ParquetError>>()?;
        let schema = Type::group_type_builder("table").with_fields(fields).build()?;
        let properties = properties(&columns, metadata)?;
        let file = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?;
        Ok(ParquetWriter { columns: columns.into_iter().map(Group::new).collect(), file, rows: 0, held: 0 })
    }

    /// Writes what is left, and gives the writer back.
    ///
    /// # Errors
    /// [`TableError::Parquet`] when it does not take the bytes.
    pub fn finish(mut self) -> Result<W, TableError> {
        self.write_group()?;
        Ok(self.file.into_inner()?)
    }

    /// Writes the rows that are held.
    fn write_group(&mut self) -> Result<(), TableError> {
        if self.held == 0 {
            return Ok(());
        }
        self.held = 0;
        let mut group = self.file.next_row_group()?;
        for column in &mut self.columns {
            let Some(mut writer) = group.next_column()? else { break };
            let levels = column.column.nullable.then_some(column.levels.as_slice());
            match &column.values {
                Values::Numbers(values) => writer.typed::<DoubleType>().write_batch(values, levels, None)?,
                Values::Counts(values) => writer.typed::<Int64Type>().write_batch(values, levels, None)?,
                Values::Texts(values) => writer.typed::<ByteArrayType>().write_batch(values, levels, None)?,
            };
            writer.close()?;
            column.clear();
        }
        group.close()?;
        Ok(())
    }
}

impl<W: Write + Send> RowWriter for ParquetWriter<W> {
    fn row(&mut self, values: &[Value<'_>]) -> Result<(), TableError> {
        self.rows += 1;
        if values.len() != self.columns.len() {
            return Err(TableError::WrongLength { row: self.rows, found: values.len(), expected: self.columns.len() });
        }
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.push(*value, self.rows)?;
        }
        self.held += 1;
        if self.held == GROUP {
            self.write_group()?;
        }
        Ok(())
    }
}

/// The values of a column that are held.
struct Group {
    column: Column,
    values: Values,
    /// For every row of a nullable column whether it has a value (1) or not (0).
    levels: Vec<i16>,
}

enum Values {
    Numbers(Vec<f64>),
    /// The bits of u64.
    Counts(Vec<i64>),
    Texts(Vec<ByteArray>),
}

impl Group {
    fn new(column: Column) -> Group {
        let values = match column.kind {
            Kind::Number => Values::Numbers(Vec::new()),
            Kind::Count => Values::Counts(Vec::new()),
            Kind::Text => Values::Texts(Vec::new()),
        };
        Group { column, values, levels: Vec::new() }
    }

    fn push(&mut self, value: Value<'_>, row: u64) -> Result<(), TableError> {
        let value = self.column.taken(value, row)?;
        if self.column.nullable {
            self.levels.push(i16::from(value != Value::Nothing));
        }
        match (&mut self.values, value) {
            (Values::Numbers(values), Value::Number(number)) => values.push(number),
            (Values::Counts(values), Value::Count(count)) => values.push(count.cast_signed()),
            (Values::Texts(values), Value::Text(text)) => {
                // Neighbours often share a text, and then its memory.
                let shared = values.last().filter(|last| last.data() == text.as_bytes()).cloned();
                values.push(shared.unwrap_or_else(|| ByteArray::from(text)));
            }
            // Nothing; `taken` has refused all else.
            _ => {}
        }
        Ok(())
    }

    fn clear(&mut self) {
        self.levels.clear();
        match &mut self.values {
            Values::Numbers(values) => values.clear(),
            Values::Counts(values) => values.clear(),
            Values::Texts(values) => values.clear(),
        }
    }
}

/// `column` as Parquet describes it.
fn field(column: &Column) -> Result<Type, ParquetError> {
    let (physical, logical) = match column.kind {
        Kind::Number => (PhysicalType::DOUBLE, None),
        Kind::Count => (PhysicalType::INT64, Some(LogicalType::integer(64, false))),
        Kind::Text => (PhysicalType::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let repetition = if column.nullable { Repetition::OPTIONAL } else { Repetition::REQUIRED };
    Type::primitive_type_builder(&column.name, physical).with_logical_type(logical).with_repetition(repetition).build()
}

fn properties(columns: &[Column], metadata: &Metadata) -> Result<WriterProperties, ParquetError> {
    let metadata = metadata.iter().map(|(name, text)| KeyValue::new(name.clone(), text.clone())).collect();
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(3)?))
        // Smallest and largest value of every group, by which readers may skip it; those of pages would be as long as short tables.
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_key_value_metadata(Some(metadata));
    for column in columns {
        // A path of one name, though keys of scenes have dots.
        let path = ColumnPath::new(vec![column.name.clone()]);
        properties = properties.set_column_dictionary_enabled(path.clone(), column.kind == Kind::Text);
        if column.kind == Kind::Number {
            properties = properties.set_column_encoding(path, Encoding::BYTE_STREAM_SPLIT);
        }
    }
    Ok(properties.build())
}
