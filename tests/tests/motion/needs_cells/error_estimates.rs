//! Whether errors that are reported are true, over the reference cells.

use sprag_sim::accuracy::Accuracy;
use sprag_sim::batch::case::CaseResult;
use sprag_tests::reference::{Cell, cells};

/// Part of the errors that an estimate must bound, at least.
const BOUNDED: f64 = 0.99;

/// How much larger than the error an estimate may be at the median.
const FACTOR: f64 = 30.0;

/// A rounding of the result itself, which no estimate can be blamed for: the tables hold more digits than an f64.
const ROUNDING: f64 = f64::EPSILON;

/// Estimates over the errors that they are of.
#[derive(Default)]
struct Ratios(Vec<f64>);

impl Ratios {
    fn add(&mut self, found: f64, exact: f64, estimate: f64) {
        self.0.push(estimate / ((found - exact).abs()).max(ROUNDING * exact.abs()));
    }

    /// The part that is bounded, and the median ratio.
    fn figures(&mut self) -> (f64, f64) {
        self.0.sort_by(f64::total_cmp);
        let bounded = self.0.iter().filter(|ratio| **ratio >= 1.0).count() as f64 / self.0.len() as f64;
        (bounded, self.0[self.0.len() / 2])
    }
}

#[test]
#[ignore = "needs the reference cells beside the repository: run by cargo xtask test"]
fn estimates_bound_the_errors_and_are_near_them() {
    let cells = cells();
    let mut failures = Vec::new();
    for accuracy in [
        Accuracy::Fast,
        Accuracy::Normal,
        Accuracy::Tight,
        Accuracy::Error(1e-3),
        Accuracy::Error(1e-6),
        Accuracy::Error(1e-9),
        Accuracy::Error(1e-12),
    ] {
        let (mut rotation, mut acceleration, mut impact) = (Ratios::default(), Ratios::default(), Ratios::default());
        let (mut wrong, mut doubtful, mut unknown, mut missed) = (0, 0, 0, 0);
        let mut errors: Vec<f64> = Vec::new();
        let begin = std::time::Instant::now();
        for cell in &cells {
            let Cell { case, .. } = cell;
            let found = case.answer(accuracy).expect("a case that can be run");
            let CaseResult { outcome, peak_rotation, peak_acceleration, first_impact_time, .. } = found.result;
            doubtful += usize::from(!found.error.outcome_certain);
            if outcome.name() != cell.outcome {
                wrong += 1;
                unknown += usize::from(found.error.outcome_certain);
                continue;
            }
            if let Some(exact) = cell.peak_rotation {
                rotation.add(peak_rotation, exact, found.error.peak_rotation);
                errors.push((peak_rotation / exact - 1.0).abs());
                if let Accuracy::Error(wanted) = accuracy {
                    missed += usize::from((peak_rotation / exact - 1.0).abs() > wanted && found.as_wanted);
                }
            }
            if let Some(exact) = cell.peak_acceleration {
                acceleration.add(peak_acceleration, exact, found.error.peak_acceleration);
            }
            if let (Some(exact), Some(found_time)) = (cell.first_impact_time, first_impact_time) {
                impact.add(found_time, exact, found.error.first_impact_time);
            }
        }
        let nanoseconds = begin.elapsed().as_secs_f64() / 1260.0 * 1e9;
        errors.sort_by(f64::total_cmp);
        let at = |share: usize| errors[(errors.len() * share / 100).min(errors.len() - 1)];
        println!(
            "{accuracy}: wrong outcomes {wrong} (certain: {unknown}), doubtful {doubtful}, above the error asked for {missed}; errors p50 {:.1e} p95 {:.1e} max {:.1e}; {nanoseconds:.0} ns",
            at(50),
            at(95),
            at(100)
        );
        for (name, ratios) in
            [("peak rotation", &mut rotation), ("peak acceleration", &mut acceleration), ("first impact", &mut impact)]
        {
            let (bounded, median) = ratios.figures();
            println!("    {name}: bounds {:.2} %, {median:.1} times the error at the median", 100.0 * bounded);
            if bounded < BOUNDED || median > FACTOR {
                failures.push(format!("{accuracy}, {name}: bounds {bounded}, median {median}"));
            }
        }
        if unknown > 0 || missed * 100 > cells.len() {
            failures
                .push(format!("{accuracy}: {unknown} wrong outcomes taken for certain, {missed} errors above the one asked for"));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
