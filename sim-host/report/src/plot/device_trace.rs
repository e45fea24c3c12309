//! One device's response in the dimensionless quantities of the figure.

use sprag_sim::history::History;

use super::palette::{DeviceLook, device_look};
use super::ticks::drawable;
use super::time_axis::check_order;
use super::{PlotError, TimeAxis};

/// Limits of the half-height of the θ/α panel: the lines at ±1 always show, and an overturning block does not flatten the others.
const ROTATION_LIMITS: (f64, f64) = (1.2, 2.5);

/// The curves and marks of one device; the first coordinate is on the figure's time axis.
#[derive(Debug, Clone)]
pub(super) struct DeviceTrace {
    /// Colour and dashes.
    pub look: DeviceLook,
    /// Legend text: device, outcome, peak.
    pub label: String,
    /// Rotation θ/α.
    pub rotation: Vec<(f64, f64)>,
    /// Angular velocity over pα.
    pub velocity: Vec<(f64, f64)>,
    /// Transferred force over weight; empty without an inerter.
    pub force: Vec<(f64, f64)>,
    /// Impact times.
    pub impacts: Vec<f64>,
    /// Engaged intervals and their flywheels (1, 2, 3 both); empty without a clutch.
    pub engagements: Vec<(f64, f64, u8)>,
    /// Where the curve of an overturning block ends in the panel.
    pub overturn: Option<(f64, f64)>,
}

/// Half-height of the θ/α panel for these responses: the blocks that come back decide.
pub(super) fn rotation_limit(histories: &[History]) -> f64 {
    let safe_peak =
        histories.iter().filter(|history| !history.ends_overturned()).map(History::peak_rotation_ratio).fold(0.0, f64::max);
    half_height(safe_peak)
}

/// Half-height of a θ/α panel for this peak.
pub(super) fn half_height(peak: f64) -> f64 {
    (1.15 * peak).clamp(ROTATION_LIMITS.0, ROTATION_LIMITS.1)
}

impl DeviceTrace {
    /// Scales the response of the device at `index`; an overturning block's curves end where θ/α passes `limit`.
    pub(super) fn new(index: usize, history: &History, axes: TimeAxis, limit: f64) -> Self {
        let time_scale = axes.scale(history.frequency_parameter_1_s);
        let alpha = history.slenderness_rad;
        let p_alpha = history.frequency_parameter_1_s * alpha;

        let overturned = history.ends_overturned();
        // From the end backwards, since a block may also swing far out and return before it overturns.
        let shown = if overturned {
            let within = |ratio: f64| ratio.abs() / alpha <= limit;
            let last_within = history.samples.iter().rposition(|sample| within(sample.rotation_rad));
            let count = last_within.map_or(0, |last| last + 2);
            &history.samples[..count.min(history.samples.len())]
        } else {
            &history.samples[..]
        };
        let curve = |value: &dyn Fn(&sprag_sim::history::Sample) -> f64| -> Vec<(f64, f64)> {
            shown.iter().map(|sample| (time_scale * sample.time_s, value(sample))).collect()
        };

        let rotation = curve(&|sample| sample.rotation_rad / alpha);
        let force = if history.has_inerter() { curve(&|sample| sample.transferred_force_ratio()) } else { Vec::new() };
        let end = rotation.last().map_or(f64::NEG_INFINITY, |point| point.0);
        Self {
            look: device_look(index),
            label: label(history, overturned),
            velocity: curve(&|sample| sample.velocity_rad_s / p_alpha),
            force,
            impacts: history.impacts_s.iter().map(|&time| time_scale * time).filter(|&time| time <= end).collect(),
            engagements: if history.is_clutched() {
                history
                    .engagements()
                    .into_iter()
                    .map(|(from, to, flywheel)| (time_scale * from, (time_scale * to).min(end), flywheel))
                    .filter(|(from, to, _)| to > from)
                    .collect()
            } else {
                Vec::new()
            },
            overturn: overturned.then(|| exit(&rotation, limit)).flatten(),
            rotation,
        }
    }
}

/// Rejects responses that would put a meaningless number into the figure.
pub(super) fn check(history: &History) -> Result<(), PlotError> {
    let device = || history.device.clone();
    let (alpha, p) = (history.slenderness_rad, history.frequency_parameter_1_s);
    let positive = |value: f64| value > 0.0 && value.is_finite();
    if !(positive(alpha) && positive(p) && positive(alpha * p)) {
        return Err(PlotError::InvalidBlock { device: device() });
    }
    for sample in &history.samples {
        let plotted = [
            sample.time_s * p,
            sample.ground_m_s2,
            sample.rotation_rad / alpha,
            sample.velocity_rad_s / (p * alpha),
            sample.transferred_force_ratio(),
        ];
        if !plotted.into_iter().all(drawable) {
            return Err(PlotError::NotFinite { device: device(), time_s: sample.time_s });
        }
    }
    check_order(&history.device, history.samples.iter().map(|sample| sample.time_s))?;
    match history.impacts_s.iter().find(|time| !time.is_finite()) {
        Some(&time_s) => Err(PlotError::NotFinite { device: device(), time_s }),
        None => Ok(()),
    }
}

fn label(history: &History, overturned: bool) -> String {
    let peak = if overturned { String::new() } else { format!(", peak {:.2}", history.peak_rotation_ratio()) };
    format!("{} ({}{peak})", history.device, history.outcome)
}

/// Where the last segment of `rotation` crosses ±`limit`, or its end when it stays below.
fn exit(rotation: &[(f64, f64)], limit: f64) -> Option<(f64, f64)> {
    let &last = rotation.last()?;
    if last.1.abs() <= limit {
        return Some(last);
    }
    let edge = if last.1 > 0.0 { limit } else { -limit };
    let before = rotation.len().checked_sub(2).map_or(last, |index| rotation[index]);
    let rise = last.1 - before.1;
    let part = if rise == 0.0 { 0.0 } else { ((edge - before.1) / rise).clamp(0.0, 1.0) };
    Some((before.0 + part * (last.0 - before.0), edge))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::synthetic;

    #[test]
    fn the_limit_follows_the_blocks_that_come_back() {
        let small = synthetic::safe("none", 0.3, 200);
        let large = synthetic::safe("none", 1.5, 200);
        let over = synthetic::overturning("none", 200);
        assert_eq!(rotation_limit(&[small.clone(), over.clone()]), 1.2);
        let limit = rotation_limit(&[large.clone(), over.clone()]);
        assert!((limit - 1.15 * large.peak_rotation_ratio()).abs() < 1e-12);
        assert_eq!(rotation_limit(&[synthetic::safe("none", 40.0, 200)]), 2.5);
    }

    #[test]
    fn an_overturning_trace_ends_just_outside_the_panel() {
        let trace = DeviceTrace::new(0, &synthetic::overturning("none", 400), TimeAxis::Seconds, 1.2);
        let (time, edge) = trace.overturn.unwrap();
        assert_eq!(edge.abs(), 1.2);
        let beyond = trace.rotation.iter().filter(|point| point.1.abs() > 1.2).count();
        assert_eq!(beyond, 1);
        assert!(time <= trace.rotation.last().unwrap().0);
        assert_eq!(trace.rotation.len(), trace.velocity.len());
    }

    #[test]
    fn meaningless_numbers_are_refused() {
        let mut history = synthetic::safe("none", 0.3, 50);
        assert_eq!(check(&history), Ok(()));
        history.samples[7].velocity_rad_s = f64::NAN;
        assert!(matches!(check(&history), Err(PlotError::NotFinite { .. })));
        history.samples[7].velocity_rad_s = 0.0;
        history.samples.swap(3, 30);
        assert!(matches!(check(&history), Err(PlotError::TimeGoesBack { .. })));
        history.slenderness_rad = 0.0;
        assert!(matches!(check(&history), Err(PlotError::InvalidBlock { .. })));
    }
}
