//! Responses over one dimensionless time, and how far they depart from one another.

use serde::Serialize;
use sprag_sim::history::{History, Sample};

/// Instants at which responses are compared.
pub const INSTANTS: usize = 2001;

/// θ/α over p t, at equal steps from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// p × step.
    pub step: f64,
    /// θ/α; shorter where the block overturns.
    pub rotations: Vec<f64>,
}

impl Response {
    /// Of a history, at steps of `step` (in 1/p): between two samples by the cubic with their rotations and velocities.
    pub fn of(history: &History, step: f64) -> Response {
        let (p, alpha) = (history.frequency_parameter_1_s, history.slenderness_rad);
        let samples = &history.samples;
        let last = samples.last().map_or(0.0, |sample| sample.time_s);
        let mut rotations = Vec::with_capacity(INSTANTS);
        let mut at = 0;
        for instant in 0..INSTANTS {
            let time = instant as f64 * step / p;
            // The last instant may lie beyond the last sample by rounding.
            if time > last * (1.0 + 1e-12) {
                break;
            }
            while samples.get(at + 1).is_some_and(|next| next.time_s < time) {
                at += 1;
            }
            let rotation = match (samples.get(at), samples.get(at + 1)) {
                (Some(left), Some(right)) => between(left, right, time),
                (Some(only), None) => only.rotation_rad,
                _ => break,
            };
            rotations.push(rotation / alpha);
        }
        Response { step, rotations }
    }
}

/// The cubic between two samples.
fn between(left: &Sample, right: &Sample, time: f64) -> f64 {
    let width = right.time_s - left.time_s;
    if width <= 0.0 {
        return right.rotation_rad;
    }
    let u = ((time - left.time_s) / width).clamp(0.0, 1.0);
    let (v, rise) = (1.0 - u, right.rotation_rad - left.rotation_rad);
    let (first, second) = (left.velocity_rad_s * width - rise, rise - right.velocity_rad_s * width);
    v * left.rotation_rad + u * right.rotation_rad + u * v * (v * first + u * second)
}

/// How far two responses depart from one another.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Departure {
    /// Largest |θ₁/α₁ − θ₂/α₂| while both stand.
    pub largest: f64,
    /// p t at which it is.
    pub at_frequency_parameter_time: f64,
    /// It over the largest |θ₁/α₁|; none where that does not move.
    pub relative: Option<f64>,
}

impl Departure {
    /// Of `other` from `first`; compared as long as both last.
    pub fn between(first: &Response, other: &Response) -> Departure {
        let mut departure = Departure { largest: 0.0, at_frequency_parameter_time: 0.0, relative: None };
        let mut peak = 0.0_f64;
        for (index, (a, b)) in first.rotations.iter().zip(&other.rotations).enumerate() {
            peak = peak.max(a.abs());
            if (a - b).abs() > departure.largest {
                departure.largest = (a - b).abs();
                departure.at_frequency_parameter_time = index as f64 * first.step;
            }
        }
        departure.relative = (peak > 0.0).then(|| departure.largest / peak);
        departure
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(time_s: f64, rotation_rad: f64, velocity_rad_s: f64) -> Sample {
        Sample {
            time_s,
            rotation_rad,
            velocity_rad_s,
            ground_m_s2: 0.0,
            acceleration_rad_s2: 0.0,
            force_ratio: [0.0; 2],
            engaged: 0,
            displacement_m: 0.0,
        }
    }

    /// θ = α t³ over samples of its own times: a cubic is met exactly, at any step.
    #[test]
    fn a_cubic_is_met_between_samples() {
        let (alpha, p) = (0.2, 3.0);
        let samples = [0.0, 0.4, 0.5, 0.5, 1.1, 2.0].map(|t: f64| sample(t, alpha * t * t * t, 3.0 * alpha * t * t)).to_vec();
        let history = History { slenderness_rad: alpha, frequency_parameter_1_s: p, samples, ..History::default() };
        let response = Response::of(&history, 0.01);
        assert_eq!(response.rotations.len(), 601);
        for (index, rotation) in response.rotations.iter().enumerate() {
            let time = index as f64 * 0.01 / p;
            assert!((rotation - time * time * time).abs() < 1e-14, "{time}: {rotation}");
        }
    }

    #[test]
    fn the_largest_departure_and_its_time() {
        let first = Response { step: 0.5, rotations: vec![0.0, 0.4, -0.8, 0.2] };
        let other = Response { step: 0.5, rotations: vec![0.0, 0.5, -0.6] };
        let departure = Departure::between(&first, &other);
        assert!((departure.largest - 0.2).abs() < 1e-15);
        assert_eq!(departure.at_frequency_parameter_time, 1.0);
        assert!((departure.relative.unwrap() - 0.25).abs() < 1e-15);
        let still = Response { step: 0.5, rotations: vec![0.0; 4] };
        assert_eq!(Departure::between(&still, &still).relative, None);
    }
}
