//! What is refused, and the block that never slides against the loop in which it cannot.

use super::*;
use crate::ground::Ricker;
use crate::math::sign::Sign;
use crate::method::taylor::Taylor;
use crate::structure::RestitutionScatter;
use crate::structure::block::Geometry;
use crate::structure::device::{Device, DeviceKind};

/// Peaks, times and states of a block that the friction holds, to the error of its steps.
#[test]
fn where_friction_is_enough_it_moves_as_a_block_that_cannot_slide() {
    let cases = [
        (0.15, 0.9, sine(0.19, 8.0), 1.6),
        (0.2, 1.2, AnySegment::Ricker(Ricker { amplitude: 0.35, rate: 4.0, centre: 1.2 }), 3.0),
        (0.25, 1.1, constant(0.4), 0.3),
    ];
    for (alpha, friction, ground, duration) in cases {
        let pieces = [(ground, None, duration), (AnySegment::Quiet, None, 6.0)];
        let structure = block(alpha, friction);
        let (state, seen) = shake(&structure, &pieces, 1e-4);
        assert_eq!((state.displacement, seen.count(Event::Slip)), (0.0, 0), "{alpha} {:?}", seen.events);
        let fixed = Structure { base: Base::Rigid, ..structure };
        let system = fixed.resolve::<f64>().unwrap();
        let (mut other, mut known) = (BlockState::default(), Seen::default());
        for (piece, _, duration) in &pieces {
            known.peaks.origin = known.origin;
            let method = Taylor::<f64, 20>::adaptive(1e-17);
            system.advance(&method, &mut other, piece, *duration, &LIMITS, &mut known).unwrap();
            known.origin += duration;
        }
        assert!(seen.peaks.rocked && seen.count(Event::Impact) > 3, "{alpha} {:?}", seen.events);
        let apart = (seen.peaks.rotation - known.peaks.rotation).abs() / alpha;
        assert!(apart < 1e-11, "{alpha} {apart:e}");
        assert_eq!((state.motion.phase, state.motion.impacts), (other.phase, other.impacts));
        for event in [Event::Uplift, Event::Impact, Event::Turn, Event::Rest] {
            let times =
                |seen: &Seen| -> Vec<f64> { seen.events.iter().filter(|(of, _)| *of == event).map(|(_, at)| *at).collect() };
            let (own, others) = (times(&seen), times(&known));
            assert_eq!(own.len(), others.len(), "{alpha} {event:?}");
            assert!(own.iter().zip(&others).all(|(a, b)| (a - b).abs() < 1e-9), "{alpha} {event:?}: {own:?} {others:?}");
        }
    }
}

#[test]
fn what_it_cannot_go_with_is_refused_by_name() {
    let error = |structure: Structure| structure.resolve_sliding::<f64>().unwrap_err();
    let base = block(0.2, 0.5);
    let inerter = Device { kind: DeviceKind::Inerter, mass_ratio: 0.5, ..Device::NONE };
    for wrong in [
        Structure { base: Base::Friction(0.0), ..base },
        Structure { base: Base::Rigid, ..base },
        Structure { base: Base::Friction(4.0 / 3.0 + 1e-9), ..base },
        Structure { geometry: Geometry::Slender, ..base },
        Structure { device: inerter, ..base },
        Structure { restitution_scatter: RestitutionScatter { deviation: 0.1, seed: 1 }, ..base },
    ] {
        assert_eq!(error(wrong).parameter, "friction_coefficient", "{wrong:?}");
    }
    assert_eq!(error(Structure { restitution: Restitution::Constant(0.99), ..base }).parameter, "restitution");
    assert!(Structure { base: Base::Friction(4.0 / 3.0 - 1e-9), ..base }.resolve_sliding::<f64>().is_ok());
    assert_eq!(base.resolve::<f64>().unwrap_err().parameter, "friction_coefficient");
    let drivetrain = crate::structure::drivetrain::Drivetrain::default();
    assert_eq!(drivetrain.resolve::<f64>(&base, true).unwrap_err().parameter, "friction_coefficient");
}

/// Impacts at which the toe slips follow one another without end, in proportion; the block comes to rest after them, and stands.
#[test]
fn impacts_that_slip_end_in_rest() {
    for (friction, push) in [(0.2, 0.0), (0.3, 0.02), (0.4, -0.08)] {
        let structure = Structure { restitution: Restitution::Constant(0.85), ..block(0.1745, friction) };
        let system = structure.resolve_sliding().unwrap();
        let mut state = system.released_at(0.05, 0.0, [push, 0.0]);
        let landing = system.land(Sign::Positive, -1e-3, 0.0);
        assert!(landing.slip != 0.0, "μ = {friction}: {landing:?}");
        let pieces = std::vec![(constant(push), None, 0.005); 2000];
        let seen = follow(&system, &mut state, &pieces, 5e-4);
        assert!(state.stands() && state.farthest > 0.0, "μ = {friction}: {state:?}");
        let (events, intervals) = (seen.events.len(), seen.ends.len());
        assert!(events < 4000 && intervals < 20_000, "μ = {friction}: {events} events in {intervals} intervals");
        // It stays so.
        let later = follow(&system, &mut state, &pieces, 5e-4);
        assert_eq!((later.events.len(), later.ends.len()), (0, 0), "μ = {friction}");
    }
}

/// Bounces at which the toe slips shrink in proportion: they end where they accumulate, whatever the step and the speed below which an impact may end
/// in rest.
#[test]
fn bounces_with_a_slipping_toe_end_where_they_accumulate() {
    let structure = Structure { restitution: Restitution::Constant(0.656), ..block(0.05, 0.356) };
    let ends = |slower: f64, step: f64| {
        let mut system: SlidingSystem<f64> = structure.resolve_sliding().unwrap();
        system.rest_speed *= slower;
        let mut state = system.released_at(0.03, 0.0, [0.0, 0.0]);
        let seen = follow(&system, &mut state, &[(constant(0.0), None, 20.0)], step);
        assert!(state.stands() && seen.count(Event::Impact) > 10, "{state:?}");
        (seen.events.iter().rfind(|(event, _)| *event == Event::Rest).unwrap().1, state.displacement)
    };
    let first = ends(1.0, 1e-3);
    for (slower, step) in [(1e-1, 1e-3), (1e-3, 1e-3), (1e-5, 1e-3), (1.0, 5e-4), (1e-5, 2e-3)] {
        let other = ends(slower, step);
        assert!((other.0 - first.0).abs() < 1e-7 && (other.1 - first.1).abs() < 1e-9, "{slower} {step}: {other:?} {first:?}");
    }
}
