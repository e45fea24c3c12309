//! Digests (hashes) of results: what has the same went through the same bits, on whatever machine.

use sprag_shared::math::fnv::Fnv;

#[cfg(feature = "effects")]
use crate::closed_loop::run::Tick;
use crate::simulation::DeviceRun;

/// [`Fnv`] over θ and θ̇ of every sample of every device, in their order.
pub fn of_responses(runs: &[DeviceRun]) -> u64 {
    let mut hash = Fnv::default();
    for sample in runs.iter().flat_map(|run| &run.history.samples) {
        hash.number(sample.rotation_rad);
        hash.number(sample.velocity_rad_s);
    }
    hash.value()
}

/// [`Fnv`] over every decision of the controller, the firmware's or the host's.
#[cfg(feature = "effects")]
pub fn of_decisions(ticks: &[Tick]) -> u64 {
    let mut hash = Fnv::default();
    ticks.iter().for_each(|tick| tick.decision.feed(&mut hash));
    hash.value()
}
