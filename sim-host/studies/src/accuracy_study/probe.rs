//! One motion, followed in one way.

use sprag_loops::{IdealLoop, Method, Precision};
use sprag_shared::equation::any_equation::WithEquation;
use sprag_shared::equation::switched::Switched;
use sprag_shared::ground::GroundSegment;
use sprag_shared::math::scalar::Real;
use sprag_shared::math::tier::{Libm, Micromath, OwnPolynomial};
use sprag_shared::math::tiered::Tiered;
use sprag_shared::method::dense_output::DenseOutput;
use sprag_shared::method::fixed::{FixedStep, Scheme};
use sprag_shared::motion::ideal::IdealSystem;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::state::{BlockState, Phase};
use sprag_shared::motion::step_end::{TimeStepping, TimeSteppingState};
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::observers::peaks::Peaks;
use sprag_sim::ground_motion::{Segment, SumSegment};
use sprag_sim::scene::accuracy::EventTreatment;
use sprag_sim::simulation::drive::{Course, Segmented};

use super::subject::Subject;
use super::variant::{self, Number, Setting, Variant};

/// What became of a motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// How it ended; `None` where it could not be followed to the end.
    pub outcome: Option<Outcome>,
    /// max |θ|/α.
    pub peak: f64,
    /// Steps begun.
    pub steps: u64,
    /// Instants (s) and θ/α, one at each of the times asked for or, without located events, at the end of the step after it.
    pub samples: Vec<(f64, f64)>,
}

/// Follows `subject` as `variant` says, and looks at θ at the `times` (s, ascending).
pub fn read(subject: &Subject, variant: &Variant, times: &[f64]) -> Reading {
    match variant.family.number {
        Number::F64Libm => with_any_method::<f64>(subject, variant, times),
        Number::F32Own => with_any_method::<f32>(subject, variant, times),
        Number::F64Own => step_end::<Tiered<f64, OwnPolynomial>>(subject, variant, times),
        Number::F32Libm => step_end::<Tiered<f32, Libm>>(subject, variant, times),
        Number::F32Micromath => step_end::<Tiered<f32, Micromath>>(subject, variant, times),
    }
}

fn with_any_method<S: Precision>(subject: &Subject, variant: &Variant, times: &[f64]) -> Reading {
    if variant.family.events == EventTreatment::StepEnd {
        return step_end::<S>(subject, variant, times);
    }
    let step = || S::of(step_of(subject, variant));
    let method = match (variant.family.method, variant.setting) {
        (variant::Method::SemiImplicitEuler, _) => Method::Fixed(FixedStep { scheme: Scheme::SemiImplicitEuler, step: step() }),
        (variant::Method::RungeKutta4, _) => Method::Fixed(FixedStep { scheme: Scheme::RungeKutta4, step: step() }),
        (variant::Method::ClosedForm, _) => Method::ClosedForm(step()),
        (variant::Method::Taylor, Setting::Step(_)) => Method::Series(step()),
        (variant::Method::Taylor, Setting::Tolerance(tolerance)) => Method::Adaptive(S::of(tolerance)),
    };
    located(subject, times, &*S::ideal(method))
}

/// The fixed step, s.
fn step_of(subject: &Subject, variant: &Variant) -> f64 {
    variant.setting.value() / subject.block().frequency_parameter()
}

fn located<S: Real>(subject: &Subject, times: &[f64], method: &dyn IdealLoop<S>) -> Reading {
    // A structure of a scene has been resolved before.
    let Ok(system) = subject.structure.resolve::<S>() else { return Reading::default() };
    let mut state = match subject.released {
        Some((rotation, velocity, ground)) => system.released_at(S::of(rotation), S::of(velocity), S::of(ground)),
        None => BlockState::default(),
    };
    let alpha = subject.block().slenderness();
    let mut watch = Watch::<S> {
        peaks: Peaks { rocked: subject.released.is_some(), ..Peaks::default() },
        steps: 0,
        origin: 0.0,
        alpha,
        times,
        samples: Vec::with_capacity(times.len()),
    };
    let done = subject.course().follow(&system, method, &mut state, &mut watch, || true);
    watch.stand_until(f64::INFINITY, if state.phase == Phase::Rocking { state.rotation.to_f64() } else { 0.0 });
    Reading {
        outcome: done.ok().map(|()| Outcome::of(&state, &watch.peaks)),
        peak: watch.peaks.rotation.to_f64() / alpha,
        steps: watch.steps,
        samples: watch.samples,
    }
}

/// Peaks, steps, and θ at the times asked for.
struct Watch<'a, S> {
    peaks: Peaks<S>,
    steps: u64,
    origin: f64,
    alpha: f64,
    times: &'a [f64],
    samples: Vec<(f64, f64)>,
}

impl<S: Real> Watch<'_, S> {
    /// θ (rad) at the times up to `time` (s).
    #[inline]
    fn stand_until(&mut self, time: f64, rotation: f64) {
        while let Some(&at) = self.times.get(self.samples.len()).filter(|at| **at <= time) {
            self.samples.push((at, rotation / self.alpha));
        }
    }
}

impl<S: Real> Observer<S> for Watch<'_, S> {
    #[inline]
    fn interval(&mut self, output: &dyn DenseOutput<S>, interval: &MonotoneInterval<S>) {
        self.steps += u64::from(interval.from == S::ZERO);
        // θ is monotone here, so its largest value lies at an end.
        let (first, last) = (interval.first.rotation.abs(), interval.last.rotation.abs());
        self.peaks.rotation = self.peaks.rotation.larger(first).larger(last);
        let start = self.origin + interval.start.to_f64();
        let to = start + interval.to.to_f64();
        while let Some(&at) = self.times.get(self.samples.len()).filter(|at| **at <= to) {
            let local = S::of(at - start).larger(interval.from).smaller(interval.to);
            self.samples.push((at, output.at(local).rotation.to_f64() / self.alpha));
        }
    }

    #[inline]
    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        self.peaks.event(event, time, state);
        if event == Event::Uplift {
            self.stand_until(self.origin + time.to_f64(), 0.0);
        }
    }
}

impl<S: Real> Segmented for Watch<'_, S> {
    fn segment(&mut self, start: f64, _segment: Option<&Segment>) {
        self.origin = start;
        self.peaks.origin = S::of(start);
    }
}

fn step_end<S: Real>(subject: &Subject, variant: &Variant, times: &[f64]) -> Reading {
    let method = variant.family.method;
    let Ok(system) = subject.structure.resolve::<S>() else { return Reading::default() };
    let next = StepEnd { subject, system: &system, times, method, step: S::of(step_of(subject, variant)) };
    system.engaged.known(next)
}

struct StepEnd<'a, S> {
    subject: &'a Subject,
    system: &'a IdealSystem<S>,
    times: &'a [f64],
    method: variant::Method,
    step: S,
}

impl<S: Real> WithEquation<S> for StepEnd<'_, S> {
    type Output = Reading;

    fn with<E: Switched<S>>(self, engaged: &E) -> Reading {
        let IdealSystem { clutch, restitution, uplift, .. } = *self.system;
        let released = if clutch.follows_signs() { engaged.without_inerter() } else { *engaged };
        let block = TimeStepping { released, engaged: *engaged, restitution, uplift };
        match self.method {
            variant::Method::SemiImplicitEuler => {
                self.follow(|state, piece, time, end| block.semi_implicit_euler(state, piece.acceleration(time), end - time))
            }
            _ => self.follow(|state, piece, time, end| {
                let middle = piece.acceleration(S::HALF * (time + end));
                block.runge_kutta_4(state, [piece.acceleration(time), middle, piece.acceleration(end)], end - time)
            }),
        }
    }
}

impl<S: Real> StepEnd<'_, S> {
    /// Steps to the end, looking at impacts and overturning after each.
    fn follow(&self, step: impl Fn(TimeSteppingState<S>, &SumSegment<S>, S, S) -> TimeSteppingState<S>) -> Reading {
        let subject = self.subject;
        let course: Course<'_> = subject.course();
        let alpha = subject.block().slenderness();
        let mut reading = Reading::default();
        let mut state = TimeSteppingState::at_rest();
        if let Some((rotation, velocity, _)) = subject.released {
            (state.rotation, state.velocity) = (S::of(rotation), S::of(velocity));
            state.side = if rotation < 0.0 || (rotation == 0.0 && velocity < 0.0) { -S::ONE } else { S::ONE };
        }
        let (mut rocked, mut peak, mut hit, mut fallen) = (subject.released.is_some(), S::ZERO, false, false);
        let quiet = (course.ground.duration(), course.free_time, None);
        let segments =
            course.ground.segments().iter().map(|segment| (segment.start, segment.duration, Some(segment))).chain([quiet]);
        'all: for (origin, duration, segment) in segments {
            let piece = segment.map_or(SumSegment::QUIET, |s| s.shape.to());
            let overturned: S = course.angle(segment.map_or(0.0, |segment| segment.bound));
            let duration = S::of(duration);
            let (mut time, mut tick) = (S::ZERO, 0);
            while time < duration {
                tick += 1;
                let end = (S::count(tick) * self.step).smaller(duration);
                let (side, moving) = (state.side, state != TimeSteppingState::at_rest());
                state = step(state, &piece, time, end);
                time = end;
                reading.steps += 1;
                rocked |= state != TimeSteppingState::at_rest();
                hit |= moving && side != state.side;
                peak = peak.larger(state.rotation.abs());
                if reading.samples.len() < self.times.len() {
                    let at = origin + time.to_f64();
                    if at >= self.times[reading.samples.len()] {
                        reading.samples.push((at, state.rotation.to_f64() / alpha));
                    }
                }
                if !state.rotation.is_finite() {
                    return reading;
                }
                if state.rotation.abs() >= overturned && state.rotation * state.velocity > S::ZERO {
                    fallen = true;
                    break 'all;
                }
            }
        }
        reading.peak = peak.to_f64() / alpha;
        reading.outcome = Some(Outcome::new(rocked, hit, fallen));
        reading
    }
}
