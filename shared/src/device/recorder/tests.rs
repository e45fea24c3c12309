//! Recordings in flash whose supply fails anywhere, that is full, that goes round, and that is slow.

use super::page::{HEADER_BYTES, words};
use super::record::{GROUND_STEP, ROTATION_STEP, VELOCITY_STEP, pack};
use super::ring::{AFTER, RECORDS};
use super::*;
use crate::control::controller::Decision;
use crate::control::estimation::estimate::Estimate;
use crate::control::monitor::fault::Fault;
use crate::control::supervisor::Phase;
use crate::device::Device;
use crate::device::beginning::Beginning;
use crate::link::{RecorderActivity, Reply, Request};
use crate::settings::Settings;
use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};
use std::vec;
use std::vec::Vec;

const PAGE: usize = PAGE_BYTES as usize;

/// Sixteen pages in sectors of `SECTOR` bytes; each double word is programmed once.
#[derive(Clone)]
struct Nor<const SECTOR: usize> {
    bytes: Vec<u8>,
    /// Double words until the supply fails.
    power: usize,
    random: u32,
    /// Offsets of sectors that were erased.
    erased: Vec<u32>,
}

impl<const SECTOR: usize> Nor<SECTOR> {
    fn new() -> Nor<SECTOR> {
        Nor { bytes: vec![0xFF; 16 * PAGE], power: usize::MAX, random: 1, erased: Vec::new() }
    }
}

impl<const SECTOR: usize> ErrorType for Nor<SECTOR> {
    type Error = NorFlashErrorKind;
}

impl<const SECTOR: usize> ReadNorFlash for Nor<SECTOR> {
    const READ_SIZE: usize = 4;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), NorFlashErrorKind> {
        let from = offset as usize;
        bytes.copy_from_slice(&self.bytes[from..from + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl<const SECTOR: usize> NorFlash for Nor<SECTOR> {
    const WRITE_SIZE: usize = 8;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), NorFlashErrorKind> {
        assert_eq!((from as usize % SECTOR, (to - from) as usize), (0, SECTOR));
        if self.power > 0 {
            self.bytes[from as usize..to as usize].fill(0xFF);
            self.erased.push(from);
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), NorFlashErrorKind> {
        assert!(offset.is_multiple_of(8) && bytes.len() == 8);
        let place = &mut self.bytes[offset as usize..offset as usize + 8];
        if place.iter().any(|byte| *byte != 0xFF) {
            return Err(NorFlashErrorKind::Other);
        }
        for (place, byte) in place.iter_mut().zip(bytes) {
            self.random = self.random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *place &= match self.power {
                0 => 0xFF,
                1 => byte | (self.random >> 24) as u8,
                _ => *byte,
            };
        }
        self.power = self.power.saturating_sub(1);
        Ok(())
    }
}

/// A device that stands as given, its ring, and its recorder.
struct Flown<const SECTOR: usize> {
    device: Device,
    ring: Ring,
    recorder: Recorder<Nor<SECTOR>>,
}

impl<const SECTOR: usize> Flown<SECTOR> {
    /// It has just started.
    fn new(flash: Nor<SECTOR>, goes_round: bool, resumed: bool) -> Flown<SECTOR> {
        let beginning = Beginning::of(Some(&Settings::default()), None, 0.0).unwrap();
        let recorder = Recorder::new(flash, goes_round, resumed);
        Flown { device: Device::new(&beginning, None), ring: Ring::new(), recorder }
    }

    /// So many ticks, after each of which the recorder may do so many pieces of work.
    fn ticks(&mut self, count: u32, phase: Phase, moves: bool, work: u32) -> &mut Flown<SECTOR> {
        for _ in 0..count {
            self.device.ticks += 1;
            let tick = self.device.ticks;
            self.device.decision = decision(tick, phase, moves);
            self.device.sample.engaged = [tick.is_multiple_of(3), moves];
            self.ring.note(&self.device);
            for _ in 0..work {
                self.recorder.work(|| self.ring.take());
            }
        }
        self
    }

    /// An earthquake in which the block moves for so many ticks, and what is needed to have all of it in flash.
    fn quake(&mut self, moving: u32) -> &mut Flown<SECTOR> {
        self.ticks(BEFORE, Phase::Armed, false, 4);
        self.ticks(moving, Phase::Rocking, true, 4).ticks(AFTER + 600, Phase::Rocking, false, 4)
    }

    fn flash(self) -> Nor<SECTOR> {
        self.recorder.release()
    }
}

fn decision(tick: u32, phase: Phase, moves: bool) -> Decision {
    let wave = |scale: f32| ((tick % 200) as f32 - 100.0) * scale;
    let estimate = Estimate {
        rotation: wave(0.001),
        velocity: wave(0.01),
        ground: [wave(0.005), 1.0],
        standing: !moves,
        ..Estimate::default()
    };
    let fault = (phase == Phase::Fault).then_some(Fault::Overrun);
    Decision { estimate, phase, fault, ..Decision::before([moves, !moves]) }
}

fn whole(flash: &[u8]) -> Vec<Page<'_>> {
    flash.chunks(PAGE).filter_map(|page| Page::of(page).ok()).collect()
}

/// Every tick and record of a recording, and where it has gaps.
fn moments(pages: &[Page<'_>], number: u16) -> Vec<(u32, Moment)> {
    pages.iter().filter(|page| page.header.number == number).flat_map(Page::moments).collect()
}

#[test]
fn a_record_is_within_a_step_and_ends_at_its_range() {
    for tick in 0..200 {
        let decision = decision(tick, Phase::ALL[tick as usize % 6], tick % 2 == 0);
        let engaged = [tick % 3 == 0, tick % 5 == 0];
        let record = pack(&decision, engaged);
        let moment = Moment::of(record).unwrap();
        let Estimate { rotation, velocity, ground, standing, .. } = decision.estimate;
        assert!((moment.rotation - rotation).abs() < ROTATION_STEP && (moment.velocity - velocity).abs() < VELOCITY_STEP);
        assert!((moment.ground - ground[0]).abs() < GROUND_STEP);
        let exact = (moment.command, moment.engaged, moment.phase, moment.standing, moment.fault);
        assert_eq!(exact, (decision.command, engaged, decision.phase, standing, decision.fault.map(Fault::code)));
    }
    let mut decision = decision(0, Phase::Rocking, true);
    for (value, rotation, velocity) in [(f32::INFINITY, 1.0, 4.0), (-1e30, -1.0, -4.0), (f32::NAN, 0.0, 0.0)] {
        (decision.estimate.rotation, decision.estimate.velocity) = (value, value);
        let moment = Moment::of(pack(&decision, [true; 2])).unwrap();
        assert!((moment.rotation - rotation).abs() <= ROTATION_STEP && (moment.velocity - velocity).abs() <= VELOCITY_STEP);
    }
    for fault in Fault::ALL {
        decision.fault = Some(fault);
        let record = pack(&decision, [true; 2]);
        assert_eq!(Moment::of(record).unwrap().fault, Some(fault.code()));
        assert!(record[1] >> 31 == 0, "it would read as blank flash");
    }
}

/// A change of any of these is another [`page::FORMAT`].
#[test]
fn the_format_is_what_it_was() {
    let header = Header {
        number: 0x0102,
        part: 3,
        index: 4,
        attached: true,
        first_tick: 5,
        period: 5e-4,
        check: 0x0607_0809,
        sequence: 10,
    };
    assert_eq!(
        header.words(),
        [0x5152_5053, 0x0803_0101, 0x0004_0102, 5, 0x3A03_126F, 0x0607_0809, 10, header.words()[7]],
        "{:x?}",
        header.words()
    );
    assert_eq!(Header::of(&header.words()), Some(header));
    assert_eq!(pack(&decision(130, Phase::Rocking, true), [true, false]), [0x0999_03D7, 0x0045_04CC]);
    assert_eq!((CAPACITY, HEADER_BYTES), (251, 32));
    for bit in 0..256 {
        let mut words = header.words();
        words[bit / 32] ^= 1 << (bit % 32);
        assert_eq!(Header::of(&words), None, "bit {bit}");
    }
}

#[test]
fn an_earthquake_is_kept_from_before_its_first_motion_to_its_last() {
    let mut flown = Flown::<PAGE>::new(Nor::new(), false, false);
    let first = flown.quake(300).device.ticks - 300 - AFTER - 600 + 1;
    assert_eq!(flown.recorder.state().activity, RecorderActivity::Ready);
    assert_eq!(flown.recorder.state().lost, 0);
    let flash = flown.flash();
    let pages = whole(&flash.bytes);
    let kept = moments(&pages, 1);
    let ticks: Vec<u32> = kept.iter().map(|(tick, _)| *tick).collect();
    // The tick that moves first has a thousand before it, less the first of all, which was the start.
    assert_eq!(ticks, (first - BEFORE..first + 300 + AFTER).collect::<Vec<u32>>());
    for (tick, moment) in kept {
        let moves = (first..first + 300).contains(&tick);
        let phase = if tick < first { Phase::Armed } else { Phase::Rocking };
        let expected = pack(&decision(tick, phase, moves), [tick.is_multiple_of(3), moves]);
        assert_eq!(Some(moment), Moment::of(expected), "tick {tick}");
    }
    assert!(pages.iter().rev().skip(1).all(|page| !page.ends) && pages.last().is_some_and(|page| page.ends));
    let header = pages[0].header;
    assert_eq!((header.check, header.period), (Settings::default().check(), Settings::default().period()));
}

/// At every double word of the third page; half of it may be written.
#[test]
fn a_power_cut_costs_the_page_that_is_written_and_no_other() {
    let page = PAGE / 8;
    for power in 2 * page + 1..=3 * page + 1 {
        let flash = Nor::<PAGE> { power, random: power as u32, ..Nor::new() };
        let mut flown = Flown::new(flash, false, false);
        flown.ticks(BEFORE, Phase::Armed, false, 4).ticks(300, Phase::Rocking, true, 4);
        let mut flash = flown.flash();
        flash.power = usize::MAX;
        let before: Vec<u32> = whole(&flash.bytes).iter().map(|page| page.header.index).map(u32::from).collect();
        // Its last words may be cut with all bits in place.
        assert!(before == [0, 1] || (power >= 3 * page && before == [0, 1, 2]), "cut at {power}: {before:?}");
        // The next one is another earthquake, and begins on a page of its own.
        let mut flown = Flown::new(flash, false, false);
        flown.quake(10);
        let state = flown.recorder.state();
        assert_eq!((state.lost, state.refused), (0, 0), "cut at {power}");
        let flash = flown.flash();
        let pages = whole(&flash.bytes);
        assert!(pages[..2].iter().all(|page| page.header.number == 1));
        assert_eq!(moments(&pages, 2).len() as u32, 10 + BEFORE + AFTER, "cut at {power}");
    }
}

#[test]
fn a_reset_in_motion_begins_another_part() {
    let mut flown = Flown::<PAGE>::new(Nor::new(), false, false);
    flown.ticks(BEFORE, Phase::Armed, false, 4).ticks(300, Phase::Rocking, true, 4);
    let mut flown = Flown::new(flown.flash(), false, true);
    flown.ticks(600, Phase::Rocking, true, 4).ticks(AFTER + 600, Phase::Rocking, false, 4);
    flown.quake(5);
    let flash = flown.flash();
    let parts: Vec<(u16, u8)> = whole(&flash.bytes).iter().map(|page| (page.header.number, page.header.part)).collect();
    assert_eq!((parts[0], parts[parts.len() - 1]), ((1, 0), (2, 0)), "{parts:?}");
    assert!(parts.contains(&(1, 1)), "{parts:?}");
    // What ended before the reset is not continued.
    let mut flown = Flown::<PAGE>::new(Nor::new(), false, false);
    flown.ticks(20, Phase::Armed, false, 4).ticks(9, Phase::Rocking, true, 4).ticks(AFTER + 600, Phase::Armed, false, 4);
    let mut flown = Flown::new(flown.flash(), false, true);
    flown.ticks(600, Phase::Rocking, true, 4).ticks(AFTER + 600, Phase::Rocking, false, 4);
    let flash = flown.flash();
    let last = whole(&flash.bytes).last().unwrap().header;
    assert_eq!((last.number, last.part), (2, 0));
}

#[test]
fn what_is_full_keeps_the_old() {
    let mut flown = Flown::<{ 2 * PAGE }>::new(Nor::new(), false, false);
    flown.quake(40).quake(10_000);
    let state = flown.recorder.state();
    assert!(state.next >= state.pages && state.lost > 8000, "{state:?}");
    let before = flown.recorder.clone().release();
    flown.quake(300);
    let flash = flown.flash();
    assert!(flash.erased.is_empty() && flash.bytes == before.bytes);
    let pages = whole(&flash.bytes);
    assert_eq!(pages.len(), 16);
    assert_eq!(moments(&pages, 1).len() as u32, BEFORE + 40 + AFTER, "the first earthquake is whole");
}

#[test]
fn what_goes_round_keeps_the_new() {
    let mut flown = Flown::<PAGE>::new(Nor::new(), true, false);
    (0..40).for_each(|_| _ = flown.quake(700));
    assert_eq!(flown.recorder.state().lost, 0);
    let flash = flown.flash();
    let mut pages = whole(&flash.bytes);
    pages.sort_by_key(|page| page.header.sequence);
    assert_eq!(pages.len(), 16);
    assert!(pages.windows(2).all(|pair| pair[1].header.sequence == pair[0].header.sequence + 1));
    assert_eq!((pages[15].header.number, pages[15].ends), (40, true));
    // After a start it continues where it was.
    let mut flown = Flown::new(flash, true, false);
    flown.quake(700);
    let flash = flown.flash();
    let newest = whole(&flash.bytes).iter().map(|page| page.header.number).max();
    assert_eq!(newest, Some(41));
}

/// A recorder that gets no time for longer than the ring lasts loses the oldest, says how much, and leaves a gap that shows.
#[test]
fn what_finds_no_room_is_counted_and_leaves_a_gap() {
    let mut flown = Flown::<PAGE>::new(Nor::new(), false, false);
    flown.ticks(BEFORE, Phase::Armed, false, 4).ticks(100, Phase::Rocking, true, 0);
    // It takes up, and then gets no time again.
    flown.ticks(10, Phase::Rocking, true, 40).ticks(RECORDS as u32 + 500, Phase::Rocking, true, 0);
    flown.ticks(AFTER + 600, Phase::Rocking, false, 8);
    let lost = flown.recorder.state().lost;
    assert!(lost > 0);
    let flash = flown.flash();
    let pages = whole(&flash.bytes);
    let kept = moments(&pages, 1);
    let gaps: u32 = kept.windows(2).map(|pair| pair[1].0 - pair[0].0 - 1).sum();
    assert!(gaps > 0 && gaps <= lost, "{gaps} of {lost}");
    for (tick, moment) in kept {
        assert!((moment.rotation - ((tick % 200) as f32 - 100.0) * 0.001).abs() < ROTATION_STEP, "tick {tick}");
    }
}

/// A fault in motion is recorded, but not for ever.
#[test]
fn a_fault_is_recorded_for_its_time() {
    let mut flown = Flown::<PAGE>::new(Nor::new(), true, false);
    flown.ticks(BEFORE, Phase::Armed, false, 4).ticks(20, Phase::Rocking, true, 4).ticks(30_000, Phase::Fault, true, 4);
    assert_eq!(flown.recorder.state().activity, RecorderActivity::Ready);
    let flash = flown.flash();
    let last = whole(&flash.bytes).into_iter().max_by_key(|page| page.header.sequence).unwrap();
    assert!(last.ends && last.moments().all(|(_, moment)| moment.fault == Some(Fault::Overrun.code())));
    // One that was in Fault before has nothing to record.
    let mut flown = Flown::<PAGE>::new(Nor::new(), true, false);
    flown.ticks(5000, Phase::Fault, true, 4);
    assert!(flown.flash().bytes.iter().all(|byte| *byte == 0xFF));
}

#[test]
fn erasing_is_by_sectors_from_the_last_and_can_be_stopped() {
    let mut flown = Flown::<{ 2 * PAGE }>::new(Nor::new(), false, false);
    flown.quake(10_000);
    assert_eq!(flown.recorder.answer(&Request::EraseRecordings), Reply::Done(crate::link::Done::AsAsked));
    flown.ticks(10, Phase::Armed, false, 4);
    for _ in 0..2 {
        assert!(flown.recorder.erases());
        flown.recorder.erase_sector();
    }
    assert!(flown.recorder.erases());
    // It begins to rock.
    flown.recorder.stop_erasing();
    flown.quake(10);
    let pages = flown.recorder.clone().release().bytes;
    assert_eq!(whole(&pages).last().unwrap().header.number, 2, "into what has been erased");
    flown.recorder.answer(&Request::EraseRecordings);
    flown.ticks(10, Phase::Armed, false, 4);
    while flown.recorder.erases() {
        flown.recorder.erase_sector();
    }
    let flash = flown.recorder.clone().release();
    assert!(flash.bytes.iter().all(|byte| *byte == 0xFF));
    assert_eq!(flash.erased, [14, 12, 14, 12, 10, 8, 6, 4, 2, 0].map(|page| page * PAGE_BYTES));
    flown.quake(10);
    let flash = flown.flash();
    assert_eq!(whole(&flash.bytes)[0].header.number, 3);
}

/// An earthquake comes before it has come to it.
#[test]
fn erasing_is_given_up_for_an_earthquake() {
    let mut flown = Flown::<PAGE>::new(Nor::new(), false, false);
    flown.quake(10);
    flown.recorder.answer(&Request::EraseRecordings);
    flown.ticks(50, Phase::Rocking, true, 0).ticks(AFTER + 600, Phase::Rocking, false, 8);
    assert!(!flown.recorder.erases());
    let flash = flown.flash();
    assert!(flash.erased.is_empty());
    assert_eq!(whole(&flash.bytes).last().unwrap().header.number, 2);
}

#[test]
fn what_is_read_over_the_link_is_what_is_there() {
    let mut flown = Flown::<PAGE>::new(Nor::new(), false, false);
    flown.quake(10);
    let (mut offset, mut bytes) = (0, Vec::new());
    while let Reply::Recorded(recorded) = flown.recorder.answer(&Request::Recorded { offset })
        && recorded.count > 0
    {
        assert_eq!(recorded.offset, offset);
        bytes.extend(&recorded.bytes.as_flattened()[..recorded.count.into()]);
        offset += u32::from(recorded.count);
    }
    assert!(bytes == flown.flash().bytes && Page::of(&bytes[..PAGE]).is_ok());
    assert_eq!(words::<1>(&bytes), [0x5152_5053]);
}
