//! Guards: functions that are positive for as long as a mode lasts (`docs/modes.md`).

use crate::consistent::way_of;
use crate::device::Coupling;
use crate::equation::{Model, Shaking};
use crate::mode::{BlockMode, Link, State};

/// What ends a mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Guard {
    /// θ = 0.
    Impact,
    /// θ̇ = 0.
    Turn,
    /// |θ| at the point of no return.
    Overturn,
    /// Weight and ground change the sign of Eq. 10.
    Command,
    /// ẋ = z: the terminals of a device on a support that moves turn.
    Terminals,
    /// Standing or held: what pushes exceeds what holds.
    Leave,
    /// Standing with an engaged clutch that holds it down: weight alone would hold it again.
    Retire,
    /// Flywheel: |F| = F_c of plates that stick.
    Slip(usize),
    /// ẋ = w of plates that slip, or of an overrunning clutch that had parted.
    Join(usize),
    /// The force of an overrunning clutch is zero.
    Part(usize),
    /// The force of what is locked changes its sign, and friction of the mesh with it.
    Load,
    /// w = 0.
    Stop(usize),
    /// The link's force is the dry friction of a flywheel that stands.
    Start(usize),
    /// |z| reaches the edge of the backlash, from within.
    Touch(usize),
    /// And from outside.
    Loosen(usize),
    /// |F| of spring and damper reaches F_c.
    Saturate(usize),
    /// The plates of a saturated clutch have one speed.
    Hold(usize),
}

/// The present guards and their values.
pub fn guards(model: &Model, state: &State, shaking: Shaking) -> Vec<(Guard, f64)> {
    let mut all = Vec::with_capacity(8);
    let device = &model.device;
    let (rotation, velocity) = (state.rotation(), state.velocity());
    let pose = model.pose(state.side(), rotation);
    let rack = model.rack_speed(&pose, velocity);
    let mut locked_force = 0.0;
    if let BlockMode::Rocking { side, direction } = state.block {
        all.push((Guard::Impact, side * rotation));
        all.push((Guard::Turn, direction * velocity));
        if side == direction {
            all.push((Guard::Overturn, model.overturned - side * rotation));
        }
        if device.is_commanded() && state.armed {
            all.push((Guard::Command, state.drive * model.drive(state, shaking)));
        }
        if state.wheels.iter().any(|wheel| wheel.link == Link::Locked) && (!device.only_locks() || device.mesh > 0.0) {
            let acceleration = model.rates(state, state.time, &state.values, shaking)[crate::step::VELOCITY];
            locked_force = model.locked_force(&pose, velocity, acceleration, direction);
            if device.mesh > 0.0 {
                all.push((Guard::Load, state.load * direction * locked_force));
            }
        }
    } else if state.block != BlockMode::Overturned {
        all.push((Guard::Leave, -model.readiness(state, shaking)));
        if model.follows_terminals() {
            all.push((Guard::Command, state.drive * model.drive(state, shaking)));
        }
        let engaged =
            device.is_commanded() && !model.follows_terminals() && state.wheels.iter().any(|wheel| wheel.link != Link::Open);
        if state.block == BlockMode::Standing && engaged {
            all.push((Guard::Retire, model.open_readiness(state, shaking)));
        }
    }
    if model.follows_terminals() {
        all.push((Guard::Terminals, state.terminals * model.terminals_now(state)));
    }
    let moves = matches!(state.block, BlockMode::Rocking { .. });
    for (i, wheel) in state.wheels.iter().enumerate() {
        let (spin, twist) = (state.spin(i), state.twist(i));
        let dry = model.dry(wheel.link);
        let (capacity, growth) = model.capacity(wheel, state.time);
        let force = if wheel.link == Link::Locked { 0.0 } else { model.link_force(wheel, twist, rack - spin, state.time) };
        match (wheel.link, device.coupling) {
            (Link::Locked, Coupling::Plates) if moves => all.push((Guard::Slip(i), capacity - locked_force.abs())),
            (Link::Locked, Coupling::Overrunning) if moves => all.push((Guard::Part(i), way_of(i) * locked_force)),
            (Link::Open, Coupling::Overrunning) => all.push((Guard::Join(i), way_of(i) * (spin - rack))),
            (Link::Slipping(sign), _) => all.push((Guard::Join(i), sign * (rack - spin))),
            (Link::Play, Coupling::Elastic { half_play, .. }) => all.push((Guard::Touch(i), half_play - twist.abs())),
            (Link::Contact(side), Coupling::Elastic { half_play, .. }) => {
                if half_play > 0.0 {
                    all.push((Guard::Loosen(i), side * twist - half_play));
                }
                // Without a damper the force follows the twist, and may be ahead of a capacity that catches up with it by rounding.
                let ahead = match device.coupling {
                    Coupling::Elastic { stiffness, damping: 0.0, .. } => growth - force.signum() * stiffness * (rack - spin),
                    _ => f64::NEG_INFINITY,
                };
                all.push((Guard::Saturate(i), (capacity - force.abs()).max(ahead)));
            }
            (Link::Saturated(_, sign), _) => {
                let slip = rack - spin - model.twist_rate(wheel, twist, rack - spin, state.time, state.time);
                all.push((Guard::Hold(i), sign * slip));
            }
            _ => {}
        }
        if wheel.link == Link::Locked || dry == 0.0 {
            continue;
        }
        match wheel.turning {
            Some(sign) => all.push((Guard::Stop(i), sign * spin)),
            None if wheel.link != Link::Open || device.drag > 0.0 => {
                all.push((Guard::Start(i), device.inertance * dry - force.abs()))
            }
            None => {}
        }
    }
    all
}
