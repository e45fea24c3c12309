//! Cloud analyses by the library: synthetic pulses, and the study of the paper's Section 6 under recorded pulse-like motions.
//!
//! `cargo test -p sprag-tests --test studies cloud -- --nocapture` prints reductions and fragilities beside the paper's. The folder of
//! records is not part of the repository.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use sprag_sim_host::cloud::demand::Demand;
use sprag_sim_host::cloud::figures::{demand_picture, fragility_picture};
use sprag_sim_host::cloud::findings::Findings;
use sprag_sim_host::cloud::pages::{demand_page, fragility_page, ranking_page};
use sprag_sim_host::cloud::records::StudyRecords;
use sprag_sim_host::cloud::runs::Runs;
use sprag_sim_host::cloud::study::Study;
use sprag_sim_host::cloud::typed_tables::{DemandTable, FragilityTable, RankingTable, RunsTable};
use sprag_sim_host::columns::{Table, write_csv};
use sprag_sim_host::interrupt::Interrupt;
use sprag_sim_host::simulation::RunError;
use sprag_sim_host::statistics::Fragility;
use sprag_tests::pulse_records::sine_pulses;

const RECORDS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/records");
const STUDY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/cloud.toml");

fn study(text: &str, records: &Path) -> Study {
    Study::parse(text, "study.toml", Path::new(""), &[], &[PathBuf::from(records)]).unwrap()
}

fn run(study: &Study) -> (StudyRecords, Runs, Findings) {
    let records = StudyRecords::read(study).unwrap();
    let runs = Runs::of(study, &records.records, &Interrupt::default(), |_| (), &|| ()).unwrap();
    let findings = Findings::of(study, &runs).unwrap();
    (records, runs, findings)
}

/// Everything that a study writes.
fn written(study: &Study, (records, runs, findings): &(StudyRecords, Runs, Findings)) -> Vec<u8> {
    let mut bytes = Vec::new();
    let runs = RunsTable { study, records: &records.records, runs: &runs.all };
    let tables: [&dyn Table; 4] = [&runs, &DemandTable(findings), &FragilityTable(findings), &RankingTable(findings)];
    for table in tables {
        write_csv(table, &mut bytes).unwrap();
    }
    for page in [demand_page(study, findings), fragility_page(study, findings), ranking_page(study, findings)] {
        bytes.extend(page.into_bytes());
    }
    for picture in [demand_picture(study, findings).unwrap(), fragility_picture(study, findings).unwrap()] {
        bytes.extend(picture.unwrap_or_default().into_bytes());
    }
    bytes
}

#[test]
fn results_have_the_same_bytes_for_every_number_of_threads() {
    let folder = sine_pulses(&[0.15, 0.3, 0.45, 0.6], &[0.5, 0.9, 1.4]);
    let text = "scale = [1.0, 1.7]\n[[structure]]\nname = 'small'\nset = { 'block.size_m' = 1.0 }\n[bootstrap]\nresamples = 100";
    let study = study(text, folder.path());
    let by = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| written(&study, &run(&study)))
    };
    let one = by(1);
    assert!(one.len() > 10_000 && one == by(3));
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
    let page = fragility_page(&study, &results.2);
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

/// The unscaled pulse-like horizontal motions of earthquakes of the paper's Table 1, each counted once, as entries of a study.
fn pulse_like(index: &str) -> Vec<String> {
    let mut lines = index.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split('\t').collect();
    let column = |name: &str| header.iter().position(|title| *title == name).unwrap_or_else(|| panic!("column {name}"));
    let (file, rsn, component, step) = (column("file"), column("RSN"), column("component"), column("dt_s"));
    let (table1, baker, fema) = (column("table1_event"), column("pulse_baker2007"), column("fema_p695"));
    let (shahi, format, scaled) = (column("pulse_shahi_baker_unverified"), column("format"), column("scaled"));
    let mut counted = BTreeSet::new();
    let mut entries = Vec::new();
    for field in lines.map(|line| line.split('\t').collect::<Vec<&str>>()) {
        let pulse = field[baker] == "yes" || field[shahi] == "yes" || field[fema] == "NF-pulse";
        let horizontal = !field[component].to_ascii_uppercase().contains(['U', 'V']);
        let identity =
            if field[rsn].is_empty() { field[file].to_owned() } else { format!("{} {}", field[rsn], field[component]) };
        if pulse && horizontal && field[table1] == "yes" && field[scaled] == "no" && counted.insert(identity) {
            let path = Path::new(RECORDS).join(field[file]);
            let known = match field[format] {
                "g3" => format!(", units = 'g', time_step_s = {}", field[step]),
                _ => String::new(),
            };
            entries.push(format!("{{ file = '{}'{known} }}", path.display()));
        }
    }
    entries
}

#[test]
fn the_study_of_the_paper_under_recorded_motions() {
    let Ok(index) = std::fs::read_to_string(Path::new(RECORDS).join("INDEX.tsv")) else {
        eprintln!("SKIPPED: the folder of recorded motions is absent; the study of the paper's Section 6 was not run");
        return;
    };
    let text = std::fs::read_to_string(STUDY).unwrap();
    let (keys, tables) = text.split_at(text.find("[[structure]]").unwrap());
    let text = format!("{keys}records = [{}]\n{tables}", pulse_like(&index).join(", "));
    let folder = Path::new(STUDY).parent().unwrap();
    let study = Study::parse(&text, "cloud.toml", folder, &[], &[]).unwrap();
    let (records, runs, findings) = run(&study);
    assert!(records.unreadable.is_empty() && runs.left_out.is_empty(), "{:?} {:?}", records.unreadable, runs.left_out);
    eprintln!("{} pulse-like motions (the paper: 202)", records.records.len());

    let percent = |ratio: f64| 100.0 * (1.0 - ratio);
    for ratio in &findings.demand_ratios {
        let (medians, pairs) = (ratio.medians.unwrap(), ratio.pairs.unwrap());
        let paper = match (ratio.demand, ratio.device.as_str()) {
            (Demand::PeakRotation, "inerter") => "30 %",
            (Demand::PeakRotation, _) => "55 %",
            (Demand::PeakAcceleration, "inerter") => "25 %",
            (Demand::PeakAcceleration, _) => "less than with the inerter",
        };
        eprintln!(
            "{}, {}: reduction {:.0} % of the medians, {:.0} % over {} pairs (the paper: {paper})",
            ratio.device,
            ratio.demand.name(),
            percent(medians.middle),
            percent(pairs.median),
            ratio.number_of_pairs
        );
        if ratio.demand == Demand::PeakRotation {
            assert!(medians.middle < 0.95 && pairs.median < 0.95, "{ratio:?}");
        }
    }
    let [inerter, pair] = [0, 1].map(|device| findings.demand_ratios[device].medians.unwrap().middle);
    assert!(pair < inerter, "the clutch reduces rotations further: {pair} {inerter}");

    // The paper's numbers are called the mean IM; by size they are medians e^μ.
    for found in &findings.fragility {
        let paper = match (found.structure.ends_with("0.5"), found.device.as_str()) {
            (_, "none") => "1.08",
            (true, "inerter") => "1.22",
            (true, _) => "1.34",
            (false, _) => "in its Figure 16b",
        };
        let overturned = format!("{}, {}: {} of {} overturned", found.structure, found.device, found.overturned, found.runs);
        match found.fragility.curve() {
            Some(curve) => eprintln!(
                "{overturned}, median {:.2} (the paper: {paper}), μ = {:.3} ± {:.3}, β = {:.3} ± {:.3}",
                curve.median, curve.mu, curve.mu_standard_error, curve.beta, curve.beta_standard_error
            ),
            None => eprintln!("{overturned}: {}", found.reason.as_deref().unwrap_or_default()),
        }
    }
    let unprotected = &findings.fragility[0];
    assert!(unprotected.fragility.curve().is_some(), "{:?}", unprotected.fragility);
    assert!(findings.fragility.iter().all(|found| found.overturned <= unprotected.overturned));
}
