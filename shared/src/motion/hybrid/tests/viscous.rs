//! Viscous slip between rack and flywheel, against its transfer function and its limits.

use std::vec::Vec;

use super::limits::engaging_at_speed;
use super::maxwell::Swing;
use super::standing::pushed_by_a_flywheel;
use super::{Shake, shake, structure, tight};
use crate::drivetrain::clutch_state::Coupling;
use crate::method::fixed::{FixedStep, Scheme};
use crate::motion::device_snapshot::DeviceOutput;
use crate::motion::hybrid::HybridSystem;
use crate::motion::hybrid::mode_output::Shaking;
use crate::motion::observer::{MonotoneInterval, Observer};
use crate::motion::state::Limits;
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Drivetrain, Engagement, FlywheelLosses};
use crate::structure::error::ParameterError;

const SIGMA: f64 = 0.5;
const LIMITS: Limits<f64> = Limits { overturned: 1.5, events: 10_000 };

/// With its corner at ω_c, 1/s.
fn slip(corner: f64) -> Drivetrain {
    Drivetrain { engagement: Engagement::Viscous { corner_frequency: corner / core::f64::consts::TAU }, ..Drivetrain::default() }
}

fn single(geometry: Geometry) -> Shake {
    shake(structure(geometry, 15.0, DeviceKind::Inerter, SIGMA, KinematicsKind::Consistent), 3.0, 5.0)
}

/// About its unstable balance a slender block is linear: swung at ω it has the amplitude and phase that an inertance b/(1 + iω/ω_c) gives,
/// and so has the flywheel, w = ẋ/(1 + iω/ω_c).
#[test]
fn it_has_the_transfer_function_of_a_maxwell_element() {
    for ratio in [0.3, 1.0, 4.0] {
        let structure = structure(Geometry::Slender, 15.0, DeviceKind::Inerter, SIGMA, KinematicsKind::Consistent);
        let block = &structure.block;
        let (alpha, k) = (block.slenderness(), SIGMA / block.inertia_ratio());
        let (omega, amplitude) = (8.0 * block.frequency_parameter(), 0.5);
        let machine: HybridSystem<f64> = slip(omega / ratio).resolve(&structure, false).unwrap();
        let swing = Swing::of(block, k, (omega, amplitude), ratio);
        let mut state = machine.released_at(alpha + swing.at(0.0, swing.rotation), swing.at(0.0, swing.velocity), [0.0; 3]);
        state.device.wheels[0].spin = swing.at(0.0, swing.spin);
        let ground = super::sine(amplitude, omega);
        let end = 2.3 * core::f64::consts::TAU / omega;
        let shaking = Shaking { horizontal: &ground, vertical: None, support: None };
        machine.advance(&tight(), &mut state, shaking, end, &LIMITS, &mut ()).unwrap();
        let size = swing.size();
        let error = (state.motion.rotation - alpha - swing.at(end, swing.rotation)) / size;
        assert!(error.abs() < 1e-11, "ω/ω_c = {ratio}: θ off by {error:e}");
        let error = (state.device.wheels[0].spin - swing.at(end, swing.spin)) / (omega * size);
        assert!(error.abs() < 1e-11, "ω/ω_c = {ratio}: w off by {error:e}");
    }
}

/// Without a corner to speak of it is the rigid clutch, with an error of 1/ω_c, and with one at 0 Hz no device. The motion has its peak
/// before an impact, which flywheels behind a dashpot do not go through with the block.
#[test]
fn between_no_device_and_a_rigid_clutch() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        for kind in [DeviceKind::ClutchedPair, DeviceKind::Inerter] {
            let mut shake = engaging_at_speed(geometry);
            shake.structure.device.kind = kind;
            shake.free_time = 1.0;
            let rigid = Drivetrain { engagement: Engagement::Rigid, ..Drivetrain::default() };
            let limit = shake.machine(&rigid, &tight()).peak;
            let corners = [60.0, 600.0, 6000.0];
            let errors: Vec<f64> =
                corners.iter().map(|&corner| (shake.machine(&slip(corner), &tight()).peak / limit - 1.0).abs()).collect();
            assert!(errors[1] < errors[0] / 5.0 && errors[2] < errors[1] / 5.0, "{geometry:?} {kind:?}: {errors:?}");
            assert!(errors[2] < 2e-3, "{geometry:?} {kind:?}: {errors:?}");
            let mut alone = shake.clone();
            alone.structure.device = crate::structure::device::Device::NONE;
            let free = alone.ideal().peak;
            assert!((shake.machine(&slip(1e-9), &tight()).peak / free - 1.0).abs() < 1e-7, "{geometry:?} {kind:?}");
        }
    }
}

/// Largest relative error of the power lost, against c(ẋ − w)².
#[derive(Default)]
struct Loss {
    damping: f64,
    error: f64,
    seen: u32,
}

impl Observer<f64> for Loss {
    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        let snapshot = output.snapshot(interval.to);
        let relative = snapshot.terminal_velocity - snapshot.device.spin[0];
        let expected = self.damping * relative * relative;
        self.error = self.error.max((snapshot.device.spent.clutch - expected).abs());
        self.seen += u32::from(expected > 1e-6);
    }
}

#[test]
fn an_inerter_with_slip_by_two_methods_and_its_ledger() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        for dry_deceleration in [0.0, 0.3] {
            let flywheel = FlywheelLosses { viscous_rate: 0.05, dry_deceleration, ..FlywheelLosses::default() };
            let drivetrain = Drivetrain { flywheel, ..slip(12.0) };
            let shake = single(geometry);
            let mut watchers = (
                shake.ledger(&drivetrain),
                Loss { damping: 12.0 * SIGMA / shake.structure.block.inertia_ratio(), ..Loss::default() },
            );
            let series = shake.watched(&drivetrain, &tight(), &mut watchers);
            let entries = watchers.0.entries;
            assert!(entries.residual().abs() < 1e-10 * entries.input, "{geometry:?}: {entries:?}");
            assert!(entries.clutch > 0.0 && entries.created == 0.0 && entries.rack == 0.0, "{entries:?}");
            assert!(watchers.1.error < 1e-12 && watchers.1.seen > 10, "{:e}", watchers.1.error);
            let fixed = shake.machine(&drivetrain, &FixedStep { scheme: Scheme::RungeKutta4, step: 1e-4 });
            assert!((fixed.peak / series.peak - 1.0).abs() < 1e-8, "{geometry:?}: {} and {}", fixed.peak, series.peak);
            assert_eq!(fixed.impacts, series.impacts);
        }
    }
}

/// [`pushed_by_a_flywheel`] through the slip.
#[test]
fn a_flywheel_pushes_a_standing_block_as_long_as_it_turns() {
    let structure = structure(Geometry::Slender, 10.0, DeviceKind::Inerter, SIGMA, KinematicsKind::Consistent);
    for (dry_deceleration, viscous_rate, push) in [(0.0, 0.0, 0.3), (0.0, 2.0, 0.9), (0.8, 1.0, 0.6), (0.8, 0.0, -0.5)] {
        let flywheel = FlywheelLosses { viscous_rate, dry_deceleration, brake_deceleration: 0.0, drag_rate: 0.0 };
        let drivetrain = Drivetrain { flywheel, ..slip(6.0) };
        let machine: HybridSystem<f64> = drivetrain.resolve(&structure, false).unwrap();
        assert_eq!(machine.at_rest().device.wheels[0].coupling, Coupling::Viscous);
        let (uplift, expected) = pushed_by_a_flywheel(&structure, &drivetrain, (0, 6.0), push);
        assert!((uplift - expected).abs() < 1e-9, "d = {dry_deceleration}: {uplift} and {expected}");
    }
}

#[test]
fn its_corner_has_a_range() {
    for corner in [0.0, -1.0, 7e3, f64::NAN] {
        let error: ParameterError = slip(corner).check().unwrap_err();
        assert_eq!(error.parameter, "corner_frequency");
    }
}
