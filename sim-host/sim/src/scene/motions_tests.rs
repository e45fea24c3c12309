//! Horizontal and vertical ground motion of a scene.

use sprag_shared::ground::GroundSegment;

use super::Scene;
use super::motions::GroundMotions;
use crate::record::{ReadOptions, Record};

const SCENE: &str = r#"
[block]
size_m = 2.0
slenderness_deg = 10.0
[[device]]
kind = "none"
[[ground]]
motion = "sine"
amplitude_ratio = 2.0
frequency_hz = 1.0
[[vertical]]
motion = "sine"
amplitude_g = 0.5
frequency_hz = 2.0
start_s = 0.8
[[vertical]]
motion = "record"
"#;

fn scene(overrides: &[&str]) -> Result<Scene, String> {
    Scene::parse_with(SCENE, "scene.toml", overrides).map_err(|error| error.to_string())
}

fn motions(scene: &Scene) -> Result<GroundMotions, String> {
    scene.ground_motions().map_err(|error| error.to_string())
}

/// A record that is `scale` g at its middle sample.
fn record(folder: &tempfile::TempDir, scale: f64) -> std::path::PathBuf {
    let file = folder.path().join("up.csv");
    std::fs::write(&file, format!("# time_s,acc_g\n0.0,0\n0.2,{scale}\n0.4,0\n0.6,0\n")).unwrap();
    file
}

#[test]
fn a_record_in_memory_goes_before_the_file_that_is_called_so() {
    let folder = tempfile::tempdir().unwrap();
    let file = record(&folder, 0.25);
    let mut scene = scene(&["vertical.1.file=nowhere.csv"]).unwrap();
    assert!(motions(&scene).is_err());
    scene.take_records(|_| Record::read(&file, &ReadOptions::default())).unwrap();
    let GroundMotions { vertical, records, .. } = motions(&scene).unwrap();
    // Between 0, 0.2, 0.4, 0.6, 0.8, 1.0 and 1.3 s.
    assert_eq!((vertical.unwrap().segments().len(), records[0].samples), (6, 4));
    // What is there already is not read again.
    scene.take_records(|_| Err("read")).unwrap();
    // One that is read otherwise is another one.
    scene.file.vertical[1].component = Some("UD".to_owned());
    assert!(motions(&scene).is_err());
    assert_eq!(scene.take_records(|_| Err("read")), Err("read"));
}

#[test]
fn horizontal_and_vertical_motions_have_the_same_segments() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene(&[]).unwrap();
    scene.use_vertical_record(&record(&folder, 0.25)).unwrap();
    let GroundMotions { horizontal, vertical, .. } = motions(&scene).unwrap();
    let vertical = vertical.unwrap();
    assert_eq!(horizontal.segments().len(), vertical.segments().len());
    assert!((horizontal.duration() - 1.3).abs() < 1e-12 && vertical.duration() == horizontal.duration());
    // 0.2 s and 1.05 s: the record's peak, and the sine's first.
    for (time, expected) in [(0.2, 0.25), (0.925, 0.5)] {
        let segment = vertical.segments().iter().find(|s| time <= s.start + s.duration).unwrap();
        assert!((segment.shape.acceleration(time - segment.start) - expected).abs() < 1e-12, "{time}");
    }
    assert_eq!(scene.ground_motion().unwrap().segments().len(), horizontal.segments().len());
}

#[test]
fn without_a_vertical_motion_the_horizontal_one_is_cut_at_its_own_kinks() {
    let scene = scene(&["vertical=[]"]).unwrap();
    let GroundMotions { horizontal, vertical, .. } = motions(&scene).unwrap();
    assert!(vertical.is_none() && horizontal.segments().len() == 1);
}

#[test]
fn a_ground_that_falls_away_is_refused_with_the_instant() {
    let folder = tempfile::tempdir().unwrap();
    let mut scene = scene(&["vertical.0.scale=0.1"]).unwrap();
    scene.use_vertical_record(&record(&folder, -1.2)).unwrap();
    let message = motions(&scene).unwrap_err();
    assert!(
        message.starts_with("scene.toml: vertical: ") && message.contains("1 + v̈_g/g = -0.2") && message.contains("at 0.2 s")
    );
    assert!(!message.contains('\n'));
    scene.use_vertical_record(&record(&folder, -0.99)).unwrap();
    assert!(motions(&scene).is_ok());
}

#[test]
fn vertical_tables_are_checked_like_horizontal_ones() {
    for (item, words) in [
        ("vertical.0.amplitude_ratio=2", ["vertical.0.amplitude_ratio", "amplitude_g or amplitude_m_s2"]),
        ("vertical.0={ motion = \"sine\", frequency_hz = 1 }", ["vertical.0.amplitude_g is missing", "amplitude_m_s2"]),
        ("vertical.0.frequency_hz=0", ["vertical.0.frequency_hz is 0", "from 0.001"]),
        ("vertical.0.duration_s=1", ["vertical.0.duration_s", "no such key"]),
        ("vertical.1.units=furlong", ["vertical.1.units", "m/s2"]),
    ] {
        let message = scene(&[item]).unwrap_err();
        assert!(words.iter().all(|word| message.contains(word)), "{item}: {message}");
    }
    let message = motions(&scene(&[]).unwrap()).unwrap_err();
    assert!(message.contains("vertical.1.file is missing") && message.contains("--record-vertical FILE"), "{message}");
    let mut without = scene(&["vertical=[]"]).unwrap();
    let message = without.use_vertical_record("x.csv".as_ref()).unwrap_err().to_string();
    assert!(message.contains("[[vertical]]") && message.contains("--record-vertical"), "{message}");
}
