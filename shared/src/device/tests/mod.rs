//! What a device does when it is asked, and what it resumes with after a reset.

use super::{Answer, Device, Surroundings};
use crate::control::controller::Decision;
use crate::control::sensing::sample::Sample;
use crate::control::supervisor::Phase;
use crate::control::supervisor::event_log::Kind;
use crate::device::beginning::Beginning;
use crate::device::retained::{MOST_RESTARTS, Retained};
use crate::link::*;
use crate::settings::kind::Description;
use crate::settings::store::Store;
use crate::settings::{COUNT, Item, Settings};
use flash::Flash;
use rig::Rig;
use std::vec::Vec;

mod alone;
mod flash;
mod integrity;
mod resume;
mod rig;
mod stuck;
mod wraps;
mod zero;

/// A device with its block and its flash.
struct Bench {
    device: Device,
    store: Store<Flash>,
    rig: Rig,
}

impl Bench {
    fn new() -> Bench {
        Bench::with(&Settings::default(), None)
    }

    fn with(settings: &Settings, retained: Option<&Retained>) -> Bench {
        Bench::of(&Beginning::of(Some(settings), retained, 0.0).unwrap(), retained)
    }

    fn of(beginning: &Beginning, retained: Option<&Retained>) -> Bench {
        let (store, _) = Store::open(Flash::default());
        Bench { device: Device::new(beginning, retained), store, rig: Rig::new(beginning.controller.model) }
    }

    fn answer(&mut self, request: Request) -> Answer {
        self.device.answer_storing(&request, &mut self.store, &Surroundings::default())
    }

    /// The reply to a request that has one.
    fn ask(&mut self, request: Request) -> Reply {
        match self.answer(request) {
            Answer::Reply(reply) | Answer::Restarted(reply) | Answer::SelfTest(reply) => reply,
            answer => panic!("{request:?}: {answer:?}"),
        }
    }

    fn tick(&mut self) -> Phase {
        let sample = self.rig.sample();
        self.device.tick(|own| *own = sample, 0.0);
        self.rig.advance(self.device.decision().command);
        self.device.decision().phase
    }

    /// A tick in which `spoil` changes what the sensors say.
    fn spoilt(&mut self, spoil: impl Fn(&mut Sample)) -> Decision {
        let mut sample = self.rig.sample();
        spoil(&mut sample);
        self.device.tick(|own| *own = sample, 0.0);
        self.rig.advance(self.device.decision().command);
        *self.device.decision()
    }

    /// Of the estimates of θ, rad, and θ̇, rad/s.
    fn errors(&self) -> [f32; 2] {
        let estimate = self.device.decision().estimate;
        let Rig { rotation, velocity, .. } = self.rig;
        [(estimate.rotation - rotation).abs(), (estimate.velocity - velocity).abs()]
    }

    fn ticks(&mut self, count: usize) {
        for _ in 0..count {
            self.tick();
        }
    }

    /// Of a device that hears nothing.
    fn ticks_without(&mut self, count: usize) {
        for _ in 0..count {
            self.device.tick(|_| panic!("its own sensors"), 0.0);
        }
    }

    /// Attached, by a sample from the link.
    fn host_tick(&mut self, number: u32) -> Phase {
        let sample = TickSample { sample: self.rig.sample(), ..host_sample(number) };
        assert_eq!(self.answer(Request::Sample(sample)), Answer::Sample);
        self.ticks_without(1);
        self.rig.advance(self.device.decision().command);
        self.device.decision().phase
    }

    /// Attached, by samples from the link from 1 on. Returns the number of the last one.
    fn arm_by_host(&mut self) -> u32 {
        (1..5000).find(|number| self.host_tick(*number) == Phase::Armed).expect("it arms")
    }

    fn until(&mut self, phase: Phase, most: usize) {
        assert!((0..most).any(|_| self.tick() == phase), "{phase:?} never came: {:?}", self.device.decision());
    }

    fn armed() -> Bench {
        let mut bench = Bench::new();
        bench.until(Phase::Armed, 5000);
        bench
    }

    fn rocking() -> Bench {
        let mut bench = Bench::armed();
        bench.rig.shakes = true;
        bench.until(Phase::Rocking, 1000);
        let swings = (0..4000).any(|_| {
            bench.tick();
            bench.rig.rotation.abs() > 5e-3
        });
        assert!(swings && bench.device.decision().phase == Phase::Rocking, "{:?}", bench.rig);
        bench
    }

    /// Writes one word into the draft.
    fn draft(&mut self, item: Item, word: u32) -> Reply {
        let mut words = [0; WORD_BLOCK];
        words[0] = word;
        self.ask(Request::Write(Words { first: item.index(), count: 1, words }))
    }
}

const DONE: Reply = Reply::Done(Done::AsAsked);

fn changed(item: Item, word: u32) -> Settings {
    let mut settings = Settings::default();
    settings.set(item.index(), word).unwrap();
    settings
}

#[test]
fn all_settings_can_be_read_in_blocks() {
    let mut bench = Bench::new();
    let mut words = Vec::<u32>::new();
    while words.len() < COUNT {
        let Reply::Words(block) = bench.ask(Request::Read { first: words.len() as u16 }) else { panic!("{}", words.len()) };
        assert_eq!(usize::from(block.first), words.len());
        assert!((1..=WORD_BLOCK as u8).contains(&block.count));
        words.extend(&block.words[..usize::from(block.count)]);
    }
    assert_eq!(words, Settings::default().words());
    for first in [COUNT as u16, u16::MAX] {
        assert_eq!(bench.ask(Request::Read { first }), Reply::Refused(Refusal::NoSuchSetting(first)));
    }
}

#[test]
fn a_draft_is_nothing_until_it_is_applied() {
    let mut bench = Bench::armed();
    let wanted = changed(Item::Law, 1);
    assert_eq!(bench.draft(Item::Law, 1), DONE);
    assert_eq!(*bench.device.settings(), Settings::default());
    // What is read is in force.
    let Reply::Words(block) = bench.ask(Request::Read { first: Item::Law.index() }) else { panic!() };
    assert_eq!(Some(block.words[0]), Settings::default().get(Item::Law.index()));
    let apply = Request::Apply { check: wanted.check(), store: false };
    assert_eq!(bench.answer(apply), Answer::Restarted(DONE));
    assert_eq!(*bench.device.settings(), wanted);
    assert_eq!(bench.device.decision().phase, Phase::Boot);
    let Reply::Identity(identity) = bench.ask(Request::Identify) else { panic!() };
    assert_eq!((identity.check, usize::from(identity.settings)), (wanted.check(), COUNT));
    // A second time it is no news: the controller continues.
    bench.until(Phase::Armed, 5000);
    assert_eq!(bench.answer(apply), Answer::Reply(DONE));
    assert_eq!(bench.tick(), Phase::Armed);
    assert_eq!(Store::open(bench.store.release()).1, None, "it was not to be stored");
}

#[test]
fn what_shall_be_kept_is_found_in_flash() {
    let mut bench = Bench::new();
    let wanted = changed(Item::Dwell, 7);
    bench.draft(Item::Dwell, 7);
    let apply = Request::Apply { check: wanted.check(), store: true };
    assert_eq!(bench.ask(apply), Reply::Done(Done::Stored));
    assert_eq!(bench.ask(apply), Reply::Done(Done::Stored));
    assert_eq!(Store::open(bench.store.release()).1, Some(wanted));
}

#[test]
fn a_full_flash_is_erased_when_it_is_asked_to_store() {
    let mut bench = Bench::new();
    let full = (0..100).find(|_| bench.store.store(&Settings::default()).is_err());
    assert!(full.is_some_and(|stores| stores > 0));
    bench.draft(Item::Dwell, 7);
    let wanted = changed(Item::Dwell, 7);
    assert_eq!(bench.ask(Request::Apply { check: wanted.check(), store: true }), Reply::Done(Done::Stored));
    assert_eq!(Store::open(bench.store.release()).1, Some(wanted));
}

#[test]
fn what_flash_does_not_take_is_not_applied() {
    let mut bench = Bench::new();
    bench.draft(Item::Dwell, 7);
    let apply = Request::Apply { check: changed(Item::Dwell, 7).check(), store: true };
    let mut flash = Flash::default();
    flash.broken = true;
    bench.store = Store::open(flash).0;
    assert_eq!(bench.ask(apply), Reply::Refused(Refusal::FlashFailed));
    assert_eq!(*bench.device.settings(), Settings::default());
}

#[test]
fn what_may_not_be_is_refused() {
    let mut bench = Bench::new();
    let check = Settings::default().check();
    assert_eq!(bench.ask(Request::Apply { check: check ^ 1, store: true }), Reply::Refused(Refusal::Check(check)));
    let law = Item::Law.index();
    let no_law = Description::at(law).unwrap().most + 1;
    assert_eq!(bench.draft(Item::Law, no_law), Reply::Refused(Refusal::OutOfRange(law)));
    let nan = f32::NAN.to_bits();
    assert_eq!(bench.draft(Item::Size, nan), Reply::Refused(Refusal::OutOfRange(Item::Size.index())));
    let words = |first, count| Request::Write(Words { first, count, words: [0; WORD_BLOCK] });
    assert_eq!(bench.ask(words(law, 17)), Reply::Refused(Refusal::NoSuchSetting(law)));
    assert_eq!(bench.ask(words(COUNT as u16, 1)), Reply::Refused(Refusal::NoSuchSetting(COUNT as u16)));
    assert_eq!(bench.ask(words(u16::MAX, 2)), Reply::Refused(Refusal::NoSuchSetting(u16::MAX)));
    // Each by itself may be, both together may not.
    let time = 3.5_f32.to_bits();
    assert_eq!(bench.draft(Item::CalibrationTime, time), DONE);
    let apply = Request::Apply { check: changed(Item::CalibrationTime, time).check(), store: true };
    let contradiction = Refusal::Contradiction(Item::CalibrationPatience.index(), Item::CalibrationTime.index());
    assert_eq!(bench.ask(apply), Reply::Refused(contradiction));
    assert_eq!(*bench.device.settings(), Settings::default());
    // And the draft can be given up.
    assert_eq!(bench.ask(Request::Discard), DONE);
    assert_eq!(bench.ask(Request::Apply { check, store: false }), DONE);
    assert_eq!(bench.ask(Request::Rehearse(Mishap::Reset)), Reply::Refused(Refusal::NotHere));
    assert_eq!(Store::open(bench.store.release()).1, None);
}

#[test]
fn in_motion_nothing_changes() {
    let mut bench = Bench::rocking();
    let before = bench.device.clone();
    let busy = Reply::Refused(Refusal::Busy(Phase::Rocking));
    let check = Settings::default().check();
    for request in [
        Request::Write(Words { first: 0, count: 1, words: [0; WORD_BLOCK] }),
        Request::Apply { check, store: false },
        Request::Apply { check, store: true },
        Request::SelfTest,
        Request::Attach { pace: Pace::Timer },
        Request::Attach { pace: Pace::Sample },
    ] {
        assert_eq!(bench.ask(request), busy, "{request:?}");
    }
    assert_eq!(bench.ask(Request::Sample(host_sample(1))), Reply::Refused(Refusal::NotHere));
    // Nobody is attached, so there is nothing to do.
    assert_eq!(bench.answer(Request::Detach), Answer::Reply(DONE));
    let mut untouched = Bench { device: before, store: Store::open(Flash::default()).0, rig: bench.rig.clone() };
    for _ in 0..100 {
        assert_eq!(bench.tick(), untouched.tick());
        assert_eq!(bench.device.decision(), untouched.device.decision());
    }
}

#[test]
fn a_self_test_begins_only_where_it_is_armed() {
    let mut bench = Bench::new();
    assert_eq!(bench.ask(Request::SelfTest), Reply::Refused(Refusal::Busy(Phase::Boot)));
    bench.until(Phase::Armed, 5000);
    assert_eq!(bench.ask(Request::SelfTest), DONE);
    bench.until(Phase::SelfTest, 10);
    bench.until(Phase::Calibrate, 1000);
    bench.until(Phase::Armed, 5000);
}

/// Sensors that test themselves say nothing for so long, and what they said before must not count as their first reading.
#[test]
fn sensors_that_test_themselves_are_waited_for() {
    let mut bench = Bench::armed();
    assert_eq!(bench.answer(Request::SelfTest), Answer::SelfTest(DONE));
    let silent = (bench.device.patience() / bench.device.period()) as usize - 10;
    for _ in 0..silent {
        bench.rig.sample();
        bench.device.tick(|_| {}, 0.0);
        assert_eq!((bench.device.decision().phase, bench.device.decision().fault), (Phase::Boot, None));
    }
    bench.until(Phase::SelfTest, 10);
    bench.until(Phase::Armed, 5000);
}

fn host_sample(number: u32) -> TickSample {
    TickSample { number, sample: Default::default(), lateness: 0.0, clear: false }
}

#[test]
fn attached_it_ticks_by_samples_from_the_link() {
    for pace in [Pace::Sample, Pace::Timer] {
        let mut bench = Bench::new();
        assert_eq!(bench.ask(Request::Sample(host_sample(1))), Reply::Refused(Refusal::NotHere));
        assert_eq!(bench.answer(Request::Attach { pace }), Answer::Restarted(DONE));
        assert_eq!(bench.device.attached(), Some(pace));
        // Before the first sample there is nothing to start with, and its own sensors are not asked.
        bench.device.tick(|_| panic!("its own sensors"), 0.0);
        let report = bench.device.report(1, 0).unwrap();
        assert_eq!((report.tick, report.sample, report.decision.phase), (0, 0, Phase::Boot));
        // Twice, late, newer: each number counts once.
        let mut last = 0;
        for (number, expected) in [(5, 5), (5, 5), (4, 5), (6, 6), (1, 6), (100, 100)] {
            let sample = TickSample { sample: bench.rig.sample(), ..host_sample(number) };
            assert_eq!(bench.answer(Request::Sample(sample)), Answer::Sample);
            assert_eq!(bench.device.has_sample(), expected != last);
            if bench.device.has_sample() {
                bench.device.tick(|_| panic!("its own sensors"), 0.0);
            }
            let report = bench.device.report(2, 0).unwrap();
            assert_eq!(report.sample, expected);
            last = expected;
        }
        assert_eq!(bench.answer(Request::Detach), Answer::Restarted(DONE));
        assert_eq!((bench.device.attached(), bench.device.report(3, 0)), (None, None));
        bench.until(Phase::Armed, 5000);
    }
}

#[test]
fn attached_or_not_it_decides_the_same() {
    let (mut own, mut attached) = (Bench::new(), Bench::new());
    attached.ask(Request::Attach { pace: Pace::Sample });
    for number in 1..4000 {
        own.rig.shakes = number > 3000;
        own.tick();
        attached.rig.shakes = number > 3000;
        attached.host_tick(number);
        assert_eq!(own.device.decision(), attached.device.decision());
    }
    assert_eq!(own.device.decision().phase, Phase::Rocking);
}

#[test]
fn reports_come_as_often_as_asked() {
    let mut bench = Bench::armed();
    let reports = |bench: &mut Bench, every: u16| -> Vec<u32> {
        assert_eq!(bench.ask(Request::Stream { every }), DONE);
        (0..100)
            .filter_map(|_| {
                bench.tick();
                bench.device.report(1, 0).map(|report| report.tick)
            })
            .collect()
    };
    assert_eq!(reports(&mut bench, 0), []);
    assert_eq!(reports(&mut bench, 1).len(), 100);
    let every = reports(&mut bench, 25);
    assert_eq!(every.len(), 4);
    assert!(every.windows(2).all(|pair| pair[1] - pair[0] == 25), "{every:?}");
}

#[test]
fn the_worst_is_kept() {
    let mut bench = Bench::new();
    for (cost, lateness) in [(10, 3), (30, 1), (20, 2)] {
        bench.tick();
        bench.device.report(cost, lateness);
    }
    let Reply::State(state) = bench.ask(Request::State) else { panic!() };
    assert_eq!((state.worst_cost, state.worst_lateness, state.ticks), (30, 3, 3));
}

#[test]
fn the_log_is_numbered_from_the_start_of_the_device() {
    let mut bench = Bench::armed();
    let download = |bench: &mut Bench, mut from: u32| {
        let mut entries = Vec::new();
        loop {
            let Reply::Log(block) = bench.ask(Request::Log { from }) else { panic!() };
            entries.extend((block.from..).zip(block.entries.into_iter().take(block.count.into())));
            from = block.from + u32::from(block.count);
            if from == block.total {
                return (entries, block.total);
            }
        }
    };
    let (entries, total) = download(&mut bench, 0);
    assert_eq!(entries.len(), total as usize);
    let kinds: Vec<Kind> = entries.iter().map(|(_, entry)| entry.entry().unwrap().kind).collect();
    assert_eq!(kinds[0], Kind::Phase(Phase::SelfTest));
    assert!(kinds.contains(&Kind::Calibrated) && kinds.contains(&Kind::Phase(Phase::Armed)), "{kinds:?}");
    // What is past the end is nothing, and says where the end is.
    let Reply::Log(block) = bench.ask(Request::Log { from: u32::MAX }) else { panic!() };
    assert_eq!((block.from, block.count, block.total), (total, 0, total));
    // More than it holds: the oldest are gone, and the numbers show it.
    while download(&mut bench, u32::MAX).1 < 100 {
        assert_eq!(bench.ask(Request::SelfTest), DONE);
        bench.until(Phase::SelfTest, 10);
        bench.until(Phase::Armed, 5000);
    }
    let (entries, total) = download(&mut bench, 0);
    assert_eq!(entries.len(), crate::control::supervisor::LOG_ENTRIES);
    assert_eq!(entries[0].0, total - entries.len() as u32);
    assert!(entries.windows(2).all(|pair| pair[0].1.tick <= pair[1].1.tick));
    let (some, _) = download(&mut bench, total - 5);
    assert_eq!(some, entries[entries.len() - 5..]);
}
