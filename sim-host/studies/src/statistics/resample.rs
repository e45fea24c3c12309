//! Drawn with replacement from all that there are.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::observation::{Stripe, Stripes};

/// Number of the first stream. Lower ones of the same seed belong to ground motions and sensors.
const FIRST_STREAM: u64 = 1 << 48;

/// Numbers below `number`, each as likely as any other, by the stream of resample `index` of `seed`.
pub(super) fn draws(seed: u64, index: u32, number: u64) -> impl Iterator<Item = u64> {
    let mut words = ChaCha8Rng::seed_from_u64(seed);
    words.set_stream(FIRST_STREAM + u64::from(index));
    std::iter::repeat_with(move || below(words.next_u64(), number))
}

/// The number below `number` that a random `word` gives: each as likely as any other to within number/2⁶⁴.
pub(crate) fn below(word: u64, number: u64) -> u64 {
    ((u128::from(word) * u128::from(number)) >> 64) as u64
}

/// Single runs to draw from.
pub(super) struct Cases {
    stripes: Stripes,
    /// For every stripe the runs up to its last that overturned and up to its last that stood.
    ends: Vec<u64>,
}

impl Cases {
    /// The runs of `stripes`.
    pub fn of(stripes: Stripes) -> Cases {
        let counts = stripes.all.iter().flat_map(|stripe| [stripe.overturned, stripe.stood]);
        let mut end = 0;
        let ends = counts
            .map(|count| {
                end += count;
                end
            })
            .collect();
        Cases { stripes, ends }
    }

    /// As many runs as there are, drawn with replacement by the stream of resample `index`.
    pub fn resample(&self, seed: u64, index: u32) -> Stripes {
        let number = self.stripes.number();
        let mut drawn: Vec<Stripe> =
            self.stripes.all.iter().map(|stripe| Stripe { overturned: 0, stood: 0, ..*stripe }).collect();
        for case in draws(seed, index, number).take(number as usize) {
            let place = self.ends.partition_point(|end| *end <= case);
            let stripe = &mut drawn[place / 2];
            let count = if place % 2 == 0 { &mut stripe.overturned } else { &mut stripe.stood };
            *count += 1;
        }
        Stripes::gathered(drawn)
    }
}

#[cfg(test)]
mod tests {
    use super::super::observation::Observation;
    use super::*;

    #[test]
    fn every_run_is_drawn_as_often_as_any_other() {
        let runs = [(1.0, 0, 3), (2.0, 1, 2), (3.0, 5, 5)];
        let observations = runs.map(|(intensity, overturned, of)| Observation { intensity, overturned, of });
        let cases = Cases::of(Stripes::of(&observations).unwrap());
        let mut counts = [[0_u64; 2]; 3];
        for index in 0..10_000 {
            let drawn = cases.resample(3, index);
            assert_eq!(drawn.number(), 10);
            for stripe in drawn.all {
                let place = stripe.intensity as usize - 1;
                counts[place][0] += stripe.overturned;
                counts[place][1] += stripe.stood;
            }
        }
        // 100,000 draws from ten runs: 10,000 each, within five standard deviations.
        for (count, runs) in counts.into_iter().flatten().zip([0.0, 3.0, 1.0, 1.0, 5.0, 0.0]) {
            let deviation = (1e5_f64 * runs / 10.0 * (1.0 - runs / 10.0)).sqrt();
            assert!((count as f64 - 1e4 * runs).abs() <= 5.0 * deviation, "{counts:?}");
        }
    }

    #[test]
    fn resamples_differ_and_never_change() {
        let observations = [1.0, 2.0].map(|intensity| Observation { intensity, overturned: 50, of: 100 });
        let cases = Cases::of(Stripes::of(&observations).unwrap());
        let drawn = |seed, index| {
            let counts = cases.resample(seed, index).all;
            [counts[0].overturned, counts[0].stood, counts[1].overturned, counts[1].stood]
        };
        assert_eq!(drawn(1, 0), drawn(1, 0));
        assert_ne!(drawn(1, 0), drawn(1, 1));
        assert_ne!(drawn(1, 0), drawn(2, 0));
        assert_eq!(drawn(7, 5), [49, 56, 45, 50]);
    }
}
