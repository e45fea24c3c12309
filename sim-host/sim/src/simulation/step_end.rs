//! Runs whose impacts and clutch are looked at once a step (`accuracy.events = "step-end"`): the scheme of the paper and of
//! most programs, kept to show what it costs ([`sprag_shared::motion::step_end`]).

use sprag_shared::equation::any_equation::WithEquation;
use sprag_shared::equation::clutch_rule::ClutchRule;
use sprag_shared::equation::switched::Switched;
use sprag_shared::ground::GroundSegment;
use sprag_shared::math::scalar::Real;
use sprag_shared::math::sign::Sign;
use sprag_shared::motion::ideal::IdealSystem;
use sprag_shared::motion::state::{BlockState, Phase};
use sprag_shared::motion::step_end::{TimeStepping, TimeSteppingState};
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::GRAVITY;

use super::drive::Course;
use crate::ground_motion::SumSegment;
use crate::history::Sample;
use crate::scene::accuracy::MethodName;

/// Which step is taken, and how often it is sampled.
#[derive(Clone, Copy, Debug)]
pub struct Steps {
    /// Runge-Kutta or semi-implicit Euler.
    pub method: MethodName,
    /// s.
    pub step: f64,
    /// Between samples, s.
    pub interval: f64,
    /// σR/g.
    pub force_scale: f64,
}

/// What a run leaves.
#[derive(Debug, Default)]
pub struct Trace<S> {
    /// Phase and impacts.
    pub state: BlockState<S>,
    /// Largest values at step ends.
    pub peaks: Peaks<S>,
    /// Samples at step ends, about one an interval.
    pub samples: Vec<Sample>,
    /// Times of impacts, s.
    pub impacts: Vec<f64>,
    /// Changes of [`Sample::engaged`] from step to step.
    pub switches: u32,
    /// Largest |F|/(mg) at step ends.
    pub peak_force: f64,
}

/// Follows a block from rest, or from `start` (θ, θ̇), until the end of the course or `continues` says no.
pub fn follow<S: Real>(
    course: &Course<'_>,
    system: &IdealSystem<S>,
    steps: &Steps,
    start: (S, S),
    continues: &mut dyn FnMut() -> bool,
) -> Trace<S> {
    system.engaged.known(Follow { course, system, steps, start, continues })
}

struct Follow<'a, S> {
    course: &'a Course<'a>,
    system: &'a IdealSystem<S>,
    steps: &'a Steps,
    start: (S, S),
    continues: &'a mut dyn FnMut() -> bool,
}

impl<S: Real> WithEquation<S> for Follow<'_, S> {
    type Output = Trace<S>;

    fn with<E: Switched<S>>(self, engaged: &E) -> Trace<S> {
        let IdealSystem { clutch, restitution, uplift, .. } = *self.system;
        let released = if clutch.follows_signs() { engaged.without_inerter() } else { *engaged };
        let block = TimeStepping { released, engaged: *engaged, restitution, uplift };
        trace(&block, clutch, self)
    }
}

fn trace<S: Real, E: Switched<S>>(block: &TimeStepping<S, E>, clutch: ClutchRule, follow: Follow<'_, S>) -> Trace<S> {
    let Follow { course, steps, start, continues, .. } = follow;
    let mut trace = Trace::default();
    let mut state = TimeSteppingState::at_rest();
    (state.rotation, state.velocity) = start;
    if start.0 < S::ZERO || (start.0 == S::ZERO && start.1 < S::ZERO) {
        state.side = -S::ONE;
    }
    let (mut engaged, mut next) = (u8::from(clutch.has_inerter() && !clutch.follows_signs()), 0.0);
    let quiet = (course.ground.duration(), course.free_time, None);
    let segments = course.ground.segments().iter().map(|segment| (segment.start, segment.duration, Some(segment))).chain([quiet]);
    for (origin, duration, segment) in segments {
        let piece = segment.map_or(SumSegment::QUIET, |s| s.shape.to());
        let overturned: S = course.angle(segment.map_or(0.0, |segment| segment.bound));
        let h = S::of(steps.step);
        let (mut time, mut tick) = (S::ZERO, 0);
        let duration = S::of(duration);
        while time < duration && continues() {
            tick += 1;
            let end = (S::count(tick) * h).smaller(duration);
            let (push, push_at_end) = (piece.acceleration(time), piece.acceleration(end));
            let (before, was_moving) = (state.side, state != TimeSteppingState::at_rest());
            state = match steps.method {
                MethodName::SemiImplicitEuler => block.semi_implicit_euler(state, push, end - time),
                MethodName::RungeKutta4 | MethodName::Taylor | MethodName::ExponentialMidpoint => {
                    block.runge_kutta_4(state, [push, piece.acceleration(S::HALF * (time + end)), push_at_end], end - time)
                }
            };
            time = end;
            let at = origin + time.to_f64();
            let moving = state != TimeSteppingState::at_rest();
            trace.peaks.rocked |= moving;
            if was_moving && before != state.side {
                trace.state.impacts += 1;
                trace.impacts.push(at);
                trace.peaks.first_impact = trace.peaks.first_impact.or(Some(S::of(at)));
                trace.peaks.first_counted_impact = trace.peaks.first_impact;
            }
            let followed = state.rotation.is_finite() && state.velocity.is_finite();
            let falls = !followed || (state.rotation.abs() >= overturned && state.rotation * state.velocity > S::ZERO);
            if falls {
                // It lies where its fall is decided; a long step may have turned it further than any sine is good for.
                let side = if followed { Sign::of(state.rotation, Sign::Positive) } else { Sign::of(before, Sign::Positive) };
                state.rotation = side.times(overturned);
                state.velocity = if followed { state.velocity } else { S::ZERO };
            }
            let equation = block.engagement(&state, state.side, push_at_end);
            let acceleration =
                if moving { equation.acceleration(state.side, state.rotation, state.velocity, push_at_end) } else { S::ZERO };
            trace.peaks.rotation = trace.peaks.rotation.larger(state.rotation.abs());
            trace.peaks.acceleration = trace.peaks.acceleration.larger(acceleration.abs());
            let engages = || steps.force_scale != 0.0 && block.engages(&state, state.side, push_at_end);
            // A plain inerter stays on the rack while the block stands.
            let works = clutch.has_inerter() && (!clutch.follows_signs() || (moving && engages()));
            let terminal = equation.terminal_acceleration(state.side, state.rotation, state.velocity, acceleration);
            let force = if works { terminal.to_f64() * steps.force_scale } else { 0.0 };
            trace.peak_force = trace.peak_force.max(force.abs());
            let second = clutch.follows_signs() && state.velocity < S::ZERO;
            let before = std::mem::replace(&mut engaged, u8::from(works) << u8::from(second));
            trace.switches += u32::from(engaged != before);
            if at >= next || falls {
                next = (at / steps.interval).floor() * steps.interval + steps.interval;
                trace.samples.push(Sample {
                    time_s: at,
                    ground_m_s2: push_at_end.to_f64() * GRAVITY,
                    rotation_rad: state.rotation.to_f64(),
                    velocity_rad_s: state.velocity.to_f64(),
                    acceleration_rad_s2: acceleration.to_f64(),
                    force_ratio: if second { [0.0, force] } else { [force, 0.0] },
                    engaged,
                    displacement_m: 0.0,
                });
            }
            if falls {
                trace.state.phase = Phase::Overturned;
                trace.peaks.ended = Some(S::of(at));
                return trace;
            }
        }
    }
    if state.rotation.abs() >= course.no_return(0.0) && state.rotation * state.velocity > S::ZERO {
        trace.state.phase = Phase::Overturned;
        trace.peaks.ended = Some(S::of(course.ground.duration() + course.free_time));
    }
    trace
}
