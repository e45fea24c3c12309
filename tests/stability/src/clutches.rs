//! A block with elastic clutches, whatever their stiffness, by fixed exponential midpoint steps.

use sprag_shared::ground::Harmonics;
use sprag_shared::math::scalar::Real;
use sprag_shared::method::fixed::{FixedStep, Scheme};
use sprag_shared::motion::device_snapshot::DeviceOutput;
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::motion::hybrid::mode_output::Shaking;
use sprag_shared::motion::observer::{Event, MonotoneInterval, Observer};
use sprag_shared::motion::state::{BlockState, Limits, Stopped};
use sprag_shared::structure::Structure;
use sprag_shared::structure::drivetrain::{Drivetrain, Engagement};

use crate::energy::Energy;

/// How a block with elastic clutches comes out of a sine pulse and the time after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticEnd<S> {
    /// The last state, or why there is none.
    pub state: Result<BlockState<S>, Stopped>,
    /// Largest |θ|, rad.
    pub peak: f64,
    /// Steps begun.
    pub steps: u64,
    /// Events reported.
    pub events: u64,
    /// Deepest |θ| below the floor, rad.
    pub depth: f64,
    /// Largest gain of energy (of block, flywheels and springs) over its least so far while the ground is quiet, over the barrier.
    pub gain: f64,
}

/// Follows `structure` with elastic clutches of `stiffness` K (N/m per kg of block) and `damping_ratio` from rest through one
/// cycle of a sine of `amplitude` (g) and `frequency` (rad/s) and for `free_time` (s) after it, in fixed steps of `step` (s).
pub fn elastic_run<S: Real>(
    structure: &Structure,
    (stiffness, damping_ratio): (f64, f64),
    (amplitude, frequency): (f64, f64),
    free_time: f64,
    step: f64,
) -> ElasticEnd<S> {
    let damping = 2.0 * damping_ratio * sprag_shared::math::square_root(stiffness * structure.device.mass_ratio);
    let engagement = Engagement::Elastic { stiffness, damping, backlash: 0.0, capacity_ratio: f64::INFINITY };
    let drivetrain = Drivetrain { engagement, ..Drivetrain::default() };
    let machine: HybridSystem<S> = drivetrain.resolve(structure, false).expect("parameters within range");
    let energy = Energy::of(structure);
    let mut watch = Watch { energy, quiet: false, least: f64::INFINITY, peak: 0.0, steps: 0, events: 0, depth: 0.0, gain: 0.0 };
    let mut state = machine.at_rest();
    let method = FixedStep { scheme: Scheme::ExponentialMidpoint, step: S::of(step) };
    let limits = Limits { overturned: S::of(core::f64::consts::FRAC_PI_2), events: 10_000_000 };
    let duration = S::of(core::f64::consts::TAU) / S::of(frequency);
    let sine = Harmonics::sine(S::of(amplitude), S::of(frequency));
    let shaking = Shaking::level(&sine);
    let mut done = machine.advance(&method, &mut state, shaking, duration, &limits, &mut watch);
    if done.is_ok() {
        watch.quiet = true;
        let shaking = Shaking::level(&Harmonics::QUIET);
        done = machine.advance(&method, &mut state, shaking, S::of(free_time), &limits, &mut watch);
    }
    let Watch { peak, steps, events, depth, gain, .. } = watch;
    ElasticEnd { state: done.map(|()| state.motion), peak, steps, events, depth, gain }
}

struct Watch {
    energy: Energy,
    quiet: bool,
    least: f64,
    peak: f64,
    steps: u64,
    events: u64,
    depth: f64,
    gain: f64,
}

impl<S: Real> Observer<S> for Watch {
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.steps += 1;
        self.depth = self.depth.max(-interval.side.times(interval.last.rotation).to_f64());
        self.peak = self.peak.max(interval.last.rotation.abs().to_f64());
        if self.quiet {
            let p2 = self.energy.frequency * self.energy.frequency;
            let stored = output.snapshot(interval.to).device.stored.to_f64() / p2;
            // What moves with the block is counted by the device.
            let energy = self.energy.at(&interval.last, interval.side, false) + stored;
            self.gain = self.gain.max((energy - self.least) / self.energy.barrier());
            self.least = self.least.min(energy);
        }
    }

    fn event(&mut self, _event: Event, _time: S, _state: &BlockState<S>) {
        self.events += 1;
    }
}
