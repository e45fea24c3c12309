//! What the checks find of devices with a memory: forces on the support, impulses of jolts at the toe.

use std::vec::Vec;

use super::{pair, structure, tight};
use crate::math;
use crate::math::sign::Sign;
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::BlockState;
use crate::observers::checks::{Checks, Report};
use crate::observers::ledger::{Account, Clutching};
use crate::structure::Structure;
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Actuation, Drivetrain, Engagement, FlywheelLosses, Rack};
use crate::structure::mount::Mount;

const SIGMA: f64 = 0.5;
const RACK: f64 = 0.02;

fn checks(structure: &Structure, clutching: Clutching, rack_mass_ratio: f64) -> Checks<f64> {
    let account = Account { clutching, mass_ratio: SIGMA, rack_mass_ratio, ..Account::default() };
    Checks::new(&structure.block, structure.geometry, &structure.device.mount, &account).unwrap()
}

/// With a release that comes late both flywheels pull: the support takes their sum.
#[test]
fn the_support_takes_what_both_flywheels_pull() {
    /// Largest |F₁ + F₂| and |Fᵢ| of a dense history, over λmR.
    #[derive(Default)]
    struct Dense([f64; 2]);
    impl Observer<f64> for Dense {
        fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
            for i in 0..=200 {
                let at = output.snapshot(interval.from + (interval.to - interval.from) * f64::from(i) / 200.0);
                let [first, second] = at.device.force;
                self.0 = [self.0[0].max((first + second).abs()), self.0[1].max(first.abs()).max(second.abs())];
            }
        }
    }
    let late = Actuation { engagement_delay: 0.02, release_delay: 0.05, ..Actuation::default() };
    let mut together = Vec::new();
    for engagement in [
        Engagement::Friction { capacity_ratio: 0.05 },
        Engagement::Elastic { stiffness: 3e3, damping: 8.0, backlash: 0.0, capacity_ratio: f64::INFINITY },
    ] {
        let shake = pair(Geometry::Full, 3.0, 9.0);
        let flywheel = FlywheelLosses { brake_deceleration: 5.0, ..FlywheelLosses::default() };
        let drivetrain = Drivetrain { engagement, flywheel, actuation: late, ..Drivetrain::default() };
        let mut watchers = (checks(&shake.structure, Clutching::Real, 0.0), Dense::default());
        shake.watched(&drivetrain, &tight(), &mut watchers);
        let (Report { support, force, .. }, Dense([sum, largest])) = (watchers.0.report, watchers.1);
        let scale = 1.0 / shake.structure.block.frequency_parameter_squared();
        let (found, single) = (support.unwrap().value, force[0].unwrap().value.max(force[1].unwrap().value));
        assert!((found / (sum * scale) - 1.0).abs() < 1e-4, "{engagement:?}: {found} {}", sum * scale);
        assert!((single / (largest * scale) - 1.0).abs() < 1e-4, "{engagement:?}");
        together.push(found / single);
    }
    assert!(together.iter().any(|ratio| *ratio > 1.2), "{together:?}");
}

/// A jump of θ̇ at a switch, with the device before and after it.
#[derive(Default)]
struct Jolts {
    before: Option<(Sign, Snapshot<f64>)>,
    jumped: bool,
    found: Vec<(Sign, Snapshot<f64>, Snapshot<f64>)>,
}

impl Observer<f64> for Jolts {
    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        if let (Some((side, before)), true) = (self.before, self.jumped) {
            self.found.push((side, before, output.snapshot(interval.from)));
        }
        self.jumped = false;
        self.before = Some((interval.side, output.snapshot(interval.to)));
    }

    fn event(&mut self, event: Event, _time: f64, state: &BlockState<f64>) {
        match (event, &mut self.before) {
            (Event::Impact, Some((side, before))) => {
                // What is locked slows down with the block.
                let left = state.velocity / before.motion.velocity;
                for i in 0..2 {
                    before.device.spin[i] *= if before.device.engaged[i] { left } else { 1.0 };
                }
                (before.motion.velocity, before.terminal_velocity) = (state.velocity, left * before.terminal_velocity);
                (*side, before.motion.rotation) = (state.side, 0.0);
            }
            (Event::Switch, Some((_, before))) => self.jumped |= (state.velocity - before.motion.velocity).abs() > 1e-6,
            (Event::Rest | Event::Uplift, before) => *before = None,
            _ => {}
        }
    }
}

/// The toe's impulses are what the momentum of the block has gained beyond what the rack gave it, by a drawing of the block that is
/// turned by hand; and their moment about the centre of mass turns it.
#[test]
fn a_jolt_keeps_the_momentum() {
    let mounts = [
        (Mount::CentreOfMass, 1.0, false),
        (Mount::TyingPoint { height: 3.0, pulley_ratio: 1.5 }, 1.5, false),
        (Mount::BaseCorners { pulley_ratio: 4.0 }, 4.0, true),
    ];
    for (mount, pulley, vertical) in mounts {
        let mut shake =
            super::shake(structure(Geometry::Full, 15.0, DeviceKind::ClutchedPair, SIGMA, KinematicsKind::Consistent), 6.0, 6.0);
        shake.structure.device.mount = mount;
        let drivetrain = Drivetrain {
            engagement: Engagement::Rigid,
            flywheel: FlywheelLosses { brake_deceleration: 5.0, ..FlywheelLosses::default() },
            rack: Rack { guided_mass_ratio: RACK, ..Rack::default() },
            actuation: Actuation { engagement_delay: 0.03, ..Actuation::default() },
            ..Drivetrain::default()
        };
        let mut watchers = (checks(&shake.structure, Clutching::Rigid, RACK), Jolts::default());
        shake.watched(&drivetrain, &tight(), &mut watchers);
        let (report, jolts) = (watchers.0.report, watchers.1.found);
        assert!(jolts.len() > 3, "{}", jolts.len());
        let block = &shake.structure.block;
        let (half_width, height) = (math::sin(block.slenderness()), math::cos(block.slenderness()));
        let (mut friction, mut pull) = (0.0_f64, 0.0_f64);
        for (side, before, after) in &jolts {
            let side: f64 = side.unit();
            // Points of the block over R from the toe, clockwise for positive rotation, and their velocity for θ̇ = 1.
            let place = |x: f64, y: f64, angle: f64| {
                let (sin, cos) = math::sin_cos(angle);
                [cos * (x - side * half_width) + sin * y, cos * y - sin * (x - side * half_width)]
            };
            let rotation = before.motion.rotation;
            let rate = |x, y| {
                let [a, b] = [rotation - 1e-5, rotation + 1e-5].map(|angle| place(x, y, angle));
                [0, 1].map(|i| (b[i] - a[i]) / 2e-5)
            };
            let jump = after.motion.velocity - before.motion.velocity;
            let gained = rate(0.0, height).map(|rate| rate * jump);
            let spins = after.device.spin[0] + after.device.spin[1] - before.device.spin[0] - before.device.spin[1];
            let rack = pulley * (SIGMA * spins + RACK * (after.terminal_velocity - before.terminal_velocity));
            let device = if vertical { [0.0, -side * rack] } else { [-rack, 0.0] };
            let toe = [gained[0] - device[0], gained[1] - device[1]];
            // About the centre of mass: I_G = (λ − 1) m R².
            let centre = place(0.0, height, rotation);
            let clockwise = |at: [f64; 2], by: [f64; 2]| (at[1] - centre[1]) * by[0] - (at[0] - centre[0]) * by[1];
            let tied = match mount {
                Mount::CentreOfMass => centre,
                Mount::TyingPoint { height, .. } => place(0.0, height / block.size(), rotation),
                Mount::BaseCorners { .. } => place(-side * half_width, 0.0, rotation),
            };
            let moment = clockwise([0.0; 2], toe) + clockwise(tied, device);
            assert!((moment - (block.inertia_ratio() - 1.0) * jump).abs() < 1e-9, "{mount:?}: {moment} for {jump}");
            if toe[1] > 0.0 {
                friction = friction.max(toe[0].abs() / toe[1]);
            } else {
                pull = pull.max(-toe[1] * block.size());
            }
        }
        let value = |extreme: Option<crate::observers::checks::Extreme<f64>>| extreme.map_or(0.0, |extreme| extreme.value);
        assert!((value(report.jolt_friction) - friction).abs() < 1e-6 * (1.0 + friction), "{mount:?}: {report:?} {friction}");
        assert!((value(report.jolt_pull) - pull).abs() < 1e-9, "{mount:?}: {report:?} {pull}");
        assert!(vertical || pull > 0.0, "{mount:?}: a horizontal device lifts the toe of a block that rises");
    }
}

/// A stopped flywheel slows a block that rises by kℓ²/(1 + kℓ²) of its speed; its centre of mass loses R sin δ as much of its rise, and
/// only a pull at the toe could take that from it.
#[test]
fn a_jolt_lifts_the_toe_of_a_block_that_rises() {
    let shake = super::limits::engaging_at_speed(Geometry::Full);
    let flywheel = FlywheelLosses { brake_deceleration: f64::INFINITY, ..FlywheelLosses::default() };
    let drivetrain = Drivetrain { engagement: Engagement::Rigid, flywheel, ..Drivetrain::default() };
    let mut found = checks(&shake.structure, Clutching::Rigid, 0.0);
    let seen = shake.watched(&drivetrain, &tight(), &mut found);
    let (_, before, _) = seen.switches.iter().find(|(time, ..)| (time - 0.22).abs() < 1e-12).unwrap();
    let block = &shake.structure.block;
    let (sin, cos) = math::sin_cos(block.slenderness() - before.rotation);
    let added = SIGMA / block.inertia_ratio() * cos * cos;
    let expected = block.size() * sin * before.velocity * added / (1.0 + added);
    let pull = found.report.jolt_pull.unwrap().value;
    assert!(expected > 1e-3 && (pull / expected - 1.0).abs() < 1e-9, "{pull} {expected}");
}

/// Where a block that falls is slowed, its toe is pressed down, but by less than friction asks for: at the centre of mass
/// (λ − cos²δ)/(sin δ cos δ), which no δ below 35° brings below 0.94.
#[test]
fn a_jolt_needs_more_friction_than_there_is() {
    let shake = pair(Geometry::Full, 6.0, 6.0);
    let actuation = Actuation { engagement_delay: 0.03, ..Actuation::default() };
    let flywheel = FlywheelLosses { brake_deceleration: 5.0, ..FlywheelLosses::default() };
    let drivetrain = Drivetrain { engagement: Engagement::Rigid, flywheel, actuation, ..Drivetrain::default() };
    let mut watchers = (checks(&shake.structure, Clutching::Rigid, 0.0), Jolts::default());
    shake.watched(&drivetrain, &tight(), &mut watchers);
    let (alpha, lambda) = (shake.structure.block.slenderness(), shake.structure.block.inertia_ratio());
    let needed = |(side, before, after): &(Sign, Snapshot<f64>, Snapshot<f64>)| {
        let (sin, cos) = math::sin_cos(alpha - side.times(before.motion.rotation));
        let presses = side.times(after.motion.velocity - before.motion.velocity) * sin > 0.0;
        presses.then_some((lambda - cos * cos) / (sin.abs() * cos))
    };
    let expected = watchers.1.found.iter().filter_map(needed).fold(0.0, f64::max);
    let found = watchers.0.report.jolt_friction.unwrap().value;
    assert!(expected > 0.94 && (found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
}

/// Dry friction of the rack has the size at a turn and as the block starts that it has just after.
#[test]
fn a_rack_rubs_at_a_turn_as_beside_it() {
    #[derive(Default)]
    struct Starts(u32);
    impl Observer<f64> for Starts {
        fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
            let length = interval.to - interval.from;
            if interval.first.velocity == 0.0 && length > 1e-6 {
                let [at, beside] = [0.0, 1e-7].map(|share| output.snapshot(interval.from + share * length).device.rack_force);
                assert!((at - beside).abs() < 1e-4, "{at} {beside}");
                self.0 += u32::from(at.abs() > 0.1);
            }
        }
    }
    let shake = pair(Geometry::Full, 3.0, 9.0);
    let mut starts = Starts::default();
    let rack = Rack { dry_ratio: 0.1, ..Rack::default() };
    shake.watched(&Drivetrain { rack, ..Drivetrain::default() }, &tight(), &mut starts);
    assert!(starts.0 > 1, "{}", starts.0);
}
