//! The mode that is consistent at an instant: who sticks, who slips.
//!
//! Where a rack and a flywheel have one speed, each may stick or slip; dry friction with a fixed capacity leaves exactly one
//! set of accelerations possible (they minimise a convex function), so all combinations are tried and the one that violates
//! no bound is taken. Bounds: |F| ≤ F_c of what sticks, relative acceleration along the force of what slips; an overrunning
//! clutch pulls only in its direction, and parts only forward.

use crate::block::GRAVITY;
use crate::device::Coupling;
use crate::equation::{Model, Shaking};
use crate::mode::{Link, State};

/// What follows from a state, if the block goes in one direction.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// θ̈.
    pub acceleration: f64,
    /// The links that give it.
    pub links: [Link; 2],
}

/// Direction that an overrunning clutch works in.
pub fn way_of(wheel: usize) -> f64 {
    [1.0, -1.0][wheel]
}

/// What wheel `i` may do now, of a block that goes in `direction`.
fn options(model: &Model, state: &State, i: usize, rack: f64, direction: f64) -> Vec<Link> {
    let link = state.wheels[i].link;
    let one_speed = link == Link::Locked || state.spin(i) == rack;
    // A rack that is about to move cannot fall behind a flywheel that stands.
    let stand = state.velocity() == 0.0 && state.spin(i) == 0.0;
    match (model.device.coupling, link) {
        (Coupling::Plates, Link::Locked | Link::Slipping(_)) if stand && state.slipped != Some(i) => {
            vec![Link::Locked, Link::Slipping(direction)]
        }
        (Coupling::Plates, Link::Locked | Link::Slipping(_)) if one_speed && state.slipped == Some(i) => {
            vec![Link::Slipping(1.0), Link::Slipping(-1.0)]
        }
        (Coupling::Plates, Link::Locked | Link::Slipping(_)) if one_speed => {
            vec![Link::Locked, Link::Slipping(1.0), Link::Slipping(-1.0)]
        }
        (Coupling::Plates, Link::Slipping(_)) => vec![Link::Slipping((rack - state.spin(i)).signum())],
        // A rack that is about to move leaves the flywheel of the other direction behind.
        (Coupling::Overrunning, _) if one_speed && state.velocity() == 0.0 && way_of(i) != direction => vec![Link::Open],
        (Coupling::Overrunning, _) if one_speed && state.slipped == Some(i) => vec![Link::Open],
        (Coupling::Overrunning, _) if one_speed => vec![Link::Locked, Link::Open],
        _ => vec![link],
    }
}

/// Solves for θ̈ and links of a block that goes, or is about to go, in `direction`.
pub fn solve(model: &Model, state: &State, shaking: Shaking, direction: f64) -> Found {
    let (rotation, velocity) = (state.rotation(), state.velocity());
    let side = if rotation == 0.0 && velocity == 0.0 { direction } else { state.side() };
    let pose = model.pose(side, rotation);
    let rack = model.rack_speed(&pose, velocity);
    let free = [0, 1].map(|i| options(model, state, i, rack, direction));
    let joined = [0, 1].map(|i| free[i].len() > 1);
    let mut best = (f64::INFINITY, Found { acceleration: 0.0, links: [Link::Open; 2] });
    for &first in &free[0] {
        for &second in &free[1] {
            let links = [first, second];
            let locked = links.iter().filter(|link| **link == Link::Locked).count() as f64;
            let forces = [0, 1].map(|i| {
                let wheel = crate::mode::Wheel { link: links[i], ..state.wheels[i] };
                if links[i] == Link::Locked {
                    0.0
                } else {
                    model.link_force(&wheel, state.twist(i), rack - state.spin(i), state.time)
                }
            });
            let acceleration = model.acceleration(&pose, velocity, shaking, direction, locked, forces[0] + forces[1]);
            let of_rack = model.rack_acceleration(&pose, velocity, acceleration);
            let mut violation = 0.0_f64;
            for i in (0..2).filter(|&i| joined[i]) {
                let held = model.locked_force(&pose, velocity, acceleration, direction);
                let parting = of_rack - free_rate(model, links[i], state.spin(i), forces[i]);
                violation = violation.max(match (links[i], model.device.coupling) {
                    (Link::Locked, Coupling::Overrunning) => -way_of(i) * held,
                    (Link::Locked, _) => held.abs() - model.capacity(&state.wheels[i], state.time).0,
                    (Link::Slipping(sign), _) => -sign * parting,
                    _ => way_of(i) * parting,
                });
            }
            if violation / GRAVITY < best.0 {
                best = (violation / GRAVITY, Found { acceleration, links });
            }
        }
    }
    best.1
}

/// ẇ of a flywheel under `force`, from standstill only beyond its dry friction.
pub fn free_rate(model: &Model, link: Link, spin: f64, force: f64) -> f64 {
    let (inertance, dry) = (model.device.inertance, model.dry(link));
    let way = if spin != 0.0 {
        spin.signum()
    } else if force.abs() <= inertance * dry {
        return 0.0;
    } else {
        force.signum()
    };
    // A brake that stops at once leaves nothing that turns.
    if dry.is_infinite() { 0.0 } else { force / inertance - model.device.bearing_viscous * spin - dry * way }
}
