//! Slow wandering of the bias of an inertial axis.

use sprag_shared::math;

use super::random::Random;

/// Peak of the Allan deviation of a first-order Gauss-Markov process over its standard deviation, reached at 1.89 correlation times
/// (IEEE Std 952-1997, Annex C: 0.437 q_c √T_c, with a standard deviation of q_c √(T_c/2)). A data sheet's in-run bias stability is the
/// bottom of the Allan curve; divided by this it is the deviation of a process that wanders as much.
pub const ALLAN_PEAK_RATIO: f64 = 0.618;

/// Bias drift in the unit of the axis: the sum of
///
/// - bias instability, as a first-order Gauss-Markov process ḃ = −b/T_c + w of a stated standard deviation, stationary from the start;
/// - rate random walk, ḃ = K w, from 0 at the start: variance K² t (IEEE Std 952-1997, Annex C).
///
/// It is added after the low-pass filter, which would not change what takes seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drift {
    /// Standard deviation of the Gauss-Markov process, unit; not negative.
    pub deviation: f64,
    /// T_c, s; above 0 wherever `deviation` is.
    pub correlation_time: f64,
    /// K, unit/√s; not negative.
    pub random_walk: f64,
}

impl Drift {
    /// No drift.
    pub const NONE: Drift = Drift { deviation: 0.0, correlation_time: 0.0, random_walk: 0.0 };
}

/// Part of a correlation time for which the bias is held: it changes by 4 % of its deviation meanwhile, and most readings cost nothing.
const HELD: f64 = 1e-3;
/// Time for which a random walk without bias instability is held, s.
const WALK_HELD: f64 = 1e-2;

/// The drift of one axis so far.
#[derive(Clone, Debug)]
pub(super) struct Wander {
    drift: Drift,
    markov: f64,
    walk: f64,
    random: Random,
    /// Since the last step, s.
    elapsed: f64,
    /// Shortest step, s.
    hold: f64,
    span: f64,
    kept: f64,
    added: f64,
    walked: f64,
}

impl Wander {
    pub(super) fn new(drift: Drift, mut random: Random) -> Wander {
        let markov = if drift.deviation > 0.0 { drift.deviation * random.normal() } else { 0.0 };
        let hold = if drift.deviation > 0.0 { HELD * drift.correlation_time } else { WALK_HELD };
        Wander { drift, markov, walk: 0.0, random, elapsed: 0.0, hold, span: 0.0, kept: 1.0, added: 0.0, walked: 0.0 }
    }

    /// The bias `span` (s) after the last one.
    #[inline]
    pub(super) fn next(&mut self, span: f64) -> f64 {
        self.elapsed += span;
        if self.elapsed >= self.hold && self.elapsed > 0.0 {
            self.step();
        }
        self.markov + self.walk
    }

    fn step(&mut self) {
        let Drift { deviation, correlation_time, random_walk } = self.drift;
        let span = std::mem::take(&mut self.elapsed);
        if deviation > 0.0 || random_walk > 0.0 {
            if span != self.span {
                self.span = span;
                self.kept = math::exp(-span / correlation_time);
                self.added = deviation * math::square_root(-math::expm1(-2.0 * span / correlation_time));
                self.walked = random_walk * math::square_root(span);
            }
            if deviation > 0.0 {
                self.markov = self.kept * self.markov + self.added * self.random.normal();
            }
            if random_walk > 0.0 {
                self.walk += self.walked * self.random.normal();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::Purpose;
    use super::*;

    fn wander(drift: Drift, seed: u64) -> Wander {
        Wander::new(drift, Random::new(seed, 0, Purpose::Drift))
    }

    #[test]
    fn bias_instability_has_its_deviation_correlation_and_allan_peak() {
        let mut process = wander(Drift { deviation: 0.3, correlation_time: 2.0, random_walk: 0.0 }, 1);
        let values: Vec<f64> = (0..1_000_000).map(|_| process.next(0.1)).collect();
        let mean_of = |count: usize, value: &dyn Fn(usize) -> f64| (0..count).map(value).sum::<f64>() / count as f64;
        let square = mean_of(values.len(), &|index| values[index] * values[index]);
        assert!((square / 0.09 - 1.0).abs() < 0.03, "{square}");
        // One correlation time apart.
        let product = mean_of(values.len() - 20, &|index| values[index] * values[index + 20]);
        assert!((product / square - math::exp(-1.0)).abs() < 0.02, "{product}");
        // Averages over 1.89 T_c = 3.8 s.
        let averages: Vec<f64> = values.chunks_exact(38).map(|chunk| chunk.iter().sum::<f64>() / 38.0).collect();
        let change = |index: usize| averages[index + 1] - averages[index];
        let allan = (0.5 * mean_of(averages.len() - 1, &|index| change(index) * change(index))).sqrt();
        assert!((allan / 0.3 - ALLAN_PEAK_RATIO).abs() < 0.02, "{allan}");
    }

    #[test]
    fn a_random_walk_spreads_with_the_root_of_time() {
        let drift = Drift { random_walk: 0.05, ..Drift::NONE };
        let after = |seconds: u32| {
            let squares = (0..2000).map(|seed| {
                let mut walk = wander(drift, seed);
                let last = (0..seconds * 10).map(|_| walk.next(0.1)).last().unwrap_or_default();
                last * last / 2000.0
            });
            squares.sum::<f64>()
        };
        for seconds in [1, 16] {
            assert!((after(seconds) / (0.0025 * f64::from(seconds)) - 1.0).abs() < 0.12, "{seconds} s");
        }
    }

    #[test]
    fn no_drift_is_exactly_none() {
        let mut none = wander(Drift::NONE, 1);
        assert!((0..10).all(|_| none.next(0.1) == 0.0));
    }
}
