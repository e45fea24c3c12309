//! Cloud analyses by the library, under synthetic pulses.

use std::path::{Path, PathBuf};

use sprag_sim::interrupt::Interrupt;
use sprag_sim::simulation::RunError;
use sprag_studies::cloud::figures::fragility_picture;
use sprag_studies::cloud::findings::Findings;
use sprag_studies::cloud::pages::fragility_page;
use sprag_studies::cloud::records::StudyRecords;
use sprag_studies::cloud::runs::Runs;
use sprag_studies::cloud::study::Study;
use sprag_studies::statistics::Fragility;
use sprag_tests::pulse_records::sine_pulses;

fn study(text: &str, records: &Path) -> Study {
    Study::parse(text, "study.toml", Path::new(""), &[], &[PathBuf::from(records)]).unwrap()
}

/// What a study reads, does and finds.
pub fn run(study: &Study) -> (StudyRecords, Runs, Findings) {
    let records = StudyRecords::read(study).unwrap();
    let runs = Runs::of(study, &records.records, &Interrupt::default(), |_| (), &|| ()).unwrap();
    let findings = Findings::of(study, &runs, &Interrupt::default()).unwrap();
    (records, runs, findings)
}

#[test]
fn runs_are_in_order_and_counted_once() {
    let folder = sine_pulses(&[0.1, 0.4, 0.8], &[0.6, 1.2]);
    let study = study("scale = [1.0, 2.0]", folder.path());
    let (records, runs, findings) = run(&study);
    assert_eq!((records.records.len(), runs.all.len()), (6, 6 * 2 * 3));
    let order: Vec<_> = runs.all.iter().map(|run| (run.structure, run.record, run.factor.to_bits(), run.device)).collect();
    assert!(order.is_sorted());
    for outcomes in &findings.outcomes {
        let sum = outcomes.no_rocking
            + outcomes.safe
            + outcomes.overturned_without_impact
            + outcomes.overturned_after_impact
            + outcomes.failed;
        assert_eq!((outcomes.runs, sum), (12, 12));
        assert!(outcomes.no_rocking > 0 && outcomes.failed == 0);
    }
    for model in &findings.demand {
        let left_out = model.left_out;
        let all = left_out.no_rocking + left_out.overturned + left_out.zero + left_out.failed;
        assert_eq!(model.points.len() + all, 12);
    }
}

#[test]
fn a_set_in_which_nothing_overturns_says_so() {
    let folder = sine_pulses(&[0.2, 0.25, 0.3], &[0.3, 0.4]);
    let study = study("title = 'Weak pulses'", folder.path());
    let results = run(&study);
    assert!(results.2.fragility.iter().all(|found| matches!(found.fragility, Fragility::NeverOverturned { number: 6, .. })));
    let page = fragility_page(&study, &results.2).unwrap();
    assert!(page.contains("no curve; none of 6 runs overturned"), "{page}");
    let picture = fragility_picture(&study, &results.2).unwrap().unwrap();
    assert!(picture.contains("clutched pair: never overturned"));
    // Demands are there all the same.
    assert!(results.2.demand.iter().all(|model| model.law.is_some()));
}

#[test]
fn stripes_have_the_level_that_was_asked_for() {
    let folder = sine_pulses(&[0.2, 0.4], &[0.5, 1.0]);
    let study = study("[stripes]\nmeasure = 'pgv'\nlevels = [0.5, 1.0, 1.5, 2.0, 4.0]", folder.path());
    let (_, runs, findings) = run(&study);
    assert_eq!((runs.all.len(), runs.left_out.len()), (4 * 5 * 3, 0));
    for run in &runs.all {
        let found = run.measure(study.file.fragility.measure);
        assert!((found / run.level.unwrap() - 1.0).abs() < 1e-12, "{found} {:?}", run.level);
    }
    assert!(findings.outcomes.iter().all(|outcomes| outcomes.runs == 20));
}

#[test]
fn an_interrupted_study_has_no_results() {
    let folder = sine_pulses(&[0.4], &[0.5, 1.0]);
    let study = study("", folder.path());
    let records = StudyRecords::read(&study).unwrap();
    let interrupt = Interrupt::default();
    let stopped = Runs::of(&study, &records.records, &interrupt, |_| (), &|| interrupt.set());
    assert!(matches!(stopped, Err(RunError::Interrupted)));
}
