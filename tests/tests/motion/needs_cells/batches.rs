//! The reference cells through the lanes of a batch, against the core.

use sprag_loops::{Method, Precision};
use sprag_sim::batch::case::{Case, TIGHT};
use sprag_sim::batch::lanes::{in_lanes, results};
use sprag_tests::reference::cells;
use sprag_tests::relative;

#[test]
#[ignore = "needs the reference cells beside the repository: run by cargo xtask test"]
fn every_cell_in_lanes() {
    let cells = cells();
    let cases: Vec<Case> = cells.iter().map(|cell| cell.case).collect();
    let method = f64::ideal(Method::Adaptive(TIGHT));
    let mut worst: [f64; 2] = [0.0; 2];
    for (cell, found) in cells.iter().zip(results(&cases, TIGHT)) {
        let (found, core, id) = (found.unwrap(), cell.case.run(&*method).unwrap(), &cell.id);
        assert_eq!(found.outcome.name(), cell.outcome, "cell {id}");
        assert_eq!((found.outcome, found.impacts), (core.outcome, core.impacts), "cell {id}");
        assert_eq!(found.first_impact_time.is_some(), core.first_impact_time.is_some(), "cell {id}");
        let first = found.first_impact_time.zip(core.first_impact_time).map_or(0.0, |(found, core)| relative(found, core));
        for (worst, error) in worst.iter_mut().zip([first, relative(found.end_time, core.end_time)]) {
            assert!(error < 1e-9, "cell {id}: {found:?} {core:?}");
            *worst = worst.max(error);
        }
        for (found, exact) in [(found.peak_rotation, cell.peak_rotation), (found.peak_acceleration, cell.peak_acceleration)] {
            assert!(exact.is_none_or(|exact| relative(found, exact) < 1e-9), "cell {id}: {found} {exact:?}");
        }
    }
    let left = in_lanes(&cases).iter().filter(|found| found.is_none()).count();
    let [first, end] = worst;
    println!("first impacts to {first:.1e}, ends to {end:.1e} of the core's; {left} cells are left to it");
    assert!(left < 200, "{left}");
}
