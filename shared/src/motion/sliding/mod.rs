//! Event-driven integration of a block without a device whose base may slide: Coulomb friction at the toe, with rocking.
//!
//! Four modes: it stands, slides on its whole base, rocks about a toe that sticks, or about one that slides. `balance` has the accelerations and
//! reactions of each, `landing` the impact. Steps are those of the Runge-Kutta method; an event inside one is located by taking the step
//! again with a shorter length. What the ends of a step do not show, such as friction that is exceeded for less than a step, is not seen.
//!
//! Equations and sources: [docs/modes.md](../../../../docs/modes.md). The room imports what is directly in `motion`, `motion::rest`, and every
//! room below `motion`.

mod balance;
mod contact;
mod landing;
pub mod resolve;
mod stretch;

use balance::Balance;
use stretch::{Guard, Stretch};

use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::method::step_grid::next_stop;
use crate::motion::ground_pair::GroundPair;
use crate::motion::observer::{Event, Observer};
use crate::motion::rest::impact_accumulation::Accumulation;
use crate::motion::state::{BlockState, Limits, Phase, Stopped};

/// Events at one instant after which a toe that would slip and stick in turn sticks for a step.
const MOST_TURNABOUTS: u32 = 4;

/// Roundings of a step that a step must last to count as one.
const PROGRESS: f64 = 1024.0;

/// Events at one instant after which the block comes to rest, or stays as it is for a step.
const MOST_AT_ONCE: u32 = 12;

/// A block on a base with Coulomb friction.
#[derive(Clone, Copy, Debug)]
pub struct SlidingSystem<S> {
    /// μ, coefficient of friction under the block, static and kinetic.
    pub friction: S,
    /// p², 1/s².
    pub frequency_squared: S,
    /// λ = I_O/(mR²).
    pub inertia: S,
    /// α, rad.
    pub slenderness: S,
    /// R, m.
    pub size: S,
    /// η of an impact after which the toe sticks and before which it did.
    pub restitution: S,
    /// tan α: ground acceleration (in g) above which a block that cannot slide uplifts.
    pub uplift: S,
    /// θ̇ (rad/s) below which an impact may end in rest.
    pub rest_speed: S,
    /// θ̇ (rad/s) below which an impact does not count.
    pub counted_speed: S,
    sin_slenderness: S,
    cos_slenderness: S,
    /// κ: the resultant impulse of an impact acts at κ R sin α from the middle of the base.
    eccentricity: S,
}

/// What the base does on the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Contact {
    /// It sticks.
    #[default]
    Sticks,
    /// It slides, ẋ with this sign.
    Slides(Sign),
}

/// State of a block whose base may slide. Lengths are over R.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlidingState<S> {
    /// Rotation; at rest the block stands or slides on its whole base.
    pub motion: BlockState<S>,
    /// Whether the base slides.
    pub contact: Contact,
    /// x/R, displacement of the base over the ground; positive as the ground's acceleration.
    pub displacement: S,
    /// ẋ/R, 1/s.
    pub slip: S,
    /// Largest |x|/R so far.
    pub farthest: S,
    /// Energy lost to friction while the base slid, over mR²; 1/s².
    pub spent: S,
    /// When the toe left the ground, V = 0, s in the ground segment: the run ends there, for the flight is not modelled.
    pub lifted_off: Option<S>,
}

impl<S: Real> SlidingState<S> {
    /// It stands still on the ground.
    pub fn stands(&self) -> bool {
        self.motion.phase == Phase::Rest && self.contact == Contact::Sticks
    }

    /// Nothing follows any more.
    pub fn has_ended(&self) -> bool {
        self.lifted_off.is_some() || self.motion.phase == Phase::Overturned
    }
}

impl<S: Real> SlidingSystem<S> {
    /// A block let go at θ (rad, not 0) with θ̇ (rad/s), the toe at rest on ground that accelerates by `ground` (horizontal and vertical, in g).
    pub fn released_at(&self, rotation: S, velocity: S, ground: [S; 2]) -> SlidingState<S> {
        let side = Sign::of(rotation, Sign::of(velocity, Sign::Positive));
        let motion = BlockState { rotation, velocity, phase: Phase::Rocking, side, ..BlockState::default() };
        let mut state = SlidingState { motion, ..SlidingState::default() };
        let ground = [ground[0], S::ONE + ground[1]];
        state.lifted_off = self.settle(&mut state, ground).then_some(S::ZERO);
        let turns_to = Sign::of(self.balance(&state, ground).acceleration, side.opposite());
        state.motion.direction = Sign::of(velocity, turns_to);
        state
    }

    /// Follows the block in steps of `step` (s), or shorter ones where the ground moves faster, over `ground` from its local time 0 to
    /// `duration` (s), giving `observer` every interval and event. Intervals end at turns; θ̇ may have an extreme inside one. A state that
    /// has ended stays as it is.
    ///
    /// # Errors
    /// [`Stopped`], with the state as it was then.
    pub fn advance(
        &self,
        step: S,
        state: &mut SlidingState<S>,
        ground: GroundPair<'_, S>,
        duration: S,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) -> Result<(), Stopped> {
        let (mut time, mut tick, mut events, mut at_once) = (S::ZERO, 0_u32, 0_u32, 0_u32);
        let step = ground.step(step);
        if state.motion.phase == Phase::Rocking && !state.has_ended() {
            // The ground may jump here.
            self.settle_seen(state, ground.at(time), time, observer);
        }
        while time < duration && !state.has_ended() {
            let before = time;
            if state.stands() {
                match self.leaves(ground, time, duration) {
                    Some(at) => {
                        time = at;
                        self.leave(state, ground.at(at), at, observer);
                    }
                    None => return Ok(()),
                }
            }
            let BlockState { side, direction, rotation, .. } = state.motion;
            if side == direction && side.times(rotation) >= limits.overturned {
                state.motion.phase = Phase::Overturned;
                observer.event(Event::Overturned, time, &state.motion);
                return Ok(());
            }
            let stop = next_stop(&mut tick, step, time, duration);
            if at_once > MOST_AT_ONCE {
                if self.ends_its_bounces(state, ground, (time, stop), observer) {
                    at_once = 0;
                } else {
                    time = stop;
                }
            } else if !state.has_ended() {
                self.follow(state, ground, (&mut time, stop, duration), at_once <= MOST_TURNABOUTS, limits, observer);
            }
            at_once = if time - before > step * S::EPSILON * S::of(PROGRESS) { 0 } else { at_once + 1 };
            events += 1;
            if !(state.motion.rotation + state.motion.velocity + state.displacement + state.slip).is_finite() {
                return Err(Stopped::NotFinite { time: time.to_f64() });
            }
            if events >= limits.events {
                return Err(Stopped::TooManyEvents { time: time.to_f64(), mode: "the block rocks and slides" });
            }
        }
        Ok(())
    }

    /// One step from `time` to `stop` at most, up to its first event; a toe that sticks slips only if it `may_slip`.
    fn follow(
        &self,
        state: &mut SlidingState<S>,
        ground: GroundPair<'_, S>,
        (time, stop, duration): (&mut S, S, S),
        may_slip: bool,
        limits: &Limits<S>,
        observer: &mut dyn Observer<S>,
    ) {
        let stretch = Stretch::new(self, ground, *state, *time, stop - *time);
        let guards = Guard::ALL.into_iter().filter(|guard| may_slip || *guard != Guard::Grip);
        let (until, found) = stretch.first(guards, |guard, at| stretch.guard(guard, at, limits.overturned));
        stretch.show(until, false, observer);
        *state = stretch.state(until);
        state.farthest = state.farthest.larger(state.displacement.abs());
        let Some(guard) = found else {
            *time = stop;
            return;
        };
        *time = *time + until;
        let here = ground.at(*time);
        match guard {
            Guard::Impact => *time = self.impact(state, ground, *time, duration, observer),
            Guard::Overturned => {
                state.motion.phase = Phase::Overturned;
                observer.event(Event::Overturned, *time, &state.motion);
            }
            Guard::Lift => self.lift_off(state, *time, observer),
            Guard::Turn => {
                state.motion.velocity = S::ZERO;
                state.motion.direction = state.motion.direction.opposite();
                observer.event(Event::Turn, *time, &state.motion);
            }
            Guard::Stop => {
                state.slip = S::ZERO;
                self.stop(state, here, *time, observer);
            }
            Guard::Grip => {
                // Just at the limit rounding might hold it.
                state.contact = Contact::Slides(self.slips_to(state, here));
                observer.event(Event::Slip, *time, &state.motion);
            }
        }
    }

    /// Impact at θ = 0, and what follows it. Returns the time, which rest moves on to the end of the impacts that it stands for.
    fn impact(
        &self,
        state: &mut SlidingState<S>,
        ground: GroundPair<'_, S>,
        time: S,
        duration: S,
        observer: &mut dyn Observer<S>,
    ) -> S {
        let (incoming, before) = (state.motion.velocity, state.contact);
        if incoming.abs() >= self.counted_speed {
            state.motion.impacts += 1;
        }
        let landing = self.land(state.motion.side, incoming, state.slip);
        let direction = Sign::of(incoming, state.motion.direction);
        state.motion = BlockState { rotation: S::ZERO, velocity: landing.velocity, side: direction, direction, ..state.motion };
        state.slip = landing.slip;
        let here = ground.at(time);
        let lifts = self.settle(state, here);
        observer.event(Event::Impact, time, &state.motion);
        if lifts {
            self.lift_off(state, time, observer);
            return time;
        }
        if state.contact != before {
            observer.event(Event::Slip, time, &state.motion);
        }
        let weak = landing.velocity.abs() <= self.rest_speed;
        if weak { self.rest(state, ground, time, duration, observer) } else { time }
    }

    /// After an impact that leaves hardly any speed: rest, a slide on the whole base, or uplift again.
    fn rest(
        &self,
        state: &mut SlidingState<S>,
        ground: GroundPair<'_, S>,
        time: S,
        duration: S,
        observer: &mut dyn Observer<S>,
    ) -> S {
        let (here, speed) = (ground.at(time), state.motion.velocity.abs());
        let nothing = self.rest_speed * S::EPSILON;
        if speed.larger(state.slip.abs()) <= nothing && self.stands(here) {
            state.slip = S::ZERO;
        }
        if state.slip != S::ZERO {
            if self.friction <= self.uplift {
                state.motion = state.motion.rested(state.motion.impacts);
            } else if speed == S::ZERO {
                self.tip(state, Sign::of(state.slip, Sign::Positive), time, observer);
            }
            return time;
        }
        if !self.stands(here) {
            let rate = self.stuck(state.motion.side, S::ZERO, S::ZERO, here).acceleration.abs();
            if self.friction <= self.uplift || speed == S::ZERO || time + speed / rate == time {
                state.motion = state.motion.rested(state.motion.impacts);
                self.leave(state, here, time, observer);
            }
            return time;
        }
        let rates = |side: Sign| {
            let rate = self.stuck(side, S::ZERO, S::ZERO, here).acceleration.abs().larger(S::EPSILON * S::EPSILON);
            (rate, rate)
        };
        let side = state.motion.side;
        let tail = Accumulation::of(rates(side), rates(side.opposite()), self.restitution, speed, self.counted_speed);
        // Where the toe would slip in each of the swings, none of them is worth following.
        let negligible = speed <= nothing || state.contact != Contact::Sticks;
        let Some(ends) = tail.rest(time, duration, negligible, |at| self.stands(ground.at(at))) else { return time };
        observer.accumulation(&tail);
        state.motion = state.motion.rested(state.motion.impacts + tail.impacts);
        if state.contact != Contact::Sticks {
            state.contact = Contact::Sticks;
            observer.event(Event::Slip, ends, &state.motion);
        }
        observer.event(Event::Rest, ends, &state.motion);
        ends
    }

    /// Rest, where bounces at which the toe slips, which shrink in proportion, have become shorter than time resolves: they accumulate here. Whether
    /// it has come to rest, to stand for some of the time until `stop`.
    fn ends_its_bounces(
        &self,
        state: &mut SlidingState<S>,
        ground: GroundPair<'_, S>,
        (time, stop): (S, S),
        observer: &mut dyn Observer<S>,
    ) -> bool {
        let BlockState { phase, rotation, velocity, impacts, .. } = state.motion;
        let weak = velocity.abs().larger(state.slip.abs()) <= self.rest_speed && rotation.abs() <= self.slenderness * S::EPSILON;
        if phase != Phase::Rocking || !weak || self.leaves(ground, time, stop).is_some_and(|at| at <= time) {
            return false;
        }
        state.slip = S::ZERO;
        state.motion = state.motion.rested(impacts);
        if state.contact != Contact::Sticks {
            state.contact = Contact::Sticks;
            observer.event(Event::Slip, time, &state.motion);
        }
        observer.event(Event::Rest, time, &state.motion);
        true
    }

    /// The toe has left the ground: a fall beyond the angle at which friction could hold it goes on, and any other run ends here.
    fn lift_off(&self, state: &mut SlidingState<S>, time: S, observer: &mut dyn Observer<S>) {
        if state.motion.side == state.motion.direction && self.is_falling(state) {
            state.motion.phase = Phase::Overturned;
            observer.event(Event::Overturned, time, &state.motion);
        } else {
            state.lifted_off = Some(time);
        }
    }

    /// Accelerations and reactions of the present mode.
    fn balance(&self, state: &SlidingState<S>, ground: [S; 2]) -> Balance<S> {
        let BlockState { phase, side, rotation, velocity, .. } = state.motion;
        match (phase, state.contact) {
            (Phase::Rocking, Contact::Sticks) => self.stuck(side, rotation, velocity, ground),
            (Phase::Rocking, Contact::Slides(direction)) => self.sliding(side, direction, rotation, velocity, ground),
            (_, Contact::Slides(direction)) => self.flat(direction, ground),
            (_, Contact::Sticks) => self.still(ground),
        }
    }
}

#[cfg(test)]
mod tests;
