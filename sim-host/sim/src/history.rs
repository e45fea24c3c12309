//! The response of one device over time, and its long-form CSV table.

use std::io;

/// One instant of a response, in SI units.
///
/// At a discontinuity (an impact, a clutch switch) two samples share the same time: the left limit, then the right
/// limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time since the start of the record (s); never decreases from one sample to the next.
    pub time_s: f64,
    /// Horizontal ground acceleration (m/s²).
    pub ground_m_s2: f64,
    /// Rotation θ of the block (rad), positive and negative for the two pivots.
    pub rotation_rad: f64,
    /// Angular velocity (rad/s).
    pub velocity_rad_s: f64,
    /// Angular acceleration (rad/s²).
    pub acceleration_rad_s2: f64,
    /// Inerter force over block weight, by flywheel: first, second (dimensionless).
    pub force_ratio: [f64; 2],
    /// The flywheels that are engaged, as [`clutches`](sprag_shared::observers::counted_swing::clutches) counts.
    pub engaged: u8,
    /// Displacement of the base over the ground (m); 0 where it cannot slide.
    pub displacement_m: f64,
}

impl Sample {
    /// Sum of the forces of both flywheels over the block weight (dimensionless).
    pub fn transferred_force_ratio(&self) -> f64 {
        self.force_ratio[0] + self.force_ratio[1]
    }
}

/// The response of a block with one device to one ground motion.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    /// Name of the device, as the figure's legend shows it.
    pub device: String,
    /// How the run ended, in words (for example `safe` or `overturned at 3.2 s`).
    pub outcome: String,
    /// Slenderness α of the block (rad); positive.
    pub slenderness_rad: f64,
    /// Frequency parameter p of the block (1/s); positive.
    pub frequency_parameter_1_s: f64,
    /// The samples in time order.
    pub samples: Vec<Sample>,
    /// Times of the impacts (s).
    pub impacts_s: Vec<f64>,
    /// The base of the block may slide.
    pub slides: bool,
}

impl History {
    /// Intervals in which a flywheel was engaged: start (s), end (s), which ([`Sample::engaged`]), in time order.
    ///
    /// A state holds from its sample up to the next one, so an interval ends where the next state begins. Intervals of
    /// zero length are left out.
    pub fn engagements(&self) -> Vec<(f64, f64, u8)> {
        let mut states = self.samples.chunk_by(|one, next| one.engaged == next.engaged).peekable();
        let mut intervals = Vec::new();
        while let Some(state) = states.next() {
            let next = states.peek().and_then(|next| next.first());
            if let (Some(first), Some(end)) = (state.first(), next.or(state.last()))
                && first.engaged != 0
                && end.time_s > first.time_s
            {
                intervals.push((first.time_s, end.time_s, first.engaged));
            }
        }
        intervals
    }

    /// Whether the engaged flywheels change during the response, which only a clutch can cause.
    ///
    /// An inerter without a clutch reports one constant state.
    pub fn is_clutched(&self) -> bool {
        self.samples.windows(2).any(|pair| pair[0].engaged != pair[1].engaged)
    }

    /// Whether any sample has an engaged flywheel or a force from one.
    pub fn has_inerter(&self) -> bool {
        self.samples.iter().any(|sample| sample.engaged != 0 || sample.force_ratio.iter().any(|&force| force != 0.0))
    }

    /// Largest |θ|/α (dimensionless); zero without samples.
    pub fn peak_rotation_ratio(&self) -> f64 {
        self.peak(|sample| sample.rotation_rad) / self.slenderness_rad
    }

    /// Largest |transferred force| over block weight (dimensionless); zero without samples.
    pub fn peak_force_ratio(&self) -> f64 {
        self.peak(Sample::transferred_force_ratio)
    }

    /// Whether the last sample lies at or beyond the slenderness angle: the block did not come back.
    pub fn ends_overturned(&self) -> bool {
        self.samples.last().is_some_and(|sample| sample.rotation_rad.abs() >= self.slenderness_rad)
    }

    fn peak(&self, value: impl Fn(&Sample) -> f64) -> f64 {
        self.samples.iter().map(|sample| value(sample).abs()).fold(0.0, f64::max)
    }
}

/// Why a table of histories could not be written.
#[derive(Debug, thiserror::Error)]
pub enum HistoryError {
    /// The CSV writer or the stream below it failed.
    #[error("cannot write the history table: {0}")]
    Write(#[from] csv::Error),
    /// The stream failed when the last bytes were pushed out.
    #[error("cannot finish the history table: {0}")]
    Flush(#[from] io::Error),
}

/// Columns of the table that [`write_csv`] writes, in order.
pub const COLUMNS: [&str; 9] = [
    "device",
    "time_s",
    "ground_m_s2",
    "rotation_rad",
    "velocity_rad_s",
    "acceleration_rad_s2",
    "force_ratio_first",
    "force_ratio_second",
    "engaged",
];

/// The column after [`COLUMNS`] where a base may slide.
pub const DISPLACEMENT: &str = "displacement_m";

/// Writes all samples of `histories` as one long-form CSV table with the columns [`COLUMNS`], and [`DISPLACEMENT`] where one may slide.
///
/// Numbers are the shortest text that reads back as the same `f64`.
///
/// # Errors
///
/// [`HistoryError`] when `out` does not take the bytes.
pub fn write_csv(histories: &[History], out: &mut impl io::Write) -> Result<(), HistoryError> {
    let mut table = csv::Writer::from_writer(out);
    let slides = histories.iter().any(|history| history.slides);
    table.write_record(COLUMNS.into_iter().chain(slides.then_some(DISPLACEMENT)))?;
    for history in histories {
        for sample in &history.samples {
            table.write_field(&history.device)?;
            for number in [
                sample.time_s,
                sample.ground_m_s2,
                sample.rotation_rad,
                sample.velocity_rad_s,
                sample.acceleration_rad_s2,
                sample.force_ratio[0],
                sample.force_ratio[1],
            ] {
                table.write_field(format!("{number:?}"))?;
            }
            table.write_field(sample.engaged.to_string())?;
            if slides {
                table.write_field(format!("{:?}", sample.displacement_m))?;
            }
            table.write_record(None::<&[u8]>)?;
        }
    }
    table.flush()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(time_s: f64, engaged: u8) -> Sample {
        Sample {
            time_s,
            ground_m_s2: 0.1,
            rotation_rad: -0.02,
            velocity_rad_s: 1.0 / 3.0,
            acceleration_rad_s2: 1e-9,
            force_ratio: [0.03, -0.05],
            engaged,
            displacement_m: 0.25,
        }
    }

    fn history(samples: Vec<Sample>) -> History {
        History {
            device: "pair, \"clutched\"".into(),
            outcome: "safe".into(),
            slenderness_rad: 0.1,
            frequency_parameter_1_s: 2.0,
            samples,
            impacts_s: vec![],
            slides: false,
        }
    }

    #[test]
    fn engagements_meet_at_switches() {
        let states = [(0.0, 0), (1.0, 0), (1.0, 1), (2.0, 1), (2.0, 2), (2.5, 2), (2.5, 0), (3.0, 0)];
        let history = history(states.map(|(time, engaged)| sample(time, engaged)).to_vec());
        assert_eq!(history.engagements(), vec![(1.0, 2.0, 1), (2.0, 2.5, 2)]);
        assert!(history.is_clutched());
    }

    #[test]
    fn engagement_lasts_to_the_last_sample_and_instants_vanish() {
        let states = [(0.0, 1), (0.0, 2), (1.0, 1), (4.0, 1)];
        let history = history(states.map(|(time, engaged)| sample(time, engaged)).to_vec());
        assert_eq!(history.engagements(), vec![(0.0, 1.0, 2), (1.0, 4.0, 1)]);
    }

    #[test]
    fn constant_engagement_is_no_clutch() {
        let single = history(vec![sample(0.0, 1), sample(1.0, 1)]);
        assert!(!single.is_clutched() && single.has_inerter());
        assert_eq!(single.engagements(), vec![(0.0, 1.0, 1)]);
        assert!(history(vec![]).engagements().is_empty());
    }

    #[test]
    fn peaks_are_dimensionless() {
        let history = history(vec![sample(0.0, 1)]);
        assert!((history.peak_rotation_ratio() - 0.2).abs() < 1e-12);
        assert!((history.peak_force_ratio() - 0.02).abs() < 1e-12);
        assert!(!history.ends_overturned());
    }

    #[test]
    fn csv_numbers_read_back_exactly() {
        let history = history(vec![sample(0.1 + 0.2, 2)]);
        let mut bytes = Vec::new();
        write_csv(std::slice::from_ref(&history), &mut bytes).unwrap();
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        assert_eq!(reader.headers().unwrap(), COLUMNS.as_slice());
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        assert_eq!(rows.len(), 1);
        assert_eq!(&rows[0][0], history.device);
        assert_eq!(rows[0][1].parse::<f64>().unwrap().to_bits(), (0.1f64 + 0.2).to_bits());
        assert_eq!(rows[0][4].parse::<f64>().unwrap().to_bits(), (1.0f64 / 3.0).to_bits());
        assert_eq!(&rows[0][8], "2");
        let mut bytes = Vec::new();
        write_csv(&[History { slides: true, ..history }], &mut bytes).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.starts_with(&format!("{},{DISPLACEMENT}\n", COLUMNS.join(","))) && text.ends_with(",2,0.25\n"), "{text}");
    }
}
