//! The energy ledger: what is there, against what came and went.

use crate::equation::Model;
use crate::mode::State;
use crate::step::{BEARING, BRAKE, CLUTCH, CREATED, IMPACT, INPUT, KINEMATICS, RACK, SIZE};

/// Kinetic, potential and elastic energy, over mR², 1/s²:
/// ½(λ + μ_g ℓ²)θ̇² + ½Σσw²/R² + (g/R)(cos δ − cos α) + ½ΣK(z − z₀)²/R².
pub fn energy(model: &Model, state: &State) -> f64 {
    let side = state.side();
    let delta = model.block.slenderness * side - state.rotation();
    let (lever, _) = model.device.lever.at(side, delta);
    let over = 1.0 / (model.block.size * model.block.size);
    let mut energy = model.block.potential(delta);
    energy += 0.5 * (model.block.inertia + model.device.guided * lever * lever) * state.velocity().powi(2);
    for (i, wheel) in state.wheels.iter().enumerate() {
        energy += 0.5 * over * model.device.inertance * state.spin(i).powi(2);
        let spring = model.spring_force(wheel, state.twist(i));
        if let (true, crate::device::Coupling::Elastic { stiffness, .. }) = (spring != 0.0, model.device.coupling) {
            energy += 0.5 * over * spring * spring / stiffness;
        }
    }
    energy
}

/// Where the energy of a run went, over mR², 1/s².
#[derive(Clone, Copy, Debug)]
pub struct Ledger {
    /// At the start.
    pub initial: f64,
    /// At the end.
    pub present: f64,
    /// Integrals, by the indices of [`crate::step`].
    pub values: [f64; SIZE],
}

impl Ledger {
    /// What is missing: 0 but for the error of the steps.
    pub fn residual(&self) -> f64 {
        let values = &self.values;
        let came = self.initial + values[INPUT] + values[CREATED] + values[KINEMATICS];
        let went = values[RACK] + values[BEARING] + values[BRAKE] + values[CLUTCH] + values[IMPACT];
        came - went - self.present
    }

    /// As Sprag names its entries.
    fn entry(&self, name: &str) -> Option<f64> {
        let values = &self.values;
        Some(match name {
            "initial" => self.initial,
            "input" => values[INPUT],
            "created" => values[CREATED],
            "impact" => values[IMPACT],
            "clutch" => values[CLUTCH],
            "brake" => values[BRAKE],
            "bearing" => values[BEARING],
            "rack" => values[RACK],
            // What the kinematics give, they take negatively.
            "kinematics" => -values[KINEMATICS],
            "residual" => self.residual(),
            _ => return None,
        })
    }

    /// Over what came in.
    pub fn shares(&self) -> Shares {
        Shares::of(|name| self.entry(name)).unwrap_or_default()
    }
}

/// Where the energy of a run went, over what came in: what was there at the start, the ground's work and what ideal clutches create.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shares {
    /// What is missing: 0 but for errors.
    pub residual: f64,
    /// Created, and lost in impacts, clutches, brakes, bearings, the rack and kinematics.
    entries: [f64; 7],
}

impl Shares {
    /// Of the entries that `entry` knows by Sprag's names, in any unit; none if it does not know one.
    pub fn of(entry: impl Fn(&str) -> Option<f64>) -> Option<Shares> {
        let income = entry("initial")? + entry("input")?.abs() + entry("created")?;
        let share = |name: &str| Some(entry(name)? / income.max(f64::MIN_POSITIVE));
        let mut entries = [0.0; 7];
        for (value, name) in entries.iter_mut().zip(["created", "impact", "clutch", "brake", "bearing", "rack", "kinematics"]) {
            *value = share(name)?;
        }
        Some(Shares { residual: share("residual")?.abs(), entries })
    }

    /// Largest difference of an entry.
    pub fn apart(&self, other: &Shares) -> f64 {
        self.entries.iter().zip(other.entries).fold(0.0, |most, (ours, theirs)| most.max((ours - theirs).abs()))
    }
}
