//! A block that rocks, its sensors and its clutches, roughly: what a supervisor sees, and what can go wrong with it.

use super::super::*;
use crate::control::monitor::coil::CoilReports;
use crate::control::monitor::stuck_time;
use crate::control::sensing::sample::{Count, Reading, Sample};
use std::vec::Vec;

/// A generator of Lehmer's kind (Knuth's MMIX constants), so that a run depends on its seed alone.
#[derive(Clone)]
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }

    /// From -1 to 1, the sum of two, so that it has tails.
    pub fn noise(&mut self) -> f32 {
        ((self.bits() >> 8) as f32 + (self.bits() >> 8) as f32) / 16_777_216.0 - 1.0
    }
}

pub const SLENDERNESS: f32 = 0.2;
pub const COUNTS: f32 = 1e5;
pub const GRAVITY: f32 = 9.81;
/// Of the sensors of the rig, to be found by the calibration.
pub const BIAS: f32 = 0.05;

pub fn parameters() -> Parameters {
    let mut parameters = Parameters::default();
    parameters.monitor.encoder.counts_per_radian = COUNTS;
    parameters
}

/// As the default, with noise known to be fine, so that readings that repeat are found at rest too.
pub fn noisy() -> Parameters {
    with_noise(200.0)
}

/// With the stuck times of sensors whose noise, in steps of a reading, is known.
pub fn with_noise(in_steps: f32) -> Parameters {
    let mut parameters = parameters();
    let (monitor, time) = (&mut parameters.monitor, stuck_time(in_steps, 0.001));
    for limits in [&mut monitor.gyroscope, &mut monitor.block_accelerometer, &mut monitor.ground_accelerometer] {
        (limits.stuck_time, limits.stuck_time_moving) = (time, time);
    }
    parameters
}

#[derive(Clone)]
pub struct Rig {
    pub supervisor: Supervisor,
    pub state: SupervisorState,
    pub tick: u32,
    pub rotation: f32,
    pub velocity: f32,
    /// Amplitude of the ground's shaking, m/s².
    pub shaking: f32,
    /// Peak of an impact in the accelerometers, m/s², for a reading.
    pub spike: f32,
    pub impacts: u32,
    pub wish: [bool; 2],
    pub standing: bool,
    pub requests: Requests,
    pub coils: CoilReports,
    pub lateness: f32,
    pub estimate_lost: bool,
    /// Ticks from command to feedback.
    pub delay: usize,
    pub first_number: u32,
    pub first_count: i32,
    jolted: bool,
    true_sample: Sample,
    held: Sample,
    sent: Vec<[bool; 2]>,
    random: Random,
}

impl Rig {
    pub fn new(parameters: &Parameters) -> Rig {
        let supervisor = Supervisor::new(parameters).unwrap();
        Rig {
            supervisor,
            state: SupervisorState::default(),
            tick: 0,
            rotation: 0.0,
            velocity: 0.0,
            shaking: 0.0,
            spike: 300.0,
            impacts: 0,
            wish: [false; 2],
            standing: false,
            requests: Requests::default(),
            coils: CoilReports::default(),
            lateness: 0.0,
            estimate_lost: false,
            delay: 20,
            first_number: 0,
            first_count: 0,
            jolted: false,
            true_sample: Sample::default(),
            held: Sample::default(),
            sent: std::vec![[false; 2]; 64],
            random: Random(1),
        }
    }

    /// At rest, armed.
    pub fn armed(parameters: &Parameters) -> Rig {
        let mut rig = Rig::new(parameters);
        rig.until(Phase::Armed, 8000);
        rig.quietly(5000);
        rig
    }

    /// In the middle of a swing.
    pub fn rocking(parameters: &Parameters) -> Rig {
        let mut rig = Rig::armed(parameters);
        rig.velocity = 0.28;
        rig.quietly(100);
        assert!(rig.velocity > 0.2 && rig.rotation > 0.0);
        rig
    }

    /// At an impact, whose spike saturates the block's accelerometer from the next tick on.
    pub fn impact(parameters: &Parameters) -> Rig {
        let mut rig = Rig::rocking(parameters);
        while rig.impacts == 0 || !rig.jolted {
            rig.quietly(1);
        }
        rig
    }

    /// One tick of the block: slender, p = 1.5/s, restitution 0.9.
    fn move_on(&mut self) {
        self.tick += 1;
        if self.rotation == 0.0 && self.velocity == 0.0 {
            return;
        }
        let side = if self.rotation == 0.0 { self.velocity.signum() } else { self.rotation.signum() };
        self.velocity -= 0.0005 * 2.25 * (side * SLENDERNESS - self.rotation);
        let before = self.rotation;
        self.rotation += 0.0005 * self.velocity;
        if before * self.rotation < 0.0 {
            self.impacts += 1;
            self.jolted = true;
            self.velocity *= 0.9;
            if self.velocity.abs() < 0.01 {
                (self.rotation, self.velocity) = (0.0, 0.0);
            }
        }
    }

    /// The sensors, each read every other tick.
    fn sense(&mut self) {
        if !self.tick.is_multiple_of(2) {
            return;
        }
        let number = self.first_number.wrapping_add(self.tick / 2);
        let rocks = self.rotation != 0.0 || self.velocity != 0.0;
        let side = if rocks { self.rotation.signum() } else { 0.0 };
        let ground = self.shaking * if (self.tick / 40).is_multiple_of(2) { 1.0 } else { -1.0 };
        let spike = if self.jolted { self.spike } else { 0.0 };
        self.jolted = false;
        let mut read = |value: f32, noise: f32, scale: f32| Reading {
            value: (value + noise * self.random.noise()).clamp(-scale, scale),
            number,
        };
        // Of the toe's reaction: R θ̈ = 3g/4 (θ - α), in the block's axes.
        let along = if rocks { 0.75 * GRAVITY * (self.rotation - side * SLENDERNESS) + GRAVITY * self.rotation } else { ground };
        self.true_sample = Sample {
            // A gyroscope feels a jolt a little.
            gyroscope: read(self.velocity + BIAS + 1e-3 * spike, 0.004, 8.7),
            block_accelerometer: [read(along + BIAS + spike, 0.03, 78.0), read(GRAVITY + BIAS + spike, 0.03, 78.0)],
            ground_accelerometer: [read(ground + BIAS + 0.1 * spike, 0.03, 78.0), read(GRAVITY + BIAS, 0.03, 78.0)],
            encoder: Count { counts: self.first_count.wrapping_add((self.rotation * COUNTS).round() as i32), number },
            engaged: [false; 2],
        };
    }

    /// A tick in which `spoil` may change what the supervisor sees: of the true sample and of the last one before it began to.
    pub fn spoilt(&mut self, spoil: impl Fn(&mut Sample, &Sample)) -> Verdict {
        self.move_on();
        self.sense();
        let mut sample = self.true_sample;
        sample.engaged = self.sent[self.sent.len() - 1 - self.delay];
        spoil(&mut sample, &self.held);
        let lost = if self.estimate_lost { f32::NAN } else { 0.0 };
        let input = SupervisorInput {
            sample: &sample,
            wish: self.wish,
            standing: self.standing,
            estimate: (self.rotation + lost, self.velocity),
            lever: 1.0,
            lateness: self.lateness,
            requests: self.requests,
            coils: self.coils,
            slower: None,
        };
        let verdict = self.supervisor.step(&mut self.state, &input);
        assert!(verdict.command != [true; 2] || self.supervisor.both_allowed || self.standing);
        self.sent.remove(0);
        self.sent.push(verdict.command);
        verdict
    }

    pub fn step(&mut self) -> Verdict {
        let verdict = self.spoilt(|_, _| {});
        self.held = self.true_sample;
        verdict
    }

    /// So many ticks, none of them with a fault.
    pub fn quietly(&mut self, ticks: u32) {
        for _ in 0..ticks {
            let verdict = self.step();
            assert_eq!(verdict.fault, None, "tick {}", self.tick);
        }
    }

    pub fn run(&mut self, ticks: u32) -> Verdict {
        for _ in 1..ticks {
            self.step();
        }
        self.step()
    }

    /// Until `phase` begins: after how many ticks.
    pub fn until(&mut self, phase: Phase, most: u32) -> u32 {
        for tick in 1..=most {
            if self.step().phase == phase {
                return tick;
            }
        }
        panic!("{phase:?} has not begun after {most} ticks: {:?}, {:?}", self.state.phase, self.kinds());
    }

    /// Spoils from the next tick on: after how many ticks of that there is a fault, and which. 1 is at once.
    pub fn found(&mut self, most: u32, spoil: impl Fn(&mut Sample, &Sample)) -> Option<(u32, Fault)> {
        (1..=most).find_map(|tick| self.spoilt(&spoil).fault.map(|fault| (tick, fault)))
    }

    pub fn kinds(&self) -> Vec<Kind> {
        self.state.log.iter().map(|entry| entry.kind).collect()
    }

    /// Warnings and faults in the log.
    pub fn complaints(&self) -> Vec<Kind> {
        self.kinds().into_iter().filter(|kind| kind.fault().is_some()).collect()
    }
}
