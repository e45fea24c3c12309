//! The board's image through its own buses, counter, converter and coils, in lockstep with the simulated plant.

use std::path::{Path, PathBuf};

use sprag_cli::board::image::build_bench;
use sprag_shared::control::law::Wish;
use sprag_shared::control::supervisor::Phase;
use sprag_sim::closed_loop::LoopScene;
use sprag_sim::closed_loop::plant::Extremes;
use sprag_sim::closed_loop::run::{Ending, Tick};
use sprag_sim::interrupt::Interrupt;
use sprag_tests::board_loop::BoardDriver;
use sprag_tests::device_loop::{decides, pulse, scene};
use sprag_tests::emulation::board_firmware;

/// The board's own sensors.
const SENSORS: &str = "controller.sensors.suite=\"icm-42688-p\"";

/// The bench and the image.
fn parts() -> (PathBuf, PathBuf) {
    (build_bench().unwrap(), board_firmware())
}

struct Run {
    driver: BoardDriver,
    ending: Ending,
    /// Largest |θ|/α.
    peak: f64,
    seen: Vec<Tick>,
}

/// Closes the loop of a scene's first pair by the board, with a reset in the period that `reset` makes of the number of those before the
/// motion.
fn run((bench, image): &(PathBuf, PathBuf), scene: &LoopScene, reset: Option<f64>) -> Run {
    let (bench, image): (&Path, &Path) = (bench, image);
    let interrupt = Interrupt::default();
    let task = scene.task(scene.pairs[0], scene.controller.sensors.seed(), &interrupt);
    let clock = task.clock();
    let own = task.driver().unwrap();
    let mut driver = BoardDriver::new(bench, image, &task.settings().unwrap(), own);
    driver.reset_at = reset.map(|time| ((clock.prelude + time) / clock.period).round() as u32);
    let (mut seen, mut extremes) = (Vec::new(), Extremes::default());
    let ending = task.run_with(&mut driver, &mut (), &mut extremes, &mut seen).unwrap();
    Run { driver, ending, peak: extremes.peaks.rotation / scene.scene.block.slenderness(), seen }
}

fn one_code(name: &str, scene: &LoopScene) {
    let Run { driver, ending, peak, .. } = run(&parts(), scene, None);
    println!(
        "| {name} | {} | {} | {} | {} | {peak:.4} | {:?} |",
        driver.periods, driver.compared, driver.differing, driver.changes, ending.faults
    );
    assert_eq!(driver.differing, 0, "{name}");
    // All but the first ones, before it streamed, and the last.
    assert!(driver.periods - driver.compared < 100, "{name}: {} of {}", driver.compared, driver.periods);
    assert!(ending.faults.is_empty(), "{name}: {:?}", ending.faults);
    let rocked = driver.reports.iter().any(|(_, report)| report.decision.phase == Phase::Rocking);
    assert!(rocked && driver.changes >= 4, "{name}: {}", driver.changes);
    assert_eq!(driver.starts.len(), 1, "{name}");
}

#[test]
#[ignore = "needs Unicorn and the board's image: run by cargo xtask test"]
fn figure_5_is_decided_alike_from_the_same_counts() {
    one_code("Figure 5", &scene("figure05.toml", &[SENSORS]));
}

#[test]
#[ignore = "needs Unicorn and the board's image: run by cargo xtask test"]
fn figure_10_is_decided_alike_from_the_same_counts() {
    one_code("Figure 10", &scene("figure10.toml", &[SENSORS]));
}

#[test]
#[ignore = "needs Unicorn and the board's image: run by cargo xtask test"]
fn the_near_fault_motion_is_decided_alike_from_the_same_counts() {
    one_code("near fault", &scene("near_fault.toml", &[SENSORS, "run.free_time_s=0.5"]));
}

/// At none of 20 phases does it cost 5 % of the peak.
#[test]
#[ignore = "needs Unicorn and the board's image: run by cargo xtask test"]
fn a_reset_at_any_phase_of_an_earthquake_is_resumed_from() {
    let (parts, scene) = (parts(), pulse(&[SENSORS, "run.free_time_s=0.6"]));
    let undisturbed = run(&parts, &scene, None);
    let begin = undisturbed.seen.iter().find(|tick| tick.plant.motion.velocity != 0.0).unwrap().plant.time;
    let end = undisturbed.seen.last().unwrap().plant.time - 0.1;
    println!("undisturbed: {:.4}; from {begin:.3} s to {end:.3} s", undisturbed.peak);
    let (mut latest, mut costs) = (0.0_f64, Vec::new());
    for phase in 0..20 {
        let time = begin + (end - begin) * f64::from(phase) / 20.0;
        let Run { driver, peak, .. } = run(&parts, &scene, Some(time));
        let reset = driver.reset_at.unwrap();
        let back = driver.reports.iter().find(|(at, report)| *at > reset && decides(&report.decision)).unwrap();
        let after = 0.5 * f64::from(back.0 - reset);
        // Until an impact has shown where θ = 0 is, one flywheel is held.
        let located = driver.reports.iter().find(|(at, report)| *at >= back.0 && report.decision.wish != Wish::Hold);
        let held = located.map_or(f64::INFINITY, |(at, _)| 0.5 * f64::from(at - reset));
        let cost = peak / undisturbed.peak - 1.0;
        println!(
            "phase {phase}, {time:.3} s: in control after {after:.1} ms, the law decides after {held:.1} ms, peak {:+.2} %",
            100.0 * cost
        );
        assert!(driver.starts.last().is_some_and(|(_, started)| started.resumed), "phase {phase}");
        assert!(after <= 50.0, "phase {phase}: {after} ms");
        latest = latest.max(after);
        costs.push(cost);
    }
    costs.sort_by(f64::total_cmp);
    println!("of 20 phases: in control after {latest:.1} ms, peaks up to {:+.2} %", 100.0 * costs[19]);
    assert!(costs[19] < 0.05, "{costs:?}");
}
