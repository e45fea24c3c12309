//! Bytes of any kind as a case table: reading may fail with one line, but never panic, and every case that it gives has a
//! finite result, the same each time, or one line that says why not.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sprag_shared::method::taylor::{TERMS, Taylor};
use sprag_sim::batch::case::{Case, CaseResult, TIGHT};
use sprag_sim::batch::table::read_cases;

/// Cases of one table that are run.
const MOST_CASES: usize = 3;

/// 1/p; a block that loses next to nothing rocks on for as long as it is asked to, …
const LONGEST_FREE_TIME: f64 = 100.0;

/// … and one that loses nothing in millions of impacts where the first motion was small.
const LARGEST_RESTITUTION: f64 = 0.999;

fuzz_target!(|input: &[u8]| {
    let cases = match read_cases(input) {
        Ok(cases) => cases,
        Err(error) => return one_line(&error.to_string()),
    };
    let method = Taylor::<f64, TERMS>::adaptive(TIGHT);
    for (id, case) in cases.into_iter().take(MOST_CASES) {
        let (free_time, restitution) = (case.free_time.min(LONGEST_FREE_TIME), case.restitution.min(LARGEST_RESTITUTION));
        let case = Case { free_time, restitution, ..case };
        let (first, again) = (case.run(&method), case.run(&method));
        match (first, again) {
            (Ok(first), Ok(again)) => {
                check(&case, &first);
                assert_eq!(first, again, "a second run of `{id}` differs");
            }
            (Err(first), Err(again)) => {
                assert_eq!(first, again);
                one_line(&first.to_string());
            }
            (first, again) => panic!("{first:?}, and then {again:?}"),
        }
    }
});

fn one_line(message: &str) {
    assert!(!message.contains('\n'), "an error of several lines: {message}");
}

fn check(case: &Case, result: &CaseResult) {
    let numbers = [result.peak_rotation, result.peak_acceleration, result.end_time];
    assert!(numbers.iter().all(|number| number.is_finite() && *number >= 0.0), "{case:?}: {result:?}");
    let end = core::f64::consts::TAU / case.frequency_ratio + case.free_time;
    assert!(result.end_time <= end * (1.0 + 1e-12), "{case:?} ended at {}, after {end}", result.end_time);
    if let Some(time) = result.first_impact_time {
        assert!((0.0..=end * (1.0 + 1e-12)).contains(&time), "{case:?}: {result:?}");
    }
}
