//! How fast the controller runs in closed loop: times real time a core, one by one and with two threads.
//!
//! `cargo bench --bench loops` closes the loop of `scenes/controller.toml` (2 kHz, 4 substeps, ADIS16470) with a specimen of the sensors
//! after the other, and prints for each part of a loop the ticks, times real time, nanoseconds a tick, and a tick's time over that of one
//! Runge-Kutta step of a block alone ([`yardstick`]), measured in the same run. Parts are timed by what the thread had of the processor, where
//! the system tells it (Linux), for others may be at work; the last rows, by the clock on the wall.

use std::hint::black_box;
use std::path::Path;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use sprag_shared::equation::FullBlock;
use sprag_shared::equation::FullInerter;
use sprag_shared::equation::body::FullBody;
use sprag_shared::equation::lever::CentreOfMass;
use sprag_shared::motion::state::Phase;
use sprag_shared::motion::step_end::{TimeStepping, TimeSteppingState};
use sprag_sim::closed_loop::LoopScene;
use sprag_sim::closed_loop::plant::Extremes;
use sprag_sim::closed_loop::run::{Tick, TickObserver};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;

/// Specimens of the sensors.
const SPECIMENS: u64 = 16;
/// Measurements, of which the fastest counts.
const REPETITIONS: u32 = 3;

/// A part of a loop.
#[derive(Clone, Copy, Default)]
struct Part {
    ticks: u64,
    time: Duration,
}

impl Part {
    fn add(&mut self, other: Part) {
        self.ticks += other.ticks;
        self.time += other.time;
    }

    fn row(&self, name: &str, period: f64, yardstick: f64) {
        let seconds = self.time.as_secs_f64();
        let tick = seconds / self.ticks as f64;
        let (times, step) = (self.ticks as f64 * period / seconds, tick / yardstick);
        println!("{name:<28} {:>10} {times:>12.0} {:>12.0} {step:>12.1}", self.ticks, 1e9 * tick);
    }
}

/// Processor time of this thread so far; elsewhere than on Linux, since `start`.
fn processor_time(start: Instant) -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split_whitespace().next().and_then(|first| first.parse().ok());
    nanoseconds.map_or_else(|| start.elapsed(), Duration::from_nanos)
}

/// Notes when a block begins to rock or to stand, and nothing else: a look at the clock takes as long as a part of a tick.
struct Stopwatch {
    start: Instant,
    since: Duration,
    rocks: bool,
    ticks: u64,
    stillness: Duration,
    standing: Part,
    rocking: Part,
}

impl Stopwatch {
    fn start() -> Stopwatch {
        let (standing, rocking) = (Part::default(), Part::default());
        let start = Instant::now();
        Stopwatch { start, since: processor_time(start), rocks: false, ticks: 0, stillness: Duration::ZERO, standing, rocking }
    }

    fn lap(&mut self) -> Duration {
        let now = processor_time(self.start);
        now.saturating_sub(std::mem::replace(&mut self.since, now))
    }

    fn note(&mut self) {
        let part = Part { ticks: std::mem::take(&mut self.ticks), time: self.lap() };
        if self.rocks {
            self.rocking.add(part);
        } else {
            self.standing.add(part);
        }
    }
}

impl TickObserver for Stopwatch {
    fn tick(&mut self, tick: &Tick) {
        let rocks = tick.plant.motion.phase == Phase::Rocking;
        if tick.plant.time == 0.0 {
            self.stillness = self.lap();
        } else if rocks != self.rocks {
            self.note();
        }
        self.rocks = rocks;
        self.ticks += 1;
    }
}

/// Time of one Runge-Kutta step of the exact block with a clutched pair, s.
fn yardstick() -> f64 {
    const STEPS: u32 = 20_000;
    let block = FullBlock { frequency_squared: 1.0, slenderness: 0.174_532_925 };
    let with = |coupling: f64| FullInerter {
        body: FullBody { block, lever: CentreOfMass, consistent: false, vertical: false },
        coupling,
    };
    let pair = black_box(TimeStepping { released: with(0.0), engaged: with(0.375), restitution: 0.85, uplift: 0.176_327 });
    let one = || {
        let mut state = TimeSteppingState::at_rest();
        let start = Instant::now();
        for step in 0..STEPS {
            let push = if step / 300 % 2 == 0 { 0.3 } else { -0.3 };
            state = pair.runge_kutta_4(state, [push; 3], 0.01);
        }
        black_box(state);
        start.elapsed().as_secs_f64() / f64::from(STEPS)
    };
    (0..50).map(|_| one()).fold(f64::INFINITY, f64::min)
}

fn main() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/controller.toml");
    let scene = Scene::load(&path, &[]).expect("the scene that ships");
    let desk = LoopScene::new(scene).expect("a scene with a pair");
    let interrupt = Interrupt::default();
    let (index, clock) = (desk.pairs[0], desk.task(desk.pairs[0], 1, &interrupt).clock());
    let still = (clock.prelude / clock.period).round() as u64;
    let watched = |seed: u64| {
        let mut watch = Stopwatch::start();
        let ended = desk.task(index, seed, &interrupt).run(&mut Extremes::default(), &mut watch);
        black_box(ended.expect("a loop"));
        watch.note();
        watch
    };
    let step = yardstick();
    println!("{:<28} {:>10} {:>12} {:>12} {:>12}", "a core, one by one", "ticks", "times real", "ns a tick", "RK4 steps");
    let mut best: Option<[Part; 4]> = None;
    for _ in 0..REPETITIONS {
        let mut parts = [Part::default(); 4];
        for seed in 1..=SPECIMENS {
            let watch = watched(seed);
            let found = [Part { ticks: still, time: watch.stillness }, watch.standing, watch.rocking];
            for (number, part) in found.into_iter().enumerate() {
                parts[number].add(part);
                parts[3].add(part);
            }
        }
        if best.is_none_or(|best| parts[3].time < best[3].time) {
            best = Some(parts);
        }
    }
    let parts = best.unwrap_or_default();
    for (name, part) in ["stillness before", "shaken, at rest", "rocking", "whole"].into_iter().zip(&parts) {
        part.row(name, clock.period, step);
    }
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let all = || {
            let start = Instant::now();
            (1..=4 * SPECIMENS).into_par_iter().for_each(|seed| {
                let ended = desk.task(index, seed, &interrupt).run(&mut Extremes::default(), &mut ());
                black_box(ended.expect("a loop"));
            });
            start.elapsed().as_secs_f64()
        };
        pool.install(|| (0..REPETITIONS).map(|_| all()).fold(f64::INFINITY, f64::min))
    };
    let ticks = parts[3].ticks / SPECIMENS * 4 * SPECIMENS;
    let (one, two) = (run(1), run(2));
    println!("{:<28} {ticks:>10} {:>12.0}", "one thread", ticks as f64 * clock.period / one);
    println!("{:<28} {ticks:>10} {:>12.0} {:>12} {:>11.2}x", "two threads", ticks as f64 * clock.period / two, "", one / two);
}
