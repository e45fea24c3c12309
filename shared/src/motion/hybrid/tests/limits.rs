//! Devices that must become one another in a limit.

use std::vec::Vec;

use super::{Seen, constant, pair, shake, structure, tight};
use crate::ground::AnySegment;
use crate::motion::observer::Event;
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Drivetrain, Engagement, FlywheelLosses};

const INSTANT: FlywheelLosses =
    FlywheelLosses { viscous_rate: 0.0, dry_deceleration: 0.0, brake_deceleration: f64::INFINITY, drag_rate: 0.0 };

fn of(engagement: Engagement, flywheel: FlywheelLosses) -> Drivetrain {
    Drivetrain { engagement, flywheel, ..Drivetrain::default() }
}

fn rigid() -> Drivetrain {
    of(Engagement::Rigid, INSTANT)
}

fn peaks(shake: &super::Shake, drivetrains: &[Drivetrain]) -> Vec<f64> {
    drivetrains.iter().map(|drivetrain| shake.machine(drivetrain, &tight()).peak).collect()
}

/// The rigid clutch is the limit of stiff ones: the error falls as 1/√K, or faster.
#[test]
fn a_stiff_clutch_becomes_a_rigid_one() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        let shake = pair(geometry, 3.0, 5.0);
        let limit = shake.machine(&rigid(), &tight()).peak;
        let stiff = [1e3, 1e5, 1e7].map(|stiffness: f64| {
            let damping = 2.0 * 0.5 * (stiffness * 0.5).sqrt();
            of(Engagement::Elastic { stiffness, damping, backlash: 0.0, capacity_ratio: f64::INFINITY }, INSTANT)
        });
        let errors: Vec<f64> = peaks(&shake, &stiff).iter().map(|peak| (peak / limit - 1.0).abs()).collect();
        assert!(errors[1] < errors[0] / 5.0 && errors[2] < errors[1] / 5.0, "{geometry:?}: {errors:?}");
        assert!(errors[2] < 1e-3, "{geometry:?}: {errors:?}");
    }
}

/// Less play, less error.
#[test]
fn play_vanishes_with_its_width() {
    let shake = pair(Geometry::Full, 3.0, 5.0);
    let with = |backlash: f64| {
        of(Engagement::Elastic { stiffness: 1e4, damping: 70.0, backlash, capacity_ratio: f64::INFINITY }, INSTANT)
    };
    let tight = peaks(&shake, &[with(0.0)])[0];
    let errors: Vec<f64> =
        peaks(&shake, &[with(1e-3), with(1e-5), with(1e-7)]).iter().map(|peak| (peak / tight - 1.0).abs()).collect();
    assert!(errors[0] > 1e-6 && errors[1] < errors[0] && errors[2] < 1e-5, "{errors:?}");
}

/// Plates that carry everything are a rigid clutch, with an error of 1/capacity; plates that carry nothing are none.
#[test]
fn plates_between_nothing_and_everything() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        let shake = engaging_at_speed(geometry);
        let with = |capacity_ratio: f64| of(Engagement::Friction { capacity_ratio }, INSTANT);
        let limit = shake.machine(&rigid(), &tight()).peak;
        let errors: Vec<f64> =
            peaks(&shake, &[with(1e1), with(1e3), with(1e5)]).iter().map(|peak| (peak / limit - 1.0).abs()).collect();
        assert!(errors[1] < errors[0] / 20.0 && errors[2] < errors[1] / 20.0, "{geometry:?}: {errors:?}");
        let mut alone = shake.clone();
        alone.structure.device = crate::structure::device::Device::NONE;
        let free = alone.ideal().peak;
        assert!((peaks(&shake, &[with(1e-9)])[0] / free - 1.0).abs() < 1e-6, "{geometry:?}");
    }
}

/// Without a jolt to speak of (the flywheel has no inertance) every clutch is none.
#[test]
fn a_flywheel_without_inertance_does_nothing() {
    let with = |kind, sigma| shake(structure(Geometry::Full, 15.0, kind, sigma, KinematicsKind::Consistent), 3.0, 5.0);
    let free = with(DeviceKind::None, 0.0).ideal().peak;
    for (engagement, losses) in [
        (Engagement::Ideal, FlywheelLosses::default()),
        (Engagement::Rigid, INSTANT),
        (Engagement::Overrunning, FlywheelLosses::default()),
    ] {
        let seen = with(DeviceKind::ClutchedPair, 1e-9).machine(&of(engagement, losses), &tight());
        assert!((seen.peak / free - 1.0).abs() < 1e-7, "{engagement:?}: {} and {free}", seen.peak);
    }
}

/// The overrunning clutch holds exactly where Eq. 10 holds as long as its flywheel has stopped in between, so that the first
/// outward swing, which ends before any flywheel is engaged at speed, is the ideal one.
#[test]
fn the_first_swing_of_an_overrunning_clutch_is_ideal() {
    let shake = pair(Geometry::Full, 1.5, 4.0);
    let ideal = shake.machine(&Drivetrain::default(), &tight());
    let overrunning = shake.machine(&of(Engagement::Overrunning, FlywheelLosses::default()), &tight());
    let turn = |seen: &Seen| seen.events.iter().find(|(event, _)| *event == Event::Turn).map(|(_, time)| *time).unwrap();
    assert!((turn(&ideal) - turn(&overrunning)).abs() < 1e-10, "{} and {}", turn(&ideal), turn(&overrunning));
}

/// Two pushes with a pause: in the pause the block slows down and lets its flywheel go, the second push engages it at speed.
pub fn engaging_at_speed(geometry: Geometry) -> super::Shake {
    let mut shake = pair(geometry, 1.0, 1.0);
    let push = -2.0 * geometry.uplift_threshold(shake.structure.block.slenderness());
    shake.pieces = std::vec![(constant(push), 0.15), (AnySegment::Quiet, 0.07), (constant(push), 0.05)];
    shake.free_time = 3.0;
    shake
}

/// At the second push the block gives the stopped flywheel its speed: (1 + kℓ²) θ̇⁺ = θ̇⁻, and the ideal clutch hides it.
#[test]
fn a_rigid_clutch_that_closes_at_speed_exchanges_momentum() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        let shake = engaging_at_speed(geometry);
        let (ideal, real) = (shake.machine(&Drivetrain::default(), &tight()), shake.machine(&rigid(), &tight()));
        let instant = 0.22;
        let switch = real.switches.iter().find(|(time, ..)| (time - instant).abs() < 1e-12).expect("an engagement at speed");
        let (_, before, after) = switch;
        let body = &shake.structure;
        let arm = match geometry {
            Geometry::Slender => 1.0,
            Geometry::Full => crate::math::cos(body.block.slenderness() - before.rotation),
        };
        let k = body.device.mass_ratio / body.block.inertia_ratio();
        assert!(before.velocity > 0.01, "{before:?}");
        let expected = before.velocity / (1.0 + k * arm * arm);
        assert!((after.velocity / expected - 1.0).abs() < 1e-13, "{geometry:?}: {} and {expected}", after.velocity);
        assert!(ideal.peak > 1.05 * real.peak, "{geometry:?}: the jolt takes energy: {} and {}", ideal.peak, real.peak);
        let same = ideal.switches.iter().find(|(time, ..)| (time - instant).abs() < 1e-12).expect("the ideal one engages too");
        assert_eq!(same.1.velocity, same.2.velocity);
    }
}

/// A flywheel that has retained its speed takes less from the block than one that has stopped, and a braked one lies between.
#[test]
fn a_flywheel_that_still_spins_costs_less() {
    let shake = engaging_at_speed(Geometry::Full);
    let braked = |brake_deceleration: f64| {
        let losses = FlywheelLosses { brake_deceleration, ..FlywheelLosses::default() };
        shake.machine(&of(Engagement::Rigid, losses), &tight()).peak
    };
    let (free, slow, stopped) = (braked(0.0), braked(0.5), braked(f64::INFINITY));
    assert!(stopped < slow && slow < free, "{stopped} {slow} {free}");
    assert!((braked(1e6) / stopped - 1.0).abs() < 1e-6, "the infinite brake is the limit of strong ones");
}

/// Flywheels that coast while the block has come to rest do so for as long as it rests: e^(−rate t), from any instant of it.
#[test]
fn flywheels_coast_while_the_block_rests() {
    let losses = FlywheelLosses { viscous_rate: 0.2, ..FlywheelLosses::default() };
    let spins = |free_time: f64| {
        let shake = super::Shake { free_time, ..pair(Geometry::Slender, 1.5, 4.0) };
        let seen = shake.machine(&of(Engagement::Overrunning, losses), &tight());
        (seen.spins, seen.ended.expect("it comes to rest") - shake.pieces[0].1)
    };
    let (long, rest) = spins(40.0);
    let (short, _) = spins(rest + 1.0);
    assert!(rest < 30.0 && short.iter().all(|spin| spin.abs() > 1e-4), "{rest} {short:?}");
    for (long, short) in long.iter().zip(short) {
        let expected = short * crate::math::exp(-0.2 * (39.0 - rest));
        assert!((long / expected - 1.0).abs() < 1e-9, "{long} and {expected}");
    }
}
