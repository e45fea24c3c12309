//! Boundaries of maps: against closed forms, and every vertex against the blocks on either side of it.

use std::f64::consts::{PI, TAU};

use sprag_report::columns::write_csv;
use sprag_report::progress::Progress;
use sprag_shared::math::{asin, exp, ln, square_root};
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::map::boundaries::{Boundaries, Boundary, EVALUATIONS, TOLERANCE};
use sprag_sim::map::cell::results_at;
use sprag_sim::map::grid::{Grid, Values};
use sprag_sim::scene::map::{AxisTable, ScaleName};
use sprag_studies::map::boundaries::refine;
use sprag_studies::map::boundary_table::boundary_table;
use sprag_studies::map::study::study;
use sprag_tests::boundary;
use sprag_tests::shipped::grid;

/// The boundaries of every device, with so many evaluations at most.
fn traced(grid: &Grid, evaluations: usize) -> Vec<Boundaries> {
    let (progress, interrupt) = (Progress::new("blocks"), Interrupt::default());
    let maps = study(grid, &progress, &interrupt).expect("a map");
    let of_device = |(device, map): (usize, &sprag_studies::map::tally::DeviceMap)| {
        let outcomes: Vec<Outcome> = map.shown.iter().map(|result| result.outcome).collect();
        refine(grid, device, &outcomes, evaluations, &progress, &interrupt).expect("boundaries")
    };
    maps.iter().enumerate().map(of_device).collect()
}

/// Vertices, and the middles between them on the scales of the axes, of boundaries with `outcome` on one side.
fn samples(grid: &Grid, of_device: &Boundaries, outcome: Outcome) -> Vec<(f64, f64)> {
    let middle = |axis: &AxisTable, one: f64, other: f64| match axis.scale {
        ScaleName::Linear => 0.5 * (one + other),
        ScaleName::Logarithmic => square_root(one * other),
    };
    let y = grid.map.y.as_ref().expect("two axes");
    let with = |boundary: &&Boundary| [boundary.left, boundary.right].contains(&outcome);
    let of_boundary = |boundary: &Boundary| {
        let point = |values: &Values| (values.0, values.1.expect("two axes"));
        let vertices: Vec<(f64, f64)> = boundary.vertices.iter().map(point).collect();
        let between = |pair: &[(f64, f64)]| (middle(&grid.map.x, pair[0].0, pair[1].0), middle(y, pair[0].1, pair[1].1));
        let middles: Vec<(f64, f64)> = vertices.windows(2).map(between).collect();
        [vertices, middles].concat()
    };
    of_device.boundaries.iter().filter(with).flat_map(of_boundary).collect()
}

fn worst(errors: impl Iterator<Item = f64>) -> f64 {
    errors.fold(0.0, |worst, error| worst.max(error.abs()))
}

/// A sine uplifts the block from the threshold on, whatever its frequency and the device.
#[test]
fn rocking_begins_at_the_threshold() {
    for y in ["from=0.7,to=1.2,cells=8", "from=0.5,to=1.2,cells=7,scale=\"logarithmic\""] {
        let y = format!("map.y={{key=\"ground.0.amplitude_ratio\",{y}}}");
        let grid = grid("figure08.toml", &["map.x.from=2.0", "map.x.cells=6", &y]);
        for of_device in traced(&grid, EVALUATIONS) {
            assert_eq!(of_device.unresolved, 0);
            let found: Vec<(f64, f64)> = samples(&grid, &of_device, Outcome::NoRocking);
            assert!(found.len() > 20);
            let error = worst(found.iter().map(|point| point.1 - 1.0));
            assert!(error <= TOLERANCE, "{}: {error:e}", of_device.device);
            let (first, last) = found.iter().fold((f64::MAX, 0.0_f64), |ends, point| (ends.0.min(point.0), ends.1.max(point.0)));
            assert_eq!((first, last), (2.0, 8.0));
        }
    }
}

/// The least amplitude of a one-cycle sine, over gα, that overturns the slender block without an impact, for ω_g/p:
/// √(β² − 1) − β e^{−(p/ω)(2π − asin 1/β)} = ω/p.
fn sine(frequency: f64) -> f64 {
    boundary(1.0, 2.0 + 2.0 * frequency, |b| square_root(b * b - 1.0) - b * exp(-(TAU - asin(1.0 / b)) / frequency) > frequency)
}

/// The slender block alone, and with an inerter that is always engaged, which is a block with p/√(1 + k) in the place of p.
#[test]
fn overturning_without_impact_has_its_closed_form() {
    for (x, y) in [("linear", "linear"), ("logarithmic", "logarithmic")] {
        let grid = grid(
            "figure08.toml",
            &[
                "block.geometry=\"slender\"",
                &format!("map.x={{key=\"ground.0.frequency_ratio\",from=0.8,to=5.0,cells=12,scale=\"{x}\"}}"),
                &format!("map.y={{key=\"ground.0.amplitude_ratio\",from=1.05,to=8.0,cells=12,scale=\"{y}\"}}"),
            ],
        );
        let all = traced(&grid, EVALUATIONS);
        for (of_device, stretch) in all.iter().zip([1.0, square_root(1.375)]) {
            let found = samples(&grid, of_device, Outcome::OverturnedWithoutImpact);
            let error = worst(found.iter().map(|(frequency, amplitude)| amplitude / sine(frequency * stretch) - 1.0));
            println!("{}: {} vertices and middles within {error:.1e} of the closed form", of_device.device, found.len());
            assert!(found.len() > 500 && error <= TOLERANCE, "{}: {error:e}", of_device.device);
        }
    }
}

/// Along one axis, in the lanes and scene by scene.
#[test]
fn a_cut_has_its_changes() {
    let cut = |change: &str, frequency: f64| {
        let frequency = format!("ground.0.frequency_ratio={frequency:?}");
        let x = "map={x={key=\"ground.0.amplitude_ratio\",from=0.5,to=6.0,cells=12}}";
        let changes = ["block.geometry=\"slender\"", "run.free_time_ratio=60.0", &frequency, change, x];
        let changes = [&changes[..], &["device=[{kind=\"none\"}]"]].concat();
        let all = traced(&grid("figure08.toml", &changes), EVALUATIONS);
        assert_eq!((all.len(), all[0].unresolved), (1, 0));
        all[0].clone()
    };
    let half_sine = |b: f64, frequency: f64| square_root(b * b - 1.0) + b * exp(-(PI - asin(1.0 / b)) / frequency);
    for frequency in [2.0, 4.0] {
        for (motion, exact) in
            [("sine", sine(frequency)), ("half-sine", boundary(1.0, 9.0, |b| half_sine(b, frequency) > frequency))]
        {
            let found = cut(&format!("ground.0.motion=\"{motion}\""), frequency);
            let at = |outcome: Outcome, last: bool| {
                let side = |boundary: &&Boundary| if last { boundary.right == outcome } else { boundary.left == outcome };
                let [vertex] = found.boundaries.iter().find(side).expect("a change").vertices[..] else { panic!("one vertex") };
                assert_eq!(vertex.1, None);
                vertex.0
            };
            let (rocks, falls) = (at(Outcome::NoRocking, false), at(Outcome::OverturnedWithoutImpact, true));
            assert!((rocks - 1.0).abs() <= TOLERANCE, "{motion}: {rocks}");
            assert!((falls / exact - 1.0).abs() <= TOLERANCE, "{motion} {frequency}: {falls} for {exact}");
            println!("{motion}, ω_g/p = {frequency}: {} evaluations", found.evaluations);
        }
    }
}

/// Whether the blocks a little to either side of `vertex`, along x or along y, have the two outcomes of its boundary.
fn separates(grid: &Grid, device: usize, boundary: &Boundary, vertex: Values) -> bool {
    let (x, y) = (vertex.0, vertex.1.expect("two axes"));
    let (less, more) = (1.0 - 2.0 * TOLERANCE, 1.0 + 2.0 * TOLERANCE);
    let around = [(x * less, Some(y)), (x * more, Some(y)), (x, Some(y * less)), (x, Some(y * more))];
    let found: Vec<Outcome> =
        results_at(grid, device, &around, &Interrupt::default()).expect("blocks").iter().map(|result| result.outcome).collect();
    let both = |pair: &[Outcome]| pair.contains(&boundary.left) && pair.contains(&boundary.right);
    both(&found[..2]) || both(&found[2..])
}

/// Traces the boundaries of a grid and prints what it takes; returns the number of vertices that do not separate their outcomes, for every
/// device, with its boundaries.
fn measured(grid: &Grid, evaluations: usize) -> Vec<(Boundaries, usize)> {
    let tolerances = |axis: &AxisTable| ln(axis.to / axis.from) / TOLERANCE;
    let uniform = tolerances(&grid.map.x) * grid.map.y.as_ref().map_or(1.0, tolerances);
    println!("{}: a uniform grid of this accuracy has {uniform:.1e} cells", grid.place(grid.values(0, 0)));
    let of_device = |(device, of_device): (usize, Boundaries)| {
        let wrong =
            |boundary: &Boundary| boundary.vertices.iter().filter(|vertex| !separates(grid, device, boundary, **vertex)).count();
        let wrong = of_device.boundaries.iter().map(wrong).sum();
        println!(
            "{}: {} boundaries, {} vertices, {} evaluations, {} squares left up to {:.1e} wide; {wrong} vertices do not separate",
            of_device.device,
            of_device.boundaries.len(),
            of_device.vertices(),
            of_device.evaluations,
            of_device.unresolved,
            of_device.unresolved_width,
        );
        (of_device, wrong)
    };
    traced(grid, evaluations).into_iter().enumerate().map(of_device).collect()
}

/// Every vertex of Figure 8 for pulses that are no slower than the block, where everything is finished.
#[test]
fn vertices_separate_their_outcomes() {
    let grid = grid("figure08.toml", &["map.x.from=1.0", "map.x.cells=24", "map.y.cells=24"]);
    for (of_device, wrong) in measured(&grid, EVALUATIONS) {
        assert_eq!((of_device.unresolved, wrong), (0, 0), "{}", of_device.device);
        assert!(of_device.vertices() > 5000 && of_device.evaluations < 300_000, "{}", of_device.evaluations);
    }
}

/// Slower pulses have ever finer stripes of overturning after impacts, in which something else may lie 2e-6 away, and which no budget
/// traces to the end.
#[test]
fn stripes_of_slow_pulses_end_with_the_budget() {
    let grid = grid("figure08.toml", &["map.x.cells=24", "map.y.cells=24"]);
    for (of_device, wrong) in measured(&grid, 100_000) {
        assert!(of_device.evaluations == 100_000 && of_device.unresolved > 0);
        assert!(wrong * 50 < of_device.vertices(), "{}: {wrong}", of_device.device);
    }
}

fn csv(grid: &Grid, threads: usize) -> (Vec<u8>, Vec<Boundaries>) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let all = pool.install(|| traced(grid, 3000));
    let mut bytes = Vec::new();
    write_csv(&boundary_table(grid, &all), &mut bytes).expect("memory");
    (bytes, all)
}

/// With a budget that does not suffice: it is kept, what is left is reported, and the result is the same on any number of threads.
#[test]
fn a_budget_is_kept_and_threads_change_nothing() {
    let grid = grid("figure08.toml", &["map.x.cells=20", "map.y.cells=15"]);
    let (bytes, all) = csv(&grid, 1);
    assert_eq!(bytes, csv(&grid, 3).0);
    for of_device in &all {
        assert_eq!(of_device.evaluations, 3000);
        assert!(of_device.unresolved > 0 && of_device.unresolved_width > TOLERANCE);
    }
    let text = String::from_utf8(bytes).expect("text");
    let rows: usize = all.iter().map(Boundaries::vertices).sum();
    assert_eq!(text.lines().count(), rows + 1);
    assert_eq!(text.lines().next(), Some("device,boundary,left,right,ground.0.frequency_ratio,ground.0.amplitude_ratio"));
    // Numbers read back to the same f64.
    let fields: Vec<&str> = text.lines().nth(1).expect("a vertex").rsplit(',').collect();
    let vertex = all[0].boundaries[0].vertices[0];
    assert_eq!((fields[1].parse(), fields[0].parse().map(Some)), (Ok(vertex.0), Ok(vertex.1)));
}
