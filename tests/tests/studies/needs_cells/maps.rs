//! Blocks in lanes, of which overturning maps are made, against the reference cells.

use sprag_ensemble::machine::{Registers, run};
use sprag_ensemble::pulsed::PulsedBlock;
use sprag_tests::reference::{RelativeErrors, cells};

/// Blocks in lanes, whose free motions are settled by their first integral, are as right as the core.
#[test]
#[ignore = "needs the reference cells beside the repository: run by cargo xtask test"]
fn reference_cells_in_lanes() {
    let cells = cells();
    let pulsed: Vec<PulsedBlock> = cells.iter().map(|cell| PulsedBlock::from(&cell.case)).collect();
    let results = run(&pulsed, Registers::Widest).expect("cases that can be run");
    let (mut rotation, mut acceleration) = (RelativeErrors::default(), RelativeErrors::default());
    let mut wrong = Vec::new();
    for (cell, result) in cells.iter().zip(&results) {
        if result.outcome.name() != cell.outcome {
            wrong.push((cell.id.clone(), result.outcome.name(), cell.outcome.clone()));
            continue;
        }
        if let Some(exact) = cell.peak_rotation {
            rotation.add(result.peak_rotation, exact, &cell.id);
        }
        if let Some(exact) = cell.peak_acceleration {
            acceleration.add(result.peak_acceleration, exact, &cell.id);
        }
    }
    assert!(wrong.is_empty(), "{} wrong outcomes: {wrong:?}", wrong.len());
    rotation.hold("peak rotation", 709);
    acceleration.hold("peak acceleration", 709);
}
