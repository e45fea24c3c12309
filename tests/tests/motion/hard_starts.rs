//! Motions that start or meet where a simulation is easily wrong: at the threshold, at the unstable equilibrium, with two
//! events at one instant.

use core::f64::consts::TAU;

use sprag_loops::{Method, Precision};
use sprag_shared::math::sign::Sign;
use sprag_shared::math::{acosh, asin, cos, cosh, exp, sinh, square_root};
use sprag_shared::motion::observer::Event;
use sprag_shared::motion::state::Phase;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_sim::batch::case::{Case, PulseShape, TIGHT};
use sprag_tests::{
    Dice, FullLog, GEOMETRIES, Log, Segment, Start, boundary, follow, relative, release, sane, shake, tight, unit_block,
};

#[test]
fn without_restitution_the_first_impact_is_the_end() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            let structure = unit_block(geometry, 10.0, device, 0.5, 0.0);
            let alpha = structure.block.slenderness();
            let mut log = FullLog::default();
            let state = release(&structure, 0.6 * alpha, 0.0, 50.0, &mut log);
            assert_eq!((state.phase, state.impacts), (Phase::Rest, 1));
            assert_eq!(log.times(Event::Rest), log.times(Event::Impact));
            let mut summed = Log::<f64, false>::default();
            let start = Start::Released(0.6 * alpha, 0.0);
            let sum = follow(&structure, &tight(), start, &[Segment::quiet(50.0)], &mut summed).expect("a motion");
            assert_eq!((sum.phase, sum.impacts), (Phase::Rest, 1));
            assert_eq!(summed.peaks.ended, log.peaks.ended);
        }
    }
}

/// An impact that stops the block while the ground pushes harder than the weight holds: it must leave again at once, to the
/// side to which it is pushed.
#[test]
fn a_stopped_block_leaves_with_the_push() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            for restitution in [0.0, 1e-12, 1e-3, 0.3, 1.0] {
                for (push, towards) in [(-1.5, 1.0), (1.5, -1.0)] {
                    let structure = unit_block(geometry, 10.0, device, 0.5, restitution);
                    let alpha = structure.block.slenderness();
                    let level = push * geometry.uplift_threshold(structure.block.slenderness());
                    // Inward, from the positive side.
                    let start = Start::Released(0.01 * alpha, -0.5 * alpha);
                    let mut log = FullLog::sampling(3);
                    let state = follow(&structure, &tight(), start, &[Segment::constant(level, 1.0)], &mut log)
                        .unwrap_or_else(|stopped| panic!("{stopped}: {geometry:?} {device:?} η = {restitution} push {push}"));
                    sane(&log);
                    assert_eq!(state.phase, Phase::Rocking);
                    assert!(
                        state.rotation * towards > 0.05 * alpha,
                        "{geometry:?} {device:?} η = {restitution}, push {push}: ends at {} α",
                        state.rotation / alpha
                    );
                }
            }
        }
    }
}

#[test]
fn the_unstable_equilibrium_and_its_neighbours() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            for side in [1.0, -1.0] {
                let structure = unit_block(geometry, 10.0, device, 0.5, 0.85);
                let alpha = structure.block.slenderness();
                let mut log = FullLog::default();
                let state = release(&structure, side * alpha, 0.0, 60.0, &mut log);
                assert_eq!((state.phase, state.rotation, state.velocity), (Phase::Rocking, side * alpha, 0.0), "it stands");
                for above in [1e-15, 1e-12, 1e-6] {
                    let state = release(&structure, side * alpha * (1.0 + above), 0.0, 60.0, &mut FullLog::default());
                    assert_eq!((state.phase, state.impacts), (Phase::Overturned, 0), "{geometry:?} {device:?} +{above}");
                }
                for below in [1e-15, 1e-12, 1e-6] {
                    let rotation = alpha * (1.0 - below);
                    let mut log = FullLog::default();
                    let state = release(&structure, side * rotation, 0.0, 80.0, &mut log);
                    assert_eq!(state.phase, Phase::Rest, "{geometry:?} {device:?} −{below}");
                    let impact = log.times(Event::Impact)[0];
                    if geometry == Geometry::Slender {
                        // It falls with p_σ while an inerter is engaged; α − θ is exact in floating point.
                        let slower = if device == DeviceKind::None { 1.0 } else { square_root(1.375) };
                        let exact = slower * acosh(alpha / (alpha - rotation));
                        // Rounding of θ during the first step away counts against α − θ.
                        let tolerance = 1e-12 * exact + 1e-3 * f64::EPSILON / below;
                        assert!((impact - exact).abs() < tolerance, "{device:?} −{below}: {impact}, exact {exact}");
                    } else {
                        // Slower than the slender block at its start, later not by much.
                        assert!(impact > 0.9 * acosh(1.0 / below) && impact < 2.0 * acosh(1.0 / below));
                    }
                }
            }
        }
    }
}

#[test]
fn uplift_at_the_threshold_and_just_above() {
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            for pulse in [PulseShape::Sine, PulseShape::Cosine] {
                for frequency_ratio in [0.5, 1.0, 3.7, 40.0] {
                    let case = Case { geometry, device, pulse, frequency_ratio, ..Case::default() };
                    for sign in [1.0, -1.0] {
                        for still in [0.0, 0.5, 1.0 - 1e-12, 1.0] {
                            let result = Case { amplitude_ratio: sign * still, ..case }
                                .run(&*f64::ideal(Method::Adaptive(TIGHT)))
                                .expect("a result");
                            assert_eq!((result.outcome, result.impacts), (Outcome::NoRocking, 0), "at {still}");
                            assert_eq!((result.peak_rotation, result.peak_acceleration), (0.0, 0.0));
                        }
                        for above in [1e-12, 1e-9, 1e-6] {
                            let result = Case { amplitude_ratio: sign * (1.0 + above), ..case }
                                .run(&*f64::ideal(Method::Adaptive(TIGHT)))
                                .expect("a result");
                            assert_eq!(
                                result.outcome,
                                Outcome::Safe,
                                "{geometry:?} {device:?} {pulse:?} {frequency_ratio} +{above}"
                            );
                            assert!(result.peak_rotation > 0.0 && result.peak_rotation < 0.01 * above.max(1e-9), "{result:?}");
                        }
                    }
                }
            }
        }
    }
}

/// At uplift under a sine pulse θ, θ̇ and θ̈ are zero together. The first impact comes from the closed form
/// φ = 1 − β/(1+ω²) sin ωt + A e^τ + B e^{−τ}, and just above the threshold (β = 1 + ε) from φ ~ √(2ε) ωτ³/6 − ω²τ⁴/24.
#[test]
fn the_triple_root_at_uplift() {
    for device in [DeviceKind::None, DeviceKind::Inerter] {
        let inertia = if device == DeviceKind::None { 1.0 } else { 1.375 };
        let slower = square_root(inertia);
        for frequency in [0.7, 1.0, slower, 1.0 / slower, 2.0, 5.0, 9.0] {
            for ratio in [1.01, 1.1, 1.3, 1.8, 3.0, 4.0] {
                // In units of 1/p_σ.
                let omega = frequency * slower;
                let uplift = asin(1.0 / ratio) / omega;
                let part = ratio / (1.0 + omega * omega);
                let sum = -1.0 + part * sprag_shared::math::sin(omega * uplift);
                let difference = part * omega * cos(omega * uplift);
                let rotation = |t: f64| {
                    let tau = t - uplift;
                    1.0 - part * sprag_shared::math::sin(omega * t)
                        + 0.5 * (sum + difference) * exp(tau)
                        + 0.5 * (sum - difference) * exp(-tau)
                };
                let end = TAU / omega;
                let samples = 4000;
                let at = |k: usize| uplift + (end - uplift) * k as f64 / f64::from(samples);
                let first = (20..=samples as usize).find(|&k| rotation(at(k)) < 0.0);
                let structure = unit_block(Geometry::Slender, 10.0, device, 0.5, 0.85);
                let alpha = structure.block.slenderness();
                let (_, log) = shake(&structure, &[Segment::sine(ratio * alpha, frequency, TAU / frequency)]);
                let impacts = log.times(Event::Impact);
                assert!(relative(log.times(Event::Uplift)[0], uplift * slower) < 1e-14);
                match first {
                    None => assert!(impacts.is_empty(), "{device:?} ω/p = {frequency}, β = {ratio}: {impacts:?}"),
                    Some(k) => {
                        let exact = slower * boundary(at(k - 1), at(k), |t| rotation(t) < 0.0);
                        assert!(
                            relative(impacts[0], exact) < 1e-9,
                            "{device:?} ω/p = {frequency}, β = {ratio}: {} for {exact}",
                            impacts[0]
                        );
                    }
                }
            }
            for above in [1e-10_f64, 1e-8, 1e-6] {
                let structure = unit_block(Geometry::Slender, 10.0, device, 0.5, 0.85);
                let alpha = structure.block.slenderness();
                let (_, log) = shake(&structure, &[Segment::sine((1.0 + above) * alpha, frequency, TAU / frequency)]);
                let lasts = log.times(Event::Impact)[0] - log.times(Event::Uplift)[0];
                let exact = 4.0 * square_root(2.0 * above) / frequency;
                assert!(relative(lasts, exact) < 4.0 * square_root(above) + 1e-15 / above, "+{above}: {lasts} for {exact}");
            }
        }
    }
}

/// An impact, the end of a pulse and a clutch command at one instant, or as near as floating point has neighbours.
#[test]
fn events_at_one_instant() {
    for device in DeviceKind::ALL {
        let structure = unit_block(Geometry::Slender, 10.0, device, 0.5, 0.85);
        let alpha = structure.block.slenderness();
        let slower = if device == DeviceKind::None { 1.0 } else { square_root(1.375) };
        let impact = slower * acosh(1.0 / 0.6);
        for push in [0.0, 0.5, -0.5, 1.7, -1.7] {
            let states: Vec<_> = (-4..=4)
                .map(|ulps| {
                    let at = impact * (1.0 + f64::from(ulps) * f64::EPSILON);
                    let segments = [Segment::quiet(at), Segment::constant(push * alpha, 0.15)];
                    let mut log = FullLog::sampling(3);
                    let start = Start::Released(0.4 * alpha, 0.0);
                    let state = follow(&structure, &tight(), start, &segments, &mut log).expect("a motion that can be followed");
                    sane(&log);
                    state
                })
                .collect();
            for state in &states {
                assert_eq!((state.phase, state.impacts, state.side), (states[0].phase, 1, Sign::Negative), "{device:?} {push}");
                assert!((state.rotation - states[0].rotation).abs() < 1e-14);
                assert!((state.velocity - states[0].velocity).abs() < 1e-14);
            }
            // Outward with η √(1 − 0.36) … of the speed it fell with, against or with the push.
            let fell = 0.8 / slower;
            let rate = 1.0 - push;
            let rises =
                if device == DeviceKind::Inerter || (device == DeviceKind::ClutchedPair && rate < 0.0) { slower } else { 1.0 };
            let (t, v) = (0.15 / rises, 0.85 * fell * rises);
            let exact = rate * (1.0 - cosh(t)) + v * sinh(t);
            assert!(relative(-states[4].rotation / alpha, exact) < 1e-12, "{device:?} {push}: {:?} for {exact}", states[4]);
        }
    }
}

/// Whatever the ground does, the work is bounded.
#[test]
fn wild_ground_motions_end() {
    let mut dice = Dice(5);
    for index in 0..600 {
        let geometry = GEOMETRIES[index % 2];
        let device = DeviceKind::ALL[index % 3];
        let restitution = [0.0, 1e-9, 0.1, 0.5, 0.9, 0.99, 0.999][index % 7];
        let mut structure = unit_block(geometry, dice.between(1.0, 60.0), device, dice.between(0.0, 3.0), restitution);
        if index % 5 == 0 {
            structure.device.kinematics = KinematicsKind::Consistent;
        }
        let uplift = geometry.uplift_threshold(structure.block.slenderness());
        let mut last = 0.0;
        let segments: Vec<_> = (0..60)
            .map(|_| {
                // Levels that like to be the threshold itself, and lengths from nothing to long.
                let level = match (dice.roll() * 6.0) as u32 {
                    0 => 0.0,
                    1 => uplift,
                    2 => -uplift,
                    3 => uplift * (1.0 + 1e-15),
                    _ => uplift * dice.between(-2.0, 2.0),
                };
                let duration = [1e-12, 1e-6, 1e-3, 0.05, 0.3][(dice.roll() * 5.0) as usize];
                let segment = match (dice.roll() * 4.0) as u32 {
                    0 => Segment::constant(level, duration),
                    1 => Segment::sine(level, dice.between(0.5, 60.0), duration),
                    2 => Segment::quiet(duration),
                    _ => Segment::line(last, level, duration),
                };
                last = level;
                segment
            })
            .chain([Segment::quiet(3.0)])
            .collect();
        let mut log = FullLog::sampling(2);
        follow(&structure, &tight(), Start::Rest, &segments, &mut log)
            .unwrap_or_else(|stopped| panic!("{stopped} in motion {index}: {structure:?}"));
        sane(&log);
    }
}
