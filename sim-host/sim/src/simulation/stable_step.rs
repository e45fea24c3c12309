//! How long a fixed step may be beside viscous forces and springs.

use sprag_shared::equation::body::Body;
use sprag_shared::math;
use sprag_shared::math::scalar::Real;
use sprag_shared::motion::hybrid::HybridSystem;

use crate::scene::accuracy::MethodName;

/// Longest step over the time in which viscous forces use up a speed: Runge-Kutta steps of order 4 are stable up to 2.78 of it.
const LONGEST: f64 = 0.5;

/// Step times rate up to which Runge-Kutta steps of order 4 are stable, less a margin: 2.78 where speeds are used up, 2.83 where springs swing.
const STABLE: f64 = 2.5;

/// Rate at which viscous slip, drag, bearings and rack of `machine` use up speeds of block and flywheels, at most, 1/s.
pub(crate) fn fastest_decay<S: Real>(machine: &HybridSystem<S>) -> f64 {
    let (transmission, body) = (&machine.transmission, &machine.body);
    let parameters = &transmission.parameters;
    let arm = body.arm(&body.configuration(S::ONE, S::ZERO));
    let slip = if transmission.slips_viscously() { parameters.damping } else { S::ZERO };
    let dashpots = slip.larger(parameters.drag) * (parameters.mobility + arm * arm);
    (dashpots + parameters.bearing_rate + parameters.rack_viscous * arm * arm).to_f64()
}

/// Rate at which springs and dampers of `machine`'s clutches move, at most, 1/s: both engaged at once, or one whose twist relaxes while its plates
/// slip.
fn fastest_spring<S: Real>(machine: &HybridSystem<S>) -> f64 {
    if !machine.transmission.traits().springs {
        return 0.0;
    }
    let parameters = &machine.transmission.parameters;
    let arm = machine.body.arm(&machine.body.configuration(S::ONE, S::ZERO)).to_f64();
    let [stiffness, damping, mobility] = [parameters.stiffness, parameters.damping, parameters.mobility].map(Real::to_f64);
    let both = mobility + 2.0 * arm * arm;
    let swing = math::square_root(both * stiffness).max(both * damping);
    let relaxes = damping > 0.0 && parameters.capacity.to_f64().is_finite();
    swing.max(if relaxes { stiffness / damping } else { 0.0 })
}

/// Whether Runge-Kutta steps of this length (s) are stable for the clutches' springs and dampers.
pub(crate) fn springs_bear<S: Real>(machine: &HybridSystem<S>, step: f64) -> bool {
    step * fastest_spring(machine) < STABLE
}

/// `step` (s) of `method`, or as large a whole part of it as is stable beside the viscous forces of `machine` and, but for the exponential midpoint
/// method, its springs.
pub(super) fn stable_step_of<S: Real>(machine: &HybridSystem<S>, method: MethodName, step: f64) -> f64 {
    let step = stable_step(step, fastest_decay(machine));
    if method == MethodName::ExponentialMidpoint || springs_bear(machine, step) {
        return step;
    }
    stable_step(step, fastest_spring(machine))
}

/// `step` (s), or as large a whole part of it as is stable where speeds are used up at a rate of `decay` (1/s).
pub(crate) fn stable_step(step: f64, decay: f64) -> f64 {
    step / (step * decay / LONGEST).ceil().max(1.0)
}

#[cfg(test)]
mod tests {
    use sprag_shared::observers::outcome::Outcome;

    use crate::simulation::runs_of;

    #[test]
    fn fixed_steps_follow_what_fast_viscous_forces_leave_of_a_motion() {
        let viscous = ["engagement = 'rigid', flywheel = { viscous_rate_1_s = 2.0e4 }", "inertance_corner_hz = 1000.0"];
        let methods =
            ["", "method = 'runge-kutta-4', step_s = 2.0e-3", "precision = 'f32', method = 'runge-kutta-4', step_s = 2.0e-3"];
        for device in viscous {
            let peaks = methods.map(|accuracy| {
                let text = format!(
                    "block = {{ size_m = 2.0, slenderness_deg = 12.0 }}
                    device = [{{ kind = 'clutched-pair', mass_ratio = 0.5, {device} }}]
                    ground = [{{ motion = 'sine', amplitude_g = 0.5, frequency_hz = 1.3 }}]
                    run = {{ free_time_s = 1.0 }}
                    accuracy = {{ {accuracy} }}"
                );
                let run = runs_of(&text).remove(0);
                run.peak_rotation.unwrap()
            });
            let near = |other: f64, tolerance: f64| (other / peaks[0] - 1.0).abs() < tolerance;
            assert!(near(peaks[1], 1e-3) && near(peaks[2], 1e-2), "{device}: {peaks:?}");
        }
    }

    #[test]
    fn fixed_steps_follow_stiff_clutches() {
        for damping in [0.1, 1.0, 3.0] {
            for accuracy in ["", "method = 'runge-kutta-4', step_s = 5.0e-3", "method = 'exponential-midpoint', step_s = 2.0e-3"]
            {
                let text = format!(
                    "block = {{ size_m = 2.0, slenderness_deg = 10.0 }}
                    device = [{{ kind = 'clutched-pair', mass_ratio = 0.5, clutch = {{ stiffness_ratio = 1.0e5, damping_ratio = {damping:?} }} }}]
                    ground = [{{ motion = 'sine', amplitude_ratio = 3.0, frequency_hz = 1.0 }}]
                    accuracy = {{ {accuracy} }}"
                );
                let run = runs_of(&text).remove(0);
                assert_eq!((run.outcome, run.impacts), (Outcome::OverturnedAfterImpact, 1), "{damping} {accuracy}");
            }
        }
    }
}
