//! Fixed steps from far below the control period to far beyond the block's own: what is located stays in order, whatever the step.

#[path = "../../../../shared/src/motion/step_end/tests/follow.rs"]
mod follow;

use core::f64::consts::TAU;

use self::follow::follow;

use sprag_shared::equation::any_equation::WithEquation;
use sprag_shared::equation::switched::Switched;
use sprag_shared::math::scalar::Real;
use sprag_shared::motion::ideal::IdealSystem;
use sprag_shared::motion::observer::Event;
use sprag_shared::motion::state::Phase;
use sprag_shared::motion::step_end::{TimeStepping, TimeSteppingState};
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_stability::{Energy, GEOMETRIES, Precision, Segment, Start, Stepping, Tally, in_both_precisions, unit_block};

in_both_precisions!(
    runge_kutta_steps_of_any_length,
    euler_steps_of_any_length,
    free_rocking_in_long_steps,
    events_looked_for_once_a_step,
);

const STEPS: [f64; 8] = [1e-5, 1e-4, 5e-4, 1e-3, 5e-3, 0.02, 0.1, 0.5];

fn structure(geometry: Geometry, device: DeviceKind, restitution: f64) -> Structure {
    let mut structure = unit_block(geometry, 12.0, device, 0.5, restitution);
    structure.device.kinematics = KinematicsKind::Consistent;
    structure
}

/// A pulse and 4/p after it: never NaN, at most one arc a step and one more for each event, and no impact leaves with more than η.
fn steps_of_any_length<S: Precision>(stepping: impl Fn(S) -> Stepping<S>) {
    for step in STEPS {
        // Ten thousand steps a second and more are tried on two structures, the others on all.
        let few = step < 5e-4;
        for geometry in GEOMETRIES.into_iter().filter(|&geometry| !few || geometry == Geometry::Full) {
            for device in DeviceKind::ALL.into_iter().filter(|&device| !few || device != DeviceKind::Inerter) {
                for amplitude in [1.2, 3.0, 8.0].into_iter().filter(|&amplitude| !few || amplitude == 3.0) {
                    let structure = structure(geometry, device, 0.85);
                    let level = S::of(amplitude * geometry.uplift_threshold(structure.block.slenderness()));
                    let segments = [Segment::sine(level, S::of(4.0), S::of(TAU / 4.0)), Segment::quiet(S::of(4.0))];
                    let mut tally = Tally::new();
                    // θ̇ of semi-implicit Euler is not the slope of its θ: it finds the floor to within the error of a step only.
                    let stepping = stepping(S::of(step));
                    let euler = matches!(stepping, Stepping::SemiImplicitEuler(_));
                    tally.floor = if euler { f64::INFINITY } else { S::tolerance(1e-8, 1e-4) / S::EPSILON.to_f64() };
                    let run = S::tally(&structure, stepping, Start::Rest, &segments, tally);
                    let steps = ((TAU / 4.0 + 4.0) / step) as u64;
                    run.tally.assert_sane(steps + 2_000, 2_000);
                    let what = format!("{} {geometry:?} {device:?} {amplitude} in steps of {step}", S::NAME);
                    assert!(run.tally.reach <= run.tally.peaks.acceleration.to_f64() * step * step, "{what}: {:?}", run.tally);
                    assert!(run.tally.rebound <= 0.85 + 4.0 * S::EPSILON.to_f64(), "{what}: {:?}", run.tally);
                    let end = run.end();
                    assert!(end.side.times(end.rotation) >= S::ZERO, "{what}: {end:?}");
                }
            }
        }
    }
}

fn runge_kutta_steps_of_any_length<S: Precision>() {
    steps_of_any_length::<S>(Stepping::RungeKutta4);
}

fn euler_steps_of_any_length<S: Precision>() {
    steps_of_any_length::<S>(Stepping::SemiImplicitEuler);
}

/// On quiet ground Runge-Kutta steps of up to 0.1/p with located events hardly gain energy, even without loss at impacts. With
/// impacts noticed at the ends of the same steps ([`TimeStepping`]) each gives the block what it fell too far, until it overturns.
fn free_rocking_in_long_steps<S: Precision>() {
    for (step, tolerance) in [(5e-3, 1e-11), (0.02, 1e-9), (0.1, 1e-6)] {
        for geometry in GEOMETRIES {
            for device in [DeviceKind::None, DeviceKind::Inerter] {
                let structure = structure(geometry, device, 1.0);
                let energy = Energy::of(&structure);
                let rotation = S::of(0.5 * structure.block.slenderness());
                let start = Start::Released(rotation, S::ZERO);
                let segments = [Segment::quiet(S::of(100.0))];
                let run = S::tally(&structure, Stepping::RungeKutta4(S::of(step)), start, &segments, Tally::with_energy(energy));
                run.tally.assert_sane((100.0 / step) as u64 + 1_000, 1_000);
                run.tally.assert_no_energy_gained(tolerance + S::tolerance(0.0, 2e-4));
                let gained = detected(&structure, rotation, step);
                println!(
                    "{} {geometry:?} {device:?} step {step}: {:.1e} of the barrier gained with impacts located, {gained:.1e} without",
                    S::NAME,
                    run.tally.energy.expect("an energy").gain
                );
                assert!(gained > 0.1, "{gained}");
            }
        }
    }
}

/// The largest energy over that of the start (in barriers) of 100/p of free rocking in Runge-Kutta steps at whose ends impacts are
/// noticed, until the block overturns.
fn detected<S: Precision>(structure: &Structure, rotation: S, step: f64) -> f64 {
    struct Run<S> {
        system: IdealSystem<S>,
        energy: Energy,
        rotation: S,
        step: S,
    }
    impl<S: Real> WithEquation<S> for Run<S> {
        type Output = f64;

        fn with<E: Switched<S>>(self, engaged: &E) -> f64 {
            let IdealSystem { restitution, uplift, .. } = self.system;
            let block = TimeStepping { released: *engaged, engaged: *engaged, restitution, uplift };
            let mut state = TimeSteppingState { rotation: self.rotation, velocity: S::ZERO, side: S::ONE };
            let energy = |state: &TimeSteppingState<S>| {
                let speed = state.velocity.to_f64() / self.energy.frequency;
                let rotation = state.rotation.abs().to_f64();
                let alpha = self.energy.slenderness;
                let cosine = sprag_shared::math::cos(alpha - rotation);
                let (inertia, weight) = match self.energy.geometry {
                    Geometry::Full => (1.0 + self.energy.coupling * cosine * cosine, cosine - sprag_shared::math::cos(alpha)),
                    Geometry::Slender => (1.0 + self.energy.coupling, rotation * (alpha - 0.5 * rotation)),
                };
                (0.5 * inertia * speed * speed + weight) / self.energy.barrier()
            };
            let (first, mut most) = (energy(&state), 0.0_f64);
            for _ in 0..(100.0 / self.step.to_f64()) as u32 {
                if state.rotation.abs().to_f64() > self.energy.slenderness {
                    break;
                }
                state = block.runge_kutta_4(state, [S::ZERO; 3], self.step);
                most = most.max(energy(&state) - first);
            }
            most
        }
    }
    let system = structure.resolve().expect("parameters within range");
    system.engaged.known(Run { system, energy: Energy::of(structure), rotation, step: S::of(step) })
}

/// The scheme that looks once a step has no order to lose, but it stays finite and ends, at every step.
fn events_looked_for_once_a_step<S: Precision>() {
    struct Run<'a, S> {
        system: IdealSystem<S>,
        structure: &'a Structure,
        step: S,
    }
    impl<S: Real> WithEquation<S> for Run<'_, S> {
        type Output = ();

        fn with<E: Switched<S>>(self, engaged: &E) {
            let IdealSystem { clutch, restitution, uplift, .. } = self.system;
            let released = if clutch.follows_signs() { engaged.without_inerter() } else { *engaged };
            let block = TimeStepping { released, engaged: *engaged, restitution, uplift };
            let alpha = self.structure.block.slenderness();
            for amplitude in [0.9, 1.5, 8.0] {
                let level = S::of(amplitude) * uplift;
                let pulse = sprag_shared::ground::Harmonics::sine(level, S::of(4.0));
                let mut state = TimeSteppingState::at_rest();
                let seen = follow(&block, &mut state, &pulse, (S::of(TAU / 4.0), self.step), S::of(1.5));
                let then =
                    follow(&block, &mut state, &sprag_shared::ground::Harmonics::QUIET, (S::of(4.0), self.step), S::of(1.5));
                let most = ((TAU / 4.0 + 4.0) / self.step.to_f64()) as u32 + 2;
                assert!(state.rotation.is_finite() && state.velocity.is_finite() && seen.impacts + then.impacts <= most);
                assert!(amplitude > 1.0 || seen.rotation == S::ZERO, "{seen:?}");
                assert!(amplitude < 1.0 || self.step.to_f64() > 0.4 || seen.rotation > S::ZERO, "{seen:?}");
                assert!(seen.overturned || then.overturned || state.rotation.abs().to_f64() < 3.0 * alpha.max(0.5));
            }
        }
    }
    for step in STEPS {
        // As above.
        for geometry in GEOMETRIES.into_iter().filter(|&geometry| step >= 5e-4 || geometry == Geometry::Full) {
            for device in DeviceKind::ALL.into_iter().filter(|&device| step >= 5e-4 || device == DeviceKind::ClutchedPair) {
                let structure = structure(geometry, device, 0.85);
                let system = structure.resolve().expect("parameters within range");
                system.engaged.known(Run { system, structure: &structure, step: S::of(step) });
                assert_ne!(structure.device.mass_ratio, 0.0);
                let run = S::tally(
                    &structure,
                    Stepping::RungeKutta4(S::of(step)),
                    Start::Rest,
                    &[Segment::quiet(S::ONE)],
                    Tally::new(),
                );
                assert_eq!((run.end().phase, run.tally.count(Event::Uplift)), (Phase::Rest, 0));
            }
        }
    }
}
