//! Friction of rack and pinion that grows with the force in the mesh, against closed forms.

use super::limits::engaging_at_speed;
use super::{Shake, constant, shake, structure, tight};
use crate::ground::AnySegment;
use crate::math::quadrature::integral;
use crate::math::square_root;
use crate::method::fixed::{FixedStep, Scheme};
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::observer::{MonotoneInterval, Observer};
use crate::observers::ledger::{Account, Clutching, Ledger};
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Drivetrain, Engagement, FlywheelLosses, Rack, Support};

const SIGMA: f64 = 0.5;

fn loaded(load_friction: f64) -> Drivetrain {
    Drivetrain { rack: Rack { load_friction, ..Rack::default() }, ..Drivetrain::default() }
}

fn of(kind: DeviceKind, geometry: Geometry, kinematics: KinematicsKind) -> Shake {
    shake(structure(geometry, 15.0, kind, SIGMA, kinematics), 2.5, 4.0)
}

/// A slender block that a constant push sets in motion has the inertia 1 + k(1 + μ) while it drives the flywheel and 1 + k(1 − μ) while the
/// flywheel drives it; the ideal pair has let go by then. Both swing up to the height that their energy leaves.
#[test]
fn a_constant_push_meets_more_inertia_and_a_swing_that_ends_less() {
    for kind in [DeviceKind::Inerter, DeviceKind::ClutchedPair] {
        for mu in [0.05, 0.3, 0.9] {
            let mut shake = of(kind, Geometry::Slender, KinematicsKind::Paper);
            let block = &shake.structure.block;
            let (p, alpha, k) = (block.frequency_parameter(), block.slenderness(), SIGMA / block.inertia_ratio());
            let (push, time) = (1.8 * alpha, 0.35);
            shake.pieces = std::vec![(constant(-push), time), (AnySegment::Quiet, 0.6)];
            shake.free_time = 1e-3;
            let rate = |share: f64| p / square_root(1.0 + k * share);
            let fast = rate(1.0 + mu);
            let (up, down) = (crate::math::exp(fast * time), crate::math::exp(-fast * time));
            let rotation = (push - alpha) * (0.5 * (up + down) - 1.0);
            let velocity = (push - alpha) * fast * 0.5 * (up - down);
            let slow = if kind == DeviceKind::Inerter { rate(1.0 - mu) } else { p };
            let (height, speed) = (alpha - rotation, velocity / slow);
            let left = height * height - speed * speed;
            let expected = alpha - square_root(left);
            let seen = shake.machine(&loaded(mu), &tight());
            assert!((seen.peak / expected - 1.0).abs() < 1e-11, "{kind:?} μ = {mu}: {} and {expected}", seen.peak);
        }
    }
}

/// The effect falls as μ, and is gone with it.
#[test]
fn it_vanishes_with_its_coefficient() {
    for kind in [DeviceKind::Inerter, DeviceKind::ClutchedPair] {
        for engagement in [Engagement::Ideal, Engagement::Rigid] {
            let shake = of(kind, Geometry::Full, KinematicsKind::Consistent);
            let peak = |mu: f64| shake.machine(&Drivetrain { engagement, ..loaded(mu) }, &tight()).peak;
            let none = shake.machine(&Drivetrain { engagement, ..Drivetrain::default() }, &tight()).peak;
            let error = |mu: f64| (peak(mu) / none - 1.0).abs();
            let (large, small) = (error(1e-3), error(1e-5));
            assert!(small < 1e-3 && (50.0..200.0).contains(&(large / small)), "{kind:?} {engagement:?}: {large:e}, {small:e}");
        }
    }
}

/// What the device must press on a slender block for its θ̈, p²(θ − sα − ü_g/g) − θ̈, is what both flywheels press on their support. It is 1 ± μ
/// times the inertia of the flywheel that is locked.
#[test]
fn the_support_bears_what_the_moment_balance_needs() {
    struct Balance {
        p2: f64,
        alpha: f64,
        inertance: f64,
        mu: f64,
        driven: u32,
        drives: u32,
    }
    impl Observer<f64> for Balance {
        fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
            for share in [0.1, 0.5, 0.9] {
                let snapshot = output.snapshot(interval.from + share * (interval.to - interval.from));
                let Snapshot { motion, ground, device, .. } = snapshot;
                let push = motion.rotation - interval.side.times(self.alpha) - ground[0];
                let (needed, force) = (self.p2 * push - motion.acceleration, snapshot.support_force());
                assert!((force - needed).abs() < 1e-9 * self.p2, "{force} {needed}");
                let own = self.inertance * motion.acceleration;
                if device.engaged != [false; 2] && own.abs() > 1e-3 * self.p2 {
                    let drives = own * motion.velocity < 0.0;
                    let expected = if drives { 1.0 - self.mu } else { 1.0 + self.mu };
                    assert!((force / own - expected).abs() < 1e-12, "{force} {own}");
                    let count = if drives { &mut self.drives } else { &mut self.driven };
                    *count += 1;
                }
            }
        }
    }
    for kind in [DeviceKind::Inerter, DeviceKind::ClutchedPair] {
        let shake = of(kind, Geometry::Slender, KinematicsKind::Paper);
        let block = &shake.structure.block;
        let (p2, alpha, inertance) = (block.frequency_parameter_squared(), block.slenderness(), SIGMA / block.inertia_ratio());
        let mut balance = Balance { p2, alpha, inertance, mu: 0.3, driven: 0, drives: 0 };
        shake.watched(&loaded(0.3), &tight(), &mut balance);
        let Balance { driven, drives, .. } = balance;
        assert!(driven > 10 && (drives > 10) == (kind == DeviceKind::Inerter), "{kind:?}: {driven} {drives}");
    }
}

/// ∫ μ|F||ẋ| dt, F the force of the flywheels without what the mesh adds or takes.
#[derive(Default)]
struct Mesh(f64);

impl Mesh {
    const FRICTION: f64 = 0.2;
}

impl Observer<f64> for Mesh {
    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        let power = |time: f64| {
            let snapshot = output.snapshot(time);
            let power = snapshot.device.force.map(|force| force * snapshot.terminal_velocity);
            [power.map(|power| power.abs() * Mesh::FRICTION / (1.0 + Mesh::FRICTION * power.signum())).iter().sum()]
        };
        self.0 += integral(interval.from, interval.to, 0.1, power)[0];
    }
}

#[test]
fn the_rack_loses_the_friction_of_the_mesh_and_the_ledger_closes() {
    let flywheel = FlywheelLosses { viscous_rate: 0.05, dry_deceleration: 0.1, ..FlywheelLosses::default() };
    for (kind, clutching) in [(DeviceKind::Inerter, Clutching::Permanent), (DeviceKind::ClutchedPair, Clutching::Ideal)] {
        for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
            for flywheel in [FlywheelLosses::default(), flywheel] {
                let drivetrain = Drivetrain { flywheel, ..loaded(Mesh::FRICTION) };
                let shake = of(kind, Geometry::Full, kinematics);
                let account = Account { clutching, mass_ratio: SIGMA, ..Account::default() };
                let mut watchers = (Ledger::new(&shake.structure.block, Geometry::Full, &account), Mesh::default());
                let series = shake.watched(&drivetrain, &tight(), &mut watchers);
                let (entries, mesh) = (watchers.0.entries, watchers.1.0);
                let what = std::format!("{kind:?} {kinematics:?}: {entries:?}");
                assert!(entries.residual().abs() < 1e-10 * entries.input, "{what}");
                assert!(entries.rack > 0.0 && (entries.rack / mesh - 1.0).abs() < 1e-10, "{what}: {mesh}");
                let fixed = shake.machine(&drivetrain, &FixedStep { scheme: Scheme::RungeKutta4, step: 1e-4 });
                assert!((fixed.peak / series.peak - 1.0).abs() < 1e-8, "{what}: {} and {}", fixed.peak, series.peak);
                assert_eq!(fixed.impacts, series.impacts, "{what}");
            }
        }
    }
}

/// The impulse of a rigid clutch on a stopped flywheel meets friction too: (1 + k(1 + μ)ℓ²) θ̇⁺ = θ̇⁻.
#[test]
fn a_jolt_meets_it_too() {
    let mu = 0.25;
    let flywheel = FlywheelLosses { brake_deceleration: f64::INFINITY, ..FlywheelLosses::default() };
    let drivetrain = Drivetrain { engagement: Engagement::Rigid, flywheel, ..loaded(mu) };
    let shake = engaging_at_speed(Geometry::Slender);
    let k = SIGMA / shake.structure.block.inertia_ratio();
    let seen = shake.machine(&drivetrain, &tight());
    let (_, before, after) = seen.switches.iter().find(|(time, ..)| (time - 0.22).abs() < 1e-12).expect("an engagement at speed");
    let expected = before.velocity / (1.0 + k * (1.0 + mu));
    assert!(before.velocity > 0.01 && (after.velocity / expected - 1.0).abs() < 1e-13, "{} and {expected}", after.velocity);
}

/// The bearings of a flywheel that stands hold the block through the mesh, (1 + μ) times as strongly.
#[test]
fn it_holds_with_the_bearings() {
    let structure = structure(Geometry::Slender, 12.0, DeviceKind::Inerter, SIGMA, KinematicsKind::Paper);
    let flywheel = FlywheelLosses { dry_deceleration: 0.4, ..FlywheelLosses::default() };
    let drivetrain = Drivetrain { flywheel, ..loaded(0.5) };
    let alpha = structure.block.slenderness();
    let threshold = alpha + SIGMA * 1.5 * 0.4 / crate::structure::block::GRAVITY;
    for (share, rocks) in [(0.999, false), (1.001, true)] {
        let mut shake = shake(structure, 1.0, 1.0);
        shake.pieces = std::vec![(constant(-share * threshold), 0.2)];
        assert_eq!(shake.machine(&drivetrain, &tight()).peak > 0.0, rocks, "{share}");
    }
}

#[test]
fn what_it_is_not_for_is_refused() {
    let parameter = |drivetrain: Drivetrain| drivetrain.check().unwrap_err().parameter;
    for mu in [1.0, -0.1, f64::NAN] {
        assert_eq!(parameter(loaded(mu)), "load_friction");
    }
    for engagement in
        [Engagement::Overrunning, Engagement::Friction { capacity_ratio: 0.1 }, Engagement::Viscous { corner_frequency: 2.0 }]
    {
        assert_eq!(parameter(Drivetrain { engagement, ..loaded(0.1) }), "load_friction");
    }
    assert_eq!(parameter(Drivetrain { support: Support::amplified(1.2), ..loaded(0.1) }), "support_amplification");
}
