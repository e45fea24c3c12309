//! Fragilities: degenerate data, invariances, and known parameters found again.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sprag_shared::math::{exp, ln};

use super::*;

fn observations(counts: &[(f64, u32, u32)]) -> Vec<Observation> {
    counts.iter().map(|&(intensity, overturned, of)| Observation { intensity, overturned, of }).collect()
}

fn of(counts: &[(f64, u32, u32)]) -> Fragility {
    fragility(&observations(counts)).unwrap()
}

fn curve(counts: &[(f64, u32, u32)]) -> FragilityCurve {
    *of(counts).curve().unwrap()
}

/// Logarithms of the probabilities of overturning and of standing.
fn ln_probabilities(curve: &FragilityCurve, intensity: f64) -> [f64; 2] {
    let z = (ln(intensity) - curve.mu) / curve.beta;
    [z, -z].map(normal::ln_cumulative)
}

const ORDINARY: [(f64, u32, u32); 5] = [(0.5, 1, 20), (0.8, 4, 20), (1.1, 9, 20), (1.5, 15, 20), (2.0, 19, 20)];

#[test]
fn runs_of_one_outcome_have_no_fragility() {
    let never = of(&[(1.0, 0, 3), (3.0, 0, 1), (2.0, 0, 1)]);
    assert_eq!(never, Fragility::NeverOverturned { number: 5, highest: 3.0 });
    assert!(never.reason().unwrap().starts_with("none of 5 runs overturned, up to an intensity of 3"));
    let always = of(&[(2.0, 3, 3), (1.0, 1, 1)]);
    assert_eq!(always, Fragility::AlwaysOverturned { number: 4, lowest: 1.0 });
    // One intensity with one outcome is that outcome.
    assert_eq!(of(&[(2.0, 0, 3)]), Fragility::NeverOverturned { number: 3, highest: 2.0 });
}

#[test]
fn one_intensity_has_no_slope() {
    assert_eq!(of(&[(2.0, 1, 3), (2.0, 1, 1)]), Fragility::SingleIntensity { intensity: 2.0, number: 4, overturned: 2 });
}

#[test]
fn separated_runs_have_no_dispersion() {
    let separated = of(&[(1.0, 0, 3), (3.0, 2, 2), (2.0, 0, 1)]);
    assert_eq!(separated, Fragility::Separated { highest_stood: 2.0, lowest_overturned: 3.0 });
    let tie = of(&[(1.0, 0, 3), (2.0, 1, 3), (3.0, 2, 2)]);
    assert_eq!(tie, Fragility::QuasiSeparated { intensity: 2.0, number: 3, overturned: 1 });
    // The tie may be the end of the data.
    assert_eq!(of(&[(1.0, 0, 3), (2.0, 1, 3)]), Fragility::QuasiSeparated { intensity: 2.0, number: 3, overturned: 1 });
    assert_eq!(of(&[(2.0, 1, 3), (3.0, 1, 1)]), Fragility::QuasiSeparated { intensity: 2.0, number: 3, overturned: 1 });
    // A small overlap suffices, but for one of rounding.
    let overlap = |by: f64| of(&[(1.0, 0, 3), (2.0, 1, 1), (2.0 * (1.0 + by), 0, 1), (3.0, 2, 2)]);
    assert!(overlap(1e-9).curve().is_some());
    assert_eq!(overlap(1e-15), Fragility::QuasiSeparated { intensity: 2.0, number: 2, overturned: 1 });
}

#[test]
fn a_fragility_that_does_not_rise_is_none() {
    for falling in [
        // Separated the other way, with and without a tie; overlapping; and with no trend at all.
        of(&[(1.0, 2, 2), (2.0, 0, 2)]),
        of(&[(1.0, 2, 2), (2.0, 1, 2), (3.0, 0, 1)]),
        of(&[(1.0, 3, 4), (2.0, 2, 4), (3.0, 1, 4)]),
        of(&[(1.0, 1, 4), (2.0, 1, 4), (3.0, 1, 4)]),
    ] {
        assert!(matches!(falling, Fragility::SlopeNotPositive { .. }), "{falling:?}");
        assert!(falling.reason().unwrap().contains("does not become likelier"));
    }
    let Fragility::SlopeNotPositive { mean_ln_stood, mean_ln_overturned } = of(&[(1.0, 2, 2), (2.0, 0, 2)]) else { panic!() };
    assert_eq!((mean_ln_stood, mean_ln_overturned), (std::f64::consts::LN_2, 0.0));
    // So flat that e^μ is no number: one in four overturn, a little more of 4e6 at twice the intensity.
    let flat = of(&[(1.0, 1_000_000, 4_000_000), (2.0, 1_000_001, 4_000_000)]);
    assert!(matches!(flat, Fragility::SlopeNotPositive { .. }), "{flat:?}");
}

#[test]
fn wrong_observations_are_named() {
    let error = fragility(&observations(&[(1.0, 0, 1), (-1.0, 0, 1)])).unwrap_err();
    assert_eq!(error.to_string(), "intensity -1 of observation 1: allowed is more than 0 and finite");
}

#[test]
fn the_unit_of_the_intensity_shifts_mu_alone() {
    let plain = curve(&ORDINARY);
    for unit in [9.80665, 1e-6, 1e100] {
        let scaled = curve(&ORDINARY.map(|(intensity, overturned, of)| (unit * intensity, overturned, of)));
        assert!((scaled.mu - plain.mu - ln(unit)).abs() < 1e-12 * ln(unit).abs().max(1.0));
        assert!((scaled.beta / plain.beta - 1.0).abs() < 1e-11);
        assert!((scaled.covariance[0][0] / plain.covariance[0][0] - 1.0).abs() < 1e-10);
        assert!((scaled.ln_likelihood / plain.ln_likelihood - 1.0).abs() < 1e-12);
        assert!((scaled.probability(unit * 0.9) / plain.probability(0.9) - 1.0).abs() < 1e-11);
    }
}

#[test]
fn order_and_grouping_change_no_bit() {
    let mut cloud = Vec::new();
    for (intensity, overturned, of) in ORDINARY.into_iter().rev() {
        cloud.extend((0..of).map(|run| (intensity, u32::from(run < overturned), 1)));
    }
    assert_eq!(of(&cloud), of(&ORDINARY));
}

#[test]
fn outcomes_turned_round_mirror_the_curve() {
    // With 1/IM and the other outcome, P becomes 1 − P: μ changes its sign.
    let plain = curve(&ORDINARY);
    let turned = curve(&ORDINARY.map(|(intensity, overturned, of)| (1.0 / intensity, of - overturned, of)));
    assert!((turned.mu + plain.mu).abs() < 1e-14 && (turned.beta / plain.beta - 1.0).abs() < 1e-13);
    assert!((turned.covariance[0][1] + plain.covariance[0][1]).abs() < 1e-14);
}

#[test]
fn the_score_is_zero_and_the_information_is_its_slope() {
    let found = curve(&ORDINARY);
    let ln_likelihood = |mu: f64, beta: f64| -> f64 {
        let shifted = FragilityCurve { mu, beta, ..found };
        ORDINARY
            .iter()
            .map(|&(intensity, overturned, of)| {
                let [over, stand] = ln_probabilities(&shifted, intensity);
                f64::from(overturned) * over + f64::from(of - overturned) * stand
            })
            .sum()
    };
    assert!((ln_likelihood(found.mu, found.beta) - found.ln_likelihood).abs() < 1e-12);
    let h = 1e-4;
    let at = |i: i32, j: i32| ln_likelihood(found.mu + f64::from(i) * h, found.beta + f64::from(j) * h);
    assert!((at(1, 0) - at(-1, 0)).abs() / (2.0 * h) < 1e-5 && (at(0, 1) - at(0, -1)).abs() / (2.0 * h) < 1e-5);
    let a = (2.0 * at(0, 0) - at(1, 0) - at(-1, 0)) / (h * h);
    let b = (2.0 * at(0, 0) - at(0, 1) - at(0, -1)) / (h * h);
    let c = (at(1, -1) + at(-1, 1) - at(1, 1) - at(-1, -1)) / (4.0 * h * h);
    let determinant = a * b - c * c;
    let [[mu, mixed], [_, beta]] = found.covariance;
    assert!((b / determinant / mu - 1.0).abs() < 1e-4 && (a / determinant / beta - 1.0).abs() < 1e-4);
    assert!((-c / determinant - mixed).abs() < 1e-4 * mu);
    assert_eq!([found.mu_standard_error, found.beta_standard_error], [mu.sqrt(), beta.sqrt()]);
}

#[test]
fn known_parameters_are_found_again() {
    // Deviations from the truth in standard errors, over forty samples of 2000 runs: their mean square is 1 with a spread of
    // 0.22.
    let (mu, beta) = (0.3, 0.4);
    let mut squares = [0.0; 2];
    for seed in 0..40 {
        let mut words = ChaCha8Rng::seed_from_u64(seed);
        let mut uniform = || (words.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        let sample: Vec<Observation> = (0..2000)
            .map(|_| {
                let intensity = exp(mu + 3.0 * beta * (uniform() - 0.5));
                let overturned = uniform() < normal::cumulative((ln(intensity) - mu) / beta);
                Observation { intensity, overturned: overturned.into(), of: 1 }
            })
            .collect();
        let found = *fragility(&sample).unwrap().curve().unwrap();
        let deviations = [(found.mu - mu) / found.mu_standard_error, (found.beta - beta) / found.beta_standard_error];
        assert!(deviations.iter().all(|deviation| deviation.abs() < 4.0), "{deviations:?}");
        squares.iter_mut().zip(deviations).for_each(|(square, deviation)| *square += deviation * deviation / 40.0);
    }
    assert!(squares.iter().all(|square| (square - 1.0).abs() < 0.9), "{squares:?}");
}

#[test]
fn a_run_far_on_the_wrong_side_counts_with_its_full_weight() {
    // One run at 1e-30 that overturned: z is far beyond where Φ underflows on the way, and the maximum is found all the same.
    let mut far = ORDINARY.map(|(intensity, overturned, of)| (intensity, 1000 * overturned, 1000 * of)).to_vec();
    let without = curve(&far);
    far.push((1e-30, 1, 1));
    let with = curve(&far);
    assert!(with.beta > without.beta && with.ln_likelihood < without.ln_likelihood - 500.0, "{with:?}");
}

#[test]
fn results_name_what_they_are() {
    let json = serde_json::to_value(of(&ORDINARY)).unwrap();
    assert_eq!((&json["status"], &json["number"]), (&"estimated".into(), &100.into()));
    let json = serde_json::to_value(of(&[(1.0, 0, 3), (3.0, 2, 2)])).unwrap();
    assert_eq!((&json["status"], &json["lowest_overturned"]), (&"separated".into(), &3.0.into()));
    assert!(of(&ORDINARY).to_string().starts_with("median 1.1") && of(&ORDINARY).reason().is_none());
}

#[test]
fn every_data_set_is_estimated_or_has_a_reason() {
    // Few runs in clusters of all sizes, where separation is a matter of the last digits; many and few runs
    // at a place; intensities up to both ends of what an f64 holds.
    let mut words = ChaCha8Rng::seed_from_u64(3);
    let mut below = |limit: u64| words.next_u64() % limit;
    let (mut estimated, mut nearest) = (0, f64::INFINITY);
    for round in 0..20_000 {
        let runs = 3 + below(6);
        let sample: Vec<(f64, u32, u32)> = (0..runs)
            .map(|_| {
                let gap = exp(-(below(37) as f64)) * below(4) as f64;
                let intensity = match round % 4 {
                    0 => exp(below(1450) as f64 - 740.0),
                    1 => [0.5, 1.0, 2.0][below(3) as usize] * (1.0 + gap),
                    _ => 1.0 + gap,
                };
                let of = [1, 1, 3, u32::MAX][below(if round % 3 == 0 { 4 } else { 3 }) as usize];
                (intensity, (below(u64::from(of) + 1)) as u32, of)
            })
            .collect();
        let found = fragility(&observations(&sample)).unwrap_or_else(|error| panic!("{error}: {sample:?}"));
        let Some(curve) = found.curve() else { continue };
        estimated += 1;
        nearest = nearest.min(curve.beta);
        let stripes = observation::Stripes::of(&observations(&sample)).unwrap();
        let at = |mu: f64, beta: f64| -> f64 {
            let shifted = FragilityCurve { mu, beta, ..*curve };
            let parts = stripes.all.iter().flat_map(|stripe| {
                let [over, stand] = ln_probabilities(&shifted, stripe.intensity);
                // Not 0·∞.
                [(stripe.overturned, over), (stripe.stood, stand)]
                    .map(|(count, ln)| if count > 0 { count as f64 * ln } else { 0.0 })
            });
            parts.sum()
        };
        let maximum = at(curve.mu, curve.beta);
        let slack = 1e-9 * maximum.abs();
        for (up, along) in [(0.1, 0.0), (-0.1, 0.0), (0.0, 0.1), (0.0, -0.1), (0.1, 0.1), (-0.1, 0.1)] {
            let (mu, beta) = (curve.mu + up * curve.mu_standard_error, curve.beta + along * curve.beta_standard_error);
            assert!(beta <= 0.0 || at(mu, beta) <= maximum + slack, "{found:?} {sample:?}");
        }
    }
    assert!(estimated > 4000 && nearest < 1e-9, "{estimated} {nearest:e}");
}
