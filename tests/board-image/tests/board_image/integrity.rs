//! A board that is not to be relied upon: bits of its program, of its memory and of its settings, its crystal.

use sprag_board_image::bench::Bench;
use sprag_board_image::chip::{RAM, StuckBit};
use sprag_board_image::image::Image;
use sprag_board_image::model::Model;
use sprag_board_image::rig::{Rig, image_for};
use sprag_board_image::time::in_milliseconds;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::supervisor::{Parameters, Phase};
use sprag_shared::link::{LOG_BLOCK, Reply, Request, State};
use sprag_shared::settings::{Item, Settings};

/// It is in Fault for this reason, its coils in the safe state, and its link answers.
fn stands_aside(rig: &mut Rig, state: &State, fault: Fault, what: &str) {
    assert_eq!((state.phase, state.fault), (Phase::Fault, Some(fault)), "{what}");
    rig.ticks(400);
    let engaged = rig.bench.chip().coils.each_ref().map(|coil| coil.current > 0.1);
    assert_eq!(engaged, Parameters::default().safe_state.command(), "{what}");
    assert!(matches!(rig.ask(&Request::Identify), Reply::Identity(_)), "{what}");
}

/// Seconds, in ticks of the default period.
const SECOND: usize = 2000;

/// Where an image is loaded: bytes that no start needs, from its last ones and its vectors of interrupts, and its seal.
fn places(image: &Image) -> Vec<(u32, &'static str)> {
    let seal = 0x5EA1_ED01_u32.to_le_bytes();
    let found = image.segments.iter().find_map(|(address, bytes)| {
        let place = bytes.windows(4).position(|window| window == seal)?;
        Some(address + place as u32)
    });
    let seal = found.expect("an image that has been sealed");
    // The vector of an interrupt that is not used, a stretch's end, the checksum, and constants at the end.
    vec![
        (0x0800_0100, "a vector"),
        (seal + 8, "the seal's stretch"),
        (seal + 36, "the seal's checksum"),
        (image.end() - 1, "the last byte"),
    ]
}

#[test]
fn a_bit_of_the_program_that_has_turned_is_a_fault_at_the_start() {
    for model in Model::ALL {
        let image = image_for(model);
        for (place, what) in places(&image) {
            for bit in [0, 7] {
                let mut rig = Rig::new(&image, Some(&Settings::default()));
                flip(&mut rig, place, bit);
                rig.boot();
                let state = rig.wait(40, |state| state.phase == Phase::Fault);
                stands_aside(&mut rig, &state, Fault::ImageDamaged, &format!("{model:?}, {what}, bit {bit}"));
            }
        }
    }
}

fn flip(rig: &mut Rig, place: u32, bit: u32) {
    let memory = &rig.bench.chip().flash.memory;
    let mut byte = [0];
    memory.read(place, &mut byte);
    memory.write(place, &[byte[0] ^ 1 << bit]);
}

#[test]
fn a_bit_of_the_program_that_turns_in_operation_is_a_fault_within_seconds() {
    for model in Model::ALL {
        let mut rig = Rig::armed(model);
        rig.ticks(3 * SECOND);
        assert_eq!(rig.state().fault, None, "{model:?}");
        let end = image_for(model).end();
        flip(&mut rig, end - 1, 3);
        let before = rig.bench.now();
        let state = rig.wait(6 * SECOND, |state| state.phase == Phase::Fault);
        println!("{model:?}: found {:.0} ms later", in_milliseconds(rig.bench.now() - before));
        stands_aside(&mut rig, &state, Fault::ImageDamaged, &format!("{model:?}"));
    }
}

/// An image without a seal runs, and says so.
#[test]
fn a_program_without_a_seal_is_reported() {
    let mut image = image_for(Model::F405);
    for (_, bytes) in &mut image.segments {
        if let Some(place) = bytes.windows(4).position(|window| window == 0x5EA1_ED01_u32.to_le_bytes()) {
            bytes[place..place + 40].fill(0);
            bytes[place..place + 4].copy_from_slice(&(!0x5EA1_ED01_u32).to_le_bytes());
        }
    }
    let mut rig = Rig::new(&image, Some(&Settings::default()));
    rig.arm();
    let Reply::Identity(identity) = rig.ask(&Request::Identify) else { panic!("no identity") };
    assert!(!identity.sealed);
    let Reply::Log(log) = rig.ask(&Request::Log { from: 0 }) else { panic!("no log") };
    let faults: Vec<_> = log.entries[..LOG_BLOCK].iter().filter_map(|entry| entry.entry()?.kind.fault()).collect();
    assert_eq!(faults, [Fault::NotSealed]);
}

/// At a bit of the stack, of nothing's, of the last word; one that is always set and one that never is.
#[test]
fn a_stuck_bit_of_the_memory_is_a_fault_before_it_arms() {
    for model in Model::ALL {
        for (address, bit) in [(RAM + 0x1235, 4), (RAM + 0x1_5002, 0), (RAM + 0x1_FFFF, 7)] {
            for set in [false, true] {
                let stuck = StuckBit { address, bit, set };
                let mut rig = Rig::on(Bench::with(&image_for(model), Some(stuck)), Some(&Settings::default()));
                rig.boot();
                let state = rig.wait(2 * SECOND, |state| matches!(state.phase, Phase::Fault | Phase::Armed));
                stands_aside(&mut rig, &state, Fault::MemoryDamaged, &format!("{model:?}, {stuck:?}"));
            }
        }
    }
}

/// What the memory holds is as before, whatever is tested: ten seconds of operation with requests, and a second pass over all of it.
#[test]
fn testing_the_memory_changes_nothing() {
    for model in Model::ALL {
        let mut rig = Rig::armed(model);
        for _ in 0..10 {
            rig.ticks(SECOND);
            let Reply::Identity(identity) = rig.ask(&Request::Identify) else { panic!("no identity") };
            assert_eq!(identity.check, Settings::default().check());
        }
        let state = rig.state();
        assert_eq!((state.phase, state.fault, state.worst_lateness, state.bad_frames), (Phase::Armed, None, 0, 0), "{model:?}");
    }
}

/// Words of the settings are there in the controller and in the settings, which matter; in the draft, in what is in flash, and where a buffer that
/// nobody has written to was laid over them while the program started.
#[test]
fn a_bit_of_the_settings_that_turns_in_memory_is_a_fault_within_seconds() {
    for model in Model::ALL {
        let word = Settings::default().words()[usize::from(Item::Uplift.index())];
        let rig = Rig::armed(model);
        let memory = RAM + 0x8000..RAM + 0x1_0000;
        let places: Vec<u32> = memory.step_by(4).filter(|place| rig.bench.chip().ram.word(*place) == word).collect();
        let count = places.len();
        assert!(count >= 4, "{model:?}: {count}");
        let mut found = Vec::new();
        rig.for_each(places, |rig, place| {
            rig.bench.chip().ram.write(place, &(word ^ 1 << 5).to_le_bytes());
            let state = rig.wait(5 * SECOND, |state| state.phase == Phase::Fault);
            if state.fault.is_some() {
                stands_aside(rig, &state, Fault::SettingsDamaged, &format!("{model:?}, {place:#x}"));
            }
            found.push(state.fault);
        });
        println!("{model:?}: {found:?}");
        assert_eq!(found.iter().flatten().count(), 2, "{model:?}: {found:?}");
    }
}

/// The fault that comes within three seconds of a crystal whose rate is off by so much, beside a slow oscillator of that rate.
fn with_crystal(model: Model, share: f64, slow_hz: u64) -> Option<Fault> {
    let mut rig = Rig::new(&image_for(model), Some(&Settings::default()));
    let chip = rig.bench.chip_mut();
    chip.set_crystal((8e6 * share) as u64);
    chip.watchdog.hz = slow_hz;
    rig.boot();
    let state = rig.wait(3 * SECOND, |state| state.phase == Phase::Fault);
    let fault = state.fault;
    println!(
        "{model:?}: crystal {share}, slow oscillator {slow_hz}/s: {fault:?} after {:.0} ms",
        in_milliseconds(rig.bench.now())
    );
    if fault.is_some() {
        stands_aside(&mut rig, &state, Fault::ClockWrong, &format!("{model:?}, {share}, {slow_hz}"));
    }
    fault
}

/// Whatever the slow oscillator's own rate: 17 to 47 kHz (DS8626, table 42), 29.5 to 34 kHz (DS12288).
#[test]
fn a_crystal_that_is_off_is_a_fault_and_a_slow_oscillator_that_is_off_is_none() {
    for (model, extremes) in [(Model::F405, [17_000, 47_000]), (Model::G474, [29_500, 34_000])] {
        for (share, wrong) in [(1.0, false), (1.03, false), (1.07, true), (0.93, true), (0.5, true)] {
            assert_eq!(with_crystal(model, share, 32_000).is_some(), wrong, "{model:?}, {share}");
        }
        for slow in extremes {
            assert_eq!(with_crystal(model, 1.0, slow), None, "{model:?}, {slow}");
            assert_eq!(with_crystal(model, 1.07, slow), Some(Fault::ClockWrong), "{model:?}, {slow}");
        }
    }
}

/// A crystal that changes to another rate in operation.
#[test]
fn a_crystal_that_changes_its_rate_is_a_fault_within_seconds() {
    for model in Model::ALL {
        let mut rig = Rig::armed(model);
        rig.bench.chip_mut().set_crystal(8_600_000);
        let state = rig.wait(5 * SECOND, |state| state.phase == Phase::Fault);
        stands_aside(&mut rig, &state, Fault::ClockWrong, &format!("{model:?}"));
    }
}
