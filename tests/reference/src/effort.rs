//! How finely a run is followed, and for how long at most.

use crate::device::Coupling;
use crate::equation::Model;

/// Fastest rate times step, where nothing else is asked for.
const RESOLUTION: f64 = 0.01;
/// Longest step at that resolution, s.
const LONGEST: f64 = 5e-4;

/// What a run may cost.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Fastest rate times step: what changes with it is the error of the steps.
    pub resolution: f64,
    /// Events. A motion without an end has more than this, and so has one whose modes do not get on.
    pub events: usize,
}

impl Default for Effort {
    /// Some ten times the events of the busiest of a thousand random scenes.
    fn default() -> Effort {
        Effort { resolution: RESOLUTION, events: 20_000 }
    }
}

impl Effort {
    /// With half the step.
    pub fn finer(self) -> Effort {
        Effort { resolution: self.resolution / 2.0, ..self }
    }

    /// Step that resolves the fastest rate of block, ground and device, s.
    pub fn largest_step(self, model: &Model) -> f64 {
        let (block, device) = (&model.block, &model.device);
        let mut rate = 5.0 * block.frequency_parameter();
        rate = rate.max(3.0 * model.horizontal.rate().max(model.vertical.rate()).max(model.support.rate()));
        rate = rate.max(device.rack_viscous).max(2.0 * device.bearing_viscous);
        if device.drag > 0.0 {
            // Both flywheels may be open.
            let (lever, _) = device.lever.at(1.0, 0.0);
            rate = rate.max(device.drag * (1.0 / device.inertance + 2.0 * lever * lever / block.inertia));
        }
        if let Coupling::Slip { damping, .. } = device.coupling {
            let (lever, _) = device.lever.at(1.0, 0.0);
            rate = rate.max(damping * (1.0 / device.inertance + lever * lever / block.inertia));
        }
        if let Coupling::Elastic { stiffness, damping, .. } = device.coupling {
            let (lever, _) = device.lever.at(1.0, 0.0);
            let inverse_mass = 1.0 / device.inertance + lever * lever / block.inertia;
            rate = rate.max(1.2 * (2.0 * stiffness * inverse_mass).sqrt()).max(damping * inverse_mass);
            if damping > 0.0 && device.capacity.is_finite() {
                rate = rate.max(0.5 * stiffness / damping);
            }
        }
        (self.resolution / rate).min(LONGEST * self.resolution / RESOLUTION)
    }
}
