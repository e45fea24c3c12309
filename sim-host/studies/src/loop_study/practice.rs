//! As good as the ideal pair in practice: real sensors, a real rate, a real delay.

use sprag_report::progress::Progress;
use sprag_sim::scene::controller::EstimatorName;

use super::bench::{Conditions, EQUATION_10, StudyError, Variant, each, run_ideal, run_loop};
use super::motion::{Motion, and_records, grid};
use super::report::{Report, Table};
use super::statistics::cell;
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
    /// Of loops with the ideal pair.
    pub fn of(loops: &[super::bench::LoopResult], ideals: &[(sprag_shared::observers::outcome::Outcome, f64)]) -> Comparison {
        let mut comparison = Comparison { motions: loops.len(), ..Comparison::default() };
        for (closed, ideal) in loops.iter().zip(ideals) {
            comparison.note((closed.outcome, closed.peak), *ideal);
        }
        comparison
    }

    /// Adds an outcome and peak, beside what they are compared with.
    pub fn note(
        &mut self,
        (outcome, peak): (sprag_shared::observers::outcome::Outcome, f64),
        (ideal, least): (sprag_shared::observers::outcome::Outcome, f64),
    ) {
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

    /// As cells of a table.
    pub fn cells(&self) -> Vec<String> {
        vec![
            cell(quantile(&self.changes, 0.5).map(|change| 100.0 * change), 3),
            cell(100.0 * self.size(0.5), 3),
            cell(100.0 * self.size(0.95), 2),
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
///
/// # Errors
/// [`StudyError`].
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
        let mut table = Table::new(&[&["sensors, estimator"], &COLUMNS[..], &["faults among blocks that stand"]].concat());
        for (variant, loops) in variants.iter().zip(&loops) {
            let comparison = Comparison::of(loops, &ideals[0]);
            let faults = loops.iter().filter(|closed| !closed.outcome.overturned() && !closed.ending.faults.is_empty()).count();
            table.row([vec![variant.name.clone()], comparison.cells(), vec![faults.to_string()]].concat());
        }
        report.section(heading);
        report.table(name, table);
    }
    Ok(report)
}
