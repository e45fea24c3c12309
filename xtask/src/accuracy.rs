//! What accuracy costs in time: every table and picture of docs/accuracy.md, and the page itself.

mod levels;
mod others;

use crate::{
    firmware,
    process::{cargo, executables, output, run as done},
    stop::Stop,
    tools,
};
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// Where everything goes, from the root.
const FOLDER: &str = "docs/accuracy";

/// The page, and what it is made from: its words, with a `{{name}}` for every table.
const PAGE: [&str; 2] = ["docs/accuracy.md", "docs/accuracy/page.md"];

/// The scenes that are followed in every way, and the smallest step for each.
const SCENES: [(&str, &str); 3] = [("figure05", "3e-5"), ("figure10", "3e-5"), ("near_fault", "1e-4")];

/// Measures and writes everything.
///
/// # Errors
/// If a tool is missing, a build or a run fails, or a file cannot be written.
pub fn run(root: &Path) -> Result<(), Stop> {
    tools::need_emulator()?;
    let image = firmware::CORE.build(root)?;
    let built = executables(&mut cargo(root, &["build", "--release", "--package", "sprag-cli"]), &[])?;
    let sprag = built.into_iter().next_back().ok_or_else(|| Stop::failed("cargo named no program"))?;
    let mut parts = vec![("levels", levels::table(root, &sprag)?), ("others", others::table(root, &sprag)?)];
    for (scene, step) in SCENES {
        let folder = root.join(FOLDER).join(scene);
        let mut command = Command::new(&sprag);
        command.current_dir(root).args([
            "accuracy",
            &format!("scenes/{scene}.toml"),
            "--smallest-step",
            step,
            "--qemu",
            "--image",
        ]);
        done(command.arg(&image).arg("--out").arg(&folder).arg("--overwrite"))?;
        let page = folder.join("accuracy.md");
        let text = read(&page)?;
        // The heading is the page's own.
        let tables = text.split_once("\n\n").map_or("", |(_, tables)| tables).replace("\n## ", "\n### ");
        parts.push((scene, tables.trim().replacen("## ", "### ", 1)));
        for file in [page, folder.join("summary.json")] {
            fs::remove_file(&file).map_err(|error| Stop::failed(format!("{}: {error}", file.display())))?;
        }
    }
    let [page, words] = PAGE.map(|name| root.join(name));
    let mut text = read(&words)?;
    for (name, table) in parts {
        let place = format!("{{{{{name}}}}}");
        if !text.contains(&place) {
            return Err(Stop::failed(format!("{} has no {place}", PAGE[1])));
        }
        text = text.replace(&place, table.trim_end());
    }
    fs::write(&page, text).map_err(|error| Stop::failed(format!("{}: {error}", page.display())))?;
    println!("written: {}", PAGE[0]);
    Ok(())
}

fn read(path: &Path) -> Result<String, Stop> {
    fs::read_to_string(path).map_err(|error| Stop::failed(format!("{}: {error}", path.display())))
}

/// A folder for what is not kept.
fn scratch(root: &Path) -> Result<PathBuf, Stop> {
    let folder = root.join("target/accuracy");
    fs::create_dir_all(&folder).map_err(|error| Stop::failed(format!("{}: {error}", folder.display())))?;
    Ok(folder)
}

/// Runs `sprag batch` on one thread; the least time of `times` runs, s.
fn batch(sprag: &Path, cases: &Path, results: &Path, options: &[&str], times: u32) -> Result<f64, Stop> {
    let mut least = f64::INFINITY;
    for _ in 0..times {
        let start = std::time::Instant::now();
        output(
            Command::new(sprag)
                .arg("batch")
                .arg(cases)
                .arg("--out")
                .arg(results)
                .args(["--overwrite", "--threads", "1"])
                .args(options),
        )?;
        least = least.min(start.elapsed().as_secs_f64());
    }
    Ok(least)
}

/// The value at a share of sorted `values`.
fn quantile(values: &[f64], share: f64) -> f64 {
    let last = values.len().saturating_sub(1);
    values.get(((values.len() as f64 * share) as usize).min(last)).copied().unwrap_or(f64::NAN)
}
