//! What a motion asks of the toe, the device and its gears, and where an assumption of the model fails.

use serde::Serialize;
use sprag_shared::math::scalar::Real;
use sprag_shared::observers::checks::{Checks, Extreme, Report};
use sprag_shared::observers::coil_use::{CoilUse, CoilUses};
use sprag_shared::structure::Base;
use sprag_shared::structure::block::{GRAVITY, Geometry};
use sprag_shared::structure::device::DeviceKind;
use sprag_shared::structure::gear_teeth::{Gear, tooth_load_ratios};
use sprag_shared::structure::inertance::Flywheel;

use super::run::Task;
use crate::scene::Scene;
use crate::scene::checks::{ChecksTable, GearTable};
use crate::scene::device::FlywheelTable;

/// The results of `[checks]`, the fall of a block that overturns left out; none where the block never rocked.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Demand {
    /// Coefficient of friction without which the toe would slide, or the block that never rocks; none where the toe would leave the ground,
    /// for no coefficient is enough there.
    pub friction_needed: Option<f64>,
    /// When, s.
    pub friction_needed_time_s: Option<f64>,
    /// Smallest vertical reaction over the weight.
    pub smallest_vertical_reaction_ratio: Option<f64>,
    /// When the toe would leave the ground, s.
    pub contact_lost_time_s: Option<f64>,
    /// Largest |F|/(mg) of both flywheels together on their support.
    pub force_ratio: Option<f64>,
    /// Farthest travel of the terminals to one side, m.
    pub stroke_m: Option<f64>,
    /// Largest bending stress at the root of a tooth, each mesh from the rack on, MPa.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tooth_stress_mpa: Vec<f64>,
    /// Energy that the coils of both clutches take, J; none without clutches that have coils.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coil_energy_j: Option<f64>,
    /// The assumptions that fail, in words.
    pub warnings: Vec<String>,
    /// As `stroke_m`, with the fall of a block that overturns, up to where it lies on the ground.
    #[serde(skip)]
    pub stroke_with_fall_m: Option<f64>,
    /// The largest of `tooth_stress_mpa`, with the fall of a block that overturns; 0 where the block never rocked, none without a gear.
    #[serde(skip)]
    pub tooth_stress_with_fall_mpa: Option<f64>,
    /// As `coil_energy_j`, with the fall of a block that overturns.
    #[serde(skip)]
    pub coil_energy_with_fall_j: Option<f64>,
    /// The largest forces, speed of a flywheel and farthest travel with their times.
    #[serde(skip)]
    pub located: Located,
    /// What the coils did, where the scene has one; the fall of a block that overturns left out.
    #[serde(skip)]
    pub coils: Option<CoilUse>,
}

/// What a device asks for and when, s; the fall of a block that overturns left out. None where the block never rocked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Located {
    /// Largest |F|/(mg) of both flywheels together on their support.
    pub support: Option<Extreme<f64>>,
    /// Largest |F|/(mg) of one flywheel at the rack.
    pub drive: Option<Extreme<f64>>,
    /// Largest speed of a flywheel behind an elastic clutch, as that of a rack that turns it, m/s; none behind others, where it is the rack's at
    /// most.
    pub flywheel_speed: Option<Extreme<f64>>,
    /// Farthest travel of the terminals to one side, m.
    pub stroke: Option<Extreme<f64>>,
}

/// What impacts and jolts ask of the toe, the fall of a block that overturns left out; each none where there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Impulses {
    /// Coefficient of friction without which the toe would slide at an impact.
    pub impact_friction_needed: Option<f64>,
    /// The same at a jolt that presses the toe down.
    pub jolt_friction_needed: Option<f64>,
    /// Largest impulse over the block's mass (m/s) by which the ground would have to pull the toe down at a jolt.
    pub jolt_pull_m_s: Option<f64>,
}

impl Impulses {
    /// Of what checks found.
    pub(super) fn of<S: Real>(report: &Report<S>) -> Impulses {
        Impulses {
            impact_friction_needed: number(&report.impact_friction),
            jolt_friction_needed: number(&report.jolt_friction),
            jolt_pull_m_s: number(&report.jolt_pull),
        }
    }

    /// The assumptions that fail where the coefficient of friction is `available`.
    fn warnings(&self, available: Option<f64>) -> Vec<String> {
        let slides = |needed: Option<f64>, what: &str| {
            let (needed, available) = needed.zip(available).filter(|(needed, available)| needed > available)?;
            Some(format!("the toe would slide at {what}: {needed:.3} is needed, {available} is there"))
        };
        let lifts = self.jolt_pull_m_s.map(|pull| {
            format!("the toe would lift at a jolt: the ground would have to pull it down by {pull:.2e} m/s times the mass")
        });
        [slides(self.impact_friction_needed, "an impact"), slides(self.jolt_friction_needed, "a jolt"), lifts]
            .into_iter()
            .flatten()
            .collect()
    }
}

impl Located {
    /// Of what checks found about the device of `task`; one flywheel is looked at where the scene asks for friction or gears.
    fn of<S: Real>(task: &Task<'_>, report: &Report<S>) -> Located {
        let times =
            |factor: f64, extreme: Extreme<S>| Extreme { value: factor * extreme.value.to_f64(), time: extreme.time.to_f64() };
        let force = |extreme: Extreme<S>| times(heavier(task), extreme);
        Located {
            support: report.support.map(force),
            drive: report.largest_force().map(force),
            flywheel_speed: report.flywheel_speed.map(|extreme| times(1.0, extreme)),
            stroke: report.stroke().map(|extreme| times(1.0, extreme)),
        }
    }
}

fn number<S: Real>(extreme: &Option<Extreme<S>>) -> Option<f64> {
    extreme.map(|extreme| extreme.value.to_f64())
}

/// Forces of a report are over the weight of the loaded block; results are over that of the bare one.
fn heavier(task: &Task<'_>) -> f64 {
    1.0 + task.device().added_mass.mass_ratio
}

/// Largest |F|/(mg) of both flywheels together on their support.
pub(super) fn support_force_ratio<S: Real>(task: &Task<'_>, report: &Report<S>) -> Option<f64> {
    number(&report.support).map(|force| force * heavier(task))
}

/// Bending stress of the teeth at each mesh of device `index` of `scene`, MPa, of which the first is `gear` and carries `force_ratio`, over the
/// block's weight; none where the block has no mass.
pub(crate) fn tooth_stresses(gear: &GearTable, scene: &Scene, index: usize, force_ratio: f64) -> Vec<f64> {
    let Some(mass) = scene.file.block.mass_kg else { return Vec::new() };
    let tooth = Gear {
        module_m: gear.module_mm * 1e-3,
        face_width_m: gear.face_width_mm * 1e-3,
        teeth: gear.teeth,
        allowable_stress_pa: gear.allowable_stress_mpa * 1e6,
    };
    let load = force_ratio * mass * GRAVITY;
    let train: Vec<Flywheel> = scene.file.device[index].flywheels.iter().flatten().map(FlywheelTable::wheel).collect();
    let ratios: Vec<f64> = match tooth_load_ratios(&train) {
        Ok(ratios) => ratios.collect(),
        Err(_) => vec![1.0],
    };
    ratios.iter().map(|ratio| tooth.bending_stress(load * ratio) * 1e-6).collect()
}

/// Largest |ü_g/g|/(1 + v̈_g/g) of a block that never rocks, where `table` asks for the friction: up to tan α it would slide before it does.
fn standing_friction(task: &Task<'_>, table: &ChecksTable) -> Option<f64> {
    let stands = matches!(task.scene.file.block.base(), Base::Rigid) && table.friction_coefficient.is_some();
    stands.then(|| task.ground.horizontal.steepest(task.ground.vertical.as_ref()))
}

impl Demand {
    /// Of what `checks` found about the device of `task`.
    pub(crate) fn of<S: Real>(task: &Task<'_>, table: &ChecksTable, checks: &Checks<S>, coils: Option<CoilUses>) -> Demand {
        let (report, whole) = (checks.before_fall(), checks.report);
        // A look may miss the instants at which V ≤ 0, which the search for its smallest value finds.
        let lifted = report.vertical.filter(|vertical| vertical.value <= S::ZERO).map(|vertical| vertical.time);
        let contact_lost = report.contact_lost.or(lifted);
        // |H|/V grows without bound towards V = 0: what is found of it there is a matter of rounding.
        let friction = report.friction.filter(|_| contact_lost.is_none());
        let farthest = |report: &Report<S>| report.stroke().map(|extreme| extreme.value.to_f64());
        // The teeth of the rack mesh with the drive of one flywheel each.
        let stresses = |report: &Report<S>| {
            let force = number(&report.largest_force()).map(|force| force * heavier(task));
            let (gear, force) = table.gear.as_ref().zip(force)?;
            Some(tooth_stresses(gear, task.scene, task.index, force))
        };
        let energy = |used: CoilUse| table.coil.as_ref().map(|coil| coil.energy_j(&used));
        let mut demand = Demand {
            friction_needed: number(&friction).or_else(|| standing_friction(task, table).filter(|_| contact_lost.is_none())),
            friction_needed_time_s: friction.map(|extreme| extreme.time.to_f64()),
            smallest_vertical_reaction_ratio: number(&report.vertical),
            contact_lost_time_s: contact_lost.map(Real::to_f64),
            force_ratio: support_force_ratio(task, &report),
            stroke_m: farthest(&report),
            tooth_stress_mpa: stresses(&report).unwrap_or_default(),
            coil_energy_j: coils.and_then(|coils| energy(coils.before_fall)),
            warnings: Vec::new(),
            stroke_with_fall_m: farthest(&whole),
            tooth_stress_with_fall_mpa: table.gear.map(|_| stresses(&whole).into_iter().flatten().fold(0.0, f64::max)),
            coil_energy_with_fall_j: coils.and_then(|coils| energy(coils.whole)),
            located: Located::of(task, &report),
            coils: coils.map(|coils| coils.before_fall),
        };
        demand.warn(task, table, &Impulses::of(&report));
        demand
    }

    fn warn(&mut self, task: &Task<'_>, table: &ChecksTable, impulses: &Impulses) {
        if let Some(allowed) = table.gear.map(|gear| gear.allowable_stress_mpa) {
            for (mesh, stress) in self.tooth_stress_mpa.iter().enumerate().filter(|(_, stress)| **stress > allowed) {
                self.warnings.push(format!("teeth of mesh {} are overloaded: {stress:.1} MPa, {allowed} MPa allowed", mesh + 1));
            }
        }
        let mut warn = |message: String| self.warnings.push(message);
        if let Some(time) = self.contact_lost_time_s {
            warn(format!(
                "the toe would leave the ground at {time:.4} s: no coefficient of friction is enough, and from there on the model does \
                 not hold"
            ));
        }
        if let Some(available) = table.friction_coefficient
            && let Some(needed) = self.friction_needed.filter(|needed| *needed > available)
        {
            warn(format!("the toe would slide: a coefficient of friction of {needed:.3} is needed, {available} is there"));
        }
        impulses.warnings(table.friction_coefficient).into_iter().for_each(&mut warn);
        // Another key shows what such a block does where it would slide.
        let shows_slide = task.device().device.kind == DeviceKind::None && task.scene.geometry() == Geometry::Full;
        let available = table.friction_coefficient.filter(|_| shows_slide);
        let needed = [self.friction_needed, impulses.impact_friction_needed].into_iter().flatten().reduce(f64::max);
        if let Some(friction) = available.filter(|available| needed.is_some_and(|needed| needed > *available)) {
            warn(format!("block.friction_coefficient = {friction} without [checks] shows how far the base slides"));
        }
        if let (Some(limit), Some(force)) = (table.largest_force_ratio, self.force_ratio)
            && force > limit
        {
            warn(format!("the force on the device's support reaches {force:.4} of the block's weight; the limit is {limit}"));
        }
        if let (Some(limit), Some(stroke)) = (table.largest_stroke_m, self.stroke_m)
            && stroke > limit
            && task.device().device.kind != DeviceKind::None
        {
            let against = if task.carried() { " against the ground, without what their support moves" } else { "" };
            warn(format!("the terminals travel {stroke:.4} m{against}; the limit is {limit} m"));
        }
        if let (Some(limit), Some(energy)) = (table.coil.and_then(|coil| coil.largest_energy_j), self.coil_energy_j)
            && energy > limit
        {
            warn(format!("the coils take {energy:.1} J; the limit is {limit} J"));
        }
    }
}
