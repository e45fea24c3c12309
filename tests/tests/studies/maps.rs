//! Overturning maps: the counts of Figure 8, and what must not depend on threads.

use sprag_report::progress::Progress;
use sprag_sim::closed_loop::LoopScene;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::map::grid::Grid;
use sprag_sim::scene::{Scene, document};
use sprag_studies::map::study::study;
use sprag_studies::map::table::Labels;
use sprag_studies::map::tally::Counts;
use sprag_tests::shipped::grid;

fn counts(changes: &[&str]) -> Vec<Counts> {
    let maps = study(&grid("figure08.toml", changes), &Progress::new("cells"), &Interrupt::default()).expect("a map");
    maps.iter().map(|map| map.counts).collect()
}

/// Figure 8: cells overturned after an impact, beside those of a program that stopped looking 10/p after the pulse. Ours are decided: a block
/// that hesitates on its tip longer than that has an outcome here. Cells next to a boundary make the rest.
#[test]
fn figure_8_counts() {
    for (geometry, published) in [("full", [578, 390, 1009]), ("slender", [393, 316, 861])] {
        let found = counts(&[&format!("block.geometry=\"{geometry}\"")]);
        let after_impact = [0, 1, 2].map(|device| found[device].overturned_after_impact);
        println!("{geometry}: overturned after an impact {after_impact:?} of 4096, at a horizon of 10/p {published:?}");
        for (ours, theirs) in after_impact.into_iter().zip(published) {
            assert!(ours.abs_diff(theirs) * 100 <= theirs * 7, "{geometry}: {after_impact:?}");
        }
    }
}

fn csv(grid: &Grid, threads: usize) -> Vec<u8> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let maps = pool.install(|| study(grid, &Progress::new("cells"), &Interrupt::default())).expect("a map");
    let labels = Labels::new(grid).expect("names");
    let mut bytes = Vec::new();
    for (row, result) in maps.iter().flat_map(|map| &map.shown).enumerate() {
        labels.write(row, result, &mut bytes);
    }
    bytes
}

/// Side by side or one by one, on one thread or on three; over keys that are read anew for every cell; and scenes that are no pulse.
#[test]
fn maps_do_not_depend_on_threads() {
    for (scene, changes) in [
        ("figure08.toml", &["map.x.cells=70", "map.y.cells=41"][..]),
        ("figure08.toml", &["map.x.cells=9", "map.y={key=\"block.inertia_ratio\",from=1.1,to=2.0,cells=7}"]),
        ("figure08.toml", &["map.x.cells=5", "map.y.cells=4", "ground.0.motion=\"half-sine\""]),
        ("near_fault.toml", &["map.x={key=\"block.size_m\",from=1.0,to=4.0,cells=3,scale=\"logarithmic\"}"]),
    ] {
        let grid = grid(scene, changes);
        let bytes = csv(&grid, 1);
        assert_eq!(bytes, csv(&grid, 3), "{scene} {changes:?}");
        let rows = grid.columns() * grid.rows() * grid.scene.devices.len();
        assert_eq!(String::from_utf8(bytes).expect("text").lines().count(), rows);
    }
}

/// Two laws beside the ideal pair: each of their cells is what `sprag loop` says of the same scene with that law, on any number of threads.
#[test]
fn cells_of_closed_loops_are_loops() {
    let axes = ["map.x={key=\"controller.latency_s\",from=0.0,to=0.03,cells=3}", "map.y.cells=2"];
    let grid = grid("laws.toml", &axes);
    let maps = study(&grid, &Progress::new("cells"), &Interrupt::default()).expect("a map");
    let names: Vec<&str> = maps.iter().map(|map| map.device.as_str()).collect();
    assert_eq!(names, ["clutched pair", "clutched pair, resisting", "clutched pair, resisting-predicted"]);
    assert_eq!(csv(&grid, 3), csv(&grid, 1));
    let interrupt = Interrupt::default();
    for (index, mapped) in grid.mapped().iter().enumerate() {
        for (cell, result) in maps[index].shown.iter().enumerate() {
            let Some(law) = mapped.law else { continue };
            let scene = grid.scene_of(cell % grid.columns(), cell / grid.columns()).expect("a cell");
            let mut desk = LoopScene::new(scene).expect("a pair");
            desk.controller.law = law;
            let task = desk.task(mapped.device, desk.controller.sensors.seed(), &interrupt);
            let (.., alone) = task.answered::<()>().expect("a loop");
            assert_eq!(result.outcome, alone.outcome(), "{} {cell}", mapped.name);
            assert!(result.peak_acceleration.is_nan());
            if !result.outcome.overturned() {
                let peak = alone.extremes.peaks.rotation / desk.scene.block.slenderness();
                assert_eq!(result.peak_rotation.to_bits(), peak.to_bits(), "{} {cell}", mapped.name);
            }
        }
    }
}

/// A pulse the other way moves the same block the other way, and ideal sensors do not mind; a law needs clutches that take commands.
#[test]
fn maps_of_closed_loops_are_symmetric_and_need_a_pair() {
    let counts = |scale: &str| {
        let ideal = ["controller.sensors={suite=\"ideal\"}", "map.x.cells=2", "map.y.cells=4", "map.laws=[\"resisting\"]", scale];
        let maps = study(&grid("laws.toml", &ideal), &Progress::new("cells"), &Interrupt::default()).expect("a map");
        maps.iter().map(|map| map.counts).collect::<Vec<_>>()
    };
    assert_eq!(counts("ground.0.scale=1.0"), counts("ground.0.scale=-1.0"));
    let text = "block = { size_m = 2.0, slenderness_deg = 10.0 }
        device = [{ kind = 'inerter', mass_ratio = 0.5 }]
        ground = [{ motion = 'sine', amplitude_ratio = 2.0, frequency_ratio = 3.0 }]
        map = { laws = ['resisting'], x = { key = 'block.size_m', from = 1.0, to = 2.0, cells = 2 } }";
    let refused = |change: &str| {
        let mut table = document::table(text, "scene").expect("TOML");
        sprag_sim::scene::overrides::apply(&mut table, change, "scene").expect("a key");
        let scene = Scene::of_table(table.clone(), "scene");
        scene.and_then(|scene| Grid::new(scene, table)).map(|grid| grid.mapped().len()).map_err(|error| error.to_string())
    };
    assert!(refused("title=a").unwrap_err().starts_with("scene: map.laws: a closed loop needs"));
    assert_eq!(refused("device.0.kind=clutched-pair"), Ok(2));
    let twice = refused("map.laws=[\"passive\", \"passive\"]").unwrap_err();
    assert!(twice.starts_with("scene: map.laws.1: "), "{twice}");
}

/// A cell of a map is the scene of that cell, simulated: lanes and cells that are read one by one agree, whatever is called overturned.
#[test]
fn a_cell_is_its_scene() {
    let run = |grid: &Grid| study(grid, &Progress::new("cells"), &Interrupt::default()).expect("a map");
    let sine = ("figure08.toml", ["map.x.cells=7", "map.y.cells=6", "run={free_time_ratio=60.0}"]);
    let x = "map={x={key=\"ground.0.scale\",from=1.0,to=6.0,cells=24}}";
    let record = ("near_fault.toml", [x, "block.size_m=4.0", "run={free_time_ratio=60.0}"]);
    let real = "device=[{kind=\"clutched-pair\",mass_ratio=0.5,engagement=\"rigid\",actuation={engagement_delay_s=0.02,release_delay_s=0.01}}]";
    let real = ("near_fault.toml", [x, real, "run={free_time_ratio=60.0}"]);
    for (scene, changes) in [sine, record, real] {
        let mut overturned = Vec::new();
        for at in ["map.overturned_at=\"no-return\"", "map.overturned_at=\"slenderness\""] {
            let fast = run(&grid(scene, &[&changes[..], &[at]].concat()));
            // A tolerance of its own takes a scene out of the lanes.
            let slow =
                run(&grid(scene, &[&changes[..], &[at, "accuracy.level=\"tight\"", "run={free_time_ratio=60.0}"]].concat()));
            for (fast, slow) in fast.iter().zip(&slow) {
                for (cell, (fast, slow)) in fast.shown.iter().zip(&slow.shown).enumerate() {
                    assert_eq!(fast.outcome, slow.outcome, "{scene} {at} cell {cell}");
                    let close = |a: f64, b: f64| a.is_nan() && b.is_nan() || (a - b).abs() <= 1e-9 * b;
                    assert!(close(fast.peak_rotation, slow.peak_rotation), "cell {cell}: {fast:?} {slow:?}");
                    assert!(close(fast.peak_acceleration, slow.peak_acceleration), "cell {cell}: {fast:?} {slow:?}");
                }
            }
            overturned.push(fast.iter().map(|map| map.counts.overturned()).sum::<usize>());
        }
        println!("{scene}: {overturned:?} overturned by the two definitions");
        assert!(overturned[0] > 0 && overturned[1] >= overturned[0], "{scene}: {overturned:?}");
    }
}
