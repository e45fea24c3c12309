//! What a control tick of the firmware costs in the emulator, with and without logs.

use crate::{
    firmware::{BOARD, Image},
    process::{cargo, output},
    stop::Stop,
    summary::first_run,
    tools,
};
use std::{fmt::Write as _, fs, path::Path};

/// The table, from the root.
const TABLE: &str = "docs/ticks.csv";

/// The scene, from the root.
const SCENE: &str = "scenes/controller.toml";

/// Cycles that an instruction takes on a Cortex-M4F, as an estimate: most take one, loads and taken branches two or three, divisions and
/// square roots fourteen, and flash at 168 MHz has five wait states behind a cache.
const CYCLES_PER_INSTRUCTION: f64 = 1.5;

/// Cycles of a control period: 168 MHz at 2 kHz.
const PERIOD_CYCLES: f64 = 84_000.0;

/// What is set in the scene for a row.
const ROWS: &[(&str, &[&str])] = &[
    ("model-aided", &["controller.estimator=model-aided"]),
    ("Kalman", &["controller.estimator=kalman"]),
    ("complementary", &["controller.estimator=complementary"]),
    ("model-aided, sign table", &["controller.law=sign-table"]),
    ("model-aided, look-ahead", &["controller.law=look-ahead"]),
];

/// The logs of a column: none, or from this level on.
const LOGS: [Option<&str>; 2] = [None, Some("info")];

/// Measures and writes the table.
///
/// # Errors
/// If a build or a run fails, or a file cannot be written.
pub fn run(root: &Path) -> Result<(), Stop> {
    tools::need_emulator()?;
    let mut table = String::from("controller,log,median_instructions,worst_instructions,worst_share_of_period_percent\n");
    let mut shown = format!("{:<26} {:<6} {:>7} {:>7} {:>22}\n", "controller", "log", "median", "worst", "of 168 MHz at 2 kHz");
    for log in LOGS {
        let features: &'static [&'static str] = if log.is_some() { &["board-qemu", "log"] } else { &["board-qemu"] };
        let image = Image { name: "measured", features, budget: None, variable: None, log, ..BOARD };
        let elf = image.build(root)?;
        for (name, set) in ROWS {
            let (median, worst) = measure(root, &elf, log, set)?;
            let share = 100.0 * f64::from(worst) * CYCLES_PER_INSTRUCTION / PERIOD_CYCLES;
            let log = log.unwrap_or("none");
            let _ = writeln!(table, "\"{name}\",{log},{median},{worst},{share:.1}");
            let _ = writeln!(shown, "{name:<26} {log:<6} {median:>7} {worst:>7} {share:>20.1} %");
        }
    }
    println!("{shown}\nan instruction taken for {CYCLES_PER_INSTRUCTION} cycles; written to {TABLE}");
    fs::write(root.join(TABLE), table).map_err(|error| Stop::failed(format!("{TABLE}: {error}")))
}

/// Instructions a tick, median and worst, of one run.
fn measure(root: &Path, elf: &Path, log: Option<&str>, set: &[&str]) -> Result<(u32, u32), Stop> {
    let folder = elf.with_extension("hil");
    let mut command =
        cargo(root, &["run", "--release", "--quiet", "--features", "defmt", "--", "hil", SCENE, "--qemu", "--firmware"]);
    command.arg(elf).arg("--out").arg(&folder).arg("--overwrite");
    if let Some(log) = log {
        command.args(["--log", log]);
    }
    for set in set {
        command.args(["--set", set]);
    }
    output(&mut command)?;
    let run = first_run(&folder)?;
    let number = |key: &str| run[key].as_u64().and_then(|number| u32::try_from(number).ok());
    number("instructions_per_tick")
        .zip(number("instructions_per_tick_worst"))
        .ok_or_else(|| Stop::failed("the summary has no instructions_per_tick"))
}
