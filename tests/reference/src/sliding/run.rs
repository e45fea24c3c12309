//! A run: steps of Runge-Kutta, what they find looked for by bisection.

use std::path::Path;

use super::body::{Body, State};
use super::impact::{eccentricity, land};
use super::mode::{Mode, find};
use crate::block::{Block, GRAVITY, Restitution};
use crate::ground::Ground;
use crate::scene::Scene;
use crate::simulate::overturned_after;

/// What a block did.
#[derive(Clone, Debug, Default)]
pub struct SlidingRun {
    /// In Sprag's words.
    pub outcome: &'static str,
    /// Impacts that came in with more than 1e-6 pα.
    pub impacts: usize,
    /// Time (s), θ (rad) and displacement of the base (m) at multiples of the output interval.
    pub samples: Vec<[f64; 3]>,
    /// max |x|, m.
    pub farthest: f64,
}

/// Speed that rounding leaves to a base that sticks, m/s.
const NEGLIGIBLE: f64 = 1e-12;

struct Runner {
    body: Body,
    horizontal: Ground,
    vertical: Ground,
    place: f64,
    rest_speed: f64,
    counted: f64,
    slenderness: f64,
}

/// Runs the block of `scene`, whose records lie in `folder`, in steps of `resolution`/p.
///
/// # Errors
/// A scene that cannot be read, or events without end, in words.
pub fn run(scene: &Scene, folder: &Path, resolution: f64) -> Result<SlidingRun, String> {
    let (block, restitution) = Block::of(&scene.block)?;
    let eta = match restitution {
        Restitution::Constant(value) => value,
        _ => block.geometric_restitution(),
    };
    let body = Body::of(&block, scene.block.friction_coefficient.ok_or("friction_coefficient")?);
    let p = block.frequency_parameter();
    let unit = p * block.slenderness;
    let runner = Runner {
        body,
        horizontal: Ground::of(&scene.ground, &block, folder)?,
        vertical: Ground::of(&scene.vertical, &block, folder)?,
        place: eccentricity(&body, eta),
        rest_speed: scene.run.rest_speed_ratio.unwrap_or(1e-6) * unit,
        counted: 1e-6 * unit,
        slenderness: block.slenderness,
    };
    let free = scene.run.free_time_s.unwrap_or(scene.run.free_time_ratio.unwrap_or(20.0) / p);
    let end = runner.horizontal.end().max(runner.vertical.end()) + free;
    let tilt = scene.block.initial_rotation_ratio * block.slenderness;
    let interval = scene.output.interval_s.unwrap_or(end / 2000.0);
    runner.follow(tilt, end, interval, resolution / p)
}

impl Runner {
    /// Acceleration of everything relative to the ground at `time`, by the formula that holds at `within`.
    fn field(&self, time: f64, within: f64) -> [f64; 2] {
        [-self.horizontal.at(time, within), -GRAVITY - self.vertical.at(time, within)]
    }

    fn rates(&self, state: &State, mode: Mode, field: [f64; 2]) -> State {
        let forces = mode.forces(&self.body, state, field);
        let slip = self.body.velocity(mode.point(&self.body), state)[0];
        State { position: state.rates, rates: forces.accelerations, spent: (forces.force[0] * slip).abs() }
    }

    fn step(&self, state: &State, mode: Mode, time: f64, h: f64) -> State {
        let within = time + 0.5 * h;
        let field = |at: f64| self.field(time + at, within);
        let plus = |rates: &State, h: f64| {
            let mut sum = *state;
            for i in 0..3 {
                sum.position[i] += h * rates.position[i];
                sum.rates[i] += h * rates.rates[i];
            }
            sum.spent += h * rates.spent;
            sum
        };
        let first = self.rates(state, mode, field(0.0));
        let second = self.rates(&plus(&first, 0.5 * h), mode, field(0.5 * h));
        let third = self.rates(&plus(&second, 0.5 * h), mode, field(0.5 * h));
        let fourth = self.rates(&plus(&third, h), mode, field(h));
        let mut mean = first;
        for i in 0..3 {
            mean.position[i] = (first.position[i] + 2.0 * (second.position[i] + third.position[i]) + fourth.position[i]) / 6.0;
            mean.rates[i] = (first.rates[i] + 2.0 * (second.rates[i] + third.rates[i]) + fourth.rates[i]) / 6.0;
        }
        mean.spent = (first.spent + 2.0 * (second.spent + third.spent) + fourth.spent) / 6.0;
        self.on_ground(plus(&mean, h), mode)
    }

    /// The state with its contact exactly on the ground, and at rest there if it sticks.
    fn on_ground(&self, mut state: State, mode: Mode) -> State {
        let point = mode.point(&self.body);
        state.position[1] -= self.body.clearance(point, &state);
        let [along, up] = self.body.velocity(point, &state);
        state.rates[1] -= up;
        if mode.slides == 0.0 {
            state.rates[0] -= along;
        }
        state
    }

    /// What the mode keeps positive: the other corner above the ground, the direction of its slide, its own margin, and no overturning.
    fn guards(&self, state: &State, mode: Mode, field: [f64; 2]) -> [f64; 4] {
        let slip = self.body.velocity(mode.point(&self.body), state)[0];
        // Its height is 2 b sin |θ|, which would drown in the rounding of heights.
        let above = mode.corner.map_or(1.0, |corner| corner * state.position[2]);
        let slides = if mode.slides == 0.0 { 1.0 } else { mode.slides * slip };
        let begins = State { position: state.position, rates: state.rates, spent: 1.0 };
        [above, slides, mode.margin(&self.body, &begins, field, false), std::f64::consts::FRAC_PI_2 - state.position[2].abs()]
    }

    fn follow(&self, tilt: f64, end: f64, interval: f64, longest: f64) -> Result<SlidingRun, String> {
        let mut run = SlidingRun::default();
        let mut state = State { position: [0.0, 0.0, tilt], ..State::default() };
        let mut corner = (tilt != 0.0).then(|| tilt.signum());
        if let Some(corner) = corner {
            let start =
                self.body.arm(corner * self.body.half_width, 0.0)[0] - self.body.arm(corner * self.body.half_width, tilt)[0];
            state.position[0] = start;
            state.position[1] = -self.body.clearance(corner * self.body.half_width, &state);
        }
        let mut kinks = [self.horizontal.kinks(), self.vertical.kinks()].concat();
        kinks.push(end);
        kinks.retain(|time| *time > 0.0 && *time <= end);
        kinks.sort_by(f64::total_cmp);
        let mut barred = None;
        let (mut time, mut next, mut slip, mut events, mut rocked, mut hit) = (0.0, 0_usize, 0.0, 0, tilt != 0.0, false);
        let ended = |rocked: bool| if rocked { "safe" } else { "no-rocking" };
        while time < end {
            let kink = kinks.iter().copied().find(|kink| *kink > time).unwrap_or(end);
            // Just after the instant, on the side of the piece that begins.
            let within = time + 1e-9 * (kink - time).min(longest);
            let Some(mode) = find(&self.body, &state, (corner, slip), barred, self.field(time, within)) else {
                // Beyond the cone of friction no force at the toe had turned it back.
                let falls = state.position[2].abs() > self.slenderness + self.body.friction.atan();
                let falls = falls && state.position[2] * state.rates[2] > 0.0;
                run.outcome = if falls { overturned_after(usize::from(hit)) } else { "lifted-off" };
                return Ok(run);
            };
            corner = mode.corner;
            rocked |= corner.is_some();
            loop {
                if time >= kink {
                    break;
                }
                while next as f64 * interval <= time + 1e-12 {
                    let x = self.body.displacement(mode.point(&self.body), &state);
                    run.samples.push([next as f64 * interval, state.position[2], x]);
                    next += 1;
                }
                let until = (time + longest).min(kink).min((next as f64 * interval).max(time + 1e-12));
                let h = until - time;
                let look = |h: f64| {
                    let there = self.step(&state, mode, time, h);
                    (there, self.guards(&there, mode, self.field(time + h, time + 0.5 * h)))
                };
                let (there, guards) = look(h);
                barred = None;
                if guards.iter().all(|guard| *guard >= 0.0) {
                    (state, time) = (there, until);
                    run.farthest = run.farthest.max(self.body.displacement(mode.point(&self.body), &state).abs());
                    slip = if mode.slides == 0.0 { 0.0 } else { self.body.velocity(mode.point(&self.body), &state)[0] };
                    continue;
                }
                let (mut low, mut high) = (0.0, h);
                for _ in 0..80 {
                    let middle = 0.5 * (low + high);
                    if look(middle).1.iter().all(|guard| *guard >= 0.0) { low = middle } else { high = middle }
                }
                let (there, guards) = look(high);
                (state, time) = (there, time + high);
                run.farthest = run.farthest.max(self.body.displacement(mode.point(&self.body), &state).abs());
                if guards[3] < 0.0 {
                    run.outcome = overturned_after(usize::from(hit));
                    return Ok(run);
                }
                // What has just found its limit does not hold any more, whatever rounding says.
                barred = (guards[2] < 0.0 && guards[0] >= 0.0).then_some(mode);
                if guards[1] < 0.0 {
                    slip = 0.0;
                    state = self.on_ground(state, Mode { slides: 0.0, ..mode });
                } else if mode.slides == 0.0 {
                    slip = 0.0;
                }
                if let (true, Some(old)) = (guards[0] < 0.0, mode.corner) {
                    hit = true;
                    run.impacts += usize::from(state.rates[2].abs() > self.counted);
                    let x = self.body.displacement(old * self.body.half_width, &state);
                    (state.position, corner) = ([x, 0.0, 0.0], Some(-old));
                    state = land(&self.body, &state, -old, self.place);
                    slip = self.body.velocity(-old * self.body.half_width, &state)[0];
                    slip = if slip.abs() <= NEGLIGIBLE { 0.0 } else { slip };
                    if state.rates[2].abs() <= self.rest_speed {
                        let base = Mode { corner: None, slides: if slip == 0.0 { 0.0 } else { slip.signum() } };
                        (state.rates, corner) = ([slip, 0.0, 0.0], None);
                        state = self.on_ground(state, base);
                    }
                }
                break;
            }
            events += 1;
            if events > 20_000 {
                return Err(format!("events without end at {time} s"));
            }
        }
        run.outcome = ended(rocked);
        Ok(run)
    }
}
