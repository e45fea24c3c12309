//! Event-driven integration of a block with an ideal device.
//!
//! Between events the motion is smooth. Within a step the zeros of θ̈ are found first; between them θ̇ is monotone,
//! so its zeros show as changes of sign; between those θ is monotone, so its zeros do. No crossing is missed however
//! close two of them lie, and the signs themselves are part of the state: an event just handled has already changed its
//! sign, so it cannot be found a second time.
//!
//! The room imports what is directly in `motion`, `motion::rest`, and every room below `motion`.

pub mod device_view;
mod impact;
pub mod resolve;
mod signs;
mod uplift;

use crate::equation::Equation;
use crate::equation::any_equation::AnyEquation;
use crate::equation::clutch_rule::ClutchRule;
use crate::ground::GroundSegment;
use crate::math::root::newton_bracketed;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::dense_output::{DenseOutput, Integrator, StepStart};
use crate::method::step_grid::next_stop;
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::{BlockState, Limits, Phase, Stopped};

/// Block with an ideal device: its equations, and the clutch rule that chooses between them.
#[derive(Clone, Copy, Debug)]
pub struct IdealSystem<S> {
    /// Equation of motion with the inerter released.
    pub released: AnyEquation<S>,
    /// Equation of motion with the inerter engaged.
    pub engaged: AnyEquation<S>,
    /// Restitution η: velocity after an impact over that before, 0 to 1.
    pub restitution: S,
    /// Uplift threshold: ground acceleration (in g) above which the block uplifts.
    pub uplift: S,
    /// α, rad: the size of a rotation that matters.
    pub slenderness: S,
    /// θ̇ (rad/s) below which an impact may end in rest.
    pub rest_speed: S,
    /// θ̇ (rad/s) below which an impact does not count; infinitely many follow in finite time.
    pub counted_speed: S,
    /// Clutch rule.
    pub clutch: ClutchRule,
}

/// Result of the search for events in a step.
enum End {
    /// No event that ends the step.
    Reached,
    /// A clutch switched, or the block turned about and its clutch with it.
    Switched,
    /// Rounding leaves open to which side a block at a turn moves off.
    Undecided,
    /// Impact: θ = 0.
    Impact,
    /// Overturning: |θ| passed the limit.
    Overturned,
}

impl<S: Real> IdealSystem<S> {
    /// Whether the inerter is engaged in `state`.
    #[inline(always)]
    pub fn is_engaged(&self, state: &BlockState<S>) -> bool {
        state.phase == Phase::Rocking && self.clutch.engages(state.direction, state.terminal_acceleration_sign)
    }

    /// The equation in force while the block moves in `direction` and its terminals' acceleration has the sign `terminal_acceleration_sign`.
    #[inline(always)]
    fn equation(&self, direction: Sign, terminal_acceleration_sign: Sign) -> &AnyEquation<S> {
        if self.clutch.engages(direction, terminal_acceleration_sign) { &self.engaged } else { &self.released }
    }

    /// A block released at θ (rad, not 0) with θ̇ (rad/s) while the ground accelerates by `ground` (in g).
    pub fn released_at(&self, rotation: S, velocity: S, ground: S) -> BlockState<S> {
        let side = Sign::of(rotation, Sign::of(velocity, Sign::Positive));
        let mut state = BlockState {
            rotation,
            velocity,
            phase: Phase::Rocking,
            side,
            direction: Sign::of(velocity, side.opposite()),
            ..BlockState::default()
        };
        self.read_signs(&mut state, ground);
        if velocity == S::ZERO {
            state.direction = state.acceleration_sign;
        }
        state
    }

    /// Follows the block over `segment` from its local time 0 to `duration` (s), giving `observer` every interval and
    /// event.
    ///
    /// # Errors
    /// [`Stopped`], with the state as it was then.
    pub fn advance<M: Integrator<S>>(
        &self,
        method: &M,
        state: &mut BlockState<S>,
        segment: &dyn GroundSegment<S>,
        duration: S,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> Result<(), Stopped> {
        let mut time = S::ZERO;
        let mut acceleration = None;
        let mut tick = 0_u32;
        let mut events = 0_u32;
        let mut swings = None;
        let mut undecided = None;
        state.acceleration_is_zero = false;
        while time < duration && state.phase != Phase::Overturned {
            if state.phase == Phase::Rest {
                match self.uplift_time(segment, time, duration) {
                    Some((at, crossing)) => {
                        time = at;
                        self.uplift(state, segment.acceleration(at), crossing);
                        observer.event(Event::Uplift, time, state);
                    }
                    None => return Ok(()),
                }
            }
            if state.is_outward_at(limits.overturned) {
                state.phase = Phase::Overturned;
                observer.event(Event::Overturned, time, state);
                return Ok(());
            }
            let stop = match method.step() {
                Some(step) => next_stop(&mut tick, step, time, duration),
                None => duration,
            };
            let end = self.follow(method, state, segment, (&mut time, &mut acceleration), stop, limits, observer);
            if !matches!(end, End::Reached) {
                acceleration = None;
            }
            match end {
                End::Reached => {}
                End::Switched => observer.event(Event::Switch, time, state),
                End::Undecided => {
                    // Neither way: it stands there for the rest of the step.
                    if undecided == Some(time) && method.step().is_some() {
                        time = stop;
                    }
                    undecided = Some(time);
                }
                End::Impact => {
                    time = self.impact(state, segment, time, duration, observer);
                    if segment.is_quiet()
                        && !observer.every_swing()
                        && self.released.switches_with_acceleration()
                        && self.engaged.switches_with_acceleration()
                    {
                        time = self.sum_up(state, &mut swings, time, duration, observer);
                    }
                }
                End::Overturned => {
                    state.phase = Phase::Overturned;
                    observer.event(Event::Overturned, time, state);
                }
            }
            events += 1;
            if !(state.rotation + state.velocity).is_finite() {
                return Err(Stopped::NotFinite { time: time.to_f64() });
            }
            if events >= limits.events {
                return Err(Stopped::TooManyEvents { time: time.to_f64(), mode: "the block rocks" });
            }
        }
        Ok(())
    }

    /// One step, up to its first event that changes the equation. `acceleration` is θ̈ at `time`, where the step before has evaluated it.
    #[expect(clippy::too_many_arguments, reason = "one call site, and each is a different thing")]
    #[inline]
    fn follow<M: Integrator<S>>(
        &self,
        method: &M,
        state: &mut BlockState<S>,
        segment: &dyn GroundSegment<S>,
        (time, acceleration): (&mut S, &mut Option<S>),
        stop: S,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> End {
        let engaged = self.is_engaged(state);
        let equation = if engaged { &self.engaged } else { &self.released };
        let start = StepStart {
            equation,
            segment,
            side: state.side,
            rotation: state.rotation,
            velocity: state.velocity,
            time: *time,
            length: stop - *time,
            acceleration: if state.acceleration_is_zero { Some(S::ZERO) } else { *acceleration },
            scale: self.slenderness,
        };
        let output = method.integrate(&start);
        let length = output.length();
        let separate_terminal_sign = self.clutch.follows_signs() && !equation.switches_with_acceleration();
        if *time == S::ZERO {
            let before = state.direction;
            let switched = self.jumped(equation, state, &output, separate_terminal_sign);
            if state.direction != before && state.rotation != S::ZERO {
                observer.event(Event::Turn, *time, state);
            }
            if switched {
                return End::Switched;
            }
        }
        let mut from = S::ZERO;
        let mut first = output.at(S::ZERO);
        let mut acceleration_is_zero = state.acceleration_is_zero;
        loop {
            let acceleration_zero = output.acceleration_zero(from, length, state.acceleration_sign, acceleration_is_zero);
            // An event within rounding of the step's end belongs to the next step.
            let switching_zero = if separate_terminal_sign && length > stop * S::EPSILON * S::of(4.0) {
                let bound = acceleration_zero.unwrap_or(length);
                let mut zero = None;
                for to in [bound, length] {
                    zero = output
                        .switching_zero(from, to, state.terminal_acceleration_sign, acceleration_is_zero)
                        .filter(|&zero| zero <= bound && !state.ends_at(output.at(zero).rotation, limits));
                    // Just after a switch rounding may show the old sign as far as a zero of θ̈ that follows at once: only a longer look
                    // distinguishes that from a switch back.
                    if acceleration_zero.is_none() || zero.is_none_or(|zero| zero > (*time + length) * S::EPSILON) {
                        break;
                    }
                }
                zero
            } else {
                None
            };
            let until = switching_zero.or(acceleration_zero).unwrap_or(length);
            let end = output.at(until);
            let mut interval = MonotoneInterval {
                start: *time,
                from,
                to: until,
                first,
                last: end,
                engaged,
                side: state.side,
                direction: state.direction,
            };
            // θ̇ is monotone up to here, so a zero of it shows.
            let turns = state.direction.times(end.velocity) < S::ZERO;
            let (turn, at_turn) = if turns {
                let turn = newton_bracketed(from, until, state.direction, S::HALF * (from + until), |t| {
                    let motion = output.at(t);
                    (motion.velocity, motion.acceleration)
                });
                (turn, output.at(turn))
            } else {
                (until, end)
            };
            // θ is monotone up to the turn.
            if let Some((level, before)) = state.passes(at_turn.rotation, limits) {
                let at = output.crossing(level, before, (from, turn));
                (interval.to, interval.last) = (at, output.at(at));
                observer.interval(&output, &interval);
                (state.rotation, state.velocity, state.acceleration_is_zero) = (level, interval.last.velocity, false);
                *time = *time + at;
                return if before == state.side { End::Impact } else { End::Overturned };
            }
            if turns {
                // It has just turned: back at once would repeat without end. The motion shows where it goes.
                let undecided =
                    self.clutch.follows_signs() && from == S::ZERO && first.velocity == S::ZERO && turn <= stop * S::EPSILON;
                (interval.to, interval.last) = (turn, at_turn);
                if !undecided {
                    observer.interval(&output, &interval);
                }
                // Not the sign of θ̈: in a long Euler step θ̇ does not follow it, and a turn back would be found without end.
                state.direction = state.direction.opposite();
                if undecided || method.step().is_none() {
                    // A block let go in balance, with θ̈ = 0, may have the wrong sign of θ̈; its turn gives it.
                    state.acceleration_sign = state.direction;
                    if !separate_terminal_sign {
                        state.terminal_acceleration_sign = state.acceleration_sign;
                    }
                }
                if undecided {
                    return End::Undecided;
                }
                observer.event(
                    Event::Turn,
                    *time + turn,
                    &BlockState { rotation: at_turn.rotation, velocity: S::ZERO, ..*state },
                );
                if self.clutch.follows_signs() {
                    state.rotation = at_turn.rotation;
                    state.velocity = S::ZERO;
                    state.acceleration_is_zero = false;
                    *time = *time + turn;
                    return End::Switched;
                }
                (from, first) = (turn, at_turn);
                acceleration_is_zero = false;
                continue;
            }
            observer.interval(&output, &interval);
            let at_acceleration_zero = switching_zero.is_none() && acceleration_zero.is_some();
            if at_acceleration_zero {
                state.acceleration_sign = state.acceleration_sign.opposite();
            }
            if switching_zero.is_some() || (at_acceleration_zero && !separate_terminal_sign) {
                state.terminal_acceleration_sign = state.terminal_acceleration_sign.opposite();
            }
            let switches = if separate_terminal_sign { switching_zero.is_some() } else { at_acceleration_zero };
            if self.clutch.follows_signs() && switches {
                state.rotation = end.rotation;
                state.velocity = end.velocity;
                state.acceleration_is_zero = at_acceleration_zero;
                if separate_terminal_sign {
                    // The other equation's θ̈ may have another sign here.
                    self.read_acceleration_sign(state, segment.acceleration(*time + until));
                }
                *time = *time + until;
                return End::Switched;
            }
            if at_acceleration_zero && until < length {
                (from, first) = (until, end);
                acceleration_is_zero = true;
                continue;
            }
            state.rotation = end.rotation;
            state.velocity = end.velocity;
            state.acceleration_is_zero = at_acceleration_zero;
            let reached = *time + length;
            *time = if length == stop - *time { stop } else { reached };
            debug_assert!(engaged == self.is_engaged(state), "a change of the clutch ends the arc");
            *acceleration = output.evaluated_end().filter(|_| *time == reached);
            return End::Reached;
        }
    }
}
