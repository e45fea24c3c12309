//! Sticking of flywheels, and of the block by dry friction of rack and bearings: tilted, where it turns, or on its base, where clutches engage as it starts.

use super::mode_output::{ModeIntegrator, Shaking};
use super::threshold::{Threshold, earlier};
use super::{HybridState, HybridSystem};
use crate::drivetrain::any_transmission::TransmissionKind;
use crate::drivetrain::clutch_state::{Coupling, Guard, ModeCoefficients};
use crate::drivetrain::transmission::Account;
use crate::equation::Accelerations;
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::observer::{Event, Observer};
use crate::motion::state::Limits;

impl<S: Real> HybridSystem<S> {
    /// Stick or slip of the block at θ̇ = 0, and its direction after it.
    #[inline(never)]
    pub(super) fn turned(&self, state: &mut HybridState<S>) {
        let (side, direction) = (state.motion.side, state.motion.direction);
        // A block on its base goes nowhere but up.
        let on = if state.motion.rotation == S::ZERO { side } else { direction };
        let on_base = self.transmission.traits().holds && state.motion.rotation == S::ZERO;
        let goes = |sign: Sign| {
            let threshold = self.breakaway(state, side, sign);
            if self.transmission.traits().holds {
                threshold.is_exceeded(state.ground)
            } else {
                threshold.at(state.ground) > S::ZERO
            }
        };
        let (goes_on, goes_back) = (goes(on), !on_base && goes(direction.opposite()));
        state.held = self.transmission.traits().holds && !goes_on && !goes_back;
        if on_base {
            state.motion.direction = side;
        } else if !goes_on && goes_back {
            state.motion.direction = direction.opposite();
        }
    }

    /// Follows a held block until the ground overcomes friction or `stop`. Returns the time.
    pub(super) fn hold(
        &self,
        state: &mut HybridState<S>,
        shaking: Shaking<'_, S>,
        time: S,
        stop: S,
        observer: &mut dyn Observer<S>,
    ) -> S {
        let end = self.let_go(state, shaking, time, stop);
        let until = end.map_or(stop, |(at, _)| at);
        let whole = until - time;
        let length = self.until_stop(state, whole);
        let (until, end) = if length < whole { (time + length, None) } else { (until, end) };
        if until > time {
            // What holds the block follows every wave of the ground.
            let span = (until - time, shaking.pieces(until - time));
            self.show_still(state, &|t| (shaking.at(time + t), S::ZERO), time, span, observer);
        }
        // A stop within rounding of now still stops a flywheel.
        self.idle(state, length);
        state.ground = shaking.at(until);
        match end {
            Some((_, Some(way))) => self.set_off(state, way, until, observer),
            Some((_, None)) => *state = self.standing(state, until, observer),
            None => {}
        }
        until
    }

    /// Breakaway of a held block before `stop`: time, and its direction with whether the threshold is crossed, not passed by a jump; no
    /// direction where it rests. On its base it can only go up, and its weight alone may hold it again.
    fn let_go(&self, state: &HybridState<S>, shaking: Shaking<'_, S>, time: S, stop: S) -> Option<(S, Option<(Sign, bool)>)> {
        let side = state.motion.side;
        let first = |threshold: Threshold<S>| threshold.exceeded(shaking, time, stop);
        let moves = |sign| first(self.breakaway(state, side, sign)).map(|(at, crossing)| (at, Some((sign, crossing))));
        let ends = if state.motion.rotation == S::ZERO {
            [moves(side), first(self.weight(state)).map(|(at, _)| (at, None))]
        } else {
            [moves(Sign::Positive), moves(Sign::Negative)]
        };
        earlier(ends)
    }

    /// Moment that holds a block on its base without its clutches.
    fn weight(&self, state: &HybridState<S>) -> Threshold<S> {
        let side = state.motion.side;
        self.breakaway(&self.standing(state, S::ZERO, &mut ()), side, side).opposite()
    }

    /// Dry friction of the rack at θ̇ = 0, which `account` leaves out: all of it where the block turns or starts, the static share where it is held.
    #[inline(never)]
    pub(super) fn hold_rack(
        &self,
        state: &HybridState<S>,
        law: &ModeCoefficients<S>,
        ground: Accelerations<S>,
        account: &mut Account<S>,
    ) {
        let share = if state.held { self.share_out(state, law, ground, account) } else { law.direction };
        account.rack_force = account.rack_force + share * self.transmission.parameters.rack_dry;
    }

    /// Static forces of the flywheels that hold a block, in `account` in the place of their largest: of the dry friction that rack and flywheels
    /// have, each gives the share that the moment balance needs, which is returned with the sign of what it resists. The weight of a block on its
    /// base needs none.
    fn share_out(
        &self,
        state: &HybridState<S>,
        law: &ModeCoefficients<S>,
        ground: Accelerations<S>,
        account: &mut Account<S>,
    ) -> S {
        let side = state.motion.side;
        let parameters = &self.transmission.parameters;
        // What would move the block towards `sign` without friction, over what friction there is.
        let share = |sign: Sign| {
            let threshold = self.breakaway(state, side, sign);
            let most = threshold.dry;
            let moves = threshold.at(ground) + most;
            if moves > S::ZERO { (moves / most).smaller(S::ONE) } else { S::ZERO }
        };
        let (outward, inward) = (share(side), if state.motion.rotation == S::ZERO { S::ZERO } else { share(side.opposite()) });
        let (sign, share) = if inward > outward { (side.opposite(), inward) } else { (side, outward) };
        // The mesh adds to what flywheels bear, or takes from it.
        let loaded = S::ONE + parameters.load_share(&state.device);
        let mut forces = account.force;
        for (force, wheel) in forces.iter_mut().zip(&state.device.wheels) {
            match wheel.coupling {
                Coupling::Locked => *force = *force - law.direction * (loaded * (parameters.inertance * parameters.bearing_dry)),
                Coupling::Slipping(_) if wheel.spin == S::ZERO => *force = S::ZERO,
                _ => {}
            }
        }
        for (i, wheel) in self.carried_along(state, sign) {
            let force = &mut forces[i & 1];
            *force = *force + sign.times(share * (loaded * parameters.standing_friction(wheel).0));
        }
        account.force = forces;
        sign.times(share)
    }

    /// A flywheel has come to a stop; what acts on it decides which way it continues, if at all.
    pub(super) fn stopped(&self, state: &mut HybridState<S>, index: usize) {
        let law = self.law(state);
        let point = self.point(&law, state.motion.side, &self.place(state));
        let force = self.transmission.account(&point, S::ZERO, &state.device).force[index & 1];
        let wheel = &mut state.device.wheels[index & 1];
        wheel.spin = S::ZERO;
        self.transmission.parameters.settle(wheel, force);
    }

    /// A held block goes, towards `sign`, as what moves it passes what holds it (`crossing`) or jumps beyond.
    #[inline(never)]
    pub(super) fn set_off(
        &self,
        state: &mut HybridState<S>,
        (sign, crossing): (Sign, bool),
        time: S,
        observer: &mut dyn Observer<S>,
    ) {
        (state.held, state.free) = (false, crossing);
        state.motion.direction = sign;
        if state.motion.rotation == S::ZERO {
            self.leave_base(state, time, observer);
        } else {
            self.look_at_drive(state);
        }
        let before = state.device.wheels.map(|wheel| wheel.coupling);
        self.settle(state, time, observer);
        // The overrunning clutch of the one way has let go, and that of the other way may hold the block in turn.
        let passed_on = self.transmission.kind == TransmissionKind::Overrunning
            && state.motion.velocity == S::ZERO
            && state.device.wheels.map(|wheel| wheel.coupling) != before;
        if passed_on {
            self.turned(state);
        }
    }

    /// A jolt gives the block the velocity `velocity` (rad/s), and friction holds it no more.
    #[inline(never)]
    pub(super) fn jolted(&self, state: &mut HybridState<S>, velocity: S, time: S, observer: &mut dyn Observer<S>) {
        let motion = &mut state.motion;
        motion.velocity = velocity;
        motion.direction = Sign::of(velocity, motion.direction);
        if motion.rotation == S::ZERO {
            motion.side = motion.direction;
        }
        if state.held && velocity != S::ZERO {
            (state.held, state.free) = (false, false);
            // Nobody has watched Eq. 10 while the block was held.
            self.look_at_drive(state);
            if state.motion.rotation == S::ZERO {
                observer.event(Event::Uplift, time, &state.motion);
            }
        }
    }

    /// At θ̇ = 0, where what holds or moves the block has changed: a held block that nothing holds any more goes. Whether it does.
    pub(super) fn try_to_set_off(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) -> bool {
        let was_held = state.held;
        self.turned(state);
        let goes = was_held && !state.held;
        if goes {
            self.set_off(state, (state.motion.direction, false), time, observer);
        }
        goes
    }

    /// An elastic clutch is engaged, so that its flywheel swings while the block is held.
    pub(super) fn has_springs(&self, state: &HybridState<S>) -> bool {
        self.transmission.traits().springs && state.device.wheels.iter().any(|wheel| wheel.coupling.has_twist())
    }

    /// A flywheel that swings on the spring of an engaged clutch.
    pub(super) fn swings(&self, state: &HybridState<S>) -> bool {
        self.transmission.traits().springs
            && state.device.wheels.iter().any(|wheel| {
                wheel.coupling.has_twist() && (wheel.spin != S::ZERO || (wheel.twist != S::ZERO && wheel.turning.is_some()))
            })
    }

    /// Mode of a held block: its springs move the flywheels alone, until they or the ground overcome the rack's friction.
    pub(super) fn hold_law(&self, state: &HybridState<S>, law: &mut ModeCoefficients<S>) {
        let (side, rotation) = (state.motion.side.unit(), state.motion.rotation);
        let configuration = self.body.configuration(side, rotation);
        let moment = self.body.to_terminal(&configuration, law.dry.abs());
        let friction = self.body.solve_acceleration(&configuration, moment, law.coupling, S::ZERO);
        law.dry = S::ZERO;
        law.watch[0] = if rotation == S::ZERO { Guard::HeldDown(friction, side) } else { Guard::Stuck(friction) };
    }

    /// Turns a block that is held on its base to the side to which it is pushed.
    fn face(&self, state: &mut HybridState<S>) {
        let (side, _) = self.lifted(state, state.ground);
        (state.motion.side, state.motion.direction) = (side, side);
    }

    /// [`HybridSystem::hold`] with springs: one step, up to its first event.
    pub(super) fn hold_springs<T: ModeIntegrator<S>>(
        &self,
        integrator: &T,
        state: &mut HybridState<S>,
        shaking: Shaking<'_, S>,
        (time, stop): (&mut S, S),
        guarded: (&Limits<S>, bool),
        observer: &mut dyn Observer<S>,
    ) {
        let on_base = state.motion.rotation == S::ZERO;
        // The clutches of a controller do not open where the weight alone holds the block.
        let opens = on_base && !self.actuator.controlled;
        let rests = if opens { self.weight(state).exceeded(shaking, *time, stop) } else { None };
        let end = rests.map_or(stop, |(at, _)| at);
        if end > *time && on_base && !opens {
            self.face(state);
            // The springs may have turned to the other side before the step ends.
            let (mut later, mut then) = (*state, *time);
            self.follow(integrator, &mut later, shaking, (&mut then, end), guarded, &mut ());
            if later.held && self.uplifting(&later, later.ground) > S::ZERO {
                self.face(&mut later);
                (state.motion.side, state.motion.direction) = (later.motion.side, later.motion.side);
            }
        }
        if end > *time {
            self.follow(integrator, state, shaking, (time, end), guarded, observer);
        }
        let rests = rests.is_some() && *time == end || state.held && on_base && !opens && !self.swings(state);
        if rests {
            *state = self.standing(state, *time, observer);
        } else if state.held {
            // An event of its device may let it go.
            self.try_to_set_off(state, *time, observer);
        }
    }

    /// Breakaway of a held block: the moving moment has reached the holding one.
    pub(super) fn break_away(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) {
        let side = state.motion.side;
        let push = |sign| self.breakaway(state, side, sign).at(state.ground);
        let outward = state.motion.rotation == S::ZERO || push(side) > push(side.opposite());
        let sign = if outward { side } else { side.opposite() };
        self.set_off(state, (sign, true), time, observer);
    }
}
