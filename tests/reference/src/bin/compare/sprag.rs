//! Runs a `sprag` binary and reads what it wrote.

use std::path::Path;
use std::process::Command;

use sprag_reference::compare::Other;
use sprag_reference::ledger::Shares;
use sprag_reference::method::Method;

/// Runs `sprag simulate` on a scene of one device; `step` (s) is that of this program.
///
/// # Errors
/// What it printed.
pub fn simulate(sprag: &Path, scene: &Path, out: &Path, method: Method, step: f64) -> Result<Other, String> {
    let mut command = Command::new(sprag);
    command.arg("simulate").arg(scene).args(["--overwrite", "--out"]).arg(out);
    for (key, value) in method.keys(step) {
        command.arg("--set").arg(format!("accuracy.{key}={value}"));
    }
    let output = command.output().map_err(|error| format!("{}: {error}", sprag.display()))?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        let lines: Vec<_> = text.lines().filter(|line| !line.contains("warning")).collect();
        return Err(format!("theirs: {}", lines.join(" ")));
    }
    let read = |name: &str| std::fs::read_to_string(out.join(name)).map_err(|error| format!("{name}: {error}"));
    let summary = read("summary.json")?;
    let after = |key: &str| summary.split(&format!("\"{key}\": ")).nth(1);
    let outcome = after("outcome").and_then(|rest| rest.split('"').nth(1)).unwrap_or_default();
    let energy = summary.split("\"energy\": {").nth(1).unwrap_or_default();
    let entry = |name: &str| energy.split(&format!("\"{name}\": ")).nth(1)?.split([',', '\n', '}']).next()?.trim().parse().ok();
    let table = read("history.csv")?;
    let history = table.lines().skip(1).filter_map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        Some([fields.get(1)?.parse().ok()?, fields.get(3)?.parse().ok()?])
    });
    Ok(Other { outcome: outcome.to_owned(), history: history.collect(), ledger: Shares::of(entry) })
}
