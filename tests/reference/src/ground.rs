//! The ground motion: shapes, scaled, shifted and summed, in pieces between which it may have a kink or a jump.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use crate::block::{Block, GRAVITY, Geometry};
use crate::pulse::Shape;
use crate::record;
use crate::scene::MotionTable;

/// A sum of shapes with their starts (s) and factors.
#[derive(Clone, Debug, Default)]
pub struct Ground {
    parts: Vec<(f64, f64, Shape)>,
}

impl Ground {
    /// Of the tables of one direction; records are read from `folder`.
    ///
    /// # Errors
    /// A missing or unknown value, or an unreadable record, in words.
    pub fn of(tables: &[MotionTable], bare: &Block, folder: &Path) -> Result<Ground, String> {
        let parts = tables.iter().map(|table| Ok((table.start_s, table.scale, shape(table, bare, folder)?)));
        Ok(Ground { parts: parts.collect::<Result<_, String>>()? })
    }

    /// When the last shape ends, s.
    pub fn end(&self) -> f64 {
        self.parts.iter().map(|(start, _, shape)| start + shape.duration()).fold(0.0, f64::max)
    }

    /// All instants at which a shape begins, ends or has a kink, s.
    pub fn kinks(&self) -> Vec<f64> {
        self.parts.iter().flat_map(|(start, _, shape)| shape.kinks().into_iter().map(move |time| start + time)).collect()
    }

    /// Acceleration (m/s²) at `time`, by the formula that holds at `within`: an instant inside the same piece.
    pub fn at(&self, time: f64, within: f64) -> f64 {
        let active = self.parts.iter().filter(|(start, _, shape)| (*start..start + shape.duration()).contains(&within));
        active.map(|(start, factor, shape)| factor * shape.at(time - start, within - start)).sum()
    }

    /// Fastest rate, 1/s.
    pub fn rate(&self) -> f64 {
        self.parts.iter().map(|(_, _, shape)| shape.rate()).fold(0.0, f64::max)
    }

    /// A bound of |acceleration|, m/s².
    pub fn bound(&self) -> f64 {
        self.parts.iter().map(|(_, factor, shape)| factor.abs() * shape.bound()).sum()
    }
}

fn shape(table: &MotionTable, bare: &Block, folder: &Path) -> Result<Shape, String> {
    let threshold = match bare.geometry {
        Geometry::Full => bare.slenderness.tan(),
        Geometry::Slender => bare.slenderness,
    };
    let p = bare.frequency_parameter();
    let amplitude = || match (table.amplitude_ratio, table.amplitude_g, table.amplitude_m_s2) {
        (Some(ratio), None, None) => Ok(ratio * threshold * GRAVITY),
        (None, Some(in_g), None) => Ok(in_g * GRAVITY),
        (None, None, Some(value)) => Ok(value),
        _ => Err("one amplitude".to_owned()),
    };
    let frequency = || match (table.frequency_ratio, table.frequency_hz) {
        (Some(ratio), None) => Ok(ratio * p),
        (None, Some(hertz)) => Ok(TAU * hertz),
        _ => Err("one frequency".to_owned()),
    };
    Ok(match table.motion.as_str() {
        "sine" => {
            let frequency = frequency()?;
            Shape::Sine { amplitude: amplitude()?, frequency, duration: TAU / frequency }
        }
        "half-sine" => {
            let frequency = frequency()?;
            Shape::Sine { amplitude: amplitude()?, frequency, duration: PI / frequency }
        }
        "cosine" => Shape::Cosine { amplitude: amplitude()?, frequency: frequency()? },
        "ricker" => Shape::Ricker { amplitude: amplitude()?, frequency: frequency()? },
        "rectangular" => {
            let ratio = || table.duration_ratio.map(|ratio| ratio / p);
            Shape::Rectangle { amplitude: amplitude()?, duration: table.duration_s.or_else(ratio).ok_or("a duration")? }
        }
        "mavroeidis-papageorgiou" => Shape::Wavelet {
            velocity: table.velocity_amplitude_m_s.ok_or("velocity_amplitude_m_s")?,
            frequency: frequency()?,
            oscillations: table.oscillations.ok_or("oscillations")?,
            phase: table.phase_deg.to_radians(),
        },
        "record" => {
            let (step, samples) = record::read(&folder.join(table.file.as_ref().ok_or("file")?), table)?;
            Shape::Record { step, samples: samples.into() }
        }
        other => return Err(format!("motion {other}")),
    })
}
