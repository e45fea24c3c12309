//! What looks wrong, or was decided by the reader, without stopping the reading.

use std::fmt;

use super::units::Units;

/// Something that a person should look at before a record is used. See [`super::checks`] for the thresholds.
#[derive(Clone, Debug, PartialEq)]
pub enum Warning {
    /// The header's number of samples is not the number of samples present.
    SamplesDisagree {
        /// Number in the header.
        stated: u64,
        /// Number of samples read.
        present: usize,
    },
    /// The header's number of samples cannot be read, so that the samples present are not compared with it.
    SamplesUnreadable {
        /// What stands in the place of the number, shortened.
        text: String,
    },
    /// The header's peak is neither the largest value nor the largest magnitude.
    PeakDisagrees {
        /// Peak in the header (m/s²).
        stated_m_s2: f64,
        /// Largest magnitude read (m/s²).
        found_m_s2: f64,
    },
    /// The record does not start near zero: the block is hit by a step.
    NonZeroStart {
        /// First sample (m/s²).
        first_m_s2: f64,
        /// Its magnitude as a fraction of the peak.
        fraction: f64,
    },
    /// Single samples that stand out from both neighbours.
    Spike {
        /// Number of such samples.
        count: usize,
        /// Time of the largest (s).
        time_s: f64,
        /// Value of the largest (m/s²).
        value_m_s2: f64,
    },
    /// Jumps between two neighbouring samples that do not come back.
    Step {
        /// Number of such samples.
        count: usize,
        /// Time of the largest (s).
        time_s: f64,
        /// Height of the largest (m/s²).
        height_m_s2: f64,
    },
    /// Several samples in a row at the same extreme value.
    Clipped {
        /// Length of the longest such run.
        samples: usize,
        /// Time of its first sample (s).
        time_s: f64,
        /// The value (m/s²).
        value_m_s2: f64,
    },
    /// The velocity from rest does not return to near zero: the baseline was not corrected.
    VelocityDrift {
        /// Velocity at the end, integrated from rest (m/s).
        final_m_s: f64,
        /// That velocity as a fraction of PGV.
        fraction: f64,
    },
    /// The time step was rounded in print so that the duration is uncertain.
    TimeStepRounded {
        /// The step as printed (s).
        printed_s: f64,
        /// Largest relative error of the rounding.
        relative: f64,
    },
    /// A long stretch before the shaking begins.
    QuietHead {
        /// Time until the shaking begins (s).
        seconds: f64,
    },
    /// A peak so large that the units are probably wrong.
    LargePeak {
        /// PGA in g.
        pga_g: f64,
    },
    /// A peak so small that the units are probably wrong.
    SmallPeak {
        /// PGA in g.
        pga_g: f64,
    },
    /// The file has several components and the reader took the one with the larger peak.
    ComponentTaken {
        /// The one taken.
        taken: String,
        /// All there are.
        available: String,
    },
    /// A component was asked for, but the file has only one.
    ComponentNotUsed {
        /// The one asked for.
        asked: String,
    },
    /// Units were given, but the file states others, which were used.
    UnitsNotUsed {
        /// Units given.
        given: Units,
        /// Units of the file.
        stated: Units,
    },
    /// A time step was given, but the file states another, which was used.
    TimeStepNotUsed {
        /// Step given (s).
        given_s: f64,
        /// Step of the file (s); none if it has a time column with unequal ones.
        stated_s: Option<f64>,
    },
    /// The first column of the file counts its rows and was left out.
    RowNumbers,
    /// The commas of the file were read as decimal marks.
    DecimalCommas,
    /// A motion that is taken as horizontal, though its name or the file says that it is vertical.
    VerticalComponent {
        /// What says so.
        sign: String,
    },
    /// The samples were interpolated linearly to another step; nothing was filtered.
    Resampled {
        /// Mean step before (s).
        from_s: f64,
        /// Step after (s).
        to_s: f64,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::SamplesDisagree { stated, present } => write!(f, "the header says {stated} samples, {present} are present"),
            Warning::SamplesUnreadable { text } => {
                write!(f, "the header's number of samples cannot be read (NPTS `{text}`), and is not compared with those present")
            }
            Warning::PeakDisagrees { stated_m_s2, found_m_s2 } => {
                write!(f, "the header says a peak of {stated_m_s2:.4} m/s2, the samples have {found_m_s2:.4} m/s2")
            }
            Warning::NonZeroStart { first_m_s2, fraction } => {
                write!(f, "starts at {first_m_s2:.4} m/s2, {:.1} % of the peak", 100.0 * fraction)
            }
            Warning::Spike { count, time_s, value_m_s2 } => {
                write!(f, "{count} spike(s) of a single sample, the largest {value_m_s2:.3} m/s2 at {time_s:.3} s")
            }
            Warning::Step { count, time_s, height_m_s2 } => {
                write!(f, "{count} step(s) between neighbouring samples, the largest {height_m_s2:.3} m/s2 at {time_s:.3} s")
            }
            Warning::Clipped { samples, time_s, value_m_s2 } => {
                write!(f, "clipped: {samples} samples in a row at the extreme {value_m_s2:.4} m/s2 from {time_s:.3} s")
            }
            Warning::VelocityDrift { final_m_s, fraction } => write!(
                f,
                "velocity from rest ends at {final_m_s:.4} m/s, {fraction:.2} times PGV about a straight baseline: the baseline seems \
                 uncorrected"
            ),
            Warning::TimeStepRounded { printed_s, relative } => write!(
                f,
                "time step printed as {printed_s} s, rounded by up to {:.1} %: give the true one with --dt",
                100.0 * relative
            ),
            Warning::QuietHead { seconds } => write!(f, "quiet for the first {seconds:.1} s"),
            Warning::LargePeak { pga_g } => write!(f, "peak of {pga_g:.3} g is larger than almost any recorded: check the units"),
            Warning::SmallPeak { pga_g } => write!(f, "peak of {pga_g:.2e} g is too weak to matter: check the units"),
            Warning::ComponentTaken { taken, available } => {
                write!(f, "component {taken} taken for its larger peak (the file has {available}; choose with --component)")
            }
            Warning::ComponentNotUsed { asked } => write!(f, "component {asked} not used: the file has one component"),
            Warning::UnitsNotUsed { given, stated } => write!(f, "units {given} not used: the file says {stated}"),
            Warning::TimeStepNotUsed { given_s, stated_s: Some(stated_s) } => {
                write!(f, "time step {given_s} s not used: the file says {stated_s} s")
            }
            Warning::TimeStepNotUsed { given_s, stated_s: None } => {
                write!(f, "time step {given_s} s not used: the file has a time column")
            }
            Warning::RowNumbers => write!(
                f,
                "its first column counts the rows (0, 1, 2… or 1, 2, 3…) and is left out: it is not taken for time in s"
            ),
            Warning::DecimalCommas => write!(f, "its commas are read as decimal marks"),
            Warning::VerticalComponent { sign } => {
                write!(f, "seems to be a vertical component ({sign}), and is taken as a horizontal motion")
            }
            Warning::Resampled { from_s, to_s } => {
                write!(f, "resampled linearly from a mean step of {from_s} s to {to_s} s, without a filter")
            }
        }
    }
}
