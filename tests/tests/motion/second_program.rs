//! Random scenes by two programs: Sprag, by both of its methods, and the second program (`tests/reference`), which shares no code
//! with it. Outcomes are equal, histories and ledgers agree.
//!
//! For many more: `compare` of `sprag-reference`.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use sprag_reference::compare::{Other, Subject, Verdict};
use sprag_reference::generate::scene;
use sprag_reference::ledger::Shares;
use sprag_reference::method::Method;
use sprag_reference::tally::Tally;
use sprag_sim::simulation::energy::COLUMNS;
use sprag_tests::scene_text::run_in;

const SEED: u64 = 16;
const COUNT: u64 = 300;

/// Runs a scene by Sprag.
fn sprag(text: &str, folder: &Path, method: Method, step: f64) -> Result<Other, String> {
    let mut text = format!("{text}\n[accuracy]\n");
    for (key, value) in method.keys(step) {
        text.push_str(&format!("{key} = {value}\n"));
    }
    let run = run_in(&text, folder)?;
    let entries = run.energy.ok_or("no ledger")?.entries;
    let ledger =
        Shares::of(|name| COLUMNS.into_iter().zip(entries.row()).find(|(column, _)| *column == name).map(|(_, value)| value))
            .ok_or("an entry is missing")?;
    Ok(Other {
        outcome: run.outcome.name().to_owned(),
        history: run.history.samples.iter().map(|sample| [sample.time_s, sample.rotation_rad]).collect(),
        ledger: Some(ledger),
    })
}

/// Verdicts on one scene, by both methods.
fn verdicts(text: &str, folder: &Path) -> Vec<Result<Verdict, String>> {
    let subject = Subject::of(text, folder);
    let verdict = |method: &Method| {
        let subject = subject.as_ref().map_err(Clone::clone)?;
        subject.against(&sprag(text, folder, *method, subject.step())?, method.tolerance())
    };
    Method::ALL.iter().map(verdict).collect()
}

/// What is wrong with the verdicts on a scene.
fn complaints(name: &str, verdicts: &[Result<Verdict, String>]) -> Vec<String> {
    let wrong = |verdict: &Result<Verdict, String>| !matches!(verdict, Ok(Verdict::Agree(_) | Verdict::Chaotic(_)));
    let judged = Method::ALL.iter().zip(verdicts).filter(|(_, verdict)| wrong(verdict));
    judged.map(|(method, verdict)| format!("{name}, {}: {verdict:?}", method.name())).collect()
}

#[test]
fn two_programs_agree_on_random_scenes() {
    let check = |number: u64| {
        let generated = scene(SEED, number);
        let folder = tempfile::tempdir().unwrap();
        generated.write_records(folder.path()).unwrap();
        (generated.family, verdicts(&generated.text, folder.path()))
    };
    let scenes: Vec<(&str, _)> = (0..COUNT).into_par_iter().map(check).collect();
    for (index, method) in Method::ALL.into_iter().enumerate() {
        let mut tally = Tally::default();
        scenes.iter().for_each(|(family, verdicts)| tally.add(family, &verdicts[index]));
        println!("{}:\n{tally}", method.name());
        assert!(tally.chaotic() as u64 <= COUNT / 50, "more chaos than there was");
    }
    let named = (0..COUNT).zip(&scenes);
    let wrong: Vec<_> =
        named.flat_map(|(number, (family, verdicts))| complaints(&format!("{number}, {family}"), verdicts)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn two_programs_agree_on_scenes_that_had_distinguished_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/scenes");
    let files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let scenes: Vec<_> = files.iter().filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect();
    assert!(scenes.len() > 10);
    let check = |path: &&PathBuf| {
        let verdicts = verdicts(&std::fs::read_to_string(path).unwrap(), &folder);
        complaints(&path.file_stem().unwrap().to_string_lossy(), &verdicts)
    };
    let wrong: Vec<_> = scenes.par_iter().map(check).collect::<Vec<_>>().concat();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
