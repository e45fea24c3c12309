//! Rocking about a toe that slides: energy, symmetry, order of the steps, and where the toe lifts.

use super::*;
use crate::math;
use crate::structure::block::GRAVITY;

/// A block that is let go on a slippery base, and one that a jump of the ground tips and slides at once.
fn cases() -> [(Structure, f64, Vec<Piece>); 4] {
    let quiet = (AnySegment::Quiet, None, 3.0);
    [
        (block(0.5, 0.2), 0.4, std::vec![quiet]),
        (block(0.3, 0.13), -0.25, std::vec![(sine(0.12, 4.0), None, 3.0)]),
        (block(0.6, 0.75), 0.0, std::vec![(constant(1.6), None, 0.12), quiet]),
        (block(0.45, 0.55), 0.0, std::vec![(sine(2.4, 14.0), Some(sine(0.3, 13.0)), 0.5), quiet]),
    ]
}

fn begin(system: &SlidingSystem<f64>, rotation: f64) -> SlidingState<f64> {
    if rotation == 0.0 { SlidingState::default() } else { system.released_at(rotation, 0.0, [0.0; 2]) }
}

/// Kinetic and potential energy over mR², of the motion relative to the ground.
fn energy(state: &SlidingState<f64>, alpha: f64) -> f64 {
    let side = state.motion.side.unit::<f64>();
    let (sin, cos) = math::sin_cos(side * alpha - state.motion.rotation);
    let rate = state.motion.velocity;
    let (x, z) = (state.slip + cos * rate, sin * rate);
    0.5 * (x * x + z * z + rate * rate / 3.0) + GRAVITY * cos
}

/// On quiet ground what the block has lost between two impacts is what friction took.
#[test]
fn friction_takes_the_energy_that_the_motion_loses() {
    let structure = block(0.5, 0.2);
    let system: SlidingSystem<f64> = structure.resolve_sliding().unwrap();
    let mut state = system.released_at(0.4, 0.0, [0.0; 2]);
    let (before, mut slid) = (energy(&state, 0.5), false);
    let ground = GroundPair { horizontal: &AnySegment::Quiet, vertical: None };
    for _ in 0..3000 {
        let mut seen = Seen::default();
        system.advance(1e-3, &mut state, ground, 1e-3, &LIMITS, &mut seen).unwrap();
        if seen.count(Event::Impact) > 0 {
            break;
        }
        slid |= state.slip != 0.0;
        let lost = before - energy(&state, 0.5);
        assert!((lost - state.spent).abs() < 1e-11 * before, "{lost} {}", state.spent);
    }
    assert!(slid && state.spent > 0.0);
}

/// Friction over its way, summed from reactions and speeds by another rule, is the energy that the state counts.
#[test]
fn the_friction_that_is_counted_is_force_times_way() {
    for (structure, rotation, pieces) in cases() {
        let system: SlidingSystem<f64> = structure.resolve_sliding().unwrap();
        let mut state = begin(&system, rotation);
        let (mut work, mut time) = (0.0, 0.0);
        let (horizontal, vertical, duration) = &pieces[0];
        let ground = GroundPair { horizontal, vertical: vertical.as_ref().map(|up| up as &dyn GroundSegment<f64>) };
        let step = 1e-4;
        // One call a step, so that ends of steps are seen with their reactions.
        while time < *duration && !state.has_ended() {
            let power = |state: &SlidingState<f64>, at: f64| (system.balance(state, ground.at(at)).along * state.slip).abs();
            let first = power(&state, time);
            let (own, up) = (Later(horizontal, time), vertical.as_ref().map(|up| Later(up, time)));
            let later = GroundPair { horizontal: &own, vertical: up.as_ref().map(|up| up as &dyn GroundSegment<f64>) };
            system.advance(step, &mut state, later, step, &LIMITS, &mut ()).unwrap();
            time += step;
            work += 0.5 * step * (first + power(&state, time));
        }
        assert!(state.spent > 0.0 && (work - state.spent).abs() < 2e-3 * state.spent, "{work} {}", state.spent);
    }
}

/// A piece from a later instant on.
struct Later<'a>(&'a AnySegment<f64>, f64);

impl GroundSegment<f64> for Later<'_> {
    fn acceleration(&self, time: f64) -> f64 {
        self.0.acceleration(self.1 + time)
    }

    fn slope(&self, time: f64) -> f64 {
        self.0.slope(self.1 + time)
    }

    fn gain(&self, time: f64) -> f64 {
        self.0.gain(self.1 + time) - self.0.gain(self.1)
    }

    fn curvature_bound(&self) -> f64 {
        self.0.curvature_bound()
    }

    fn series(&self, time: f64, coefficients: &mut [f64]) {
        self.0.series(self.1 + time, coefficients);
    }
}

#[test]
fn the_mirrored_motion_is_the_mirrored_one() {
    let mirrored = |piece: &Piece| {
        let (horizontal, vertical, duration) = *piece;
        let horizontal = match horizontal {
            AnySegment::Linear(line) => AnySegment::Linear(Linear { start: -line.start, slope: -line.slope }),
            AnySegment::Sine(Harmonics { terms: [term] }) => sine(-term.amplitude, term.frequency),
            other => other,
        };
        (horizontal, vertical, duration)
    };
    for (structure, rotation, pieces) in cases() {
        let system: SlidingSystem<f64> = structure.resolve_sliding().unwrap();
        let (mut state, mut other) = (begin(&system, rotation), begin(&system, -rotation));
        let seen = follow(&system, &mut state, &pieces, 1e-3);
        let across: Vec<Piece> = pieces.iter().map(mirrored).collect();
        let seen_other = follow(&system, &mut other, &across, 1e-3);
        assert!(state.displacement != 0.0, "{structure:?} {state:?}");
        assert!(seen.peaks.rocked == seen_other.peaks.rocked);
        assert_eq!(
            (state.displacement, state.motion.rotation, state.spent, state.motion.impacts),
            (-other.displacement, -other.motion.rotation, other.spent, other.motion.impacts)
        );
        assert_eq!(seen.events, seen_other.events);
    }
}

/// The error falls with the fourth power of the step, events included.
#[test]
fn the_order_of_the_steps_is_four() {
    for (structure, rotation, pieces) in cases().into_iter().take(2) {
        let system: SlidingSystem<f64> = structure.resolve_sliding().unwrap();
        let end = |step: f64| {
            let mut state = begin(&system, rotation);
            let piece = [(pieces[0].0, pieces[0].1, 0.5)];
            follow(&system, &mut state, &piece, step);
            [state.motion.rotation, state.displacement, state.spent]
        };
        let exact = end(0.5 / 4096.0);
        let error = |step: f64| end(step).into_iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let (coarse, fine) = (error(0.5 / 32.0), error(0.5 / 128.0));
        // Between 4^3.3 and 4^5.5.
        assert!((97.0..2048.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    }
}

/// A rod-like block that turns fast enough flies: V = 0 at a toe that slides where θ̇² cos δ = g/R.
#[test]
fn a_toe_that_is_not_pressed_down_lifts_off() {
    let system: SlidingSystem<f64> = block(0.3, 0.4).resolve_sliding().unwrap();
    let fast = (GRAVITY / math::cos(0.3_f64 - 0.1)).sqrt();
    let mut flies = system.released_at(0.1, -fast * 1.001, [0.0; 2]);
    let seen = follow(&system, &mut flies, &[(AnySegment::Quiet, None, 1.0)], 1e-3);
    assert!(flies.lifted_off == Some(0.0) && flies.has_ended() && seen.ends.is_empty());
    let stays = system.released_at(0.1, -fast * 0.999, [0.0; 2]);
    assert!(stays.lifted_off.is_none());
}

/// A slide at first speed with enough friction to tip tips the block forward: uplift to the side of the slide.
#[test]
fn both_lands_and_tips_by_the_cone_of_friction() {
    // Below tan α a base that slides stays flat, above it the block tips.
    let slides = block(0.3, 0.2);
    let (state, seen) = shake(&slides, &[(constant(2.0), None, 0.1), (AnySegment::Quiet, None, 10.0)], 1e-3);
    assert!(!seen.peaks.rocked && state.displacement < 0.0);
    let tips = block(0.3, 0.5);
    let (state, seen) = shake(&tips, &[(constant(2.0), None, 0.1), (AnySegment::Quiet, None, 10.0)], 1e-3);
    assert!(seen.peaks.rocked && state.displacement < 0.0, "{state:?}");
}
