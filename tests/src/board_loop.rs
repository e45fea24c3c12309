//! The board's own image in closed loop with the plant: quantised sensors in at its buses, encoder's counts in at its counter, and the
//! plant's clutches at its coils' currents.

use std::collections::VecDeque;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use sprag_cli::board::driver::same;
use sprag_shared::control::controller::{Circumstances, Decision};
use sprag_shared::control::law::Wish;
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::supervisor::event_log::Entry;
use sprag_shared::device::coil::Feedback;
use sprag_shared::device::inertial::Component;
use sprag_shared::link::{Deframer, MAX_FRAME, Reply, Request, Started, TickReport, encode};
use sprag_shared::settings::Settings;
use sprag_shared::settings::wiring::{Axis, Wiring};
use sprag_sim::closed_loop::driver::Driver;
use sprag_sim::closed_loop::plant::Whereabouts;

use crate::board_mirror::{Mirror, Read};

/// Reports that the mirror is ahead of the board's, at most.
const AHEAD: usize = 64;

/// A board that drives a loop.
pub struct BoardDriver {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    own: Box<dyn Driver>,
    wiring: Wiring,
    clutches: [Feedback; 2],
    deframer: Deframer,
    last: Decision,
    mirror: Option<Mirror>,
    expected: VecDeque<TickReport>,
    /// Periods so far.
    pub periods: u32,
    /// In which period the watchdog resets it.
    pub reset_at: Option<u32>,
    /// Reports that were compared with the mirror's, …
    pub compared: u32,
    /// … and of these the ones that differ in a bit.
    pub differing: u32,
    /// What it has said of its starts, and when.
    pub starts: Vec<(u32, Started)>,
    /// What it has reported, and when.
    pub reports: Vec<(u32, TickReport)>,
    /// How often a clutch has changed.
    pub changes: u32,
    engaged: [bool; 2],
}

impl BoardDriver {
    /// Powers a board that has `settings` in its flash. `own` is the controller of the host, which only says what the law would want.
    pub fn new(bench: &Path, image: &Path, settings: &Settings, own: Box<dyn Driver>) -> BoardDriver {
        let mut child =
            Command::new(bench).arg("lockstep").arg(image).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let (mut input, output) = (child.stdin.take().unwrap(), child.stdout.take().unwrap());
        let words: Vec<String> = settings.words().iter().map(|word| format!("{word:x}")).collect();
        writeln!(input, "{}", words.join(" ")).unwrap();
        let wiring = Wiring::of(settings);
        BoardDriver {
            child,
            input,
            output: BufReader::new(output),
            own,
            wiring,
            clutches: Default::default(),
            deframer: Deframer::new(),
            last: Decision::before(settings.safe_command()),
            mirror: Some(Mirror::new(settings)),
            expected: VecDeque::new(),
            periods: 0,
            reset_at: None,
            compared: 0,
            differing: 0,
            starts: Vec::new(),
            reports: Vec::new(),
            changes: 0,
            engaged: [false; 2],
        }
    }

    /// What is said to the board of a sample: all its sensors' axes, each as many counts as the part would give.
    fn counts(&self, sample: &Sample) -> [i16; 12] {
        let Wiring { block_gyroscope, block, ground, .. } = self.wiring;
        let mut counts = [0; 12];
        let mut put = |first: usize, axis: Axis, value: f32, component: Component| {
            counts[first + usize::from(axis.index())] = (value / component.of([1; 3])).round() as i16;
        };
        for (first, axes, readings) in [(0, block, &sample.block_accelerometer), (6, ground, &sample.ground_accelerometer)] {
            put(first, axes[0], readings[0].value, Component::of_acceleration(axes[0]));
            put(first, axes[1], readings[1].value, Component::of_acceleration(axes[1]));
        }
        put(3, block_gyroscope, sample.gyroscope.value, Component::of_rate(block_gyroscope));
        counts
    }

    /// Sends what is to be sent in a period and gives the bench's answer.
    fn exchange(&mut self, sample: &Sample) -> String {
        let mut line = self.wiring.travel(sample.encoder.counts).to_string();
        for count in self.counts(sample) {
            let _ = write!(line, " {count}");
        }
        line.push(' ');
        // Until it streams: a board that has just started does not hear.
        let resets = self.reset_at == Some(self.periods);
        let silent = self.reports.last().is_none_or(|(at, _)| self.periods - at > 4);
        if silent && self.periods.is_multiple_of(4) {
            let mut frame = [0; MAX_FRAME];
            let length = encode(1, &Request::Stream { every: 1 }, &mut frame).unwrap();
            frame[..length].iter().for_each(|byte| _ = write!(line, "{byte:02x}"));
        } else {
            line.push('-');
        }
        if resets {
            line.push_str(" reset");
            // It knows of nothing that the board keeps.
            self.mirror = None;
        }
        writeln!(self.input, "{line}").unwrap();
        let mut answer = String::new();
        self.output.read_line(&mut answer).unwrap();
        assert!(!answer.is_empty(), "the bench has gone");
        answer
    }

    fn hear(&mut self, link: &str) {
        if link == "-" {
            return;
        }
        for place in (0..link.len()).step_by(2) {
            let byte = u8::from_str_radix(&link[place..place + 2], 16).unwrap();
            match self.deframer.feed::<Reply>(byte) {
                Some(Ok(received)) => match received.message {
                    Reply::Tick(report) => self.compare(report),
                    Reply::Started(started) => self.starts.push((self.periods, started)),
                    _ => {}
                },
                // A reset cuts a frame.
                Some(Err(error)) => assert!(self.reset_at.is_some(), "{error}"),
                None => {}
            }
        }
    }

    fn compare(&mut self, report: TickReport) {
        self.last = report.decision;
        self.reports.push((self.periods, report));
        if self.mirror.is_none() {
            return;
        }
        while self.expected.front().is_some_and(|expected| expected.tick < report.tick) {
            self.expected.pop_front();
        }
        let expected = self.expected.pop_front().expect("a report of a tick that was not");
        assert_eq!(expected.tick, report.tick);
        self.compared += 1;
        self.differing += u32::from(!same(&expected.decision, &report.decision));
        assert_eq!(report.lateness, 0, "tick {}", report.tick);
    }
}

/// What a tick read, as the bench says it.
fn read<'a>(mut words: impl Iterator<Item = &'a str>) -> Option<Read> {
    let counts = |word: &str| -> Option<[i16; 6]> {
        let counts: Vec<i16> = word.split(',').map(|count| count.parse().ok()).collect::<Option<_>>()?;
        counts.try_into().ok()
    };
    let (block, ground) = (counts(words.next()?), counts(words.next()?));
    let mut number = || words.next().map(|word| word.parse().unwrap());
    Some(Read { block, ground, counter: number()?, converted: [number()?, number()?] })
}

impl Driver for BoardDriver {
    fn tick(&mut self, sample: &Sample, circumstances: Circumstances) -> Decision {
        self.own.tick(sample, circumstances);
        let answer = self.exchange(sample);
        let mut words = answer.split_ascii_whitespace();
        let mut current = || words.next().unwrap().parse::<f32>().unwrap();
        let currents = [current(), current()];
        let ticks: u32 = words.next().unwrap().parse().unwrap();
        let link = words.next().unwrap().to_owned();
        let read = read(words);
        assert!(ticks <= 1, "{ticks} ticks in a period");
        if let (Some(mirror), Some(read)) = (&mut self.mirror, &read) {
            self.expected.push_back(mirror.tick(read));
            assert!(self.expected.len() < AHEAD || self.reports.is_empty(), "the board has fallen silent");
        }
        self.hear(&link);
        self.periods += 1;
        let threshold = self.wiring.coil_engaged_current;
        let before = self.engaged;
        for (coil, engaged) in self.engaged.iter_mut().enumerate() {
            *engaged = self.clutches[coil].engaged(currents[coil], threshold);
        }
        self.changes += u32::from(self.engaged != before);
        Decision { command: self.engaged, ..self.last }
    }

    fn ideal(&mut self, plant: &Whereabouts, asked: bool) -> Wish {
        self.own.ideal(plant, asked)
    }

    fn log(&self) -> Vec<Entry> {
        Vec::new()
    }
}

impl Drop for BoardDriver {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
