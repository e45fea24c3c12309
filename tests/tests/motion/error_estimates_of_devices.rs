//! Whether the errors that are reported for real devices are true: random scenes, against the second program (`tests/reference`), whose own
//! error is what half the step changes.

use std::path::Path;

use rayon::prelude::*;
use sprag_reference::effort::Effort;
use sprag_reference::generate::scene;
use sprag_reference::simulate::run_with;
use sprag_sim::simulation::DeviceRun;
use sprag_tests::scene_text::run_in;

const SEED: u64 = 23;
const COUNT: u64 = 300;

/// What rounding may make of a peak in the second program, over α.
const ROUNDING: f64 = 1e-12;

/// Part of the errors that estimates must bound, at least.
const BOUNDED: f64 = 0.99;

/// The scene in `text` as accurately as `level` asks.
fn sprag(text: &str, folder: &Path, level: &str) -> DeviceRun {
    run_in(&format!("{text}\n[accuracy]\nlevel = {level:?}\n"), folder).unwrap()
}

/// What is known of one scene at one level.
struct Look {
    number: u64,
    /// The outcome is the second program's.
    right: bool,
    /// It is reported as certain.
    certain: bool,
    /// Error of the peak over α, less the second program's own, and what it is estimated at; of a block that stands.
    error: Option<(f64, f64)>,
}

impl Look {
    fn words(&self) -> String {
        let Look { number, right, certain, error } = self;
        format!("scene {number}: right {right}, certain {certain}, error and estimate {error:?}")
    }
}

fn looks(number: u64) -> Vec<Look> {
    let generated = scene(SEED, number);
    let folder = tempfile::tempdir().unwrap();
    generated.write_records(folder.path()).unwrap();
    let parsed = sprag_reference::scene::Scene::parse(&generated.text).unwrap();
    let run = |effort: Effort| run_with(&parsed, 0, folder.path(), effort).unwrap();
    let (coarse, fine) = (run(Effort::default()), run(Effort::default().finer()));
    let slenderness = parsed.block.slenderness_deg.to_radians();
    let own = (coarse.peak - fine.peak).abs() / slenderness + ROUNDING;
    let look = |level: &str| {
        let found = sprag(&generated.text, folder.path(), level);
        let estimate = found.error.expect("an error").estimate;
        let error = |peak: f64| ((peak - fine.peak / slenderness).abs() - own, estimate.peak_rotation);
        Look {
            number,
            right: found.outcome.name() == fine.outcome,
            certain: estimate.outcome_certain && coarse.outcome == fine.outcome,
            error: found.peak_rotation.map(error),
        }
    };
    ["fast", "normal", "tight"].map(look).into()
}

#[test]
fn estimates_bound_the_errors_of_real_devices() {
    let scenes: Vec<Vec<Look>> = (0..COUNT).into_par_iter().map(looks).collect();
    let mut failures = Vec::new();
    for (level, name) in ["fast", "normal", "tight"].iter().enumerate() {
        let looks = || scenes.iter().map(|looks| &looks[level]);
        let errors: Vec<(f64, f64)> = looks().filter(|look| look.right).filter_map(|look| look.error).collect();
        let bounded = errors.iter().filter(|(error, estimate)| error <= estimate).count() as f64 / errors.len() as f64;
        let wrong = looks().filter(|look| look.certain && !look.right).count();
        let doubtful = looks().filter(|look| !look.certain).count();
        let largest = errors.iter().fold(0.0_f64, |most, (error, _)| most.max(*error));
        println!(
            "{name}: {} peaks, errors up to {largest:.1e} α, {:.1} % bounded; {doubtful} outcomes in doubt, {wrong} wrong and certain",
            errors.len(),
            100.0 * bounded
        );
        if bounded < BOUNDED || wrong > 0 || 10 * doubtful > COUNT as usize {
            let beyond = |look: &&Look| look.error.is_some_and(|(error, estimate)| error > estimate);
            failures.extend(looks().filter(|look| !look.right || beyond(look)).map(|look| format!("{name}: {}", look.words())));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
