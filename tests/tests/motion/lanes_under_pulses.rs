//! Blocks under pulses in lanes against the core, which follows one at a time.

use std::fmt::Debug;

use sprag_ensemble::machine::{Registers, run};
use sprag_ensemble::plain::PlainBlock;
use sprag_ensemble::pulsed::{PulseResult, PulsedBlock};
use sprag_loops::{Method, Precision};
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_sim::batch::case::{Case, PulseShape, TIGHT};

/// A coarse grid of everything, dense enough that every kind of event occurs.
fn cases(geometry: Geometry, device: DeviceKind, side: u32) -> Vec<Case> {
    let along = |index: u32, low: f64, high: f64| low + (high - low) * f64::from(index) / f64::from(side - 1);
    let mut cases = Vec::new();
    for (slenderness, restitution, mass_ratio) in [(0.35, 0.85, 0.5), (0.1, 0.6, 3.0), (0.6, 0.99, 0.1)] {
        for pulse in [PulseShape::Sine, PulseShape::Cosine] {
            for row in 0..side {
                for column in 0..side {
                    let (frequency_ratio, amplitude_ratio) = (along(column, 0.2, 8.0), along(row, 1.0, 10.0));
                    let case = Case { geometry, device, slenderness, restitution, mass_ratio, pulse, ..Case::default() };
                    cases.push(Case { frequency_ratio, amplitude_ratio, ..case });
                }
            }
        }
    }
    cases
}

/// The lanes against the core, whose free motions are followed for 60/p.
#[test]
fn blocks_in_lanes_do_what_they_do_alone() {
    let method = f64::ideal(Method::Adaptive(TIGHT));
    for geometry in [Geometry::Full, Geometry::Slender] {
        for device in DeviceKind::ALL {
            let cases = cases(geometry, device, 17);
            let pulsed: Vec<PulsedBlock> = cases.iter().map(PulsedBlock::from).collect();
            let results = run(&pulsed, Registers::Widest).unwrap();
            let mut seen = [0; 4];
            for (case, found) in cases.iter().zip(&results) {
                let alone = case.run(&*method).unwrap();
                assert_eq!(found.outcome, alone.outcome, "{case:?}");
                seen[found.outcome as usize] += 1;
                if !alone.outcome.overturned() {
                    for (found, alone) in
                        [(found.peak_rotation, alone.peak_rotation), (found.peak_acceleration, alone.peak_acceleration)]
                    {
                        assert!((found - alone).abs() <= 1e-9 * alone, "{case:?}: {found} {alone}");
                    }
                }
            }
            assert!(seen.iter().all(|&count| count > 20), "{geometry:?} {device:?}: {seen:?}");
        }
    }
}

#[test]
fn bits_depend_neither_on_registers_nor_on_neighbours() {
    for geometry in [Geometry::Full, Geometry::Slender] {
        let mut pulsed: Vec<PulsedBlock> = Vec::new();
        for device in DeviceKind::ALL {
            pulsed.extend(cases(geometry, device, 9).iter().map(PulsedBlock::from));
        }
        have_the_same_bits(pulsed, |pulsed: &[PulsedBlock], registers| -> Vec<(Outcome, u64, u64)> {
            let of = |r: &PulseResult| (r.outcome, r.peak_rotation.to_bits(), r.peak_acceleration.to_bits());
            run(pulsed, registers).unwrap().iter().map(of).collect()
        });
    }
}

/// Expects the same `bits` of what is `asked` in any registers, with and without neighbours, and in any order.
pub fn have_the_same_bits<B, T: PartialEq + Debug>(mut asked: Vec<B>, bits: impl Fn(&[B], Registers) -> Vec<T>) {
    let results = bits(&asked, Registers::Widest);
    assert_eq!(results, bits(&asked, Registers::Baseline));
    let alone: Vec<T> = asked.iter().flat_map(|block| bits(std::slice::from_ref(block), Registers::Widest)).collect();
    assert_eq!(results, alone);
    asked.reverse();
    let mut reversed = bits(&asked, Registers::Widest);
    reversed.reverse();
    assert_eq!(results, reversed);
}

#[test]
fn a_pulse_turned_about_gives_the_mirrored_motion() {
    let pulsed: Vec<PulsedBlock> = cases(Geometry::Full, DeviceKind::ClutchedPair, 7).iter().map(PulsedBlock::from).collect();
    let mirrored: Vec<PulsedBlock> =
        pulsed.iter().map(|block| PulsedBlock { amplitude_ratio: -block.amplitude_ratio, ..*block }).collect();
    let (results, others) = (run(&pulsed, Registers::Widest).unwrap(), run(&mirrored, Registers::Widest).unwrap());
    for (result, other) in results.iter().zip(&others) {
        assert_eq!(result.outcome, other.outcome);
        assert!(result.peak_rotation == other.peak_rotation || result.outcome.overturned());
    }
}

/// On the threshold, just beyond it, with parameters at the ends of their ranges: the core has them.
#[test]
fn what_is_not_plain_is_left_to_the_core() {
    let pulsed = PulsedBlock::from(&Case { amplitude_ratio: 3.0, ..Case::default() });
    let result = |block: PulsedBlock| run(&[block, pulsed], Registers::Widest).map(|results| results[0].outcome);
    assert_eq!(result(PulsedBlock { amplitude_ratio: 1.0, ..pulsed }).unwrap(), Outcome::NoRocking);
    assert_eq!(result(PulsedBlock { amplitude_ratio: 0.5, ..pulsed }).unwrap(), Outcome::NoRocking);
    assert_eq!(result(PulsedBlock { amplitude_ratio: 1.0 + 1e-10, ..pulsed }).unwrap(), Outcome::Safe);
    assert_eq!(
        result(PulsedBlock { plain: PlainBlock { restitution: 0.0, ..pulsed.plain }, amplitude_ratio: 1.2, ..pulsed }).unwrap(),
        Outcome::Safe
    );
    assert!(result(PulsedBlock { plain: PlainBlock { slenderness: 1.6, ..pulsed.plain }, ..pulsed }).is_err());
    assert!(result(PulsedBlock { plain: PlainBlock { slenderness: f64::NAN, ..pulsed.plain }, ..pulsed }).is_err());
    assert!(result(PulsedBlock { plain: PlainBlock { restitution: 1.5, ..pulsed.plain }, ..pulsed }).is_err());
    let second = run(
        &[pulsed, PulsedBlock { plain: PlainBlock { coupling: -1.0, device: DeviceKind::Inerter, ..pulsed.plain }, ..pulsed }],
        Registers::Widest,
    );
    assert_eq!(second.unwrap_err().0, 1);
}
