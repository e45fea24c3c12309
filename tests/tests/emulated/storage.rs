//! A device in the emulator whose supply fails while settings are written, and one that is sent rubbish.
//!
//! The numbers of `docs/faults.md` come from `cargo test -p sprag-tests --test emulated storage -- --ignored --nocapture`, with the image that
//! `cargo xtask test` builds.

use std::path::Path;
use std::time::{Duration, Instant};

use sprag_cli::board::emulator::{Emulator, Way};
use sprag_cli::board::image::Image;
use sprag_cli::board::line::Line as _;
use sprag_cli::board::parameters;
use sprag_cli::board::session::Session;
use sprag_shared::control::sensing::sample::{Count, Reading, Sample};
use sprag_shared::link::reset_cause::Cause;
use sprag_shared::link::{Done, MAX_FRAME, Mishap, Pace, Reply, Request, Started, TickSample, WORD_BLOCK, Words, encode};
use sprag_shared::settings::store::SLOT_BYTES;
use sprag_shared::settings::{Item, Settings};
use sprag_tests::device_loop::row;
use sprag_tests::dice::Dice;
use sprag_tests::emulation::controller_firmware;

/// Longest silence of a device that has not hung, on any machine that tests run on.
const PATIENCE: Duration = Duration::from_secs(20);

fn start(image: &Path) -> Session<Emulator> {
    Session::new(Emulator::start(Image::File(image.to_owned()), Way::Streams, None).unwrap())
}

/// Writes the draft, orders it to be stored with the supply about to fail, and says what came of it.
fn store(session: &mut Session<Emulator>, settings: &Settings, bytes: u32) -> Result<Done, Started> {
    for (number, block) in settings.words().chunks(WORD_BLOCK).enumerate() {
        let mut words = [0; WORD_BLOCK];
        words[..block.len()].copy_from_slice(block);
        let words = Words { first: (number * WORD_BLOCK) as u16, count: block.len() as u8, words };
        session.order(&Request::Write(words)).unwrap();
    }
    session.rehearse(Mishap::PowerCut(bytes)).unwrap();
    let tag = session.send(&Request::Apply { check: settings.check(), store: true }).unwrap();
    let asked = Instant::now();
    while asked.elapsed() < PATIENCE {
        let replies = session.receive(PATIENCE).unwrap();
        if let Some(started) = session.take_started() {
            return Err(started);
        }
        for (of, reply) in replies {
            match reply {
                Reply::Done(done) if of == tag => return Ok(done),
                reply => assert_ne!(of, tag, "{reply:?}"),
            }
        }
    }
    panic!("silent after a power cut at byte {bytes}");
}

/// At every byte of both copies.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_power_cut_leaves_the_old_settings_or_the_new() {
    let image = controller_firmware();
    let mut session = start(&image);
    let mut one = Settings::default();
    one.set(Item::Slenderness.index(), 0.2_f32.to_bits()).unwrap();
    let mut other = one;
    other.set(Item::Restitution.index(), 0.7_f32.to_bits()).unwrap();
    parameters::write(&mut session, &one, true).unwrap();
    session.take_started();
    let (mut stored, mut cuts, mut survivors) = (one, 0, [0; 2]);
    let done = loop {
        let next = if stored == one { other } else { one };
        match store(&mut session, &next, cuts) {
            Ok(done) => break done,
            Err(started) => {
                assert_eq!((started.cause, started.stored, started.resumed), (Cause::PowerOn, true, false), "byte {cuts}");
                let found = parameters::read(&mut session).unwrap();
                assert!(found == stored || found == next, "byte {cuts}: neither the old settings nor the new ones");
                survivors[usize::from(found == next)] += 1;
                stored = found;
            }
        }
        cuts += 1;
    };
    assert_eq!(done, Done::Stored);
    // Every byte of both copies has been the first one that was not written, and so has each erased sector where there was no room.
    assert!((2 * SLOT_BYTES..=2 * SLOT_BYTES + 2).contains(&cuts), "{cuts}");
    // Where there is no room the flash is erased first, and the power fails there too, which leaves the old ones.
    assert!(survivors[0] >= SLOT_BYTES - 1 && survivors[1] > SLOT_BYTES / 2, "{survivors:?}");
    row(
        "the supply fails while settings are stored",
        &format!("Mishap::PowerCut at each of {cuts} bytes"),
        &format!("{} times the old settings, {} times the new ones, never the defaults", survivors[0], survivors[1]),
        None,
        None,
        "a_power_cut_leaves_the_old_settings_or_the_new",
    );
}

fn bits(dice: &mut Dice) -> f32 {
    f32::from_bits(dice.word())
}

/// A whole frame with any content, but none that a device is to obey: no fault injection, no settings with the right check.
fn whole(dice: &mut Dice) -> Vec<u8> {
    let reading = |dice: &mut Dice| Reading { value: bits(dice), number: dice.word() };
    let request = match dice.below(14) {
        0 => Request::Identify,
        1 => Request::State,
        2 => Request::Read { first: dice.below(200) as u16 },
        3 | 4 => {
            let words = std::array::from_fn(|_| if dice.hits(0.5) { dice.word() } else { dice.below(3) as u32 });
            Request::Write(Words { first: dice.below(140) as u16, count: dice.below(20) as u8, words })
        }
        5 => Request::Apply { check: dice.word(), store: dice.hits(0.5) },
        6 => Request::Discard,
        7 => Request::Log { from: if dice.hits(0.5) { dice.word() } else { dice.below(100) as u32 } },
        8 => Request::Clear,
        9 => Request::SelfTest,
        10 => Request::Stream { every: dice.below(4) as u16 },
        11 => Request::Attach { pace: if dice.hits(0.5) { Pace::Timer } else { Pace::Sample } },
        12 => Request::Detach,
        _ => {
            let sample = Sample {
                gyroscope: reading(dice),
                block_accelerometer: [reading(dice), reading(dice)],
                ground_accelerometer: [reading(dice), reading(dice)],
                encoder: Count { counts: dice.word() as i32, number: dice.word() },
                engaged: [dice.hits(0.5), dice.hits(0.5)],
            };
            Request::Sample(TickSample { number: dice.word(), sample, lateness: bits(dice), clear: dice.hits(0.5) })
        }
    };
    let mut frame = [0; MAX_FRAME];
    let length = encode(dice.word() as u8, &request, &mut frame).unwrap();
    frame[..length].to_vec()
}

/// Rubbish, a damaged frame, or a whole one.
fn bad(dice: &mut Dice) -> Vec<u8> {
    match dice.below(3) {
        0 => {
            let most = if dice.hits(0.05) { 400 } else { 120 };
            let length = dice.below(most);
            (0..length).map(|_| dice.word() as u8).chain([0]).collect()
        }
        1 => {
            let mut frame = whole(dice);
            for _ in 0..1 + dice.below(4) {
                let place = dice.below(frame.len());
                match dice.below(4) {
                    0 => frame[place] = dice.word() as u8,
                    1 => frame[place] ^= 1 << dice.below(8),
                    2 => frame.insert(place, dice.word() as u8),
                    _ if frame.len() > 1 => drop(frame.remove(place)),
                    _ => {}
                }
            }
            frame
        }
        _ => whole(dice),
    }
}

#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn no_input_makes_it_panic_hang_or_change_its_settings() {
    let image = controller_firmware();
    const FRAMES: usize = 100_000;
    let mut session = start(&image);
    let mut settings = Settings::default();
    settings.set(Item::Slenderness.index(), 0.2_f32.to_bits()).unwrap();
    parameters::write(&mut session, &settings, true).unwrap();
    session.take_started();
    let before = session.identify().unwrap();
    let (mut dice, mut chunk, mut bytes, mut periods, mut replies) = (Dice::new(3), Vec::new(), 0, 0, 0);
    for _ in 0..FRAMES {
        let frame = bad(&mut dice);
        if chunk.len() + frame.len() > 1022 {
            bytes += chunk.len();
            session.line().send(&chunk).unwrap();
            chunk.clear();
            let asked = Instant::now();
            replies += session.receive(PATIENCE).unwrap().len();
            while session.take_tick().is_some() {}
            periods += 1;
            assert!(asked.elapsed() < PATIENCE, "it hangs after {periods} periods");
            assert_eq!(session.take_started(), None, "it started anew within {periods} periods");
        }
        chunk.extend(frame);
    }
    // What is left of the last frame must not swallow the next request.
    session.line().send(&[0]).unwrap();
    let after = session.identify().unwrap();
    let state = session.state().unwrap();
    assert_eq!((after, session.take_started()), (before, None));
    assert_eq!(parameters::read(&mut session).unwrap(), settings);
    assert_eq!(session.bad_frames(), 0, "what it says is whole");
    assert!(state.bad_frames > FRAMES as u32 / 3 && replies > FRAMES / 10, "{state:?} {replies}");
    row(
        &format!("{FRAMES} bad frames"),
        &format!("{bytes} bytes in {periods} periods: noise, damaged and senseless requests"),
        &format!("{} were not whole or not known, {replies} got an answer; no restart, settings unchanged", state.bad_frames),
        None,
        None,
        "no_input_makes_it_panic_hang_or_change_its_settings",
    );
}

/// As much as fits into a chunk, with answers that are several times as long.
#[test]
#[ignore = "needs the emulator and its images: run by cargo xtask test"]
fn a_chunk_full_of_requests_is_answered_to_the_last() {
    let image = controller_firmware();
    let mut session = start(&image);
    session.identify().unwrap();
    const REQUESTS: usize = 140;
    for _ in 0..REQUESTS {
        session.send(&Request::Identify).unwrap();
    }
    let asked = Instant::now();
    let mut answers = 0;
    while answers < REQUESTS && asked.elapsed() < PATIENCE {
        answers += session.receive(PATIENCE).unwrap().len();
    }
    assert_eq!(answers, REQUESTS, "the link hangs");
    row(
        &format!("{REQUESTS} requests at once"),
        "one chunk of whole requests",
        "answers each of them, over several control periods",
        None,
        None,
        "a_chunk_full_of_requests_is_answered_to_the_last",
    );
}
