//! What a block and its flywheels do at an instant, where nobody asks for forces and energies.

use super::{HybridState, HybridSystem};
use crate::drivetrain::clutch_state::{Coupling, UNKNOWNS};
use crate::drivetrain::transmission::EvaluationPoint;
use crate::equation::any_body::AnyConfiguration;
use crate::equation::body::Body;
use crate::math::scalar::Real;
use crate::motion::state::Phase;

impl<S: Real> HybridSystem<S> {
    /// θ̈ (rad/s²) of a block in its `configuration`, under the ground's acceleration at the end of the last ground segment.
    #[inline]
    pub fn acceleration_now(&self, state: &HybridState<S>, configuration: &AnyConfiguration<S>) -> S {
        if state.motion.phase != Phase::Rocking || state.held {
            return S::ZERO;
        }
        let law = self.law(state);
        self.transmission.acceleration(&EvaluationPoint {
            body: &self.body,
            parameters: &self.transmission.parameters,
            law: &law,
            configuration: *configuration,
            velocity: state.motion.velocity,
            unknowns: state.device.unknowns(),
            ground: state.ground,
            clock: S::ZERO,
        })
    }

    /// Speeds of the flywheels as that of a rack moving with them, over R; 1/s.
    #[inline]
    pub fn spins_now(&self, state: &HybridState<S>, configuration: &AnyConfiguration<S>) -> [S; 2] {
        let own: [S; UNKNOWNS] = state.device.unknowns();
        let known = if state.device.terminals.is_some() { 0 } else { self.transmission.traits().unknowns };
        let support = state.device.terminals.map_or(S::ZERO, |terminals| terminals.support);
        core::array::from_fn(|i| match state.device.wheels[i].coupling {
            Coupling::Locked => self.body.to_terminal(configuration, state.motion.velocity) - support,
            _ if i < known => own[i],
            _ => S::ZERO,
        })
    }
}
