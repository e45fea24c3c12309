//! A block that slides on its whole base: Newmark's.

use super::*;
use crate::math;
use crate::structure::block::GRAVITY;

/// Under a rectangular pulse A for T and quiet ground after it the base slides back by
/// A (A − μ) g T²/(2μ): speed (A − μ)gT at the end of the pulse, and μg takes it from there (Newmark 1965).
#[test]
fn a_rectangular_pulse_leaves_newmarks_displacement() {
    for (level, friction, duration) in [(0.4, 0.15, 0.5), (-0.9, 0.1, 0.3), (0.2, 0.19, 1.0)] {
        let pieces = [(constant(level), None, duration), (AnySegment::Quiet, None, 20.0)];
        let (state, seen) = shake(&block(0.4, friction), &pieces, 0.0037);
        let level_size = level.abs();
        let expected = -level.signum() * level_size * (level_size - friction) * GRAVITY * duration * duration / (2.0 * friction);
        assert!((state.displacement - expected).abs() < 1e-12 * expected.abs(), "{} {expected}", state.displacement);
        let stops = duration + (level_size - friction) * duration / friction;
        let rest = seen.events.iter().find(|(event, _)| *event == Event::Rest).unwrap().1;
        assert!((rest - stops).abs() < 1e-12 * stops, "{rest} {stops}");
        assert_eq!((state.farthest, state.slip, state.stands()), (state.displacement.abs(), 0.0, true));
        // All work of friction is that of μ m g over the way.
        assert!((state.spent - friction * GRAVITY * expected.abs()).abs() < 1e-11 * state.spent, "{}", state.spent);
        assert!(!seen.peaks.rocked && seen.count(Event::Slip) == 2);
    }
}

/// A constant acceleration: x = −(A − μ)gt²/2.
#[test]
fn a_constant_acceleration_leaves_it_behind() {
    let (state, _) = shake(&block(0.4, 0.2), &[(constant(0.3), None, 2.0)], 0.01);
    assert!((state.displacement + 0.5 * 0.1 * GRAVITY * 4.0).abs() < 1e-12);
    assert!((state.slip + 0.1 * GRAVITY * 2.0).abs() < 1e-12);
}

/// Under a sine the base begins to slide where A sin ωt = μ, and its speed is the integral of what exceeds friction.
#[test]
fn a_sine_is_exceeded_where_it_reaches_friction() {
    let (amplitude, friction, frequency) = (0.3, 0.2, 5.0_f64);
    let (_, seen) = shake(&block(0.4, friction), &[(sine(amplitude, frequency), None, 1.2)], 1e-3);
    let begins = seen.events[0].1;
    assert!((math::sin(frequency * begins) - friction / amplitude).abs() < 1e-12, "{:?}", seen.events);
    // ẋ/g = A (cos ωt − cos ωt₀)/ω + μ (t − t₀), zero again at the end of the slide.
    let cos = |t: f64| math::cos(frequency * t);
    let speed = |t: f64| amplitude * (cos(t) - cos(begins)) / frequency + friction * (t - begins);
    let stop = seen.events[1].1;
    assert!(stop > 0.4 && speed(stop).abs() < 1e-9, "{stop} {}", speed(stop));
}

/// A block that is heavier by the ground's acceleration holds as one under another gravity, and slides by the rest.
#[test]
fn vertical_acceleration_is_another_gravity() {
    let up = Some(constant(0.5));
    let (held, seen) = shake(&block(0.4, 0.2), &[(constant(0.29), up, 1.0)], 0.01);
    assert!(held.stands() && seen.events.is_empty());
    let (slid, _) = shake(&block(0.4, 0.2), &[(constant(0.4), up, 1.0)], 0.01);
    assert!((slid.displacement + 0.5 * 0.1 * GRAVITY).abs() < 1e-12, "{}", slid.displacement);
}

#[test]
fn below_friction_and_slenderness_it_stands() {
    let (state, seen) = shake(&block(0.2, 0.5), &[(sine(0.2, 4.0), None, 10.0)], 0.01);
    assert!(state.stands() && state.displacement == 0.0 && seen.events.is_empty());
}

/// A wave of six steps is followed by shorter ones.
#[test]
fn steps_follow_a_ground_that_is_faster_than_the_block() {
    let pieces = [(sine(0.6, 6000.0), None, core::f64::consts::TAU / 6000.0), (AnySegment::Quiet, None, 1e-3)];
    let [found, close] = [1.8e-4, 1e-6].map(|step| shake(&block(0.4, 0.15), &pieces, step).0.farthest);
    assert!((found / close - 1.0).abs() < 1e-5 && close > 0.0, "{found} and {close}");
}
