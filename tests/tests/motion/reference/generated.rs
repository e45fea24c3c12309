//! Random scenes: the same seed makes the same scene, every family occurs, and whatever runs keeps its ledger.

use std::collections::BTreeSet;
use std::path::Path;

use sprag_reference::compare::{CLOSES, Subject};
use sprag_reference::effort::Effort;
use sprag_reference::generate::scene;
use sprag_reference::scene::Scene;
use sprag_reference::simulate::{run, run_with};

#[test]
fn a_seed_and_a_number_decide_a_scene() {
    for number in 0..20 {
        assert_eq!(scene(7, number), scene(7, number));
        assert_ne!(scene(7, number), scene(8, number));
        assert_ne!(scene(7, number), scene(7, number + 1));
    }
    let families: BTreeSet<&str> = (0..100).map(|number| scene(7, number).family).collect();
    assert_eq!(families.len(), 7, "{families:?}");
}

#[test]
fn ledgers_close() {
    let folder = std::env::temp_dir().join(format!("sprag-reference-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    for number in 0..40 {
        let generated = scene(11, number);
        for (name, text) in &generated.files {
            std::fs::write(folder.join(name), text).expect("a record");
        }
        let parsed = Scene::parse(&generated.text).expect("a scene");
        let residual = run(&parsed, 0, &folder).expect("a run").ledger.shares().residual;
        assert!(residual < 1e-9, "scene {number}, {}: {residual:e}", generated.family);
    }
    std::fs::remove_dir_all(&folder).expect("a folder that was there");
}

/// What the ground asks for is far more than this motion, 1e-4 of α: its ledger closes at half the step.
#[test]
fn a_ledger_that_does_not_close_asks_for_shorter_steps() {
    let generated = scene(77, 4960);
    let folder = tempfile::tempdir().expect("a folder");
    generated.write_records(folder.path()).expect("records");
    let own = run(&Scene::parse(&generated.text).expect("a scene"), 0, folder.path()).expect("a run");
    assert!(own.ledger.shares().residual > CLOSES);
    let subject = Subject::of(&generated.text, folder.path()).expect("a run");
    assert_eq!(subject.step(), own.step / 2.0);
}

/// Scenes in which two programs had differed (`scenes/`, whose first lines say by what): this one runs them.
#[test]
fn scenes_that_distinguished_programs_run() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
        if entry.path().extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let text = std::fs::read_to_string(entry.path()).expect("a text");
        let residual = run(&Scene::parse(&text).expect("a scene"), 0, &folder).expect("a run").ledger.shares().residual;
        assert!(residual < 1e-10, "{}: {residual:e}", entry.path().display());
        count += 1;
    }
    assert!(count >= 10);
}

/// Every event of this free rocking is known: the run stops at the one too many, and says which and when.
#[test]
fn a_run_with_more_events_than_it_may_have_names_the_instant_and_the_mode() {
    let text = "[block]\nsize_m = 2\nslenderness_deg = 10\ninitial_rotation_ratio = 0.3\n[[device]]\nkind = \"none\"\n";
    let scene = Scene::parse(text).expect("a scene");
    let (time, _) = run(&scene, 0, Path::new(".")).expect("a run").events[4];
    let few = Effort { events: 4, ..Effort::default() };
    let Err(error) = run_with(&scene, 0, Path::new("."), few) else { panic!("a run of more than 4 events") };
    assert!(error.starts_with(&format!("more than 4 events by {time} s: Impact")) && error.contains("Rocking"), "{error}");
}
