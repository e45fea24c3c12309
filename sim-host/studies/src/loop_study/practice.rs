//! As good as the ideal pair in practice: real sensors, a real rate, a real delay.

use sprag_report::progress::Progress;
use sprag_report::text_table::{TextTable, number};
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::scene::controller::{EstimatorName, MODEL_ERROR};

use super::bench::{Conditions, EQUATION_10, StudyError, Variant, each, run_ideal, run_loop};
use super::motion::{Motion, and_records, grid};
use super::report::Report;
use crate::statistics::quantile;

/// A hundred pulses of each shape: ω/p 1 to 6, amplitudes 1.2 to 5.2.
pub fn pulses() -> Vec<Motion> {
    let mut motions = Vec::new();
    for shape in ["sine", "cosine"] {
        motions.extend(grid(shape, 10, (1.0, 6.0), (1.2, 5.2)));
    }
    motions
}

/// Peak rotation of the ideal pair over α from which on a relative change says something.
pub const ROCKS: f64 = 0.02;

/// How far loops are from the ideal pair.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Change of the peak rotation, relative, under each motion in which both stand and the ideal pair rocks by [`ROCKS`] or more.
    pub changes: Vec<f64>,
    /// Motions in which only the loop overturns, …
    pub overturned: usize,
    /// … and in which only the ideal pair does.
    pub saved: usize,
    /// All motions.
    pub motions: usize,
}

impl Comparison {
    /// Comparison of loops with the ideal pair.
    pub fn of(loops: &[super::bench::LoopResult], ideals: &[(Outcome, f64)]) -> Comparison {
        Comparison::beside(loops.iter().map(|closed| (closed.outcome, closed.peak)), ideals)
    }

    /// Of outcomes and peaks with those of the ideal pair under the same motions.
    pub fn beside(runs: impl IntoIterator<Item = (Outcome, f64)>, ideals: &[(Outcome, f64)]) -> Comparison {
        let mut comparison = Comparison { motions: ideals.len(), ..Comparison::default() };
        runs.into_iter().zip(ideals).for_each(|(run, ideal)| comparison.note(run, *ideal));
        comparison
    }

    /// Adds an outcome and peak, beside what they are compared with.
    pub fn note(&mut self, (outcome, peak): (Outcome, f64), (ideal, least): (Outcome, f64)) {
        match (outcome.overturned(), ideal.overturned()) {
            (true, false) => self.overturned += 1,
            (false, true) => self.saved += 1,
            (false, false) if least >= ROCKS => self.changes.push(peak / least - 1.0),
            _ => {}
        }
    }

    /// |change| at a quantile; NaN without changes.
    pub fn size(&self, share: f64) -> f64 {
        quantile(&self.changes.iter().map(|change| change.abs()).collect::<Vec<f64>>(), share).unwrap_or(f64::NAN)
    }

    /// Cells of a table.
    pub fn cells(&self) -> Vec<String> {
        vec![
            number(quantile(&self.changes, 0.5).map(|change| 100.0 * change), 3),
            number(100.0 * self.size(0.5), 3),
            number(100.0 * self.size(0.95), 2),
            self.overturned.to_string(),
            self.saved.to_string(),
            self.changes.len().to_string(),
            self.motions.to_string(),
        ]
    }
}

/// Headings of [`Comparison::cells`].
pub const COLUMNS: [&str; 7] = [
    "median change %",
    "median size %",
    "95th percentile %",
    "overturned beyond ideal",
    "saved beyond ideal",
    "both stand",
    "motions",
];

/// From sample to clutch, ms: fast electromagnetic clutches take 20, others 50.
const SLOW_CLUTCHES: [f64; 2] = [20.0, 50.0];

fn variant(name: &str, suite: &str, estimator: &str, delay: f64) -> Variant {
    Variant::new(
        name,
        &[
            EQUATION_10,
            &format!("controller.sensors.suite=\"{suite}\""),
            &format!("controller.estimator=\"{estimator}\""),
            &format!("controller.latency_s={:?}", 1e-3 * delay),
        ],
    )
}

/// Runs the study over the pulses and `records`.
pub fn practice(records: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let pulses = pulses();
    let mut report = Report::new("practice", "As good as ideal in practice");
    report.paragraph(&format!(
        "Motions: {} one-cycle sine and cosine pulses (ω/p 1 to 6, peaks of 1.2 to 5.2 uplift thresholds){}.\n\nPeak rotation of the closed loop against the ideal clutched pair (no controller, no delay): R = 2 m, α = 10°, σ = 0.5, \
         η = 0.85, control rate 2 kHz, 1 ms from sample to clutch but where a row says otherwise, Eq. 10 predicted. Changes among motions in \
         which both keep the block standing and the ideal pair rocks by {ROCKS} α or more.",
        pulses.len(),
        and_records(records.len(), ", as recorded")
    ));
    let parts = [
        ("Pulses", "practice-pulses", &pulses[..], &["adis16470", "icm-42688-p", "bmi088", "mpu-6050"][..]),
        ("Recorded motions", "practice-records", records, &["adis16470", "icm-42688-p"][..]),
    ];
    for (heading, name, motions, suites) in parts {
        if motions.is_empty() {
            continue;
        }
        let mut variants = Vec::new();
        for suite in suites {
            for estimator in EstimatorName::ALL.map(EstimatorName::name) {
                variants.push(variant(&format!("{suite}, {estimator}"), suite, estimator, 1.0));
            }
        }
        for delay in SLOW_CLUTCHES {
            variants.push(variant(&format!("{}, model-aided, {delay} ms", suites[0]), suites[0], "model-aided", delay));
        }
        let ideals =
            each(motions, &[Variant::new("ideal", &[])], progress, |motion, variant| run_ideal(motion, variant, conditions))?;
        let loops = each(motions, &variants, progress, |motion, variant| run_loop(motion, variant, conditions))?;
        let mut table = TextTable::new(1, [&["sensors, estimator"], &COLUMNS[..], &["faults among blocks that stand"]].concat());
        for (variant, loops) in variants.iter().zip(&loops) {
            let comparison = Comparison::of(loops, &ideals[0]);
            let faults = loops.iter().filter(|closed| !closed.outcome.overturned() && !closed.ending.faults.is_empty()).count();
            table.row([vec![variant.name.clone()], comparison.cells(), vec![faults.to_string()]].concat());
        }
        report.section(heading);
        report.table(name, table);
    }
    if !records.is_empty() {
        trust(&mut report, records, progress, conditions)?;
    }
    Ok(report)
}

/// Shares of p²α by which the equation of motion may be wrong, that are compared; with wrong beliefs the first and the last.
const MODEL_ERRORS: [f64; 3] = [0.1, 0.05, 0.02];
/// Specimens of the sensors with the right belief …
const SPECIMENS: std::ops::RangeInclusive<u64> = 9..=16;
/// … and with each wrong one.
const FEW_SPECIMENS: std::ops::RangeInclusive<u64> = 9..=10;

/// Several specimens' comparisons as cells: 95th percentile of all changes, its range over the specimens, median, and overturned blocks.
fn pooled(of: &[Comparison]) -> Vec<String> {
    let mut all = Comparison::default();
    for comparison in of {
        all.changes.extend_from_slice(&comparison.changes);
        all.overturned += comparison.overturned;
        all.motions += comparison.motions;
    }
    let each: Vec<f64> = of.iter().map(|comparison| 100.0 * comparison.size(0.95)).collect();
    let (least, most) = each
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most): (f64, f64), &size| (least.min(size), most.max(size)));
    vec![
        number(100.0 * all.size(0.5), 3),
        number(100.0 * all.size(0.95), 2),
        if all.changes.is_empty() { "-".to_owned() } else { format!("{} to {}", number(least, 2), number(most, 2)) },
        all.overturned.to_string(),
        all.motions.to_string(),
    ]
}

/// Adds what the trust in the equation of motion does to the peaks under `records`, over specimens of the sensors.
fn trust(report: &mut Report, records: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<(), StudyError> {
    let ideal = |scale: f64| {
        let motions: Vec<Motion> = records.iter().map(|motion| motion.times(scale)).collect();
        let run = |motion: &Motion, variant: &Variant| run_ideal(motion, variant, conditions);
        Ok::<_, StudyError>(each(&motions, &[Variant::new("ideal", &[])], progress, run)?.remove(0))
    };
    let all = ideal(1.0)?;
    let mut table = TextTable::new(
        3,
        [
            "sensors",
            "belief",
            "model error",
            "median size %",
            "95th percentile %",
            "of a specimen",
            "overturned beyond ideal",
            "runs",
        ],
    );
    let dash = || "-".to_owned();
    let moved = |scale: f64| Ok::<_, StudyError>(Comparison::beside(ideal(scale)?, &all));
    let chaos = [moved(0.999)?, moved(1.001)?];
    table.row([vec!["none: the ideal pair, ground times 0.999 and 1.001".to_owned(), dash(), dash()], pooled(&chaos)].concat());
    let kept = |index: &usize| !all[*index].0.overturned() && all[*index].1 >= ROCKS;
    let (rocked, ideals): (Vec<Motion>, Vec<_>) =
        (0..all.len()).filter(kept).map(|index| (records[index].clone(), all[index])).unzip();
    let slow = SLOW_CLUTCHES[0];
    let mut beliefs = vec![
        ("right".to_owned(), String::new()),
        (format!("right, {slow} ms"), format!("controller.latency_s={:?}", 1e-3 * slow)),
    ];
    for (symbol, key) in [("α", "slenderness"), ("R", "size"), ("σ", "mass_ratio"), ("η", "restitution")] {
        for factor in [0.95, 1.05] {
            beliefs.push((format!("{symbol} times {factor}"), format!("controller.belief.{key}_factor={factor:?}")));
        }
    }
    for (suite, beliefs) in [("icm-42688-p", &beliefs[..]), ("adis16470", &beliefs[..1])] {
        for (belief, key) in beliefs {
            let right = belief.starts_with("right");
            for error in MODEL_ERRORS.into_iter().filter(|error| right || *error != MODEL_ERRORS[1]) {
                let mut base =
                    variant(suite, suite, "model-aided", 1.0).with(&format!("controller.belief.model_error={error:?}"));
                base.overrides.extend((!key.is_empty()).then(|| key.clone()));
                let seeds = if right { SPECIMENS } else { FEW_SPECIMENS };
                let variants: Vec<Variant> = seeds.map(|seed| Variant { seed, ..base.clone() }).collect();
                let loops = each(&rocked, &variants, progress, |motion, variant| run_loop(motion, variant, conditions))?;
                let compared: Vec<Comparison> = loops.iter().map(|loops| Comparison::of(loops, &ideals)).collect();
                table.row([vec![suite.to_owned(), belief.clone(), error.to_string()], pooled(&compared)].concat());
            }
        }
    }
    report.section("How far to trust the equation of motion");
    report.paragraph(&format!(
        "`belief.model_error` is the share of p²α by which the model-aided estimator takes the equation of motion to be wrong. Over the {} \
         recorded motions that make the ideal pair rock and leave it standing; specimens {} to {} of the sensors with the right belief, {} \
         and {} with each wrong one. The first row is what a change of the ground by a thousandth makes of the ideal pair itself. The default is {MODEL_ERROR}.",
        rocked.len(),
        SPECIMENS.start(),
        SPECIMENS.end(),
        FEW_SPECIMENS.start(),
        FEW_SPECIMENS.end()
    ));
    report.table("practice-trust", table);
    Ok(())
}

#[cfg(test)]
mod tests {
    use sprag_shared::settings::Settings;
    use sprag_shared::settings::kind::Description;

    use super::*;
    use crate::loop_study::bench::with_loop;
    use sprag_sim::interrupt::Interrupt;

    /// The board's default block is that of the studies, its default sensors those of the parts list.
    #[test]
    fn a_boards_default_estimator_is_the_one_that_is_studied() {
        let interrupt = Interrupt::default();
        let motion = Motion::Pulse { shape: "sine", frequency: 2.0, amplitude: 2.0 };
        let parts = variant("parts list", "icm-42688-p", "model-aided", 1.0);
        let solved = with_loop(&motion, &parts, &Conditions::new(None, &interrupt), |task| Ok(task.settings()?)).unwrap();
        let differing: Vec<String> = Description::all()
            .iter()
            .zip(solved.words().iter().zip(Settings::default().words()))
            .filter(|(description, (solved, default))| description.name.starts_with("estimator") && solved != default)
            .map(|(description, (&solved, _))| format!("{} is {}", description.name, description.show(solved)))
            .collect();
        assert!(differing.is_empty(), "{differing:#?}");
    }

    #[test]
    fn specimens_are_pooled_and_their_range_is_kept() {
        let specimen = |changes: &[f64], overturned| Comparison { changes: changes.to_vec(), overturned, saved: 0, motions: 3 };
        let cells = pooled(&[specimen(&[0.01, -0.01], 1), specimen(&[0.03, 0.03], 0)]);
        assert_eq!([&cells[2], &cells[3], &cells[4]], ["1.00 to 3.00", "1", "6"]);
        assert_eq!(pooled(&[Comparison::default()])[1..3], ["-", "-"]);
    }
}
