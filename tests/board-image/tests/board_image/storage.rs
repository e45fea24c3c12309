//! The supply fails while settings are stored, at each of the flash's operations.

use sprag_board_image::bench::Stop;
use sprag_board_image::image::Image;
use sprag_board_image::model::Model;
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
    // A G4's are too slow for all of them: the first and the last, and some in between.
    cut_at_every(Model::F405, 1);
    cut_at_every(Model::G474, 5);
}

fn cut_at_every(model: Model, step: usize) {
    let image = image_for(model);
    let mut rig = begun(&image);
    let before = rig.bench.chip().flash.works.len();
    assert!(store(&mut rig, None));
    let operations = rig.bench.chip().flash.works.len() - before;
    let mut counts = [0; 2];
    for cut in (0..operations).filter(|cut| cut % step == 0 || cut + 2 >= operations) {
        let mut rig = begun(&image);
        assert!(!store(&mut rig, Some(cut)), "{model:?}: not cut at {cut}");
        let time = in_milliseconds(rig.boot());
        assert!(time < 20.0, "{model:?}: cut at {cut}: {time} ms");
        let Reply::Identity(identity) = rig.ask(&Request::Identify) else { panic!("no identity") };
        let which = [Settings::default().check(), others().check()].iter().position(|check| *check == identity.check);
        counts[which.unwrap_or_else(|| panic!("{model:?}: cut at {cut}: neither"))] += 1;
        assert!(rig.starts.last().is_some_and(|start| start.stored), "{model:?}: cut at {cut}: defaults");
    }
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
