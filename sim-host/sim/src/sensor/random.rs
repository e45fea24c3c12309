//! Seeded random numbers of the sensors: one ChaCha8 stream for each purpose of each axis, and normal deviates from it.

use std::sync::LazyLock;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sprag_shared::math;

/// Number of the first stream. Stream 0 of a seed belongs to the synthetic ground motion, which may well have the same seed.
const FIRST_STREAM: u64 = 1 << 32;

/// What numbers are drawn for. Each purpose has a stream of its own, so that switching one imperfection leaves the others as they were.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// Errors that stay as they are from the start: bias, scale, misalignment, phase of an encoder.
    TurnOn = 0,
    /// White noise, missed counts.
    Noise = 1,
    /// Bias drift.
    Drift = 2,
    /// Instants of sampling.
    Clock = 3,
}

/// One stream of one seed.
#[derive(Clone, Debug)]
pub(super) struct Random {
    words: ChaCha8Rng,
    ziggurat: &'static Ziggurat,
}

impl Random {
    /// The stream of `axis` (from 0, counted over all sensors) for `purpose`.
    pub(super) fn new(seed: u64, axis: u64, purpose: Purpose) -> Random {
        let mut words = ChaCha8Rng::seed_from_u64(seed);
        words.set_stream(FIRST_STREAM + 4 * axis + purpose as u64);
        Random { words, ziggurat: &ZIGGURAT }
    }

    /// Evenly distributed from 0 up to, not including, 1.
    pub(super) fn uniform(&mut self) -> f64 {
        unit(self.words.next_u64())
    }

    /// Normally distributed with mean 0 and variance 1.
    #[inline(always)]
    pub(super) fn normal(&mut self) -> f64 {
        let word = self.words.next_u64();
        let (layer, part) = layer_of(word);
        let value = part * self.ziggurat.edge[layer];
        if value.abs() < self.ziggurat.edge[layer + 1] { value } else { self.normal_from(word) }
    }

    /// [`Random::normal`] of which the first `word` is drawn.
    #[inline(never)]
    fn normal_from(&mut self, mut word: u64) -> f64 {
        loop {
            let (layer, part) = layer_of(word);
            let value = part * self.ziggurat.edge[layer];
            if value.abs() < self.ziggurat.edge[layer + 1] {
                return value;
            }
            if layer == 0 {
                return self.tail(part < 0.0);
            }
            let (low, high) = (self.ziggurat.density[layer], self.ziggurat.density[layer + 1]);
            if low + self.uniform() * (high - low) < density(value) {
                return value;
            }
            word = self.words.next_u64();
        }
    }

    /// Beyond the last layer: Marsaglia (1964).
    fn tail(&mut self, negative: bool) -> f64 {
        loop {
            let beyond = -math::ln(1.0 - self.uniform()) / LAST_EDGE;
            let height = -math::ln(1.0 - self.uniform());
            if 2.0 * height >= beyond * beyond {
                return if negative { -LAST_EDGE - beyond } else { LAST_EDGE + beyond };
            }
        }
    }
}

/// Layer of the ziggurat, and place in it from −1 to 1. The layer comes from bits that the place does not use: Leong et al. (2005), J. Stat.
/// Softw. 12(7).
#[inline(always)]
fn layer_of(word: u64) -> (usize, f64) {
    ((word & 127) as usize, 2.0 * unit(word) - 1.0)
}

#[inline(always)]
fn unit(word: u64) -> f64 {
    // Of 53 bits: signed numbers are converted at once.
    (word >> 11).cast_signed() as f64 / (1_u64 << 53) as f64
}

/// Right edge of the outermost layer of a ziggurat of 128.
const LAST_EDGE: f64 = 3.442_619_855_899;
/// Area of each of its layers under exp(−x²/2).
const LAYER_AREA: f64 = 9.912_563_035_262_17e-3;

/// Layers of equal area over half the normal density, from the outermost in: Marsaglia and Tsang (2000), J. Stat. Softw. 5(8), with
/// doubles as in Doornik (2005). Nearly every draw needs no logarithm or sine, which counts at 8000 readings a second.
#[derive(Debug)]
struct Ziggurat {
    edge: [f64; 129],
    /// exp(−x²/2) at the edges.
    density: [f64; 129],
}

fn density(x: f64) -> f64 {
    math::exp(-0.5 * x * x)
}

static ZIGGURAT: LazyLock<Ziggurat> = LazyLock::new(|| {
    let mut edge = [0.0; 129];
    edge[0] = LAYER_AREA / density(LAST_EDGE);
    edge[1] = LAST_EDGE;
    for layer in 2..128 {
        let outer: f64 = edge[layer - 1];
        edge[layer] = math::square_root(-2.0 * math::ln(LAYER_AREA / outer + density(outer)));
    }
    Ziggurat { edge, density: edge.map(density) }
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_deviates_have_the_moments_and_tails_of_the_normal_distribution() {
        let mut random = Random::new(1, 0, Purpose::Noise);
        let count = 2_000_000;
        let mut sums = [0.0; 4];
        let mut within = [0_u32; 4];
        for _ in 0..count {
            let value = random.normal();
            let mut power = 1.0;
            for sum in &mut sums {
                power *= value;
                *sum += power / f64::from(count);
            }
            for (sigma, within) in within.iter_mut().enumerate() {
                *within += u32::from(value.abs() < sigma as f64 + 1.0);
            }
        }
        // Five standard errors of each.
        for (moment, (expected, allowed)) in sums.iter().zip([(0.0, 0.0035), (1.0, 0.005), (0.0, 0.0137), (3.0, 0.0346)]) {
            assert!((moment - expected).abs() < allowed, "{moment} {expected}");
        }
        for (within, expected) in within.iter().zip([0.682_689_5, 0.954_499_7, 0.997_300_2, 0.999_936_7]) {
            let deviation = (expected * (1.0 - expected) / f64::from(count)).sqrt();
            assert!((f64::from(*within) / f64::from(count) - expected).abs() < 5.0 * deviation, "{within} {expected}");
        }
    }

    #[test]
    fn layers_close_at_the_top_and_the_numbers_never_change() {
        // The innermost layer has the same area as the others only if the constants fit each other.
        let last = ZIGGURAT.edge[127];
        assert!((last * (1.0 - math::exp(-0.5 * last * last)) - LAYER_AREA).abs() < 1e-9);
        assert!(ZIGGURAT.edge.windows(2).all(|edges| edges[0] > edges[1]));
        let mut random = Random::new(7, 3, Purpose::Drift);
        let first: Vec<u64> = (0..3).map(|_| random.normal().to_bits()).collect();
        assert_eq!(first, [0x3fed_224d_8c6a_236f, 0xbfe0_11b7_f44b_5f50, 0x3fee_06e9_459b_4d6b]);
    }

    #[test]
    fn streams_differ_by_seed_axis_and_purpose() {
        let first = |seed, axis, purpose| Random::new(seed, axis, purpose).uniform().to_bits();
        let words = [
            first(1, 0, Purpose::TurnOn),
            first(1, 0, Purpose::Noise),
            first(1, 0, Purpose::Drift),
            first(1, 0, Purpose::Clock),
            first(1, 1, Purpose::TurnOn),
            first(2, 0, Purpose::TurnOn),
        ];
        for (index, word) in words.iter().enumerate() {
            assert!(!words[..index].contains(word));
        }
    }
}
