//! One code: the firmware on the emulated Cortex-M4F gives every command and every estimate that the same controller gives on the host, to
//! the last bit, over whole scenes.
//!
//! Needs the image that `cargo xtask test` builds; `-- --nocapture` shows the numbers.

use sprag_cli::board::emulator::Way;
use sprag_cli::board::image::build_bench;
use sprag_cli::board::report::costs;
use sprag_shared::control::supervisor::Phase;
use sprag_sim::closed_loop::LoopScene;
use sprag_sim::digest::of_decisions;
use sprag_tests::device_loop::{Course, Trial, faithful, on_the_host, pulse, scene};
use sprag_tests::digests::of_scene;
use sprag_tests::emulation::{board_firmware, controller_firmware};

/// Runs `scene` on the device in the emulator and on the host.
fn one_code(name: &str, scene: &LoopScene, way: Way) -> Course {
    compare(name, &Trial { way, ..Trial::new(&controller_firmware(), scene) })
}

/// Runs a trial on its device and on the host.
fn compare(name: &str, trial: &Trial<'_>) -> Course {
    let (host, peak) = on_the_host(trial.scene);
    let begun = std::time::Instant::now();
    let course = trial.run(faithful(), &mut ());
    let seconds = begun.elapsed().as_secs_f64();
    // The decisions that the device sent, beside those of the same code on the host, which was given the same.
    assert_eq!(course.differing(), 0, "{name}");
    // And so the loop is the one that the host closes by itself.
    assert_eq!(course.seen.len(), host.len(), "{name}");
    for (device, host) in course.seen.iter().zip(&host) {
        assert_eq!(device.decision, host.decision, "{name}: {} s", host.plant.time);
        assert_eq!(device.plant.motion.rotation.to_bits(), host.plant.motion.rotation.to_bits(), "{name}: {} s", host.plant.time);
    }
    assert_eq!(course.peak.to_bits(), peak.to_bits());
    let commands = commands(&course);
    // What decides nothing is not compared.
    assert!(commands >= 4 && course.seen.iter().any(|tick| tick.decision.phase == Phase::Rocking), "{name}: {commands}");
    let (median, worst) = costs(&course.ticks).unwrap();
    println!(
        "| {name} | {} | {} | {commands} | {peak:.4} | {median} | {worst} | {} | {:.0} |",
        course.ticks.len(),
        course.differing(),
        course.state.stack,
        course.ticks.len() as f64 / seconds
    );
    course
}

/// Runs a scene of `scenes/digests.csv` on the device, the host and by the digest that every other machine has of it.
fn everywhere(name: &str) {
    let course = one_code(name, &scene(&format!("{name}.toml"), &[]), Way::Streams);
    let decisions = of_decisions(&course.seen);
    assert_eq!(decisions, of_scene(name).decisions, "{name}: {decisions:016x}");
}

/// Changes of command.
fn commands(course: &Course) -> usize {
    course.ticks.windows(2).filter(|pair| pair[0].applied.command != pair[1].applied.command).count()
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn figure_5_is_the_same_on_the_device() {
    everywhere("figure05");
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn figure_10_is_the_same_on_the_device() {
    everywhere("figure10");
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn the_near_fault_motion_is_the_same_on_the_device() {
    everywhere("near_fault");
}

/// Byte by byte through the emulated USART1, each sample a tick.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_pulse_is_the_same_by_the_serial_line() {
    one_code(
        "sine pulse by USART",
        &pulse(&["run.free_time_s=0.1", "controller.rate_hz=500", "controller.prelude_s=1.6"]),
        Way::Usart,
    );
}

/// The board's own image, unmodified, as `sprag hil --board-image` runs it.
#[test]
#[ignore = "needs Unicorn and the board's image: run by cargo xtask test"]
fn a_pulse_is_the_same_on_the_boards_image() {
    let (image, bench, scene) = (board_firmware(), build_bench().unwrap(), pulse(&["run.free_time_s=0.5"]));
    compare("sine pulse on the board's image", &Trial { bench: Some(&bench), ..Trial::new(&image, &scene) });
}
