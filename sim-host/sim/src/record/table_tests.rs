//! Texts as people write them, good and bad.

use crate::record::{Component, Format, ReadOptions, Record, RecordError, Units, Warning};

fn read(text: &str, options: &ReadOptions) -> Result<Record, RecordError> {
    Record::parse("t.txt", text.as_bytes(), options)
}

fn plain(text: &str) -> Result<Record, RecordError> {
    read(text, &ReadOptions::default())
}

fn message(text: &str) -> String {
    plain(text).unwrap_err().to_string()
}

#[test]
fn tables_with_a_header_need_no_options() {
    for text in [
        "# time_s,acc_g\n0.00,0.1\n0.01,-0.2\n0.02,0.05\n",
        "time_s,acc_g\n0.00,0.1\n0.01,-0.2\n0.02,0.05\n",
        "\"Time (s)\",\"Acceleration (g)\"\r\n0.00,0.1\r\n0.01,-0.2\r\n0.02,0.05\r\n",
        "% a station, units: g\n  0.00  0.1\n  0.01 -0.2\n  0.02 0.05\n",
        "Time (ms);Acc (g)\n0;0.1\n10;-0.2\n20;0.05\n",
        "Time (ms)  Acceleration (g)\n0 0.1\n10 -0.2\n20 0.05\n",
        "# time (ms)   acc (g)\n0 0.1\n10 -0.2\n20 0.05\n",
        "time_ms,acc_g,\n0,0.1,\n10,-0.2,\n20,0.05,\n",
        "% NPTS = 3, DT = 0.01\n% Time (s), Acceleration (g)\n0.00 0.1\n0.01 -0.2\n0.02 0.05\n",
        "time acc_g\n1.00\t0.1\n1.01\t-0.2\n# a comment between\n1.02\t0.05\n\n",
    ] {
        let record = plain(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!((record.format, record.time_step_s, record.units), (Format::Table, 0.01, Units::StandardGravity), "{text}");
        for (found, expected) in record.acceleration_m_s2.iter().zip([0.980665, -1.96133, 0.4903325]) {
            assert!((found - expected).abs() < 1e-12);
        }
    }
}

#[test]
fn values_alone_need_a_step_and_units() {
    let step = ReadOptions { time_step_s: Some(0.02), ..ReadOptions::default() };
    let both = ReadOptions { units: Some(Units::CentimetrePerSecondSquared), ..step.clone() };
    let text = " 100.0  -200.0 50.\n  25. 0 -1\n 7\n";
    let record = read(text, &both).unwrap();
    assert_eq!((record.format, record.acceleration_m_s2.len()), (Format::Values, 7));
    assert!((record.acceleration_m_s2[1] + 2.0).abs() < 1e-12);
    assert_eq!(
        read(text, &step).unwrap_err().to_string(),
        "t.txt: no units in the file, or several: say them with --units (g, m/s2, cm/s2 (gal), mm/s2, in/s2, ft/s2)"
    );
    assert_eq!(
        read("1\n2\n3\n", &ReadOptions { units: Some(Units::StandardGravity), ..ReadOptions::default() })
            .unwrap_err()
            .to_string(),
        "t.txt: no time step in the file: say it in seconds with --dt, for example --dt 0.005"
    );
    let commented = plain("# dt = 0.02 s, units: cm/s2\n1\n2\n3\n").unwrap();
    assert_eq!((commented.time_step_s, commented.units), (0.02, Units::CentimetrePerSecondSquared));
}

#[test]
fn no_sample_is_lost_where_line_ends_are_mixed() {
    let text = "# acc_g, DT=0.005\n0.0\n0.1\n-0.2\n# a remark\n0.3\n0.1\n";
    let expected = plain(text).unwrap();
    for lines in 1..7 {
        for end in ["\r", "\r\n", "\r\r\n"] {
            let mixed = text.replacen('\n', end, lines);
            assert_eq!(plain(&mixed).unwrap().acceleration_m_s2, expected.acceleration_m_s2, "{mixed:?}");
        }
    }
}

#[test]
fn a_table_with_npts_in_its_header_stays_a_table() {
    let (times, values) = ([0.0, 0.01, 0.02, 0.03], [0.0, 0.1, -0.2, 0.05]);
    let rows: String = times.iter().zip(values).map(|(time, value)| format!("{time} {value}\n")).collect();
    let comma = rows.replace(' ', ",");
    for text in [
        format!("Station X\nNPTS = 4, DT = 0.01\nTime (s),Acceleration (g)\n{comma}"),
        format!("Station X\nNPTS: 9  DT: 0.01\nUnits: g\nTime Acc\n{rows}"),
        format!("PEER\nEvent, 1/1/1999, ST, 90\nACCELERATION IN UNITS OF G\nNPTS= 4, DT= .01 SEC\n{rows}"),
    ] {
        let record = plain(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!((record.format, record.time_step_s, record.units), (Format::Table, 0.01, Units::StandardGravity), "{text}");
        assert_eq!(record.acceleration_m_s2, values.map(|value| value * 9.80665), "{text}");
    }
    // Components without times.
    for header in
        ["NPTS = 3, DT = 0.005, units g\nacc_ns,acc_ew\n", "NPTS = 3, DT = 0.005, units g\n", "# NPTS = 3, DT = 0.005, units g\n"]
    {
        let text = format!("{header}0.1,0.4\n0.3,0.5\n0.2,-0.6\n");
        assert!(matches!(plain(&text), Err(RecordError::Component { .. })), "{header}");
        let record = read(&text, &ReadOptions { component: Some("2".into()), ..ReadOptions::default() }).unwrap();
        assert_eq!(
            (record.time_step_s, record.acceleration_m_s2),
            (0.005, [0.4, 0.5, -0.6].map(|value| value * 9.80665).to_vec())
        );
    }
    // Five samples a row behind five words, and a last line that is short.
    for unit in ["ACCELERATION IN UNITS OF G\n", "units of g\n"] {
        let record = plain(&format!("PEER\nE\nNPTS= 7, DT= .01 SEC\n{unit}.1 .2 .3 .4 .5\n.6 .7\n")).unwrap();
        assert_eq!((record.format, record.acceleration_m_s2.len()), (Format::PeerAt2, 7), "{unit}");
    }
}

#[test]
fn a_remark_does_not_overrule_the_units_and_two_remarks_state_none() {
    let units = |header: &str| plain(&format!("# DT = 0.02\n{header}1\n2\n3\n")).map(|record| record.units);
    let (said, remark) = ("# units: cm/s2\n", "# PGA 0.300 (g)\n");
    for header in [format!("{said}{remark}"), format!("{remark}{said}"), format!("{said}{said}")] {
        assert_eq!(units(&header).unwrap(), Units::CentimetrePerSecondSquared, "{header}");
    }
    assert_eq!(units(remark).unwrap(), Units::StandardGravity);
    for header in ["# PGA 294.2 (cm/s^2)\n# PGA 0.300 (g)\n", "# units: g\n# units: cm/s2\n"] {
        assert!(matches!(units(header), Err(RecordError::MissingUnits { .. })), "{header}");
    }
}

#[test]
fn samples_with_a_scale_factor_are_refused() {
    let text = "Sampling Freq(Hz)   100Hz\nScale Factor   3920(gal)/6182761\nMax. Acc. (gal)   94.7\n 10 20 30\n";
    assert!(
        message(text).starts_with("t.txt: line 2: `Scale Factor   3920(gal)/6182761`: samples are not multiplied"),
        "{}",
        message(text)
    );
}

#[test]
fn a_first_row_of_counts_is_no_sample() {
    let values: String = (0..12).map(|i| format!("0.0{i}\n")).collect();
    let g = ReadOptions { units: Some(Units::StandardGravity), ..ReadOptions::default() };
    let record = read(&format!("12 0.005\n{values}"), &g).unwrap();
    assert_eq!((record.acceleration_m_s2.len(), record.time_step_s, record.header.samples), (12, 0.005, Some(12)));
}

#[test]
fn components_of_a_table_are_chosen_by_name_or_number() {
    let text: String = (0..10).map(|i| format!("0.{i} {} {}\n", i % 3, i % 2)).collect();
    let options = |component: &str| ReadOptions {
        units: Some(Units::MetrePerSecondSquared),
        component: Some(Component::from(component)),
        ..ReadOptions::default()
    };
    assert_eq!(read(&text, &options("2")).unwrap().acceleration_m_s2[..3], [0.0, 1.0, 0.0]);
    assert!(matches!(plain(&text), Err(RecordError::Component { .. })));
    let named = format!("t ns_m_s2 ew_m_s2\n{text}");
    assert_eq!(read(&named, &options("ns")).unwrap().acceleration_m_s2[..3], [0.0, 1.0, 2.0]);
    let quantities = "time_s,acc_g,vel_m_s\n0,0.1,5\n1,0.2,6\n";
    assert_eq!(plain(quantities).unwrap().component.as_deref(), Some("acc_g"));
}

#[test]
fn a_word_of_several_names_chooses_none() {
    let text = "time_s,acc_x_g,acc_y_g\n0,0,1\n0.01,0.2,2\n0.02,0.1,3\n";
    for (component, found) in [("acc", None), ("g", None), ("y", Some("acc_y_g")), ("ACC_X_G", Some("acc_x_g"))] {
        let read = read(text, &ReadOptions { component: Some(component.into()), ..ReadOptions::default() });
        assert_eq!(read.ok().and_then(|record| record.component).as_deref(), found, "{component}");
    }
}

/// Times as `%g` and spreadsheets write them, without trailing zeros.
#[test]
fn a_time_column_without_trailing_zeros_gives_the_true_step() {
    for (step, rows) in
        [(0.005, 101), (0.006, 100), (0.015, 200), (0.0125, 400), (0.00125, 3000), (0.007_812_5, 2000), (0.0025, 1000)]
    {
        let rows: String = (0..rows).map(|row| format!("{},0.{}\n", f64::from(row) * step, row % 7)).collect();
        let record = plain(&format!("time_s,acc_g\n{rows}")).unwrap();
        assert!((record.time_step_s / step - 1.0).abs() < 1e-9, "{step}: {}", record.time_step_s);
    }
}

#[test]
fn a_column_that_counts_the_rows_is_no_time_column() {
    let values = [0.0, 0.1, -0.2, 0.05, 0.0, 0.3, 0.1, 0.0, 0.1];
    let g = ReadOptions { units: Some(Units::StandardGravity), time_step_s: Some(0.005), ..ReadOptions::default() };
    let rows = |first: usize, row: &dyn Fn(usize, f64) -> String| -> String {
        values.iter().enumerate().map(|(at, value)| format!("{}\n", row(first + at, *value))).collect()
    };
    let alone = read(&rows(0, &|_, value| value.to_string()), &g).unwrap().acceleration_m_s2;
    let comma = |number: usize, value: f64| format!("{number},{value}");
    for (header, first) in [(",acc_g\n", 0), ("\"\",\"acc_g\"\n", 1), ("Sample,acc_g\n", 0), ("# units: g\n", 1), ("", 0)] {
        let record = read(&format!("{header}{}", rows(first, &comma)), &g).unwrap();
        assert_eq!((record.time_step_s, &record.acceleration_m_s2), (0.005, &alone), "{header}");
        assert!(record.warnings.contains(&Warning::RowNumbers), "{header}: {:?}", record.warnings);
    }
    let said = plain(&format!("# dt = 0.02\nn,acc_g\n{}", rows(0, &comma))).unwrap();
    assert_eq!((said.time_step_s, &said.acceleration_m_s2), (0.02, &alone));
    assert!(matches!(plain(&format!(",acc_g\n{}", rows(0, &comma))), Err(RecordError::MissingTimeStep { .. })));
    // Times may stand behind it.
    let timed = |number: usize, value: f64| format!("{number} {} {value}", number as f64 * 0.01);
    for header in ["", "No,Zeit (s),acc_g\n", "# No,time_s,acc_g\n"] {
        let record = read(&format!("{header}{}", rows(0, &timed)), &ReadOptions { time_step_s: None, ..g.clone() }).unwrap();
        assert_eq!((record.time_step_s, &record.acceleration_m_s2, record.component), (0.01, &alone, None), "{header}");
    }
    // What is called time is time, in its unit.
    for (header, step) in [("time_s,acc_g\n", 1.0), ("Zeit (ms),acc_g\n", 1e-3), ("t,acc_g\n", 1.0)] {
        let record = plain(&format!("{header}{}", rows(0, &comma))).unwrap();
        assert_eq!((record.time_step_s, record.warnings.contains(&Warning::RowNumbers)), (step, false), "{header}");
    }
}

#[test]
fn times_in_other_units_are_refused_by_name() {
    for unit in ["h", "min", "minutes", "days", "cs", "ns", "samples"] {
        for header in [format!("time ({unit}),acc_g\n"), format!("t_{unit},acc_g\n")] {
            let error = plain(&format!("{header}0,0.1\n0.01,0.2\n0.02,0.1\n")).unwrap_err();
            assert_eq!(error.to_string(), format!("t.txt: line 1: times in {unit} are not read; allowed are s and ms"));
        }
    }
}

#[test]
fn a_step_that_is_given_replaces_one_that_is_stated_only_where_it_is_near() {
    let of = |given: f64| {
        let text = "# dt = .01, units: g\n1\n2\n3\n";
        read(text, &ReadOptions { time_step_s: Some(given), ..ReadOptions::default() }).unwrap()
    };
    assert_eq!(of(0.009_77).time_step_s, 0.009_77);
    for given in [0.005, 0.0149] {
        let record = of(given);
        assert_eq!(record.time_step_s, 0.01, "{given}");
        assert!(record.warnings.contains(&Warning::TimeStepNotUsed { given_s: given, stated_s: Some(0.01) }), "{given}");
    }
}

#[test]
fn columns_of_other_quantities_are_refused() {
    for text in ["vel_m_s,disp_m\n0,0\n0.01,0.2\n0.02,0.1\n", "vel_m_s\n0\n0.2\n0.1\n", "velocity (m/s)\n0\n0.2\n0.1\n"] {
        let options = ReadOptions {
            units: Some(Units::MetrePerSecondSquared),
            time_step_s: Some(0.01),
            component: Some("1".into()),
            ..ReadOptions::default()
        };
        let error = read(text, &options).unwrap_err();
        assert!(matches!(error, RecordError::NotAcceleration { line: 1, .. }), "{text}: {error}");
    }
    let text = "time_s,acc_g,disp_m,vel_m_s,x_disp\n0,0.1,5,1,1\n1,0.2,6,1,1\n";
    for component in ["disp_m", "vel_m_s", "x_disp", "3"] {
        let options =
            ReadOptions { units: Some(Units::StandardGravity), component: Some(component.into()), ..ReadOptions::default() };
        let error = read(text, &options).unwrap_err();
        assert!(matches!(error, RecordError::NotAcceleration { line: 1, .. }), "{component}: {error}");
    }
    let options = ReadOptions { units: Some(Units::StandardGravity), ..ReadOptions::default() };
    let error = read("t,disp_m\n0,0.1\n1,0.2\n", &options).unwrap_err();
    assert_eq!(
        error.to_string(),
        "t.txt: line 1: the header says displacement in column disp_m; only acceleration histories are read"
    );
}

#[test]
fn spectra_are_refused_by_the_names_of_their_columns() {
    let g = ReadOptions { units: Some(Units::StandardGravity), time_step_s: Some(0.01), ..ReadOptions::default() };
    let rows = "0.00,0.4\n0.02,0.5\n0.04,0.6\n";
    for names in [
        "Period (s),Sa (g)",
        "Period (s),Acceleration (g)",
        "Period\tAcceleration",
        "T (s),PSa 5% (g)",
        "T (s),Spectral acceleration (g)",
        "Frequency (Hz),Amplitude (g)",
        "freq_hz,acc_g",
        "t,Fourier (Hz)",
        "# natural period,acc",
    ] {
        let error = read(&format!("{names}\n{rows}"), &g).unwrap_err();
        assert!(matches!(error, RecordError::NotAcceleration { line: 1, .. }), "{names}: {error}");
        assert!(error.to_string().contains("the header says a spectrum in column "), "{error}");
    }
    for names in [
        "time_s,acc_hz",
        "time_s,acc_sa_g",
        "time_s,acc (g) low frequency removed",
        "Time history,sampling frequency 200 Hz",
        "Time,usage",
        "# Sampling frequency: 50 Hz, corrected",
        "# Frequency, 50 Hz",
    ] {
        let record = read(&format!("{names}\n{rows}"), &g).unwrap_or_else(|error| panic!("{names}: {error}"));
        assert_eq!((record.acceleration_m_s2.len(), record.time_step_s), (3, 0.02), "{names}");
    }
}

#[test]
fn the_unit_of_a_column_is_the_end_of_its_name() {
    let text = "time_s,acc_x_g,acc_y_mm_s2,acc_z_mg\n0,0.1,100,1\n1,0.2,-200,2\n";
    let of = |component: &str| read(text, &ReadOptions { component: Some(component.into()), ..ReadOptions::default() });
    assert_eq!(of("acc_x_g").unwrap().units, Units::StandardGravity);
    assert_eq!(of("y").unwrap().acceleration_m_s2, [0.1, -0.2]);
    assert_eq!(
        of("z").unwrap_err().to_string(),
        "t.txt: line 1: unit mg is not known (g, m/s2, cm/s2 (gal), mm/s2, in/s2, ft/s2)"
    );
    // An option does not overrule what the file says.
    let options = ReadOptions { units: Some(Units::StandardGravity), ..ReadOptions::default() };
    assert!(matches!(read("time_s,acc_%g\n0,0.1\n1,0.2\n", &options), Err(RecordError::UnknownUnits { line: 1, .. })));
}

#[test]
fn unequal_steps_are_an_error_and_resampled_only_on_request() {
    let text = "# time_s,acc_g\n0.00,0.0\n0.01,0.1\n0.02,0.2\n0.04,0.4\n0.05,0.5\n";
    assert_eq!(
        message(text),
        "t.txt: line 5: time advances by 0.02 s where the mean step is 0.0125 s; equal steps are needed, or ask for linear resampling with --resample"
    );
    let record = read(text, &ReadOptions { resample_to_s: Some(0.01), ..ReadOptions::default() }).unwrap();
    assert_eq!(record.acceleration_m_s2.len(), 6);
    assert!((record.acceleration_m_s2[3] - 0.3 * 9.80665).abs() < 1e-12);
    assert!(record.warnings.iter().any(|warning| matches!(warning, Warning::Resampled { .. })));
    let backwards = "# time_s,acc_g\n".to_owned()
        + &(0..30).map(|i| format!("0.{:02},0.1\n", if i == 20 { 5 } else { i })).collect::<String>();
    assert!(matches!(plain(&backwards), Err(RecordError::UnequalSteps { line: 22, .. })), "{}", message(&backwards));
    let options = ReadOptions { resample_to_s: Some(0.01), ..ReadOptions::default() };
    assert!(matches!(read(&backwards, &options), Err(RecordError::TimeNotIncreasing { line: 22, .. })));
}

#[test]
fn warnings_of_unequal_steps_are_of_the_file_and_not_of_what_was_made_of_it() {
    let rows = "# time_s,acc_g\n0.00,0.0\n0.01,0.1\n0.02,0.2\n0.04,0.4\n0.05,0.5\n";
    let options = ReadOptions { resample_to_s: Some(0.005), time_step_s: Some(0.02), ..ReadOptions::default() };
    let of = |header: &str| read(&format!("{header}{rows}"), &options).unwrap();
    let disagrees = |record: &Record| record.warnings.iter().any(|warning| matches!(warning, Warning::SamplesDisagree { .. }));
    let right = of("# NPTS = 5\n");
    assert_eq!((right.acceleration_m_s2.len(), disagrees(&right)), (11, false), "{:?}", right.warnings);
    assert!(of("# NPTS = 11\n").warnings.contains(&Warning::SamplesDisagree { stated: 11, present: 5 }));
    let not_used = right.warnings.iter().map(ToString::to_string).find(|warning| warning.starts_with("time step"));
    assert_eq!(not_used.as_deref(), Some("time step 0.02 s not used: the file has a time column"));
}

#[test]
fn damage_is_named_with_its_line() {
    assert_eq!(message("# time_s,acc_g\n0,0\n0.01,abc\n"), "t.txt: line 3: `abc` where a number is due");
    assert_eq!(
        message("# time_s,acc_g\n0,0\n0.01,inf\n"),
        "t.txt: line 3: `inf` is not finite; every sample must be a finite number"
    );
    assert_eq!(message("# time_s,acc_g\n0,0\n0.01,\n"), "t.txt: line 3: 1 column(s) where 2 are due");
    assert_eq!(message("# time_s,acc_g\n0,,0\n"), "t.txt: 0 sample(s); a record needs at least 2");
    assert_eq!(message(""), "t.txt: 0 sample(s); a record needs at least 2");
    assert_eq!(message("# time_s,acc_g\n0,0.1\n"), "t.txt: 1 sample(s); a record needs at least 2");
    assert_eq!(
        message("# units: furlong\n1\n2\n"),
        "t.txt: line 1: unit furlong is not known (g, m/s2, cm/s2 (gal), mm/s2, in/s2, ft/s2)"
    );
    assert!(message("# time_s,acc_g\n0,1\n0.01,1e7\n").contains("sample 2 is 9.80665e7 m/s2"));
}

#[test]
fn any_bytes_give_a_record_or_an_error() {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let seeds: [&[u8]; 6] = [
        b"PEER\nE\nACCELERATION IN UNITS OF G\nNPTS= 4, DT= .01 SEC\n.1 .2\n-.3-.5E-1\n",
        b"# time_s,acc_g\n0.00,0.1\n0.01,-0.2\n0.02,0.05\n",
        b"{\"dT\": 0.01, \"data_x\": [0.0, 0.2], \"data_y\": [0, 1e3]}",
        b"12 0.01\n1\n2\n3\n4\n5\n6\n7\n8\n9\n10\n11\n12\n",
        b"2 CORRECTED ACCELEROGRAM\n*\n*\n*\n*\n*\n*\n*\n*\n*\n*\n    -32768      1989\n",
        b"t x y\n0 1 2\n1 2 3\n2 3 4\n3 4 5\n4 5 6\n5 6 7\n6 7 8\n7 8 9\n",
    ];
    let alphabet = b"0123456789.+-eEdD,; \t\n\r#/NPTSDT=gG{}[]\":\xff\x00\xc3";
    let names = ["a.AT2", "a.json", "a.smc", "a.csv", ""];
    for round in 0..20_000 {
        let mut bytes = seeds[round % seeds.len()].to_vec();
        for _ in 0..1 + random.next_u32() % 6 {
            let at = random.next_u32() as usize % bytes.len().max(1);
            let letter = alphabet[random.next_u32() as usize % alphabet.len()];
            match random.next_u32() % 4 {
                0 if !bytes.is_empty() => drop(bytes.remove(at)),
                1 => bytes.insert(at.min(bytes.len()), letter),
                2 => bytes.truncate(at.max(1)),
                _ => {
                    if let Some(byte) = bytes.get_mut(at) {
                        *byte = letter;
                    }
                }
            }
        }
        let options = ReadOptions {
            units: (round % 2 == 0).then_some(Units::StandardGravity),
            time_step_s: (round % 3 == 0).then_some(0.01),
            component: (round % 5 == 0).then(|| Component::from("1")),
            resample_to_s: (round % 7 == 0).then_some(0.005),
        };
        if let Ok(record) = Record::parse(names[round % names.len()], &bytes, &options) {
            assert!(record.acceleration_m_s2.len() >= 2 && record.acceleration_m_s2.iter().all(|a| a.is_finite()));
            let intensity = crate::record::Intensity::of(&record);
            assert!(intensity.pgv_m_s.is_finite() && intensity.arias_m_s.is_finite() && intensity.d5_95_s >= 0.0);
        }
    }
}
