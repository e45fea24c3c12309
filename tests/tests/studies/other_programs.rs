//! Overturning amplitudes of a program that shares nothing with this one, and its definition of overturning.

use sprag_report::progress::Progress;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::map::boundaries::{Boundary, EVALUATIONS};
use sprag_sim::map::cell::results_at;
use sprag_sim::map::grid::Grid;
use sprag_sim::scene::{Scene, document};
use sprag_studies::map::boundaries::refine;
use sprag_studies::map::study::study;

/// R (m), and where the first overturning amplitude a_g/(g tan α) of the full block with α = 0.2 and η = 1 − 1.5 sin²α lies under one sine
/// of 0.5 s, g = 9.80665 m/s². From github.com/Numerics-in-Motion/blocks, `under-this-pulse/data/transitions.csv`: DOP853 at two
/// tolerances, and two audits of its events.
const BRACKETS: [(f64, f64, f64); 4] = [
    (0.25, 1.261_884_8, 1.261_894_5),
    (0.5, 1.458_437_5, 1.458_447_3),
    (1.0, 2.163_779_3, 2.163_789_1),
    (2.0, 5.154_921_9, 5.154_931_6),
];

/// A size that no amplitude up to [`LARGEST`] overturns there.
const STANDS: f64 = 4.0;
const LARGEST: f64 = 6.0;

/// Amplitudes of the block of size `size` (m) under that sine, with `changes` after it.
fn amplitudes(size: f64, changes: &str) -> Grid {
    let slenderness = 0.2_f64.to_degrees();
    let text = format!(
        "block = {{ size_m = {size}, slenderness_deg = {slenderness:?}, restitution = 'geometric' }}
         device = [{{ kind = 'none' }}]
         ground = [{{ motion = 'sine', amplitude_ratio = 1.0, frequency_hz = 2.0 }}]
         map.x = {{ key = 'ground.0.amplitude_ratio', from = 1.01, to = {LARGEST}, cells = 500 }}
         {changes}"
    );
    let table = document::table(&text, "scene").expect("TOML");
    Grid::new(Scene::parse(&text, "scene").expect("a scene"), table).expect("an axis")
}

/// Amplitudes from which on the block overturns, after amplitudes at which it stands.
fn first_overturning(grid: &Grid) -> Vec<f64> {
    let (progress, interrupt) = (Progress::new("blocks"), Interrupt::default());
    let map = study(grid, &progress, &interrupt).expect("a map").remove(0);
    let outcomes: Vec<Outcome> = map.shown.iter().map(|result| result.outcome).collect();
    let found = refine(grid, 0, &outcomes, EVALUATIONS, &progress, &interrupt).expect("boundaries");
    assert_eq!(found.unresolved, 0);
    let begins = |boundary: &&Boundary| !boundary.left.overturned() && boundary.right.overturned();
    found.boundaries.iter().filter(begins).map(|boundary| boundary.vertices[0].0).collect()
}

const SLENDERNESS: &str = "map.overturned_at = 'slenderness'";

/// As soon as |θ| reaches α, which is its definition, a block has one transition; where it cannot come back the first one is the same.
#[test]
fn first_overturning_amplitudes_lie_in_the_brackets_of_another_program() {
    for (size, low, high) in BRACKETS {
        let [at_slenderness] = first_overturning(&amplitudes(size, SLENDERNESS))[..] else {
            panic!("R = {size} m: one transition")
        };
        let no_return = first_overturning(&amplitudes(size, ""))[0];
        println!("R = {size} m: {at_slenderness:.8} and {no_return:.8} in {low} to {high}");
        for found in [at_slenderness, no_return] {
            assert!((low..high).contains(&found), "R = {size} m: {found}");
        }
    }
    for changes in ["", SLENDERNESS] {
        assert!(first_overturning(&amplitudes(STANDS, changes)).is_empty());
    }
}

/// Blocks that pass α and that the pulse brings back: in the lanes, scene by scene, and as devices with a memory are.
#[test]
fn blocks_that_pass_their_slenderness_and_come_back_are_overturned_by_one_definition() {
    for (size, amplitudes_found, peaks) in [(0.25, [2.705, 2.715], 1.54..1.58), (0.5, [3.985, 4.065], 1.44..1.51)] {
        // A tolerance of its own takes a scene out of the lanes, and any vertical ground motion asks for the integrator of devices.
        for slow in [
            "",
            "accuracy.level = 'tight'\nrun.free_time_ratio = 60.0",
            "vertical = [{ motion = 'sine', amplitude_g = 1e-9, frequency_hz = 2.0 }]\nrun.free_time_ratio = 60.0",
        ] {
            let results = |changes: &str| {
                let grid = amplitudes(size, &format!("{changes}\n{slow}"));
                results_at(&grid, 0, &amplitudes_found.map(|amplitude| (amplitude, None)), &Interrupt::default()).expect("blocks")
            };
            for (comes_back, overturned) in results("").iter().zip(results(SLENDERNESS)) {
                assert!(
                    comes_back.outcome == Outcome::Safe && peaks.contains(&comes_back.peak_rotation),
                    "{size}: {comes_back:?}"
                );
                assert!(overturned.outcome.overturned() && overturned.peak_rotation.is_nan(), "{size}: {overturned:?}");
            }
        }
    }
}
