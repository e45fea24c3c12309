//! Actuation of the clutch: commands by the signs of Eq. 10, delays, dwell and missed commands.

use super::{HybridState, HybridSystem};
use crate::drivetrain::clutch_state::{Coupling, FlywheelState, Guard};
use crate::drivetrain::scaled_parameters::ScaledParameters;
use crate::drivetrain::under_way::UnderWay;
use crate::equation::clutch_rule::wheel_for;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::math::split_mix;
use crate::motion::observer::Observer;
use crate::motion::state::{BlockState, Phase};
use crate::structure::drivetrain::{Actuation, Delay};

/// Actuator between a command and its clutch: delays, dwell, misses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Actuator<S> {
    /// Delay of an engagement, s.
    pub engagement_delay: S,
    /// Delay of a release, s.
    pub release_delay: S,
    /// Transport delay: a command takes effect even if another one follows before its delay is over.
    pub transport: bool,
    /// Dwell: least time between two moves, s.
    pub dwell: S,
    /// Miss probability in units of 2⁻³².
    pub misses: u64,
    /// Seed of the misses.
    pub seed: u64,
    /// Commands come from a controller ([`HybridSystem::order`]) and not from the signs of Eq. 10.
    pub controlled: bool,
}

impl<S: Real> Actuator<S> {
    /// Actuator of an actuation within its ranges.
    pub fn of(actuation: &Actuation) -> Actuator<S> {
        Actuator {
            engagement_delay: S::of(actuation.engagement_delay),
            release_delay: S::of(actuation.release_delay),
            transport: actuation.delay == Delay::Transport,
            dwell: S::of(actuation.dwell),
            misses: (actuation.miss_probability * 4_294_967_296.0) as u64,
            seed: actuation.miss_seed,
            controlled: false,
        }
    }

    /// Whether its clutches move later than they are commanded.
    pub(super) fn is_late(&self) -> bool {
        self.engagement_delay.larger(self.release_delay).larger(self.dwell) > S::ZERO
    }

    /// Whether engagement number `count` is missed: SplitMix64 of seed and number, so that it depends on nothing else.
    pub fn misses(&self, count: u32) -> bool {
        (split_mix::word(self.seed, u64::from(count)) >> 32) < self.misses
    }
}

/// Largest number of answers to one event: a jolt may change the signs that caused it.
const MOST_ANSWERS: usize = 4;

/// Time (s) until the line of a rising capacity ends, or overcomes the friction that holds a standing flywheel.
fn ramp_due<S: Real>(parameters: &ScaledParameters<S>, wheel: &FlywheelState<S>, block_held: bool) -> Option<S> {
    let line = parameters.line_at(wheel.engaged_for).filter(|_| wheel.coupling.is_engaged())?;
    let end = line.time[1] - wheel.engaged_for;
    let (capacity, growth) = parameters.capacity_of(wheel);
    let held = match wheel.coupling {
        Coupling::Slipping(_) | Coupling::Saturated(_) | Coupling::Elastic(_) => wheel.turning.is_none(),
        Coupling::Locked => block_held,
        Coupling::Open | Coupling::Viscous | Coupling::InPlay => false,
    };
    if !held || parameters.standing_friction(wheel).1 == S::ZERO {
        return Some(end);
    }
    Some(((parameters.inertance * parameters.bearing_dry - capacity) / growth).smaller(end))
}

impl<S: Real> HybridSystem<S> {
    /// Gives the commands that the present signs ask for, and executes those that are due.
    pub(super) fn command(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) {
        if !self.transmission.traits().commanded || state.motion.phase != Phase::Rocking {
            return;
        }
        state.weak = state.weak && self.is_slow(&state.motion);
        for answer in 0..MOST_ANSWERS {
            if answer > 0 {
                self.show_instant(state, time, observer);
            }
            let way = state.device.terminals.map_or(state.motion.direction, |terminals| terminals.direction);
            let resists = way == state.motion.terminal_acceleration_sign;
            // A block that friction holds has no motion to resist: its commands stay.
            if !self.actuator.controlled && !state.held {
                self.ask(state, resists.then_some(way));
            }
            let (velocity, direction) = (state.motion.velocity, state.motion.direction);
            let moved = self.carry_out_due(state, time, observer);
            if state.motion.velocity == velocity {
                if moved && self.transmission.traits().holds && velocity == S::ZERO {
                    // The bearings of a wheel that has just been engaged may hold the block, those of a released one let it go, and a
                    // spring that is let go moves it no more.
                    state.free = false;
                    if self.try_to_set_off(state, time, observer) {
                        // It has a motion again, which Eq. 10 looks at.
                        continue;
                    }
                    if state.motion.direction != direction {
                        self.look_at_drive(state);
                        continue;
                    }
                }
                if moved {
                    // One clutch changes the force on the other.
                    self.settle(state, time, observer);
                }
                return;
            }
            if state.motion.direction != direction {
                self.look_at_drive(state);
            } else {
                // A jolt that only slows the block down leaves the sign that asked for it, or a clutch would chatter at its zero.
                state.jolted = self.terminal_acceleration_sign(state) != state.motion.terminal_acceleration_sign;
            }
            self.settle(state, time, observer);
        }
    }

    /// Whether a swing that set out too slowly to count still does: nowhere near the speed and the rotation that matter.
    fn is_slow(&self, motion: &BlockState<S>) -> bool {
        motion.velocity.abs().larger(motion.rotation.abs() * self.speed / self.slenderness) <= self.counted_speed
    }

    /// A controller's command to each clutch, at local time 0 of the ground segment that follows. It takes effect after the
    /// delay, at once where there is none.
    pub fn order(&self, state: &mut HybridState<S>, wanted: [bool; 2], observer: &mut dyn Observer<S>) {
        // What is to be released is released first, so that two that change places are never both engaged.
        for engage in [false, true] {
            for (index, &wish) in wanted.iter().enumerate() {
                if wish == engage {
                    self.give(state, index, wish);
                }
            }
            if state.motion.phase == Phase::Rocking {
                self.command(state, S::ZERO, observer);
            } else if state.motion.phase == Phase::Rest {
                self.carry_out_at_rest(state, S::ZERO, observer);
            }
        }
    }

    /// Clutches of a standing block that have been commanded for long.
    pub fn preset(&self, state: &mut HybridState<S>, engaged: [bool; 2]) {
        for (index, &engage) in engaged.iter().enumerate() {
            let wheel = &mut state.device.wheels[index & 1];
            (wheel.commanded, wheel.obeys, wheel.dwell) = (engage, true, S::ZERO);
            (wheel.pending, wheel.under_way) = (-S::ONE, UnderWay::default());
            if engage {
                self.with_instant(state, S::ZERO, &mut (), |transmission, at| transmission.engage(at, index));
            }
        }
        state.motion.velocity = S::ZERO;
    }

    /// Commands to the clutches of a standing block that are due.
    pub(super) fn carry_out_at_rest(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) {
        self.carry_out_due(state, time, observer);
        if self.swings(state) {
            self.stay_on_base(state, time, observer);
        }
    }

    /// Commands for a motion in the direction `way`, which the clutch of that direction is to resist; none is to be engaged without one.
    pub(super) fn ask(&self, state: &mut HybridState<S>, way: Option<Sign>) {
        let wheel = way.map(wheel_for);
        for index in 0..2 {
            self.give(state, index, wheel == Some(index));
        }
    }

    /// A command to one clutch, if it is new.
    fn give(&self, state: &mut HybridState<S>, index: usize, engage: bool) {
        let device = &mut state.device;
        let wheel = &mut device.wheels[index];
        if wheel.commanded == engage {
            return;
        }
        wheel.commanded = engage;
        let open = !wheel.coupling.is_engaged();
        let delay = if engage {
            // Of the bounces of a dying motion the rest threshold decides how many there are: they have no number, and miss nothing.
            let counts = self.actuator.controlled || !state.weak;
            device.engagements += u32::from(counts);
            wheel.obeys = !(counts && self.actuator.misses(device.engagements));
            device.missed += u32::from(!wheel.obeys);
            self.actuator.engagement_delay
        } else {
            self.actuator.release_delay
        };
        if self.actuator.transport {
            if wheel.obeys || !engage {
                let soonest = if wheel.pending < S::ZERO { delay.larger(wheel.dwell) } else { delay };
                wheel.pending = wheel.under_way.send(engage, soonest, wheel.pending);
            }
            return;
        }
        // Where it is already what it shall be, an older command is only taken back.
        let moves = if engage { open && wheel.obeys } else { !open };
        wheel.pending = if moves { delay.larger(wheel.dwell) } else { -S::ONE };
    }

    /// Whether the command that is due is one to engage.
    fn due_command(&self, wheel: &FlywheelState<S>) -> bool {
        if self.actuator.transport { wheel.under_way.first() } else { wheel.commanded }
    }

    /// Carries out the commands that are due, releases before engagements, so that two clutches that change places are never both engaged; those to
    /// one clutch in their order. Returns whether there were any.
    fn carry_out_due(&self, state: &mut HybridState<S>, time: S, observer: &mut dyn Observer<S>) -> bool {
        let is_due = |wheel: &FlywheelState<S>| wheel.pending == S::ZERO;
        let mut any = false;
        while state.device.wheels.iter().any(is_due) {
            any = true;
            for engage in [false, true] {
                for index in 0..2 {
                    let wheel = &state.device.wheels[index];
                    if !is_due(wheel) || self.due_command(wheel) != engage {
                        continue;
                    }
                    self.carry_out(state, index, time, observer);
                    if state.motion.phase == Phase::Rest {
                        state.motion.velocity = S::ZERO;
                    }
                    if is_due(&state.device.wheels[index]) {
                        // An infinite brake has the flywheel before it is engaged again, and an ideal clutch has created its energy before it opens.
                        self.show_instant(state, time, observer);
                    }
                }
            }
        }
        any
    }

    #[inline(never)]
    fn carry_out(&self, state: &mut HybridState<S>, index: usize, time: S, observer: &mut dyn Observer<S>) {
        let wheel = &mut state.device.wheels[index];
        let engage = self.due_command(wheel);
        // By a transport delay a command may find the clutch as it shall be: the one before it was missed.
        let moves = engage != wheel.coupling.is_engaged();
        if moves {
            (wheel.dwell, wheel.engaged_for) = (self.actuator.dwell, S::ZERO);
        }
        wheel.pending = if self.actuator.transport { wheel.under_way.arrived(wheel.dwell) } else { -S::ONE };
        if !moves {
            return;
        }
        let wheel = &mut state.device.wheels[index];
        if engage && wheel.coupling == Coupling::Open && wheel.spin.abs() <= self.speed * S::EPSILON {
            // It turns by less than rounding, and the sign of that would decide which way a block at its turn goes.
            wheel.spin = S::ZERO;
        }
        self.with_instant(state, time, observer, |transmission, at| {
            if engage {
                transmission.engage(at, index);
            } else {
                at.open(index);
            }
        });
        // The acceleration of Eq. 10, and the velocity, do not depend on the clutches.
        let flywheels = if state.device.terminals.is_some() { 2 } else { 1 };
        state.fresh[flywheels..].fill(false);
    }

    /// Time until something happens by the clock alone, s; none if nothing is due.
    pub fn next_due(&self, state: &HybridState<S>) -> Option<S> {
        if !self.transmission.traits().commanded {
            return None;
        }
        let parameters = &self.transmission.parameters;
        let wheels = state.device.wheels.iter().filter(|_| parameters.rise_time > S::ZERO);
        let ramps = wheels.filter_map(|wheel| ramp_due(parameters, wheel, state.held));
        state.device.next_due().into_iter().filter(|time| *time > S::ZERO).chain(ramps).reduce(S::smaller)
    }

    /// `stop`, or the instant before it at which something happens by the clock alone.
    pub(super) fn until_due(&self, state: &mut HybridState<S>, time: S, stop: S) -> S {
        let Some(due) = self.next_due(state) else { return stop };
        let stop = stop.smaller(time + due);
        if stop <= time {
            // What is due within rounding of now is due now.
            state.device.elapse(due);
        }
        stop
    }

    /// A clock has run out: a rising capacity may start a flywheel that stood.
    pub(super) fn ramps(&self, state: &mut HybridState<S>) {
        let parameters = &self.transmission.parameters;
        for wheel in state.device.wheels.iter_mut().filter(|_| parameters.rise_time > S::ZERO) {
            if let (Some(sign), None) = (wheel.coupling.slip_sign(), wheel.turning)
                && parameters.overcomes_bearings(wheel)
            {
                // As [`ramp_due`] sees it: what it waits for no more has come.
                wheel.turning = Some(sign);
            }
        }
    }

    /// Takes the sign of the terminals' acceleration as it is now.
    #[inline(never)]
    pub(super) fn look_at_drive(&self, state: &mut HybridState<S>) {
        if self.transmission.traits().commanded {
            (state.motion.terminal_acceleration_sign, state.jolted) = (self.terminal_acceleration_sign(state), false);
        }
    }

    /// Sign of the terminals' acceleration under weight and ground in the present state; where it is zero, as it was.
    #[inline(never)]
    fn terminal_acceleration_sign(&self, state: &HybridState<S>) -> Sign {
        let motion = &state.motion;
        let law = self.transmission.law(motion.direction, Sign::Positive, &state.device);
        let point = self.point(&law, motion.side, &self.place(state));
        Sign::of(self.transmission.guard(&point, S::ZERO, Guard::Command(S::ONE)), motion.terminal_acceleration_sign)
    }
}
