use super::*;
use crate::equation::FullBlock;
use crate::equation::any_equation::AnyEquation;
use crate::ground::check::Sum;
use crate::ground::harmonic::{Harmonic, MavroeidisPapageorgiou};
use crate::ground::{GroundSegment, Harmonics, Linear, Ricker};
use crate::math::{asin, exp, square_root};
use crate::method::fixed::{FixedStep, Scheme};
use crate::method::taylor::Taylor;
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::{BlockState, Limits, Phase};
use crate::observers::peaks::Peaks;
use crate::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use crate::structure::device::{Device, DeviceKind};
use crate::structure::{Restitution, Structure};
use core::f64::consts::TAU;
use std::vec::Vec;
use std::{println, vec};

/// α, rad.
const SLENDERNESS: f64 = 0.2;

/// Every motion of the ground that has a closed form, as one type.
type Ground<S> = Sum<Linear<S>, Harmonics<S, 3>>;

fn sines<const N: usize>(terms: [(f64, f64, f64); N]) -> [Harmonic<f64>; 3] {
    let mut all = [Harmonic { amplitude: 0.0, frequency: 1.0, phase: 0.0 }; 3];
    for (slot, (amplitude, frequency, phase)) in all.iter_mut().zip(terms) {
        *slot = Harmonic { amplitude, frequency, phase };
    }
    all
}

/// A ground motion and its duration.
#[derive(Clone, Copy, Debug)]
struct Segment {
    line: (f64, f64),
    sines: [Harmonic<f64>; 3],
    duration: f64,
}

impl Segment {
    fn line(start: f64, slope: f64, duration: f64) -> Segment {
        Segment { line: (start, slope), sines: sines([]), duration }
    }

    fn sine(amplitude: f64, frequency: f64, phase: f64) -> Segment {
        Segment { line: (0.0, 0.0), sines: sines([(amplitude, frequency, phase)]), duration: TAU / frequency }
    }

    fn wavelet(velocity_amplitude: f64, frequency: f64, phase: f64) -> Segment {
        let wavelet = MavroeidisPapageorgiou { velocity_amplitude, frequency, oscillations: 1.8, phase };
        Segment { line: (0.0, 0.0), sines: wavelet.harmonics().terms, duration: wavelet.duration() }
    }

    fn ground<S: Real>(&self) -> Ground<S> {
        let terms = self.sines.map(|term| Harmonic {
            amplitude: S::of(term.amplitude),
            frequency: S::of(term.frequency),
            phase: S::of(term.phase),
        });
        Sum(Linear { start: S::of(self.line.0), slope: S::of(self.line.1) }, Harmonics { terms })
    }
}

/// Peaks and every event.
#[derive(Default)]
struct Log<S> {
    peaks: Peaks<S>,
    events: Vec<(Event, f64)>,
    stretches: u32,
}

impl<S: Real> Observer<S> for Log<S> {
    fn interval(&mut self, output: &dyn DenseOutput<S>, interval: &MonotoneInterval<S>) {
        self.peaks.interval(output, interval);
        self.stretches += 1;
    }

    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        self.peaks.event(event, time, state);
        self.events.push((event, (self.peaks.origin + time).to_f64()));
    }
}

/// A slender block with p = 1/s.
fn structure(kind: DeviceKind, geometry: Geometry) -> Structure {
    Structure {
        geometry,
        device: Device { kind, mass_ratio: 0.5, ..Device::NONE },
        ..Structure::new(Block::of_unit_frequency(SLENDERNESS, RECTANGLE_INERTIA_RATIO).unwrap(), Restitution::Constant(0.85))
    }
}

fn run<S: Real, M: Integrator<S>>(kind: DeviceKind, method: &M, segments: &[Segment]) -> (BlockState<S>, Log<S>) {
    follow(&structure(kind, Geometry::Slender), method, segments)
}

fn follow<S: Real, M: Integrator<S>>(structure: &Structure, method: &M, segments: &[Segment]) -> (BlockState<S>, Log<S>) {
    let system = structure.resolve().unwrap();
    let (mut state, mut log) = (BlockState::default(), Log::default());
    for (index, segment) in segments.iter().enumerate() {
        // Nothing stronger than 1.5 g follows; on quiet ground an outward motion beyond α does not return.
        let last = index + 1 == segments.len();
        let limits = Limits { overturned: S::of(SLENDERNESS + if last { 0.0 } else { 1.5 }), events: 2_000_000 };
        let duration = S::of(segment.duration);
        system.advance(method, &mut state, &segment.ground(), duration, &limits, &mut log).unwrap();
        log.peaks.origin = log.peaks.origin + duration;
    }
    (state, log)
}

/// Pulses, a wavelet and a record; blocks rock on, overturn or come to rest.
fn motions() -> Vec<Vec<Segment>> {
    let quiet = Segment::line(0.0, 0.0, 2.75);
    let record = [0.0, 0.31, -0.26, 0.42, 0.1, -0.35, 0.2, 0.28, -0.31, 0.0];
    let record = record.windows(2).map(|pair| Segment::line(pair[0], (pair[1] - pair[0]) / 0.7, 0.7));
    vec![
        vec![Segment::sine(0.3, 5.0, 0.0), quiet],
        vec![Segment::sine(0.5, 3.0, core::f64::consts::FRAC_PI_2), quiet],
        vec![Segment::wavelet(1.4, 0.4, 0.6), quiet],
        record.collect(),
        // Long and fast, so that steps hold many zeros of θ̈.
        vec![Segment { duration: 9.0, ..Segment::sine(0.9, 11.0, 0.4) }, quiet],
    ]
}

/// Largest differences of the final state, of all event times and of the peaks from the tight Taylor method.
fn difference<S: Real>((state, log): &(BlockState<S>, Log<S>), (exact, exact_log): &(BlockState<f64>, Log<f64>)) -> f64 {
    let kinds = |events: &[(Event, f64)]| events.iter().map(|event| event.0).collect::<Vec<_>>();
    assert_eq!(kinds(&log.events), kinds(&exact_log.events), "the same events in the same order");
    let events = log.events.iter().zip(&exact_log.events).map(|(a, b)| (a.1 - b.1).abs()).fold(0.0, f64::max);
    let apart = |a: S, b: f64| (a.to_f64() - b).abs();
    events
        .max(apart(state.rotation, exact.rotation) / SLENDERNESS)
        .max(apart(state.velocity, exact.velocity) / SLENDERNESS)
        .max(apart(log.peaks.rotation, exact_log.peaks.rotation) / SLENDERNESS)
        .max(apart(log.peaks.acceleration, exact_log.peaks.acceleration) / SLENDERNESS)
}

#[test]
fn it_is_the_taylor_methods_motion_whatever_the_step() {
    for (index, segments) in motions().iter().enumerate() {
        for kind in DeviceKind::ALL {
            let exact = run(kind, &Taylor::<f64, 20>::adaptive(1e-17), segments);
            assert!(exact.1.events.len() >= 4, "motion {index}: {:?}", exact.1.events);
            for step in [1e-4, 1e-3, 0.02, 0.3, 100.0] {
                let found = run(kind, &ClosedForm { step }, segments);
                let error = difference(&found, &exact);
                println!("motion {index}, {kind:?}, step {step}: {error:.1e}, {} stretches", found.1.stretches);
                assert!(error < 1e-12, "motion {index}, {kind:?}, step {step}: {error:e}");
            }
        }
    }
}

#[test]
fn single_precision_has_its_own_rounding_and_nothing_more() {
    for (index, segments) in motions().iter().enumerate() {
        for kind in DeviceKind::ALL {
            let exact = run(kind, &Taylor::<f64, 20>::adaptive(1e-17), segments);
            for step in [1e-3, 0.02, 0.5] {
                let error = difference(&run(kind, &ClosedForm { step: step as f32 }, segments), &exact);
                println!("motion {index}, {kind:?}, f32, step {step}: {error:.1e}");
                assert!(error < 1e-4, "motion {index}, {kind:?}, step {step}: {error:e}");
            }
        }
    }
}

/// From the instant of uplift θ starts as τ³, in which everything else cancels.
#[test]
fn a_short_step_loses_no_digits() {
    let block = SlenderBlock { frequency_squared: 1.0, slenderness: 1.0, inertia: 1.0, lever: 1.0 };
    let single = SlenderBlock { frequency_squared: 1.0_f32, slenderness: 1.0, inertia: 1.0, lever: 1.0 };
    let (amplitude, frequency) = (7.7, 6.0);
    let time = asin(1.0 / amplitude) / frequency;
    let slope = frequency * square_root(amplitude * amplitude - 1.0);
    for step in [1e-5, 1e-4, 1e-3] {
        // θ = −p² (slope τ³/6 − ω² τ⁴/24 + …): the block turns away from the push, and ü starts at 1.
        let exact = -(slope * step * step * step / 6.0) * (1.0 - frequency * frequency / slope * step / 4.0);
        let pulse = Harmonics::sine(amplitude, frequency);
        let start = StepStart {
            equation: &AnyEquation::Slender(block),
            segment: &pulse,
            side: Sign::Negative,
            rotation: 0.0,
            velocity: 0.0,
            time,
            length: step,
            acceleration: Some(0.0),
            scale: 1.0,
        };
        let found = ClosedForm { step }.integrate(&start).at(step).rotation;
        assert!((found / exact - 1.0).abs() < 2e-5 * (step / 1e-3) * (step / 1e-3) + 1e-11, "{step}: {found:e} {exact:e}");
        let pulse = Harmonics::sine(amplitude as f32, frequency as f32);
        let start = StepStart {
            equation: &AnyEquation::Slender(single),
            segment: &pulse,
            side: Sign::Negative,
            rotation: 0.0,
            velocity: 0.0,
            time: time as f32,
            length: step as f32,
            acceleration: Some(0.0),
            scale: 1.0,
        };
        let found = f64::from(ClosedForm { step: step as f32 }.integrate(&start).at(step as f32).rotation);
        assert!((found / exact - 1.0).abs() < 1e-3, "{step} in f32: {found:e} {exact:e}");
    }
}

#[test]
fn it_knows_where_it_applies() {
    let slender = AnyEquation::Slender(SlenderBlock { frequency_squared: 1.0, slenderness: 0.2, inertia: 1.0, lever: 1.0 });
    let full = AnyEquation::Block(FullBlock { frequency_squared: 1.0, slenderness: 0.2 });
    let wavelet = Ricker { amplitude: 0.5, rate: 4.0, centre: 1.0 };
    let applies = |equation: &AnyEquation<f64>, segment: &dyn GroundSegment<f64>| {
        let start = StepStart {
            equation,
            segment,
            side: Sign::Positive,
            rotation: 0.1,
            velocity: 0.0,
            time: 0.0,
            length: 0.1,
            acceleration: None,
            scale: 0.2,
        };
        matches!(ClosedForm { step: 0.1 }.integrate(&start), ClosedFormOutput::Closed(_))
    };
    assert!(applies(&slender, &Harmonics::QUIET) && applies(&slender, &Harmonics::sine(0.3, 5.0)));
    assert!(applies(&slender, &Segment::wavelet(1.4, 0.4, 0.6).ground::<f64>()));
    assert!(!applies(&slender, &wavelet) && !applies(&full, &Harmonics::QUIET));
}

/// Where it does not apply, its steps are the Runge-Kutta method's to the last bit.
#[test]
fn elsewhere_it_is_the_runge_kutta_method() {
    let segments = &motions()[0];
    for kind in DeviceKind::ALL {
        let structure = structure(kind, Geometry::Full);
        let (state, log) = follow::<f64, _>(&structure, &ClosedForm { step: 0.01 }, segments);
        let (same, same_log) = follow::<f64, _>(&structure, &FixedStep { scheme: Scheme::RungeKutta4, step: 0.01 }, segments);
        assert_eq!((state, log.peaks, log.events), (same, same_log.peaks, same_log.events));
    }
}

/// The least amplitude, in gα, that overturns the block without an impact.
fn boundary(kind: DeviceKind, near: f64, pulse: impl Fn(f64) -> Segment) -> f64 {
    let overturns = |ratio: f64| {
        let (state, _) = run(kind, &ClosedForm { step: 1e3 }, &[pulse(ratio * SLENDERNESS), Segment::line(0.0, 0.0, 80.0)]);
        state.phase == Phase::Overturned && state.impacts == 0
    };
    let (mut low, mut high) = (0.9 * near, 1.1 * near);
    assert!(!overturns(low) && overturns(high));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *if overturns(middle) { &mut high } else { &mut low } = middle;
    }
    high
}

/// Boundaries that are known in closed form, with one step for each event.
#[test]
fn overturning_boundaries() {
    for (kind, p) in [(DeviceKind::None, 1.0), (DeviceKind::Inerter, square_root(1.0 / 1.375))] {
        let close = |found: f64, exact: f64, name: &str| {
            assert!((found / exact - 1.0).abs() < 1e-7, "{name}, {kind:?}: {found} for {exact}");
        };
        let duration = core::f64::consts::LN_2 / p;
        close(boundary(kind, 2.0, |amplitude| Segment::line(amplitude, 0.0, duration)), 2.0, "rectangular pulse");
        for (ratio, exact) in [(2.0, 1.8007239), (4.0, 2.7907980), (8.0, 4.7870713)] {
            let half = |amplitude| Segment { duration: 0.5 * TAU / (ratio * p), ..Segment::sine(amplitude, ratio * p, 0.0) };
            close(boundary(kind, exact, half), exact, "half sine");
        }
        for (ratio, exact) in [(1.0, 1.4183153), (2.0, 2.3499031), (3.0, 3.6311499), (5.0, 7.1681288)] {
            close(boundary(kind, exact, |amplitude| Segment::sine(amplitude, ratio * p, 0.0)), exact, "sine");
        }
        let cosine = |amplitude| Segment::sine(amplitude, 2.0 * p, core::f64::consts::FRAC_PI_2);
        let exact = 5.0 / (1.0 - exp(-0.5 * TAU));
        close(boundary(kind, exact, cosine), exact, "cosine");
    }
}
