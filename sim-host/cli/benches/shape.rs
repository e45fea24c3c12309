//! What it costs to write the equations once: the Runge-Kutta step of the full model with a clutched pair (Eq. 10 by signs
//! and the impact included) over plain numbers and over SIMD lanes, and the ways of being generic that were not taken.
//!
//! `cargo bench --bench shape` prints nanoseconds, which are noise on a shared machine, and ratios to the first row,
//! which are not. The instructions of the same step on the target: `cargo run --release -p sprag-emulated-core --target
//! thumbv7em-none-eabihf`.

use std::hint::black_box;
use std::time::Instant;

use sprag_shared::equation::body::FullBody;
use sprag_shared::equation::lever::{CentreOfMass, Lever, TyingPoint};
use sprag_shared::equation::{FullBlock, FullInerter};
use sprag_shared::math::lanes::Lanes;
use sprag_shared::math::scalar::Scalar;
use sprag_shared::motion::step_end::{TimeStepping, TimeSteppingState};

mod alternatives;

use alternatives::{AnyMount, Quad, step_by_pointer};

type Pair<S, L> = TimeStepping<S, FullInerter<S, L>>;

/// Steps in one measurement: short enough to fall between two other programs' turns.
const STEPS: usize = 1 << 11;
/// Measurements, of which the fastest counts.
const REPETITIONS: usize = 600;
/// A step, in 1/p.
const STEP: f64 = 0.01;

/// α = 10°, σ = 0.5, η = 0.85, p = 1.
fn pair<S: Scalar, L: Lever<S>>(lever: L) -> Pair<S, L> {
    let block = FullBlock { frequency_squared: S::of(1.0), slenderness: S::of(0.174_532_925) };
    let with = |coupling: f64| FullInerter {
        body: FullBody { block, lever, consistent: false, vertical: false },
        coupling: S::of(coupling),
    };
    TimeStepping { released: with(0.0), engaged: with(0.375), restitution: S::of(0.85), uplift: S::of(0.176_327) }
}

/// ü_g/g of a few cycles, again and again: it keeps the block rocking and does not overturn it.
fn ground() -> Vec<f64> {
    (0..1025).map(|k| 0.4 * sprag_shared::math::sin(std::f64::consts::TAU * f64::from(k) / 128.0)).collect()
}

/// Steps `states` side by side, each a chain of its own; `scale` gives each another amplitude.
#[inline(always)]
fn chains<S: Scalar, const CHAINS: usize>(
    states: &mut [TimeSteppingState<S>; CHAINS],
    scales: &[S; CHAINS],
    ground: &[f64],
    step: impl Fn(TimeSteppingState<S>, [S; 3]) -> TimeSteppingState<S>,
) {
    for tick in 0..STEPS {
        let window = &ground[2 * (tick & 511)..][..3];
        for (state, &scale) in states.iter_mut().zip(scales) {
            *state = step(*state, [S::of(window[0]) * scale, S::of(window[1]) * scale, S::of(window[2]) * scale]);
        }
    }
}

/// Fastest time of `work`, in ns by step of one block, where `work` takes `blocks` of them through [`STEPS`] steps.
fn nanoseconds(blocks: usize, mut work: impl FnMut()) -> f64 {
    let one = |work: &mut dyn FnMut()| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64() * 1e9 / (STEPS * blocks) as f64
    };
    (0..REPETITIONS).map(|_| one(&mut work)).fold(f64::INFINITY, f64::min)
}

/// `CHAINS` chains of plain numbers or of lanes.
#[inline(never)]
fn generic<S: Scalar, L: Lever<S>, const CHAINS: usize>(
    block: &Pair<S, L>,
    states: &mut [TimeSteppingState<S>; CHAINS],
    scales: &[S; CHAINS],
    ground: &[f64],
) {
    chains(states, scales, ground, |state, push| block.runge_kutta_4(state, push, S::of(STEP)));
}

/// The same source, compiled for a machine with AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn generic_avx2<S: Scalar, L: Lever<S>, const CHAINS: usize>(
    block: &Pair<S, L>,
    states: &mut [TimeSteppingState<S>; CHAINS],
    scales: &[S; CHAINS],
    ground: &[f64],
) {
    chains(states, scales, ground, |state, push| block.runge_kutta_4(state, push, S::of(STEP)));
}

/// Time of one block's step in `CHAINS` chains of `S`, `width` blocks each.
fn measure<S: Scalar, const CHAINS: usize>(width: usize, avx2: bool, scale: impl Fn(usize) -> S) -> f64 {
    let (block, ground) = (black_box(pair::<S, _>(CentreOfMass)), black_box(ground()));
    let scales = std::array::from_fn(scale);
    let mut states = [TimeSteppingState::at_rest(); CHAINS];
    let time = nanoseconds(width * CHAINS, || {
        #[cfg(target_arch = "x86_64")]
        if avx2 {
            // SAFETY: asked for only where `main` has found AVX2.
            unsafe { generic_avx2(&block, &mut states, &scales, &ground) };
            return;
        }
        let _ = avx2;
        generic(&block, &mut states, &scales, &ground);
    });
    black_box(states);
    time
}

/// Lanes with amplitudes of their own.
fn spread<const N: usize>(chain: usize) -> Lanes<f64, N> {
    Lanes(std::array::from_fn(|lane| 1.0 - 0.02 * (chain * N + lane) as f64))
}

fn single(chain: usize) -> f64 {
    1.0 - 0.02 * chain as f64
}

/// Prints a row and gives its time.
fn row(name: &str, time: f64, base: f64) {
    println!("{name:<58} {time:>8.2} {:>8.2}", base / time);
}

fn main() {
    println!("{:<58} {:>8} {:>8}", "RK4 step, full model, clutched pair; one block's", "ns", "times");
    let base = measure::<f64, 1>(1, false, single);
    row("f64, one dependent chain", base, base);
    row("f64, four chains", measure::<f64, 4>(1, false, single), base);
    row("f32, one dependent chain", measure::<f32, 1>(1, false, |k| single(k) as f32), base);
    row("f32, four chains", measure::<f32, 4>(1, false, |k| single(k) as f32), base);
    row("Lanes<f64, 1>, one chain (the lanes' sine alone)", measure::<Lanes<f64, 1>, 1>(1, false, spread), base);
    lanes("as built", false, base);
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        lanes("AVX2", true, base);
    } else {
        println!("this machine has no AVX2");
    }

    println!("ways not taken:");
    row("wide::f64x4 for the number, one chain", measure::<Quad, 1>(4, false, Quad::spread), base);
    row("wide::f64x4 for the number, four chains", measure::<Quad, 4>(4, false, Quad::spread), base);
    let ground = black_box(ground());
    let mut states = [TimeSteppingState::at_rest(); 1];
    let mounts = [AnyMount::CentreOfMass(CentreOfMass), AnyMount::TyingPoint(TyingPoint { along: 1.0, across: 0.0 })];
    let any = pair::<f64, _>(mounts[black_box(0)]);
    row("f64, mount chosen by `match` at every look", nanoseconds(1, || generic(&any, &mut states, &[1.0], &ground)), base);
    let mut states = [TimeSteppingState::at_rest(); 1];
    let point = black_box(pair::<f64, _>(TyingPoint { along: 1.0, across: 0.0 }));
    row("f64, one general mount for all", nanoseconds(1, || generic(&point, &mut states, &[1.0], &ground)), base);
    let mut states = [TimeSteppingState::at_rest(); 1];
    let block = black_box(pair::<f64, _>(CentreOfMass));
    let released = block.released;
    let pointer = black_box(&released as &dyn alternatives::Acceleration);
    let by_pointer = nanoseconds(1, || {
        chains(&mut states, &[1.0], &ground, |state, push| step_by_pointer(pointer, &block, state, push, STEP));
    });
    row("f64, equation behind a `dyn` pointer", by_pointer, base);
}

fn lanes(built: &str, avx2: bool, base: f64) {
    row(&format!("Lanes<f64, 4>, {built}"), measure::<Lanes<f64, 4>, 1>(4, avx2, spread), base);
    row(&format!("Lanes<f64, 8>, {built}"), measure::<Lanes<f64, 8>, 1>(8, avx2, spread), base);
    row(&format!("Lanes<f64, 16>, {built}"), measure::<Lanes<f64, 16>, 1>(16, avx2, spread), base);
    row(&format!("Lanes<f64, 4>, {built}, four chains"), measure::<Lanes<f64, 4>, 4>(4, avx2, spread), base);
    row(&format!("Lanes<f64, 8>, {built}, two chains"), measure::<Lanes<f64, 8>, 2>(8, avx2, spread), base);
}
