//! Each check finds what it is for, in an otherwise clean motion, and nothing else.

use sprag_shared::math;

use crate::record::{ReadOptions, Record, Units, Warning};

/// A modulated motion of 2 m/s², 20 s at 100 Hz, that starts and ends at rest.
fn clean() -> Vec<f64> {
    let envelope = |t: f64| math::sin(std::f64::consts::PI * t / 20.0) * math::sin(std::f64::consts::PI * t / 20.0);
    let velocity = |t: f64| envelope(t) * (0.3 * math::sin(6.0 * t) + 0.05 * math::sin(23.0 * t + 1.0));
    (0..=2000).map(|i| f64::from(i) * 0.01).map(|t| (velocity(t + 0.005) - velocity(t - 0.005)) / 0.01).collect()
}

fn warnings_of(values: &[f64], units: Units, header: &str) -> Vec<Warning> {
    let text = header.to_owned() + &values.iter().map(|value| format!("{value:.6e}\n")).collect::<String>();
    let options = ReadOptions { units: Some(units), time_step_s: Some(0.01), ..ReadOptions::default() };
    Record::parse("m.txt", text.as_bytes(), &options).unwrap().warnings
}

fn warnings(values: &[f64]) -> Vec<Warning> {
    warnings_of(values, Units::MetrePerSecondSquared, "")
}

#[test]
fn a_clean_motion_raises_nothing() {
    assert_eq!(warnings(&clean()), []);
}

#[test]
fn samples_in_memory_are_the_record_of_a_file_that_holds_them() {
    let of = |step, samples| Record::of_samples("m.txt", step, Units::StandardGravity, samples);
    let record = of(0.01, vec![0.0, 0.1, -0.2]).unwrap();
    let options = ReadOptions { units: Some(Units::StandardGravity), time_step_s: Some(0.01), ..ReadOptions::default() };
    let file = Record::parse("m.txt", b"0.0 0.1 -0.2", &options).unwrap();
    assert_eq!(
        (&record.acceleration_m_s2, record.time_step_s, &record.warnings),
        (&file.acceleration_m_s2, 0.01, &file.warnings)
    );
    for samples in [vec![], vec![0.0], vec![0.0, f64::NAN], vec![f64::INFINITY, 0.0], vec![0.0, 2e4]] {
        assert!(of(0.01, samples).is_err());
    }
    assert!([0.0, -0.01, f64::NAN, 2.0].iter().all(|&step| of(step, vec![0.0, 1.0]).is_err()));
}

#[test]
fn a_single_sample_spike_is_found_where_it_is() {
    let mut values = clean();
    values[700] += 6.0;
    let found = warnings(&values);
    assert!(matches!(found[..], [Warning::Spike { count: 1, time_s, .. }] if (time_s - 7.0).abs() < 1e-9), "{found:?}");
}

#[test]
fn a_step_is_found_where_it_is() {
    let mut values = clean();
    values[700..].iter_mut().for_each(|value| *value += 3.0);
    let found = warnings(&values);
    assert!(
        found.iter().any(|w| matches!(w, Warning::Step { count: 1, time_s, .. } if (time_s - 7.0).abs() < 1e-9)),
        "{found:?}"
    );
}

#[test]
fn a_clipped_top_is_found() {
    let values: Vec<f64> = clean().into_iter().map(|value| value.min(1.2)).collect();
    let found = warnings(&values);
    assert!(
        found.iter().any(|w| matches!(w, Warning::Clipped { samples: 3.., value_m_s2, .. } if *value_m_s2 == 1.2)),
        "{found:?}"
    );
}

/// A pulse of 2 s at 200 Hz in the digits of `print`, of which no sample exceeds `stop`.
fn pulse(print: impl Fn(f64) -> String, stop: f64) -> Vec<Warning> {
    let turn = |t: f64| math::sin(std::f64::consts::PI * t);
    let value = |t: f64| if (2.0..4.0).contains(&t) { 0.321 * turn(t) } else { 0.0 };
    let rows: String = (0..1200).map(|row| format!("{}\n", print(value(f64::from(row) * 0.005).min(stop)))).collect();
    let options = ReadOptions { units: Some(Units::StandardGravity), time_step_s: Some(0.005), ..ReadOptions::default() };
    Record::parse("m.txt", rows.as_bytes(), &options).unwrap().warnings
}

#[test]
fn a_smooth_top_in_few_digits_is_not_clipped() {
    let clipped = |found: &[Warning]| found.iter().any(|warning| matches!(warning, Warning::Clipped { .. }));
    for decimals in 2..7 {
        assert!(!clipped(&pulse(|value| format!("{value:.decimals$}"), 1.0)), "{decimals}");
    }
    for decimals in 2..5 {
        assert!(!clipped(&pulse(|value| format!("{value:.decimals$e}"), 1.0)), "{decimals}");
    }
    for decimals in 4..7 {
        assert!(clipped(&pulse(|value| format!("{value:.decimals$}"), 0.3)), "{decimals}");
        assert!(clipped(&pulse(|value| format!("{value:.decimals$e}"), 0.3)), "{decimals}");
    }
}

#[test]
fn an_offset_baseline_is_found() {
    let values: Vec<f64> = clean().into_iter().map(|value| value + 0.02).collect();
    let found = warnings(&values);
    assert!(matches!(found[..], [Warning::VelocityDrift { final_m_s, .. }] if (final_m_s - 0.4).abs() < 0.01), "{found:?}");
}

#[test]
fn counts_start_head_and_units_are_compared() {
    let header = "# NPTS = 2000\n";
    assert_eq!(
        warnings_of(&clean(), Units::MetrePerSecondSquared, header),
        [Warning::SamplesDisagree { stated: 2000, present: 2001 }]
    );
    let late = warnings(&clean()[500..]);
    assert!(late.iter().any(|w| matches!(w, Warning::NonZeroStart { .. })), "{late:?}");
    let quiet: Vec<f64> = std::iter::repeat_n(0.0, 3000).chain(clean()).collect();
    assert!(matches!(warnings(&quiet)[..], [Warning::QuietHead { seconds }] if seconds > 30.0));
    assert!(matches!(warnings_of(&clean(), Units::InchPerSecondSquared, "")[..], []));
    let hundredfold: Vec<f64> = clean().into_iter().map(|value| value * 100.0).collect();
    assert!(matches!(warnings_of(&hundredfold, Units::MetrePerSecondSquared, "")[..], [Warning::LargePeak { .. }]));
    let hundredth: Vec<f64> = clean().into_iter().map(|value| value / 300.0).collect();
    assert!(matches!(warnings_of(&hundredth, Units::MetrePerSecondSquared, "")[..], [Warning::SmallPeak { .. }]));
}

#[test]
fn rounded_steps_are_found_and_cured_by_the_true_one() {
    let text = |dt: &str| {
        let samples: String = clean().iter().map(|value| format!("{:.6e}\n", value / 9.80665)).collect();
        format!("PEER\nE\nACCELERATION IN UNITS OF G\nNPTS= 2001, DT= {dt} SEC\n{samples}")
    };
    let read = |dt: &str, given| {
        Record::parse("m.AT2", text(dt).as_bytes(), &ReadOptions { time_step_s: given, ..ReadOptions::default() }).unwrap()
    };
    let rounded = |record: &Record| record.warnings.iter().any(|w| matches!(w, Warning::TimeStepRounded { .. }));
    assert!(rounded(&read(".0024", None)));
    assert!(!rounded(&read(".0050", None)));
    assert!(!rounded(&read(".00390625", None)));
    let cured = read(".0024", Some(0.00244));
    assert_eq!(cured.time_step_s, 0.00244);
    assert!(!rounded(&cured));
    let other = read(".0024", Some(0.005));
    assert_eq!(other.time_step_s, 0.0024);
    assert!(other.warnings.contains(&Warning::TimeStepNotUsed { given_s: 0.005, stated_s: Some(0.0024) }));
}
