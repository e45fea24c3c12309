//! What effects cost, and that one which is off costs nothing: instructions a step on the host under callgrind, nanoseconds a
//! step, and instructions a step on the emulated board.
//!
//! A run with half the step takes the same motion in twice as many steps; the difference between both, over the added steps, is
//! the cost of a step without start and output.

use crate::{
    callgrind::instructions,
    firmware,
    process::{executables, output},
    stop::Stop,
    summary::first_run,
    tools,
};
use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
    process::Command,
    time::{Duration, Instant},
};

/// Largest relative difference between the loop of the full program and that of one without effects.
const SAME: f64 = 0.01;

/// Steps of both runs, s.
const STEPS: [f64; 2] = [1e-3, 5e-4];

/// Runs of which the fastest counts.
const REPETITIONS: u32 = 7;

/// The default features of the program but `effects`.
const BARE: &[&str] = &["--no-default-features", "--features", "parquet,png,serial"];

/// The scene, from the root.
const SCENE: &str = "docs/effects-cost.toml";

/// A row: name of the effect in the registry (or a base), its base, the board's kernel, and what is set for it.
struct Row {
    name: &'static str,
    base: &'static str,
    kernel: &'static str,
    set: &'static [&'static str],
}

const fn row(name: &'static str, base: &'static str, kernel: &'static str, set: &'static [&'static str]) -> Row {
    Row { name, base, kernel, set }
}

const PAIR: &str = "device.0={kind=\"clutched-pair\",mass_ratio=0.5,kinematics=\"consistent\"";

const ROWS: &[Row] = &[
    row("block alone", "", "", &["device.0={kind=\"none\"}"]),
    row("inerter", "", "", &["device.0={kind=\"inerter\",mass_ratio=0.5}"]),
    row("clutched pair", "", "located-rk4-step", &["device.0={kind=\"clutched-pair\",mass_ratio=0.5}"]),
    row(
        "geometry",
        "clutched pair",
        "located-rk4-step",
        &["block.geometry=\"full\"", "device.0={kind=\"clutched-pair\",mass_ratio=0.5}"],
    ),
    row("kinematics", "geometry", "", &["block.geometry=\"full\"", "PAIR}"]),
    row("mount", "kinematics", "", &["block.geometry=\"full\"", "PAIR,mount=\"tying-point\",mount_height_m=1.5}"]),
    row("impact", "clutched pair", "", &["PAIR}", "block.restitution=\"momentum-balance\""]),
    row("scatter", "clutched pair", "", &["PAIR}", "block.restitution_scatter=0.02"]),
    row(
        "foundation",
        "geometry",
        "",
        &["block.geometry=\"full\"", "PAIR}", "block.foundation={vertical_frequency_hz=10.0,damping_ratio=0.3}"],
    ),
    row("sliding", "block alone", "", &["block.geometry=\"full\"", "device.0={kind=\"none\"}", "block.friction_coefficient=0.3"]),
    row(
        "vertical",
        "clutched pair",
        "machine-alone-vertical",
        &["PAIR}", "vertical=[{motion=\"sine\",amplitude_g=0.01,frequency_hz=0.1}]"],
    ),
    row(
        "flywheel",
        "clutched pair",
        "machine-rigid",
        &["PAIR,engagement=\"rigid\",flywheel={viscous_rate_1_s=0.05,dry_deceleration_m_s2=0.3,brake_deceleration_m_s2=5.0}}"],
    ),
    row(
        "flywheel, drag",
        "flywheel",
        "machine-drag",
        &["PAIR,engagement=\"rigid\",flywheel={viscous_rate_1_s=0.05,dry_deceleration_m_s2=0.3,brake_deceleration_m_s2=5.0,\
           drag_rate_1_s=0.1},actuation={engagement_delay_s=0.02}}"],
    ),
    row("engagement", "clutched pair", "machine-overrunning", &["PAIR,engagement=\"overrunning\"}"]),
    row("clutch", "clutched pair", "machine-friction-clutch", &["PAIR,clutch={capacity_ratio=0.1}}"]),
    row("clutch, elastic", "clutched pair", "machine-elastic-rk4", &["PAIR,clutch={stiffness_ratio=1e4,damping_ratio=0.1}}"]),
    row(
        "clutch, elastic, exponential",
        "clutched pair",
        "machine-elastic-exponential",
        &["PAIR,clutch={stiffness_ratio=1e4,damping_ratio=0.1}}", "accuracy.method=\"exponential-midpoint\""],
    ),
    row("slip", "clutched pair", "machine-viscous-slip", &["PAIR,inertance_corner_hz=4.0}"]),
    row("rack, load friction", "flywheel", "machine-load-friction", &["PAIR,engagement=\"rigid\",rack={load_friction=0.05}}"]),
    row("rack", "clutched pair", "machine-ideal-pair-friction", &["PAIR,rack={dry_friction_ratio=0.01,viscous_1_s=0.05}}"]),
    row("actuation", "clutched pair", "machine-ideal-pair", &["PAIR,actuation={engagement_delay_s=0.02,release_delay_s=0.02}}"]),
    row("actuation, coil", "clutch", "", &["PAIR,clutch={capacity_ratio=0.1},actuation={time_constant_s=0.1}}"]),
    row("weight", "clutched pair", "", &["PAIR,weight={rack_ratio=0.01}}"]),
    row("support", "clutched pair", "", &["PAIR,support_amplification=1.2}"]),
    row("support, oscillator", "clutched pair", "", &["PAIR,support_frequency_hz=5.0,support_damping_ratio=0.05}"]),
    row("checks", "clutched pair", "", &["PAIR}", "checks={}"]),
    row("energy", "clutched pair", "", &["PAIR}", "output.energy=true"]),
    row(
        "all together",
        "block alone",
        "machine-all-together",
        &[
            "block.geometry=\"full\"",
            "block.restitution=\"momentum-balance\"",
            "PAIR,clutch={capacity_ratio=0.1},flywheel={viscous_rate_1_s=0.05,dry_deceleration_m_s2=0.3,brake_deceleration_m_s2=5.0},\
             rack={dry_friction_ratio=0.01,viscous_1_s=0.05},actuation={engagement_delay_s=0.02,release_delay_s=0.02},\
             weight={rack_ratio=0.01}}",
            "vertical=[{motion=\"sine\",amplitude_g=0.01,frequency_hz=0.1}]",
            "checks={}",
            "output.energy=true",
        ],
    ),
];

/// What was measured.
struct Measured {
    instructions: f64,
    nanoseconds: f64,
    target: Option<u32>,
}

/// Measures, prints the table, and writes `docs/effects-cost.csv`.
///
/// # Errors
/// If a tool is missing, a run fails, or an effect that is off is not free.
pub fn run(root: &Path) -> Result<(), Stop> {
    let bare = off_costs_nothing(root)?;
    let elf = firmware::CORE.build(root)?;
    tools::need_emulator()?;
    let kernels = output(Command::new("qemu-system-arm").args(firmware::EMULATOR).arg(&elf))?;
    let full = sprag(root, &[])?;
    let mut table =
        String::from("| effect | instructions a step | ns a step | added to | instructions added | on the board, a step |\n");
    table.push_str("| --- | --- | --- | --- | --- | --- |\n");
    let mut csv = String::from("effect,host_instructions,host_ns,target_instructions\n");
    let mut done: Vec<(&str, Measured)> = Vec::new();
    for row in ROWS {
        let measured = Measured {
            instructions: instructions_per_step(root, &full, row.set)?,
            nanoseconds: nanoseconds_per_step(root, &full, row.set)?,
            target: kernel(&kernels, row.kernel),
        };
        let base = done.iter().find(|(name, _)| *name == row.base).map(|(_, base)| base);
        let added = base.map_or(f64::NAN, |base| measured.instructions - base.instructions);
        let target = measured.target.map_or_else(|| "–".to_owned(), |count| count.to_string());
        let dash = |text: &str| if text.is_empty() { "–".to_owned() } else { text.to_owned() };
        let change = if added.is_nan() { "–".to_owned() } else { format!("{added:+.0}") };
        let (instructions, nanoseconds) = (measured.instructions, measured.nanoseconds);
        let _ =
            writeln!(table, "| {} | {instructions:.0} | {nanoseconds:.0} | {} | {change} | {target} |", row.name, dash(row.base));
        if let (Some(base), false) = (base, row.name.contains([',', ' '])) {
            let time = measured.nanoseconds - base.nanoseconds;
            let _ = writeln!(csv, "{},{added:+.0},{time:+.0},{target}", row.name);
        }
        done.push((row.name, measured));
    }
    println!("{table}");
    println!("{bare}");
    let path = root.join("docs/effects-cost.csv");
    std::fs::write(&path, csv).map_err(|error| Stop::usage(format!("{}: {error}", path.display())))
}

/// Compares the loop of the slender block alone in the full program with that of a program without effects.
///
/// # Errors
/// If they differ by more than 1 %.
pub fn off_costs_nothing(root: &Path) -> Result<String, Stop> {
    let full = instructions_per_step(root, &sprag(root, &[])?, &[])?;
    let bare = instructions_per_step(root, &sprag(root, BARE)?, &[])?;
    let change = full / bare - 1.0;
    let line = format!(
        "slender block alone: {full:.2} instructions a step in the full program, {bare:.2} without effects: {:+.3} %",
        100.0 * change
    );
    if change.abs() < SAME { Ok(line) } else { Err(Stop::failed(line)) }
}

/// The program, built for speed in a folder of its own for each set of features.
fn sprag(root: &Path, features: &[&str]) -> Result<PathBuf, Stop> {
    let folder = if features.is_empty() { "target" } else { "target/without-effects" };
    let mut build = crate::process::cargo(root, &["build", "--release", "--package", "sprag-cli", "--bin", "sprag"]);
    build.args(features).arg("--target-dir").arg(root.join(folder));
    executables(&mut build, &[])?.pop().ok_or_else(|| Stop::failed("cargo names no program"))
}

/// The scene's settings for one run.
fn arguments(root: &Path, set: &[&str], step: f64, out: &Path) -> Vec<String> {
    let mut words = vec!["simulate".to_owned(), root.join(SCENE).display().to_string()];
    let mut all = vec!["accuracy.method=\"runge-kutta-4\"".to_owned(), format!("accuracy.step_s={step}")];
    all.extend(set.iter().map(|item| item.replace("PAIR", PAIR)));
    for item in all {
        words.extend(["--set".to_owned(), item]);
    }
    words.extend(["--out".to_owned(), out.display().to_string(), "--overwrite".to_owned()]);
    words
}

/// Time for which the block rocks, s.
fn rocking_time(folder: &Path) -> Result<f64, Stop> {
    first_run(folder)?["end_time_s"].as_f64().ok_or_else(|| Stop::failed("a summary without end_time_s"))
}

fn added_steps(folder: &Path) -> Result<f64, Stop> {
    Ok(rocking_time(folder)? * (1.0 / STEPS[1] - 1.0 / STEPS[0]))
}

fn instructions_per_step(root: &Path, program: &Path, set: &[&str]) -> Result<f64, Stop> {
    let folder = root.join("target/effects");
    let mut counts = [0.0; 2];
    for (count, step) in counts.iter_mut().zip(STEPS) {
        *count = instructions(program, &arguments(root, set, step, &folder), &folder)?.values().sum::<u64>() as f64;
    }
    Ok((counts[1] - counts[0]) / added_steps(&folder)?)
}

fn nanoseconds_per_step(root: &Path, program: &Path, set: &[&str]) -> Result<f64, Stop> {
    // Short runs of a whole program need many more steps to be seen above its start.
    const FINER: f64 = 20.0;
    let folder = root.join("target/effects");
    let mut fastest = [Duration::MAX; 2];
    for _ in 0..REPETITIONS {
        for (time, step) in fastest.iter_mut().zip(STEPS) {
            let start = Instant::now();
            output(Command::new(program).args(arguments(root, set, step / FINER, &folder)))?;
            *time = (*time).min(start.elapsed());
        }
    }
    let difference = fastest[1].as_secs_f64() - fastest[0].as_secs_f64();
    Ok(difference * 1e9 / (added_steps(&folder)? * FINER))
}

/// Instructions of a kernel in the board's report.
fn kernel(report: &str, name: &str) -> Option<u32> {
    let mut words = report
        .lines()
        .map(str::split_whitespace)
        .find_map(|mut words| (words.next() == Some("kernel") && words.next() == Some(name)).then_some(words))?;
    words.next()?.parse().ok()
}
