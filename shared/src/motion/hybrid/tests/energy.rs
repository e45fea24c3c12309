//! The energy of every kind of drivetrain adds up.

use std::vec::Vec;

use super::{drivetrains, pair, shake, structure, tight};
use crate::motion::observer::Event;
use crate::structure::Structure;
use crate::structure::block::Geometry;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::drivetrain::{Actuation, Drivetrain, Engagement, FlywheelLosses, Rack};
use crate::structure::restitution::Restitution;

#[test]
fn the_ledger_closes_for_every_drivetrain() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        for (name, drivetrain) in drivetrains() {
            for (amplitude, frequency) in [(3.0, 5.0), (1.6, 3.0)] {
                let shake = pair(geometry, amplitude, frequency);
                let mut ledger = shake.ledger(&drivetrain);
                shake.watched(&drivetrain, &tight(), &mut ledger);
                let entries = ledger.entries;
                let residual = entries.residual().abs() / entries.input.abs();
                let what = std::format!("{geometry:?} {name} a = {amplitude}, ω/p = {frequency}: {entries:?}");
                assert!(residual < 1e-10, "{what}: residual {residual:e} of the input");
                let loses = drivetrain.flywheel != FlywheelLosses::default();
                assert!(entries.impact > 0.0 && (entries.rack > 0.0) == loses && (entries.bearing > 0.0) == loses, "{what}");
                match drivetrain.engagement {
                    Engagement::Ideal => assert!(entries.clutch.abs() < 1e-14 * entries.input, "{what}"),
                    Engagement::Overrunning => assert!(entries.clutch.abs() < 1e-12 * entries.input, "{what}: no jolt, no loss"),
                    Engagement::Rigid => assert!(entries.clutch >= 0.0 && entries.created == 0.0, "{what}"),
                    _ => assert!(entries.clutch > 0.0 && entries.created == 0.0, "{what}"),
                }
            }
        }
    }
}

/// The ideal clutch gives a stopped flywheel the energy ½ k (ℓθ̇)² out of nothing; the rigid one takes it from the block and loses
/// as much again in the jolt.
#[test]
fn what_the_ideal_clutch_creates() {
    let shake = super::limits::engaging_at_speed(Geometry::Slender);
    let k = shake.structure.device.mass_ratio / shake.structure.block.inertia_ratio();
    let mut created = Vec::new();
    for engagement in [Engagement::Ideal, Engagement::Rigid] {
        let flywheel = FlywheelLosses { brake_deceleration: f64::INFINITY, ..FlywheelLosses::default() };
        let flywheel = if engagement == Engagement::Ideal { FlywheelLosses::default() } else { flywheel };
        let drivetrain = Drivetrain { engagement, flywheel, ..Drivetrain::default() };
        let mut ledger = shake.ledger(&drivetrain);
        let seen = shake.watched(&drivetrain, &tight(), &mut ledger);
        let at_speed: Vec<f64> =
            seen.switches.iter().filter(|(time, ..)| (time - 0.22).abs() < 1e-12).map(|s| s.1.velocity).collect();
        let entries = ledger.entries;
        let spin = 0.5 * k * at_speed[0] * at_speed[0];
        match engagement {
            Engagement::Ideal => assert!((entries.created / spin - 1.0).abs() < 1e-9, "{entries:?} {spin}"),
            // ½ k v²/(1 + k): reduced mass of block and flywheel.
            _ => assert!((entries.clutch / (spin / (1.0 + k)) - 1.0).abs() < 1e-9, "{entries:?} {spin}"),
        }
        created.push(entries.created);
        assert!(entries.residual().abs() < 1e-12 * entries.input);
    }
    assert!(created[0] > 0.0 && created[1] == 0.0);
}

/// A rigid clutch that closes on a spinning flywheel moves a tilted block that friction holds. By the balance of moments, integrated by another
/// program from the jolt on, the block stops again at 0.728456157319 s, and turns by 0.006510341083 α at most.
#[test]
fn a_jolt_moves_a_held_block() {
    let base = structure(Geometry::Full, 10.0, DeviceKind::ClutchedPair, 0.5, KinematicsKind::Consistent);
    let drivetrain = Drivetrain {
        engagement: Engagement::Rigid,
        actuation: Actuation { engagement_delay: 0.05, ..Actuation::default() },
        rack: Rack { dry_ratio: 0.15, ..Rack::default() },
        ..Drivetrain::default()
    };
    let shake = shake(Structure { restitution: Restitution::Constant(0.8), ..base }, 2.0, 3.0);
    let mut ledger = shake.ledger(&drivetrain);
    let seen = shake.watched(&drivetrain, &tight(), &mut ledger);
    let stops = seen.events.iter().any(|(event, time)| *event == Event::Turn && (time - 0.728_456_157_319).abs() < 1e-10);
    assert!(stops, "{:?}", seen.events);
    let peak = seen.peak / base.block.slenderness();
    assert!((peak - 0.006_510_341_083).abs() < 1e-10, "{peak}");
    let entries = ledger.entries;
    assert!(entries.residual().abs() < 1e-12 * entries.input, "{entries:?}");
}
