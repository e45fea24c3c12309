//! Intensity measures of a ground motion, made dimensionless by the block that it shakes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sprag_shared::math;
use sprag_shared::structure::block::GRAVITY;
use sprag_sim::record::Record;
use sprag_sim::record::intensity::{Intensity, cumulative_absolute_velocity_m_s, uniform_duration_s};
use sprag_sim::scene::Scene;

/// Largest factor by which a record is scaled.
pub const LARGEST_FACTOR: f64 = 1000.0;

/// How far a record may be from a level that it is scaled to, relative.
const SAME_LEVEL: f64 = 1e-6;

/// What makes a measure dimensionless: the frequency parameter and the uplift threshold of the bare block.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BlockScales {
    /// p = √(g/(λR)), 1/s.
    pub frequency_parameter_1_s: f64,
    /// g tan α, or gα for the slender model, m/s².
    pub uplift_threshold_m_s2: f64,
}

impl BlockScales {
    /// Scales of the block of `scene`.
    pub fn of(scene: &Scene) -> BlockScales {
        BlockScales {
            frequency_parameter_1_s: scene.block.frequency_parameter(),
            uplift_threshold_m_s2: scene.uplift_threshold() * GRAVITY,
        }
    }
}

/// A record with its measures in SI units.
#[derive(Clone, Debug)]
pub struct MeasuredRecord {
    /// The record.
    pub record: Record,
    /// Peaks, Arias intensity and significant duration.
    pub intensity: Intensity,
    /// CAV, m/s.
    pub cav_m_s: f64,
}

impl From<Record> for MeasuredRecord {
    fn from(record: Record) -> MeasuredRecord {
        let intensity = Intensity::of(&record);
        let cav_m_s = cumulative_absolute_velocity_m_s(&record.acceleration_m_s2, record.time_step_s);
        MeasuredRecord { record, intensity, cav_m_s }
    }
}

/// A dimensionless intensity measure, with p, g and α of the bare block; the slender model has gα for g tan α.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// p t_uni: the time during which |ü_g| exceeds g tan α (Thiers-Moggia and Málaga-Chuquitaype 2019, Figure 14 and
    /// Section 6.1).
    UniformDuration,
    /// p PGV/(g tan α) (the same, Section 6.1).
    Pgv,
    /// PGA/(g tan α) (the same, Section 6.1).
    Pga,
    /// p² PGD/(g tan α).
    Pgd,
    /// Arias intensity I_A = π/(2g) ∫ü_g² dt as p ∫ü_g² dt/(g tan α)² = (2g/π) p I_A/(g tan α)².
    Arias,
    /// Cumulative absolute velocity ∫|ü_g| dt as p CAV/(g tan α).
    Cav,
    /// p D5-95, the significant duration.
    SignificantDuration,
    /// PGA/(p PGV): ω_g/p of the sine of these peaks.
    Frequency,
}

/// How a measure changes with the factor that its record is scaled by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Growth {
    None,
    Linear,
    Square,
    /// Upwards, by what of the record exceeds the threshold.
    OfTheRecord,
}

impl Measure {
    /// How many there are.
    pub const COUNT: usize = 8;

    /// All, in the order of tables.
    pub const ALL: [Measure; Measure::COUNT] = [
        Measure::UniformDuration,
        Measure::Pgv,
        Measure::Pga,
        Measure::Pgd,
        Measure::Arias,
        Measure::Cav,
        Measure::SignificantDuration,
        Measure::Frequency,
    ];

    /// As study files and tables name it.
    pub fn name(self) -> &'static str {
        match self {
            Measure::UniformDuration => "uniform-duration",
            Measure::Pgv => "pgv",
            Measure::Pga => "pga",
            Measure::Pgd => "pgd",
            Measure::Arias => "arias",
            Measure::Cav => "cav",
            Measure::SignificantDuration => "significant-duration",
            Measure::Frequency => "frequency",
        }
    }

    /// Formula of the measure as text, of the full model or the slender one.
    pub fn formula(self, slender: bool) -> String {
        let formula = match self {
            Measure::UniformDuration => "p t_uni",
            Measure::Pgv => "p PGV/(g tan α)",
            Measure::Pga => "PGA/(g tan α)",
            Measure::Pgd => "p² PGD/(g tan α)",
            Measure::Arias => "p ∫ü_g² dt/(g tan α)²",
            Measure::Cav => "p CAV/(g tan α)",
            Measure::SignificantDuration => "p D5-95",
            Measure::Frequency => "PGA/(p PGV)",
        };
        if slender { formula.replace(" tan α", "α") } else { formula.to_owned() }
    }

    /// Its formula in the markup of axis titles.
    pub fn axis_title(self, slender: bool) -> String {
        let title = match self {
            Measure::UniformDuration => "*p* *t*_{uni}",
            Measure::Pgv => "*p* PGV/(*g* tan α)",
            Measure::Pga => "PGA/(*g* tan α)",
            Measure::Pgd => "*p*² PGD/(*g* tan α)",
            Measure::Arias => "*p* ∫*a*² d*t*/(*g* tan α)²",
            Measure::Cav => "*p* CAV/(*g* tan α)",
            Measure::SignificantDuration => "*p* *D*_{5-95}",
            Measure::Frequency => "PGA/(*p* PGV)",
        };
        if slender { title.replace(" tan α", "α") } else { title.to_owned() }
    }

    /// Its value for `motion` scaled by `factor` (> 0): at least 0, 0 where the motion has none of it.
    pub fn of(self, motion: &MeasuredRecord, factor: f64, block: BlockScales) -> f64 {
        let (p, threshold) = (block.frequency_parameter_1_s, block.uplift_threshold_m_s2);
        let MeasuredRecord { record, intensity, cav_m_s } = motion;
        let in_thresholds = |value: f64| factor * value / threshold;
        match self {
            Measure::UniformDuration => p * uniform_duration_s(&record.acceleration_m_s2, record.time_step_s, threshold / factor),
            Measure::Pgv => p * in_thresholds(intensity.pgv_m_s),
            Measure::Pga => in_thresholds(intensity.pga_m_s2),
            Measure::Pgd => p * p * in_thresholds(intensity.pgd_m),
            Measure::Arias => {
                let of_squares = 2.0 * GRAVITY / core::f64::consts::PI * intensity.arias_m_s;
                p * of_squares * factor * factor / (threshold * threshold)
            }
            Measure::Cav => p * in_thresholds(*cav_m_s),
            Measure::SignificantDuration => p * intensity.d5_95_s,
            Measure::Frequency if intensity.pgv_m_s > 0.0 => intensity.pga_m_s2 / (p * intensity.pgv_m_s),
            Measure::Frequency => 0.0,
        }
    }

    /// Whether it changes when a record is scaled.
    pub fn scales(self) -> bool {
        self.growth() != Growth::None
    }

    fn growth(self) -> Growth {
        match self {
            Measure::UniformDuration => Growth::OfTheRecord,
            Measure::Pgv | Measure::Pga | Measure::Pgd | Measure::Cav => Growth::Linear,
            Measure::Arias => Growth::Square,
            Measure::SignificantDuration | Measure::Frequency => Growth::None,
        }
    }

    /// The factor at which `motion` has the `level` (> 0) of this measure; `None` where no factor up to [`LARGEST_FACTOR`]
    /// gives it, as of p t_uni at a level that the record jumps over.
    pub fn factor(self, motion: &MeasuredRecord, level: f64, block: BlockScales) -> Option<f64> {
        let factor = match self.growth() {
            Growth::None => return None,
            Growth::Linear => level / self.of(motion, 1.0, block),
            Growth::Square => math::square_root(level / self.of(motion, 1.0, block)),
            Growth::OfTheRecord => {
                let has = |factor: &f64| (self.of(motion, *factor, block) / level - 1.0).abs() < SAME_LEVEL;
                self.bisected(motion, level, block).filter(has)?
            }
        };
        (factor > 0.0 && factor <= LARGEST_FACTOR).then_some(factor)
    }

    /// The smallest factor at which the measure reaches `level`, to the last bit.
    fn bisected(self, motion: &MeasuredRecord, level: f64, block: BlockScales) -> Option<f64> {
        let reaches = |factor: f64| self.of(motion, factor, block) >= level;
        let (mut below, mut above) = (0.0, LARGEST_FACTOR);
        if !reaches(above) {
            return None;
        }
        loop {
            let middle = 0.5 * (below + above);
            if middle <= below || middle >= above {
                return Some(above);
            }
            if reaches(middle) { above = middle } else { below = middle }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;
    use sprag_sim::record::ReadOptions;

    const STEP: f64 = 1e-3;
    const BLOCK: BlockScales = BlockScales { frequency_parameter_1_s: 2.0, uplift_threshold_m_s2: 1.5 };

    fn motion(acceleration: impl Iterator<Item = f64>) -> MeasuredRecord {
        let text: String = acceleration.map(|a| format!("{a:?}\n")).collect();
        let options = ReadOptions { units: "m/s2".parse().ok(), time_step_s: Some(STEP), ..ReadOptions::default() };
        Record::parse("motion.txt", text.as_bytes(), &options).unwrap().into()
    }

    /// Two cycles of 3 sin(2πt) (m/s²) from 1 s to 3 s of 4 s.
    fn sine() -> MeasuredRecord {
        let at = |t: f64| if (1.0..3.0).contains(&t) { 3.0 * math::sin(TAU * t) } else { 0.0 };
        motion((0..=4000).map(|k| at(f64::from(k) * STEP)))
    }

    #[test]
    fn measures_of_a_sine_are_its_closed_forms() {
        let motion = sine();
        let near = |measure: Measure, expected: f64, within: f64| {
            let found = measure.of(&motion, 1.0, BLOCK);
            assert!((found / expected - 1.0).abs() < within, "{}: {found} {expected}", measure.name());
        };
        // |sin| exceeds 1/2 for two thirds of 2 s.
        near(Measure::UniformDuration, 2.0 * 4.0 / 3.0, 1e-5);
        near(Measure::Pga, 3.0 / 1.5, 1e-5);
        near(Measure::Arias, 2.0 * 9.0 * 0.5 * 2.0 / (1.5 * 1.5), 1e-5);
        near(Measure::Cav, 2.0 * 3.0 * (2.0 / core::f64::consts::PI) * 2.0 / 1.5, 1e-5);
        // From rest the velocity is A/ω (1 − cos ωt), less the straight line of the baseline: its mean over 4 s is A/(2ω), and by
        // symmetry it has no slope.
        near(Measure::Pgv, 2.0 * 1.5 * 3.0 / TAU / 1.5, 1e-3);
        near(Measure::Frequency, 3.0 / (2.0 * 1.5 * 3.0 / TAU), 1e-3);
    }

    #[test]
    fn a_rectangle_exceeds_the_threshold_as_long_as_it_lasts() {
        // 2 m/s² over 0.5 s and back: velocity and displacement come back to 0.
        let at = |k: i32| {
            if (1000..1500).contains(&k) {
                2.0
            } else if (1500..2000).contains(&k) {
                -2.0
            } else {
                0.0
            }
        };
        let motion = motion((0..=3000).map(at));
        let found = |measure: Measure| measure.of(&motion, 1.0, BLOCK);
        assert!((found(Measure::UniformDuration) - 2.0).abs() < 0.01);
        assert!((found(Measure::Pga) - 2.0 / 1.5).abs() < 1e-12);
        assert!((found(Measure::Cav) - 2.0 * 2.0 / 1.5).abs() < 1e-2);
        assert_eq!(Measure::UniformDuration.of(&motion, 0.75, BLOCK), 0.0);
    }

    #[test]
    fn scaling_follows_the_growth_of_each_measure() {
        let motion = sine();
        for measure in Measure::ALL {
            let [one, two] = [1.0, 2.0].map(|factor| measure.of(&motion, factor, BLOCK));
            match measure.growth() {
                Growth::None => assert_eq!(one, two),
                Growth::Linear => assert!((two / one - 2.0).abs() < 1e-14),
                Growth::Square => assert!((two / one - 4.0).abs() < 1e-14),
                // At twice the amplitude |sin| exceeds 1/4.
                Growth::OfTheRecord => {
                    let expected = 2.0 * 2.0 * (1.0 - 2.0 * math::asin(0.25) / core::f64::consts::PI);
                    assert!((two - expected).abs() < 1e-4 && two > one, "{two} {expected}");
                }
            }
        }
    }

    #[test]
    fn a_factor_gives_its_level() {
        let motion = sine();
        for measure in Measure::ALL {
            let level = 0.7 * measure.of(&motion, 1.0, BLOCK);
            let factor = measure.factor(&motion, level, BLOCK);
            assert_eq!(factor.is_some(), measure.scales(), "{}", measure.name());
            if let Some(factor) = factor {
                assert!((measure.of(&motion, factor, BLOCK) / level - 1.0).abs() < 1e-12, "{}", measure.name());
            }
        }
        // Longer than the motion itself, more than the largest factor, and of a motion that has none.
        assert_eq!(Measure::UniformDuration.factor(&motion, 2.0 * 2.01, BLOCK), None);
        assert_eq!(Measure::Pga.factor(&motion, 1e5, BLOCK), None);
        // A rectangle of 1 s exceeds the threshold for all of that time or not at all, but for its edges of a sample.
        let rectangle = self::motion((0..=3000).map(|k| if (1000..2000).contains(&k) { 2.0 } else { 0.0 }));
        let of = |level: f64| Measure::UniformDuration.factor(&rectangle, level, BLOCK);
        assert_eq!([0.5, 1.0, 1.5].map(of), [None; 3]);
        assert!(of(2.0).is_some());
        let quiet = self::motion([0.0; 10].into_iter());
        assert!(Measure::ALL.iter().all(|measure| measure.of(&quiet, 1.0, BLOCK) == 0.0));
        assert!(Measure::ALL.iter().all(|measure| measure.factor(&quiet, 1.0, BLOCK).is_none()));
    }

    #[test]
    fn names_are_those_of_study_files() {
        for measure in Measure::ALL {
            assert_eq!(serde_json::to_value(measure).unwrap(), measure.name());
        }
        assert_eq!(Measure::Pgv.axis_title(true), "*p* PGV/(*g*α)");
    }
}
