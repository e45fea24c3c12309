//! Faults between the plant and a device in the emulator: a bad link, bad sensors, bad clutches.
//!
//! The numbers of `docs/faults.md` come from `cargo test -p sprag-tests --test emulated faults -- --ignored --nocapture`, with the image that
//! `cargo xtask test` builds. What holds whatever happens is in [`Course::check`].

use sprag_cli::board::faulty::{Direction, Fate};
use sprag_shared::control::controller::Circumstances;
use sprag_shared::control::monitor::fault::{Fault, Recovery};
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::sensing::sensor::Sensor;
use sprag_shared::control::supervisor::Phase;
use sprag_sim::closed_loop::LoopScene;
use sprag_sim::closed_loop::disturbance::Disturbance;
use sprag_sim::closed_loop::failing::{ALL, Failing, Injected, Part};
use sprag_tests::device_loop::{Course, Timed, Trial, faithful, mid_swing, on_the_host, pulse, row};
use sprag_tests::dice::Dice;
use sprag_tests::emulation::controller_firmware;

/// What becomes of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Damage {
    Lost,
    Doubled,
    Reordered,
    Corrupted,
    Cut,
}

/// Frames in both directions are damaged, this share of them.
fn damaged(damage: Damage, share: f64) -> impl Fate {
    let mut dice = Dice::new(7);
    let mut held: [Vec<u8>; 2] = Default::default();
    move |direction: Direction, _: u64, frame: &[u8]| {
        let held = &mut held[direction as usize];
        let mut arrived = frame.to_vec();
        let hit = dice.hits(share);
        match damage {
            Damage::Reordered if hit && held.is_empty() => std::mem::swap(held, &mut arrived),
            Damage::Reordered => arrived.append(held),
            _ if !hit => {}
            Damage::Lost => arrived.clear(),
            Damage::Doubled => arrived.extend(frame),
            Damage::Corrupted => {
                let place = dice.below(arrived.len());
                arrived[place] ^= 1 << dice.below(8);
            }
            Damage::Cut => arrived.truncate(dice.below(frame.len())),
        }
        arrived
    }
}

/// The worst that damaged frames do to the estimates that reach the plant: differences from those of the host's controller, which hears
/// everything, in rad and rad/s.
fn worst_difference(course: &Course) -> (f32, f32) {
    course.ticks[course.prelude..].iter().fold((0.0, 0.0), |(rotation, velocity), tick| {
        let (device, own) = (tick.applied.estimate, tick.own.estimate);
        (rotation.max((device.rotation - own.rotation).abs()), velocity.max((device.velocity - own.velocity).abs()))
    })
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn damaged_frames_are_missed_and_nothing_else() {
    let image = controller_firmware();
    let scene = pulse(&[]);
    let (_, peak) = on_the_host(&scene);
    let cases = [
        (Damage::Lost, 0.01),
        (Damage::Lost, 0.1),
        (Damage::Doubled, 0.1),
        (Damage::Reordered, 0.1),
        (Damage::Corrupted, 0.1),
        // A cut frame takes the next one with it, so that 10 % of them make gaps that are faults.
        (Damage::Cut, 0.03),
    ];
    for (damage, share) in cases {
        let course = Trial::new(&image, &scene).run(damaged(damage, share), &mut ());
        let missing = course.ticks.iter().filter(|tick| tick.report.is_none()).count();
        let (rotation, velocity) = worst_difference(&course);
        row(
            &format!("{:.0} % of all frames {damage:?}", 100.0 * share),
            "both ways, at random",
            &format!(
                "{missing} of {} reports missing, {} bad frames; estimates off by {rotation:.1e} rad, {velocity:.1e} rad/s; peak |θ|/α \
                 {:.4} for {peak:.4}",
                course.ticks.len(),
                course.state.bad_frames,
                course.peak
            ),
            None,
            None,
            "damaged_frames_are_missed_and_nothing_else",
        );
        assert!(course.ticks.iter().all(|tick| tick.applied.phase != Phase::Fault), "{damage:?}: a fault for a missing frame");
        assert!((course.peak - peak).abs() < 0.02 * peak, "{damage:?}: {} for {peak}", course.peak);
        assert_eq!(course.state.bad_frames > 0, matches!(damage, Damage::Corrupted | Damage::Cut), "{damage:?}");
        if damage == Damage::Doubled {
            assert_eq!(course.differing(), 0, "a frame that comes twice counts once");
        }
    }
}

/// Samples do not arrive for a while, from mid-swing on.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_silent_link_puts_the_clutches_into_the_safe_state() {
    let image = controller_firmware();
    let scene = pulse(&[]);
    let from = mid_swing(&on_the_host(&scene).0);
    for (silence, rest) in [(0.002, 0.0), (0.005, 6.0), (0.1, 6.0), (4.0, 8.0)] {
        let mut timed = Timed::new(());
        let time = timed.time.clone();
        let mut left = (silence / 0.0005_f64).round() as u32;
        let fate = move |direction: Direction, _: u64, frame: &[u8]| {
            if direction == Direction::ToDevice && time.get() >= from && left > 0 {
                left -= 1;
                return Vec::new();
            }
            frame.to_vec()
        };
        let course = Trial { rest, ..Trial::new(&image, &scene) }.run(fate, &mut timed);
        let begun = course.at(from);
        let (safe, back) = (course.safe_after(begun), course.back_after(begun));
        let fault = course.ticks[begun..].iter().find_map(|tick| tick.applied.fault);
        let does = fault.map_or_else(|| "continues by its model".to_owned(), |fault| format!("Fault {}: {fault}", fault.code()));
        row(
            &format!("no samples for {} ms", 1e3 * silence),
            "frames to the device dropped from mid-swing on",
            &does,
            safe,
            back,
            "a_silent_link_puts_the_clutches_into_the_safe_state",
        );
        if silence < 0.003 {
            assert_eq!(fault, None);
            continue;
        }
        assert!(matches!(fault, Some(Fault::Stale(_))), "{fault:?}");
        assert!(safe.unwrap() <= 5.0, "{safe:?} ms");
        let back = back.unwrap();
        assert!(back > 1e3 * silence && course.state.phase == Phase::Armed, "{back} ms, {:?}", course.state.phase);
        assert!(course.starts.is_empty());
    }
}

/// One fault of the sensors, the clutches or the clock, from mid-swing on.
fn injected(image: &std::path::Path, scene: &LoopScene, failing: Failing, from: f64) {
    let course = Trial::new(image, scene).run(faithful(), &mut Injected::new(failing, from));
    // The same code, given the same: the same fault at the same tick.
    assert_eq!(course.differing(), 0, "{failing:?}");
    let begun = course.at(from);
    let fault = course.ticks[begun..].iter().find_map(|tick| tick.applied.fault);
    let does =
        fault.map_or_else(|| "not seen before all is still".to_owned(), |fault| format!("Fault {}: {fault}", fault.code()));
    row(
        &format!("{failing}"),
        if failing == Failing::Refuses {
            "clutches, from before the motion on"
        } else {
            "samples or clutches, from mid-swing on"
        },
        &does,
        course.safe_after(begun).filter(|_| fault.is_some()),
        None,
        "every_fault_of_the_sensors_is_found_at_the_hosts_tick",
    );
    match failing {
        Failing::Contradicts(Part::Ground) => {}
        Failing::Stale(part) | Failing::Stuck(part) | Failing::Saturated(part) | Failing::NotFinite(part) => {
            let sensor = match part {
                Part::Gyroscope => Sensor::Gyroscope,
                Part::Ground => Sensor::GroundAccelerometer,
                Part::Encoder => Sensor::Encoder,
            };
            assert_eq!(fault.and_then(Fault::sensor), Some(sensor), "{failing:?}");
        }
        Failing::Contradicts(_) => assert!(matches!(fault, Some(Fault::Contradiction(_))), "{failing:?}: {fault:?}"),
        Failing::Overrun => assert_eq!(fault, Some(Fault::Overrun)),
        Failing::Refuses => assert!(matches!(fault, Some(Fault::ClutchRefuses(_))), "{fault:?}"),
        Failing::Sticks => assert!(matches!(fault, Some(Fault::ClutchEngagedUnbidden(_))), "{fault:?}"),
    }
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn every_fault_of_the_sensors_is_found_at_the_hosts_tick() {
    let image = controller_firmware();
    let scene = pulse(&["run.free_time_s=0.75"]);
    let from = mid_swing(&on_the_host(&scene).0);
    for failing in ALL {
        // A clutch refuses what it is asked, so it must be asked: at rest it is to be engaged.
        let from = if failing == Failing::Refuses { 0.1 } else { from };
        injected(&image, &scene, failing, from);
    }
}

/// A fault that ends, and somebody who asks to leave Fault once all is still.
struct Passing {
    fault: Injected,
    span: (f64, f64),
}

impl Disturbance for Passing {
    fn disturb(&mut self, time: f64, sample: &mut Sample, circumstances: &mut Circumstances) {
        if time < self.span.1 {
            self.fault.disturb(time, sample, circumstances);
        }
    }
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_sensor_that_recovers_is_trusted_again_after_the_motion() {
    let image = controller_firmware();
    let scene = pulse(&[]);
    let from = mid_swing(&on_the_host(&scene).0);
    let failing = Failing::Stale(Part::Gyroscope);
    let mut passing = Passing { fault: Injected::new(failing, from), span: (from, from + 0.05) };
    let course = Trial { rest: 6.0, ..Trial::new(&image, &scene) }.run(faithful(), &mut passing);
    assert_eq!(course.differing(), 0);
    let begun = course.at(from);
    let (safe, back) = (course.safe_after(begun), course.back_after(begun));
    let fault = course.ticks[begun..].iter().find_map(|tick| tick.applied.fault).unwrap();
    assert_eq!(fault.recovery(), Recovery::WhenGood);
    row(
        &format!("{failing} for 50 ms"),
        "samples, from mid-swing on",
        &format!("Fault {}: {fault}; by itself through a new calibration, once nothing moves", fault.code()),
        safe,
        back,
        "a_sensor_that_recovers_is_trusted_again_after_the_motion",
    );
    assert_eq!(course.state.phase, Phase::Armed);
    // It has not come back while the block rocked.
    let rocking = course.seen.iter().rfind(|tick| tick.plant.motion.velocity != 0.0).unwrap().plant.time;
    assert!(from + back.unwrap() / 1e3 > rocking);
}
