//! Section 5, Figure 13: cuts at two amplitudes, of full blocks as in the figure and of slender ones, which the paper finds similar.

use sprag_shared::observers::outcome::Outcome;

use super::say;
use super::spectra::{Cell, DEVICES, INERTER, KINDS, NONE, PAIR, REGION_1, Ratios, Spectra};

/// Over which ω_g/p blocks with both devices stand: the lowest of the uppermost stretch.
fn from(cut: &Spectra, device: usize) -> f64 {
    let last = cut.cells.iter().rposition(|cell| cell.overturns(device)).expect("a block that overturns");
    cut.cells[last + 1].frequency
}

/// Ratios of a panel: of the inerter and the pair to none, and of the pair to the inerter; over the uppermost stretch in which both stand.
struct Panel {
    cut: Spectra,
    inerter: Ratios,
    pair: Ratios,
    clutch: Ratios,
}

fn panel(statements: &str, kind: (&str, &str), amplitude: f64) -> Panel {
    let cut = Spectra::cut(kind, amplitude);
    let ratios = |device: usize, reference: usize| {
        let from = from(&cut, device).max(from(&cut, reference));
        cut.ratios(device, reference, |cell| cell.frequency >= from)
    };
    let (inerter, pair, clutch) = (ratios(INERTER, NONE), ratios(PAIR, NONE), ratios(PAIR, INERTER));
    for (name, ratios) in [("inerter over none", &inerter), ("pair over none", &pair), ("pair over inerter", &clutch)] {
        say(statements, &cut.name, &format!("{name}: {ratios}"));
    }
    let stand = DEVICES.map(|(device, _)| cut.count(|cell| cell.stands(device)));
    let stretches = DEVICES.map(|(device, _)| from(&cut, device));
    say(
        statements,
        &cut.name,
        &format!("of {} stand: none, inerter, pair {stand:?}; all above ω_g/p = {stretches:.2?} do", cut.cells.len()),
    );
    Panel { cut, inerter, pair, clutch }
}

fn panels(statements: &str, pulse: &str, amplitude: f64) -> impl Iterator<Item = Panel> {
    KINDS.into_iter().filter(move |kind| kind.1 == pulse).map(move |kind| panel(statements, kind, amplitude))
}

#[test]
fn weak_cosines() {
    for Panel { cut, clutch, .. } in panels("5.6-7", "cosine", 2.0) {
        // 5.6: a little less rotation, everywhere; 5.7: more acceleration, everywhere.
        assert!((0.92..0.99).contains(&clutch.rotation.median()) && clutch.rotation.below(1.0) == 100.0, "{}", cut.name);
        assert!(clutch.acceleration.median() > 1.1 && clutch.acceleration.below(1.0) == 0.0, "{}", cut.name);
    }
}

#[test]
fn strong_cosines() {
    for Panel { cut, inerter, pair, clutch } in panels("5.8-9", "cosine", 8.0) {
        let crossing = cut.cells.windows(2).rev().find(|cells| {
            let above = |cell: &Cell| cell.results[PAIR].peak_rotation > cell.results[INERTER].peak_rotation;
            above(&cells[1]) && !above(&cells[0])
        });
        let crossing = crossing.expect("a crossing")[1].frequency;
        say("5.8", &cut.name, &format!("the pair rotates more than the inerter from ω_g/p = {crossing:.2} on, less below"));
        // 5.8: more than with the inerter from a frequency on, never as much as without a device.
        assert!((3.0..3.6).contains(&crossing) && clutch.rotation.median() > 1.1, "{}", cut.name);
        assert!(pair.rotation.below(1.0) == 100.0 && pair.rotation.median() > inerter.rotation.median() + 0.1, "{}", cut.name);
        // 5.9: next to nothing is left of what the inerter took off the acceleration.
        assert!((0.98..1.0).contains(&pair.acceleration.median()) && inerter.acceleration.median() < 0.76, "{}", cut.name);
    }
}

#[test]
fn weak_sines() {
    for Panel { cut, clutch, .. } in panels("5.10", "sine", 2.0) {
        // 5.10: less rotation, everywhere; 5.13: the same acceleration.
        assert!((0.85..0.93).contains(&clutch.rotation.median()) && clutch.rotation.below(1.0) == 100.0, "{}", cut.name);
        assert!(clutch.acceleration.quantile(0.0) > 0.98 && clutch.acceleration.quantile(1.0) < 1.02, "{}", cut.name);
    }
}

#[test]
fn strong_sines() {
    for Panel { cut, pair, clutch, .. } in panels("5.11", "sine", 8.0) {
        // 5.11: more rotation, everywhere; 5.14: much more acceleration, above that of none.
        assert!(clutch.rotation.median() > 1.1 && clutch.rotation.below(1.0) == 0.0, "{}", cut.name);
        assert!(clutch.acceleration.median() > 1.3 && pair.acceleration.below(1.0) == 0.0, "{}", cut.name);
        // 5.12: fewer frequencies at which the block stands than without a device.
        let [none, inerter, pair] = [NONE, INERTER, PAIR].map(|device| cut.count(|cell| cell.stands(device)));
        assert!(pair < none && none < inerter, "{}", cut.name);
        // 5.15: where both overturn alike, and where only the inerter overturns without an impact.
        let both = |pair: Outcome| cut.count(|cell| cell.outcome(INERTER) == REGION_1 && cell.outcome(PAIR) == pair);
        let (same, safe, later) = (both(REGION_1), both(Outcome::Safe), both(Outcome::OverturnedAfterImpact));
        say(
            "5.15",
            &cut.name,
            &format!(
                "without an impact overturn both in {same} cells, the inerter alone in {} (there the pair stands in {safe})",
                safe + later
            ),
        );
        assert!(same > 0 && safe > 0, "{}", cut.name);
    }
}
