//! Records that something has happened to, through the real reader, its checks and whole simulations of ideal and real devices: a jump, a
//! gap, an offset, a spike of 100 g, samples too far apart and very close, and two records in one file.

use std::fmt::Write;
use std::path::Path;

use sprag_shared::math;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::GRAVITY;
use sprag_sim::record::{ReadOptions, Record, RecordError, Units, Warning};
use sprag_sim::scene::Scene;
use sprag_sim::simulation::DeviceRun;
use sprag_tests::scene_text::{self, IDEAL_DEVICES};

/// A pier with no device, an inerter, an ideal pair, and a pair of rigid clutches that come late and whose flywheels spin.
fn pier() -> String {
    let block = "[block]\nsize_m = 2.0\nslenderness_deg = 10.0\n";
    let real_pair = r#"
[[device]]
kind = "clutched-pair"
name = "real pair"
mass_ratio = 0.5
engagement = "rigid"
flywheel = { brake_deceleration_m_s2 = 2.0 }
rack = { dry_friction_ratio = 0.001 }
actuation = { engagement_delay_s = 0.003, release_delay_s = 0.003 }
[[ground]]
motion = "record"
[run]
free_time_s = 6.0
"#;
    format!("{block}{IDEAL_DEVICES}{real_pair}")
}

const STEP: f64 = 0.005;

/// 12 s of a sine of 1 Hz, 0.3 g, that swells and fades, in m/s².
fn swell() -> Vec<f64> {
    let tau = core::f64::consts::TAU;
    (0..=2400)
        .map(|index| {
            let time = f64::from(index) * STEP;
            let envelope = 0.5 - 0.5 * math::cos(tau * time / 12.0);
            0.3 * GRAVITY * envelope * math::sin(tau * time)
        })
        .collect()
}

/// As a table of time and acceleration, with every digit of the latter.
fn table(samples: &[f64], step: f64) -> String {
    let mut text = "time_s,acc_m_s2\n".to_owned();
    for (index, sample) in samples.iter().enumerate() {
        writeln!(text, "{:.6},{sample:?}", index as f64 * step).unwrap();
    }
    text
}

fn read(text: &str) -> Result<Record, RecordError> {
    Record::parse("record.csv", text.as_bytes(), &ReadOptions::default())
}

fn runs_of(scene: &str, text: &str, set: &[&str]) -> Vec<DeviceRun> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.csv");
    std::fs::write(&path, text).unwrap();
    let mut scene = Scene::parse_with(scene, "scene.toml", set).unwrap();
    scene.use_record(&path).unwrap();
    run(&scene)
}

/// Runs a scene: finite throughout, in order, and in no more samples than were asked for and the jumps of events.
fn run(scene: &Scene) -> Vec<DeviceRun> {
    let runs = scene_text::run(scene);
    for run in &runs {
        let samples = &run.history.samples;
        let finite = |number: &f64| number.is_finite();
        assert!(
            samples.iter().all(|s| [s.rotation_rad, s.velocity_rad_s, s.acceleration_rad_s2].iter().all(finite)),
            "{}",
            run.device
        );
        assert!(samples.windows(2).all(|pair| pair[0].time_s <= pair[1].time_s), "{}", run.device);
        let events = run.impacts + run.clutch_switches;
        assert!(samples.len() < 10_000 + 10 * events as usize, "{}: {} samples", run.device, samples.len());
        assert_eq!(run.peak_rotation.is_some(), !run.outcome.overturned());
    }
    runs
}

/// The same outcomes, and peaks that agree within `tolerance` of α.
fn assert_same(first: &[DeviceRun], second: &[DeviceRun], tolerance: f64) {
    assert_eq!(first.len(), second.len());
    for (one, other) in first.iter().zip(second) {
        assert_eq!(
            (one.outcome, one.first_impact_time_s.is_some()),
            (other.outcome, other.first_impact_time_s.is_some()),
            "{}",
            one.device
        );
        if let (Some(first), Some(second)) = (one.peak_rotation, other.peak_rotation) {
            assert!((first - second).abs() <= tolerance, "{}: {first} {second}", one.device);
        }
    }
}

/// What a series of its own steps makes of a motion is what Runge-Kutta makes of it.
fn assert_right(text: &str) {
    let fixed = runs_of(&pier(), text, &["accuracy.method=runge-kutta-4", "accuracy.step_s=0.0005"]);
    assert_same(&runs_of(&pier(), text, &[]), &fixed, 1e-6);
}

#[test]
fn a_jump_is_noticed_and_followed() {
    let mut samples = swell();
    assert!(read(&table(&samples, STEP)).unwrap().warnings.is_empty());
    samples[1200..].iter_mut().for_each(|sample| *sample += 0.35 * GRAVITY);
    let text = table(&samples, STEP);
    let warnings = read(&text).unwrap().warnings;
    let step = warnings.iter().find_map(|warning| match warning {
        Warning::Step { count, time_s, height_m_s2 } => Some((*count, *time_s, *height_m_s2)),
        _ => None,
    });
    let (count, time, height) = step.unwrap_or_else(|| panic!("{warnings:?}"));
    assert_eq!((count, (time - 6.0).abs() < 1e-9), (1, true), "{time}");
    // 0.35 g, and the sine's own 0.3 g · 2π · 0.005 at its steepest.
    assert!((height / GRAVITY - 0.35).abs() < 0.3 * core::f64::consts::TAU * STEP + 1e-9, "{height}");
    assert!(warnings.iter().any(|warning| matches!(warning, Warning::VelocityDrift { .. })), "{warnings:?}");
    assert_right(&text);
}

#[test]
fn a_gap_is_refused_and_bridged_on_request_by_a_straight_line() {
    let samples = swell();
    let gap = 1000..1100;
    let text: String = table(&samples, STEP)
        .lines()
        .enumerate()
        // Sample k stands in line k + 1, after the header.
        .filter(|(line, _)| !gap.contains(&line.wrapping_sub(1)))
        .map(|(_, line)| format!("{line}\n"))
        .collect();
    let error = read(&text).unwrap_err().to_string();
    assert!(error.contains(&format!("line {}", gap.start + 2)) && !error.contains('\n'), "{error}");
    let options = ReadOptions { resample_to_s: Some(STEP), ..ReadOptions::default() };
    let bridged = Record::parse("record.csv", text.as_bytes(), &options).unwrap();
    assert!(bridged.warnings.iter().any(|warning| matches!(warning, Warning::Resampled { .. })), "{:?}", bridged.warnings);
    assert_eq!(bridged.acceleration_m_s2.len(), samples.len());
    let (first, last) = (samples[gap.start - 1], samples[gap.end]);
    for (index, found) in bridged.acceleration_m_s2.iter().enumerate() {
        let expected = if gap.contains(&index) {
            first + (last - first) * (index + 1 - gap.start) as f64 / (gap.len() + 1) as f64
        } else {
            samples[index]
        };
        assert!((found - expected).abs() < 1e-9, "{index}: {found} {expected}");
    }
    assert_right(&table(&bridged.acceleration_m_s2, STEP));
}

/// Nothing uplifts below g tan α, for however long it is pushed; 2 % above it even what has to overcome friction does.
#[test]
fn an_offset_below_the_threshold_moves_nothing() {
    let threshold = GRAVITY * math::tan(10.0_f64.to_radians());
    for (share, outcome) in [(0.999, Some(Outcome::NoRocking)), (-0.999, Some(Outcome::NoRocking)), (1.02, None), (-1.02, None)] {
        let text = table(&vec![share * threshold; 8000], STEP);
        let warnings = read(&text).unwrap().warnings;
        assert!(warnings.iter().any(|warning| matches!(warning, Warning::NonZeroStart { .. })), "{warnings:?}");
        for run in runs_of(&pier(), &text, &[]) {
            match outcome {
                Some(outcome) => assert_eq!((run.outcome, run.peak_rotation), (outcome, Some(0.0)), "{share}: {}", run.device),
                None => assert_ne!(run.outcome, Outcome::NoRocking, "{share}: {}", run.device),
            }
        }
    }
    // An offset under a motion: together they stay below the threshold, and the baseline drifts.
    let samples: Vec<f64> = swell().iter().map(|sample| 0.3 * sample + 0.45 * threshold).collect();
    let text = table(&samples, STEP);
    let warnings = read(&text).unwrap().warnings;
    assert!(warnings.iter().any(|warning| matches!(warning, Warning::VelocityDrift { .. })), "{warnings:?}");
    assert!(runs_of(&pier(), &text, &[]).iter().all(|run| run.outcome == Outcome::NoRocking));
}

/// One sample of 100 g is a triangle of area V, and for a large slender block an impulse: θ̇ becomes p²V/g over the inertia of what is
/// engaged, and the block overturns where that takes it past θ = α. With k = σ/λ: pV/(gα) = 1 without a device, √(1 + k) with an inerter
/// that stays, 1 + k with a pair that lets go as soon as the block slows down.
#[test]
fn a_spike_of_100_g_is_an_impulse() {
    let (alpha, sigma) = (0.2_f64, 0.5);
    let mut samples = vec![0.0; 401];
    samples[200] = 100.0 * GRAVITY;
    let text = table(&samples, STEP);
    let warnings = read(&text).unwrap().warnings;
    let spike = |warning: &Warning| matches!(warning, Warning::Spike { count: 1, time_s, .. } if (time_s - 1.0).abs() < 1e-9);
    assert!(warnings.iter().any(spike) && warnings.iter().any(|w| matches!(w, Warning::LargePeak { .. })), "{warnings:?}");
    let velocity = 100.0 * GRAVITY * STEP;
    let k = sigma * 3.0 / 4.0;
    let limits = [1.0, math::square_root(1.0 + k), 1.0 + k];
    for (device, limit) in limits.into_iter().enumerate() {
        // The triangle lasts 10 ms, in which gravity takes up to 10 ms · p of the limit.
        for (share, outcome) in [(0.98, Outcome::Safe), (1.02, Outcome::OverturnedWithoutImpact)] {
            let p = share * limit * GRAVITY * alpha / velocity;
            let scene = pier()
                .replace("size_m = 2.0", &format!("frequency_parameter_1_s = {p:?}\ngeometry = \"slender\""))
                .replace("slenderness_deg = 10.0", &format!("slenderness_deg = {:?}", alpha.to_degrees()))
                .replace("free_time_s = 6.0", "free_time_ratio = 15.0");
            let runs = runs_of(&scene, &text, &[]);
            assert_eq!(runs[device].outcome, outcome, "{}: {share} of {limit}", runs[device].device);
        }
    }
    assert_right(&text);
}

#[test]
fn two_seconds_between_samples_are_refused_and_one_is_not() {
    let samples = [0.0, 2.5, -2.5, 2.5, -2.5, 0.0];
    for step in [2.0, 1.000_001] {
        let error = read(&table(&samples, step)).unwrap_err();
        assert!(matches!(error, RecordError::TimeStepRange { .. }), "{error}");
        assert!(!error.to_string().contains('\n'), "{error}");
        // Resampling does not make it a record.
        let options = ReadOptions { resample_to_s: Some(STEP), ..ReadOptions::default() };
        assert!(Record::parse("record.csv", table(&samples, step).as_bytes(), &options).is_err());
    }
    let text = table(&samples, 1.0);
    assert_eq!(read(&text).unwrap().time_step_s, 1.0);
    assert_right(&text);
}

/// Samples at 2,000 Hz on the straight lines between those at 200 Hz are the same motion.
#[test]
fn two_thousand_samples_a_second_on_the_same_lines_change_nothing() {
    let samples = swell();
    let coarse = runs_of(&pier(), &table(&samples, STEP), &[]);
    assert!(coarse.iter().all(|run| run.outcome == Outcome::Safe && run.impacts > 0));
    let resampled = Record::parse(
        "record.csv",
        table(&samples, STEP).as_bytes(),
        &ReadOptions { resample_to_s: Some(0.1 * STEP), ..ReadOptions::default() },
    )
    .unwrap();
    assert_eq!(resampled.acceleration_m_s2.len(), 24_001);
    let lines: Vec<f64> = (0..24_001)
        .map(|index| {
            let (from, part) = (index / 10, (index % 10) as f64 / 10.0);
            samples[from] * (1.0 - part) + samples.get(from + 1).map_or(0.0, |next| next * part)
        })
        .collect();
    for fine in [resampled.acceleration_m_s2, lines] {
        let text = table(&fine, 0.1 * STEP);
        assert_eq!(read(&text).unwrap().time_step_s, 0.1 * STEP);
        let fine = runs_of(&pier(), &text, &[]);
        assert_same(&coarse, &fine, 1e-9);
        for (one, other) in coarse.iter().zip(&fine) {
            assert_eq!((one.impacts, one.clutch_switches), (other.impacts, other.clutch_switches), "{}", one.device);
        }
    }
}

/// Two records in one file are one after the other; where the header counts the first one only, a warning says so.
#[test]
fn joined_records_are_one_motion_after_the_other() {
    let first = swell();
    let second: Vec<f64> = first.iter().map(|sample| -0.8 * sample).collect();
    let joined: Vec<f64> = first.iter().chain(&second).copied().collect();
    let at2 = |count: usize, samples: &[f64]| {
        let mut text = format!("PEER\nE\nACCELERATION IN UNITS OF G\nNPTS= {count}, DT= {STEP} SEC\n");
        samples.iter().for_each(|sample| writeln!(text, " {:?}", sample / GRAVITY).unwrap());
        text
    };
    let text = at2(first.len(), &joined);
    let record = read(&text).unwrap();
    assert_eq!((record.acceleration_m_s2.len(), record.units), (joined.len(), Units::StandardGravity));
    let disagree = Warning::SamplesDisagree { stated: first.len() as u64, present: joined.len() };
    assert!(record.warnings.contains(&disagree), "{:?}", record.warnings);
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("first.AT2", &at2(first.len(), &first));
    write("second.AT2", &at2(second.len(), &second));
    let start = first.len() as f64 * STEP;
    let both = pier().replace(
        "[[ground]]\nmotion = \"record\"\n",
        &format!(
            "[[ground]]\nmotion = \"record\"\nfile = \"first.AT2\"\n[[ground]]\nmotion = \"record\"\nfile = \"second.AT2\"\nstart_s = {start:?}\n"
        ),
    );
    let path = folder.path().join("both.toml");
    std::fs::write(&path, both).unwrap();
    let apart = run(&Scene::load(Path::new(&path), &[]).unwrap());
    let together = runs_of(&pier(), &text, &[]);
    assert!(together.iter().any(|run| run.impacts > 20));
    assert_same(&together, &apart, 1e-9);
}
