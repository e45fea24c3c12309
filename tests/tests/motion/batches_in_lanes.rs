//! A batch's lanes against the core: outcomes, peaks, impacts and times, whatever stands beside a case.

use sprag_loops::{Method, Precision};
use sprag_shared::structure::device::DeviceKind;
use sprag_sim::batch::case::{Case, CaseResult, PulseShape, TIGHT};
use sprag_sim::batch::lanes::{in_lanes, results};
use sprag_tests::{Dice, GEOMETRIES, relative};

/// Cases of all kinds, the same on every machine, that move freely for up to `longest` (1/p).
fn cases(count: usize, longest: f64) -> Vec<Case> {
    let mut dice = Dice(1 + longest as u64);
    let one = |index: usize, dice: &mut Dice| Case {
        geometry: GEOMETRIES[index % 2],
        slenderness: dice.between(1.0, 45.0).to_radians(),
        device: DeviceKind::ALL[index % 3],
        mass_ratio: dice.between(0.0, if index.is_multiple_of(10) { 20.0 } else { 2.0 }),
        restitution: match index % 20 {
            7 => 0.0,
            13 => 1.0,
            _ => dice.between(0.3, 1.0),
        },
        pulse: if index % 4 < 2 { PulseShape::Sine } else { PulseShape::Cosine },
        frequency_ratio: dice.between(0.2, 8.0),
        amplitude_ratio: dice.between(0.9, 10.0) * if index.is_multiple_of(9) { -1.0 } else { 1.0 },
        free_time: dice.between(0.0, longest),
        ..Case::default()
    };
    (0..count).map(|index| one(index, &mut dice)).collect()
}

fn same(found: &CaseResult, core: &CaseResult, case: &Case) {
    assert_eq!((found.outcome, found.impacts), (core.outcome, core.impacts), "{case:?}: {found:?} {core:?}");
    assert_eq!(found.first_impact_time.is_some(), core.first_impact_time.is_some(), "{case:?}");
    let near = |a: f64, b: f64| a == b || relative(a, b) < 1e-9;
    assert!(near(found.end_time, core.end_time), "{case:?}: ends at {} or {}", found.end_time, core.end_time);
    if let (Some(found), Some(core)) = (found.first_impact_time, core.first_impact_time) {
        assert!(near(found, core), "{case:?}: first impact at {found} or {core}");
    }
    if !core.outcome.overturned() {
        assert!(near(found.peak_rotation, core.peak_rotation), "{case:?}: {found:?} {core:?}");
        assert!(near(found.peak_acceleration, core.peak_acceleration), "{case:?}: {found:?} {core:?}");
    }
}

#[test]
fn the_lanes_and_the_core_agree_on_impacts_and_times() {
    let method = f64::ideal(Method::Adaptive(TIGHT));
    // Of long free times few are left to the core; of short ones all that end before the largest rotation.
    for (longest, most_left) in [(60.0, 0.1), (5.0, 0.5), (0.0, 1.0)] {
        let cases = cases(6_000, longest);
        let (mut left, mut seen) = (0, [0; 4]);
        for (case, found) in cases.iter().zip(in_lanes(&cases)) {
            match found {
                Some(found) => {
                    same(&found, &case.run(&*method).expect("a case that can be run"), case);
                    seen[found.outcome as usize] += 1;
                }
                None => left += 1,
            }
        }
        println!("free times up to {longest}: {left} of {} are left to the core", cases.len());
        assert!(f64::from(left) <= most_left * cases.len() as f64, "{left}");
        assert!(longest < 50.0 || seen.iter().all(|&count| count > 50), "{seen:?}");
    }
}

#[test]
fn what_stands_beside_a_case_does_not_show() {
    let cases = cases(1_200, 30.0);
    let bits = |result: &CaseResult| {
        let CaseResult { outcome, peak_rotation, peak_acceleration, impacts, first_impact_time, end_time } = *result;
        let numbers = [peak_rotation, peak_acceleration, first_impact_time.unwrap_or(-1.0), end_time];
        (outcome, impacts, numbers.map(|number| if number.is_nan() { 0 } else { number.to_bits() }))
    };
    let all = |cases: &[Case]| -> Vec<_> { results(cases, TIGHT).iter().map(|result| bits(result.as_ref().unwrap())).collect() };
    let together = all(&cases);
    let turned: Vec<Case> = cases.iter().rev().copied().collect();
    assert!(all(&turned).iter().rev().eq(&together));
    let alone: Vec<_> = cases.iter().flat_map(|case| all(std::slice::from_ref(case))).collect();
    assert!(alone == together);
    let parts: Vec<_> = cases.chunks(37).flat_map(all).collect();
    assert!(parts == together);
}

/// A block that comes within rounding of its tip, or whose free time ends with an event, is left to the core, which decides; its neighbours are not.
#[test]
fn what_rounding_decides_is_the_cores() {
    let method = f64::ideal(Method::Adaptive(TIGHT));
    let case = Case { frequency_ratio: 3.0, amplitude_ratio: 1.3, ..Case::default() };
    let whole = case.run(&*method).unwrap();
    let pulse = core::f64::consts::TAU / case.frequency_ratio;
    let until = |end: f64| Case { free_time: end - pulse, ..case };
    for (end, left) in [(whole.end_time, true), (whole.end_time * (1.0 + 1e-7), false), (whole.end_time * (1.0 - 1e-3), false)] {
        assert_eq!(in_lanes(&[until(end)])[0].is_none(), left, "{end}");
        same(&results(&[until(end)], TIGHT)[0].unwrap(), &until(end).run(&*method).unwrap(), &until(end));
    }
    // Between an amplitude that stands and one that overturns.
    let at = |amplitude_ratio: f64| Case { amplitude_ratio, ..case };
    let (mut stands, mut falls) = (1.3, 2.0);
    while falls - stands > 1e-12 {
        let middle = 0.5 * (stands + falls);
        *if at(middle).run(&*method).unwrap().outcome.overturned() { &mut falls } else { &mut stands } = middle;
    }
    for (amplitude, left) in [(stands, true), (falls, true), (stands - 1e-3, false), (falls + 1e-3, false)] {
        assert_eq!(in_lanes(&[at(amplitude)])[0].is_none(), left, "{amplitude}");
        same(&results(&[at(amplitude)], TIGHT)[0].unwrap(), &at(amplitude).run(&*method).unwrap(), &at(amplitude));
    }
}
