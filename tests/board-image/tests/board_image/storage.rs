//! The supply fails while settings are stored, at each of the flash's operations.

use sprag_board_image::bench::Stop;
use sprag_board_image::image::Image;
use sprag_board_image::model::Model;
use sprag_board_image::peripheral::flash::g4::BANK_2;
use sprag_board_image::peripheral::flash::{Flash, Work};
use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, image_for, keep};
use sprag_board_image::time::in_milliseconds;
use sprag_shared::link::{Done, Reply, Request, WORD_BLOCK, Words};
use sprag_shared::settings::{Item, Settings};

/// Others than the defaults, by one word.
fn others() -> Settings {
    let mut settings = Settings::default();
    settings.set(Item::Dwell.index(), 3).unwrap();
    settings
}

/// Has the board store [`others`] with the supply failing at an operation of the flash; whether it came to the end.
fn store(rig: &mut Rig, cut: Option<usize>) -> bool {
    let mut words = [0; WORD_BLOCK];
    words[0] = 3;
    rig.ask(&Request::Write(Words { first: Item::Dwell.index(), count: 1, words }));
    rig.bench.chip_mut().flash.cut_after = cut;
    let tag = rig.send(&Request::Apply { check: others().check(), store: true });
    for _ in 0..400 {
        if rig.tick() == Stop::Reset(Cause::Power) {
            return false;
        }
        if let Some(answer) = rig.answer(tag) {
            assert_eq!(answer, Reply::Done(Done::Stored));
            return true;
        }
    }
    panic!("no answer");
}

fn begun(image: &Image) -> Rig {
    let mut rig = Rig::new(image, Some(&Settings::default()));
    rig.boot();
    rig
}

#[test]
fn a_cut_at_any_operation_leaves_the_old_settings_or_the_new() {
    // Of a G4 every fifth and the last two, for the time that it takes.
    cut_at_every(Model::F405, 1);
    cut_at_every(Model::G474, 5);
}

fn cut_at_every(model: Model, step: usize) {
    let image = image_for(model);
    let mut whole = begun(&image);
    let before = whole.bench.chip().flash.works.len();
    assert!(store(&mut whole, None));
    let operations = whole.bench.chip().flash.works.len() - before;
    let mut counts = [0; 2];
    begun(&image).for_each((0..operations).filter(|cut| cut % step == 0 || cut + 2 >= operations), |rig, cut| {
        assert!(!store(rig, Some(cut)), "{model:?}: not cut at {cut}");
        let time = in_milliseconds(rig.boot());
        assert!(time < 20.0, "{model:?}: cut at {cut}: {time} ms");
        let Reply::Identity(identity) = rig.ask(&Request::Identify) else { panic!("no identity") };
        let which = [Settings::default().check(), others().check()].iter().position(|check| *check == identity.check);
        counts[which.unwrap_or_else(|| panic!("{model:?}: cut at {cut}: neither"))] += 1;
        assert!(rig.starts.last().is_some_and(|start| start.stored), "{model:?}: cut at {cut}: defaults");
    });
    println!("{model:?}: {operations} operations: {} times the old settings, {} times the new", counts[0], counts[1]);
    assert!(operations > 100 && counts.iter().all(|count| *count > 0), "{counts:?} of {operations}");
}

#[test]
fn a_sector_that_is_half_erased_leaves_the_other_copy() {
    for (model, copy) in Model::ALL.into_iter().flat_map(|model| [(model, 0), (model, 1)]) {
        let mut rig = Rig::new(&image_for(model), None);
        keep(&mut rig.bench.chip_mut().flash, &others(), 2);
        rig.bench.chip_mut().flash.half_erase_copy(copy);
        let time = in_milliseconds(rig.boot());
        let Reply::Identity(identity) = rig.ask(&Request::Identify) else { panic!("no identity") };
        assert_eq!(identity.check, others().check(), "{model:?}, copy {copy}");
        println!("{model:?}, copy {copy} half erased: first tick after {time:.1} ms");
    }
}

/// A G4 mends one wrong bit of a double word by its check bits; two raise the NMI when they are read, and the copy before stands.
#[test]
fn a_word_that_its_check_bits_cannot_mend_leaves_the_copy_before() {
    for (bits, expected) in [(1 << 7, others()), (1 << 7 | 1 << 40, Settings::default())] {
        let mut rig = Rig::new(&image_for(Model::G474), Some(&Settings::default()));
        let flash = &mut rig.bench.chip_mut().flash;
        let doubles = |flash: &Flash| (BANK_2..BANK_2 + 0x1_0000).step_by(8).map(|at| (at, flash.double(at))).collect::<Vec<_>>();
        let before = doubles(flash);
        keep(flash, &others(), 1);
        let new: Vec<u32> = doubles(flash).iter().zip(&before).filter(|(now, then)| now != then).map(|(now, _)| now.0).collect();
        // In both copies that storing makes.
        [1, 3].iter().for_each(|quarter| flash.turn(new[quarter * new.len() / 4], bits));
        rig.boot();
        let Reply::Identity(identity) = rig.ask(&Request::Identify) else { panic!("no identity") };
        assert_eq!(identity.check, expected.check(), "{bits:#x}");
        assert!(rig.starts.last().is_some_and(|start| start.stored), "{bits:#x}: defaults");
        let causes: Vec<Cause> = rig.bench.resets.iter().map(|(_, cause)| *cause).collect();
        assert_eq!((causes, rig.bench.lockup), (vec![Cause::OptionReload], false), "{bits:#x}");
    }
}

/// A G4 erases both copies in its second bank, for 0.7 s, while the controller ticks from the first.
#[test]
fn erasing_the_other_bank_makes_no_tick_late() {
    let mut rig = Rig::new(&image_for(Model::G474), None);
    keep(&mut rig.bench.chip_mut().flash, &Settings::default(), 34);
    rig.boot();
    let mut words = [0; WORD_BLOCK];
    words[0] = 3;
    // Settings that come into force hold up a tick by less than a period; erasing adds nothing.
    let (mut erased, mut late) = (0, u32::MAX);
    for dwell in 3..40 {
        words[0] = dwell;
        rig.ask(&Request::Write(Words { first: Item::Dwell.index(), count: 1, words }));
        let mut settings = others();
        settings.set(Item::Dwell.index(), dwell).unwrap();
        let tag = rig.send(&Request::Apply { check: settings.check(), store: true });
        let mut answer = None;
        for _ in 0..4000 {
            assert_eq!(rig.tick(), Stop::Tick);
            answer = answer.or(rig.answer(tag));
            if answer.is_some() {
                break;
            }
        }
        assert_eq!(answer, Some(Reply::Done(Done::Stored)));
        erased = rig.bench.chip().flash.works.iter().filter(|work| matches!(work, Work::ErasePage(_))).count();
        if erased > 0 {
            break;
        }
        late = rig.state().worst_lateness;
    }
    assert_eq!((erased, rig.state().worst_lateness), (32, late));
}
