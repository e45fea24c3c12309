//! What the core costs on the target, kernel by kernel, in instructions of the emulator.
//!
//! Every kernel is a function of its own that is not inlined, with inputs and outputs in memory, so that a count includes
//! the call and can be compared with a call from anywhere.

mod accuracy;
mod controller;
mod devices;

use core::{fmt, hint::black_box};
use sprag_shared::{
    equation::{
        Equation, FullBlock, FullInerter, SlenderBlock, any_equation::AnyEquation, body::FullBody, clutch_rule::ClutchRule,
        lever::CentreOfMass, switched::Switched,
    },
    ground::Harmonics,
    math::{scalar::Real, sine32},
    method::{
        dense_output::Integrator,
        fixed::{FixedStep, Scheme, runge_kutta_4},
        taylor::Taylor,
    },
    motion::{
        ideal::IdealSystem,
        observer::{Event, MonotoneInterval, Observer},
        state::{BlockState, Limits, Stopped},
        step_end::{TimeStepping, TimeSteppingState},
    },
};

type Inerter = FullInerter<f32, CentreOfMass>;

/// A block and its inerter, in time stepping.
type WithInerter<S> = TimeStepping<S, FullInerter<S, CentreOfMass>>;

/// p² of a rectangle with R = 2 m, 1/s².
const FREQUENCY_SQUARED: f32 = 3.677_493_7;
/// α = 10°, rad.
const SLENDERNESS: f32 = 0.174_532_93;
/// k = σ/λ with σ = 0.5.
const COUPLING: f32 = 0.375;
/// tan α.
const UPLIFT: f32 = 0.176_326_98;
/// η.
const RESTITUTION: f32 = 0.85;
/// A step, s.
const STEP: f32 = 0.005;

const BLOCK: FullBlock<f32> = FullBlock { frequency_squared: FREQUENCY_SQUARED, slenderness: SLENDERNESS };

const fn inerter(coupling: f32) -> Inerter {
    FullInerter { body: FullBody { block: BLOCK, lever: CentreOfMass, consistent: false, vertical: false }, coupling }
}

const fn slender(inertia: f32) -> SlenderBlock<f32> {
    let frequency_squared = FREQUENCY_SQUARED / inertia;
    SlenderBlock { frequency_squared, slenderness: SLENDERNESS, inertia, lever: 1.0 }
}

const fn stepped<E>(released: E, engaged: E, uplift: f32) -> TimeStepping<f32, E> {
    TimeStepping { released, engaged, restitution: RESTITUTION, uplift }
}

/// ü_g/g at the start, the middle and the end of a step, and its length (s).
struct Step<S> {
    ground: [S; 3],
    length: S,
}

/// With kinematics that the compiler knows, as [`AnyEquation::known`](sprag_shared::equation::any_equation::AnyEquation::known) hands a block
/// to its steps.
#[inline(always)]
fn paper<S: Real>(block: &WithInerter<S>) -> WithInerter<S> {
    let [released, engaged] = [block.released, block.engaged].map(|equation| equation.with_kinematics(false));
    TimeStepping { released, engaged, ..*block }
}

/// Clutch by the signs at the start, four evaluations, impact by the sign at the end.
#[inline(never)]
fn detected<S: Real, E: Switched<S>>(block: &TimeStepping<S, E>, state: &mut TimeSteppingState<S>, step: &Step<S>) {
    *state = block.runge_kutta_4(*state, step.ground, step.length);
}

#[inline(never)]
fn detected_euler<S: Real, E: Switched<S>>(block: &TimeStepping<S, E>, state: &mut TimeSteppingState<S>, step: &Step<S>) {
    *state = block.semi_implicit_euler(*state, step.ground[0], step.length);
}

#[inline(never)]
fn detected_inerter<S: Real>(block: &WithInerter<S>, state: &mut TimeSteppingState<S>, step: &Step<S>) {
    *state = paper(block).runge_kutta_4(*state, step.ground, step.length);
}

#[inline(never)]
fn detected_inerter_euler<S: Real>(block: &WithInerter<S>, state: &mut TimeSteppingState<S>, step: &Step<S>) {
    *state = paper(block).semi_implicit_euler(*state, step.ground[0], step.length);
}

/// Four evaluations and nothing else.
#[inline(never)]
fn smooth<E: Equation<f32>>(equation: &E, state: &mut TimeSteppingState<f32>, step: &Step<f32>) {
    evaluate(equation, state, step);
}

#[inline(always)]
fn evaluate<E: Equation<f32>>(equation: &E, state: &mut TimeSteppingState<f32>, step: &Step<f32>) {
    let TimeSteppingState { rotation, velocity, side } = *state;
    let first = equation.acceleration(side, rotation, velocity, step.ground[0]);
    (state.rotation, state.velocity) = runge_kutta_4(equation, side, (rotation, velocity), first, step.ground, step.length);
}

/// The same with an inerter.
#[inline(never)]
fn smooth_full(equation: &Inerter, state: &mut TimeSteppingState<f32>, step: &Step<f32>) {
    evaluate(&equation.with_kinematics(false), state, step);
}

#[inline(never)]
fn sine(x: &f32, result: &mut (f32, f32)) {
    *result = sine32::sin_cos(*x);
}

#[inline(never)]
fn sine_of_phase(x: &f32, result: &mut (f32, f32)) {
    *result = sine32::sin_cos_of_phase(*x);
}

/// What [`sine32`] replaces: in double precision inside, which this core does in software.
#[inline(never)]
fn libm_sine(x: &f32, result: &mut (f32, f32)) {
    *result = (libm::sinf(*x), libm::cosf(*x));
}

/// Counts the steps and events of a passage.
#[derive(Default)]
struct Tally {
    steps: u32,
    events: u32,
}

impl Observer<f32> for Tally {
    fn interval(&mut self, _output: &dyn sprag_shared::method::dense_output::DenseOutput<f32>, interval: &MonotoneInterval<f32>) {
        self.steps += u32::from(interval.from == 0.0);
    }

    fn event(&mut self, _event: Event, _time: f32, _state: &BlockState<f32>) {
        self.events += 1;
    }
}

/// One cycle of a sine pulse and every event in it, located.
#[inline(never)]
fn passage<M: Integrator<f32>>(
    system: &IdealSystem<f32>,
    method: &M,
    pulse: &Harmonics<f32, 1>,
    tally: &mut Tally,
) -> Result<(), Stopped> {
    let limits = Limits { overturned: core::f32::consts::FRAC_PI_2, events: 10_000 };
    system.advance(method, &mut BlockState::default(), pulse, 1.0, &limits, tally)
}

/// What `work` costs.
fn count(counter: &mut impl FnMut() -> u32, work: impl FnOnce()) -> u32 {
    let before = counter();
    work();
    counter().wrapping_sub(before)
}

/// Prints `kernel NAME INSTRUCTIONS` a line; all zeros on the host.
///
/// # Errors
/// If `out` refuses a line.
pub fn report(counter: &mut impl FnMut() -> u32, out: &mut impl fmt::Write) -> fmt::Result {
    let state = black_box(TimeSteppingState { rotation: 0.08, velocity: 0.21, side: 1.0 });
    let step = black_box(Step { ground: [-0.31, -0.32, -0.33], length: STEP });
    let full = black_box(stepped(inerter(0.0), inerter(COUPLING), UPLIFT));
    let slender = black_box(stepped(slender(1.0), slender(1.0 + COUPLING), SLENDERNESS));

    let mut line = |name: &str, instructions: u32| writeln!(out, "kernel {name} {instructions}");
    line("nothing", count(counter, || ()))?;
    let mut end = state;
    line("rk4-full-clutched-pair", count(counter, || detected_inerter(&full, &mut end, &step)))?;
    black_box(end);
    end = state;
    line("rk4-full-engaged-only", count(counter, || smooth_full(&full.engaged, &mut end, &step)))?;
    black_box(end);
    end = state;
    line("rk4-full-no-inerter", count(counter, || smooth(&full.released.body.block, &mut end, &step)))?;
    black_box(end);
    end = state;
    line("rk4-slender-clutched-pair", count(counter, || detected(&slender, &mut end, &step)))?;
    black_box(end);
    end = state;
    line("rk4-slender-engaged-only", count(counter, || smooth(&slender.engaged, &mut end, &step)))?;
    black_box(end);
    end = state;
    line("euler-full-clutched-pair", count(counter, || detected_inerter_euler(&full, &mut end, &step)))?;
    black_box(end);

    let x = black_box(0.7_f32);
    let mut result = (0.0, 0.0);
    line("sine32-sin-cos", count(counter, || sine(&x, &mut result)))?;
    black_box(result);
    line("sine32-sin-cos-of-phase", count(counter, || sine_of_phase(&x, &mut result)))?;
    black_box(result);
    line("libm-sinf-and-cosf", count(counter, || libm_sine(&x, &mut result)))?;
    black_box(result);

    let pair = black_box(IdealSystem {
        released: AnyEquation::Block(BLOCK),
        engaged: AnyEquation::Centre(inerter(COUPLING)),
        restitution: RESTITUTION,
        uplift: UPLIFT,
        slenderness: SLENDERNESS,
        rest_speed: 3e-7,
        counted_speed: 3e-7,
        clutch: ClutchRule::Resisting,
    });
    let pulse = black_box(Harmonics::sine(0.5, core::f32::consts::TAU));
    located("located-euler-step", &FixedStep { scheme: Scheme::SemiImplicitEuler, step: STEP }, (&pair, &pulse), counter, out)?;
    located("located-rk4-step", &FixedStep { scheme: Scheme::RungeKutta4, step: STEP }, (&pair, &pulse), counter, out)?;
    located("located-taylor12-step", &Taylor::<f32, 12>::fixed(10.0 * STEP), (&pair, &pulse), counter, out)?;
    accuracy::report(counter, out)?;
    devices::report(counter, out)?;
    controller::report(counter, out)
}

/// The mean cost of a step of an ideal pair with its events located, over one pulse.
fn located<M: Integrator<f32>>(
    name: &str,
    method: &M,
    (pair, pulse): (&IdealSystem<f32>, &Harmonics<f32, 1>),
    counter: &mut impl FnMut() -> u32,
    out: &mut impl fmt::Write,
) -> fmt::Result {
    mean(name, |tally| passage(pair, method, pulse, tally), counter, out)
}

/// Prints what a step costs on the average of what `pass` tallies.
fn mean(
    name: &str,
    pass: impl FnOnce(&mut Tally) -> Result<(), Stopped>,
    counter: &mut impl FnMut() -> u32,
    out: &mut impl fmt::Write,
) -> fmt::Result {
    let mut tally = Tally::default();
    let mut done = Ok(());
    let instructions = count(counter, || done = pass(&mut tally));
    match done {
        Ok(()) => {
            let mean = instructions.checked_div(tally.steps).unwrap_or(0);
            writeln!(out, "kernel {name} {mean} ({} steps, {} events)", tally.steps, tally.events)
        }
        Err(stopped) => writeln!(out, "kernel {name} stopped: {stopped}"),
    }
}
