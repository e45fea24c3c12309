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
    /// Everything that came in.
    pub fn income(&self) -> f64 {
        let values = &self.values;
        self.initial + values[INPUT].abs() + values[CREATED]
    }

    /// What is missing: 0 but for the error of the steps.
    pub fn residual(&self) -> f64 {
        let values = &self.values;
        let came = self.initial + values[INPUT] + values[CREATED] + values[KINEMATICS];
        let went = values[RACK] + values[BEARING] + values[BRAKE] + values[CLUTCH] + values[IMPACT];
        came - went - self.present
    }

    /// [`Ledger::residual`] over what came in.
    pub fn relative_residual(&self) -> f64 {
        self.residual().abs() / self.income().max(f64::MIN_POSITIVE)
    }
}
