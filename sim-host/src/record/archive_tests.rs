//! The 228 genuine records beside the repository, against the numbers of their index.
//!
//! The folder is not part of the repository; without it the test says so and passes.

use std::collections::BTreeMap;
use std::path::Path;

use super::{Component, Intensity, ReadOptions, Record, RecordError, Units};

const ARCHIVE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/records");
/// Half of the last digit that the index prints.
const PGA_G: f64 = 0.5e-4 + 1e-9;
const PGV_M_S: f64 = 0.003;

#[derive(serde::Deserialize)]
struct Row {
    file: String,
    dt_s: f64,
    npts: usize,
    #[serde(rename = "PGA_g")]
    pga_g: f64,
    #[serde(rename = "PGV_m_s")]
    pgv_m_s: f64,
    format: String,
}

/// Units of the formats that have no header.
fn headerless_units(format: &str) -> Option<Units> {
    match format {
        "g3" => Some(Units::StandardGravity),
        "6col" => Some(Units::CentimetrePerSecondSquared),
        _ => None,
    }
}

#[test]
fn every_record_of_the_archive_is_read_as_indexed() {
    let archive = Path::new(ARCHIVE);
    let Ok(index) = std::fs::read_to_string(archive.join("INDEX.tsv")) else {
        eprintln!("SKIPPED: the archive of records is not beside the repository, 228 files were not compared");
        return;
    };
    let rows: Vec<Row> = csv::ReaderBuilder::new()
        .delimiter(b'\t')
        .flexible(true)
        .from_reader(index.as_bytes())
        .deserialize()
        .collect::<Result<_, _>>()
        .unwrap();
    assert_eq!(rows.len(), 228);
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let (mut with_warnings, mut worst_pgv) = (0, 0.0_f64);
    for row in &rows {
        let units = headerless_units(&row.format);
        if units.is_some() {
            let refused = Record::read(archive.join(&row.file), &ReadOptions { units, ..ReadOptions::default() });
            assert!(matches!(refused, Err(RecordError::MissingTimeStep { .. })), "{} has no step of its own", row.file);
        }
        let options = ReadOptions { units, time_step_s: units.map(|_| row.dt_s), ..ReadOptions::default() };
        let record = Record::read(archive.join(&row.file), &options).unwrap_or_else(|error| panic!("{error}"));
        let intensity = Intensity::of(&record);
        let pga_g = intensity.pga_m_s2 / 9.80665;
        assert!((pga_g - row.pga_g).abs() <= PGA_G, "{}: PGA {pga_g} g, index {}", row.file, row.pga_g);
        assert_eq!(record.acceleration_m_s2.len(), row.npts, "{}", row.file);
        assert!((record.time_step_s - row.dt_s).abs() < 1e-12, "{}: step {}, index {}", row.file, record.time_step_s, row.dt_s);
        let mut pgv = intensity.pgv_m_s;
        if row.format == "json" {
            // The index has the larger velocity of the two components.
            for component in ["x", "y"] {
                let options = ReadOptions { component: Some(Component::from(component)), ..ReadOptions::default() };
                let one = Record::read(archive.join(format!("{}#{component}", row.file)), &ReadOptions::default()).unwrap();
                assert_eq!(one.acceleration_m_s2, Record::read(archive.join(&row.file), &options).unwrap().acceleration_m_s2);
                pgv = pgv.max(Intensity::of(&one).pgv_m_s);
            }
        }
        worst_pgv = worst_pgv.max((pgv - row.pgv_m_s).abs());
        assert!((pgv - row.pgv_m_s).abs() <= PGV_M_S, "{}: PGV {pgv} m/s, index {}", row.file, row.pgv_m_s);
        with_warnings += usize::from(!record.warnings.is_empty());
        for warning in &record.warnings {
            let kind = format!("{warning:?}").split([' ', '{']).next().unwrap_or_default().to_owned();
            if std::env::var_os("SPRAG_SHOW_WARNINGS").is_some() {
                eprintln!("{}: {warning}", row.file);
            }
            *counts.entry(kind).or_default() += 1;
        }
    }
    eprintln!("{} records, PGV within {worst_pgv:.5} m/s of the index, {with_warnings} with warnings: {counts:?}", rows.len());
    for alarm in ["Spike", "Step", "Clipped", "LargePeak", "SmallPeak", "SamplesDisagree", "PeakDisagrees"] {
        assert!(counts.get(alarm).copied().unwrap_or(0) <= rows.len() / 50, "{alarm}: {counts:?}");
    }
    assert!(with_warnings <= rows.len() / 3, "{with_warnings} of {} genuine records raise a warning", rows.len());
}
