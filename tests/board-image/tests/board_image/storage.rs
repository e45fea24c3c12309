//! The supply fails while settings are stored, at each of the flash's operations.

use sprag_board_image::bench::Stop;
use sprag_board_image::image::Image;
use sprag_board_image::peripheral::flash::Work;
use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, image, keep};
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
    let image = image();
    let mut rig = begun(&image);
    let before = rig.bench.chip().flash.works.len();
    assert!(store(&mut rig, None));
    let operations = rig.bench.chip().flash.works.len() - before;
    let mut counts = [0; 2];
    for cut in 0..operations {
        let mut rig = begun(&image);
        assert!(!store(&mut rig, Some(cut)), "not cut at {cut}");
        let time = in_milliseconds(rig.boot());
        assert!(time < 20.0, "cut at {cut}: {time} ms");
        let Reply::Identity(identity) = rig.ask(&Request::Identify) else { panic!("no identity") };
        let which = [Settings::default().check(), others().check()].iter().position(|check| *check == identity.check);
        counts[which.unwrap_or_else(|| panic!("cut at {cut}: neither"))] += 1;
        assert!(rig.starts.last().is_some_and(|start| start.stored), "cut at {cut}: defaults");
    }
    println!("{operations} operations: {} times the old settings, {} times the new", counts[0], counts[1]);
    assert!(operations > 100 && counts.iter().all(|count| *count > 0), "{counts:?} of {operations}");
}

#[test]
fn a_sector_that_is_half_erased_leaves_the_other_copy() {
    for sector in [1, 2] {
        let mut rig = Rig::new(&image(), None);
        keep(&mut rig.bench.chip_mut().flash, &others(), 2);
        rig.bench.chip_mut().flash.finish(Work::Erase(sector), true);
        let time = in_milliseconds(rig.boot());
        let Reply::Identity(identity) = rig.ask(&Request::Identify) else { panic!("no identity") };
        assert_eq!(identity.check, others().check(), "sector {sector}");
        println!("sector {sector} half erased: first tick after {time:.1} ms");
    }
}
