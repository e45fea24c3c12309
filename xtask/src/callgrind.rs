//! Instructions that a program executes, counted by callgrind.

use crate::{process::output, stop::Stop, tools};
use std::{
    collections::{BTreeMap, HashMap},
    path::Path,
    process::Command,
};

/// Instructions of one run of `program`, by the source file in which they stand, inlined elsewhere or not; those of [`INLINED`] count for the file
/// before them in the same function. All stand under one name where the program has no line tables. What callgrind writes goes into `folder`.
///
/// # Errors
/// If there is no valgrind, or the run fails.
pub fn instructions(program: &Path, arguments: &[String], folder: &Path) -> Result<BTreeMap<String, u64>, Stop> {
    tools::need_valgrind()?;
    let cannot = |path: &Path, error: &std::io::Error| Stop::usage(format!("{}: {error}", path.display()));
    std::fs::create_dir_all(folder).map_err(|error| cannot(folder, &error))?;
    let profile = folder.join("callgrind");
    let mut run = Command::new("valgrind");
    run.arg("--tool=callgrind").arg("--quiet").arg(format!("--callgrind-out-file={}", profile.display())).arg(program);
    output(run.args(arguments))?;
    let text = std::fs::read_to_string(&profile).map_err(|error| cannot(&profile, &error))?;
    let counts = by_file(&text);
    if counts.is_empty() { Err(Stop::failed("callgrind counted nothing")) } else { Ok(counts) }
}

/// Parts of the paths of files that are arithmetic for others: the standard library's, and that of lanes.
const INLINED: [&str; 6] = ["/library/core/", "pulp-", "math/lanes.rs", "math/scalar.rs", "math/value.rs", "ensemble/src/lib.rs"];

/// Self costs of callgrind's output format by file: a file stands with its number once, and by the number alone after that.
fn by_file(text: &str) -> BTreeMap<String, u64> {
    let mut names = HashMap::new();
    let mut named = |word: &str| -> String {
        let (number, name) = word.split_once(')').unwrap_or(("", word));
        let known = names.entry(number.to_owned()).or_insert_with(|| name.trim().to_owned());
        known.clone()
    };
    let mut counts = BTreeMap::new();
    let (mut file, mut of_call) = (String::new(), false);
    for line in text.lines() {
        match line.split_once('=') {
            Some(("fl", word)) => file = named(word),
            Some(("fi" | "fe", word)) => {
                let inlined = named(word);
                if !INLINED.iter().any(|part| inlined.contains(part)) {
                    file = inlined;
                }
            }
            Some(("cfi" | "cfl", word)) => _ = named(word),
            // The next line has what the called function costs, which stands in its own lines, too.
            Some(("calls", _)) => of_call = true,
            _ if !line.starts_with(|first: char| first.is_ascii_digit() || "+-*".contains(first)) => {}
            _ if of_call => of_call = false,
            _ => {
                let cost: u64 = line.split(' ').nth(1).and_then(|cost| cost.parse().ok()).unwrap_or(0);
                *counts.entry(file.clone()).or_default() += cost;
            }
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_go_to_the_file_of_the_line_and_calls_are_not_counted_twice() {
        let text = "version: 1\nevents: Ir\n\nob=(1) /a\nfl=(1) a.rs\nfn=(1) f\n10 5\nfi=(2) inlined.rs\n+3 7\n\
                    fi=(4) /rustc/0/library/core/src/ops/arith.rs\n9 4\nfe=(1)\n* 2\n\
                    cfi=(3) b.rs\ncfn=(2) g\ncalls=2 40\n-1 100\n12 1\n\nfl=(3)\nfn=(2)\n40 100\n\ntotals: 119\n";
        let counts = by_file(text);
        assert_eq!(counts, [("a.rs", 8), ("inlined.rs", 11), ("b.rs", 100)].map(|(file, cost)| (file.to_owned(), cost)).into());
        assert_eq!(counts.values().sum::<u64>(), 119);
    }
}
