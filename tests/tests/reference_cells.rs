//! The 1,260 reference cells, computed independently in 113-bit arithmetic.

use sprag_shared::taylor::Taylor;
use sprag_sim_host::batch::case::{Case, CaseResult, TERMS, TIGHT};
use sprag_tests::reference::cells;

/// Limits of the relative error: median, 95th percentile and maximum.
const LIMITS: [f64; 3] = [1e-13, 1e-11, 1e-6];

/// Relative errors and the cells that they belong to.
#[derive(Default)]
struct Errors(Vec<(f64, String)>);

impl Errors {
    fn add(&mut self, found: f64, exact: f64, id: &str) {
        self.0.push(((found / exact - 1.0).abs(), id.to_owned()));
    }

    /// Median, 95th percentile, maximum, and the cell of the last.
    fn figures(&mut self) -> ([f64; 3], &str) {
        assert!(self.0.iter().all(|(error, _)| error.is_finite()));
        self.0.sort_by(|a, b| a.0.total_cmp(&b.0));
        let at = |share: f64| self.0[((share * self.0.len() as f64) as usize).min(self.0.len() - 1)].0;
        ([at(0.5), at(0.95), at(1.0)], &self.0[self.0.len() - 1].1)
    }
}

#[test]
fn every_cell() {
    let Some(cells) = cells() else { return };
    let method = Taylor::<f64, TERMS>::adaptive(TIGHT);
    let (mut rotation, mut acceleration, mut impact) = (Errors::default(), Errors::default(), Errors::default());
    let mut wrong = Vec::new();
    for answer in &cells {
        let (id, case) = (&answer.id, &answer.case);
        let result = case.run(&method).expect("a case that can be run");
        if result.outcome.name() != answer.outcome || result.first_impact_time.is_some() != answer.first_impact_time.is_some() {
            wrong.push((id.clone(), result.outcome.name(), answer.outcome.clone()));
            continue;
        }
        if let Some(exact) = answer.peak_rotation {
            rotation.add(result.peak_rotation, exact, id);
        }
        if let Some(exact) = answer.peak_acceleration {
            acceleration.add(result.peak_acceleration, exact, id);
        }
        if let (Some(exact), Some(found)) = (answer.first_impact_time, result.first_impact_time) {
            impact.add(found, exact, id);
        }
        ends_as_it_should(case, &result, id);
    }
    assert!(wrong.is_empty(), "{} wrong outcomes: {wrong:?}", wrong.len());
    for (name, errors, count) in
        [("peak rotation", &mut rotation, 709), ("peak acceleration", &mut acceleration, 709), ("first impact", &mut impact, 937)]
    {
        assert_eq!(errors.0.len(), count, "cells with a {name}");
        let (figures, worst) = errors.figures();
        let [p50, p95, maximum] = figures;
        println!("{name}: p50 {p50:.1e}, p95 {p95:.1e}, max {maximum:.1e} (cell {worst})");
        for (figure, limit) in figures.into_iter().zip(LIMITS) {
            assert!(figure <= limit, "{name}: {figure:e} is above {limit:e}");
        }
    }
}

/// What any result must satisfy, whatever the numbers.
fn ends_as_it_should(case: &Case, result: &CaseResult, id: &str) {
    let last = core::f64::consts::TAU / case.frequency_ratio + case.free_time;
    assert!(result.end_time > 0.0 && result.end_time <= last * (1.0 + 1e-15), "cell {id} ends at {}", result.end_time);
    assert!(result.first_impact_time.is_none_or(|time| time > 0.0 && time < result.end_time), "cell {id}");
    assert_eq!(result.impacts > 0, result.first_impact_time.is_some(), "cell {id}");
}
