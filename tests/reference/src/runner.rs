//! From stop to stop: steps, guards after each, bisection by stepping anew.

use crate::actuation::Command;
use crate::device::Coupling;
use crate::effort::Effort;
use crate::equation::{Model, Shaking};
use crate::guard::{Guard, guards};
use crate::ledger::{Ledger, energy};
use crate::mode::{BlockMode, Link, State, Wheel};
use crate::simulate::{Run, overturned_after};
use crate::step::{INPUT, ROTATION, SIZE, SPIN, VELOCITY, step};

/// Events within this time (s) of one another count as one instant …
const INSTANT: f64 = 1e-10;
/// … of which so many at standstill are rounding that decides between what holds and what pushes: both are as good as equal.
const GRAZE: usize = 20;
/// A block that grazes stands still for this long (s); then the faster of both has won.
const PAUSE: f64 = 1e-9;
/// Steps (s) of a block whose clutch opens and closes without end …
const CHATTER: f64 = 1e-6;
/// … which does not any more where so many of them ask for the same.
const ALIKE: usize = 1000;
/// Rotations (rad) up to which a block has not moved: it was on the verge.
const STANDS: f64 = 1e-15;
/// So many events in one instant are a mode that contradicts itself.
const MOST_AT_ONCE: usize = 100;

/// A model on its way.
#[derive(Debug)]
pub(crate) struct Runner<'a> {
    model: &'a Model,
    state: State,
    largest: f64,
    events: usize,
    kinks: Vec<f64>,
    next_kink: usize,
    /// An instant inside the present piece of ground motion.
    within: f64,
}

impl<'a> Runner<'a> {
    /// At the start, with θ and θ̇.
    pub fn new(model: &'a Model, rotation: f64, velocity: f64, effort: Effort) -> Runner<'a> {
        let link = match model.device.coupling {
            Coupling::Inerter => Link::Locked,
            Coupling::Slip { permanent: true, .. } => Link::Dragged,
            _ => Link::Open,
        };
        let wheel = Wheel { link, turning: None, command: Command::default(), lent: 0.0 };
        let mut other = wheel;
        other.link = Link::Open;
        let mut values = [0.0; SIZE];
        (values[ROTATION], values[VELOCITY]) = (rotation, velocity);
        let sign = |value: f64| if value < 0.0 { -1.0 } else { 1.0 };
        let direction = if velocity != 0.0 { sign(velocity) } else { -sign(rotation) };
        let block = match (rotation == 0.0, velocity == 0.0) {
            (true, true) => BlockMode::Standing,
            (true, false) => BlockMode::Rocking { side: direction, direction },
            (false, _) => BlockMode::Rocking { side: sign(rotation), direction },
        };
        let state = State {
            time: 0.0,
            values,
            block,
            wheels: [wheel, other],
            drive: direction,
            terminals: direction,
            armed: true,
            engagements: 0,
            weak: false,
            impacts: 0,
            load: 1.0,
            slipped: None,
        };
        let mut kinks = [model.horizontal.kinks(), model.vertical.kinks(), model.support.kinks()].concat();
        kinks.sort_by(f64::total_cmp);
        kinks.dedup_by(|later, sooner| *later - *sooner < 1e-12);
        let mut runner =
            Runner { model, state, largest: effort.largest_step(model), events: effort.events, kinks, next_kink: 0, within: 0.0 };
        runner.enter_piece();
        runner
    }

    /// The piece of ground motion that begins now.
    fn enter_piece(&mut self) {
        let time = self.state.time;
        while self.next_kink < self.kinks.len() && self.kinks[self.next_kink] <= time {
            self.next_kink += 1;
        }
        let end = self.kinks.get(self.next_kink).copied().unwrap_or(time + 1.0);
        self.within = time + (end - time) / 2.0;
    }

    fn shaking(&self, time: f64) -> Shaking {
        self.model.shaking(time, self.within)
    }

    /// The state at `time` (s), in the present modes. Steps go from one number of the clock to another, or the ground would move
    /// by another step than the block.
    fn ahead(&self, time: f64) -> State {
        let start = self.state.time;
        let mut state = self.state.clone();
        state.values = step(&self.state.values, time - start, |t, values| {
            self.model.rates(&self.state, start + t, values, self.shaking(start + t))
        });
        state.time = time;
        self.model.follow_rack(&mut state);
        state
    }

    fn fired(&self, state: &State) -> Option<Guard> {
        let all = guards(self.model, state, self.shaking(state.time));
        all.into_iter().find(|(_, value)| *value < 0.0).map(|(guard, _)| guard)
    }

    /// The next instant at which a clock runs out.
    fn next_clock(&self) -> f64 {
        let mut next = f64::INFINITY;
        for wheel in &self.state.wheels {
            if let Some(due) = wheel.command.due {
                next = next.min(due);
            }
            let line = wheel.command.line_ends(&self.model.device, self.state.time);
            if let Some(end) = line.filter(|end| wheel.link != Link::Open && *end > self.state.time) {
                next = next.min(end);
            }
        }
        next
    }

    /// Where it is.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Runs to `end`, with samples at multiples of `interval`; impacts from the speed `counted` (rad/s) on count.
    pub fn follow(&mut self, end: f64, interval: f64, counted: f64) -> Result<Run, String> {
        let model = self.model;
        // What is always locked moves with the block from the start.
        model.follow_rack(&mut self.state);
        if self.state.wheels[0].link == Link::Dragged {
            self.state.values[SPIN] = model.rack_now(&self.state);
        }
        let (mut impacts, mut peak) = (0, self.state.rotation().abs());
        let (mut samples, mut events) = (Vec::new(), Vec::new());
        let mut at_once = 0;
        if self.state.block != BlockMode::Standing {
            let shaking = self.shaking(0.0);
            model.look_at_drive(&mut self.state, shaking);
        }
        let shaking = self.shaking(0.0);
        model.begin_terminals(&mut self.state, shaking);
        model.settle(&mut self.state, shaking);
        // The books begin with what the first instant has left.
        self.state.values[INPUT..].fill(0.0);
        let initial = energy(model, &self.state);
        samples.push([0.0, self.state.rotation(), self.state.velocity()]);
        // Steps, with one more for whatever may cut one in two.
        let mut left = end / self.largest + end / interval + self.kinks.len() as f64 + self.events as f64;
        while self.state.time < end && self.state.block != BlockMode::Overturned {
            let time = self.state.time;
            left -= 1.0;
            if left < 0.0 {
                return Err(format!("no end by {time} s: {:?}, {:?}", events.last(), self.state));
            }
            let sample = samples.len() as f64 * interval;
            let kink = self.kinks.get(self.next_kink).copied().unwrap_or(f64::INFINITY);
            let clock = self.next_clock();
            let stop = end.min(sample).min(kink).min(clock).max(time);
            let goal = stop.min(time + self.largest);
            let next = self.ahead(goal);
            if goal > time && self.fired(&next).is_some() {
                let (guard, at) = self.locate(goal);
                let slow = |state: &State| state.velocity().abs() < 1e-6 * counted;
                if guard == Guard::Impact && self.state.rotation() == 0.0 && self.state.velocity() == 0.0 && slow(&at) {
                    // It has set out on the verge, and rounding has thrown it back: it has not moved, and its clutches keep their commands.
                    self.pause();
                    continue;
                }
                if let (Guard::Impact, true) = (guard, at.velocity().abs() >= counted) {
                    impacts += 1;
                }
                at_once = if at.time - time > INSTANT { 0 } else { at_once + 1 };
                self.state = at;
                peak = peak.max(self.state.rotation().abs());
                events.push((self.state.time, guard));
                if events.len() > self.events {
                    let most = self.events;
                    return Err(format!("more than {most} events by {} s: {guard:?}, {:?}", self.state.time, self.state));
                }
                if at_once > MOST_AT_ONCE {
                    return Err(format!("the modes contradict themselves at {} s: {guard:?}, {:?}", self.state.time, self.state));
                }
                let shaking = self.shaking(self.state.time);
                model.answer(&mut self.state, guard, shaking);
                if at_once > GRAZE && slow(&self.state) {
                    self.pause();
                } else if at_once > GRAZE && guard == Guard::Command {
                    self.chatter(stop);
                    peak = peak.max(self.state.rotation().abs());
                }
                continue;
            }
            self.state = next;
            peak = peak.max(self.state.rotation().abs());
            let shaking = self.shaking(self.state.time);
            if !self.state.armed && self.state.drive * model.drive(&self.state, shaking) > 0.0 {
                self.state.armed = true;
            }
            if !self.state.values.iter().all(|value| value.is_finite()) {
                return Err(format!("not finite at {} s", self.state.time));
            }
            if goal == stop {
                if stop >= sample {
                    samples.push([stop, self.state.rotation(), self.state.velocity()]);
                }
                self.pass(stop, kink, clock);
            }
        }
        let outcome = match (self.state.block, peak > STANDS) {
            (BlockMode::Overturned, _) => overturned_after(impacts),
            (_, false) => "no-rocking",
            _ => "safe",
        };
        let ledger = Ledger { initial, present: energy(model, &self.state), values: self.state.values };
        Ok(Run { outcome, step: self.largest, peak, impacts, samples, ledger, events })
    }

    /// A block on the verge of moving stands for a moment, with its clutches as they are.
    fn pause(&mut self) {
        self.state.values[VELOCITY] = 0.0;
        self.model.follow_rack(&mut self.state);
        self.state.block = match self.state.rotation() == 0.0 {
            true => BlockMode::Standing,
            false => BlockMode::Held { side: self.state.rotation().signum() },
        };
        self.state = self.ahead(self.state.time + PAUSE);
        let shaking = self.shaking(self.state.time);
        self.model.settle(&mut self.state, shaking);
    }

    /// A clutch that opens and closes without end, up to `stop` (s): a flywheel that runs ahead drives the block back over the zero of Eq. 10 while
    /// it is engaged. Short steps, each with the command that its start asks for, until many ask for the same or another guard fires.
    fn chatter(&mut self, stop: f64) {
        let model = self.model;
        let mut alike = 0;
        while alike < ALIKE && self.state.time < stop {
            let next = self.ahead(stop.min(self.state.time + CHATTER));
            let shaking = self.shaking(next.time);
            if guards(model, &next, shaking).iter().any(|(guard, value)| *value < 0.0 && *guard != Guard::Command) {
                break;
            }
            let before = self.state.drive;
            self.state = next;
            model.look_at_drive(&mut self.state, shaking);
            alike += 1;
            if self.state.drive != before {
                model.settle(&mut self.state, shaking);
                alike = 0;
            }
        }
    }

    /// Kinks of the ground and clocks at a stop.
    fn pass(&mut self, stop: f64, kink: f64, clock: f64) {
        let model = self.model;
        if stop >= kink {
            let before = self.shaking(stop);
            self.enter_piece();
            let after = self.shaking(stop);
            let jumps = [after.horizontal - before.horizontal, after.vertical - before.vertical, after.support - before.support];
            let jump: f64 = jumps.iter().map(|jump| jump.abs()).sum();
            if jump > 1e-9 {
                if self.state.velocity() != 0.0 || model.follows_terminals() {
                    model.look_at_drive(&mut self.state, after);
                    model.look_at_terminals(&mut self.state, after);
                }
                model.settle(&mut self.state, after);
            } else if model.follows_terminals() && after.support == 0.0 && self.shaking(self.within).support == 0.0 {
                // Where the support accelerates no more, a block that stands wants no clutch, however gently that came.
                model.settle(&mut self.state, after);
            }
        }
        if stop >= clock {
            let shaking = self.shaking(stop);
            model.settle(&mut self.state, shaking);
        }
    }

    /// The first guard that fires until `end` (s), and the state just after.
    fn locate(&self, end: f64) -> (Guard, State) {
        let (mut before, mut after) = (self.state.time, end);
        for _ in 0..100 {
            let middle = before + 0.5 * (after - before);
            if middle <= before || middle >= after {
                break;
            }
            if self.fired(&self.ahead(middle)).is_some() {
                after = middle;
            } else {
                before = middle;
            }
        }
        let state = self.ahead(after);
        let guard = self.fired(&state).unwrap_or(Guard::Turn);
        (guard, state)
    }
}
