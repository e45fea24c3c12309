//! A block on a spring and a dashpot under each corner: a free body under forces at its two corners, by Newton's and Euler's laws. The corner
//! to which it leans does not slide, which a horizontal force there sees to.

use std::path::Path;

use crate::block::{Block, GRAVITY};
use crate::ground::Ground;
use crate::scene::Scene;

/// What a block did.
#[derive(Clone, Debug, Default)]
pub struct FoundationRun {
    /// In Sprag's words.
    pub outcome: &'static str,
    /// How often both corners pressed again.
    pub impacts: usize,
    /// Time (s) and θ (rad) at multiples of the output interval.
    pub samples: Vec<[f64; 2]>,
}

/// Turn clockwise (rad) and height of the centre of mass (m) above where it is on undeformed feet, with their rates.
type State = [f64; 4];

/// Who presses, to which side it leans, and whether a flywheel is engaged.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mode {
    presses: [bool; 2],
    side: f64,
    engaged: bool,
}

struct Runner {
    half_width: f64,
    height: f64,
    inertia: f64,
    stiffness: f64,
    damping: f64,
    ratio: f64,
    kind: String,
    consistent: bool,
    horizontal: Ground,
    vertical: Ground,
}

/// Runs the only device of `scene`, whose records lie in `folder`, in steps of `part` of the period in which the feet swing.
///
/// # Errors
/// A scene that cannot be read, in words.
pub fn run(scene: &Scene, folder: &Path, part: f64) -> Result<FoundationRun, String> {
    let (block, _) = Block::of(&scene.block)?;
    let foundation = scene.block.foundation.ok_or("a foundation")?;
    let device = scene.device.first().ok_or("a device")?;
    let (sin, cos) = block.slenderness.sin_cos();
    let omega = std::f64::consts::TAU * foundation.vertical_frequency_hz;
    let runner = Runner {
        half_width: block.size * sin,
        height: block.size * cos,
        inertia: (block.inertia - 1.0) * block.size * block.size,
        stiffness: omega * omega / 2.0,
        damping: foundation.damping_ratio * omega,
        ratio: if device.kind == "none" { 0.0 } else { device.mass_ratio.ok_or("mass_ratio")? },
        kind: device.kind.clone(),
        consistent: device.kinematics.as_deref() == Some("consistent"),
        horizontal: Ground::of(&scene.ground, &block, folder)?,
        vertical: Ground::of(&scene.vertical, &block, folder)?,
    };
    let free = scene.run.free_time_s.ok_or("free_time_s")?;
    let end = runner.horizontal.end().max(runner.vertical.end()) + free;
    let tilt = scene.block.initial_rotation_ratio * block.slenderness;
    runner.follow(tilt, end, scene.output.interval_s.ok_or("interval_s")?, part / foundation.vertical_frequency_hz)
}

impl Runner {
    /// From the centre of mass to the corner at `along`, and its rate over the turn.
    fn arm(&self, along: f64, turn: f64) -> ([f64; 2], [f64; 2]) {
        let (sin, cos) = turn.sin_cos();
        let arm = [along * cos - self.height * sin, -along * sin - self.height * cos];
        (arm, [arm[1], -arm[0]])
    }

    /// Compression of a corner's foot and the force that it would have.
    fn foot(&self, corner: usize, state: &State) -> (f64, f64) {
        let (arm, rate) = self.arm([-self.half_width, self.half_width][corner], state[0]);
        let compression = -(state[1] + self.height + arm[1]);
        (compression, self.stiffness * compression - self.damping * (state[3] + rate[1] * state[2]))
    }

    /// θ̈, ÿ, and acceleration times velocity of the terminals.
    fn accelerations(&self, state: &State, mode: Mode, ground: [f64; 2]) -> [f64; 3] {
        let (pivot, rate) = self.arm(mode.side * self.half_width, state[0]);
        let square = state[2] * state[2];
        let forces = [0, 1].map(|corner| if mode.presses[corner] { self.foot(corner, state).1 } else { 0.0 });
        let ratio = if mode.engaged { self.ratio } else { 0.0 };
        // The centre of mass is at −pivot from a corner that stands still: ẍ = −(p′θ̈ + p″θ̇²), p″ = −p.
        let swing = if self.consistent { 1.0 + ratio } else { 1.0 };
        let moment = rate[0] * (ground[0] + swing * pivot[0] * square)
            - (0..2)
                .map(|corner| self.arm([-self.half_width, self.half_width][corner], state[0]).0[0] * forces[corner])
                .sum::<f64>();
        let turn = moment / (self.inertia + (1.0 + ratio) * rate[0] * rate[0]);
        let along = -rate[0] * turn + if self.consistent { pivot[0] * square } else { 0.0 };
        [turn, forces[0] + forces[1] - GRAVITY - ground[1], along * -rate[0] * state[2]]
    }

    fn ground(&self, time: f64, within: f64) -> [f64; 2] {
        [self.horizontal.at(time, within), self.vertical.at(time, within)]
    }

    fn mode(&self, state: &State, ground: [f64; 2]) -> Mode {
        let presses = [0, 1].map(|corner| {
            let (compression, force) = self.foot(corner, state);
            compression > 0.0 && force > 0.0
        });
        let side = if state[0] == 0.0 { state[2] } else { state[0] }.signum();
        let mode = Mode { presses, side, engaged: self.kind == "inerter" };
        let resists = self.kind == "clutched-pair" && self.accelerations(state, mode, ground)[2] > 0.0;
        Mode { engaged: mode.engaged || resists, ..mode }
    }

    fn step(&self, state: &State, mode: Mode, time: f64, h: f64, within: f64) -> State {
        let rates = |state: &State, time: f64| {
            let [turn, lift, _] = self.accelerations(state, mode, self.ground(time, within));
            [state[2], state[3], turn, lift]
        };
        let plus = |rates: &State, h: f64| std::array::from_fn(|i| state[i] + h * rates[i]);
        let first = rates(state, time);
        let second = rates(&plus(&first, h / 2.0), time + h / 2.0);
        let third = rates(&plus(&second, h / 2.0), time + h / 2.0);
        let fourth = rates(&plus(&third, h), time + h);
        std::array::from_fn(|i| state[i] + h / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]))
    }

    fn follow(&self, tilt: f64, end: f64, interval: f64, longest: f64) -> Result<FoundationRun, String> {
        let mut stops = [self.horizontal.kinks(), self.vertical.kinks()].concat();
        stops.extend((0..).map(|sample| f64::from(sample) * interval).take_while(|time| *time <= end));
        stops.push(end);
        stops.sort_by(f64::total_cmp);
        stops.dedup_by(|later, sooner| *later - *sooner < 1e-12);
        let mut run = FoundationRun::default();
        let mut state: State = [tilt, 0.0, 0.0, 0.0];
        state[1] = self.sunk(&state);
        let mut stood = self.mode(&state, self.ground(0.0, 1e-9)).presses == [true; 2];
        let (mut time, mut sample, mut rocked, mut changes) = (0.0, 0, tilt != 0.0, 0_u32);
        for stop in stops {
            while time < stop {
                let within = (time + stop) / 2.0;
                let mode = self.mode(&state, self.ground(time, within));
                let stands = mode.presses == [true; 2];
                rocked |= stood && !stands;
                run.impacts += usize::from(stands && !stood);
                stood = stands;
                let count = ((stop - time) / longest).ceil();
                let mut h = if count <= 1.0 { stop - time } else { (stop - time) / count };
                let changed = |h: f64| {
                    let next = self.step(&state, mode, time, h, within);
                    self.mode(&next, self.ground(time + h, within)) != mode
                };
                if changed(h) {
                    let mut low = 0.0;
                    for _ in 0..60 {
                        let middle = (low + h) / 2.0;
                        *(if changed(middle) { &mut h } else { &mut low }) = middle;
                    }
                    changes += 1;
                    if changes > 1_000_000 {
                        return Err(format!("changes without end at {time} s"));
                    }
                }
                state = self.step(&state, mode, time, h, within);
                time = if time + h >= stop - 1e-15 { stop } else { time + h };
                if state[0].abs() >= std::f64::consts::FRAC_PI_2 {
                    run.outcome = if run.impacts > 0 { "overturned-after-impact" } else { "overturned-without-impact" };
                    return Ok(run);
                }
            }
            if (time - f64::from(sample) * interval).abs() < 1e-9 {
                run.samples.push([time, state[0]]);
                sample += 1;
            }
        }
        run.outcome = if rocked { "safe" } else { "no-rocking" };
        Ok(run)
    }

    /// Height at which the feet bear the weight of the tilted block, by bisection.
    fn sunk(&self, state: &State) -> f64 {
        let up = self.ground(0.0, 1e-9)[1];
        let bears = |height: f64| -> f64 {
            (0..2).map(|corner| self.stiffness * self.foot(corner, &[state[0], height, 0.0, 0.0]).0.max(0.0)).sum()
        };
        let (mut low, mut high) = (-self.height, self.height);
        for _ in 0..200 {
            let middle = (low + high) / 2.0;
            *(if bears(middle) > GRAVITY + up { &mut low } else { &mut high }) = middle;
        }
        high
    }
}
