//! Tables in both formats against each other, to the bits.

use parquet::basic::Compression;
use parquet::data_type::DoubleType;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::Field;
use parquet::schema::parser::parse_message_type;

use super::parquet_writer::GROUP;
use super::*;

/// Rows of all kinds.
struct Samples(usize);

impl Table for Samples {
    fn columns(&self) -> Vec<Column> {
        vec![
            Column::text("device"),
            Column::number("ground.0.frequency_ratio"),
            Column::count("impacts").or_nothing(),
            Column::number("peak, rotation").or_nothing(),
            Column::count("of"),
            Column::text("reason").or_nothing(),
        ]
    }

    fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        const HARD: [f64; 9] = [0.0, -0.0, 0.1, 5e-324, f64::MAX, f64::MIN_POSITIVE, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
        let mut state = 1_u64;
        for row in 0..self.0 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let hard = HARD.get(row).copied().unwrap_or_else(|| f64::from_bits(state));
            let device = ["none", "one, \"inerter\"", "pair (σ = 0.5)\nof two", ""][row % 4];
            let reason = (row % 7 == 3).then(|| format!("no convergence at {state}"));
            writer.row(&[
                device.into(),
                hard.into(),
                (row % 3 > 0).then_some(state).into(),
                (row % 5 > 0).then_some(-hard).into(),
                Value::Count(if row == 0 { u64::MAX } else { row as u64 }),
                reason.as_ref().into(),
            ])?;
        }
        Ok(())
    }
}

fn metadata() -> Vec<(String, String)> {
    [("command", "sprag map scene.toml"), ("scene", "{\"title\": \"α\"}")]
        .map(|(name, text)| (name.to_owned(), text.to_owned()))
        .to_vec()
}

fn csv(table: &dyn Table) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_csv(table, &mut bytes).unwrap();
    bytes
}

fn parquet(table: &dyn Table) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_parquet(table, &metadata(), &mut bytes).unwrap();
    bytes
}

/// Fields as CSV has them, and rows of the groups.
fn read(parquet: Vec<u8>) -> (Vec<Vec<String>>, Vec<i64>) {
    let reader = SerializedFileReader::new(bytes::Bytes::from(parquet)).unwrap();
    let text = |field: &Field| match field {
        Field::Null => String::new(),
        Field::Double(number) => format!("{number:?}"),
        Field::ULong(count) => count.to_string(),
        Field::Str(text) => text.clone(),
        other => panic!("{other:?}"),
    };
    let rows = reader.get_row_iter(None).unwrap();
    let rows = rows.map(|row| row.unwrap().get_column_iter().map(|(_, field)| text(field)).collect()).collect();
    let groups = reader.metadata().row_groups().iter().map(|group| group.num_rows()).collect();
    (rows, groups)
}

fn fields(csv: &[u8]) -> Vec<Vec<String>> {
    let rows = csv::Reader::from_reader(csv).into_records();
    rows.map(|row| row.unwrap().iter().map(str::to_owned).collect()).collect()
}

#[test]
fn both_formats_hold_the_same_bits() {
    for rows in [0, 1, 9, GROUP - 1, GROUP, 2 * GROUP + 77] {
        let csv = csv(&Samples(rows));
        let (found, groups) = read(parquet(&Samples(rows)));
        // Equal texts of numbers are equal bits, since CSV has the shortest text of each.
        assert!(found == fields(&csv), "{rows}");
        assert_eq!(found.len(), rows);
        assert_eq!(groups.len(), rows.div_ceil(GROUP));
        assert!(groups.iter().all(|rows| *rows <= GROUP as i64));
    }
}

#[test]
fn a_finished_csv_file_gives_the_same_bytes() {
    for rows in [0, 1, 1000, GROUP + 5] {
        let table = Samples(rows);
        let mut from_csv = Vec::new();
        let read = parquet_of_csv(csv(&table).as_slice(), &table.columns(), &metadata(), &mut from_csv).unwrap();
        assert_eq!(read, rows as u64);
        assert!(from_csv == parquet(&table), "{rows}");
        assert!(parquet(&table) == parquet(&table));
    }
}

#[test]
fn a_file_reads_back_to_the_same_csv() {
    let path = tempfile::NamedTempFile::new().unwrap();
    let open = || std::fs::File::open(path.path()).unwrap();
    for rows in [0, 1, 1000, GROUP + 5] {
        let table = Samples(rows);
        std::fs::write(path.path(), parquet(&table)).unwrap();
        let mut writer = CsvWriter::new(table.columns(), Vec::new()).unwrap();
        assert_eq!(read_parquet(open(), &table.columns(), &mut writer).unwrap(), rows as u64);
        assert!(writer.finish().unwrap() == csv(&table), "{rows}");
    }
    assert_eq!(parquet_text(open(), "command").unwrap().as_deref(), Some("sprag map scene.toml"));
    assert_eq!(parquet_text(open(), "absent").unwrap(), None);
    // Other columns, and what is no table, are refused.
    let mut writer = CsvWriter::new(Vec::new(), Vec::new()).unwrap();
    assert!(matches!(read_parquet(open(), &Samples(1).columns()[1..], &mut writer), Err(TableError::Titles { .. })));
    std::fs::write(path.path(), "no table").unwrap();
    assert!(matches!(read_parquet(open(), &Samples(1).columns(), &mut writer), Err(TableError::Parquet(_))));
    assert!(parquet_text(open(), "command").is_err());
}

#[test]
fn a_file_says_what_made_it() {
    let reader = SerializedFileReader::new(bytes::Bytes::from(parquet(&Samples(3)))).unwrap();
    let file = reader.metadata().file_metadata();
    let found = file.key_value_metadata().unwrap().iter();
    let found: Vec<(String, String)> = found.map(|pair| (pair.key.clone(), pair.value.clone().unwrap())).collect();
    assert_eq!(found, metadata());
    assert!(file.created_by().unwrap().starts_with("parquet-rs version"));
}

#[test]
fn numbers_in_csv_are_the_shortest_that_read_back() {
    let text = String::from_utf8(csv(&Samples(4))).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("device,ground.0.frequency_ratio,impacts,\"peak, rotation\",of,reason"));
    assert_eq!(lines.next(), Some("none,0.0,,,18446744073709551615,"));
    assert!(
        lines.next().is_some_and(|line| line.starts_with("\"one, \"\"inerter\"\"\",-0.0,") && line.ends_with(",0.0,1,")),
        "{text}"
    );
}

#[test]
fn a_csv_file_continues_where_it_ended() {
    let columns = || vec![Column::text("device"), Column::number("peak")];
    let mut writer = CsvWriter::new(columns(), Vec::new()).unwrap();
    writer.row(&["none".into(), 0.5.into()]).unwrap();
    writer.flush().unwrap();
    let mut writer = CsvWriter::resumed(columns(), writer.finish().unwrap());
    writer.row(&["pair".into(), 0.25.into()]).unwrap();
    assert_eq!(writer.finish().unwrap(), b"device,peak\nnone,0.5\npair,0.25\n");
}

#[test]
fn rows_of_other_columns_are_refused() {
    let columns = || vec![Column::text("device"), Column::number("peak").or_nothing()];
    let refused = |values: &[Value<'_>]| {
        let mut parquet = ParquetWriter::new(columns(), &[], Vec::new()).unwrap();
        let one = CsvWriter::new(columns(), Vec::new()).unwrap().row(values).unwrap_err().to_string();
        assert_eq!(one, parquet.row(values).unwrap_err().to_string());
        one
    };
    assert_eq!(refused(&["none".into()]), "row 1 has 1 values instead of 2");
    assert_eq!(refused(&["none".into(), 7_usize.into()]), "row 1, column `peak`: Count(7) is not a number");
    assert_eq!(refused(&[Value::Nothing, 1.0.into()]), "row 1, column `device`: there is no value");
}

#[test]
fn bad_files_are_refused_with_their_line() {
    let columns = [Column::text("device"), Column::number("peak").or_nothing(), Column::count("impacts")];
    let refused = |csv: &str| parquet_of_csv(csv.as_bytes(), &columns, &[], Vec::new()).unwrap_err().to_string();
    assert_eq!(
        refused("device,peak\n"),
        "line 1: the columns are [\"device\", \"peak\"] instead of [\"device\", \"peak\", \"impacts\"]"
    );
    assert_eq!(refused("device,peak,impacts\n\"two\nlines\",,1\nnone,1.5x,3\n"), "line 4, column `peak`: `1.5x` is not a number");
    assert_eq!(refused("device,peak,impacts\nnone,,\n"), "line 2, column `impacts`: `` is not a whole number from 0 to 2^64 - 1");
    // Cut off in the middle of a row.
    let cut = refused("device,peak,impacts\nnone,,1\nnone,0.");
    assert!(cut.contains("line: 3"), "{cut}");
}

#[test]
fn either_format_reads_as_the_same_texts() {
    let path = tempfile::NamedTempFile::new().unwrap();
    let table = Samples(1000);
    std::fs::write(path.path(), parquet(&table)).unwrap();
    let csv = csv(&table);
    let expected = fields(&csv);
    let of_parquet = TextRows::of_parquet(std::fs::File::open(path.path()).unwrap()).unwrap();
    for (mut rows, end) in [(TextRows::of_csv(std::io::Cursor::new(csv.clone())), csv.len() as u64), (of_parquet, 1000)] {
        assert!(rows.titles().unwrap().iter().eq(table.columns().iter().map(|column| column.name.as_str())));
        let mut row = csv::StringRecord::new();
        for expected in &expected {
            assert!(rows.read(&mut row).unwrap() && row.iter().eq(expected), "{row:?}");
        }
        assert!(!rows.read(&mut row).unwrap());
        assert_eq!(rows.done(), end);
    }
}

#[test]
fn a_row_without_an_end_is_refused() {
    let endless = std::io::Read::chain(&b"device\none\n\""[..], std::io::repeat(b'\n'));
    let mut rows = TextRows::of_csv(endless);
    let mut row = csv::StringRecord::new();
    assert!(rows.read(&mut row).unwrap());
    assert!(matches!(rows.read(&mut row), Err(TableError::LongRow { line: 3 })));
    assert!(matches!(TextRows::of_csv(std::io::repeat(0)).titles(), Err(TableError::LongRow { line: 1 })));
}

#[test]
fn a_compression_that_is_not_known_is_named() {
    let bytes = parquet(&Samples(3));
    // The name of a column and then its codec in Thrift: zstd is 6, LZO 3, each doubled.
    let named = b"device\x15\x0c";
    let place = bytes.windows(named.len()).position(|bytes| bytes == named).unwrap() + named.len() - 1;
    let mut lzo = bytes;
    lzo[place] = 6;
    let path = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(path.path(), lzo).unwrap();
    let refused = TextRows::of_parquet(std::fs::File::open(path.path()).unwrap()).err().unwrap().to_string();
    assert_eq!(refused, "it is compressed by LZO; zstd, snappy and no compression can be read");
}

/// As pandas writes it unless it is asked for another compression.
#[test]
fn snappy_is_read() {
    let schema = parse_message_type("message table { required double rotation; }").unwrap();
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let path = tempfile::NamedTempFile::new().unwrap();
    let mut file = SerializedFileWriter::new(path.reopen().unwrap(), schema.into(), properties.into()).unwrap();
    let mut group = file.next_row_group().unwrap();
    let mut column = group.next_column().unwrap().unwrap();
    column.typed::<DoubleType>().write_batch(&[0.1, 2.5], None, None).unwrap();
    column.close().unwrap();
    group.close().unwrap();
    file.close().unwrap();
    let mut rows = TextRows::of_parquet(path.reopen().unwrap()).unwrap();
    let mut row = csv::StringRecord::new();
    for number in ["0.1", "2.5"] {
        assert!(rows.read(&mut row).unwrap());
        assert_eq!(&row[0], number);
    }
    assert!(!rows.read(&mut row).unwrap());
}
