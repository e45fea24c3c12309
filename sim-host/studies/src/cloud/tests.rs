//! Studies that cannot be run, and what they say.

use std::path::{Path, PathBuf};

use sprag_shared::observers::outcome::Outcome;
use sprag_sim::keys::Described;
use sprag_sim::scene::Scene;

use super::demand::{Demand, DemandModel};
use super::findings::Findings;
use super::measure::Measure;
use super::pages::{demand_page, fragility_page, ranking_page};
use super::runs::Run;
use super::study::{Scaling, Study};
use super::study_file::StudyFile;

const RECORDS: &str = "records = ['a.csv']\n";

fn parse(text: &str) -> Result<Study, String> {
    Study::parse(text, "study.toml", Path::new(""), &[], &[]).map_err(|error| error.to_string())
}

/// A slash that a shell's completion adds to a folder makes no other study, nor does one in the study's own text.
#[test]
fn a_folder_is_the_same_with_a_slash_at_its_end() {
    let text = |study: Study| serde_json::to_string(&study.file.records).unwrap();
    let given = |folder: &str| text(Study::parse(RECORDS, "a", Path::new(""), &[], &[PathBuf::from(folder)]).unwrap());
    assert_eq!(given("motions/"), given("motions"));
    let written = |folder: &str| text(parse(&format!("records = ['{folder}', {{ file = '{folder}', units = 'g' }}]")).unwrap());
    assert_eq!(written("motions/"), written("motions"));
}

#[test]
fn a_study_needs_records_and_nothing_else() {
    let study = parse(RECORDS).unwrap();
    assert_eq!(study.devices, ["none", "inerter", "clutched pair"]);
    assert_eq!(study.structures.len(), 1);
    assert!(matches!(&study.scaling, Scaling::Factors(factors) if factors.len() == 1));
    assert_eq!(study.scaling, Scaling::Factors(vec![1.0]));
    assert_eq!(study.file.measures, Measure::ALL);
    assert_eq!((study.file.demand.measure, study.file.fragility.measure), (Measure::UniformDuration, Measure::Pgv));
    assert_eq!((study.bootstrap.resamples, study.bootstrap.seed, study.bootstrap.level.value()), (1000, 1, 0.95));
    // The paper's pier: p = √(3g/(4R)).
    let scales = study.structures[0].scales;
    assert!((scales.frequency_parameter_1_s - (0.75_f64 * 9.80665 / 2.0).sqrt()).abs() < 1e-12);
    assert!((scales.uplift_threshold_m_s2 - 9.80665 * 0.176_326_980_708_465).abs() < 1e-9);
    assert_eq!(
        parse("title = 'x'").unwrap_err(),
        "study.toml: records is missing: a list of record files and folders here, or --records PATH…"
    );
}

#[test]
fn structures_change_the_scene() {
    let study = parse(&format!(
        "{RECORDS}[[structure]]\nname = 'small'\nset = {{ 'block.size_m' = 1, 'block.geometry' = 'slender' }}\n\
         [[structure]]\nname = 'heavy'\nset = {{ 'device.1.mass_ratio' = 1.0 }}"
    ))
    .unwrap();
    let [small, heavy] = &study.structures[..] else { panic!() };
    assert_eq!((small.scene.file.block.size_m, heavy.scene.file.block.size_m), (Some(1.0), Some(2.0)));
    assert_eq!(heavy.scene.file.device[1].mass_ratio, Some(1.0));
    assert!((small.scales.uplift_threshold_m_s2 - 9.80665 * 10.0_f64.to_radians()).abs() < 1e-12);
    assert!(!study.slender());
}

/// Pages name the threshold that measures were divided by: g tan α, and gα of slender blocks.
#[test]
fn pages_have_the_formulas_of_the_blocks_models() {
    let pages = |structures: &str| {
        let (study, findings) = (parse(&format!("{RECORDS}{structures}")).unwrap(), Findings::default());
        [demand_page(&study, &findings), fragility_page(&study, &findings), ranking_page(&study, &findings)]
            .map(Result::unwrap)
            .concat()
    };
    let [full, slender] =
        ["full", "slender"].map(|name| format!("[[structure]]\nname = '{name}'\nset = {{ 'block.geometry' = '{name}' }}\n"));
    let (of_full, of_slender, of_both) = (pages(&full), pages(&slender), pages(&format!("{full}{slender}")));
    assert!(of_full.contains("- pga: PGA/(g tan α)\n") && !of_full.contains("gα"), "{of_full}");
    assert!(of_slender.contains("IM = p PGV/(gα),") && of_slender.contains("- pga: PGA/(gα)\n"), "{of_slender}");
    assert!(!of_slender.contains("tan α"), "{of_slender}");
    assert!(of_both.contains("IM = p PGV/(g tan α) (gα of slender blocks),"), "{of_both}");
    assert!(
        of_both.contains("- frequency: PGA/(p PGV)\n") && of_both.contains("- pga: PGA/(g tan α) (gα of slender blocks)\n"),
        "{of_both}"
    );
}

/// Demands of 1e-6 IM².
#[test]
fn a_small_factor_of_a_power_law_is_no_zero() {
    let runs = [10.0, 20.0, 40.0].map(|intensity: f64| Run::of(0, intensity, Outcome::Safe, 1e-6 * intensity * intensity));
    let runs: Vec<&Run> = runs.iter().collect();
    let model = DemandModel::fit(&runs, (0, "pier"), (0, "none"), Demand::PeakRotation, Measure::Pgv);
    let findings = Findings { demand: vec![model], ..Findings::default() };
    let page = demand_page(&parse(RECORDS).unwrap(), &findings).unwrap();
    assert!(page.contains("| 1.00e\u{2212}6 | 2.000 | 1.000 |"), "{page}");
}

#[test]
fn the_command_line_wins_over_structures_unless_these_differ() {
    let with = |structures: &str, change: &str| {
        let text = format!("{RECORDS}{structures}");
        Study::parse(&text, "study.toml", Path::new(""), &[change.to_owned()], &[]).map_err(|error| error.to_string())
    };
    let small = "[[structure]]\nname = 'small'\nset = { 'block.size_m' = 1 }\n";
    let also_small = "[[structure]]\nname = 'heavy'\nset = { 'block.size_m' = 1, 'device.1.mass_ratio' = 1.0 }";
    for structures in [small.to_owned(), format!("{small}{also_small}")] {
        let study = with(&structures, " block.size_m = 3").unwrap();
        assert!(study.structures.iter().all(|structure| structure.scene.file.block.size_m == Some(3.0)));
    }
    assert_eq!(
        with(&format!("{small}{also_small}"), "device.1.mass_ratio=0.5").unwrap_err(),
        "study.toml: --set device.1.mass_ratio: structures differ in it, as set by \"heavy\"; change it in the study"
    );
}

#[test]
fn a_key_of_the_study_itself_is_not_set_on_the_command_line() {
    for key in ["optimise.largest_force_ratio", "scale", "fragility.measure"] {
        let error = Study::parse(RECORDS, "study.toml", Path::new(""), &[format!("{key}=0.3")], &[]).unwrap_err();
        assert_eq!(error.to_string(), format!("study.toml: --set {key}: a key of the study itself; change it there"));
    }
}

#[test]
fn what_is_wrong_is_named_with_its_key_and_range() {
    for (keys, expected) in [
        ("scale = [0.0]", "scale.0 is 0, but must be above 0, to 1000"),
        ("scale = []", "scale is a list of 0, but must be a list of 1 to 1000"),
        ("scale = [1]\n[stripes]\nmeasure = 'pga'\nlevels = [1]", "scale: give only one of scale and [stripes]"),
        ("[stripes]\nmeasure = 'pga'\nlevels = [1, -1]", "stripes.levels.1 is -1, but must be above 0, to 1e6"),
        ("[stripes]\nmeasure = 'frequency'\nlevels = [1]", "stripes.measure: frequency does not change when a record is scaled"),
        ("measures = ['pgv', 'pga', 'pgv']", "measures.2: this value is there already"),
        ("scale = [1, 2.0, 1.0]", "scale.2: this value is there already"),
        ("[stripes]\nmeasure = 'pga'\nlevels = [0.5, 0.5]", "stripes.levels.1: this value is there already"),
        ("[stripes]\nmeasure = 'pga'\nlevels = []", "stripes.levels is a list of 0, but must be a list of 1 to 1000"),
        ("measures = []", "measures is a list of 0, but must be a list of 1 or more"),
        ("[optimise]\nmass_ratio = []", "optimise.mass_ratio is a list, but must be a table"),
        ("[bootstrap]\nseed = -1", "bootstrap.seed is -1, but must be a whole number from 0"),
        ("block = { size_m = 2 }", "block is a key of scenes, which `sprag simulate` and `sprag map` take"),
        ("measures = ['sa']", "measures.0: unknown variant `sa`, expected one of"),
        ("speed = 1", "unknown field `speed`"),
        ("[bootstrap]\nlevel = 1.0", "bootstrap.level is 1, but must be above 0 and below 1"),
        ("[bootstrap]\nresamples = 0", "bootstrap.resamples is 0, but must be from 1 to 1e6"),
        ("[record]\ntime_step_s = 0", "record.time_step_s is 0, but must be from 1e-5 to 1 s"),
        ("[record]\nunits = 'ell'", "record.units is \"ell\", but must be g, m/s2, cm/s2 (gal), mm/s2, in/s2, ft/s2"),
        ("[demand]\nstructures = ['tall']", "demand.structures is \"tall\", but must be among the structures"),
        ("[[structure]]\nname = 'a'\nset = { 'block.size_m' = -1 }", "block.size_m is -1, but must be from 0.001 to 10000 m"),
        ("[[structure]]\nname = 'a'\nset = { 'block.sise_m' = 1 }", "block.sise_m is not a key; did you mean `size_m`?"),
        ("[[structure]]\nname = 'a'\n[[structure]]\nname = 'a'", "structure.1.name: each structure needs a name of its own"),
        ("[[structure]]\nname = 'a'\n[[structure]]\nname = 'b'\nset = { 'device.0.name' = 'x' }", "give them the same names"),
        ("[[structure]]\nname = 'a'\nset = { 'ground.0.scale' = 2 }", "factors on records belong into the study"),
    ] {
        let error = parse(&format!("{RECORDS}{keys}")).unwrap_err();
        assert!(error.starts_with("study.toml") && error.contains(expected), "{keys}: {error}");
        assert!(!error.contains('\n'), "{error}");
    }
}

#[test]
fn a_scene_knows_every_key_of_a_study() {
    for key in StudyFile::schema()["properties"].as_object().unwrap().keys().filter(|key| *key != "title") {
        let error = Scene::parse(&format!("{key} = 1"), "study.toml").unwrap_err().to_string();
        assert!(error.contains(&format!("{key} is a key of studies, which `sprag cloud` and `sprag optimise` take")), "{error}");
    }
}

#[test]
fn every_study_of_the_repository_is_read() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes"));
    for name in ["cloud.toml", "optimise.toml"] {
        Study::load(&folder.join(name), &[], &[folder.to_owned()]).unwrap_or_else(|error| panic!("{error}"));
    }
}
