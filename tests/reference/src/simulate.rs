//! A run: scene to model, model to what happened.

use std::path::Path;

use crate::block::{Block, GRAVITY, Geometry};
use crate::device::{Coupling, Device};
use crate::effort::Effort;
use crate::equation::Model;
use crate::ground::Ground;
use crate::guard::Guard;
use crate::ledger::Ledger;
use crate::mode::{Link, State, wheel_for};
use crate::runner::Runner;
use crate::scatter::Scatter;
use crate::scene::Scene;
use crate::support::Support;

/// How a run ended, in Sprag's words.
pub type Outcome = &'static str;

/// What a device of a scene did.
#[derive(Clone, Debug)]
pub struct Run {
    /// `no-rocking`, `safe`, `overturned-without-impact` or `overturned-after-impact`.
    pub outcome: Outcome,
    /// Longest step, s.
    pub step: f64,
    /// Largest |θ|, rad.
    pub peak: f64,
    /// Impacts that came in with more than 1e-6 pα.
    pub impacts: usize,
    /// Time (s), θ and θ̇ at multiples of the output interval, up to the end or to the fall.
    pub samples: Vec<[f64; 3]>,
    /// Energies.
    pub ledger: Ledger,
    /// Every event with its time, s.
    pub events: Vec<(f64, Guard)>,
}

/// Runs device `index` of a scene whose records lie in `folder`.
///
/// # Errors
/// A scene that cannot be read; a mode that contradicts itself or comes to no end, with the instant.
pub fn run(scene: &Scene, index: usize, folder: &Path) -> Result<Run, String> {
    run_with(scene, index, folder, Effort::default())
}

/// As [`run`], with an effort of one's own.
///
/// # Errors
/// As there.
pub fn run_with(scene: &Scene, index: usize, folder: &Path, effort: Effort) -> Result<Run, String> {
    let (bare, restitution) = Block::of(&scene.block)?;
    let (block, device) = Device::of(&scene.device[index], &bare, &scene.block)?;
    let horizontal = Ground::of(&scene.ground, &bare, folder)?;
    let vertical = Ground::of(&scene.vertical, &bare, folder)?;
    let p = bare.frequency_parameter();
    let free = scene.run.free_time_s.unwrap_or(scene.run.free_time_ratio.unwrap_or(20.0) / p);
    let ends = horizontal.end().max(vertical.end());
    let support = Support::of(&scene.device[index], scene, &bare, folder, (&horizontal, ends))?;
    let end = ends.max(support.end()) + free;
    let unit = p * bare.slenderness;
    let rest_speed = scene.run.rest_speed_ratio.unwrap_or(1e-6) * unit;
    let overturned = point_of_no_return(&block, &device, (&horizontal, &vertical, &support));
    let counted = 1e-6 * block.frequency_parameter() * block.slenderness;
    let scatter = Scatter::of(&scene.block);
    let model = Model { block, device, restitution, scatter, counted, rest_speed, overturned, horizontal, vertical, support };
    let rotation = scene.block.initial_rotation_ratio * bare.slenderness;
    let velocity = scene.block.initial_velocity_ratio * unit;
    let interval = scene.output.interval_s.unwrap_or(end / 2000.0);
    let mut runner = Runner::new(&model, rotation, velocity, effort);
    let mut run = runner.follow(end, interval, 1e-6 * unit)?;
    // Nothing but friction holds a block any more that leans outward beyond its balance; springs pull at a full one.
    let state = runner.state();
    let balance = match (model.block.geometry, model.device.coupling) {
        (Geometry::Slender, _) => model.block.slenderness + stops(&model, state) / GRAVITY,
        (Geometry::Full, Coupling::Elastic { .. }) => f64::INFINITY,
        (Geometry::Full, _) => model.block.slenderness + (stops(&model, state) / GRAVITY).atan(),
    };
    let beyond = state.rotation().abs() > balance && state.rotation() * state.velocity() > 0.0;
    if run.outcome == "safe" && beyond {
        run.outcome = overturned_after(run.impacts);
    }
    Ok(run)
}

/// How a fall after so many impacts is called.
pub(crate) fn overturned_after(impacts: usize) -> Outcome {
    if impacts > 0 { "overturned-after-impact" } else { "overturned-without-impact" }
}

/// |θ| from which no push or friction brings the block back. The full model lies on the ground at π/2.
fn point_of_no_return(block: &Block, device: &Device, (horizontal, vertical, support): (&Ground, &Ground, &Support)) -> f64 {
    if block.geometry == Geometry::Full {
        return std::f64::consts::FRAC_PI_2;
    }
    let lightest = (GRAVITY - vertical.bound()).max(0.05 * GRAVITY);
    let (lever, _) = device.lever.at(1.0, block.slenderness);
    let moved = 2.0 * device.inertance * device.support.abs() * support.bound(horizontal.bound());
    let pushed = horizontal.bound() * (1.0 + device.guided * lever) + lever * moved;
    block.slenderness * 3.0 + 1.5 * (pushed + held(block, device)) / lightest
}

/// Longest arm of the rack about a toe, over R.
fn longest_arm(block: &Block, device: &Device) -> f64 {
    (0..=64).map(|part| device.lever.at(1.0, block.slenderness * (1.0 - f64::from(part) / 16.0)).0.abs()).fold(0.0, f64::max)
}

/// Largest moment of all friction about a toe, as a horizontal acceleration.
fn held(block: &Block, device: &Device) -> f64 {
    let plates = if device.capacity.is_finite() { 2.0 * device.capacity } else { 0.0 };
    longest_arm(block, device) * (device.rack_dry + 2.0 * device.inertance * device.bearing_dry + plates)
}

/// That of the friction which may still stop a block that falls. A flywheel that is engaged, or about to be, brakes it by its bearings once it has
/// the speed of the rack, as far as the plates pass that on; before that by the whole capacity, and on past a stop only if it turns the other way. A
/// spring pulls with its whole capacity from either side.
fn stops(model: &Model, state: &State) -> f64 {
    let device = &model.device;
    let falls = state.velocity().signum();
    let bearings = device.inertance * device.bearing_dry * (1.0 + device.mesh);
    let springs = matches!(device.coupling, Coupling::Elastic { .. });
    let brakes = |i: usize| {
        let wheel = &state.wheels[i];
        let counts = match device.coupling {
            Coupling::Overrunning => i == wheel_for(falls),
            _ => wheel.link != Link::Open || wheel.command.due.is_some(),
        };
        let turns_back = wheel.link != Link::Locked && state.spin(i) * falls < 0.0;
        match counts {
            false => 0.0,
            true if device.capacity.is_finite() && (springs || turns_back) => device.capacity,
            true => bearings.min(device.capacity),
        }
    };
    longest_arm(&model.block, device) * (device.rack_dry + brakes(0) + brakes(1))
}
