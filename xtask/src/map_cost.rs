//! Where the time of an overturning map goes: instructions a cell under callgrind, by what they are for.
//!
//! A map of twice as many rows has the same start and twice the cells; the difference of both, over the added cells, is the cost of a cell.

use crate::{
    callgrind::instructions,
    process::{cargo, executables},
    stop::Stop,
};
use std::path::Path;

/// The scene, from the root.
const SCENE: &str = "scenes/figure08.toml";

/// Rows of both maps, and cells of a row, by device.
const ROWS: [u32; 2] = [64, 128];
const COLUMNS: u32 = 64;
const DEVICES: u32 = 3;

/// What a part of the path of a source file says that its instructions are for; the first that fits.
const PARTS: [(&str, &[&str]); 6] = [
    (
        "power series of θ, and of the ground",
        &["power_series.rs", "motion_series.rs", "ensemble/src/series.rs", "ensemble/src/pulses.rs", "wide_sine.rs"],
    ),
    ("zeros, shapes and extremes of them", &["polynomial.rs", "math/root.rs"]),
    ("slender blocks in closed form", &["ensemble/src/slender", "wide_hyperbolic.rs"]),
    ("events, peaks and the order of both", &["ensemble/src"]),
    ("free motion after the pulse, and blocks that go by the core", &["shared/src", "sim-host/loops", "libm"]),
    ("tables, files and pictures", &[""]),
];

/// Prints the table of the full and the slender block.
///
/// # Errors
/// If there is no valgrind, or a build or a run fails.
pub fn run(root: &Path) -> Result<(), Stop> {
    let target = root.join("target/map-cost");
    let mut build = cargo(root, &["build", "--release", "--package", "sprag-cli", "--bin", "sprag"]);
    build.env("CARGO_PROFILE_RELEASE_DEBUG", "line-tables-only").arg("--target-dir").arg(&target);
    let program = executables(&mut build, &[])?.pop().ok_or_else(|| Stop::failed("cargo names no program"))?;
    let mut costs = [[0.0; PARTS.len()]; 2];
    for (costs, geometry) in costs.iter_mut().zip(["full", "slender"]) {
        for (sign, rows) in [-1.0, 1.0].into_iter().zip(ROWS) {
            let words = [
                "map".to_owned(),
                root.join(SCENE).display().to_string(),
                format!("--set=block.geometry=\"{geometry}\""),
                format!("--x=ground.0.frequency_ratio=0.2:8:{COLUMNS}"),
                format!("--y=ground.0.amplitude_ratio=1:10:{rows}"),
                "--threads=1".to_owned(),
                "--formats=csv".to_owned(),
                format!("--out={}", target.join("map").display()),
                "--overwrite".to_owned(),
            ];
            for (file, count) in instructions(&program, &words, &target)? {
                let part = PARTS.iter().position(|(_, paths)| paths.iter().any(|path| file.contains(path)));
                costs[part.unwrap_or(PARTS.len() - 1)] += sign * count as f64;
            }
        }
        costs.iter_mut().for_each(|cost| *cost /= f64::from((ROWS[1] - ROWS[0]) * COLUMNS * DEVICES));
    }
    let totals = costs.map(|costs| costs.iter().sum::<f64>());
    println!("| instructions a cell | full | slender |\n| --- | --- | --- |");
    let row = |name: &str, found: [f64; 2]| {
        let [full, slender] = [0, 1].map(|model| format!("{:.0} ({:.0} %)", found[model], 100.0 * found[model] / totals[model]));
        println!("| {name} | {full} | {slender} |");
    };
    for (part, (name, _)) in PARTS.iter().enumerate() {
        row(name, [0, 1].map(|model| costs[model][part]));
    }
    row("all", totals);
    Ok(())
}
