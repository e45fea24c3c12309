//! A whole ground motion: smooth pieces in a row, of one pulse, one record, or the sum of several.

use sprag_shared::block::GRAVITY;
use sprag_shared::ground::harmonic::Harmonic;
use sprag_shared::ground::{Harmonics, Linear, Piece, Ricker};
use sprag_shared::scalar::Real;

/// A smooth piece of one motion, in g over local time in s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Smooth {
    /// A straight line.
    Linear(Linear<f64>),
    /// A sine.
    Single(Harmonics<f64, 1>),
    /// Three sines.
    Triple(Harmonics<f64, 3>),
    /// A Ricker wavelet.
    Ricker(Ricker<f64>),
}

/// One motion of a sum: its start and its pieces.
#[derive(Clone, Debug)]
pub struct Component {
    start: f64,
    /// End of each piece after the start (s), and the piece in its own time.
    pieces: Vec<(f64, Smooth)>,
}

impl Component {
    /// One smooth piece of `duration` (s).
    pub fn pulse(start: f64, duration: f64, smooth: Smooth) -> Component {
        Component { start, pieces: vec![(duration, smooth)] }
    }

    /// Samples (in g) every `step` (s), straight lines between them; a single sample moves nothing.
    pub fn record(start: f64, step: f64, samples: impl Iterator<Item = f64>) -> Component {
        let mut pieces = Vec::new();
        let mut previous = None;
        for (index, sample) in samples.enumerate() {
            if let Some(first) = previous {
                pieces.push((index as f64 * step, Smooth::Linear(Linear::between(first, sample, step))));
            }
            previous = Some(sample);
        }
        Component { start, pieces }
    }
}

/// The pieces in force over one segment, each with the local time at which the segment starts.
pub type Mixture = Vec<(f64, Smooth)>;

/// A stretch between two kinks of the sum.
#[derive(Clone, Debug)]
pub struct Segment {
    /// s from the origin.
    pub start: f64,
    /// s.
    pub duration: f64,
    /// What shakes.
    pub shape: Shape,
    /// Bound of |ü_g/g| from here to the end of the motion.
    pub bound: f64,
}

/// The sum over a segment.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Records only, or nothing: a straight line.
    Linear(Linear<f64>),
    /// Anything else.
    Mixture(Mixture),
}

/// A ground motion from time 0 on; quiet after its last segment.
#[derive(Clone, Debug, Default)]
pub struct GroundMotion {
    segments: Vec<Segment>,
}

impl GroundMotion {
    /// The sum of `components`.
    pub fn sum(components: &[Component]) -> GroundMotion {
        let mut times: Vec<f64> = vec![0.0];
        for component in components {
            if !component.pieces.is_empty() {
                times.push(component.start);
            }
            times.extend(component.pieces.iter().map(|(end, _)| component.start + end));
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        let mut at = vec![0_usize; components.len()];
        let mut segments = Vec::with_capacity(times.len());
        for pair in times.windows(2) {
            let (start, end) = (pair[0], pair[1]);
            let mut mixture = Mixture::new();
            for (component, index) in components.iter().zip(&mut at) {
                while component.pieces.get(*index).is_some_and(|(end, _)| component.start + end <= start) {
                    *index += 1;
                }
                if component.start <= start
                    && let Some((_, smooth)) = component.pieces.get(*index)
                {
                    let piece_start = if *index == 0 { 0.0 } else { component.pieces[*index - 1].0 };
                    mixture.push((start - (component.start + piece_start), *smooth));
                }
            }
            let lines: Option<Vec<Linear<f64>>> = mixture.iter().map(|part| part.1.line(part.0)).collect();
            let shape = match lines {
                Some(lines) => Shape::Linear(lines.iter().fold(Linear { start: 0.0, slope: 0.0 }, |sum, l| Linear {
                    start: sum.start + l.start,
                    slope: sum.slope + l.slope,
                })),
                None => Shape::Mixture(mixture),
            };
            segments.push(Segment { start, duration: end - start, shape, bound: 0.0 });
        }
        let mut bound = 0.0_f64;
        for segment in segments.iter_mut().rev() {
            bound = bound.max(segment.shape.bound(segment.duration));
            segment.bound = bound;
        }
        GroundMotion { segments }
    }

    /// Its segments, in order.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// When it ends, s.
    pub fn duration(&self) -> f64 {
        self.segments.last().map_or(0.0, |segment| segment.start + segment.duration)
    }

    /// Largest |ü_g| at 2,000 instants and at every kink, m/s².
    pub fn peak_m_s2(&self) -> f64 {
        let mut peak = 0.0_f64;
        for segment in &self.segments {
            let inner = if matches!(segment.shape, Shape::Linear(_)) { 1 } else { 2000 };
            for k in 0..=inner {
                peak = peak.max(segment.shape.acceleration(segment.duration * f64::from(k) / f64::from(inner)).abs());
            }
        }
        peak * GRAVITY
    }
}

impl Smooth {
    /// As a straight line from local time `offset`, if it is one.
    fn line(&self, offset: f64) -> Option<Linear<f64>> {
        match self {
            Smooth::Linear(line) => Some(Linear { start: line.start + line.slope * offset, slope: line.slope }),
            _ => None,
        }
    }

    fn bound(&self) -> f64 {
        match self {
            Smooth::Linear(line) => line.start.abs(),
            Smooth::Single(harmonics) => harmonics.terms.iter().map(|term| term.amplitude.abs()).sum(),
            Smooth::Triple(harmonics) => harmonics.terms.iter().map(|term| term.amplitude.abs()).sum(),
            Smooth::Ricker(wavelet) => wavelet.amplitude.abs(),
        }
    }
}

impl Shape {
    fn bound(&self, duration: f64) -> f64 {
        match self {
            Shape::Linear(line) => line.start.abs().max((line.start + line.slope * duration).abs()),
            Shape::Mixture(parts) => parts
                .iter()
                .map(|(offset, smooth)| match smooth.line(*offset) {
                    Some(line) => line.start.abs().max((line.start + line.slope * duration).abs()),
                    None => smooth.bound(),
                })
                .sum(),
        }
    }

    /// ü_g/g at local time `time` (s).
    pub fn acceleration(&self, time: f64) -> f64 {
        match self {
            Shape::Linear(line) => Piece::<f64>::acceleration(line, time),
            Shape::Mixture(parts) => MixturePiece::<f64>::of(parts).acceleration(time),
        }
    }
}

/// A mixture in the precision of a run.
#[derive(Clone, Debug)]
pub struct MixturePiece<S> {
    parts: Vec<(S, SmoothPiece<S>)>,
}

/// A segment's shape in the precision of a run.
#[derive(Clone, Debug)]
pub enum ShapePiece<S> {
    /// A straight line.
    Linear(Linear<S>),
    /// Anything else.
    Mixture(MixturePiece<S>),
}

impl<S: Real> ShapePiece<S> {
    /// In precision `S`.
    pub fn of(shape: &Shape) -> Self {
        match shape {
            Shape::Linear(line) => ShapePiece::Linear(line_of(line)),
            Shape::Mixture(parts) => ShapePiece::Mixture(MixturePiece::of(parts)),
        }
    }
}

impl<S: Real> Piece<S> for ShapePiece<S> {
    #[inline]
    fn acceleration(&self, time: S) -> S {
        match self {
            ShapePiece::Linear(line) => line.acceleration(time),
            ShapePiece::Mixture(mixture) => mixture.acceleration(time),
        }
    }

    #[inline]
    fn slope(&self, time: S) -> S {
        match self {
            ShapePiece::Linear(line) => line.slope(time),
            ShapePiece::Mixture(mixture) => mixture.slope(time),
        }
    }

    #[inline]
    fn curvature_bound(&self) -> S {
        match self {
            ShapePiece::Linear(_) => S::ZERO,
            ShapePiece::Mixture(mixture) => mixture.curvature_bound(),
        }
    }

    #[inline]
    fn series(&self, time: S, coefficients: &mut [S]) {
        match self {
            ShapePiece::Linear(line) => line.series(time, coefficients),
            ShapePiece::Mixture(mixture) => mixture.series(time, coefficients),
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum SmoothPiece<S> {
    Linear(Linear<S>),
    Single(Harmonics<S, 1>),
    Triple(Harmonics<S, 3>),
    Ricker(Ricker<S>),
}

fn line_of<S: Real>(line: &Linear<f64>) -> Linear<S> {
    Linear { start: S::of(line.start), slope: S::of(line.slope) }
}

fn harmonics_of<S: Real, const M: usize>(harmonics: &Harmonics<f64, M>) -> Harmonics<S, M> {
    Harmonics {
        terms: harmonics.terms.map(|term| Harmonic {
            amplitude: S::of(term.amplitude),
            frequency: S::of(term.frequency),
            phase: S::of(term.phase),
        }),
    }
}

impl<S: Real> MixturePiece<S> {
    /// In precision `S`.
    pub fn of(mixture: &[(f64, Smooth)]) -> Self {
        let part = |smooth: &Smooth| match smooth {
            Smooth::Linear(line) => SmoothPiece::Linear(line_of(line)),
            Smooth::Single(harmonics) => SmoothPiece::Single(harmonics_of(harmonics)),
            Smooth::Triple(harmonics) => SmoothPiece::Triple(harmonics_of(harmonics)),
            Smooth::Ricker(wavelet) => SmoothPiece::Ricker(Ricker {
                amplitude: S::of(wavelet.amplitude),
                rate: S::of(wavelet.rate),
                centre: S::of(wavelet.centre),
            }),
        };
        MixturePiece { parts: mixture.iter().map(|(offset, smooth)| (S::of(*offset), part(smooth))).collect() }
    }
}

macro_rules! each {
    ($piece:expr, $inner:ident => $result:expr) => {
        match $piece {
            SmoothPiece::Linear($inner) => $result,
            SmoothPiece::Single($inner) => $result,
            SmoothPiece::Triple($inner) => $result,
            SmoothPiece::Ricker($inner) => $result,
        }
    };
}

impl<S: Real> Piece<S> for MixturePiece<S> {
    fn acceleration(&self, time: S) -> S {
        self.parts.iter().fold(S::ZERO, |sum, (offset, piece)| sum + each!(piece, p => p.acceleration(*offset + time)))
    }

    fn slope(&self, time: S) -> S {
        self.parts.iter().fold(S::ZERO, |sum, (offset, piece)| sum + each!(piece, p => p.slope(*offset + time)))
    }

    fn curvature_bound(&self) -> S {
        self.parts.iter().fold(S::ZERO, |sum, (_, piece)| sum + each!(piece, p => Piece::<S>::curvature_bound(p)))
    }

    fn series(&self, time: S, coefficients: &mut [S]) {
        coefficients.fill(S::ZERO);
        let mut others = [S::ZERO; sprag_shared::tape::MAXIMUM_ORDER];
        let length = coefficients.len().min(others.len());
        for (offset, piece) in &self.parts {
            each!(piece, p => p.series(*offset + time, &mut others[..length]));
            for (sum, other) in coefficients.iter_mut().zip(&others) {
                *sum = *sum + *other;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(motion: &GroundMotion, time: f64) -> f64 {
        let segment = motion.segments().iter().find(|s| time < s.start + s.duration);
        segment.map_or(0.0, |s| s.shape.acceleration(time - s.start))
    }

    #[test]
    fn a_sum_is_that_of_its_parts_at_every_time() {
        let record = Component::record(0.5, 0.25, [0.1, -0.2, 0.3, 0.0].into_iter());
        let sine = Component::pulse(0.6, 1.0, Smooth::Single(Harmonics::sine(0.4, core::f64::consts::TAU)));
        let block = Component::pulse(0.0, 0.8, Smooth::Linear(Linear::constant(0.05)));
        let parts = [record, sine, block];
        let sum = GroundMotion::sum(&parts);
        for k in 0..200 {
            let time = f64::from(k) * 0.01 + 0.003;
            let expected: f64 = parts.iter().map(|part| at(&GroundMotion::sum(std::slice::from_ref(part)), time)).sum();
            assert!((at(&sum, time) - expected).abs() < 1e-14, "{time}");
            let segment = sum.segments().iter().find(|s| time < s.start + s.duration);
            assert!(segment.is_none_or(|s| s.bound >= expected.abs()), "bound at {time}");
        }
        assert!((sum.duration() - 1.6).abs() < 1e-15);
    }

    #[test]
    fn a_record_of_one_sample_moves_nothing() {
        let motion = GroundMotion::sum(&[Component::record(0.0, 0.01, [1.0].into_iter())]);
        assert!(motion.segments().is_empty() && motion.duration() == 0.0);
    }
}
