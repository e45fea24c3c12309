//! Compares this program with a `sprag` binary on random scenes, or on given ones:
//!
//! `compare SPRAG COUNT SEED KEEP` keeps the scenes that differ in the folder KEEP; `compare SPRAG SCENE.toml…` tells of each;
//! with `EVENTS` or `HISTORY` in the environment it lists those of this program, `RESOLUTION` changes its steps.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use sprag_reference::compare::{Other, Tolerance, Verdict, check, compare};
use sprag_reference::generate::scene;
use sprag_reference::scene::Scene;
use sprag_reference::simulate::{RESOLUTION, run_at};

/// Differences beyond these are told.
const TOLERANCE: Tolerance = Tolerance { history: 1e-6, residual: 1e-9 };

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [sprag, rest @ ..] = arguments.as_slice() else { return Err("compare SPRAG COUNT SEED KEEP".to_owned()) };
    match rest {
        [count, seed, keep] if count.parse::<u64>().is_ok() => {
            let number = |text: &String| text.parse::<u64>().map_err(|error| format!("{text}: {error}"));
            random(sprag, number(count)?, number(seed)?, Path::new(keep))
        }
        scenes => scenes.iter().try_for_each(|path| single(sprag, Path::new(path))),
    }
}

fn random(sprag: &str, count: u64, seed: u64, keep: &Path) -> Result<(), String> {
    let mut tally: BTreeMap<&str, [usize; 5]> = BTreeMap::new();
    let mut histories = Vec::new();
    for number in 0..count {
        let generated = scene(seed, number);
        let folder = keep.join(format!("{seed}-{number}"));
        std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
        let verdict = check(&generated, &folder, TOLERANCE, |path| sprag_run(sprag, path, &folder.join("out")));
        let row = tally.entry(generated.family).or_default();
        row[0] += 1;
        let told = match verdict {
            Ok(Verdict::Agree(difference)) => {
                histories.push(difference.history);
                row[1] += 1;
                None
            }
            Ok(Verdict::Chaotic(_)) => {
                row[2] += 1;
                None
            }
            Ok(Verdict::Differ(difference)) => {
                row[3] += 1;
                Some(format!("{difference:?}"))
            }
            Err(error) => {
                row[4] += 1;
                Some(error.lines().next().unwrap_or_default().chars().take(260).collect())
            }
        };
        match told {
            Some(line) => println!("{} {:12} {line}", folder.display(), generated.family),
            None => drop(std::fs::remove_dir_all(&folder)),
        }
    }
    println!("family: scenes, agree, chaotic, differ, not run\n{tally:?}");
    histories.sort_by(f64::total_cmp);
    let at = |share: f64| histories.get((share * (histories.len().max(1) - 1) as f64) as usize).copied().unwrap_or(0.0);
    println!("histories that agree: median {:.1e}, 90 % {:.1e}, largest {:.1e}", at(0.5), at(0.9), at(1.0));
    Ok(())
}

fn single(sprag: &str, path: &Path) -> Result<(), String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let parsed = Scene::parse(&text)?;
    let folder = path.parent().map(PathBuf::from).unwrap_or_default();
    for index in 0..parsed.device.len() {
        let resolution = std::env::var("RESOLUTION").ok().and_then(|text| text.parse().ok()).unwrap_or(RESOLUTION);
        let ours = run_at(&parsed, index, &folder, resolution)?;
        let finer = run_at(&parsed, index, &folder, resolution / 2.0)?;
        let slenderness = parsed.block.slenderness_deg.to_radians();
        println!(
            "{}: device {index}: {}, peak {:.9} α, {} impacts, residual {:.1e}",
            path.display(),
            ours.outcome,
            ours.peak / slenderness,
            ours.impacts,
            ours.ledger.residual() / ours.ledger.income()
        );
        println!("  half the step: {:?}", compare(&ours, &Other::from(&finer), slenderness));
        if std::env::var_os("EVENTS").is_some() {
            ours.events.iter().for_each(|(time, guard)| println!("  {time:.15} {guard:?}"));
        }
        if std::env::var_os("HISTORY").is_some() {
            ours.samples.iter().for_each(|[time, rotation, velocity]| println!("{time},{rotation},{velocity}"));
        }
        if parsed.device.len() == 1 && parsed.output.interval_s.is_some() {
            match sprag_run(sprag, path, &folder.join("out")) {
                Ok(theirs) => println!("  {:?} against {}", compare(&ours, &theirs, slenderness), theirs.outcome),
                Err(error) => println!("  theirs: {error}"),
            }
        }
    }
    Ok(())
}

/// Runs `sprag simulate` and reads what it wrote.
fn sprag_run(sprag: &str, scene: &Path, out: &Path) -> Result<Other, String> {
    let output = Command::new(sprag).arg("simulate").arg(scene).args(["--overwrite", "--out"]).arg(out).output();
    let output = output.map_err(|error| format!("{sprag}: {error}"))?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        return Err(text.lines().filter(|line| !line.contains("warning")).collect::<Vec<_>>().join(" "));
    }
    let read = |name: &str| std::fs::read_to_string(out.join(name)).map_err(|error| format!("{name}: {error}"));
    let summary = read("summary.json")?;
    let outcome = summary.split("\"outcome\": \"").nth(1).and_then(|rest| rest.split('"').next()).unwrap_or_default();
    let table = read("history.csv")?;
    let history = table.lines().skip(1).filter_map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        Some([fields.get(1)?.parse().ok()?, fields.get(3)?.parse().ok()?])
    });
    Ok(Other { outcome: outcome.to_owned(), history: history.collect() })
}
