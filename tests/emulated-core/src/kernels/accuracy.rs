//! What a step costs by method, by how events are found, by precision, tier of the sine, geometry and device: the prices of
//! accuracy on the target. Names are `step-METHOD-EVENTS-PRECISION-TIER-GEOMETRY-DEVICE`.
//!
//! - `step-end`: one step of [`sprag_shared::motion::step_end`], whose inputs, the ground among them, are in memory. Without a branch, so that one
//!   step is all steps; only libm's sine takes its time by its argument. A single inerter costs what a pair costs.
//! - `located`: the mean over a second that contains an uplift, turns, an impact and switches, all located, under ground motion that
//!   is a straight line, as between two samples of a record. In single precision and with its own sine only: these are the loops of
//!   the cases ([`sprag_case`]), and flash holds no other set. Setting up is not counted.
//!
//! Taylor steps are ten times as long as the others. A tier is no part of the slender model, so there its cost is the same for all.

use super::{RESTITUTION, STEP, Step, Tally, count, detected, detected_euler, detected_inerter, detected_inerter_euler, mean};
use crate::watcher::Watcher;
use core::{f64::consts::FRAC_PI_2, fmt, hint::black_box};
use sprag_case::{Case, CaseError, FixedMethod, Ground, GroundPiece, Initially, Shape};
use sprag_shared::{
    equation::{
        FullBlock, FullInerter, SlenderBlock, any_equation::AnyEquation, body::FullBody, clutch_rule::ClutchRule,
        lever::CentreOfMass, switched::Switched,
    },
    ground::Linear,
    math::{
        scalar::Real,
        tier::{Libm, Micromath, OwnPolynomial},
        tiered::Tiered,
    },
    method::{closed_form::ClosedForm, dense_output::DenseOutput},
    motion::{
        ideal::IdealSystem,
        observer::{Event, MonotoneInterval, Observer},
        state::{BlockState, Limits, Stopped},
        step_end::{TimeStepping, TimeSteppingState},
    },
    observers::peaks::Peaks,
    structure::{
        Base, REST_SPEED, Restitution, RestitutionScatter, Structure,
        added_mass::AddedMass,
        block::{Block, Geometry, RECTANGLE_INERTIA_RATIO},
        device::{Device, DeviceKind},
        drivetrain::Drivetrain,
    },
};

/// The ground motion of a located step, in g: a line down from a start that uplifts the block at once.
const LINE: Linear<f32> = Linear { start: 0.5, slope: -1.0 };

/// Its duration, s: the ground comes to push the other way as hard.
const DURATION: f32 = 1.0;

fn full<S: Real>() -> FullBlock<S> {
    FullBlock { frequency_squared: S::of(super::FREQUENCY_SQUARED.into()), slenderness: S::of(super::SLENDERNESS.into()) }
}

fn inerter<S: Real>(coupling: f32) -> FullInerter<S, CentreOfMass> {
    FullInerter {
        body: FullBody { block: full(), lever: CentreOfMass, consistent: false, vertical: false },
        coupling: S::of(coupling.into()),
    }
}

fn slender<S: Real>(inertia: f32) -> SlenderBlock<S> {
    SlenderBlock {
        frequency_squared: S::of((super::FREQUENCY_SQUARED / inertia).into()),
        slenderness: S::of(super::SLENDERNESS.into()),
        inertia: S::of(inertia.into()),
        lever: S::ONE,
    }
}

/// One step of `method` whose events are seen at its end.
fn step_end<S: Real, E: Switched<S>>(
    method: fn(&TimeStepping<S, E>, &mut TimeSteppingState<S>, &Step<S>),
    (released, engaged): (E, E),
    counter: &mut impl FnMut() -> u32,
) -> u32 {
    let [restitution, uplift] = [RESTITUTION, super::UPLIFT].map(|x| S::of(x.into()));
    let block = black_box(TimeStepping { released, engaged, restitution, uplift });
    let step = black_box(Step { ground: [-0.31, -0.32, -0.33].map(S::of), length: S::of(STEP.into()) });
    let mut state = black_box(TimeSteppingState { rotation: S::of(0.08), velocity: S::of(0.21), side: S::ONE });
    let instructions = count(counter, || method(&block, &mut state, &step));
    black_box(state);
    instructions
}

/// A case of the core, followed for `duration` (s): its steps, and the instructions of all.
fn run(
    (method, geometry, kind): (FixedMethod, Geometry, DeviceKind),
    duration: f32,
    counter: &mut impl FnMut() -> u32,
) -> Result<(u32, u32), CaseError> {
    let case = black_box(Case {
        structure: Structure {
            block: Block::new(2.0, f64::from(super::SLENDERNESS), RECTANGLE_INERTIA_RATIO)?,
            geometry,
            device: Device { kind, mass_ratio: 0.5, ..Device::NONE },
            added_mass: AddedMass::NONE,
            restitution: Restitution::Constant(RESTITUTION.into()),
            restitution_scatter: RestitutionScatter::NONE,
            base: Base::Rigid,
            rest_speed: REST_SPEED,
        },
        drivetrain: Drivetrain::default(),
        initially: Initially::Rest,
        method,
        step: if method == FixedMethod::Taylor { 10.0 * STEP } else { STEP },
        ground: Ground::pieces(&[GroundPiece { shape: Shape::Linear(LINE), duration }])?,
        free_time: 0.0,
    });
    let mut end = None;
    let instructions = count(counter, || end = Some(case.run(&mut Watcher::default())));
    end.unwrap_or(Err(CaseError::TooManySteps)).map(|end| (end.steps, instructions))
}

/// The mean of a step of a case, less what setting it up takes.
fn located(
    case: (FixedMethod, Geometry, DeviceKind),
    counter: &mut impl FnMut() -> u32,
    out: &mut impl fmt::Write,
    name: fmt::Arguments<'_>,
) -> fmt::Result {
    let both = run(case, DURATION, counter).and_then(|whole| Ok((whole, run(case, 0.0, counter)?)));
    match both {
        Ok(((steps, instructions), (_, setting_up))) => {
            let mean = instructions.wrapping_sub(setting_up).checked_div(steps).unwrap_or(0);
            writeln!(out, "kernel {name} {mean} ({steps} steps)")
        }
        Err(error) => writeln!(out, "kernel {name} failed: {error}"),
    }
}

/// A slender block by the closed form, under the same motion.
#[inline(never)]
fn closed_form(
    ([released, engaged], clutch): ([AnyEquation<f32>; 2], ClutchRule),
    method: &ClosedForm<f32>,
    tally: &mut Tally,
) -> Result<(), Stopped> {
    let system = IdealSystem {
        released,
        engaged,
        restitution: RESTITUTION,
        uplift: super::SLENDERNESS,
        slenderness: super::SLENDERNESS,
        rest_speed: 3e-7,
        counted_speed: 3e-7,
        clutch,
    };
    let limits = Limits { overturned: FRAC_PI_2 as f32, events: 10_000 };
    let mut watch = Watch { peaks: Peaks::default(), tally };
    system.advance(method, &mut BlockState::default(), &black_box(LINE), DURATION, &limits, &mut watch)
}

/// Peaks and a tally.
struct Watch<'t> {
    peaks: Peaks<f32>,
    tally: &'t mut Tally,
}

impl Observer<f32> for Watch<'_> {
    fn interval(&mut self, output: &dyn DenseOutput<f32>, interval: &MonotoneInterval<f32>) {
        self.peaks.interval(output, interval);
        self.tally.interval(output, interval);
    }

    fn event(&mut self, event: Event, time: f32, state: &BlockState<f32>) {
        self.peaks.event(event, time, state);
        self.tally.event(event, time, state);
    }
}

/// Prints a line for every combination that shows something; all zeros on the host.
///
/// # Errors
/// If `out` refuses a line.
pub fn report(counter: &mut impl FnMut() -> u32, out: &mut impl fmt::Write) -> fmt::Result {
    macro_rules! step_end {
        ($precision:literal, $number:ty, $tier:literal: $($method:ident $label:literal $device:literal $geometry:literal $blocks:expr),* $(,)?) => {
            $(
                let instructions = step_end::<$number, _>($method, $blocks, counter);
                writeln!(out, concat!("kernel step-", $label, "-step-end-", $precision, "-", $tier, "-", $geometry, "-", $device, " {}"), instructions)?;
            )*
        };
    }
    macro_rules! full_and_slender {
        ($precision:literal, $number:ty, $tier:literal) => {
            step_end!($precision, $number, $tier:
                detected_euler "euler" "none" "full" (full(), full()),
                detected_inerter_euler "euler" "clutched-pair" "full" (inerter(0.0), inerter(super::COUPLING)),
                detected "rk4" "none" "full" (full(), full()),
                detected_inerter "rk4" "clutched-pair" "full" (inerter(0.0), inerter(super::COUPLING)),
                detected "rk4" "clutched-pair" "slender" (slender(1.0), slender(1.0 + super::COUPLING)),
            );
        };
    }
    full_and_slender!("f32", Tiered<f32, OwnPolynomial>, "own-polynomial");
    full_and_slender!("f32", Tiered<f32, Libm>, "libm");
    full_and_slender!("f32", Tiered<f32, Micromath>, "micromath");
    full_and_slender!("f64", Tiered<f64, OwnPolynomial>, "own-polynomial");
    full_and_slender!("f64", Tiered<f64, Libm>, "libm");
    step_end!("f32", Tiered<f32, OwnPolynomial>, "own-polynomial":
        detected_euler "euler" "none" "slender" (slender(1.0), slender(1.0)),
        detected_euler "euler" "clutched-pair" "slender" (slender(1.0), slender(1.0 + super::COUPLING)),
        detected "rk4" "none" "slender" (slender(1.0), slender(1.0)),
    );

    const METHODS: [(FixedMethod, &str); 3] =
        [(FixedMethod::SemiImplicitEuler, "euler"), (FixedMethod::RungeKutta4, "rk4"), (FixedMethod::Taylor, "taylor12")];
    const DEVICES: [(DeviceKind, &str); 3] =
        [(DeviceKind::None, "none"), (DeviceKind::Inerter, "inerter"), (DeviceKind::ClutchedPair, "clutched-pair")];
    for (geometry, shape) in [(Geometry::Full, "full"), (Geometry::Slender, "slender")] {
        for (method, label) in METHODS {
            for (kind, device) in DEVICES {
                let name = format_args!("step-{label}-located-f32-own-polynomial-{shape}-{device}");
                located((method, geometry, kind), counter, out, name)?;
            }
        }
    }
    let step = black_box(ClosedForm { step: STEP });
    let alone = black_box([slender(1.0); 2].map(AnyEquation::Slender));
    let pair = black_box([slender(1.0), slender(1.0 + super::COUPLING)].map(AnyEquation::Slender));
    mean(
        "step-closed-form-located-f32-own-polynomial-slender-none",
        |tally| closed_form((alone, ClutchRule::Without), &step, tally),
        counter,
        out,
    )?;
    mean(
        "step-closed-form-located-f32-own-polynomial-slender-clutched-pair",
        |tally| closed_form((pair, ClutchRule::Resisting), &step, tally),
        counter,
        out,
    )
}
