//! The two precisions that every case runs in.

use sprag_shared::math::scalar::Real;
use sprag_shared::method::dense_output::Integrator;
use sprag_shared::method::fixed::{FixedStep, Scheme};
use sprag_shared::method::taylor::Taylor;
use sprag_shared::motion::state::{BlockState, Stopped};
use sprag_shared::structure::Structure;

use crate::counted::Counted;
use crate::follow::{Start, Watcher, follow};
use crate::log::Log;
use crate::segment::Segment;
use crate::tally::Tally;

/// By which method a case is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stepping<S> {
    /// Taylor steps of the method's own choice, as tight as the precision allows.
    Tight,
    /// Runge-Kutta steps of this length, s.
    RungeKutta4(S),
    /// Semi-implicit Euler steps of this length, s.
    SemiImplicitEuler(S),
    /// Taylor steps of this length, s.
    Taylor(S),
}

/// How a motion ended and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome<S> {
    /// The last state, or why there is none.
    pub state: Result<BlockState<S>, Stopped>,
    /// Counts and checks.
    pub tally: Tally<S>,
    /// Arcs begun.
    pub arcs: u64,
    /// Motions asked for.
    pub looks: u64,
}

impl<S: Real> Outcome<S> {
    /// The last state of a motion that could be followed.
    #[track_caller]
    pub fn end(&self) -> BlockState<S> {
        self.state.unwrap_or_else(|stopped| panic!("{stopped}: {self:?}"))
    }
}

/// f32 or f64, with what a case has to know of it.
pub trait Precision: Real {
    /// As messages print it.
    const NAME: &'static str;

    /// A number that is denormal, and whose square is zero.
    const DENORMAL: Self;

    /// The tightest method.
    type Tight: Integrator<Self>;

    /// The Taylor method as tight as the precision allows.
    fn tight() -> Self::Tight;

    /// The next number above.
    fn up(self) -> Self;

    /// The next number below.
    fn down(self) -> Self;

    /// Follows `structure` by `stepping` from `start` over all `segments`, counted. Not generic, so that it is built once.
    fn tally(
        structure: &Structure,
        stepping: Stepping<Self>,
        start: Start<Self>,
        segments: &[Segment<Self>],
        tally: Tally<Self>,
    ) -> Outcome<Self>;

    /// The same, remembered in `log`.
    ///
    /// # Errors
    /// The errors of [`follow`].
    fn record(
        structure: &Structure,
        stepping: Stepping<Self>,
        start: Start<Self>,
        segments: &[Segment<Self>],
        log: &mut Log<Self, true>,
    ) -> Result<BlockState<Self>, Stopped>;

    /// The tolerance for this precision, given those in f64 and in f32.
    fn tolerance(double: f64, single: f64) -> f64;
}

macro_rules! precision {
    ($number:ident, $denormal:literal, $terms:literal, $tight:literal, |$double:ident, $single:ident| $tolerance:ident) => {
        impl Precision for $number {
            const NAME: &'static str = stringify!($number);
            const DENORMAL: $number = $denormal;

            type Tight = Taylor<$number, $terms>;

            fn tight() -> Self::Tight {
                Taylor::adaptive($tight)
            }

            fn up(self) -> $number {
                self.next_up()
            }

            fn down(self) -> $number {
                self.next_down()
            }

            fn tally(
                structure: &Structure,
                stepping: Stepping<Self>,
                start: Start<Self>,
                segments: &[Segment<Self>],
                mut tally: Tally<Self>,
            ) -> Outcome<Self> {
                let (state, (arcs, looks)) = run(structure, stepping, start, segments, &mut tally);
                Outcome { state, tally, arcs, looks }
            }

            fn record(
                structure: &Structure,
                stepping: Stepping<Self>,
                start: Start<Self>,
                segments: &[Segment<Self>],
                log: &mut Log<Self, true>,
            ) -> Result<BlockState<Self>, Stopped> {
                run(structure, stepping, start, segments, log).0
            }

            fn tolerance($double: f64, $single: f64) -> f64 {
                $tolerance
            }
        }
    };
}

precision!(f64, 1e-310, 20, 1e-17, |double, _single| double);
precision!(f32, 1e-40, 12, 1e-9, |_double, single| single);

/// The last state, and the arcs and looks that it took.
fn run<S: Precision, W: Watcher<S>>(
    structure: &Structure,
    stepping: Stepping<S>,
    start: Start<S>,
    segments: &[Segment<S>],
    watcher: &mut W,
) -> (Result<BlockState<S>, Stopped>, (u64, u64)) {
    fn counted<S: Precision, M: Integrator<S>, W: Watcher<S>>(
        structure: &Structure,
        method: M,
        start: Start<S>,
        segments: &[Segment<S>],
        watcher: &mut W,
    ) -> (Result<BlockState<S>, Stopped>, (u64, u64)) {
        let method = Counted::new(method);
        let state = follow(structure, &method, start, segments, watcher);
        (state, (method.arcs(), method.looks()))
    }
    match stepping {
        Stepping::Tight => counted(structure, S::tight(), start, segments, watcher),
        Stepping::RungeKutta4(step) => {
            counted(structure, FixedStep { scheme: Scheme::RungeKutta4, step }, start, segments, watcher)
        }
        Stepping::SemiImplicitEuler(step) => {
            counted(structure, FixedStep { scheme: Scheme::SemiImplicitEuler, step }, start, segments, watcher)
        }
        Stepping::Taylor(step) => counted(structure, Taylor::<S, 12>::fixed(step), start, segments, watcher),
    }
}

/// Makes of each generic case `name::<S: Precision>()` a test in f64 (`double::name`) and one in f32 (`single::name`).
#[macro_export]
macro_rules! in_both_precisions {
    ($($case:ident),* $(,)?) => {
        mod double {
            $(#[test] fn $case() { super::$case::<f64>(); })*
        }
        mod single {
            $(#[test] fn $case() { super::$case::<f32>(); })*
        }
    };
}
