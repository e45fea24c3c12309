//! What somebody who stands at the board may do and nobody else: the jumper, protecting the flash, and which firmware has run.

use sprag_board_image::bench::Stop;
use sprag_board_image::chip::JUMPER;
use sprag_board_image::model::Model;
use sprag_board_image::peripheral::flash::Work;
use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, image_for};
use sprag_board_image::time::milliseconds;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::control::supervisor::event_log::Kind;
use sprag_shared::link::{Done, Identity, Pace, Protection, Refusal, Reply, Request, WORD_BLOCK, Words};
use sprag_shared::settings::{Item, Settings};

fn begun(model: Model, stored: Option<&Settings>) -> Rig {
    let mut rig = Rig::new(&image_for(model), stored);
    rig.boot();
    rig
}

/// Opens or closes the jumper.
fn jumper(rig: &mut Rig, closed: bool) {
    rig.bench.chip_mut().ports[2].outside[JUMPER] = closed.then_some(false);
}

fn identity(rig: &mut Rig) -> Identity {
    match rig.ask(&Request::Identify) {
        Reply::Identity(identity) => identity,
        other => panic!("{other:?}"),
    }
}

#[test]
fn without_the_jumper_the_board_is_not_changed() {
    for (model, stored) in Model::ALL.into_iter().flat_map(|model| [(model, true), (model, false)]) {
        let defaults = Settings::default();
        let mut rig = begun(model, stored.then_some(&defaults));
        rig.wait(4000, |state| matches!(state.phase, Phase::Armed | Phase::Fault));
        jumper(&mut rig, false);
        assert!(!identity(&mut rig).jumper, "{model:?}");
        let works = rig.bench.chip().flash.works.len();
        let mut words = [0; WORD_BLOCK];
        words[0] = 3;
        let mut wanted = defaults;
        wanted.set(Item::Dwell.index(), 3).unwrap();
        let requests = [
            Request::Write(Words { first: Item::Dwell.index(), count: 1, words }),
            Request::Apply { check: defaults.check(), store: true },
            Request::Apply { check: defaults.check(), store: false },
            Request::SelfTest,
            Request::Attach { pace: Pace::Timer },
            Request::Protect,
        ];
        for request in requests {
            assert_eq!(rig.ask(&request), Reply::Refused(Refusal::NoJumper), "{model:?}: {request:?}");
        }
        assert_eq!(rig.bench.chip().flash.works.len(), works, "{model:?}: something was written");
        jumper(&mut rig, true);
        assert!(identity(&mut rig).jumper, "{model:?}");
        assert_eq!(rig.ask(&requests[0]), Reply::Done(Done::AsAsked), "{model:?}");
        let stored = rig.ask(&Request::Apply { check: wanted.check(), store: true });
        assert_eq!(stored, Reply::Done(Done::Stored), "{model:?}");
        assert_eq!(identity(&mut rig).check, wanted.check(), "{model:?}");
    }
}

/// By request only, from the next power-on on; settings are stored as before, and a probe that takes it away erases everything.
#[test]
fn a_flash_that_is_protected_is_neither_read_out_nor_overwritten() {
    for model in Model::ALL {
        let image = image_for(model);
        let mut rig = Rig::armed(model);
        let flash = &rig.bench.chip().flash;
        let brown_out = flash.brown_out();
        assert_eq!(flash.by_probe(image.end() - 4), Some(flash.memory.word(image.end() - 4)));
        let before = identity(&mut rig);
        assert!(before.sealed && before.protection == Protection::default(), "{model:?}");
        assert_eq!(rig.ask(&Request::Protect), Reply::Done(Done::Stored), "{model:?}");
        assert!(rig.bench.resets.iter().all(|(_, cause)| *cause == Cause::OptionReload), "{model:?}: {:?}", rig.bench.resets);
        rig.reset(Cause::Power);
        rig.boot();
        let chip = rig.bench.chip();
        assert_eq!((chip.flash.by_probe(image.end() - 4), chip.flash.brown_out()), (None, brown_out), "{model:?}");
        assert_eq!(identity(&mut rig).protection, Protection { reading: true, writing: true }, "{model:?}");
        // Settings may be stored.
        let mut words = [0; WORD_BLOCK];
        words[0] = 3;
        rig.ask(&Request::Write(Words { first: Item::Dwell.index(), count: 1, words }));
        let mut wanted = Settings::default();
        wanted.set(Item::Dwell.index(), 3).unwrap();
        assert_eq!(rig.ask(&Request::Apply { check: wanted.check(), store: true }), Reply::Done(Done::Stored), "{model:?}");
        // Sectors, or pages, of the program take nothing.
        rig.settle(milliseconds(1));
        let chip = rig.bench.chip_mut();
        assert_eq!(erase(model, |address, value| chip.store(address, value)), (), "{model:?}");
        let erased =
            rig.bench.chip().flash.works.iter().filter(|work| matches!(work, Work::Erase(_) | Work::ErasePage(_))).count();
        assert_eq!(erased, 0, "{model:?}: {:?}", rig.bench.chip().flash.works.last());
        assert_eq!(rig.tick(), Stop::Tick);
    }
}

/// A program gone astray erases the first sector, or page, and the one with the code.
fn erase(model: Model, mut store: impl FnMut(u32, u32)) {
    let (base, key, control) = match model {
        Model::F405 => (0x4002_3C00, 0x04, 0x10),
        Model::G474 => (0x4002_2000, 0x08, 0x14),
    };
    for key_word in [0x4567_0123, 0xCDEF_89AB] {
        store(base + key, key_word);
    }
    for number in [0, 4] {
        store(base + control, 2 | number << 3 | 1 << 16);
    }
    store(base + control, 1 << 31);
}

#[test]
fn an_older_firmware_than_one_that_has_run_is_reported() {
    for model in Model::ALL {
        let mut rig = begun(model, Some(&Settings::default()));
        let own = identity(&mut rig);
        assert_eq!(own.highest, own.version, "{model:?}");
        // A newer one has run since.
        let newer = u32::from_be_bytes([0, 7, 1, 2]);
        let place = 2 * 0x4000 + 8;
        rig.bench.chip_mut().flash.set_settings(place, &[newer.to_le_bytes(), (!newer).to_le_bytes()].concat());
        let works = rig.bench.chip().flash.works.len();
        rig.reset(Cause::Power);
        rig.boot();
        assert_eq!(identity(&mut rig).highest, [7, 1, 2], "{model:?}");
        let Reply::Log(log) = rig.ask(&Request::Log { from: 0 }) else { panic!("no log") };
        let first = log.entries[0].entry().map(|entry| entry.kind);
        assert_eq!(first, Some(Kind::Warning(Fault::OlderFirmware.code())), "{model:?}");
        // Only reported.
        let state = rig.wait(4000, |state| state.phase == Phase::Armed);
        assert_eq!((state.phase, state.fault), (Phase::Armed, None), "{model:?}");
        assert_eq!(rig.bench.chip().flash.works.len(), works, "{model:?}: noted again");
    }
}
