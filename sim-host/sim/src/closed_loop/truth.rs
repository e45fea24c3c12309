//! What sensors on the block, on the ground and on the rack would read if they were perfect.

use sprag_shared::equation::any_body::AnyConfiguration;
use sprag_shared::equation::body::Body;
use sprag_shared::math;
use sprag_shared::math::sign::Sign;
use sprag_shared::motion::device_snapshot::DeviceOutput;
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::state::BlockState;
use sprag_shared::structure::block::{Block, GRAVITY};

use crate::sensor::Truth;

/// Where the sensors sit: a block of size R at its centre of mass.
#[derive(Clone, Copy, Debug)]
pub struct Places {
    /// R of the loaded block, m.
    pub size: f64,
    /// p² of the block, 1/s².
    pub frequency_squared: f64,
    /// Travel of the rack over R at θ = 0 on the positive side and on the other one.
    standing_travel: [f64; 2],
}

/// What θ alone decides, worked out once for all that need it.
#[derive(Clone, Copy, Debug)]
pub struct Posture {
    side: Sign,
    rotation: f64,
    /// Of the body.
    pub configuration: AnyConfiguration<f64>,
    /// sin θ and cos θ.
    tilt: (f64, f64),
    /// c and s of [`Places::truth`].
    arm: (f64, f64),
    /// Travel of the rack, m.
    travel: f64,
}

impl Places {
    /// On `block`, whose equations `machine` has.
    pub fn new(machine: &HybridSystem<f64>, block: &Block) -> Places {
        let travel = |side: Sign| machine.body.travel(side.unit(), &machine.body.configuration(side.unit(), 0.0));
        Places {
            size: block.size(),
            frequency_squared: block.frequency_parameter_squared(),
            standing_travel: [travel(Sign::Positive), travel(Sign::Negative)],
        }
    }

    /// The posture of a block on its toe of `side`, at θ = `rotation`.
    #[inline(always)]
    pub fn posture(&self, machine: &HybridSystem<f64>, side: Sign, rotation: f64) -> Posture {
        let configuration = machine.body.configuration(side.unit(), rotation);
        let standing = self.standing_travel[usize::from(side == Sign::Negative)];
        let travel = machine.body.travel(side.unit(), &configuration) - standing;
        let (across, along) = machine.body.factors(&configuration);
        let arm = (-across / self.frequency_squared, -along / self.frequency_squared);
        Posture { side, rotation, configuration, tilt: math::sin_cos(rotation), arm, travel: travel * self.size }
    }

    /// Makes `posture` that at θ = `rotation`, if it is another one.
    #[inline]
    pub fn follow(&self, posture: &mut Posture, machine: &HybridSystem<f64>, side: Sign, rotation: f64) {
        if posture.rotation.to_bits() != rotation.to_bits() || posture.side != side {
            self.renew(posture, machine, side, rotation);
        }
    }

    // The posture is made in its place; one that a call returns would be copied there.
    #[inline(never)]
    fn renew(&self, posture: &mut Posture, machine: &HybridSystem<f64>, side: Sign, rotation: f64) {
        *posture = self.posture(machine, side, rotation);
    }

    /// Truth of a block in `posture` with θ̇ = `velocity` and θ̈ = `acceleration` and a `shock`, on ground that accelerates by `ground` (in g,
    /// horizontally and vertically).
    ///
    /// With c = cos δ and s = sin δ (1 and δ for the slender block) the centre of mass has, relative to the ground, the acceleration
    /// R (c θ̈ + s θ̇², s θ̈ − c θ̇²), and in a shock R (c `turning`, |s| `lifting`) more; a specific force is that minus gravity, turned into the
    /// axes of the block.
    pub fn truth(&self, posture: &Posture, (velocity, acceleration): (f64, f64), shock: Shock, ground: [f64; 2]) -> Truth {
        let (c, s) = posture.arm;
        let square = velocity * velocity;
        let ground = [ground[0] * GRAVITY, GRAVITY * (1.0 + ground[1])];
        let horizontal = ground[0] + self.size * (c * (acceleration + shock.turning) + s * square);
        let lifting = posture.side.times(s) * shock.lifting;
        let vertical = ground[1] + self.size * (s * acceleration - c * square + lifting);
        let (sine, cosine) = posture.tilt;
        Truth {
            rate: velocity,
            block: [horizontal * cosine - vertical * sine, horizontal * sine + vertical * cosine],
            ground,
            travel: posture.travel,
        }
    }
}

/// What an impact or a jolt adds to the acceleration of the centre of mass, rad/s²: R c `turning` horizontally, R |s| `lifting` vertically; or
/// the jumps of velocity that they come to, rad/s.
///
/// The vertical velocity is R s θ̇, and s changes its sign with the toe: at an impact, after which θ̇ goes on in one direction on the other
/// toe, it jumps by R |s| (1 + η) |θ̇| upwards, while θ̇ jumps by (1 − η) |θ̇| alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shock {
    turning: f64,
    lifting: f64,
}

impl Shock {
    /// From θ̇ = `before` on the toe of `from` to `after` on that of `to`; where these are two, θ is 0.
    fn between((from, before): (Sign, f64), (to, after): (Sign, f64)) -> Shock {
        Shock { turning: after - before, lifting: to.times(after) - from.times(before) }
    }
}

/// What sensors see of a jump of θ̇ at an impact or a jolt: a half-sine of acceleration that makes up the jump, because no contact is
/// without a duration. The motion itself keeps the jump.
#[derive(Clone, Copy, Debug)]
pub struct Shocks {
    /// s; 0 is no shock at all.
    pub duration: f64,
    /// Start and jump of the last few.
    recent: [(f64, Shock); 4],
    next: usize,
    /// Side and θ̇ at the end of the last stretch.
    last: Option<(Sign, f64)>,
    /// Start of the piece that is being followed, s.
    pub origin: f64,
}

impl Shocks {
    /// Of contacts that last for `duration` (s).
    pub fn new(duration: f64) -> Shocks {
        Shocks { duration, recent: [(f64::NEG_INFINITY, Shock::default()); 4], next: 0, last: None, origin: 0.0 }
    }

    /// The accelerations at `time` (s).
    #[inline]
    pub fn at(&self, time: f64) -> Shock {
        if self.over_at(time) { Shock::default() } else { self.sum_at(time) }
    }

    /// None lasts beyond `time` (s).
    #[inline]
    pub fn over_at(&self, time: f64) -> bool {
        // The latest lasts longest.
        self.duration <= 0.0 || time - self.recent[(self.next + 3) % 4].0 >= self.duration
    }

    fn sum_at(&self, time: f64) -> Shock {
        let mut sum = Shock::default();
        for &(start, Shock { turning, lifting }) in &self.recent {
            let phase = (time - start) / self.duration;
            if (0.0..1.0).contains(&phase) {
                // ∫ π/2 sin(πφ) dφ over a contact is 1.
                let pulse =
                    |jump: f64| jump / self.duration * std::f64::consts::FRAC_PI_2 * math::sin(std::f64::consts::PI * phase);
                sum = Shock { turning: sum.turning + pulse(turning), lifting: sum.lifting + pulse(lifting) };
            }
        }
        sum
    }
}

impl Observer<f64> for Shocks {
    fn device_interval(&mut self, _output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        if let Some(before) = self.last {
            let jump = Shock::between(before, (interval.side, interval.first.velocity));
            // Never the smaller of the two.
            if jump.lifting.abs() > 1e-9 {
                self.recent[self.next % 4] = (self.origin + interval.start, jump);
                self.next += 1;
            }
        }
        self.last = Some((interval.side, interval.last.velocity));
    }

    fn event(&mut self, event: Event, _time: f64, _state: &BlockState<f64>) {
        if matches!(event, Event::Rest | Event::Uplift | Event::Overturned) {
            self.last = None;
        }
    }
}
