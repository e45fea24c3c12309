//! A device in the place of the host's controller in a closed loop, tick for tick beside that controller.
//!
//! The plant's clutches are driven as a board drives its own: a coil keeps its last command until it gets another. So where a report is lost
//! on the way the last one stays in force, and while the device is late the plant moves on without it. Only a device that starts anew lets go
//! by itself: before a reset it puts its coils into the safe state, and there they stay until its first tick.

use std::collections::VecDeque;
use std::time::Duration;

use sprag_shared::control::controller::{Circumstances, Decision};
use sprag_shared::control::law::Wish;
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::supervisor::event_log::Entry;
use sprag_shared::link::reset_cause::Cause;
use sprag_shared::link::{Identity, MAX_FRAME, Mishap, Pace, Request, Started, State, TickReport, TickSample, encode};
use sprag_shared::settings::Settings;
use sprag_sim::closed_loop::driver::Driver;
use sprag_sim::closed_loop::plant::Whereabouts;

use super::line::{DeviceError, Line};
use super::parameters;
use super::session::Session;

/// For how long one tick's report is waited for before the sample is sent again.
const PATIENCE: Duration = Duration::from_millis(100);

/// How often a sample is sent before its tick is given up.
const ATTEMPTS: u32 = 3;

/// So many exchanges in a row without a report, and the device does not tick.
const UNREPORTED: u32 = 100;

/// A device that says nothing for so long is gone.
const GIVE_UP: Duration = Duration::from_secs(20);

/// For how long a watchdog lets a device that has lost its way continue, s.
const WATCHDOG: f64 = 0.02;

/// What the device said of one tick.
#[derive(Clone, Copy, Debug)]
pub struct DeviceTick {
    /// Its report; `None` where none came.
    pub report: Option<TickReport>,
    /// What was in force at the plant from then on.
    pub applied: Decision,
    /// What the host's controller decided.
    pub own: Decision,
    /// What it decided is not what the host's controller decided, to the last bit.
    pub differs: bool,
}

/// What a device says at the end of a loop.
#[derive(Clone, Debug)]
pub struct Farewell {
    /// Every tick, from the first one of the stillness before the motion.
    pub ticks: Vec<DeviceTick>,
    /// How it was after the last one.
    pub state: State,
    /// Who it is.
    pub identity: Identity,
    /// That it has started anew since the last tick.
    pub started: Option<Started>,
}

/// A device that drives a closed loop. Whatever becomes of the loop, the device is detached when this is dropped.
pub struct DeviceDriver<L: Line> {
    session: Session<L>,
    own: Box<dyn Driver>,
    period: f64,
    counter_hz: f64,
    number: u32,
    last: Decision,
    /// Sample and tick of the last report.
    newest: Option<(u32, u32)>,
    /// Reports of ticks that came late, each with the number of ticks until then.
    late: VecDeque<(u32, TickReport)>,
    safe: [bool; 2],
    ticks: Vec<DeviceTick>,
    error: Option<DeviceError>,
    /// Exchanges since the last report.
    unreported: u32,
    detached: bool,
    /// For how long a device that has been reset is away, s.
    boot_time: f64,
    /// Ticks for which the coils still hold what the device commanded before it lost its way.
    stalled: u32,
    /// Ticks after these for which it is away, its coils in the safe state.
    away: u32,
    starts: Vec<(u32, Started)>,
    mishaps: Vec<(u32, Mishap)>,
}

impl<L: Line> DeviceDriver<L> {
    /// Gives the device `settings`, makes it take its samples from the link, and starts its controller. `own` is the same controller on the
    /// host.
    ///
    /// # Errors
    /// Those of talking to it.
    pub fn attach(mut session: Session<L>, settings: &Settings, own: Box<dyn Driver>) -> Result<DeviceDriver<L>, DeviceError> {
        // Another loop may have ended without a word.
        session.order(&Request::Detach)?;
        parameters::write(&mut session, settings, false)?;
        let counter_hz = session.identify()?.counter_hz.into();
        let pace = session.line().pace();
        if let Err(error) = session.order(&Request::Attach { pace }) {
            // It may have heard, and its answer been lost.
            detach(&mut session);
            return Err(error);
        }
        while session.take_tick().is_some() {}
        session.take_started();
        let safe = settings.safe_command();
        let last = Decision::before(safe);
        Ok(DeviceDriver {
            session,
            own,
            period: settings.period().into(),
            counter_hz,
            number: 0,
            last,
            newest: None,
            late: VecDeque::new(),
            safe,
            ticks: Vec::new(),
            error: None,
            unreported: 0,
            detached: false,
            boot_time: 0.0,
            stalled: 0,
            away: 0,
            starts: Vec::new(),
            mishaps: Vec::new(),
        })
    }

    /// Injects `mishap` at a tick, counted from the first one of all.
    #[must_use]
    pub fn with_mishap(mut self, tick: u32, mishap: Mishap) -> Self {
        self.mishaps.push((tick, mishap));
        self
    }

    /// Lets the plant move on for this long (s) without a controller, its clutches in the safe state, whenever the device starts anew: an
    /// emulator starts in no time, a board does not.
    #[must_use]
    pub fn with_boot_time(mut self, seconds: f64) -> Self {
        self.boot_time = seconds;
        self
    }

    /// What the device said, tick by tick from the first one of the stillness before the motion.
    pub fn ticks(&self) -> &[DeviceTick] {
        &self.ticks
    }

    /// New starts in mid-run, by tick.
    pub fn starts(&self) -> &[(u32, Started)] {
        &self.starts
    }

    /// What the device says once the loop is over; and detaches it.
    ///
    /// # Errors
    /// What ended the conversation before, or as [`Session::ask`].
    pub fn finish(mut self) -> Result<Farewell, DeviceError> {
        if let Some(error) = self.error.take() {
            return Err(error);
        }
        let (state, identity) = (self.session.state()?, self.session.identify()?);
        self.session.order(&Request::Detach)?;
        self.detached = true;
        let started = self.session.take_started();
        Ok(Farewell { ticks: std::mem::take(&mut self.ticks), state, identity, started })
    }

    /// The report of the tick that is paced by the device's timer: one period, one report.
    fn paced_by_timer(&mut self) -> Result<Option<TickReport>, DeviceError> {
        let asked = std::time::Instant::now();
        // Replies are to nothing that is still of interest.
        self.session.receive(GIVE_UP)?;
        if asked.elapsed() >= GIVE_UP {
            return Err(DeviceError::Silent(String::new()));
        }
        let mut newest = None;
        while let Some(report) = self.session.take_tick() {
            if !self.is_news(&report) {
                continue;
            }
            let periods = (f64::from(report.lateness) / self.counter_hz / self.period).round() as u32;
            if periods > 0 {
                self.late.push_back((periods + u32::from(newest.is_some()), report));
            } else if !self.late.is_empty() {
                self.late.push_back((1, report));
            } else {
                newest = Some(report);
            }
        }
        Ok(newest)
    }

    /// Whether nothing newer has been heard: frames may overtake each other.
    fn is_news(&mut self, report: &TickReport) -> bool {
        let newer = self.newest.is_none_or(|(sample, tick)| {
            let after = |now: u32, before: u32| now.wrapping_sub(before) as i32;
            match after(report.sample, sample) {
                0 => after(report.tick, tick) > 0,
                ahead => ahead > 0,
            }
        });
        if newer {
            self.newest = Some((report.sample, report.tick));
        }
        newer
    }

    /// The report of the tick that the sample itself makes.
    fn paced_by_sample(&mut self, sample: &TickSample) -> Result<Option<TickReport>, DeviceError> {
        for attempt in 0..ATTEMPTS {
            if attempt > 0 {
                self.session.sample(sample)?;
            }
            let asked = std::time::Instant::now();
            while asked.elapsed() < PATIENCE {
                self.session.receive(PATIENCE)?;
                while let Some(report) = self.session.take_tick() {
                    if report.sample == sample.number {
                        return Ok(Some(report));
                    }
                }
            }
        }
        Ok(None)
    }

    fn exchange(&mut self, sample: &Sample, circumstances: Circumstances) -> Result<Option<TickReport>, DeviceError> {
        let sample = TickSample {
            number: self.number,
            sample: *sample,
            lateness: circumstances.lateness,
            clear: circumstances.requests.clear,
        };
        for &(_, mishap) in self.mishaps.iter().filter(|(tick, _)| *tick == self.number) {
            self.session.rehearse(mishap)?;
        }
        self.session.sample(&sample)?;
        let report = match self.session.line().pace() {
            Pace::Timer => self.paced_by_timer()?,
            Pace::Sample => self.paced_by_sample(&sample)?,
        };
        if let Some(started) = self.session.take_started() {
            self.starts.push((self.number, started));
            // It counts from the beginning again.
            self.newest = None;
            self.late.clear();
            let ticks = |seconds: f64| (seconds / self.period).round() as u32;
            self.stalled = if started.cause == Cause::Watchdog { ticks(WATCHDOG) } else { 0 };
            self.away = ticks(self.boot_time);
        }
        Ok(report)
    }
}

/// Lets go of a device that need not answer any more.
fn detach<L: Line>(session: &mut Session<L>) {
    let _ = session.send(&Request::Detach);
    let _ = session.receive(PATIENCE);
}

impl<L: Line> Drop for DeviceDriver<L> {
    fn drop(&mut self) {
        if !self.detached {
            detach(&mut self.session);
        }
    }
}

/// Whether two decisions are the same to the last bit, as they are sent.
pub fn same(one: &Decision, other: &Decision) -> bool {
    let (mut one_frame, mut other_frame) = ([0; MAX_FRAME], [0; MAX_FRAME]);
    let lengths = (encode(0, one, &mut one_frame), encode(0, other, &mut other_frame));
    lengths.0.is_ok() && lengths.0 == lengths.1 && one_frame == other_frame
}

impl<L: Line> DeviceDriver<L> {
    /// One tick of the device: its report, if there is one, and what is in force from then on.
    fn answer(&mut self, sample: &Sample, circumstances: Circumstances) -> Option<TickReport> {
        if self.error.is_some() {
            return None;
        }
        if let Some((left, _)) = self.late.front_mut() {
            *left = left.saturating_sub(1);
            return if *left == 0 { self.late.pop_front().map(|(_, report)| report) } else { None };
        }
        if self.stalled > 0 {
            self.stalled -= 1;
            return None;
        }
        if self.away > 0 {
            self.away -= 1;
            self.last.command = self.safe;
            return None;
        }
        match self.exchange(sample, circumstances) {
            Ok(report) => {
                self.unreported = if report.is_some() || !self.late.is_empty() { 0 } else { self.unreported + 1 };
                if self.unreported >= UNREPORTED {
                    self.error = Some(DeviceError::Unreported(self.unreported));
                }
                if self.away > 0 && self.stalled == 0 {
                    self.last.command = self.safe;
                }
                report
            }
            Err(error) => {
                self.error = Some(error);
                self.last.command = self.safe;
                None
            }
        }
    }
}

impl<L: Line> Driver for DeviceDriver<L> {
    fn tick(&mut self, sample: &Sample, circumstances: Circumstances) -> Decision {
        self.number = self.number.wrapping_add(1);
        let own = self.own.tick(sample, circumstances);
        let report = self.answer(sample, circumstances);
        if let Some(report) = &report {
            self.last = report.decision;
        }
        let differs = report.is_none_or(|report| !same(&report.decision, &own));
        self.ticks.push(DeviceTick { report, applied: self.last, own, differs });
        self.last
    }

    fn ideal(&mut self, plant: &Whereabouts, asked: bool) -> Wish {
        self.own.ideal(plant, asked)
    }

    fn log(&self) -> Vec<Entry> {
        self.own.log()
    }
}
