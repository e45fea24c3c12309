//! Impacts that accumulate, for every loss at an impact from almost all to none.

use sprag_shared::math::{acosh, atanh, square_root};
use sprag_shared::motion::observer::Event;
use sprag_shared::motion::state::Phase;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_stability::{Energy, GEOMETRIES, Precision, Segment, Start, Stepping, Tally, in_both_precisions, relative, unit_block};

in_both_precisions!(
    a_hundredth_is_left_at_each_impact,
    half_is_left_at_each_impact,
    a_hundredth_is_lost_at_each_impact,
    a_ten_thousandth_is_lost_at_each_impact,
    nothing_is_lost_at_each_impact,
    ten_thousand_swings_without_loss,
    impacts_without_number_in_one_sample,
);

/// σ = 0.5, consistent kinematics, α = 10°, p = 1/s.
fn structure(geometry: Geometry, device: DeviceKind, restitution: f64) -> Structure {
    let mut structure = unit_block(geometry, 10.0, device, 0.5, restitution);
    structure.device.kinematics = KinematicsKind::Consistent;
    structure
}

fn a_hundredth_is_left_at_each_impact<S: Precision>() {
    impacts_accumulate::<S>(0.01);
}

fn half_is_left_at_each_impact<S: Precision>() {
    impacts_accumulate::<S>(0.5);
}

fn a_hundredth_is_lost_at_each_impact<S: Precision>() {
    impacts_accumulate::<S>(0.99);
}

fn a_ten_thousandth_is_lost_at_each_impact<S: Precision>() {
    impacts_accumulate::<S>(0.9999);
}

fn nothing_is_lost_at_each_impact<S: Precision>() {
    impacts_accumulate::<S>(1.0);
}

/// Released at 0.3 α: the energy never grows, and the block comes to rest or, where it loses too little for that in 300/p, rocks
/// on. The slender block does both when its closed form says so.
fn impacts_accumulate<S: Precision>(restitution: f64) {
    const TIME: f64 = 300.0;
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            let structure = structure(geometry, device, restitution);
            let alpha = structure.block.slenderness();
            let start = Start::Released(S::of(0.3 * alpha), S::ZERO);
            let tally = Tally::with_energy(Energy::of(&structure));
            let run = S::tally(&structure, Stepping::Tight, start, &[Segment::quiet(S::of(TIME))], tally);
            let (end, tally) = (run.end(), &run.tally);
            tally.assert_sane(12_000, 12_000);
            tally.assert_no_energy_gained(S::tolerance(1e-14, 4e-6));
            assert!(tally.rebound <= restitution + S::tolerance(1e-15, 1e-7), "{geometry:?} {device:?}: {tally:?}");
            assert_eq!(tally.count(Event::Overturned) + tally.count(Event::Uplift), 0);
            // A clutched pair keeps nothing of what an engaged flywheel took.
            let dies = device == DeviceKind::ClutchedPair || restitution <= 0.99;
            assert_eq!(end.phase, if dies { Phase::Rest } else { Phase::Rocking }, "{} {geometry:?} {device:?}", S::NAME);
            let (rest, impacts) = slender_rest(device, restitution);
            if geometry == Geometry::Slender && dies {
                let ended = tally.peaks.ended.expect("rest").to_f64();
                let tolerance = S::tolerance(1e-12, 1e-6) / (1.0 - restitution).max(1e-3);
                assert!(relative(ended, rest) < tolerance, "{} {device:?} η = {restitution}: {ended} for {rest}", S::NAME);
                // In f32 the last of the counted impacts is right to rounding of its speed.
                let off = end.impacts.abs_diff(impacts);
                assert!(off <= u32::from(S::EPSILON.to_f64() > 1e-10), "{} impacts for {impacts}", end.impacts);
            }
            if dies {
                assert_eq!((end.rotation, end.velocity, tally.count(Event::Rest)), (S::ZERO, S::ZERO, 1));
            }
        }
    }
}

/// When a slender block released at 0.3 α comes to rest, in 1/p, and after how many impacts of more than 10⁻⁶ pα: it falls
/// and rises as with its own p_σ of that direction, and each impact leaves η of its speed.
fn slender_rest(device: DeviceKind, restitution: f64) -> (f64, u32) {
    let slow = square_root(1.375);
    let (rise, fall) = match device {
        DeviceKind::None => (1.0, 1.0),
        DeviceKind::Inerter => (slow, slow),
        DeviceKind::ClutchedPair => (1.0, slow),
    };
    // From φ = 0.3 with θ̇ = 0: θ̇ p_σ/p at the floor is √(1 − 0.7²).
    let mut time = fall * acosh(1.0 / 0.7);
    let mut incoming = square_root(1.0 - 0.49) / fall;
    let mut impacts = 0;
    if device != DeviceKind::ClutchedPair && restitution > 0.99 {
        return (f64::INFINITY, u32::MAX);
    }
    while incoming > 1e-17 {
        impacts += u32::from(incoming >= 1e-6);
        let outgoing = incoming * restitution;
        time += (rise + fall) * atanh(outgoing * rise);
        incoming = outgoing * rise / fall;
    }
    (time, impacts)
}

/// Nothing is lost and nothing gained in 10,000 swings. In f64 the energy stays within 10⁻⁹; in f32 each of some 50,000 steps
/// rounds θ and θ̇ once, and the bound is what these add up to in the worst direction seen, not a property of the method.
fn ten_thousand_swings_without_loss<S: Precision>() {
    for geometry in GEOMETRIES {
        for device in [DeviceKind::None, DeviceKind::Inerter] {
            let structure = structure(geometry, device, 1.0);
            let alpha = structure.block.slenderness();
            // A swing from 0.5 α lasts at least 2 acosh 2 = 2.63/p.
            let segments = vec![Segment::quiet(S::of(16.0)); 2_000];
            let tally = Tally::with_energy(Energy::of(&structure));
            let start = Start::Released(S::of(0.5 * alpha), S::ZERO);
            let run = S::tally(&structure, Stepping::Tight, start, &segments, tally);
            run.tally.assert_sane(400_000, 40_000);
            assert_eq!(run.end().phase, Phase::Rocking);
            assert!(run.tally.count(Event::Impact) >= 10_000, "{:?}", run.tally);
            let level = run.tally.energy.expect("an energy");
            let first = level.first / level.energy.barrier();
            let drift = (level.gain / first).max((level.first - level.least) / level.first);
            println!(
                "{} {geometry:?} {device:?}: energy within {drift:.1e} in {} swings, {} steps",
                S::NAME,
                run.tally.count(Event::Impact),
                run.tally.steps
            );
            assert!(drift < S::tolerance(1e-9, 2e-2), "{} {geometry:?} {device:?}: {drift:e}", S::NAME);
        }
    }
}

/// A motion that dies within one sample of a record, and one whose swings are shorter than the ulp of the clock.
fn impacts_without_number_in_one_sample<S: Precision>() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            for restitution in [0.3, 0.85, 0.97] {
                let structure = structure(geometry, device, restitution);
                let speed = structure.block.slenderness() * 1e-5;
                let record = vec![Segment::quiet(S::of(0.005)); 4];
                let tally = Tally::with_energy(Energy::of(&structure));
                let run = S::tally(&structure, Stepping::Tight, Start::Released(S::ZERO, S::of(speed)), &record, tally);
                run.tally.assert_sane(2_000, 2_000);
                assert_eq!(run.end().phase, Phase::Rest, "{} {geometry:?} {device:?} η = {restitution}", S::NAME);
                assert!(run.end().impacts >= 1);
                // An hour into a piece, the clock of f32 has an ulp of 2⁻¹² s; of f64 one of 2⁻⁴¹ s.
                let late = [Segment::constant(S::ZERO, S::of(3600.0)), Segment::quiet(S::of(1.0))];
                let start = Start::Released(S::of(1e-4 * structure.block.slenderness()), S::ZERO);
                let run = S::tally(&structure, Stepping::Tight, start, &late, Tally::new());
                run.tally.assert_sane(4_000, 4_000);
                assert_eq!(run.end().phase, Phase::Rest);
            }
        }
    }
}
