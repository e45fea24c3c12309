//! What a device and its sensors are asked for under one motion, until its end or the fall of a block that overturns.

use sprag_shared::math;
use sprag_shared::observers::checks::Extreme;
use sprag_shared::observers::coil_use::CoilUse;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::GRAVITY;
use sprag_sim::accuracy::ErrorEstimate;
use sprag_sim::history::Sample;
use sprag_sim::scene::Scene;
use sprag_sim::scene::checks::CoilTable;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::simulation::DeviceRun;
use sprag_sim::simulation::demand::Located;

/// The largest of each, with its time (s). Forces are over the block's weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Asked {
    /// Outcome of the run.
    pub outcome: Outcome,
    /// max |θ|/α; `None` when overturned.
    pub peak_rotation: Option<f64>,
    /// |F|/(mg) on the support and of one flywheel, speed of one behind a spring, m/s, and travel, m.
    pub located: Located,
    /// Speed of the rack, m/s.
    pub rack_speed: Extreme<f64>,
    /// |θ̇|, rad/s.
    pub rate: Extreme<f64>,
    /// Bound on the specific force at the block's centre of mass, m/s².
    pub block_acceleration: Extreme<f64>,
    /// Horizontal acceleration of the ground, m/s².
    pub ground_acceleration: Extreme<f64>,
    /// Jump of the velocity of the centre of mass at an impact or a jolt, m/s.
    pub jump: Extreme<f64>,
    /// What the coils did, of clutches that have some.
    pub coils: Option<CoilUse>,
    /// Coefficient of friction that the toe needs, impacts and jolts included; none where it would leave the ground, for none is enough.
    pub friction_needed: Option<f64>,
    /// Whether the toe would leave the ground, at a jolt or between.
    pub contact_lost: bool,
    /// How accurate that is, where it was asked for.
    pub error: Option<ErrorEstimate>,
}

/// |θ| below which a jump is an impact, rad.
const IMPACT: f64 = 1e-9;

impl Asked {
    /// Of `run`, with a history and checks, of the only device of `scene` under `ground`.
    pub fn of(scene: &Scene, ground: &GroundMotions, run: &DeviceRun) -> Asked {
        let samples = standing(run, scene.block.slenderness());
        let largest = |of: &dyn Fn(&Sample) -> f64| {
            let mut largest = Extreme { value: 0.0, time: 0.0 };
            for sample in samples {
                let value = of(sample);
                if value > largest.value {
                    largest = Extreme { value, time: sample.time_s };
                }
            }
            largest
        };
        let (size, mount) = (scene.block.size(), scene.devices[0].device.mount);
        // A mount that the scene has is one that has a lever.
        let lever = |rotation: f64| mount.lever_at(&scene.block, scene.geometry(), rotation).unwrap_or(0.0);
        let upwards = GRAVITY + ground.vertical.as_ref().map_or(0.0, |vertical| vertical.peak_m_s2());
        let (sine, cosine) = math::sin_cos(scene.block.slenderness());
        let mut jump = Extreme { value: 0.0, time: 0.0 };
        for pair in samples.windows(2).filter(|pair| pair[0].time_s == pair[1].time_s) {
            let (before, after) = (pair[0].velocity_rad_s, pair[1].velocity_rad_s);
            // At an impact the block goes down about one toe and up about the other.
            let value = if pair[1].rotation_rad.abs() < IMPACT {
                size * hypotenuse(cosine * (after - before), sine * (after.abs() + before.abs()))
            } else {
                size * (after - before).abs()
            };
            if value > jump.value {
                jump = Extreme { value, time: pair[0].time_s };
            }
        }
        let checks = run.checks.as_ref();
        let impulses = run.impulses;
        let frictions =
            [checks.and_then(|checks| checks.friction_needed), impulses.impact_friction_needed, impulses.jolt_friction_needed];
        let lifted = impulses.jolt_pull_m_s.is_some_and(|pull| pull > 0.0);
        let contact_lost = lifted || checks.is_some_and(|checks| checks.contact_lost_time_s.is_some());
        Asked {
            outcome: run.outcome,
            peak_rotation: run.peak_rotation,
            located: checks.map(|checks| checks.located).unwrap_or_default(),
            rack_speed: largest(&|sample| (size * lever(sample.rotation_rad) * sample.velocity_rad_s).abs()),
            rate: largest(&|sample| sample.velocity_rad_s.abs()),
            block_acceleration: largest(&|sample| {
                let square = sample.velocity_rad_s * sample.velocity_rad_s;
                let own = size * hypotenuse(sample.acceleration_rad_s2, square);
                hypotenuse(sample.ground_m_s2, upwards) + own
            }),
            ground_acceleration: Extreme {
                value: ground.horizontal.peak_m_s2(),
                time: largest(&|sample| sample.ground_m_s2.abs()).time,
            },
            jump,
            coils: checks.and_then(|checks| checks.coils),
            friction_needed: frictions.into_iter().flatten().reduce(f64::max).filter(|_| !contact_lost),
            contact_lost,
            error: run.error.map(|report| report.estimate),
        }
    }

    /// Largest speed of a flywheel as that of a rack that turns it, m/s: the rack's own, but behind a spring.
    pub fn flywheel_speed(&self) -> Extreme<f64> {
        self.located.flywheel_speed.unwrap_or(self.rack_speed)
    }

    /// What an accelerometer on block or ground reads at most, m/s².
    pub fn acceleration(&self) -> Extreme<f64> {
        let (block, ground) = (self.block_acceleration, self.ground_acceleration);
        if ground.value > block.value { ground } else { block }
    }

    /// How long the coils of both clutches are engaged, s.
    pub fn coils_engaged_s(&self) -> Option<Extreme<f64>> {
        self.coils.map(|coils| whole_run(coils.engaged_s))
    }

    /// Energy of the coils of both clutches, of which each is `coil`, J.
    pub fn coil_energy_j(&self, coil: Option<&CoilTable>) -> Option<Extreme<f64>> {
        self.coils.zip(coil).map(|(coils, coil)| whole_run(coil.energy_j(&coils)))
    }
}

/// A total over a run, which has no instant.
fn whole_run(value: f64) -> Extreme<f64> {
    Extreme { value, time: f64::NAN }
}

fn hypotenuse(a: f64, b: f64) -> f64 {
    math::square_root(a * a + b * b)
}

/// The samples of `run` before |θ| passes α (rad) without coming back.
fn standing(run: &DeviceRun, slenderness: f64) -> &[Sample] {
    let samples = &run.history.samples;
    if !run.outcome.overturned() {
        return samples;
    }
    let last = samples.iter().rposition(|sample| sample.rotation_rad.abs() <= slenderness);
    &samples[..last.map_or(0, |last| last + 1)]
}
