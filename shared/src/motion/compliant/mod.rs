//! Event-driven integration of a block on a compliant foundation: a spring and a dashpot under each toe, which push and never pull.
//!
//! The block turns by θ and its centre of mass rises by y; the toe about which it turns, or would turn, does not slide. Each toe's foot
//! presses on the ground while its spring is compressed and its force is positive. There are no impacts: a toe that comes down meets its
//! dashpot. For stiff feet the motion is that of the rigid block on rigid ground. `balance` has the equations, `stretch` a step: the
//! Runge-Kutta method, taken again with a shorter length where an event lies inside. What the ends of a step do not show is not seen.
//!
//! Source: the two-spring foundation of Psycharis and Jennings (1983), with the full geometry; see
//! [docs/modes.md](../../../../docs/modes.md). The room imports what is directly in `motion`, and every room below `motion`.

mod balance;
pub mod resolve;
mod stretch;

use stretch::{Guard, Stretch};

use crate::equation::clutch_rule::ClutchRule;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::dense_output::DenseOutput;
use crate::method::step_grid::next_stop;
use crate::motion::ground_pair::GroundPair;
use crate::motion::observer::{Event, Observer};
use crate::motion::state::{BlockState, Limits, Phase, Stopped};

/// Events within a step after which the block goes to its end without looking for more: where rounding decides between two modes they may have
/// no end.
const MOST_IN_STEP: u32 = 16;

/// A block on a compliant foundation, with an ideal device or without.
#[derive(Clone, Copy, Debug)]
pub struct CompliantSystem<S> {
    /// p², 1/s².
    pub frequency_squared: S,
    /// λ = I_O/(mR²).
    pub inertia: S,
    /// α, rad.
    pub slenderness: S,
    /// k/m of the spring under each toe, 1/s².
    pub stiffness: S,
    /// c/m of the dashpot under each toe, 1/s.
    pub damping: S,
    /// σ, inertance of a flywheel over the mass of the block.
    pub mass_ratio: S,
    /// When a flywheel is engaged.
    pub clutch: ClutchRule,
    /// The device's kinematics have their θ̇² term, which the paper's (Eq. 11) leave out.
    pub consistent: bool,
    sin_slenderness: S,
    cos_slenderness: S,
}

/// What a foot does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Foot {
    /// It presses on the ground.
    #[default]
    Presses,
    /// It is compressed and has no force: the block rises faster than the dashpot lets it follow.
    Relaxes,
    /// It is above the ground.
    Lifted,
}

/// State of a block on a compliant foundation. Lengths are over R.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompliantState<S> {
    /// Rotation. Its phase is rest while both feet press.
    pub motion: BlockState<S>,
    /// y/R, rise of the centre of mass above where it is on undeformed feet.
    pub height: S,
    /// ẏ/R, 1/s.
    pub rise: S,
    /// The feet under the toes of negative and of positive θ.
    pub feet: [Foot; 2],
    /// A flywheel is engaged.
    pub engaged: bool,
    /// Energy lost to the dashpots, over mR²; 1/s².
    pub spent: S,
}

impl<S: Real> CompliantState<S> {
    fn stands(&self) -> bool {
        self.feet == [Foot::Presses; 2]
    }
}

impl<S: Real> CompliantSystem<S> {
    /// The block at rest on its feet on ground that does not move.
    pub fn at_rest(&self) -> CompliantState<S> {
        self.released_at(S::ZERO, S::ZERO, [S::ZERO; 2])
    }

    /// The block let go at θ (rad) with θ̇ (rad/s), its feet as far compressed as its weight asks, on ground that accelerates by `ground`
    /// (horizontal and vertical, in g).
    pub fn released_at(&self, rotation: S, velocity: S, ground: [S; 2]) -> CompliantState<S> {
        let side = Sign::of(rotation, Sign::of(velocity, Sign::Positive));
        let ground = [ground[0], S::ONE + ground[1]];
        let weight = self.gravity() * ground[1];
        let [toe, other] = self.sinking(side, rotation);
        // Compression of the toe's foot alone, and where the other one presses too.
        let alone = weight / self.stiffness;
        let sunk = if alone + other - toe > S::ZERO { S::HALF * (alone + toe - other) } else { alone };
        let height = toe - sunk;
        let feet = if sunk + other - toe > S::ZERO { Foot::Presses } else { Foot::Lifted };
        let feet = match side {
            Sign::Positive => [feet, Foot::Presses],
            Sign::Negative => [Foot::Presses, feet],
        };
        let phase = if feet == [Foot::Presses; 2] { Phase::Rest } else { Phase::Rocking };
        let motion = BlockState { rotation, velocity, phase, side, ..BlockState::default() };
        let (rise, engaged, spent) = (S::ZERO, self.clutch == ClutchRule::Always, S::ZERO);
        let mut state = CompliantState { motion, height, rise, feet, engaged, spent };
        let balance = self.balance(&state, ground);
        state.motion.direction = Sign::of(velocity, Sign::of(balance.acceleration, side));
        self.command(&mut state, balance.push);
        state
    }

    /// Follows the block in steps of `step` (s), or shorter ones where the ground moves faster, over `ground` from its local time 0 to
    /// `duration` (s), giving `observer` every interval and event: uplift where a foot leaves the ground that both pressed on, impact where
    /// both press again. A state that has overturned stays as it is.
    ///
    /// # Errors
    /// [`Stopped`], with the state as it was then.
    pub fn advance(
        &self,
        step: S,
        state: &mut CompliantState<S>,
        ground: GroundPair<'_, S>,
        duration: S,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> Result<(), Stopped> {
        let (mut time, mut tick, mut events, mut in_step) = (S::ZERO, 0_u32, 0_u32, 0_u32);
        let step = ground.step(step);
        // The ground may have jumped here.
        self.settle(state, ground, time, observer);
        while time < duration && state.motion.phase != Phase::Overturned {
            let stop = next_stop(&mut tick, step, time, duration);
            self.follow(state, ground, (&mut time, stop), in_step < MOST_IN_STEP, limits, observer);
            in_step = if time < stop { in_step + 1 } else { 0 };
            events += 1;
            if !(state.motion.rotation + state.motion.velocity + state.height + state.rise).is_finite() {
                return Err(Stopped::NotFinite { time: time.to_f64() });
            }
            if events >= limits.events {
                return Err(Stopped::TooManyEvents { time: time.to_f64(), mode: "the block rocks on its feet" });
            }
        }
        Ok(())
    }

    /// One step from `time` to `stop` at most, up to its first event, if it is to `look` for any.
    fn follow(
        &self,
        state: &mut CompliantState<S>,
        ground: GroundPair<'_, S>,
        (time, stop): (&mut S, S),
        look: bool,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) {
        if state.motion.rotation == S::ZERO && state.motion.velocity == S::ZERO {
            // Upright and at rest, it sets out the way it is pushed. A push that grows from zero has the sign of the motion that it leads to; any other
            // may turn within the step.
            let push = self.balance(state, ground.at(*time)).push;
            let stretch = Stretch::new(self, ground, *state, *time, stop - *time);
            let push = if push == S::ZERO { stretch.state(stretch.length()).motion.velocity } else { push };
            state.motion.direction = Sign::of(push, state.motion.direction);
            (state.motion.side, state.motion.terminal_acceleration_sign) = (state.motion.direction, state.motion.direction);
            self.command_seen(state, push, *time, observer);
        }
        let stretch = Stretch::new(self, ground, *state, *time, stop - *time);
        let guards = Guard::ALL.into_iter().filter(|_| look);
        let (until, found) = stretch.first(guards, |guard, at| stretch.guard(guard, at, limits.overturned));
        stretch.show(until, state.engaged, observer);
        *state = stretch.state(until);
        let Some(guard) = found else {
            if !look {
                let BlockState { side, direction, rotation, velocity, .. } = state.motion;
                (state.motion.side, state.motion.direction) = (Sign::of(rotation, side), Sign::of(velocity, direction));
            }
            *time = stop;
            return;
        };
        *time = *time + until;
        match guard {
            Guard::Overturned => {
                state.motion.phase = Phase::Overturned;
                observer.event(Event::Overturned, *time, &state.motion);
                return;
            }
            Guard::Upright => {
                state.motion.rotation = S::ZERO;
                state.motion.side = state.motion.direction;
            }
            Guard::Turn => {
                state.motion.velocity = S::ZERO;
                state.motion.direction = state.motion.direction.opposite();
                observer.event(Event::Turn, *time, &state.motion);
            }
            Guard::Foot(foot) => self.step_foot(state, foot, *time, observer),
            Guard::Push => {}
        }
        let push = self.balance(state, ground.at(*time)).push;
        let push = if guard == Guard::Push { state.motion.terminal_acceleration_sign.opposite().times(S::ONE) } else { push };
        self.command_seen(state, push, *time, observer);
    }

    /// The next mode of the foot with this number, whose guard has come to zero.
    fn step_foot(&self, state: &mut CompliantState<S>, foot: usize, time: S, observer: &mut dyn Observer<S>) {
        let stood = state.stands();
        let (compression, force) = self.foot(state, foot);
        state.feet[foot] = match state.feet[foot] {
            Foot::Presses if compression > S::ZERO => {
                // What the spring still holds, its own dashpot takes.
                state.spent = state.spent + S::HALF * self.stiffness * compression * compression;
                Foot::Relaxes
            }
            Foot::Presses => Foot::Lifted,
            Foot::Relaxes if compression.abs() < force.abs() / self.stiffness => Foot::Lifted,
            Foot::Relaxes => {
                state.spent = state.spent - S::HALF * self.stiffness * compression * compression;
                Foot::Presses
            }
            Foot::Lifted => Foot::Presses,
        };
        self.seen(state, stood, time, observer);
    }

    /// Reports that both feet no longer press, or press again.
    fn seen(&self, state: &mut CompliantState<S>, stood: bool, time: S, observer: &mut dyn Observer<S>) {
        let stands = state.stands();
        if stood == stands {
            return;
        }
        if stands {
            state.motion.phase = Phase::Rest;
            state.motion.impacts += 1;
            observer.event(Event::Impact, time, &state.motion);
        } else {
            state.motion.phase = Phase::Rocking;
            observer.event(Event::Uplift, time, &state.motion);
        }
    }

    /// The clutch after the ground has jumped.
    fn settle(&self, state: &mut CompliantState<S>, ground: GroundPair<'_, S>, time: S, observer: &mut dyn Observer<S>) {
        let push = self.balance(state, ground.at(time)).push;
        self.command_seen(state, push, time, observer);
    }

    fn command_seen(&self, state: &mut CompliantState<S>, push: S, time: S, observer: &mut dyn Observer<S>) {
        let before = state.engaged;
        self.command(state, push);
        if state.engaged != before {
            observer.event(Event::Switch, time, &state.motion);
        }
    }

    /// Eq. 10 with a `push` of the sign of the terminals' acceleration. Without a push a block that does not move wants nothing.
    fn command(&self, state: &mut CompliantState<S>, push: S) {
        let sign = Sign::of(push, state.motion.terminal_acceleration_sign);
        (state.motion.acceleration_sign, state.motion.terminal_acceleration_sign) = (sign, sign);
        let still = push == S::ZERO && state.motion.velocity == S::ZERO;
        state.engaged = self.clutch.engages(state.motion.direction, sign) && !(still && self.clutch.follows_signs());
    }
}

#[cfg(test)]
mod tests;
