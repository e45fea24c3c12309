//! A whole ground motion: smooth pieces in a row, of one pulse, one record, or the sum of several.

pub mod oscillator;
mod sum_segment;

use sprag_shared::ground::{AnySegment, GroundSegment, Linear};
use sprag_shared::structure::block::GRAVITY;

pub use sum_segment::SumSegment;

/// One motion of a sum: its start and its pieces.
#[derive(Clone, Debug)]
pub struct Component {
    start: f64,
    /// End of each piece after the start (s), and the piece in its own time.
    pieces: Vec<(f64, AnySegment<f64>)>,
}

impl Component {
    /// One smooth piece of `duration` (s).
    pub fn pulse(start: f64, duration: f64, segment: AnySegment<f64>) -> Component {
        Component { start, pieces: vec![(duration, segment)] }
    }

    /// Samples (in g) every `step` (s), straight lines between them; a single sample moves nothing.
    pub fn record(start: f64, step: f64, samples: impl Iterator<Item = f64>) -> Component {
        let mut pieces = Vec::new();
        let mut previous = None;
        for (index, sample) in samples.enumerate() {
            if let Some(first) = previous {
                pieces.push((index as f64 * step, AnySegment::Linear(Linear::between(first, sample, step))));
            }
            previous = Some(sample);
        }
        Component { start, pieces }
    }

    /// The motion the other way round.
    fn opposite(&self) -> Component {
        let pieces = self.pieces.iter().map(|(end, segment)| (*end, segment.opposite())).collect();
        Component { start: self.start, pieces }
    }
}

/// A stretch between two kinks of the sum.
#[derive(Clone, Debug)]
pub struct Segment {
    /// s from the origin.
    pub start: f64,
    /// s.
    pub duration: f64,
    /// Ground acceleration over the segment.
    pub shape: SumSegment<f64>,
    /// Bound of |ü_g/g| from here to the end of the motion.
    pub bound: f64,
}

/// A ground motion from time 0 on; quiet after its last segment.
#[derive(Clone, Debug, Default)]
pub struct GroundMotion {
    segments: Vec<Segment>,
}

impl GroundMotion {
    /// The sum of `components`.
    pub fn sum(components: &[Component]) -> GroundMotion {
        GroundMotion::cut(components, &kinks(components))
    }

    /// The sums of `horizontal` and of `vertical` components, cut at the kinks of both, so that they have the same segments;
    /// where only one of them still moves, the other is quiet.
    pub fn aligned(horizontal: &[Component], vertical: &[Component]) -> [GroundMotion; 2] {
        GroundMotion::cut_together([horizontal, vertical])
    }

    /// The sum of each of `motions`, cut at the kinks of all.
    fn cut_together<const N: usize>(motions: [&[Component]; N]) -> [GroundMotion; N] {
        let mut times = motions.map(kinks).concat();
        times.sort_by(f64::total_cmp);
        times.dedup();
        motions.map(|components| GroundMotion::cut(components, &times))
    }

    /// The sum of `components` between one of the `times` and the next; every kink is among them.
    fn cut(components: &[Component], times: &[f64]) -> GroundMotion {
        let mut at = vec![0_usize; components.len()];
        let mut segments = Vec::with_capacity(times.len());
        let mut parts = Vec::new();
        for pair in times.windows(2) {
            let (start, end) = (pair[0], pair[1]);
            parts.clear();
            for (component, index) in components.iter().zip(&mut at) {
                while component.pieces.get(*index).is_some_and(|(end, _)| component.start + end <= start) {
                    *index += 1;
                }
                if component.start <= start
                    && let Some((_, segment)) = component.pieces.get(*index)
                {
                    let piece_start = if *index == 0 { 0.0 } else { component.pieces[*index - 1].0 };
                    parts.push((start - (component.start + piece_start), *segment));
                }
            }
            segments.push(Segment { start, duration: end - start, shape: SumSegment::of(&parts), bound: 0.0 });
        }
        let mut motion = GroundMotion { segments };
        motion.bind();
        motion
    }

    /// Sets the bounds of its segments.
    fn bind(&mut self) {
        let mut bound = 0.0_f64;
        for segment in self.segments.iter_mut().rev() {
            bound = bound.max(segment.shape.bound(segment.duration));
            segment.bound = bound;
        }
    }

    /// Its segments, in order.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// When it ends, s.
    pub fn duration(&self) -> f64 {
        self.segments.last().map_or(0.0, |segment| segment.start + segment.duration)
    }

    /// A block's weight at its lightest under this vertical motion, over its weight at rest.
    pub fn lightest(&self) -> f64 {
        1.0 + self.lowest().0.min(0.0)
    }

    /// Largest |ü_g| at 2,000 instants and at every kink, m/s².
    pub fn peak_m_s2(&self) -> f64 {
        let mut peak = 0.0_f64;
        for segment in &self.segments {
            let inner = if matches!(segment.shape, SumSegment::Single(AnySegment::Linear(_))) { 1 } else { 2000 };
            for k in 0..=inner {
                peak = peak.max(segment.shape.acceleration(segment.duration * f64::from(k) / f64::from(inner)).abs());
            }
        }
        peak * GRAVITY
    }

    /// The smallest ü_g/g, to 1e-9 of the largest or of 1, and when (s); 0 at time 0 for a motion without segments.
    pub fn lowest(&self) -> (f64, f64) {
        let mut highest = (f64::NEG_INFINITY, 0.0);
        for segment in &self.segments {
            let (curvature, tolerance) = (segment.shape.curvature_bound(), 1e-9 * segment.bound.max(1.0));
            let may_rise = |highest: f64, ends: [f64; 2], length: f64| {
                ends[0].max(ends[1]) + curvature * length * length / 8.0 > highest + tolerance
            };
            segment.search(&mut highest, |time| -segment.shape.acceleration(time), |value| value, may_rise);
        }
        if highest.0.is_finite() { (-highest.0, highest.1) } else { (0.0, 0.0) }
    }

    /// Largest |ü_g/g|/(1 + v̈_g/g), to 1e-9, above a `vertical` motion with the same segments under which the block keeps some weight.
    pub fn steepest(&self, vertical: Option<&GroundMotion>) -> f64 {
        let mut steepest = (0.0, 0.0);
        for (index, segment) in self.segments.iter().enumerate() {
            let level = &segment.shape;
            let up =
                vertical.and_then(|vertical| vertical.segments.get(index)).map_or(&SumSegment::QUIET, |segment| &segment.shape);
            let at = |time: f64| [level.acceleration(time).abs(), 1.0 + up.acceleration(time)];
            let may_steepen = |steepest: f64, [first, last]: [[f64; 2]; 2], length: f64| {
                let apart = length * length / 8.0;
                let push = first[0].max(last[0]) + level.curvature_bound() * apart;
                let weight = first[1].min(last[1]) - up.curvature_bound() * apart;
                push > (steepest + 1e-9) * weight
            };
            segment.search(&mut steepest, at, |[push, weight]| push / weight, may_steepen);
        }
        steepest.0
    }
}

impl Segment {
    /// Raises `most`, a value and its time (s), to the largest `value` of what is seen `at` any time of this segment, s from its start. A span
    /// of this length (s) is halved as long as what is seen at its ends says that it `may` hold more: between them nothing is further from the
    /// chord than the bound of its curvature times an eighth of the length squared, so that nothing falls between samples.
    fn search<V: Copy>(
        &self,
        most: &mut (f64, f64),
        at: impl Fn(f64) -> V,
        value: impl Fn(V) -> f64,
        may: impl Fn(f64, [V; 2], f64) -> bool,
    ) {
        let look = |most: &mut (f64, f64), time: f64| {
            let seen = at(time);
            if value(seen) > most.0 {
                *most = (value(seen), self.start + time);
            }
            seen
        };
        let (first, last) = (look(most, 0.0), look(most, self.duration));
        let mut spans = vec![(0.0, first, self.duration, last)];
        while let Some((from, first, to, last)) = spans.pop() {
            let middle = 0.5 * (from + to);
            if !may(most.0, [first, last], to - from) || middle <= from || middle >= to {
                continue;
            }
            let seen = look(most, middle);
            spans.extend([(middle, seen, to, last), (from, first, middle, seen)]);
        }
    }
}

/// Times from 0 on at which a sum of `components` may kink or jump, in order.
fn kinks(components: &[Component]) -> Vec<f64> {
    let mut times: Vec<f64> = vec![0.0];
    for component in components {
        if !component.pieces.is_empty() {
            times.push(component.start);
        }
        times.extend(component.pieces.iter().map(|(end, _)| component.start + end));
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

#[cfg(test)]
mod tests {
    use sprag_shared::ground::{Harmonics, Ricker};

    use super::*;

    fn at(motion: &GroundMotion, time: f64) -> f64 {
        let segment = motion.segments().iter().find(|s| time < s.start + s.duration);
        segment.map_or(0.0, |s| s.shape.acceleration(time - s.start))
    }

    #[test]
    fn a_sum_is_that_of_its_parts_at_every_time() {
        let record = Component::record(0.5, 0.25, [0.1, -0.2, 0.3, 0.0].into_iter());
        let sine = Component::pulse(0.6, 1.0, AnySegment::Sine(Harmonics::sine(0.4, core::f64::consts::TAU)));
        let block = Component::pulse(0.0, 0.8, AnySegment::Linear(Linear::constant(0.05)));
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

    /// A few motions that overlap, end before each other and jump.
    fn parts() -> Vec<Component> {
        vec![
            Component::record(0.5, 0.25, [0.1, -0.2, 0.3, 0.0].into_iter()),
            Component::pulse(0.6, 1.0, AnySegment::Sine(Harmonics::sine(0.4, core::f64::consts::TAU))),
            Component::pulse(0.0, 0.8, AnySegment::Linear(Linear::constant(0.05))),
            Component::record(1.1, 0.1, (0..30).map(|k| 0.02 * f64::from(k % 7) - 0.05)),
            Component::pulse(2.0, 0.7, AnySegment::Ricker(Ricker { amplitude: 0.3, rate: 17.0, centre: 0.35 })),
        ]
    }

    /// Fractions of 1 without a pattern, always the same.
    fn fractions() -> impl Iterator<Item = f64> {
        let mut state = 1_u64;
        core::iter::repeat_with(move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        })
    }

    #[test]
    fn aligned_motions_have_the_same_segments_and_the_values_of_separate_ones() {
        let parts = parts();
        for split in 0..=parts.len() {
            let (horizontal, vertical) = parts.split_at(split);
            let aligned = GroundMotion::aligned(horizontal, vertical);
            let cuts = |motion: &GroundMotion| motion.segments().iter().map(|s| (s.start, s.duration)).collect::<Vec<_>>();
            assert_eq!(cuts(&aligned[0]), cuts(&aligned[1]), "{split}");
            assert_eq!(aligned[0].duration(), aligned[1].duration());
            let separate = [GroundMotion::sum(horizontal), GroundMotion::sum(vertical)];
            for time in fractions().take(2000).map(|fraction| 4.5 * fraction) {
                for (one, other) in aligned.iter().zip(&separate) {
                    assert!((at(one, time) - at(other, time)).abs() < 1e-13, "{split} at {time}");
                    let segment = one.segments().iter().find(|s| time < s.start + s.duration);
                    assert!(segment.is_none_or(|s| s.bound >= at(other, time).abs()), "bound, {split} at {time}");
                }
            }
        }
    }

    #[test]
    fn nothing_lies_below_the_lowest_value_and_it_is_taken() {
        let parts = parts();
        for motion in [GroundMotion::sum(&parts), GroundMotion::sum(&parts[..2]), GroundMotion::sum(&parts[4..])] {
            let (lowest, when) = motion.lowest();
            // At a jump the value is that of one of its sides.
            let taken = motion.segments().iter().any(|s| {
                (s.start..=s.start + s.duration).contains(&when) && s.shape.acceleration(when - s.start) < lowest + 1e-12
            });
            assert!(taken, "{lowest} at {when}");
            assert!(fractions().take(5000).all(|fraction| at(&motion, 4.5 * fraction) >= lowest - 2e-9), "{lowest} at {when}");
        }
        let sine = GroundMotion::sum(&[Component::pulse(0.5, 1.0, AnySegment::Sine(Harmonics::sine(0.4, 7.0)))]);
        let (lowest, when) = sine.lowest();
        assert!((lowest + 0.4).abs() < 1e-9 && (when - 0.5 - 1.5 * core::f64::consts::PI / 7.0).abs() < 1e-4);
        assert_eq!(GroundMotion::default().lowest(), (0.0, 0.0));
    }

    #[test]
    fn nothing_is_steeper_than_the_steepest_and_it_is_taken() {
        let parts = parts();
        for split in 0..=parts.len() {
            let [level, up] = GroundMotion::aligned(&parts[..split], &parts[split..]);
            for vertical in [None, Some(&up)] {
                let steepest = level.steepest(vertical);
                let lean = |time: f64| at(&level, time).abs() / (1.0 + vertical.map_or(0.0, |up| at(up, time)));
                let largest = (0..=450_000).map(|k| lean(1e-5 * f64::from(k))).fold(0.0, f64::max);
                // A jump may lie between two instants.
                assert!((-2e-9..1e-4).contains(&(steepest - largest)), "{split}: {steepest} {largest}");
            }
        }
        let sine =
            |amplitude: f64| Component::pulse(0.0, 1.0, AnySegment::Sine(Harmonics::sine(amplitude, core::f64::consts::TAU)));
        assert!((GroundMotion::sum(&[sine(0.2), sine(-0.15)]).steepest(None) - 0.05).abs() < 1e-9);
        assert_eq!(GroundMotion::sum(&[sine(0.2)]).steepest(None), 0.2);
    }
}
