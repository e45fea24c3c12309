//! A one-cycle pulse of a scene in the units that it was written in.

use std::f64::consts::TAU;

use sprag_shared::structure::block::{Block, GRAVITY, Geometry};

use crate::scene::ground::GroundTable;

/// Frequency and amplitude of a pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pulse {
    pub frequency: Frequency,
    pub amplitude: Amplitude,
    /// Factor on the amplitude.
    scale: f64,
}

/// Frequency of a pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Frequency {
    /// ω_g/p.
    Ratio(f64),
    /// Hz.
    Hertz(f64),
}

/// Amplitude of a pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Amplitude {
    /// Over the uplift threshold.
    Ratio(f64),
    /// g.
    G(f64),
    /// m/s².
    MetresPerSquareSecond(f64),
}

impl Pulse {
    /// Of a motion, if that has both.
    pub fn of(ground: &GroundTable) -> Option<Pulse> {
        let frequency = ground.frequency_ratio.map(Frequency::Ratio).or(ground.frequency_hz.map(Frequency::Hertz))?;
        let amplitude = match (ground.amplitude_ratio, ground.amplitude_g, ground.amplitude_m_s2) {
            (Some(ratio), ..) => Amplitude::Ratio(ratio),
            (_, Some(g), _) => Amplitude::G(g),
            (.., m_s2) => Amplitude::MetresPerSquareSecond(m_s2?),
        };
        Some(Pulse { frequency, amplitude, scale: ground.scale })
    }

    /// ω_g/p and a_g over the uplift threshold of a block.
    pub fn ratios(&self, block: &Block, geometry: Geometry) -> (f64, f64) {
        let frequency = match self.frequency {
            Frequency::Ratio(ratio) => ratio,
            Frequency::Hertz(hertz) => hertz * TAU / block.frequency_parameter(),
        };
        let threshold = || geometry.uplift_threshold(block.slenderness());
        let amplitude = match self.amplitude {
            Amplitude::Ratio(ratio) => ratio,
            Amplitude::G(g) => g / threshold(),
            Amplitude::MetresPerSquareSecond(m_s2) => m_s2 / GRAVITY / threshold(),
        };
        (frequency, self.scale * amplitude)
    }
}

impl Frequency {
    /// The key of the motion that sets it.
    pub fn key(self) -> &'static str {
        match self {
            Frequency::Ratio(_) => "frequency_ratio",
            Frequency::Hertz(_) => "frequency_hz",
        }
    }

    /// Sets it, in its own unit.
    pub fn set(&mut self, value: f64) {
        match self {
            Frequency::Ratio(own) | Frequency::Hertz(own) => *own = value,
        }
    }
}

impl Amplitude {
    /// The key of the motion that sets it.
    pub fn key(self) -> &'static str {
        match self {
            Amplitude::Ratio(_) => "amplitude_ratio",
            Amplitude::G(_) => "amplitude_g",
            Amplitude::MetresPerSquareSecond(_) => "amplitude_m_s2",
        }
    }

    /// Sets it, in its own unit.
    pub fn set(&mut self, value: f64) {
        match self {
            Amplitude::Ratio(own) | Amplitude::G(own) | Amplitude::MetresPerSquareSecond(own) => *own = value,
        }
    }
}
