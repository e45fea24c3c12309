//! What goes wrong on purpose: faults put into the samples that the controller gets, and into what the clutches do.

use sprag_shared::control::controller::Circumstances;
use sprag_shared::control::sensing::sample::Sample;

/// Whoever stands between sensors, controller and clutches.
pub trait Disturbance {
    /// May change what the controller is given at `time` (s).
    fn disturb(&mut self, time: f64, sample: &mut Sample, circumstances: &mut Circumstances);

    /// What the clutches do of the controller's `command`; `last` is what they did before.
    fn clutches(&mut self, _time: f64, command: [bool; 2], _last: [bool; 2]) -> [bool; 2] {
        command
    }
}

/// Nobody.
impl Disturbance for () {
    fn disturb(&mut self, _time: f64, _sample: &mut Sample, _circumstances: &mut Circumstances) {}
}
