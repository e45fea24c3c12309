//! Self-similarity: Figures 6 and 7.

use sprag_studies::similarity::compare::Departure;
use sprag_tests::shipped::responses;

/// Departures of the second block of a figure from the first, device by device.
fn departures(scene: &str, second: &[&str]) -> Vec<Departure> {
    let step = 0.01;
    let ((groups, first), (other_groups, other)) = (responses(scene, &[], step), responses(scene, second, step));
    assert!(groups.iter().zip(&other_groups).all(|(a, b)| a.equals(b)), "{groups:?} {other_groups:?}");
    first.iter().zip(&other).map(|(first, other)| Departure::between(first, other)).collect()
}

#[test]
fn slender_blocks_of_equal_groups_are_one() {
    for second in [["block.size_m=5", "block.slenderness_deg=5"], ["block.size_m=0.1", "block.slenderness_deg=30"]] {
        for departure in departures("figure06.toml", &second) {
            assert!(departure.largest < 1e-9, "{departure:?}");
        }
    }
}

/// "practically self-similar" with a single inerter, "non or less self-similar" with the pair.
#[test]
fn full_blocks_are_nearly_one_with_an_inerter_and_less_with_a_clutched_pair() {
    let departures = departures("figure07.toml", &["block.size_m=5", "block.slenderness_deg=20"]);
    println!("{departures:?}");
    let [inerter, pair] = departures[..] else { panic!("two devices: {departures:?}") };
    assert!(pair.largest > inerter.largest && inerter.largest > 1e-4, "{inerter:?} {pair:?}");
}
