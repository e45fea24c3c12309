//! A board that is mounted on a structure, and a host at its link.

use std::path::PathBuf;
use std::rc::Rc;

use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::control::supervisor::event_log::Kind;
use sprag_shared::link::{Deframer, MAX_FRAME, Reply, Request, Started, State, TickReport, encode};
use sprag_shared::settings::store::Store;
use sprag_shared::settings::{Item, Settings};

use crate::bench::{self, Bench, Stop, TickCost};
use crate::image::Image;
use crate::model::Model;
use crate::peripheral::flash::Flash;
use crate::peripheral::icm42688::Measured;
use crate::peripheral::rcc::Cause;
use crate::random::Random;
use crate::time::{SECOND, microseconds, milliseconds, seconds};

/// The image for a chip that is tested: the one that [`Model::variable`] names, as `cargo xtask test` sets it.
///
/// # Panics
/// Without it.
pub fn image_for(model: Model) -> Image {
    let variable = model.variable();
    let path = std::env::var_os(variable).unwrap_or_else(|| panic!("{variable} names no image; `cargo xtask test` builds one"));
    Image::load(&PathBuf::from(path)).unwrap_or_else(|error| panic!("{error}")).on(model)
}

/// The image for the F405.
///
/// # Panics
/// Without it.
pub fn image() -> Image {
    image_for(Model::F405)
}

/// The two copies of the settings, as the program's store sees them, written to by the host.
struct Sectors<'a>(&'a mut Flash);

impl ErrorType for Sectors<'_> {
    type Error = NorFlashErrorKind;
}

impl ReadNorFlash for Sectors<'_> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), NorFlashErrorKind> {
        self.0.settings(offset, bytes);
        Ok(())
    }

    fn capacity(&self) -> usize {
        2 * Self::ERASE_SIZE
    }
}

impl NorFlash for Sectors<'_> {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = 0x4000;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), NorFlashErrorKind> {
        self.0.set_settings(from, &vec![0xFF; (to - from) as usize]);
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), NorFlashErrorKind> {
        self.0.set_settings(offset, bytes);
        Ok(())
    }
}

/// Where the structure is and how it moves, in counts of the sensors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Whereabouts {
    /// Of the rack, counts.
    pub travel: i64,
    /// About y of the block's sensor, counts.
    pub rate: f64,
    /// Of the ground, along x of its sensor, counts.
    pub push: f64,
}

/// Of the sensors' noise, counts, standard deviation.
const NOISE: f64 = 4.0;

/// Board, structure and host.
pub struct Rig {
    /// The board.
    pub bench: Bench,
    /// The structure, at a time.
    pub structure: Rc<dyn Fn(u64) -> Whereabouts>,
    /// Of the block's and of the ground's sensor at rest, counts.
    pub gravity: f64,
    /// What the program has said about its starts.
    pub starts: Vec<Started>,
    /// Reports that came.
    pub reports: Vec<TickReport>,
    /// Costs of all ticks since the last start.
    pub costs: Vec<TickCost>,
    deframer: Deframer,
    replies: Vec<(u8, Reply)>,
    tag: u8,
    noise: Random,
}

/// A rig at one time, to come back to.
pub struct Snapshot {
    board: bench::Snapshot,
    structure: Rc<dyn Fn(u64) -> Whereabouts>,
    starts: Vec<Started>,
    deframer: Deframer,
    tag: u8,
    noise: Random,
}

impl Rig {
    /// A new board with `image`, at rest, just powered. In flash are `stored` settings, if there are any.
    pub fn new(image: &Image, stored: Option<&Settings>) -> Rig {
        Rig::on(Bench::new(image), stored)
    }

    /// The same on a board of somebody's choice.
    pub fn on(mut bench: Bench, stored: Option<&Settings>) -> Rig {
        if let Some(settings) = stored {
            keep(&mut bench.chip_mut().flash, settings, 1);
        }
        Rig {
            bench,
            structure: Rc::new(|_| Whereabouts::default()),
            gravity: 4096.0,
            starts: Vec::new(),
            reports: Vec::new(),
            costs: Vec::new(),
            deframer: Deframer::new(),
            replies: Vec::new(),
            tag: 0,
            noise: Random::new(42),
        }
    }

    /// A new board with the image for a chip and the default settings, armed.
    ///
    /// # Panics
    /// As [`Rig::arm`] does.
    pub fn armed(model: Model) -> Rig {
        let mut rig = Rig::new(&image_for(model), Some(&Settings::default()));
        rig.arm();
        rig
    }

    /// Board, structure and link as they are now.
    pub fn snapshot(&self) -> Snapshot {
        let Rig { bench, structure, starts, deframer, tag, noise, .. } = self;
        let (structure, starts, deframer, noise) = (structure.clone(), starts.clone(), deframer.clone(), noise.clone());
        Snapshot { board: bench.snapshot(), structure, starts, deframer, tag: *tag, noise }
    }

    /// As they were; of reports, answers and costs there are none yet.
    pub fn restore(&mut self, then: &Snapshot) {
        self.bench.restore(&then.board);
        self.structure = then.structure.clone();
        self.starts.clone_from(&then.starts);
        (self.deframer, self.tag, self.noise) = (then.deframer.clone(), then.tag, then.noise.clone());
        self.reports.clear();
        self.replies.clear();
        self.costs.clear();
    }

    /// Does the same with each case from here on, as if each had a board of its own that has come so far.
    pub fn for_each<T>(mut self, cases: impl IntoIterator<Item = T>, mut work: impl FnMut(&mut Rig, T)) {
        let here = self.snapshot();
        for case in cases {
            self.restore(&here);
            work(&mut self, case);
        }
    }

    /// Sensors and encoder as the structure is now.
    fn sense(&mut self) {
        let (at, gravity) = ((self.structure)(self.bench.now()), self.gravity);
        let mut noisy = |value: f64| (value + NOISE * self.noise.normal()).round() as i16;
        let block =
            Measured { acceleration: [noisy(0.0), noisy(0.0), noisy(gravity)], rate: [noisy(0.0), noisy(at.rate), noisy(0.0)] };
        let ground = Measured {
            acceleration: [noisy(at.push), noisy(0.0), noisy(gravity)],
            rate: [0; 3].map(|rate| noisy(f64::from(rate))),
        };
        let chip = self.bench.chip_mut();
        chip.move_rack(at.travel);
        for (bus, measured) in chip.buses.iter_mut().zip([block, ground]) {
            bus.sensor.measured = measured;
        }
    }

    /// Runs to the end of the next control tick, or to a reset, at most 2 s.
    pub fn tick(&mut self) -> Stop {
        self.sense();
        let end = self.bench.now() + 2 * SECOND;
        // The rack moves on while a program starts.
        let stop = loop {
            match self.bench.run(end.min(self.bench.now() + milliseconds(1))) {
                Stop::Time if self.bench.now() < end => self.sense(),
                stop => break stop,
            }
        };
        match stop {
            Stop::Tick => self.costs.extend(self.bench.last_tick),
            Stop::Reset(_) => self.costs.clear(),
            _ => {}
        }
        self.hear();
        stop
    }

    /// Runs over the next control tick until the program has nothing left to do.
    pub fn period(&mut self) {
        self.bench.until_asleep = false;
        while self.bench.run(self.bench.now() + SECOND) != Stop::Tick {}
        self.settle(microseconds(300));
    }

    /// Runs until the program has nothing left to do, for `at_most` counts: while it measures its clock it never sleeps.
    pub fn settle(&mut self, at_most: u64) {
        self.bench.until_asleep = true;
        self.bench.wake();
        self.bench.run(self.bench.now() + at_most);
        self.bench.until_asleep = false;
    }

    /// So many ticks.
    ///
    /// # Panics
    /// If the board is reset meanwhile.
    pub fn ticks(&mut self, count: usize) {
        for _ in 0..count {
            assert_eq!(self.tick(), Stop::Tick);
        }
    }

    fn hear(&mut self) {
        let now = self.bench.now();
        for byte in self.bench.chip_mut().line.take(now) {
            match self.deframer.feed::<Reply>(byte) {
                Some(Ok(received)) => match received.message {
                    Reply::Started(started) => self.starts.push(started),
                    Reply::Tick(report) => self.reports.push(report),
                    reply => self.replies.push((received.tag, reply)),
                },
                Some(Err(error)) => panic!("the board sends {error}"),
                None => {}
            }
        }
    }

    /// Sends a request, and gives the tag that its answer will have.
    pub fn send(&mut self, request: &Request) -> u8 {
        self.tag = self.tag % 250 + 1;
        // Answers to a request of long ago with this tag, which nobody has taken.
        self.replies.retain(|(tag, _)| *tag != self.tag);
        let mut frame = [0; MAX_FRAME];
        let length = encode(self.tag, request, &mut frame).expect("requests fit");
        let now = self.bench.now();
        let chip = self.bench.chip_mut();
        let clock = chip.rcc.peripheral_hz()[1];
        chip.line.send(&frame[..length], clock, now);
        self.tag
    }

    /// The answer to a request that was sent, if it has come.
    pub fn answer(&mut self, tag: u8) -> Option<Reply> {
        let place = self.replies.iter().position(|(of, _)| *of == tag)?;
        Some(self.replies.remove(place).1)
    }

    /// What the board answers to a request, within 400 ticks.
    ///
    /// # Panics
    /// If it does not.
    pub fn ask(&mut self, request: &Request) -> Reply {
        let tag = self.send(request);
        for _ in 0..400 {
            self.tick();
            if let Some(reply) = self.answer(tag) {
                return reply;
            }
        }
        panic!("no answer to {request:?}");
    }

    /// How the board is.
    ///
    /// # Panics
    /// If it does not say so.
    pub fn state(&mut self) -> State {
        match self.ask(&Request::State) {
            Reply::State(state) => state,
            other => panic!("{other:?}"),
        }
    }

    /// The warnings in the board's event log.
    ///
    /// # Panics
    /// If it does not give it.
    pub fn warnings(&mut self) -> Vec<Fault> {
        let (mut from, mut warnings) = (0, Vec::new());
        loop {
            let block = match self.ask(&Request::Log { from }) {
                Reply::Log(block) => block,
                other => panic!("{other:?}"),
            };
            for entry in block.entries.iter().take(block.count.into()) {
                if let Some(Kind::Warning(code)) = entry.entry().map(|entry| entry.kind) {
                    warnings.extend(Fault::from_code(code));
                }
            }
            from = block.from + u32::from(block.count);
            if block.count == 0 || from >= block.total {
                return warnings;
            }
        }
    }

    /// Runs until the state is as wanted, asking every 20 ticks, at most for so many; the last state.
    pub fn wait(&mut self, ticks: usize, wanted: impl Fn(&State) -> bool) -> State {
        let mut state = self.state();
        for _ in 0..ticks / 20 {
            if wanted(&state) {
                break;
            }
            for _ in 0..20 {
                self.tick();
            }
            state = self.state();
        }
        state
    }

    /// Runs to the first control tick after a reset or the power-on; when the program began to run, and how long it took.
    ///
    /// # Panics
    /// If the board does not tick within 3 s.
    pub fn boot(&mut self) -> u64 {
        let begun = self.bench.now();
        for _ in 0..16 {
            if self.tick() == Stop::Tick {
                return self.bench.last_tick.map_or(0, |tick| tick.at - begun);
            }
        }
        let (chip, resets) = (self.bench.chip(), &self.bench.resets);
        panic!(
            "the board does not start: resets {resets:?}, lockup {}, faults {:x?}, last blocks {:x?}",
            self.bench.lockup, chip.faults, chip.trail
        );
    }

    /// Runs from a reset or the power-on until the board has armed itself.
    ///
    /// # Panics
    /// If it does not, or has a fault.
    pub fn arm(&mut self) {
        self.boot();
        let state = self.wait(4000, |state| state.phase == Phase::Armed);
        assert_eq!((state.phase, state.fault), (Phase::Armed, None), "{:?}", self.bench.chip().model);
    }

    /// Resets the board.
    pub fn reset(&mut self, cause: Cause) {
        self.bench.reset(cause);
        self.costs.clear();
    }
}

/// Stores settings `count` times, as the program would.
pub fn keep(flash: &mut Flash, settings: &Settings, count: u32) {
    for _ in 0..count {
        let (mut store, _) = Store::open(Sectors(&mut *flash));
        store.store_erasing(settings).expect("a flash that works");
    }
}

/// Counts of the encoder to a radian.
fn counts_per_radian() -> f64 {
    f64::from(f32::from_bits(Settings::default().words()[usize::from(Item::CountsPerRadian.index())]))
}

/// A smooth swing from `begin` on: 0.05 rad at 6 rad/s.
pub fn swing(begin: u64) -> impl Fn(u64) -> Whereabouts {
    let scale = counts_per_radian();
    move |now| {
        if now <= begin {
            return Whereabouts::default();
        }
        let time = seconds(now - begin);
        let (sine, cosine) = (6.0 * time).sin_cos();
        let amplitude = 0.05 * (1.0 - (-2.0 * time).exp());
        let rotation = amplitude * sine;
        let velocity = 0.1 * (-2.0 * time).exp() * sine + 6.0 * amplitude * cosine;
        Whereabouts { travel: (rotation * scale).round() as i64, rate: velocity.to_degrees() * 65.5, push: 0.3 * 4096.0 * sine }
    }
}
