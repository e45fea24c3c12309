//! Intensity measures ranked by how well they predict a demand.

use serde::Serialize;

use super::power_law::{DemandPoint, PowerLaw, PowerLawError};

/// Relative difference of dispersions up to which measures share a rank: PGA in g and in m/s² differ by their rounding only.
const TIE: f64 = 1e-9;

/// An intensity measure with its value in every run.
#[derive(Clone, Debug, PartialEq)]
pub struct IntensityMeasure {
    /// Its name.
    pub name: String,
    /// Its values, in the order of the demands; positive and finite.
    pub values: Vec<f64>,
}

/// Measures in order, and those that have none.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Efficiency {
    /// By rising dispersion; those that tie in the order in which they were given.
    pub ranked: Vec<RankedMeasure>,
    /// Without a law, in the order in which they were given.
    pub unfitted: Vec<UnfittedMeasure>,
}

/// A measure that predicts the demand by a power law.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RankedMeasure {
    /// Its rank, from 1: one more than the measures that are more efficient.
    pub rank: usize,
    /// Its name.
    pub name: String,
    /// Other measures of the same rank.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ties: Vec<String>,
    /// Proficiency ζ = β_D|IM / |b| (Padgett, Nielson and DesRoches 2008), the scatter in terms of ln IM: the smaller, the
    /// better. `None` if the demand does not depend on the measure (b = 0).
    pub proficiency: Option<f64>,
    /// Its law: the dispersion β_D|IM measures efficiency (Luco and Cornell 2007; smaller is better), the exponent b
    /// practicality (Padgett, Nielson and DesRoches 2008; larger is better), and R² the variance explained.
    #[serde(flatten)]
    pub law: PowerLaw,
}

/// A measure without a law.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UnfittedMeasure {
    /// Its name.
    pub name: String,
    /// Reason why the measure has no law.
    #[serde(serialize_with = "in_words")]
    pub reason: UnfittedReason,
}

/// Reasons why a measure has no law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum UnfittedReason {
    /// It does not have one value for each demand.
    #[error("{values} values for {demands} demands")]
    Length {
        /// Values.
        values: usize,
        /// Demands.
        demands: usize,
    },
    /// Its points have none.
    #[error(transparent)]
    Fit(#[from] PowerLawError),
}

fn in_words<S: serde::Serializer>(reason: &UnfittedReason, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(reason)
}

/// Ranks `measures` by the dispersion of `demands` (positive and finite) about the law of each.
pub fn rank(demands: &[f64], measures: &[IntensityMeasure]) -> Efficiency {
    let (mut ranked, mut unfitted) = (Vec::new(), Vec::new());
    for IntensityMeasure { name, values } in measures {
        match law(demands, values) {
            Ok(law) => {
                let proficiency = (law.b != 0.0).then(|| law.dispersion / law.b.abs());
                ranked.push(RankedMeasure { rank: 0, name: name.clone(), ties: Vec::new(), proficiency, law });
            }
            Err(reason) => unfitted.push(UnfittedMeasure { name: name.clone(), reason }),
        }
    }
    ranked.sort_by(|one, other| one.law.dispersion.total_cmp(&other.law.dispersion));
    number(&mut ranked);
    // Rounding may have parted those that tie.
    let place = |of: &RankedMeasure| measures.iter().position(|measure| measure.name == of.name);
    ranked.sort_by_key(|measure| (measure.rank, place(measure)));
    Efficiency { ranked, unfitted }
}

fn law(demands: &[f64], values: &[f64]) -> Result<PowerLaw, UnfittedReason> {
    if values.len() != demands.len() {
        return Err(UnfittedReason::Length { values: values.len(), demands: demands.len() });
    }
    let pairs = values.iter().zip(demands);
    let points: Vec<DemandPoint> = pairs.map(|(&intensity, &demand)| DemandPoint { intensity, demand }).collect();
    Ok(PowerLaw::fit(&points)?)
}

/// Gives measures in order of their dispersion their ranks: those within [`TIE`] of the first of a rank share it.
fn number(ranked: &mut [RankedMeasure]) {
    let mut start = 0;
    while let Some(first) = ranked.get(start) {
        let most = first.law.dispersion * (1.0 + TIE);
        let end = start + ranked[start..].iter().take_while(|measure| measure.law.dispersion <= most).count();
        let names: Vec<String> = ranked[start..end].iter().map(|measure| measure.name.clone()).collect();
        for (place, measure) in ranked[start..end].iter_mut().enumerate() {
            measure.rank = start + 1;
            let others = names.iter().enumerate().filter(|(other, _)| *other != place);
            measure.ties = others.map(|(_, name)| name.clone()).collect();
        }
        start = end;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprag_shared::math::exp;

    fn measure(name: &str, values: &[f64]) -> IntensityMeasure {
        IntensityMeasure { name: name.to_owned(), values: values.to_vec() }
    }

    #[test]
    fn measures_are_ranked_by_dispersion() {
        // ln D = 1, 2, 2, 4 against ln IM = 0, 1, 2, 3: s² = 0.35, b = 0.9. Against 0, 1, 1, 3: the line 1 + ln IM without
        // scatter.
        let demands = [1.0, 2.0, 2.0, 4.0].map(exp);
        let plain = [0.0, 1.0, 2.0, 3.0].map(exp);
        let exact = [0.0, 1.0, 1.0, 3.0].map(exp);
        let found = rank(
            &demands,
            &[
                measure("in g", &plain),
                measure("exact", &exact),
                measure("short", &[1.0]),
                measure("in m/s²", &plain.map(|value| 9.80665 * value)),
                measure("zero", &[1.0, 0.0, 2.0, 3.0]),
                measure("equal", &[2.0; 4]),
                measure("turned", &plain.map(|value| 1.0 / value)),
            ],
        );
        let order: Vec<(usize, &str)> = found.ranked.iter().map(|measure| (measure.rank, measure.name.as_str())).collect();
        assert_eq!(order, [(1, "exact"), (2, "in g"), (2, "in m/s²"), (2, "turned")]);
        assert_eq!(found.ranked[1].ties.len(), 2);
        assert!(found.ranked[0].ties.is_empty());
        let expected = 0.35_f64.sqrt() / 0.9;
        for tie in &found.ranked[1..] {
            assert!((tie.proficiency.unwrap() - expected).abs() < 1e-13);
        }
        assert!((found.ranked[3].law.b + 0.9).abs() < 1e-14);
        assert_eq!(found.unfitted[0].reason, UnfittedReason::Length { values: 1, demands: 4 });
        assert_eq!(found.unfitted[1].reason, UnfittedReason::Fit(PowerLawError::Intensity { index: 1, value: 0.0 }));
        assert_eq!(found.unfitted[2].reason.to_string(), "all 4 intensities are 2: an exponent needs two that differ");
        let json = serde_json::to_value(&found).unwrap();
        assert_eq!(json["unfitted"][0]["reason"], "1 values for 4 demands");
        assert!(json["ranked"][1]["dispersion"].is_f64() && json["ranked"][1]["r_squared"].is_f64());
    }

    #[test]
    fn a_measure_that_says_nothing_has_no_proficiency() {
        let found = rank(&[0.5; 3], &[measure("any", &[1.0, 2.0, 3.0])]);
        assert_eq!((found.ranked[0].proficiency, found.ranked[0].law.r_squared), (None, None));
        assert_eq!(rank(&[0.5; 3], &[]).ranked.len(), 0);
    }
}
