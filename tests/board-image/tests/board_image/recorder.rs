//! What the board records of an earthquake in its flash, and what that costs its ticks.

use std::rc::Rc;

use super::resets::rocking;
use sprag_board_image::bench::Stop;
use sprag_board_image::model::Model;
use sprag_board_image::peripheral::flash::g4::BANK_2;
use sprag_board_image::peripheral::flash::{Flash, Pace, Work};
use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, image_for, swing};
use sprag_shared::control::supervisor::Phase;
use sprag_shared::control::supervisor::event_log::Kind;
use sprag_shared::device::recorder::record::{GROUND_STEP, ROTATION_STEP, VELOCITY_STEP};
use sprag_shared::device::recorder::{BEFORE, Moment, PAGE_BYTES, Page};
use sprag_shared::link::reset_cause;
use sprag_shared::link::{RecorderActivity, RecorderState, Refusal, Reply, Request};
use sprag_shared::settings::Settings;

/// Where the recordings are: first address and bytes.
fn place(model: Model) -> (u32, u32) {
    match model {
        Model::F405 => (0x0804_0000, 6 * 0x2_0000),
        Model::G474 => (BANK_2 + 0x1_0000, 0x3_0000),
    }
}

fn contents(flash: &Flash, model: Model) -> Vec<u8> {
    let (start, length) = place(model);
    let mut bytes = vec![0; length as usize];
    flash.memory.read(start, &mut bytes);
    bytes
}

fn whole(bytes: &[u8]) -> Vec<Page<'_>> {
    let mut pages: Vec<Page<'_>> = bytes.chunks(PAGE_BYTES as usize).filter_map(|page| Page::of(page).ok()).collect();
    pages.sort_by_key(|page| page.header.sequence);
    pages
}

fn state(rig: &mut Rig) -> RecorderState {
    match rig.ask(&Request::Recorder) {
        Reply::Recorder(state) => state,
        other => panic!("{other:?}"),
    }
}

/// A board that is armed, with recordings that are not its own in this part of the flash.
fn armed(model: Model, bytes: u32) -> Rig {
    let mut rig = Rig::new(&image_for(model), Some(&Settings::default()));
    let (start, _) = place(model);
    rig.bench.chip_mut().flash.memory.write(start, &vec![0x5A; bytes as usize]);
    rig.arm();
    rig
}

fn rock(rig: &mut Rig, ticks: usize) {
    rig.structure = Rc::new(swing(rig.bench.now()));
    rig.ticks(ticks);
}

/// In the pace of a typical flash and of the slowest, no tick is late, none is lost, and each is what the board reported of it.
#[test]
fn an_earthquake_is_recorded_and_no_tick_is_late() {
    for (model, pace) in [(Model::F405, Pace::Typical), (Model::F405, Pace::Slowest), (Model::G474, Pace::Slowest)] {
        let mut rig = armed(model, 0);
        rig.bench.chip_mut().flash.pace = pace;
        rig.bench.chip_mut().line.haste = 8;
        rig.send(&Request::Stream { every: 1 });
        rock(&mut rig, 2400);
        let (recorder, board) = (state(&mut rig), rig.state());
        assert_eq!((board.phase, board.fault, board.worst_lateness), (Phase::Rocking, None, 0), "{model:?} {pace:?}");
        assert_eq!((recorder.activity, recorder.lost, recorder.refused), (RecorderActivity::Writing, 0, 0), "{model:?} {pace:?}");
        let bytes = contents(&rig.bench.chip().flash, model);
        let pages = whole(&bytes);
        let moments: Vec<(u32, Moment)> = pages.iter().flat_map(Page::moments).collect();
        println!("{model:?} {pace:?}: {} pages, {} ticks", pages.len(), moments.len());
        assert!(moments.len() > 2400 + BEFORE as usize - 700, "{model:?} {pace:?}: {}", moments.len());
        assert!(moments.windows(2).all(|pair| pair[1].0 == pair[0].0 + 1), "{model:?} {pace:?}");
        let mut compared = 0;
        for report in &rig.reports {
            let Some((_, moment)) = moments.iter().find(|(tick, _)| *tick == report.tick) else { continue };
            let (decision, estimate) = (&report.decision, &report.decision.estimate);
            let near = (moment.rotation - estimate.rotation).abs() < ROTATION_STEP
                && (moment.velocity - estimate.velocity).abs() < VELOCITY_STEP
                && (moment.ground - estimate.ground[0]).abs() < GROUND_STEP;
            assert!(near, "{moment:?} {report:?}");
            assert_eq!((moment.command, moment.phase), (decision.command, decision.phase), "{report:?}");
            compared += 1;
        }
        assert!(compared > 1000, "{compared}");
    }
}

/// Words from the first of the second page on, and whether the supply fails at them: the first page is whole, whatever was written after it.
#[test]
fn a_power_cut_in_a_page_leaves_the_pages_before() {
    // Of an F4 by the word, of a G4 by the double word, after the erasing of each page.
    for (model, page, cuts) in [(Model::F405, 512, [1, 9, 301, 511]), (Model::G474, 257, [1, 6, 200, 256])] {
        armed(model, 0).for_each(cuts, |rig, cut| {
            rig.bench.chip_mut().flash.cut_after = Some(page + cut - 1);
            rig.structure = Rc::new(swing(rig.bench.now()));
            let stop = (0..4000).map(|_| rig.tick()).find(|stop| *stop != Stop::Tick);
            assert_eq!(stop, Some(Stop::Reset(Cause::Power)), "{model:?}: not cut at {cut}");
            let bytes = contents(&rig.bench.chip().flash, model);
            let before = whole(&bytes);
            // The last word may be there in spite of the cut.
            assert!(before.len() == 1 || (cut + 2 > page && before.len() == 2), "{model:?}, cut at {cut}: {}", before.len());
            assert_eq!((before[0].header.number, before[0].moments().count()), (1, 251));
            rig.structure = Rc::new(|_| Default::default());
            rig.boot();
            rig.wait(4000, |state| state.phase == Phase::Armed);
            // And the next earthquake is another one.
            rock(rig, 1000);
            let bytes = contents(&rig.bench.chip().flash, model);
            let after = whole(&bytes);
            assert!(after[..before.len()] == before[..] && after.len() > before.len(), "{model:?}, cut at {cut}");
            assert_eq!((after[before.len()].header.number, after[before.len()].header.part), (2, 0), "{model:?}, cut at {cut}");
        });
    }
}

#[test]
fn a_reset_in_motion_continues_in_another_part_and_the_log_says_so() {
    for model in Model::ALL {
        let mut rig = rocking(model, 900);
        rig.reset(Cause::Watchdog);
        rig.boot();
        rig.ticks(1200);
        let bytes = contents(&rig.bench.chip().flash, model);
        let parts: Vec<(u16, u8)> = whole(&bytes).iter().map(|page| (page.header.number, page.header.part)).collect();
        let count = |part: u8| parts.iter().filter(|key| **key == (1, part)).count();
        assert!(count(0) >= 5 && count(1) >= 3 && count(0) + count(1) == parts.len(), "{model:?}: {parts:?}");
        let (mut entries, mut from) = (Vec::new(), 0);
        while let Reply::Log(block) = rig.ask(&Request::Log { from })
            && block.count > 0
        {
            entries.extend(block.entries[..block.count.into()].iter().filter_map(|entry| entry.entry()));
            from = block.from + u32::from(block.count);
        }
        let started = entries.iter().position(|entry| entry.kind == Kind::Started(reset_cause::Cause::Watchdog as u8));
        let before = &entries[..started.unwrap_or_else(|| panic!("{model:?}: {entries:?}"))];
        assert!(before.iter().any(|entry| entry.kind == Kind::Phase(Phase::Rocking)), "{model:?}: {entries:?}");
        // After a loss of power nothing is left of it.
        rig.reset(Cause::Power);
        rig.boot();
        let Reply::Log(block) = rig.ask(&Request::Log { from: 0 }) else { panic!("no log") };
        assert!(block.total < 5, "{model:?}: {block:?}");
    }
}

#[test]
fn a_full_flash_keeps_the_old_and_says_so() {
    let (_, length) = place(Model::F405);
    let mut rig = armed(Model::F405, length - PAGE_BYTES);
    rock(&mut rig, 2000);
    let (recorder, board) = (state(&mut rig), rig.state());
    assert_eq!((recorder.next, recorder.goes_round, board.worst_lateness), (recorder.pages, false, 0), "{recorder:?}");
    assert!(recorder.lost > 1000, "{recorder:?}");
    let bytes = contents(&rig.bench.chip().flash, Model::F405);
    assert!(bytes[..(length - PAGE_BYTES) as usize].iter().all(|byte| *byte == 0x5A));
    assert_eq!(whole(&bytes).len(), 1);
    assert!(!rig.bench.chip().flash.works.iter().any(|work| matches!(work, Work::Erase(_))));
}

/// A G4 whose second bank is full of what nobody can read, not even by its check bits.
#[test]
fn what_goes_round_makes_room_and_no_tick_late() {
    let (_, length) = place(Model::G474);
    let mut rig = armed(Model::G474, length);
    rock(&mut rig, 2000);
    let (recorder, board) = (state(&mut rig), rig.state());
    assert_eq!((recorder.goes_round, recorder.lost, recorder.refused, board.worst_lateness), (true, 0, 0, 0), "{recorder:?}");
    assert!(rig.bench.resets.iter().all(|(_, cause)| *cause == Cause::OptionReload), "{:?}", rig.bench.resets);
    let bytes = contents(&rig.bench.chip().flash, Model::G474);
    let (pages, erased) = (whole(&bytes).len(), rig.bench.chip().flash.works.clone());
    let erased = erased.iter().filter(|work| matches!(work, Work::ErasePage(_))).count();
    assert!(pages >= 9 && erased == pages + 1, "{pages} pages, {erased} erased");
}

#[test]
fn recordings_are_erased_at_rest_only() {
    let mut rig = armed(Model::F405, 3 * 0x2_0000);
    rig.bench.chip_mut().flash.pace = Pace::Slowest;
    assert!(matches!(rig.ask(&Request::EraseRecordings), Reply::Done(_)));
    // A sector takes two seconds, the longest for which the rig waits for a tick.
    (0..200).for_each(|_| assert!(matches!(rig.tick(), Stop::Tick | Stop::Time)));
    let board = rig.state();
    assert_eq!((board.phase, board.fault, board.worst_lateness), (Phase::Armed, None, 0));
    assert_eq!(state(&mut rig).activity, RecorderActivity::Ready);
    assert!(contents(&rig.bench.chip().flash, Model::F405).iter().all(|byte| *byte == 0xFF));
    // Those that had nothing on them were left alone.
    let erased: Vec<Work> = rig.bench.chip().flash.works.iter().filter(|work| matches!(work, Work::Erase(_))).copied().collect();
    assert_eq!(erased, [Work::Erase(8), Work::Erase(7), Work::Erase(6)]);
    rock(&mut rig, 600);
    assert_eq!(rig.ask(&Request::EraseRecordings), Reply::Refused(Refusal::Busy(Phase::Rocking)));
}
