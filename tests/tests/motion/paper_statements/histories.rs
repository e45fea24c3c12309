//! Section 4: the histories of Figures 9 and 10, slender blocks under sines.

use core::f64::consts::{PI, TAU};

use sprag_shared::motion::observer::Event;
use sprag_shared::motion::state::Phase;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_sim::batch::case::PulseShape;
use sprag_tests::pulse::Pulsed;
use sprag_tests::{boundary, overturned_without_impact};

use super::say;

const FREQUENCY_9: f64 = 3.0;
const FREQUENCY_10: f64 = 6.0;

fn pulsed(device: DeviceKind, frequency: f64, amplitude: f64) -> Pulsed {
    Pulsed { geometry: Geometry::Slender, degrees: 10.0, device, shape: PulseShape::Sine, frequency, amplitude }
}

/// Time after which a motion is decided, 1/p.
fn decided(frequency: f64) -> f64 {
    TAU / frequency + 60.0
}

/// The inerter and the pair move as one until the clutch releases; only the pair comes back, and it turns without an impact.
#[test]
fn figure_9() {
    let [none, inerter, pair] = DeviceKind::ALL.map(|device| pulsed(device, FREQUENCY_9, 5.22));
    for (pulsed, name) in [(none, "none"), (inerter, "inerter"), (pair, "pair")] {
        let (state, log) = pulsed.follow(decided(FREQUENCY_9));
        let peak = log.peaks.rotation / pulsed.degrees.to_radians();
        say(
            "4.13",
            name,
            &format!(
                "{:?}, {} impacts, peak |θ|/α {peak:.4}, turns at p t = {:.3?}",
                state.phase,
                state.impacts,
                log.times(Event::Turn).first()
            ),
        );
        assert_eq!(state.phase == Phase::Overturned, pulsed.device != DeviceKind::ClutchedPair, "{name}");
        let falls = boundary(2.0, 9.0, |amplitude| {
            overturned_without_impact(&Pulsed { amplitude, ..pulsed }.follow(decided(FREQUENCY_9)).0)
        });
        say("4.13", name, &format!("overturns without an impact from an amplitude of {falls:.4}"));
    }
    let released = pair.follow(decided(FREQUENCY_9)).1.times(Event::Switch)[0];
    let alike = |time: f64| {
        let (a, b) = (inerter.follow(time).0, pair.follow(time).0);
        ((a.rotation - b.rotation).abs() / inerter.degrees.to_radians(), a.rotation)
    };
    let ((until, rotation), (after, _)) = (alike(released), alike(released + 0.5));
    say(
        "4.12",
        "inerter, pair",
        &format!(
            "apart by {until:.0e} α until the release at p t = {released:.4} (θ/α = {:.3}), by {after:.3} α 0.5/p later",
            rotation / inerter.degrees.to_radians()
        ),
    );
    assert!(until < 1e-12 && after > 0.05);
}

/// The paper's pulse falls 0.1 % short of overturning the pair; and every first impact comes after the pulse.
#[test]
fn figure_10() {
    let (reversal, end) = (PI / FREQUENCY_10, TAU / FREQUENCY_10);
    let mut impacts = Vec::new();
    let mut returning = Vec::new();
    for (device, name) in DeviceKind::ALL.into_iter().zip(["none", "inerter", "pair"]) {
        let pulsed = pulsed(device, FREQUENCY_10, 7.7);
        let alpha = pulsed.degrees.to_radians();
        let (state, log) = pulsed.follow(decided(FREQUENCY_10));
        let impact = log.times(Event::Impact)[0];
        let turn = log.times(Event::Turn)[0];
        let [at_reversal, at_end] = [reversal, end].map(|time| pulsed.follow(time).0);
        say("4.19", name, &format!("{:?}, peak |θ|/α {:.4}", state.phase, log.peaks.rotation / alpha));
        say(
            "4.20",
            name,
            &format!(
                "pulse reverses at p t = {reversal:.3} and ends at {end:.3}; first impact at {impact:.3}, {:.2} of the pulse",
                impact / end
            ),
        );
        say(
            "4.21",
            name,
            &format!(
                "θ̇/(pα) at the reversal {:.3}, turns at p t = {turn:.3}, θ̇/(pα) at the end {:.3}, before the impact {:.3}",
                at_reversal.velocity / alpha,
                at_end.velocity / alpha,
                log.states(Event::Impact)[0].velocity / (0.85 * alpha),
            ),
        );
        assert_eq!(state.phase, Phase::Rest, "{name}");
        assert!(impact > 1.4 * end && reversal < turn && turn < end, "{name}");
        impacts.push(impact);
        returning.push(at_end.velocity / alpha);
    }
    assert!(impacts[0] > impacts[1] && impacts[1] > impacts[2], "{impacts:?}");
    assert!(returning[2] > 1.7 * returning[0] && returning[2] > 1.7 * returning[1], "{returning:?}");
    let falls = boundary(7.6, 7.8, |amplitude| {
        pulsed(DeviceKind::ClutchedPair, FREQUENCY_10, amplitude).follow(decided(FREQUENCY_10)).0.phase == Phase::Overturned
    });
    say("4.19", "pair", &format!("overturns from an amplitude of {falls:.4}"));
    assert!((7.705..7.71).contains(&falls));
}
