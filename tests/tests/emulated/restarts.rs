//! A device in the emulator that is late, that starts anew in the middle of an earthquake, or that cannot start well.
//!
//! The numbers of `docs/faults.md` come from `cargo test -p sprag-tests --test emulated restarts -- --ignored --nocapture`, with the image that
//! `cargo xtask test` builds. What holds whatever happens is in [`Course::check`].

use std::path::{Path, PathBuf};

use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::device::retained::MOST_RESTARTS;
use sprag_shared::link::reset_cause::Cause;
use sprag_shared::link::{Mishap, Started};
use sprag_shared::settings::Settings;
use sprag_sim::closed_loop::LoopScene;
use sprag_tests::device_loop::{Course, Trial, decides, faithful, mid_swing, on_the_host, pulse, row};
use sprag_tests::emulation::controller_firmware;

/// For how long a board is away when it starts, s.
const BOOT: f64 = 0.02;

/// Counts of the emulated board's counter in a millisecond.
const MILLISECOND: u32 = 1_000_000;

/// Instants at which things happen: before uplift, in the first swing at its fastest, at its end, and half a second later.
fn instants(scene: &LoopScene) -> [(&'static str, f64); 4] {
    let (ticks, _) = on_the_host(scene);
    let uplift = ticks.iter().find(|tick| tick.plant.motion.velocity != 0.0).unwrap().plant.time;
    let impact = ticks.iter().find(|tick| tick.plant.motion.impacts > 0).unwrap().plant.time;
    [
        ("at uplift", uplift),
        ("in mid-swing", mid_swing(&ticks)),
        ("at the first impact", impact),
        ("0.5 s after it", impact + 0.5),
    ]
}

/// A fault injected at `time`, with a boot that takes as long as a board's.
fn course(image: &Path, scene: &LoopScene, time: f64, mishap: Mishap) -> Course {
    Trial { mishaps: &[(time, mishap)], boot_time: BOOT, ..Trial::new(image, scene) }.run(faithful(), &mut ())
}

/// It is away in the safe state, then in control again, knowing where the block truly is. How long that took, ms, and how far off it
/// then is, rad and rad/s.
fn resumed(course: &Course, cause: Cause) -> (Started, f64, f64, f64) {
    let [(number, started)] = course.starts[..] else { panic!("{:?}", course.starts) };
    assert_eq!((started.cause, started.resumed, started.restarts), (cause, true, 1), "{started:?}");
    let begun = number as usize - 1;
    let back = course.ticks[begun..].iter().position(|tick| tick.report.is_some_and(|report| decides(&report.decision))).unwrap();
    let first = &course.ticks[begun + back];
    assert_eq!(first.applied.phase, Phase::Rocking);
    // What the plant is when the tick is due, and what a controller that was never reset believes.
    let truth = course.seen[begun + back - course.prelude].plant.motion;
    let estimate = first.applied.estimate;
    let off = ((f64::from(estimate.rotation) - truth.rotation).abs(), (f64::from(estimate.velocity) - truth.velocity).abs());
    let own = first.own.estimate;
    assert!(off.0 < 1e-4 && off.1 < 0.03, "{off:?}: {estimate:?} for {truth:?}");
    assert!((estimate.rotation - own.rotation).abs() < 1e-4 && (estimate.velocity - own.velocity).abs() < 0.03, "{own:?}");
    // From then on, it never doubts itself.
    assert!(course.ticks[begun + back..].iter().all(|tick| decides(&tick.applied)), "not in control to the end");
    (started, 1e3 * back as f64 * course.period, off.0, off.1)
}

/// In the safe state from the tick of the start until it is back.
fn stays_safe(course: &Course, back: f64) {
    let begun = course.starts[0].0 as usize - 1;
    let safe = course.settings.safe_command();
    for tick in &course.ticks[begun..begun + (back / 1e3 / course.period).round() as usize] {
        assert_eq!(tick.applied.command, safe);
    }
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_reset_in_mid_earthquake_is_resumed_from() {
    let image = controller_firmware();
    let scene = pulse(&["run.free_time_s=0.75"]);
    for (name, time) in instants(&scene) {
        let course = course(&image, &scene, time, Mishap::Reset);
        let (_, back, rotation, velocity) = resumed(&course, Cause::Software);
        stays_safe(&course, back);
        row(
            &format!("reset {name}"),
            "Mishap::Reset; the board takes 20 ms to boot",
            &format!(
                "resumes in Rocking with the calibration of before; off by {rotation:.1e} rad, {velocity:.1e} rad/s; peak |θ|/α {:.4}",
                course.peak
            ),
            Some(0.0),
            Some(back),
            "a_reset_in_mid_earthquake_is_resumed_from",
        );
        assert!(back <= 50.0, "{back} ms");
    }
}

/// A source file of the firmware.
fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../firmware/src").join(name)
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_panic_reports_where_and_a_hard_fault_too() {
    let image = controller_firmware();
    let scene = pulse(&["run.free_time_s=0.75"]);
    let (_, time) = instants(&scene)[1];
    for (mishap, cause) in [(Mishap::Panic, Cause::Panic), (Mishap::HardFault, Cause::HardFault)] {
        let course = course(&image, &scene, time, mishap);
        let (started, back, ..) = resumed(&course, cause);
        stays_safe(&course, back);
        let file = String::from_utf8_lossy(&started.file[..usize::from(started.length)]).into_owned();
        let reported = if cause == Cause::Panic {
            assert!(file.ends_with("link.rs"), "{file}");
            let text = std::fs::read_to_string(source("link.rs")).unwrap();
            assert!(text.lines().nth(started.place as usize - 1).unwrap().contains("panic!(\"rehearsed\")"), "{}", started.place);
            format!("reports {file}, line {}", started.place)
        } else {
            assert!((0x0800_0000..0x0810_0000).contains(&started.place), "{:#x}", started.place);
            // Not which: another image has another one.
            "reports its address".to_owned()
        };
        row(
            &format!("{cause:?} in mid-swing"),
            &format!("Mishap::{mishap:?}; the board takes 20 ms to boot"),
            &format!("{reported}; resumes in Rocking"),
            Some(0.0),
            Some(back),
            "a_panic_reports_where_and_a_hard_fault_too",
        );
        assert!(back <= 50.0, "{back} ms");
    }
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_late_tick_is_a_fault_and_a_lost_one_a_reset() {
    let image = controller_firmware();
    let scene = pulse(&["run.free_time_s=0.75"]);
    let (_, time) = instants(&scene)[1];

    let mishaps = [(time, Mishap::Dawdle(3 * MILLISECOND))];
    let trial = Trial { mishaps: &mishaps, rest: 8.0, clear: true, ..Trial::new(&image, &scene) };
    let late = trial.run(faithful(), &mut ());
    let begun = late.at(time);
    let fault = late.ticks[begun..].iter().find_map(|tick| tick.applied.fault);
    let lateness = late.ticks.iter().filter_map(|tick| tick.report).map(|report| report.lateness).max().unwrap();
    row(
        "a tick takes 3 ms",
        "Mishap::Dawdle in mid-swing",
        &format!(
            "the next one is {:.2} ms late, Fault 61: {}; back when somebody asks, 4 s after the motion",
            f64::from(lateness) / 1e6,
            fault.map_or_else(String::new, |fault| fault.to_string())
        ),
        late.safe_after(begun),
        late.back_after(begun),
        "a_late_tick_is_a_fault_and_a_lost_one_a_reset",
    );
    assert_eq!(fault, Some(Fault::Overrun));
    assert!((2 * MILLISECOND..3 * MILLISECOND).contains(&lateness), "{lateness}");
    assert!(late.starts.is_empty());
    assert!(late.safe_after(begun).unwrap() <= 5.0);
    // 4 s of stillness, then somebody asks.
    assert!(late.back_after(begun).unwrap() > 4000.0 && late.state.phase == Phase::Armed);

    let lost = course(&image, &scene, time, Mishap::Dawdle(30 * MILLISECOND));
    let (_, back, rotation, velocity) = resumed(&lost, Cause::Watchdog);
    row(
        "a tick takes 30 ms",
        "Mishap::Dawdle in mid-swing; the board takes 20 ms to boot",
        &format!("the watchdog resets it after 20 ms; resumes in Rocking, off by {rotation:.1e} rad, {velocity:.1e} rad/s"),
        lost.safe_after(lost.at(time)),
        Some(back),
        "a_late_tick_is_a_fault_and_a_lost_one_a_reset",
    );
    assert!(lost.safe_after(lost.at(time)).unwrap() <= 21.0);
    assert!(back <= 50.0, "{back} ms");
}

/// Whatever makes it start again and again may be what it remembers.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn too_many_restarts_lead_to_a_start_from_the_beginning() {
    let image = controller_firmware();
    let scene = pulse(&[]);
    let (_, time) = instants(&scene)[1];
    let count = usize::from(MOST_RESTARTS) + 1;
    let mishaps: Vec<(f64, Mishap)> = (0..count).map(|number| (time + 0.06 * number as f64, Mishap::Reset)).collect();
    let course = Trial { mishaps: &mishaps, boot_time: BOOT, rest: 8.0, ..Trial::new(&image, &scene) }.run(faithful(), &mut ());
    assert_eq!(course.starts.len(), count);
    for (number, (_, started)) in course.starts.iter().enumerate() {
        assert_eq!(started.restarts as usize, number + 1);
        assert_eq!(started.resumed, number + 1 < count, "{number}: {started:?}");
    }
    let last = course.starts[count - 1].0 as usize - 1;
    let back = course.back_after(last);
    row(
        &format!("{count} resets in a row"),
        "Mishap::Reset every 60 ms from mid-swing on",
        &format!("resumes {} times, then starts from the beginning: self-test and calibration at rest", count - 1),
        course.safe_after(last),
        back,
        "too_many_restarts_lead_to_a_start_from_the_beginning",
    );
    let phases: Vec<Phase> =
        course.ticks[last..].iter().filter_map(|tick| tick.report).map(|report| report.decision.phase).collect();
    assert!(phases.contains(&Phase::SelfTest) && phases.contains(&Phase::Calibrate));
    assert_eq!((course.state.phase, course.state.cause), (Phase::Armed, Cause::Software));
    assert!(back.is_some());
}

/// With other settings than those by which it was in control it must not take control of a block in motion.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn settings_that_a_reset_takes_back_are_not_resumed_from() {
    let image = controller_firmware();
    let scene = pulse(&["run.free_time_s=0.75"]);
    let (_, time) = instants(&scene)[1];
    let trial = Trial { mishaps: &[(time, Mishap::Reset)], boot_time: BOOT, stored: false, ..Trial::new(&image, &scene) };
    let course = trial.run(faithful(), &mut ());
    let [(number, started)] = course.starts[..] else { panic!("{:?}", course.starts) };
    assert_eq!((started.cause, started.resumed, started.stored), (Cause::Software, false, false));
    let begun = number as usize - 1;
    // The safe state of the settings that it started with.
    let safe = Settings::default().safe_command();
    assert!(course.ticks[begun..].iter().all(|tick| tick.applied.command == safe));
    row(
        "reset in mid-swing with settings that are not in flash",
        "Mishap::Reset; the board takes 20 ms to boot",
        "starts from the beginning with the settings in flash: self-test and calibration at rest",
        course.safe_after(begun),
        course.back_after(begun),
        "settings_that_a_reset_takes_back_are_not_resumed_from",
    );
}
