//! The 228 genuine records, against the numbers of their index.

use std::collections::BTreeMap;

use sprag_sim::record::{Component, Intensity, ReadOptions, Record, RecordError, Units};
use sprag_tests::records::recorded_motions;

/// Half of the last digit that the index prints.
const PGA_G: f64 = 0.5e-4 + 1e-9;
const PGV_M_S: f64 = 0.003;

#[test]
#[ignore = "needs the recorded motions beside the repository: run by cargo xtask test"]
fn every_record_of_the_archive_is_read_as_indexed() {
    let motions = recorded_motions();
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let (mut with_warnings, mut worst_pgv) = (0, 0.0_f64);
    for motion in &motions {
        let units = motion.unsaid_units().and_then(Units::from_spelling);
        if units.is_some() {
            let refused = Record::read(&motion.path, &ReadOptions { units, ..ReadOptions::default() });
            assert!(matches!(refused, Err(RecordError::MissingTimeStep { .. })), "{} has no step of its own", motion.name);
        }
        let options = ReadOptions { units, time_step_s: units.map(|_| motion.time_step_s), ..ReadOptions::default() };
        let record = Record::read(&motion.path, &options).unwrap_or_else(|error| panic!("{error}"));
        let intensity = Intensity::of(&record);
        let pga_g = intensity.pga_m_s2 / 9.80665;
        assert!((pga_g - motion.pga_g).abs() <= PGA_G, "{}: PGA {pga_g} g, index {}", motion.name, motion.pga_g);
        assert_eq!(record.acceleration_m_s2.len(), motion.samples, "{}", motion.name);
        assert!(
            (record.time_step_s - motion.time_step_s).abs() < 1e-12,
            "{}: step {}, index {}",
            motion.name,
            record.time_step_s,
            motion.time_step_s
        );
        let mut pgv = intensity.pgv_m_s;
        if motion.format == "json" {
            // The index has the larger velocity of the two components.
            for component in ["x", "y"] {
                let options = ReadOptions { component: Some(Component::from(component)), ..ReadOptions::default() };
                let one = Record::read(format!("{}#{component}", motion.path.display()), &ReadOptions::default()).unwrap();
                assert_eq!(one.acceleration_m_s2, Record::read(&motion.path, &options).unwrap().acceleration_m_s2);
                pgv = pgv.max(Intensity::of(&one).pgv_m_s);
            }
        }
        worst_pgv = worst_pgv.max((pgv - motion.pgv_m_s).abs());
        assert!((pgv - motion.pgv_m_s).abs() <= PGV_M_S, "{}: PGV {pgv} m/s, index {}", motion.name, motion.pgv_m_s);
        with_warnings += usize::from(!record.warnings.is_empty());
        for warning in &record.warnings {
            let kind = format!("{warning:?}").split([' ', '{']).next().unwrap_or_default().to_owned();
            if std::env::var_os("SPRAG_SHOW_WARNINGS").is_some() {
                eprintln!("{}: {warning}", motion.name);
            }
            *counts.entry(kind).or_default() += 1;
        }
    }
    eprintln!("{} records, PGV within {worst_pgv:.5} m/s of the index, {with_warnings} with warnings: {counts:?}", motions.len());
    for alarm in ["Spike", "Step", "Clipped", "LargePeak", "SmallPeak", "SamplesDisagree", "PeakDisagrees"] {
        assert!(counts.get(alarm).copied().unwrap_or(0) <= motions.len() / 50, "{alarm}: {counts:?}");
    }
    assert!(with_warnings <= motions.len() / 3, "{with_warnings} of {} genuine records raise a warning", motions.len());
}
