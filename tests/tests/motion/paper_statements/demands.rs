//! Section 5 and the conclusions on single pulses: demands over the maps of Figures 11 and 12, and their slender counterparts.

use super::say;
use super::spectra::{Cell, INERTER, NONE, PAIR, Ratios, SPECTRA, Spectra};

/// Bands of amplitude.
const BANDS: [(f64, f64); 5] = [(1.0, 2.0), (2.0, 4.0), (4.0, 6.0), (6.0, 8.0), (8.0, 10.0)];

fn in_band((above, to): (f64, f64)) -> impl Fn(&Cell) -> bool {
    move |cell| cell.amplitude > above && cell.amplitude <= to
}

/// One inerter lowers rotations and accelerations; of the acceleration it takes off more the stronger the pulse, but the same share.
#[test]
fn one_inerter_lowers_both_demands() {
    for map in SPECTRA.iter() {
        let all = map.ratios(INERTER, NONE, |_| true);
        say("5.3", &map.name, &format!("inerter over none: {all}"));
        assert!(
            (0.70..0.76).contains(&all.rotation.median()) && (0.72..0.76).contains(&all.acceleration.median()),
            "{}",
            map.name
        );
        assert!(all.rotation.below(1.0) > 99.5 && all.acceleration.below(1.0) > 99.5, "{}", map.name);
        let (mut shares, mut amounts) = (Vec::new(), Vec::new());
        for band in BANDS {
            let share = map.ratios(INERTER, NONE, in_band(band)).acceleration.median();
            let amount = map.taken_off(INERTER, NONE, in_band(band)).median();
            say(
                "5.4",
                &map.name,
                &format!("amplitude {} to {}: max |θ̈|/(p²α) x {share:.3}, lower by {amount:.2}", band.0, band.1),
            );
            shares.push(share);
            amounts.push(amount);
        }
        assert!(amounts.is_sorted() && amounts[4] > 3.0 * amounts[0], "{}: {amounts:?}", map.name);
        assert!(shares.iter().all(|share| (share / shares[0] - 1.0).abs() < 0.04), "{}: {shares:?}", map.name);
    }
}

/// Over none and over the inerter, band by band.
fn pair(map: &Spectra) -> Vec<[Ratios; 2]> {
    BANDS.map(|band| [NONE, INERTER].map(|reference| map.ratios(PAIR, reference, in_band(band)))).into_iter().collect()
}

/// With the clutch demands depend on pulse and amplitude.
#[test]
fn a_clutched_pair_depends_on_pulse_and_amplitude() {
    for map in SPECTRA.iter() {
        let bands = pair(map);
        for (band, [over_none, over_inerter]) in BANDS.iter().zip(&bands) {
            say("5.5", &map.name, &format!("amplitude {} to {}, pair over none: {over_none}", band.0, band.1));
            say("5.5", &map.name, &format!("amplitude {} to {}, pair over inerter: {over_inerter}", band.0, band.1));
        }
        let rotation = |band: usize| bands[band][1].rotation.median();
        let acceleration = |band: usize| bands[band][0].acceleration.median();
        // Below the inerter under weak pulses, above it under strong ones.
        assert!(rotation(0) < 0.95 && rotation(3) > 1.05 && rotation(4) > 1.05, "{}", map.name);
        // Most of what the inerter takes off the acceleration is gone, and under strong sines more than all of it.
        assert!(acceleration(0) < 0.9 && acceleration(4) > 0.98, "{}", map.name);
        assert_eq!(acceleration(4) > 1.0, map.name.ends_with(" sine"), "{}", map.name);
    }
}

/// The conclusions: the clutch lowers rotations further under sines for the most part, under cosines only under weak pulses; accelerations
/// rise with it.
#[test]
fn the_conclusions_on_the_clutch_hold_in_part() {
    for map in SPECTRA.iter() {
        let all = map.ratios(PAIR, INERTER, |_| true);
        say("7.5", &map.name, &format!("pair over inerter: {all}"));
        say("7.5", &map.name, &format!("pair over none: {}", map.ratios(PAIR, NONE, |_| true)));
        let lower = all.rotation.below(1.0);
        if map.name.ends_with(" sine") {
            assert!((55.0..75.0).contains(&lower), "{}: {lower}", map.name);
        } else {
            assert!((25.0..45.0).contains(&lower), "{}: {lower}", map.name);
        }
        assert!(all.acceleration.below(1.0) < 15.0, "{}", map.name);
    }
}

/// Under sines near the threshold the pair's accelerations are not the inerter's; from 1.6 times the threshold to twice they are.
#[test]
fn accelerations_under_weak_sines() {
    for map in SPECTRA.iter().filter(|map| map.name.ends_with(" sine")) {
        for band in [(1.0, 1.2), (1.2, 1.6), (1.6, 2.0)] {
            let found = map.ratios(PAIR, INERTER, in_band(band)).acceleration;
            say("5.13", &map.name, &format!("amplitude {} to {}, pair over inerter: acceleration {found}", band.0, band.1));
            match band.0 {
                1.0 => assert!(found.median() > 1.15),
                1.2 => assert!((0.94..0.98).contains(&found.median())),
                _ => assert!(found.quantile(0.05) > 0.97 && found.quantile(0.95) < 1.02),
            }
        }
    }
}
