//! Shapes of ground motions, each from its own beginning.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// An acceleration over a time of its own, m/s²; zero outside.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A sin ωt over `duration`: one cycle, or half of one.
    Sine {
        /// A, m/s².
        amplitude: f64,
        /// ω, rad/s.
        frequency: f64,
        /// s.
        duration: f64,
    },
    /// A cos ωt over one cycle.
    Cosine {
        /// A, m/s².
        amplitude: f64,
        /// ω, rad/s.
        frequency: f64,
    },
    /// A constant.
    Rectangle {
        /// A, m/s².
        amplitude: f64,
        /// s.
        duration: f64,
    },
    /// A (1 − 2x²) e^(−x²) with x = ω/2 (t − t₀), from x = −6 to 6.
    Ricker {
        /// A, m/s².
        amplitude: f64,
        /// ω, rad/s.
        frequency: f64,
    },
    /// Derivative of V/2 [1 + cos(ωτ/γ)] cos(ωτ + ν) over |τ| ≤ γπ/ω (Mavroeidis and Papageorgiou 2003).
    Wavelet {
        /// V, m/s.
        velocity: f64,
        /// ω, rad/s.
        frequency: f64,
        /// γ.
        oscillations: f64,
        /// ν, rad.
        phase: f64,
    },
    /// Straight lines between samples.
    Record {
        /// s.
        step: f64,
        /// m/s².
        samples: Arc<[f64]>,
    },
}

/// x at which a Ricker wavelet is cut.
const RICKER_REACH: f64 = 6.0;

impl Shape {
    /// How long it lasts, s.
    pub fn duration(&self) -> f64 {
        match self {
            Shape::Sine { duration, .. } | Shape::Rectangle { duration, .. } => *duration,
            Shape::Cosine { frequency, .. } => TAU / frequency,
            Shape::Ricker { frequency, .. } => 4.0 * RICKER_REACH / frequency,
            Shape::Wavelet { frequency, oscillations, .. } => TAU * oscillations / frequency,
            Shape::Record { step, samples } => step * (samples.len() - 1) as f64,
        }
    }

    /// Acceleration at a time `t` after the beginning; between samples near `within`, which decides the straight line.
    pub fn at(&self, t: f64, within: f64) -> f64 {
        match self {
            Shape::Sine { amplitude, frequency, .. } => amplitude * (frequency * t).sin(),
            Shape::Cosine { amplitude, frequency } => amplitude * (frequency * t).cos(),
            Shape::Rectangle { amplitude, .. } => *amplitude,
            Shape::Ricker { amplitude, frequency } => {
                let x = frequency / 2.0 * t - RICKER_REACH;
                amplitude * (1.0 - 2.0 * x * x) * (-x * x).exp()
            }
            Shape::Wavelet { velocity, frequency, oscillations, phase } => {
                let tau = t - PI * oscillations / frequency;
                let slow = frequency / oscillations;
                let fast = frequency * tau + phase;
                let (slow_sin, slow_cos) = (slow * tau).sin_cos();
                -velocity / 2.0 * (slow * slow_sin * fast.cos() + (1.0 + slow_cos) * frequency * fast.sin())
            }
            Shape::Record { step, samples } => {
                let line = ((within / step).floor().max(0.0) as usize).min(samples.len() - 2);
                let (a, b) = (samples[line], samples[line + 1]);
                a + (b - a) * (t / step - line as f64)
            }
        }
    }

    /// Times after the beginning at which a straight line ends, s.
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Shape::Record { step, samples } => (0..samples.len()).map(|i| i as f64 * step).collect(),
            _ => vec![0.0, self.duration()],
        }
    }

    /// Its fastest rate, 1/s, which a step must resolve. Straight lines have none.
    pub fn rate(&self) -> f64 {
        match self {
            Shape::Sine { frequency, .. } | Shape::Cosine { frequency, .. } => *frequency,
            Shape::Ricker { frequency, .. } => 1.5 * frequency,
            Shape::Wavelet { frequency, oscillations, .. } => frequency * (1.0 + 1.0 / oscillations),
            Shape::Rectangle { .. } | Shape::Record { .. } => 0.0,
        }
    }

    /// A bound of |acceleration|, m/s².
    pub fn bound(&self) -> f64 {
        match self {
            Shape::Sine { amplitude, .. } | Shape::Cosine { amplitude, .. } => amplitude.abs(),
            Shape::Rectangle { amplitude, .. } | Shape::Ricker { amplitude, .. } => amplitude.abs(),
            Shape::Wavelet { velocity, frequency, .. } => 2.0 * velocity.abs() * frequency,
            Shape::Record { samples, .. } => samples.iter().fold(0.0, |most, sample| sample.abs().max(most)),
        }
    }
}
