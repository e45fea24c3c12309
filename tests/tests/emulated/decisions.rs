//! The controller on the emulated Cortex-M4F: the same decisions as on the host, to the last bit, and cheap enough.
//!
//! Needs what `emulator.rs` needs. What runs there is run here from the same file.

#[path = "../../emulated-core/src/kernels/controller/mod.rs"]
mod controller;

use std::collections::BTreeMap;

use sprag_tests::emulation::{emulate, firmware, kernels};

/// Instructions that reading the sensors and estimating may take with the leanest estimator, and a whole control tick (prediction, law, turns,
/// dwell and supervisor included) with the richest.
const LIMITS: [u32; 2] = [700, 2600];

const ESTIMATORS: [&str; 3] = ["model-aided", "kalman", "complementary"];

/// What follows the word of a line, by the name of the run.
fn digests(lines: &str) -> BTreeMap<&str, &str> {
    lines.lines().filter_map(|line| line.strip_prefix("digest controller-")?.split_once(' ')).collect()
}

/// Worst tick of a run.
fn worst(lines: &str, name: &str) -> u32 {
    let start = format!("kernel controller-{name} ");
    let line = lines.lines().find(|line| line.starts_with(&start)).unwrap();
    line.rsplit_once("worst ").unwrap().1.trim_end_matches(')').parse().unwrap()
}

fn board() -> String {
    emulate(&firmware(), tempfile::tempdir().unwrap().path(), None)
}

fn host() -> String {
    let mut lines = String::new();
    controller::report(&mut || 0, &mut lines).unwrap();
    lines
}

#[test]
fn runs_decide_differently() {
    let host = host();
    let here = digests(&host);
    assert_eq!(here.len(), 12);
    // A tick in parts is the same tick; all else differs.
    assert_eq!(here["parts"], here["model-aided"]);
    let different: std::collections::BTreeSet<&&str> = here.values().collect();
    assert_eq!(different.len(), 11, "{here:?}");
    let commands = |line: &str| line.split(['(', ' ']).nth(2).unwrap().parse::<u32>().unwrap();
    for (name, line) in &here {
        // Four of them are the self-test's, and two each of the safe state before and after it, which engages one.
        assert!(if *name == "passive" { commands(line) == 8 } else { commands(line) > 10 }, "{name} {line}");
    }
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn the_board_decides_as_the_host_does() {
    let (board, host) = (board(), host());
    assert_eq!(digests(&board), digests(&host), "{board}");
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_control_tick_is_cheap_enough() {
    let lines = board();
    print!("{lines}");
    let kernels = kernels(&lines);
    let estimating = kernels["controller-part-instruments-and-estimator"];
    assert!((100..=LIMITS[0]).contains(&estimating), "{estimating} instructions to estimate");
    for name in ESTIMATORS {
        let (median, worst) = (kernels[format!("controller-{name}").as_str()], worst(&lines, name));
        println!("{name}: median {median}, worst {worst}");
        // A tick that costs next to nothing has not been taken.
        assert!((200..=LIMITS[1]).contains(&median), "{name}: {median} instructions a tick");
        assert!(worst >= median && worst <= LIMITS[1], "{name}: {worst} instructions at worst");
    }
}
