//! The 1,260 reference cells, computed independently in 113-bit arithmetic.

use sprag_loops::{Method, Precision};
use sprag_sim::batch::case::{Case, CaseResult, TIGHT};
use sprag_tests::reference::{RelativeErrors, cells};

#[test]
#[ignore = "needs the reference cells beside the repository: run by cargo xtask test"]
fn every_cell() {
    let cells = cells();
    let method = f64::ideal(Method::Adaptive(TIGHT));
    let (mut rotation, mut acceleration, mut impact) =
        (RelativeErrors::default(), RelativeErrors::default(), RelativeErrors::default());
    let mut wrong = Vec::new();
    for answer in &cells {
        let (id, case) = (&answer.id, &answer.case);
        let result = case.run(&*method).expect("a case that can be run");
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
        errors.hold(name, count);
    }
}

/// What any result must satisfy, whatever the numbers.
fn ends_as_it_should(case: &Case, result: &CaseResult, id: &str) {
    let last = core::f64::consts::TAU / case.frequency_ratio + case.free_time;
    assert!(result.end_time > 0.0 && result.end_time <= last * (1.0 + 1e-15), "cell {id} ends at {}", result.end_time);
    assert!(result.first_impact_time.is_none_or(|time| time > 0.0 && time < result.end_time), "cell {id}");
    assert_eq!(result.impacts > 0, result.first_impact_time.is_some(), "cell {id}");
}
