//! Devices that must become one another in a limit.

use super::{Seen, pair, shake, structure, tight};
use crate::block::Geometry;
use crate::drivetrain::{Drivetrain, Engagement, FlywheelLosses};
use crate::observer::Event;
use crate::structure::{DeviceKind, KinematicsKind};

const INSTANT: FlywheelLosses = FlywheelLosses { viscous_rate: 0.0, dry_deceleration: 0.0, brake_deceleration: f64::INFINITY };

fn of(engagement: Engagement, flywheel: FlywheelLosses) -> Drivetrain {
    Drivetrain { engagement, flywheel, ..Drivetrain::default() }
}

fn rigid() -> Drivetrain {
    of(Engagement::Rigid, INSTANT)
}

fn peaks(shake: &super::Shake, drivetrains: &[Drivetrain]) -> Vec<f64> {
    drivetrains.iter().map(|drivetrain| shake.machine(drivetrain, &tight()).peak).collect()
}

use std::vec::Vec;

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
        let shake = pair(geometry, 3.0, 5.0);
        let with = |capacity_ratio: f64| of(Engagement::Friction { capacity_ratio }, INSTANT);
        let limit = shake.machine(&rigid(), &tight()).peak;
        let errors: Vec<f64> =
            peaks(&shake, &[with(1e1), with(1e3), with(1e5)]).iter().map(|peak| (peak / limit - 1.0).abs()).collect();
        assert!(errors[1] < errors[0] / 20.0 && errors[2] < errors[1] / 20.0, "{geometry:?}: {errors:?}");
        let alone = super::shake(structure(geometry, 15.0, DeviceKind::None, 0.0, KinematicsKind::Paper), 3.0, 5.0);
        let free = alone.ideal().peak;
        assert!((peaks(&shake, &[with(1e-9)])[0] / free - 1.0).abs() < 1e-6, "{geometry:?}");
    }
}

/// Without a jolt to speak of (the flywheel has no inertance) every clutch is none.
#[test]
fn a_flywheel_without_inertance_does_nothing() {
    let with = |kind, sigma| shake(structure(Geometry::Full, 15.0, kind, sigma, KinematicsKind::Consistent), 3.0, 5.0);
    let free = with(DeviceKind::None, 0.0).ideal().peak;
    for engagement in [Engagement::Ideal, Engagement::Rigid, Engagement::Overrunning] {
        let seen = with(DeviceKind::ClutchedPair, 1e-9).machine(&of(engagement, INSTANT), &tight());
        assert!((seen.peak / free - 1.0).abs() < 1e-7, "{engagement:?}: {} and {free}", seen.peak);
    }
}

/// The velocities around an engagement at speed.
fn first_engagement_at_speed(seen: &Seen) -> Option<f64> {
    let turns: Vec<f64> = seen.events.iter().filter(|(event, _)| *event == Event::Turn).map(|(_, time)| *time).collect();
    let uplifts: Vec<f64> = seen.events.iter().filter(|(event, _)| *event == Event::Uplift).map(|(_, time)| *time).collect();
    let near = |times: &[f64], time: f64| times.iter().any(|other| (other - time).abs() < 1e-9);
    seen.events
        .iter()
        .filter(|(event, _)| *event == Event::Switch)
        .map(|(_, time)| *time)
        .find(|time| !near(&turns, *time) && !near(&uplifts, *time))
}

/// The overrunning clutch holds exactly where Eq. 10 holds as long as its flywheel has stopped in between, so that the first
/// outward swing, which ends before any flywheel is engaged at speed, is the ideal one.
#[test]
fn the_first_swing_of_an_overrunning_clutch_is_ideal() {
    let shake = pair(Geometry::Full, 1.5, 4.0);
    let ideal = shake.machine(&Drivetrain::default(), &tight());
    let overrunning = shake.machine(&of(Engagement::Overrunning, INSTANT), &tight());
    let turn = |seen: &Seen| seen.events.iter().find(|(event, _)| *event == Event::Turn).map(|(_, time)| *time).unwrap();
    assert!((turn(&ideal) - turn(&overrunning)).abs() < 1e-10, "{} and {}", turn(&ideal), turn(&overrunning));
}

/// A rigid clutch that closes at speed makes a difference, which is the point of having it.
#[test]
fn the_ideal_clutch_hides_the_jolt() {
    let shake = pair(Geometry::Full, 6.0, 6.0);
    let (ideal, real) = (shake.machine(&Drivetrain::default(), &tight()), shake.machine(&rigid(), &tight()));
    assert!(first_engagement_at_speed(&ideal).is_some(), "this pulse engages a flywheel at speed");
    assert!((ideal.peak / real.peak - 1.0).abs() > 1e-3, "{} and {}", ideal.peak, real.peak);
}
