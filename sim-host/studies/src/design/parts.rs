//! The parts list of one device.

use serde::Serialize;
use sprag_shared::observers::checks::Extreme;
use sprag_shared::structure::block::GRAVITY;
use sprag_sim::scene::checks::CoilTable;

use super::asked::Asked;
use super::basis::Basis;
use super::flywheel::Disc;
use super::gear::{Pinion, rack_teeth};
use super::largest::{Largest, largest};
use super::late::Allowed;
use super::sensors::{SensorClass, sensor_class};
use super::standard::{R10, R20, preferred};
use crate::sensitivity::motion::StudyMotion;

/// One line of the list.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Item {
    /// The part.
    pub part: &'static str,
    /// What of it is sized.
    pub quantity: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What the motions ask for, without a margin; null where it follows from other lines.
    pub needed: Option<f64>,
    /// What is chosen, or allowed; null where nothing is.
    pub chosen: Option<f64>,
    /// Chosen over needed.
    pub margin: Option<f64>,
    /// The motion that decides.
    pub motion: Option<String>,
    /// When, s.
    pub time_s: Option<f64>,
    /// Whether that is in the run with the chosen clutches.
    pub chosen_clutches: bool,
}

/// What the chosen clutches come to, as plates that slip, with the delay that is allowed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Built {
    /// Force at the rack at which a clutch slips, N.
    pub capacity_n: f64,
    /// Delay of engagement and release, beyond the scene's, s.
    pub delay_s: f64,
    /// Motions that overturn it.
    pub overturned: usize,
    /// Those of them that do not overturn the device as the scene has it.
    pub newly_overturned: usize,
    /// Motions without a run.
    pub failed: usize,
    /// max |θ|/α over the motions in which it stands, as the scene has it too; null where there is none.
    pub largest_rotation: Option<f64>,
    /// Largest force on the support, N.
    pub support_n: Option<Largest>,
    /// Farthest travel to one side, m.
    pub travel_m: Option<Largest>,
    /// Largest speed of the rack, m/s.
    pub rack_speed_m_s: Option<Largest>,
    /// Largest |θ̇|, rad/s.
    pub rate_rad_s: Option<Largest>,
    /// Largest acceleration that an accelerometer on block or ground reads, m/s².
    pub acceleration_m_s2: Option<Largest>,
    /// Longest time that the coils of both clutches are engaged, s.
    pub coils_engaged_s: Option<Largest>,
    /// Largest energy of both, J; null where the scene has no coil.
    pub coil_energy_j: Option<Largest>,
    /// Largest coefficient of friction that the toe needs, impacts and jolts included, over the motions under which it stays on the ground.
    pub friction_needed: Option<f64>,
    /// Motions under which the toe would leave the ground.
    pub contact_lost: usize,
    /// Largest jump of the velocity of the centre of mass at an impact or a jolt, m/s.
    pub jump_m_s: Option<Largest>,
}

/// What is known of a device before its lines are written.
pub struct Sizing<'a> {
    /// The motions.
    pub motions: &'a [StudyMotion],
    /// What it asks for under each.
    pub asked: &'a [Option<Asked>],
    /// The design basis.
    pub basis: &'a Basis,
    /// Sets of the parts: two for a rack at each base corner, which rises only.
    pub sets: usize,
    /// Mass of the block, kg.
    pub mass_kg: f64,
    /// The pinion.
    pub pinion: &'a Pinion,
    /// The flywheel.
    pub disc: &'a Disc,
    /// Largest speed of a flywheel as that of a rack that turns it, m/s.
    pub flywheel_speed: Option<&'a Largest>,
    /// The delay allowed, of clutches that take commands.
    pub allowed: Option<&'a Allowed>,
    /// Whether a controller drives them, so that its sensors were in the runs.
    pub controlled: bool,
    /// The chosen clutches, where they were tried.
    pub built: Option<&'a Built>,
    /// The support moves otherwise than the ground, so that nobody knows how the rack moves on it.
    pub on_support: bool,
    /// The scene's coil.
    pub coil: Option<CoilTable>,
}

impl Sizing<'_> {
    /// The sensors that a controller needs; none without clutches that take commands.
    pub fn sensors(&self) -> Option<SensorClass> {
        let allowed = self.allowed?;
        let margin = self.basis.margin;
        let for_sensors = (!self.controlled).then_some(allowed.delay_s);
        Some(sensor_class(margin * self.rate()?.value, margin * self.acceleration()?.value, for_sensors))
    }

    fn rate(&self) -> Option<Largest> {
        self.of_both_runs(|asked| Some(asked.rate), |built| &built.rate_rad_s)
    }

    fn acceleration(&self) -> Option<Largest> {
        self.of_both_runs(|asked| Some(asked.acceleration()), |built| &built.acceleration_m_s2)
    }

    /// The larger of what the scene's clutches ask for and of what the chosen ones do.
    fn of_both_runs(
        &self,
        of: impl Fn(&Asked) -> Option<Extreme<f64>>,
        built: fn(&Built) -> &Option<Largest>,
    ) -> Option<Largest> {
        let found = largest(self.motions, self.asked, of)?;
        Some(found.or_larger(self.built.and_then(|with| built(with).as_ref())))
    }

    /// The lines, by part.
    pub fn items(&self, sensors: Option<&SensorClass>) -> Vec<Item> {
        let (basis, pinion, disc) = (self.basis, self.pinion, self.disc);
        let weight = self.mass_kg * GRAVITY;
        let in_newtons = |force: Extreme<f64>| Extreme { value: weight * force.value, ..force };
        let support = self.of_both_runs(|asked| asked.located.support.map(in_newtons), |built| &built.support_n);
        let travel = self.of_both_runs(|asked| asked.located.stroke, |built| &built.travel_m);
        let drive = largest(self.motions, self.asked, |asked| asked.located.drive);
        let mut list = List::default();
        let at_corners = self.sets > 1;
        if at_corners {
            list.follows("all parts", "sets, one at each base corner", "", Some(self.sets as f64));
        }

        let with_margin = |series: &[f64], needed: &Option<Largest>| {
            needed.as_ref().map(|needed| preferred(series, basis.margin * needed.value)).filter(|size| size.is_finite())
        };
        let chosen_travel = with_margin(&R20, &travel).filter(|_| !self.on_support);
        // A clutch that was not tried may pull with more than was needed here.
        let slips = pinion.clutch_torque_n_m.is_some() && self.built.is_none();
        let slips_at = if slips { preferred(&R10, pinion.load_n) } else { 0.0 };
        let chosen_support = with_margin(&R10, &support).map(|force| force.max(slips_at));
        list.sized("support", "force", "N", support.as_ref(), chosen_support);
        let (of_travel, sides) = if at_corners { ("travel upwards", 1.0) } else { ("travel to each side", 2.0) };
        list.sized("rack", of_travel, "m", travel.as_ref(), chosen_travel);
        let teeth = chosen_travel.map(|travel| rack_teeth(sides * travel, pinion.module_mm));
        list.follows("rack", "teeth", "", teeth);
        list.follows("rack", "toothed length", "m", teeth.map(|teeth| 1e-3 * std::f64::consts::PI * pinion.module_mm * teeth));

        list.follows("pinion", "module", "mm", Some(pinion.module_mm));
        list.follows("pinion", "teeth", "", Some(f64::from(pinion.teeth)));
        list.follows("pinion", "face width", "mm", Some(pinion.face_width_mm));
        list.follows("pinion", "pitch radius", "m", Some(pinion.radius_m));
        let stress = drive.as_ref().map(|drive| Largest { value: pinion.stress_mpa, ..drive.clone() });
        list.sized("pinion", "bending stress", "MPa", stress.as_ref(), Some(basis.allowable_stress_mpa));
        if let Some(torque) = pinion.clutch_torque_n_m {
            let needed = drive.as_ref().map(|drive| drive.times(weight * pinion.radius_m));
            list.sized("clutch, each", "torque", "N m", needed.as_ref(), Some(torque));
        }

        let flywheel = if pinion.clutch_torque_n_m.is_some() { "flywheel, each" } else { "flywheel" };
        list.follows(flywheel, "moment of inertia", "kg m²", Some(disc.inertia_kg_m2));
        list.follows(flywheel, "diameter", "m", Some(disc.diameter_m));
        list.follows(flywheel, "thickness", "m", Some(disc.thickness_m));
        list.follows(flywheel, "mass", "kg", Some(disc.mass_kg));
        let of_speed = |value: f64| self.flywheel_speed.map(|speed| Largest { value, ..speed.clone() });
        list.sized(flywheel, "speed", "rev/min", of_speed(disc.speed_rev_min).as_ref(), None);
        list.sized(flywheel, "energy", "J", of_speed(disc.energy_j).as_ref(), None);
        let rim = of_speed(disc.rim_stress_mpa);
        let allowable = (!self.on_support).then_some(basis.allowable_stress_mpa);
        list.sized(flywheel, "stress at the rim", "MPa", rim.as_ref(), allowable);

        if let Some(allowed) = self.allowed {
            let motion = allowed.lost().and_then(|late| late.motion).map(|motion| self.motions[motion].name.clone());
            let mut item = Item::of("clutch control", "delay, all in all", "s", None, Some(allowed.delay_s));
            item.motion = motion;
            list.0.push(item);
            let for_sensors = sensors.and_then(|sensors| sensors.delay_s);
            list.follows("coil", "delay, at most", "s", Some(allowed.delay_s - for_sensors.unwrap_or(0.0)));
            let engaged = self.of_both_runs(Asked::coils_engaged_s, |built| &built.coils_engaged_s);
            list.sized("coils, both", "time engaged", "s", engaged.as_ref(), None);
            if let Some(coil) = &self.coil {
                let energy = self.of_both_runs(|asked| asked.coil_energy_j(Some(coil)), |built| &built.coil_energy_j);
                list.sized("coils, both", "energy", "J", energy.as_ref(), None);
            }
        }
        if let Some(sensors) = sensors {
            let degrees = self.rate().map(|rate| rate.times(1.0 / sprag_sim::sensor::preset::DEGREE));
            let range = sensors.gyroscope_range_deg_s;
            list.sized("gyroscope", "full scale", "°/s", degrees.as_ref(), range);
            let g = self.acceleration().map(|acceleration| acceleration.times(1.0 / GRAVITY));
            list.sized("accelerometers", "full scale", "g", g.as_ref(), sensors.accelerometer_range_g);
            if sensors.delay_s.is_some() {
                list.follows("sensors", "delay, at most", "s", sensors.delay_s);
                list.follows("sensors", "bandwidth, at least", "Hz", sensors.bandwidth_hz);
                list.follows("sensors", "rate, at least", "Hz", sensors.rate_hz);
            }
        }
        list.0
    }
}

/// Lines.
#[derive(Default)]
struct List(Vec<Item>);

impl Item {
    fn of(part: &'static str, quantity: &'static str, unit: &'static str, needed: Option<&Largest>, chosen: Option<f64>) -> Item {
        let value = needed.map(|needed| needed.value);
        Item {
            part,
            quantity,
            unit,
            needed: value,
            chosen,
            margin: value.zip(chosen).filter(|(needed, _)| *needed > 0.0).map(|(needed, chosen)| chosen / needed),
            motion: needed.map(|needed| needed.motion.clone()),
            time_s: needed.map(|needed| needed.time_s).filter(|time| time.is_finite()),
            chosen_clutches: needed.is_some_and(|needed| needed.chosen_clutches),
        }
    }
}

impl List {
    fn sized(
        &mut self,
        part: &'static str,
        quantity: &'static str,
        unit: &'static str,
        needed: Option<&Largest>,
        chosen: Option<f64>,
    ) {
        self.0.push(Item::of(part, quantity, unit, needed, chosen));
    }

    fn follows(&mut self, part: &'static str, quantity: &'static str, unit: &'static str, chosen: Option<f64>) {
        self.0.push(Item::of(part, quantity, unit, None, chosen));
    }
}
