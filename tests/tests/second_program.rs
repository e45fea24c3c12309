//! Random scenes by two programs: Sprag, by both of its methods, and the second program (`tests/reference`), which shares no code
//! with it. Outcomes are equal, histories agree and ledgers close, or the scene is in a list with its reason.
//!
//! For many more: `compare` of `sprag-reference`.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use sprag_reference::compare::{Other, Subject, Verdict};
use sprag_reference::generate::scene;
use sprag_reference::method::Method;
use sprag_reference::tally::Tally;
use sprag_sim_host::interrupt::Interrupt;
use sprag_sim_host::scene::Scene;
use sprag_sim_host::simulation::simulate;

const SEED: u64 = 16;
const COUNT: u64 = 300;

const ROUNDING: &str = "rounding of the acceleration at the uplift makes an impact";
const FROZEN: &str = "springs are frozen while friction or a spring holds the block, and so are their flywheels";
const ILL_CONDITIONED: &str = "no damper: every error of a located parting grows";

/// Random scenes on which Sprag's methods differ from the second program, and why.
const RANDOM: [&[(u64, &str)]; 2] = [&[], &[]];

/// Scenes that had told the programs apart (`tests/reference/scenes`) and still do, by method.
const SCENES: [&[(&str, &str)]; 2] = [
    &[("backlash_without_damper", ILL_CONDITIONED), ("spring_holds_the_block_down", FROZEN), ("spring_of_a_held_block", FROZEN)],
    &[("spring_holds_the_block_down", FROZEN), ("spring_of_a_held_block", FROZEN), ("uplift_without_impact", ROUNDING)],
];

/// Runs a scene by Sprag.
fn sprag(text: &str, folder: &Path, method: Method, step: f64) -> Result<Other, String> {
    let mut text = format!("{text}\n[accuracy]\n");
    for (key, value) in method.keys(step) {
        text.push_str(&format!("{key} = {value}\n"));
    }
    let mut scene = Scene::parse(&text, "second program").map_err(|error| error.to_string())?;
    scene.folder = folder.to_owned();
    let ground = scene.ground_motions().map_err(|error| error.to_string())?;
    let run = simulate(&scene, &ground, &Interrupt::default()).map_err(|error| error.to_string())?.remove(0);
    let shares = run.energy.ok_or("no ledger")?.entries;
    let income = shares.initial + shares.input.abs() + shares.created;
    Ok(Other {
        outcome: run.outcome.name().to_owned(),
        history: run.history.samples.iter().map(|sample| [sample.time_s, sample.rotation_rad]).collect(),
        residual: Some(shares.residual.abs() / income.max(f64::MIN_POSITIVE)),
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

/// What is wrong with a verdict on a scene that is listed for `reason`, or is not listed.
fn complaint(name: &str, method: Method, verdict: &Result<Verdict, String>, reason: Option<&str>) -> Option<String> {
    let agrees = matches!(verdict, Ok(Verdict::Agree(_) | Verdict::Chaotic(_)));
    (agrees != reason.is_none()).then(|| format!("{name}, {}, listed for {reason:?}: {verdict:?}", method.name()))
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
    let mut complaints = Vec::new();
    for (index, (method, understood)) in Method::ALL.into_iter().zip(RANDOM).enumerate() {
        let mut tally = Tally::default();
        for (number, (family, verdicts)) in (0..COUNT).zip(&scenes) {
            tally.add(family, &verdicts[index]);
            let reason = understood.iter().find(|(listed, _)| *listed == number).map(|(_, reason)| *reason);
            complaints.extend(complaint(&format!("scene {number}, {family}"), method, &verdicts[index], reason));
        }
        println!("{}:\n{tally}", method.name());
        assert!(tally.chaotic() as u64 <= COUNT / 50, "more chaos than there was");
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn two_programs_agree_on_scenes_that_had_told_them_apart() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/scenes");
    let files: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let scenes: Vec<_> = files.iter().filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect();
    assert!(scenes.len() > 10);
    let check = |path: &&PathBuf| {
        let name = path.file_stem().unwrap().to_str().unwrap();
        let verdicts = verdicts(&std::fs::read_to_string(path).unwrap(), &folder);
        let complaint = |index: usize| {
            let reason = SCENES[index].iter().find(|(listed, _)| *listed == name).map(|(_, reason)| *reason);
            complaint(name, Method::ALL[index], &verdicts[index], reason)
        };
        [complaint(0), complaint(1)]
    };
    let complaints: Vec<_> = scenes.par_iter().map(check).collect::<Vec<_>>().into_iter().flatten().flatten().collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
