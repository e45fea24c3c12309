//! Loops that a device in the emulator closes, and what has to hold of every one of them.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use sprag_cli::board::driver::{DeviceDriver, DeviceTick, Farewell};
use sprag_cli::board::emulator::{Emulator, Way};
use sprag_cli::board::faulty::{Direction, Fate, FaultyLine};
use sprag_cli::board::image::Image;
use sprag_cli::board::parameters;
use sprag_cli::board::session::Session;
use sprag_cli::command::loop_scene;
use sprag_cli::command::record_arguments::SceneRecordArguments;
use sprag_shared::control::controller::{Circumstances, Decision};
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::supervisor::{Phase, Requests};
use sprag_shared::link::{Identity, Mishap, Started, State};
use sprag_shared::settings::Settings;
use sprag_sim::closed_loop::disturbance::Disturbance;
use sprag_sim::closed_loop::driver::Driver;
use sprag_sim::closed_loop::plant::Extremes;
use sprag_sim::closed_loop::run::{Ending, Tick};
use sprag_sim::closed_loop::{LoopScene, LoopTask};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::sensor::{Sensors, Truth};

/// A file of the scenes.
pub fn scene_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name)
}

/// A scene with changes.
pub fn scene(name: &str, set: &[&str]) -> LoopScene {
    let set: Vec<String> = set.iter().map(|&set| set.to_owned()).collect();
    loop_scene::load(&scene_file(name), &set, &SceneRecordArguments::default()).unwrap()
}

/// The scene `controller.toml` with a sine pulse (ω/p = 4, 3 thresholds) in the place of the record, which is over sooner.
pub fn pulse(set: &[&str]) -> LoopScene {
    let record = "motion = \"record\"\nfile = \"near_fault.csv\"";
    let sine = "motion = \"sine\"\nfrequency_ratio = 4.0\namplitude_ratio = 3.0\nstart_s = 0.25";
    let text = std::fs::read_to_string(scene_file("controller.toml")).unwrap();
    assert!(text.contains(record));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pulse.toml");
    std::fs::write(&path, text.replace(record, sine)).unwrap();
    let set: Vec<String> = ["run.free_time_s=1.5"].iter().chain(set).map(|&set| set.to_owned()).collect();
    loop_scene::load(&path, &set, &SceneRecordArguments::default()).unwrap()
}

/// Longer than a clutch of the scene takes to open, s.
const RELEASED_WITHIN: f64 = 0.01;

/// A line on which nothing happens to frames.
pub fn faithful() -> impl Fate {
    |_: Direction, _: u64, frame: &[u8]| frame.to_vec()
}

/// A disturbance that gives others the time of the loop, and does what another one does.
pub struct Timed<D> {
    /// s; below 0 before the motion.
    pub time: Rc<Cell<f64>>,
    /// The other one.
    pub inner: D,
}

impl<D> Timed<D> {
    /// Before the motion.
    pub fn new(inner: D) -> Timed<D> {
        Timed { time: Rc::new(Cell::new(-1.0)), inner }
    }
}

impl<D: Disturbance> Disturbance for Timed<D> {
    fn disturb(&mut self, time: f64, sample: &mut Sample, circumstances: &mut Circumstances) {
        self.time.set(time);
        self.inner.disturb(time, sample, circumstances);
    }

    fn clutches(&mut self, time: f64, command: [bool; 2], last: [bool; 2]) -> [bool; 2] {
        self.inner.clutches(time, command, last)
    }
}

/// A loop with a device.
pub struct Trial<'a> {
    /// The firmware.
    pub image: &'a Path,
    /// The scene; its first clutched pair.
    pub scene: &'a LoopScene,
    /// How bytes get there.
    pub way: Way,
    /// The program with models of the board's parts, where the image is the board's own.
    pub bench: Option<&'a Path>,
    /// What goes wrong in the device, by the time of the loop, s.
    pub mishaps: &'a [(f64, Mishap)],
    /// For how long a device that starts anew is away, s.
    pub boot_time: f64,
    /// Stillness after the motion, s.
    pub rest: f64,
    /// In the middle of which somebody asks to leave Fault.
    pub clear: bool,
    /// The settings are in flash, and so in force after a reset too.
    pub stored: bool,
}

impl<'a> Trial<'a> {
    /// Where nothing goes wrong.
    pub fn new(image: &'a Path, scene: &'a LoopScene) -> Trial<'a> {
        Trial {
            image,
            scene,
            way: Way::Streams,
            bench: None,
            mishaps: &[],
            boot_time: 0.0,
            rest: 0.0,
            clear: false,
            stored: true,
        }
    }

    /// Runs it.
    pub fn run(&self, fate: impl Fate, disturbance: &mut dyn Disturbance) -> Course {
        let interrupt = Interrupt::default();
        let task = self.scene.task(self.scene.pairs[0], self.scene.controller.sensors.seed(), &interrupt);
        let clock = task.clock();
        let prelude = (clock.prelude / clock.period).round() as usize;
        let settings = task.settings().unwrap();
        let own = task.driver().unwrap();
        let emulator = match self.bench {
            Some(bench) => Emulator::between_models(bench, self.image),
            None => Emulator::start(Image::File(self.image.to_owned()), self.way, None),
        };
        let line = FaultyLine::new(emulator.unwrap(), fate);
        let mut session = Session::new(line);
        if self.stored {
            parameters::write(&mut session, &settings, true).unwrap();
        }
        let mut driver = DeviceDriver::attach(session, &settings, own).unwrap().with_boot_time(self.boot_time);
        for &(time, mishap) in self.mishaps {
            driver = driver.with_mishap(prelude as u32 + (time / clock.period).round() as u32 + 1, mishap);
        }
        let (mut seen, mut extremes) = (Vec::new(), Extremes::default());
        let ending = task.run_with(&mut driver, disturbance, &mut extremes, &mut seen).unwrap();
        rest(&mut driver, &task, self.rest, self.clear);
        let starts = driver.starts().to_vec();
        let Farewell { ticks, state, identity, started } = driver.finish().unwrap();
        let course = Course {
            seen,
            starts,
            ending,
            state,
            identity,
            ticks,
            stored: self.stored,
            settings,
            prelude,
            period: clock.period,
            peak: extremes.peaks.rotation / self.scene.scene.block.slenderness(),
            late: started,
        };
        course.check();
        course
    }
}

/// The same loop without a device: its ticks, and the largest |θ|/α.
pub fn on_the_host(scene: &LoopScene) -> (Vec<Tick>, f64) {
    let interrupt = Interrupt::default();
    let task = scene.task(scene.pairs[0], scene.controller.sensors.seed(), &interrupt);
    let (mut ticks, mut extremes) = (Vec::new(), Extremes::default());
    task.run(&mut extremes, &mut ticks).unwrap();
    (ticks, extremes.peaks.rotation / scene.scene.block.slenderness())
}

/// Time of the largest velocity of the first swing, s.
pub fn mid_swing(ticks: &[Tick]) -> f64 {
    let impact = ticks.iter().find(|tick| tick.plant.motion.impacts > 0).unwrap().plant.time;
    // The largest of all may be the impact's own.
    let swing = ticks.iter().take_while(|tick| tick.plant.time < 0.9 * impact);
    let speed = |tick: &&Tick| tick.plant.motion.velocity.abs();
    swing.max_by(|one, other| speed(one).total_cmp(&speed(other))).unwrap().plant.time
}

/// Nothing moves, and the clutches follow as before the motion.
fn rest(driver: &mut dyn Driver, task: &LoopTask<'_>, seconds: f64, clear: bool) {
    let clock = task.clock();
    let mut sensors = Sensors::new(task.suite, task.seed, &Truth::STILL);
    let lag = (clock.actuation / clock.period).ceil() as usize;
    let mut pending = std::collections::VecDeque::from(vec![[false; 2]; lag + 1]);
    let ticks = (seconds / clock.period).round() as u64;
    for tick in 1..=ticks {
        sensors.advance(tick as f64 * clock.period, &Truth::STILL);
        let mut sample = sensors.sample();
        sample.engaged = pending.pop_front().unwrap_or_default();
        let requests = Requests { clear: clear && tick == ticks / 2 };
        pending.push_back(driver.tick(&sample, Circumstances { requests, ..Circumstances::default() }).command);
    }
}

/// What became of a loop.
pub struct Course {
    /// Every tick, from the first one of the stillness before the motion to the last one of the rest after it.
    pub ticks: Vec<DeviceTick>,
    /// Those of the motion, with the plant.
    pub seen: Vec<Tick>,
    /// New starts, by the number of the tick from 1 on.
    pub starts: Vec<(u32, Started)>,
    /// How the motion ended.
    pub ending: Ending,
    /// How the device is at the end.
    pub state: State,
    /// Who it is at the end.
    pub identity: Identity,
    /// What it was given.
    pub settings: Settings,
    /// And keeps in flash.
    pub stored: bool,
    /// Ticks before the motion.
    pub prelude: usize,
    /// s.
    pub period: f64,
    /// Largest |θ|/α.
    pub peak: f64,
    /// A start after the last tick.
    pub late: Option<Started>,
}

impl Course {
    /// Ticks whose decision is not that of the host's controller.
    pub fn differing(&self) -> usize {
        self.ticks.iter().filter(|tick| tick.differs).count()
    }

    /// Index of the tick at a time of the motion, s.
    pub fn at(&self, time: f64) -> usize {
        self.prelude + (time / self.period).round() as usize
    }

    /// How long after tick `from` the device was in Fault or away, its clutches in the safe state, ms.
    pub fn safe_after(&self, from: usize) -> Option<f64> {
        let safe = self.settings.safe_command();
        let away = |tick: &DeviceTick| tick.report.is_none() && tick.applied.command == safe;
        let first = self.ticks[from..].iter().position(|tick| {
            tick.applied.command == safe
                && (tick.applied.phase == Phase::Fault || tick.applied.phase == Phase::Boot || away(tick))
        })?;
        Some(1e3 * first as f64 * self.period)
    }

    /// How long after tick `from` it was in control again after having been in the safe state, ms.
    pub fn back_after(&self, from: usize) -> Option<f64> {
        let gone = (self.safe_after(from)? / 1e3 / self.period).round() as usize;
        let back = self.ticks[from + gone..].iter().position(|tick| decides(&tick.applied) && tick.report.is_some())?;
        Some(1e3 * (gone + back) as f64 * self.period)
    }

    /// What has to hold whatever happens: never both clutches but for a block that stands, in the safe state wherever the law does not
    /// decide, only the ways that the supervisor has between its states, and the settings as they were given.
    pub fn check(&self) {
        let safe = self.settings.safe_command();
        // Of two that wait at rest one is open as soon as a command has reached the clutches.
        let mut waiting = 0.0;
        for tick in &self.seen {
            if tick.decision.command == [true; 2] {
                waiting = tick.plant.time;
            }
            let both = tick.plant.engaged == [true; 2] && tick.plant.time > waiting + RELEASED_WITHIN;
            assert!(!both, "both engaged at {} s", tick.plant.time);
        }
        let mut before: Option<(u32, Phase)> = None;
        for (index, tick) in self.ticks.iter().enumerate() {
            assert!(!both_in_motion(&tick.applied), "both in force at tick {index}");
            let Some(report) = &tick.report else { continue };
            let decision = &report.decision;
            assert!(!both_in_motion(decision), "both commanded at tick {index}");
            assert!(decision.fault.is_some() || decision.phase != Phase::Fault, "tick {index}: {decision:?}");
            if !decides(decision) && decision.phase != Phase::SelfTest {
                // Of the rungs of the safe state the one that its fault leaves.
                let of_clutch = |fault: Fault| fault.is_of_an_engaged_clutch() || fault.missing_clutch().is_some();
                let lower = decision.fault.is_some_and(of_clutch) && decision.command != [true; 2];
                assert!(decision.command == safe || lower, "tick {index}: {decision:?}");
            }
            if let Some((number, phase)) = before
                && report.tick == number.wrapping_add(1)
            {
                let resumed = self.starts.iter().any(|(_, started)| started.resumed);
                assert!(is_way(phase, decision.phase, resumed), "tick {index}: {phase:?} to {:?}", decision.phase);
            }
            before = Some((report.tick, decision.phase));
        }
        let kept = if self.stored || self.starts.is_empty() { self.settings } else { Settings::default() };
        assert_eq!(self.identity.check, kept.check(), "its settings have changed");
        assert_eq!(self.late, None, "it started anew at the end");
    }
}

/// Whether both clutches are commanded though the block does not stand.
fn both_in_motion(decision: &Decision) -> bool {
    decision.command == [true; 2] && !decision.estimate.standing
}

/// Whether the law decides.
pub fn decides(decision: &Decision) -> bool {
    matches!(decision.phase, Phase::Armed | Phase::Rocking)
}

/// The ways of `docs/controller.md`; a device that resumes after a reset skips what is before Rocking.
pub fn is_way(from: Phase, to: Phase, resumed: bool) -> bool {
    use Phase::{Armed, Boot, Calibrate, Fault, Rocking, SelfTest};
    match (from, to) {
        (Boot, Rocking) | (Rocking, Calibrate) | (Calibrate, Rocking) => resumed,
        (Boot, SelfTest)
        | (SelfTest, Calibrate)
        | (Calibrate, Armed)
        | (Armed, Rocking)
        | (Rocking, Armed)
        | (Armed, Calibrate) => true,
        (_, Fault) | (Fault, SelfTest | Calibrate) => true,
        (from, to) => from == to,
    }
}

/// A row of the table in `docs/faults.md`.
pub fn row(fault: &str, made: &str, does: &str, safe: Option<f64>, back: Option<f64>, test: &str) {
    let cell = |time: Option<f64>| time.map_or_else(|| "-".to_owned(), |time| format!("{time:.1}"));
    println!("| {fault} | {made} | {does} | {} | {} | `{test}` |", cell(safe), cell(back));
}
