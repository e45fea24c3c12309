//! Random scenes, on every core, printed in their order.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc;

use sprag_reference::compare::{Subject, Verdict};
use sprag_reference::generate::scene;
use sprag_reference::method::Method;
use sprag_reference::tally::Tally;

use crate::sprag::simulate;

/// What became of a scene: its family, and a verdict for each method.
type Checked = (&'static str, Vec<Result<Verdict, String>>);

/// Compares scenes 0 up to `count` of `seed` with `sprag`, and keeps those that differ in `keep`.
///
/// # Errors
/// An unknown method, or how many verdicts were not as they should be.
pub fn compare(sprag: &Path, count: u64, seed: u64, keep: &Path) -> Result<(), String> {
    let asked = std::env::var("METHOD").ok();
    let methods: Vec<Method> =
        Method::ALL.into_iter().filter(|method| asked.as_ref().is_none_or(|name| name == method.name())).collect();
    if methods.is_empty() {
        return Err(format!("METHOD: {}", asked.unwrap_or_default()));
    }
    let mut tallies: Vec<Tally> = methods.iter().map(|_| Tally::default()).collect();
    let mut wrong = 0;
    let mut print = |number: u64, (family, verdicts): Checked| {
        for ((method, verdict), tally) in methods.iter().zip(&verdicts).zip(&mut tallies) {
            tally.add(family, verdict);
            let text = match verdict {
                Ok(Verdict::Differ(difference)) => format!("{difference:?}"),
                Err(error) => error.lines().next().unwrap_or_default().chars().take(260).collect(),
                Ok(_) => continue,
            };
            wrong += 1;
            println!("{seed}-{number} {family:12} {:14} {text}", method.name());
        }
    };
    let next = AtomicU64::new(0);
    let (sender, results) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            let (sender, next, methods) = (sender.clone(), &next, &methods);
            scope.spawn(move || {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= count || sender.send((number, check(sprag, seed, number, keep, methods))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        // Those that are done before their turn.
        let mut early = BTreeMap::new();
        let mut turn = 0;
        for (number, checked) in results {
            early.insert(number, checked);
            while let Some(checked) = early.remove(&turn) {
                print(turn, checked);
                turn += 1;
            }
        }
    });
    for (method, tally) in methods.iter().zip(&tallies) {
        println!("\n{}:\n{tally}", method.name());
    }
    if wrong == 0 { Ok(()) } else { Err(format!("{wrong} comparisons differ or could not be made")) }
}

/// Runs one scene by both programs in a folder of its own, which stays if they differ.
fn check(sprag: &Path, seed: u64, number: u64, keep: &Path, methods: &[Method]) -> Checked {
    let generated = scene(seed, number);
    let folder = keep.join(format!("{seed}-{number}"));
    let path = folder.join("scene.toml");
    let subject = || {
        std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
        std::fs::write(&path, &generated.text).map_err(|error| error.to_string())?;
        generated.write_records(&folder)?;
        Subject::of(&generated.text, &folder)
    };
    let verdicts: Vec<_> = match subject() {
        Err(error) => methods.iter().map(|_| Err(error.clone())).collect(),
        Ok(subject) => {
            let verdict = |method: &Method| {
                let theirs = simulate(sprag, &path, &folder.join("out"), *method, subject.step())?;
                subject.against(&theirs, method.tolerance())
            };
            methods.iter().map(verdict).collect()
        }
    };
    if verdicts.iter().all(|verdict| matches!(verdict, Ok(Verdict::Agree(_) | Verdict::Chaotic(_)))) {
        drop(std::fs::remove_dir_all(&folder));
    }
    (generated.family, verdicts)
}
