//! The samples of a closed loop, to be played to its controller again with something changed.

use std::collections::VecDeque;

use sprag_shared::control::controller::{Circumstances, Controller, ControllerState, Decision};
use sprag_shared::control::law::Wish;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::supervisor::event_log::{Entry, Kind};
use sprag_shared::control::supervisor::{Phase, Requests};
use sprag_shared::motion::state::Phase as Standing;
use sprag_sim::closed_loop::driver::Driver;
use sprag_sim::closed_loop::plant::{Extremes, Whereabouts};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::controller::EstimatorName;

use crate::device_loop::{decides, is_way, pulse};

/// Ticks from a command to the feedback that it has been followed.
const FEEDBACK: usize = 3;

/// A controller, and what its sensors said before, during and after a motion.
pub struct Tape {
    /// The controller.
    pub controller: Controller,
    /// Nothing moves; the controller arms itself.
    pub prelude: Vec<Sample>,
    /// A sine pulse of three thresholds and the free rocking after it, down to rest.
    pub motion: Vec<Sample>,
}

impl Tape {
    /// Of a loop with this estimator and these sensors.
    pub fn new(estimator: EstimatorName, suite: &str) -> Tape {
        let set = [
            &format!("controller.estimator=\"{}\"", estimator.name()) as &str,
            &format!("controller.sensors.suite=\"{suite}\""),
            "run.free_time_s=12",
        ];
        let scene = pulse(&set);
        let interrupt = Interrupt::default();
        let task = scene.task(scene.pairs[0], 1, &interrupt);
        let clock = task.clock();
        let mut heard = Listener { own: task.driver().unwrap(), samples: Vec::new() };
        let mut extremes = Extremes::default();
        let ending = task.run_with(&mut heard, &mut (), &mut extremes, &mut ()).unwrap();
        assert!(ending.motion.impacts >= 3 && ending.motion.phase == Standing::Rest, "{ending:?}");
        let (prelude, motion) = heard.samples.split_at((clock.prelude / clock.period).round() as usize);
        Tape {
            controller: task.controller(task.controller.clutch_law()).unwrap(),
            prelude: prelude.to_vec(),
            motion: motion.to_vec(),
        }
    }

    /// Stillness after `last`: the prelude over again, with numbers that continue.
    pub fn stillness_after(&self, last: &Sample) -> impl Iterator<Item = Sample> + '_ {
        let quiet = &self.prelude[self.prelude.len() / 2..];
        let length = quiet[quiet.len() - 1].gyroscope.number.wrapping_sub(quiet[0].gyroscope.number) + 1;
        let first = last.gyroscope.number.wrapping_add(1).wrapping_sub(quiet[0].gyroscope.number);
        (0_u32..).flat_map(move |round| {
            quiet.iter().map(move |sample| numbered_on(sample, first.wrapping_add(round.wrapping_mul(length))))
        })
    }

    /// Prelude, motion, and stillness for so many ticks.
    pub fn whole(&self, still: usize) -> Vec<Sample> {
        let last = self.motion.last().expect("a motion");
        let moved = self.prelude.iter().chain(&self.motion).copied();
        moved.chain(self.stillness_after(last).take(still)).collect()
    }
}

/// A controller that remembers what it was given.
struct Listener {
    own: Box<dyn Driver>,
    samples: Vec<Sample>,
}

impl Driver for Listener {
    fn tick(&mut self, sample: &Sample, circumstances: Circumstances) -> Decision {
        self.samples.push(*sample);
        self.own.tick(sample, circumstances)
    }

    fn ideal(&mut self, plant: &Whereabouts, asked: bool) -> Wish {
        self.own.ideal(plant, asked)
    }

    fn log(&self) -> Vec<Entry> {
        self.own.log()
    }
}

/// The same readings, taken `later` readings later.
pub fn numbered_on(sample: &Sample, later: u32) -> Sample {
    let mut sample = *sample;
    let [along, up] = &mut sample.block_accelerometer;
    let [ground_along, ground_up] = &mut sample.ground_accelerometer;
    for reading in [&mut sample.gyroscope, along, up, ground_along, ground_up] {
        reading.number = reading.number.wrapping_add(later);
    }
    sample.encoder.number = sample.encoder.number.wrapping_add(later);
    sample
}

/// A controller at work, and what has to hold at every tick.
pub struct Player<'a> {
    controller: &'a Controller,
    /// Its state.
    pub state: ControllerState,
    clutches: VecDeque<[bool; 2]>,
    phase: Phase,
    /// What an operator asks for.
    pub asked: Requests,
}

impl<'a> Player<'a> {
    /// At power-on.
    pub fn new(controller: &'a Controller) -> Player<'a> {
        let clutches = VecDeque::from(vec![controller.supervisor.safe(); FEEDBACK]);
        Player { controller, state: controller.start(), clutches, phase: Phase::Boot, asked: Requests::default() }
    }

    /// One tick, in time.
    pub fn tick(&mut self, sample: &Sample) -> Decision {
        self.tick_late(sample, 0.0)
    }

    /// One tick, `lateness` s after its time: clutches that obey, and never both on a block that moves; the safe state wherever the law
    /// does not decide; only the ways that the supervisor has between its states; and finite estimates, whatever the sensors say.
    pub fn tick_late(&mut self, sample: &Sample, lateness: f32) -> Decision {
        let engaged = self.clutches.pop_front().expect("never empty");
        let sample = Sample { engaged, ..*sample };
        let decision = self.controller.tick(
            &mut self.state,
            &sample,
            Circumstances { lateness, requests: self.asked, ..Circumstances::default() },
        );
        self.clutches.push_back(decision.command);
        let estimate = &decision.estimate;
        let numbers =
            [estimate.rotation, estimate.velocity, estimate.push, estimate.ground[0], estimate.ground[1], estimate.ground_rate];
        assert!(numbers.iter().all(|number| number.is_finite()), "{decision:?} of {sample:?}");
        assert!(self.state.spins().iter().all(|spin| spin.is_finite()), "{:?}", self.state.spins());
        assert!(decision.command != [true; 2] || estimate.standing, "{decision:?}");
        assert!(is_way(self.phase, decision.phase, false), "{:?} to {decision:?}", self.phase);
        assert!(decision.fault.is_some() || decision.phase != Phase::Fault, "{decision:?}");
        if !decides(&decision) && decision.phase != Phase::SelfTest {
            assert_eq!(decision.command, self.controller.supervisor.safe(), "{decision:?}");
        }
        self.phase = decision.phase;
        decision
    }

    /// All of `samples`, in time.
    pub fn play<'s>(&mut self, samples: impl IntoIterator<Item = &'s Sample>) -> Vec<Decision> {
        samples.into_iter().map(|sample| self.tick(sample)).collect()
    }

    /// Faults and warnings in its log.
    pub fn complaints(&self) -> Vec<Fault> {
        self.state.supervisor().log.iter().filter_map(|entry| Kind::fault(entry.kind)).collect()
    }
}
