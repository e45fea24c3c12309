//! Ground motions of a study: pulses of several families, and recorded ones.

use std::f64::consts::TAU;
use std::path::PathBuf;

use sprag_shared::ground::AnySegment;
use sprag_shared::ground::harmonic::MavroeidisPapageorgiou;
use sprag_shared::math;
use sprag_shared::structure::block::{Block, GRAVITY};
use sprag_sim::ground_motion::{Component, GroundMotion};

use super::bench::{StudyError, records_of};
use crate::cloud::study_file::RecordTable;

/// A ground motion of a study.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// A pulse of one shape.
    Pulse {
        /// As scenes name it: "sine", "cosine", "half-sine" or "ricker".
        shape: &'static str,
        /// ω_g/p.
        frequency: f64,
        /// a_g/(g tan α).
        amplitude: f64,
    },
    /// A Mavroeidis-Papageorgiou pulse.
    Wavelet {
        /// γ and ν (degrees).
        kind: (f64, f64),
        /// ω_g/p.
        frequency: f64,
        /// Largest acceleration over g tan α.
        amplitude: f64,
    },
    /// A recorded one.
    Record {
        /// File, from where the user stands.
        file: PathBuf,
        /// What the file does not say.
        reading: RecordTable,
        /// Factor on its accelerations.
        scale: f64,
    },
}

impl Motion {
    /// The same with accelerations `factor` times as large.
    #[must_use]
    pub fn times(&self, factor: f64) -> Motion {
        let mut motion = self.clone();
        match &mut motion {
            Motion::Pulse { amplitude: size, .. }
            | Motion::Wavelet { amplitude: size, .. }
            | Motion::Record { scale: size, .. } => {
                *size *= factor;
            }
        }
        motion
    }

    /// `[[ground]]` and `[run]` of a scene with this `block`.
    pub fn tables(&self, block: &Block) -> String {
        let after_pulse = "[run]\nfree_time_ratio = 10.0\n";
        match self {
            Motion::Pulse { shape, frequency, amplitude } => format!(
                "[[ground]]\nmotion = \"{shape}\"\nfrequency_ratio = {frequency:?}\namplitude_ratio = {amplitude:?}\n{after_pulse}"
            ),
            Motion::Wavelet { kind: (oscillations, phase), frequency, amplitude } => {
                let threshold = math::tan(block.slenderness());
                let unit = peak((*oscillations, *phase), frequency * block.frequency_parameter() / TAU);
                format!(
                    "[[ground]]\nmotion = \"mavroeidis-papageorgiou\"\nfrequency_ratio = {frequency:?}\noscillations = {oscillations:?}\n\
                     phase_deg = {phase:?}\nvelocity_amplitude_m_s = 1.0\nscale = {:?}\n{after_pulse}",
                    amplitude * threshold / unit
                )
            }
            Motion::Record { file, reading, scale } => {
                let file = toml::Value::String(file.display().to_string().replace('\\', "/"));
                let reading = toml::to_string(reading).unwrap_or_default();
                format!("[[ground]]\nmotion = \"record\"\nfile = {file}\nscale = {scale:?}\n{reading}[run]\nfree_time_s = 5.0\n")
            }
        }
    }
}

/// Largest acceleration, g, of a Mavroeidis-Papageorgiou pulse of γ and ν (degrees) with A = 1 m/s and `frequency` (Hz).
fn peak((oscillations, phase): (f64, f64), frequency: f64) -> f64 {
    let wavelet = MavroeidisPapageorgiou { velocity_amplitude: 1.0, frequency, oscillations, phase: phase.to_radians() };
    let pulse = Component::pulse(0.0, wavelet.duration(), AnySegment::ThreeSines(wavelet.harmonics()));
    GroundMotion::sum(&[pulse]).peak_m_s2() / GRAVITY
}

/// A family of pulses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Family {
    /// One of [`Motion::Pulse`].
    Shape(&'static str),
    /// γ and ν (degrees) of a Mavroeidis-Papageorgiou pulse.
    Wavelet(f64, f64),
}

impl Family {
    /// All families of the studies.
    pub const ALL: [Family; 7] = [
        Family::Shape("sine"),
        Family::Shape("cosine"),
        Family::Shape("half-sine"),
        Family::Shape("ricker"),
        Family::Wavelet(1.3, 0.0),
        Family::Wavelet(1.8, 90.0),
        Family::Wavelet(3.0, 0.0),
    ];

    /// For headings.
    pub fn name(self) -> String {
        match self {
            Family::Shape(shape) => shape.to_owned(),
            Family::Wavelet(oscillations, phase) => format!("M-P γ {oscillations} ν {phase}°"),
        }
    }

    /// The pulse of this ω_g/p and this peak over g tan α.
    pub fn at(self, frequency: f64, amplitude: f64) -> Motion {
        match self {
            Family::Shape(shape) => Motion::Pulse { shape, frequency, amplitude },
            Family::Wavelet(oscillations, phase) => Motion::Wavelet { kind: (oscillations, phase), frequency, amplitude },
        }
    }

    /// A grid of `count` x `count` of them, row by row, first and last of each range included.
    pub fn grid(self, count: usize, frequencies: (f64, f64), amplitudes: (f64, f64)) -> Vec<Motion> {
        let part = |index: usize| index as f64 / (count.max(2) - 1) as f64;
        (0..count * count)
            .map(|index| self.at(between(frequencies, part(index % count)), between(amplitudes, part(index / count))))
            .collect()
    }

    /// `count` of them spread evenly without a grid: points n of the additive recurrence (n/g, n/g²) mod 1, where g³ = g + 1 (Roberts
    /// 2018), any part of which is spread evenly as well.
    pub fn spread(self, count: usize, frequencies: (f64, f64), amplitudes: (f64, f64)) -> Vec<Motion> {
        const G: f64 = 1.324_717_957_244_746;
        let part = |index: usize, step: f64| (0.5 + (index + 1) as f64 * step).fract();
        (0..count)
            .map(|index| self.at(between(frequencies, part(index, 1.0 / G)), between(amplitudes, part(index, 1.0 / (G * G)))))
            .collect()
    }
}

pub(super) fn between((from, to): (f64, f64), part: f64) -> f64 {
    from + (to - from) * part
}

/// A grid of pulses of one shape: ω/p from `frequencies` and amplitudes from `amplitudes`, first and last included.
pub fn grid(shape: &'static str, count: usize, frequencies: (f64, f64), amplitudes: (f64, f64)) -> Vec<Motion> {
    Family::Shape(shape).grid(count, frequencies, amplitudes)
}

/// Recorded motions and their peaks.
#[derive(Clone, Debug)]
pub struct Records<'a> {
    motions: &'a [Motion],
    /// m/s².
    peaks: Vec<f64>,
}

impl<'a> Records<'a> {
    /// Records of a study, read from their files.
    ///
    /// # Errors
    /// [`StudyError`] names the first file that cannot be read or in which the ground does not move.
    pub fn new(motions: &'a [Motion]) -> Result<Records<'a>, StudyError> {
        let peaks: Vec<f64> = records_of(motions)?.iter().map(|record| record.pga_m_s2).collect();
        match motions.iter().zip(&peaks).find(|(_, peak)| **peak <= 0.0) {
            Some((Motion::Record { file, .. }, _)) => Err(StudyError::Still { file: file.clone() }),
            _ => Ok(Records { motions, peaks }),
        }
    }

    /// How many.
    pub fn count(&self) -> usize {
        self.motions.len()
    }

    /// Record `index`, its peak acceleration `threshold` times the g tan α of a block of `slenderness` (rad).
    fn scaled(&self, index: usize, threshold: f64, slenderness: f64) -> Motion {
        let factor = threshold * GRAVITY * math::tan(slenderness) / self.peaks[index];
        match &self.motions[index] {
            Motion::Record { file, reading, .. } => {
                Motion::Record { file: file.clone(), reading: reading.clone(), scale: factor }
            }
            other => other.clone(),
        }
    }

    /// Every record at every one of `thresholds`.
    pub fn at_each(&self, thresholds: &[f64], slenderness: f64) -> Vec<Motion> {
        let at = |&threshold: &f64| (0..self.count()).map(move |index| self.scaled(index, threshold, slenderness));
        thresholds.iter().flat_map(at).collect()
    }

    /// Every record at one of `thresholds`, which take turns.
    pub fn at_turns(&self, thresholds: &[f64], slenderness: f64) -> Vec<Motion> {
        (0..self.count()).map(|index| self.scaled(index, thresholds[index % thresholds.len()], slenderness)).collect()
    }
}

/// What a page that names its pulses says of `count` recorded motions besides, and of how they are taken.
pub fn and_records(count: usize, how: &str) -> String {
    if count == 0 { String::new() } else { format!(" and {count} recorded motions{how}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loop_study::bench::{Conditions, Variant, with_loop};
    use sprag_sim::interrupt::Interrupt;
    use std::io::Write as _;

    /// Whatever the family, the largest ground acceleration is the one that was asked for.
    #[test]
    fn pulses_have_the_peak_that_they_are_named_by() {
        let interrupt = Interrupt::default();
        for family in Family::ALL {
            let variant = Variant::new("peak", &["block.slenderness_deg=15.0"]);
            let largest = with_loop(&family.at(2.5, 3.0), &variant, &Conditions::new(None, &interrupt), |task| {
                Ok(task.ground.horizontal.peak_m_s2())
            });
            let ratio = largest.unwrap() / (GRAVITY * math::tan(15_f64.to_radians()));
            assert!((ratio - 3.0).abs() < 1e-4, "{}: {ratio}", family.name());
        }
    }

    #[test]
    fn a_record_without_motion_is_named() {
        let mut file = tempfile::NamedTempFile::with_suffix(".csv").unwrap();
        write!(file, "time_s,acc_m_s2\n0,0\n0.01,0\n0.02,0\n").unwrap();
        let motions = [Motion::Record { file: file.path().to_owned(), reading: RecordTable::default(), scale: 1.0 }];
        let error = Records::new(&motions).unwrap_err();
        assert_eq!(error.to_string(), format!("{}: the ground does not move: no factor gives it a peak", file.path().display()));
    }

    #[test]
    fn spread_points_fill_their_ranges_evenly() {
        let inside = |motion: &&Motion| matches!(motion, Motion::Pulse { frequency, amplitude, .. } if *frequency < 2.0 && *amplitude < 5.5);
        for count in [64, 128, 512] {
            let motions = Family::Shape("sine").spread(count, (1.0, 5.0), (1.0, 10.0));
            let share = motions.iter().filter(inside).count() as f64 / count as f64;
            assert!((share - 0.125).abs() < 0.03, "{count}: {share}");
        }
    }
}
