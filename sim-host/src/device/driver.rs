//! A device in the place of the host's controller in a closed loop, tick for tick beside that controller.

use std::time::Duration;

use sprag_shared::control::controller::{Circumstances, Decision};
use sprag_shared::control::estimate::Estimate;
use sprag_shared::control::event_log::Entry;
use sprag_shared::control::law::Wish;
use sprag_shared::control::sample::Sample;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::digest::Digest;
use sprag_shared::link::{Mishap, Pace, Request, Started, TickReport, TickSample};
use sprag_shared::settings::Settings;

use super::line::{DeviceError, Line};
use super::parameters;
use super::session::Session;
use crate::closed_loop::driver::Driver;
use crate::closed_loop::plant::Whereabouts;

/// For how long one tick's report is waited for before the sample is sent again.
const PATIENCE: Duration = Duration::from_millis(100);

/// How often a sample is sent before its tick is given up.
const ATTEMPTS: u32 = 3;

/// A device that says nothing for so long is gone.
const GIVE_UP: Duration = Duration::from_secs(20);

/// What the device said of one tick.
#[derive(Clone, Copy, Debug)]
pub struct DeviceTick {
    /// Its report; `None` where none came.
    pub report: Option<TickReport>,
    /// What it decided is not what the host's controller decided, to the last bit.
    pub differs: bool,
}

/// A device that drives a closed loop.
pub struct DeviceDriver<L> {
    session: Session<L>,
    own: Box<dyn Driver>,
    period: f64,
    number: u32,
    last: Decision,
    safe: [bool; 2],
    ticks: Vec<DeviceTick>,
    error: Option<DeviceError>,
    /// For how long a device that has been reset is away, s.
    boot_time: f64,
    away: u32,
    starts: Vec<(u32, Started)>,
    mishaps: Vec<(u32, Mishap)>,
}

impl<L: Line> DeviceDriver<L> {
    /// Gives the device `settings`, tells it to take its samples from the link, and starts its controller. `own` is the same controller on the
    /// host.
    ///
    /// # Errors
    /// Those of talking to it.
    pub fn attach(mut session: Session<L>, settings: &Settings, own: Box<dyn Driver>) -> Result<DeviceDriver<L>, DeviceError> {
        parameters::write(&mut session, settings, false)?;
        let pace = session.line().pace();
        session.order(&Request::Attach { pace })?;
        while session.take_tick().is_some() {}
        session.take_started();
        let safe = settings.safe_command();
        let last = Decision {
            command: safe,
            estimate: Estimate { standing: true, ..Estimate::default() },
            wish: Wish::Release,
            phase: Phase::Boot,
            fault: None,
        };
        Ok(DeviceDriver {
            session,
            own,
            period: settings.period().into(),
            number: 0,
            last,
            safe,
            ticks: Vec::new(),
            error: None,
            boot_time: 0.0,
            away: 0,
            starts: Vec::new(),
            mishaps: Vec::new(),
        })
    }

    /// Lets `mishap` happen at a tick, counted from the first one of all.
    #[must_use]
    pub fn with_mishap(mut self, tick: u32, mishap: Mishap) -> Self {
        self.mishaps.push((tick, mishap));
        self
    }

    /// Lets the plant go on for this long (s) without a controller, its clutches in the safe state, whenever the device starts anew: an
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

    /// The session, once the loop is over.
    ///
    /// # Errors
    /// What ended the conversation before.
    pub fn finish(self) -> Result<(Session<L>, Vec<DeviceTick>), DeviceError> {
        match self.error {
            Some(error) => Err(error),
            None => Ok((self.session, self.ticks)),
        }
    }

    /// The report of the tick that is paced by the device's timer: one period, one report.
    fn paced_by_timer(&mut self) -> Result<Option<TickReport>, DeviceError> {
        // Replies are to nothing that is still of interest.
        self.session.receive(GIVE_UP)?;
        let mut newest = None;
        while let Some(report) = self.session.take_tick() {
            newest = Some(report);
        }
        Ok(newest)
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
            self.away = (self.boot_time / self.period).round() as u32;
        }
        Ok(report)
    }
}

fn bits(decision: &Decision) -> u64 {
    let mut digest = Digest::default();
    digest.decision(decision);
    digest.hash()
}

impl<L: Line> Driver for DeviceDriver<L> {
    fn tick(&mut self, sample: &Sample, circumstances: Circumstances) -> Decision {
        self.number = self.number.wrapping_add(1);
        let own = self.own.tick(sample, circumstances);
        let report = if self.error.is_some() {
            None
        } else if self.away > 0 {
            self.away -= 1;
            None
        } else {
            match self.exchange(sample, circumstances) {
                Ok(report) => report,
                Err(error) => {
                    self.error = Some(error);
                    None
                }
            }
        };
        match &report {
            Some(report) => self.last = report.decision,
            None if self.away > 0 || self.error.is_some() => self.last.command = self.safe,
            None => {}
        }
        let differs = report.is_none_or(|report| bits(&report.decision) != bits(&own));
        self.ticks.push(DeviceTick { report, differs });
        self.last
    }

    fn ideal(&mut self, plant: &Whereabouts) -> Wish {
        self.own.ideal(plant)
    }

    fn log(&self) -> Vec<Entry> {
        self.own.log()
    }
}
