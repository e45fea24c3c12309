//! The study of the paper's Section 6 under recorded pulse-like motions.
//!
//! `cargo test -p sprag-tests --test studies cloud -- --ignored --nocapture` prints reductions and fragilities beside the paper's.

use std::path::Path;

use sprag_studies::cloud::demand::Demand;
use sprag_studies::cloud::study::Study;
use sprag_tests::records::{RecordedMotion, recorded_motions};

use crate::cloud::run;

const STUDY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/cloud.toml");

/// A motion as an entry of a study.
fn entry(motion: &RecordedMotion) -> String {
    let unsaid = motion
        .unsaid_units()
        .map_or_else(String::new, |units| format!(", units = '{units}', time_step_s = {:?}", motion.time_step_s));
    format!("{{ file = '{}'{unsaid} }}", motion.path.display())
}

#[test]
#[ignore = "needs the recorded motions beside the repository: run by cargo xtask test"]
fn the_study_of_the_paper_under_recorded_motions() {
    let motions: Vec<String> = recorded_motions().iter().filter(|motion| motion.pulse_like).map(entry).collect();
    let text = std::fs::read_to_string(STUDY).unwrap();
    let (keys, tables) = text.split_at(text.find("[[structure]]").unwrap());
    let text = format!("{keys}records = [{}]\n{tables}", motions.join(", "));
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
