//! Forward dynamic programming over the states that the clutches can bring a block to.
//!
//! At every decision each state is continued with every position of the clutches. Of the states that come to lie in one cell of
//! (θ, θ̇, speeds of the flywheels) only the one with the smallest peak is kept. Every state that is kept has been reached by a schedule, so a
//! block that is found to stand can stand; what merging loses vanishes as cells and decisions become finer.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::hash::{BuildHasherDefault, Hasher};

use super::rocker::{Engaged, OPEN, Place, Rocker};
use super::shaking::Shaking;
use crate::ground_motion::GroundMotion;

/// How finely it is searched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Cells in θ, α, and in θ̇, pα; above 0.
    pub cell: f64,
    /// Cells in the speeds of flywheels, pα; above 0.
    pub spin_cell: f64,
    /// From a decision to the next, 1/p; above 0.
    pub decision: f64,
    /// Steps of integration of each; 1 or more.
    pub steps: u32,
    /// Most states that are kept; those with the least |θ|/α + |θ̇|/pα.
    pub most: usize,
}

impl Grid {
    /// As the study of the bound has it.
    pub const STANDARD: Grid = Grid { cell: 0.04, spin_cell: 0.3, decision: 0.08, steps: 8, most: 20_000 };
}

/// What the search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Smallest peak |θ|/α of a block that stands; none if every schedule overturns it.
    pub peak: Option<f64>,
    /// The clutches of it, decision by decision, …
    pub schedule: Vec<Engaged>,
    /// … each for this long, s.
    pub interval: f64,
}

/// How long after the ground motion the clutches still decide, 1/p.
const AFTERWARDS: f64 = 3.0;

const FIRST: Engaged = [true, false];
const SECOND: Engaged = [false, true];

/// The best schedule for `rocker`, from rest, under `ground`.
pub fn search(rocker: &Rocker, ground: &GroundMotion, grid: &Grid) -> Found {
    let frequency = rocker.frequency();
    let interval = grid.decision / frequency;
    let shaking = Shaking::of(ground, interval, grid.steps.max(1), AFTERWARDS / frequency);
    let choices: &[Engaged] = if rocker.spins() { &[OPEN, FIRST, SECOND] } else { &[OPEN, FIRST] };
    let mut states = vec![(Place::REST, 0_u32)];
    // Of every state that was ever kept: the one before, and the clutches between.
    let mut past: Vec<(u32, Engaged)> = vec![(0, OPEN)];
    let mut kept: HashMap<u64, usize, BuildHasherDefault<Mixed>> = HashMap::default();
    for part in shaking.parts() {
        let limit = rocker.no_return(part.bound);
        let mut reached: Vec<(Place, (u32, Engaged))> = Vec::with_capacity(2 * states.len());
        kept.clear();
        for &(place, index) in &states {
            for &choice in choices {
                if (0..2).any(|wheel| choice[wheel] && !rocker.may_engage(&place, wheel)) {
                    continue;
                }
                let mut next = place;
                rocker.engage(&mut next, choice);
                if !follow(rocker, &mut next, part.ground, shaking.step(), limit) {
                    continue;
                }
                match kept.entry(key(rocker, &next, grid)) {
                    Entry::Vacant(slot) => {
                        slot.insert(reached.len());
                        reached.push((next, (index, choice)));
                    }
                    Entry::Occupied(slot) => {
                        let other = &mut reached[*slot.get()];
                        if next.peak < other.0.peak {
                            *other = (next, (index, choice));
                        }
                    }
                }
            }
        }
        if reached.len() > grid.most {
            let (alpha, speed) = (rocker.slenderness(), rocker.slenderness() * frequency);
            let size = |place: &Place| place.rotation.abs() / alpha + place.velocity.abs() / speed;
            reached.sort_by(|one, other| size(&one.0).total_cmp(&size(&other.0)));
            reached.truncate(grid.most);
        }
        let first = past.len() as u32;
        past.extend(reached.iter().map(|(_, step)| *step));
        states = reached.into_iter().zip(first..).map(|((place, _), index)| (place, index)).collect();
        if part.quiet && states.iter().any(|(place, _)| rocker.settles_at(place).is_some()) {
            break;
        }
    }
    let settled = states.iter().filter_map(|(place, index)| Some((rocker.settles_at(place)?, *index)));
    let Some((peak, mut index)) = settled.min_by(|one, other| one.0.total_cmp(&other.0)) else {
        return Found { peak: None, schedule: Vec::new(), interval };
    };
    let mut schedule = Vec::new();
    while index != 0 {
        let (before, choice) = past[index as usize];
        schedule.push(choice);
        index = before;
    }
    schedule.reverse();
    Found { peak: Some(peak / rocker.slenderness()), schedule, interval }
}

/// Follows a block over a decision; whether it can still return.
fn follow(rocker: &Rocker, place: &mut Place, ground: &[f64], step: f64, limit: f64) -> bool {
    for &acceleration in ground {
        rocker.step(place, acceleration, step);
        if place.rotation.abs() >= limit && place.rotation * place.velocity > 0.0 {
            return false;
        }
    }
    true
}

/// Cell of a state.
fn key(rocker: &Rocker, place: &Place, grid: &Grid) -> u64 {
    let (alpha, speed) = (rocker.slenderness(), rocker.slenderness() * rocker.frequency());
    let cell = |x: f64, size: f64, bits: u32| {
        let middle = 1_i64 << (bits - 1);
        ((x / size).floor() as i64).clamp(-middle, middle - 1).wrapping_add(middle) as u64
    };
    let mut key = u64::from(place.standing) << 1 | u64::from(place.side > 0.0);
    key = key << 18 | cell(place.rotation, grid.cell * alpha, 18);
    key = key << 18 | cell(place.velocity, grid.cell * speed, 18);
    if rocker.spins() {
        for spin in place.spins {
            key = key << 10 | cell(spin, grid.spin_cell * speed, 10);
        }
        key = key << 2 | u64::from(place.engaged[0]) << 1 | u64::from(place.engaged[1]);
    }
    key
}

/// Hash of one number, the same everywhere.
#[derive(Default)]
struct Mixed(u64);

impl Hasher for Mixed {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(self.0 ^ u64::from(byte));
        }
    }

    fn write_u64(&mut self, number: u64) {
        let mixed = number.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = mixed ^ (mixed >> 32);
    }
}
