//! What an impact does to block and device, how impacts that accumulate end in rest, and how rest ends.

use super::path::Shaking;
use super::{Machine, MachineState};
use crate::accumulation::Accumulation;
use crate::body::Body;
use crate::drivetrain::device::Coupling;
use crate::drivetrain::drive::{Drive, open};
use crate::ground::Piece;
use crate::observer::Event;
use crate::polynomial::first_zero_of;
use crate::rocking::{Phase, State};
use crate::scalar::{Real, Sign};
use crate::snapshot::DeviceObserver;

/// Pairs of swings below the rest speed that are followed in one piece when their impacts do not end them.
const MOST_IDLE_SWINGS: f64 = 1e3;

/// a ü_g/g + b (1 + v̈_g/g) + c: the moment that moves the block to one side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Threshold<S> {
    pub(super) horizontal: S,
    pub(super) vertical: S,
    pub(super) constant: S,
}

impl<S: Real> Threshold<S> {
    /// Its value for the ground acceleration in g.
    pub(super) fn at(&self, ground: [S; 2]) -> S {
        self.horizontal * ground[0] + self.vertical * (S::ONE + ground[1]) + self.constant
    }

    /// First instant in [`from`, `to`) at which it is above zero, and whether it gets there by crossing zero or by a jump.
    pub(super) fn exceeded<B: Body<S>, P: Piece<S>, Q: Piece<S>>(
        &self,
        shaking: Shaking<'_, P, Q>,
        from: S,
        to: S,
    ) -> Option<(S, bool)> {
        if self.at(shaking.at::<S, B>(from)) > S::ZERO {
            return Some((from, false));
        }
        let end = self.at(shaking.at::<S, B>(to));
        let mut curvature = self.horizontal.abs() * shaking.horizontal.curvature_bound();
        if B::VERTICAL {
            curvature = curvature + self.vertical.abs() * shaking.vertical.curvature_bound();
        }
        let value = |t: S| {
            let mut slope = self.horizontal * shaking.horizontal.slope(t);
            if B::VERTICAL {
                slope = slope + self.vertical * shaking.vertical.slope(t);
            }
            (self.at(shaking.at::<S, B>(t)), slope)
        };
        let zero = first_zero_of(value, curvature, (from, to, end), Sign::Negative, false);
        // What the clock cannot tell from the end of the piece is left to the next one.
        zero.filter(|&t| to - t > to * S::EPSILON * S::of(4.0)).map(|t| (t, true))
    }
}

impl<S: Real, B: Body<S>, D: Drive<S, X, G>, const X: usize, const G: usize> Machine<S, B, D, X, G> {
    /// What uplifts a standing block to `side`: weight and ground, against the friction of rack and locked bearings.
    fn uplift_threshold(&self, side: Sign) -> Threshold<S> {
        let posture = self.body.posture(side.unit(), S::ZERO);
        let (horizontal, vertical) = self.body.factors(&posture);
        let arm = self.body.arm(&posture);
        let push = self.drive.gears().map_or(S::ZERO, |gears| gears.rack_push);
        let dry = self.drive.standing_friction(self.actuator.engagement_delay == S::ZERO);
        Threshold { horizontal: side.times(horizontal - arm * push), vertical: side.times(vertical), constant: -(arm * dry) }
    }

    /// Both sides' thresholds at an instant: the larger of the two moments.
    fn uplifting(&self, ground: [S; 2]) -> S {
        self.uplift_threshold(Sign::Positive).at(ground).larger(self.uplift_threshold(Sign::Negative).at(ground))
    }

    /// First instant in [`from`, `to`) at which the ground pushes a standing block harder than its weight holds it, and whether
    /// it gets there by crossing that threshold.
    pub(super) fn uplift_time<P: Piece<S>, Q: Piece<S>>(&self, shaking: Shaking<'_, P, Q>, from: S, to: S) -> Option<(S, bool)> {
        let first = self.uplift_threshold(Sign::Positive).exceeded::<B, P, Q>(shaking, from, to);
        let second = self.uplift_threshold(Sign::Negative).exceeded::<B, P, Q>(shaking, from, to);
        match (first, second) {
            (Some(a), Some(b)) => Some(if b.0 < a.0 { b } else { a }),
            (a, b) => a.or(b),
        }
    }

    /// Sets the block in motion, to the side to which the ground pushes it.
    pub(super) fn uplift(&self, state: &mut MachineState<S>, ground: [S; 2], crossing: bool) {
        let positive = self.uplift_threshold(Sign::Positive).at(ground);
        let negative = self.uplift_threshold(Sign::Negative).at(ground);
        let side = if positive >= negative { Sign::Positive } else { Sign::Negative };
        let impacts = state.motion.impacts;
        state.motion =
            State { phase: Phase::Rocking, side, direction: side, drive: side, push: side, impacts, ..State::default() };
        state.ground = ground;
        (state.fresh, state.free) = ([D::COMMANDED, false, false], crossing);
        self.with_instant(state, S::ZERO, &mut (), |drive, at| drive.settle(at));
    }

    /// θ = 0. Returns the time, which rest moves on to the end of the impacts that it stands for.
    pub(super) fn impact<P: Piece<S>, Q: Piece<S>>(
        &self,
        state: &mut MachineState<S>,
        shaking: Shaking<'_, P, Q>,
        time: S,
        duration: S,
        observer: &mut dyn DeviceObserver<S>,
    ) -> S {
        let motion = &mut state.motion;
        let incoming = motion.velocity;
        if incoming.abs() >= self.counted_speed {
            motion.impacts += 1;
        }
        // A turn and a hit in one ulp leave the direction of before the turn.
        motion.direction = Sign::of(incoming, motion.direction);
        let before = {
            let posture = self.body.posture(motion.side.unit(), S::ZERO);
            self.body.along(&posture, incoming)
        };
        let engaged = self.drive.engaged_at_impact(&state.device);
        motion.velocity = self.restitution[engaged.min(2)] * incoming;
        motion.side = motion.direction;
        state.motion.drive = self.drive_sign_after_jump(state);
        let velocity = state.motion.velocity;
        observer.device_event(Event::Impact, time, &state.motion);
        self.with_instant(state, time, observer, |drive, at| {
            drive.impact(at, before);
            drive.settle(at);
        });
        if velocity.abs() > self.rest_speed || self.uplifting(state.ground) > S::ZERO {
            return time;
        }
        let tail = self.accumulation(state.motion.side, velocity.abs(), state.ground);
        let ends = time + tail.duration;
        let holds = ends <= duration && self.uplifting(shaking.at::<S, B>(ends)) < S::ZERO;
        let lingers = duration - time > tail.swing * S::of(MOST_IDLE_SWINGS);
        let hopeless = velocity.abs() <= self.rest_speed * S::EPSILON;
        if !(holds || lingers || hopeless) {
            return time;
        }
        let ends = if holds { ends } else { time };
        let State { side, direction, impacts, .. } = state.motion;
        state.motion = State { impacts: impacts + tail.impacts, side, direction, ..State::default() };
        self.part_at_rest(state);
        self.idle(state, ends - time);
        observer.device_event(Event::Rest, ends, &state.motion);
        ends
    }

    fn drive_sign_after_jump(&self, state: &MachineState<S>) -> Sign {
        if D::COMMANDED { self.drive_sign(state) } else { state.motion.drive }
    }

    /// The clutches of a standing block are open; a device without clutches stays engaged.
    pub(super) fn part_at_rest(&self, state: &mut MachineState<S>) {
        let Some(gears) = self.drive.gears() else { return };
        if !D::COMMANDED && X == 0 {
            state.device.wheels[0].coupling = Coupling::Locked;
            return;
        }
        if self.actuator.controlled {
            return;
        }
        self.with_instant(state, S::ZERO, &mut (), |_, at| {
            for wheel in 0..2 {
                if at.device.wheels[wheel].coupling != Coupling::Open {
                    open(gears, at, wheel);
                }
                let wheel = &mut at.device.wheels[wheel];
                (wheel.commanded, wheel.pending) = (false, -S::ONE);
            }
        });
    }

    /// The infinitely many impacts that follow a weak one ([`crate::accumulation`]).
    fn accumulation(&self, side: Sign, speed: S, ground: [S; 2]) -> Accumulation<S> {
        let rates = |side: Sign| {
            let posture = self.body.posture(side.unit(), S::ZERO);
            let arm = self.body.arm(&posture);
            let held = -self.uplift_threshold(side).at(ground);
            let over = |inward: bool| {
                let inertia = S::ONE + self.drive.swing_coupling(inward) * arm * arm;
                (held / inertia).larger(S::EPSILON * S::EPSILON)
            };
            (over(false), over(true))
        };
        Accumulation::of(rates(side), rates(side.opposite()), self.restitution[0], speed, self.counted_speed)
    }

    /// Signs and modes of a block that has just been released.
    pub(super) fn start(&self, state: &mut MachineState<S>) {
        let inward = state.motion.side.opposite();
        state.motion.drive = inward;
        state.motion.drive = self.drive_sign_after_jump(state);
        if state.motion.velocity == S::ZERO {
            self.turned(state);
        }
        self.settle(state, S::ZERO, &mut ());
        self.command(state, S::ZERO, &mut ());
        if state.motion.velocity == S::ZERO {
            self.turned(state);
        }
    }

    /// The ground may have jumped between two pieces.
    pub(super) fn ground_at_start(&self, state: &mut MachineState<S>, ground: [S; 2], observer: &mut dyn DeviceObserver<S>) {
        let jump = (ground[0] - state.ground[0]).abs().larger((ground[1] - state.ground[1]).abs());
        state.ground = ground;
        let size = ground[0].abs().larger(ground[1].abs()).larger(S::EPSILON);
        if state.motion.phase == Phase::Rocking && jump > size * S::EPSILON * S::of(4096.0) {
            state.motion.drive = self.drive_sign_after_jump(state);
            if state.motion.velocity == S::ZERO {
                state.held = false;
                self.turned(state);
            }
            state.fresh = [false; 3];
            self.settle(state, S::ZERO, observer);
            self.command(state, S::ZERO, observer);
        }
    }

    /// Time passes for an idle device.
    pub(super) fn idle(&self, state: &mut MachineState<S>, time: S) {
        if let Some(gears) = self.drive.gears() {
            for wheel in &mut state.device.wheels {
                gears.coast(wheel, time);
            }
        }
        state.device.elapse(time);
    }
}
