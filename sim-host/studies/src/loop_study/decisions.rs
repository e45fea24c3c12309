//! Decision quality: estimators by sensors by delays.

use sprag_report::progress::Progress;
use sprag_report::text_table::{TextTable, number};
use sprag_sim::closed_loop::decisions::{DecisionReport, Decisions};
use sprag_sim::scene::controller::EstimatorName;

use super::bench::{Conditions, EQUATION_10, StudyError, Variant, each, run_loop_observed};
use super::motion::{Motion, and_records, grid};
use super::report::Report;
use crate::statistics::quantile;

/// From sample to clutch, ms.
const DELAYS: [f64; 3] = [0.0, 1.0, 5.0];

/// Runs the study over 32 pulses and `records`.
pub fn decisions(records: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let mut motions = [grid("sine", 4, (1.5, 6.0), (1.5, 4.0)), grid("cosine", 4, (1.5, 6.0), (1.5, 4.0))].concat();
    motions.extend_from_slice(records);
    let mut variants = Vec::new();
    let mut labels = Vec::new();
    for estimator in EstimatorName::ALL {
        for suite in ["ideal", "adis16470", "icm-42688-p", "bmi088", "mpu-6050"] {
            for delay in DELAYS {
                labels.push([estimator.name().to_owned(), suite.to_owned(), format!("{delay:.0}")]);
                variants.push(Variant::new(
                    suite,
                    &[
                        &format!("controller.estimator=\"{}\"", estimator.name()),
                        &format!("controller.sensors.suite=\"{suite}\""),
                        &format!("controller.latency_s={:?}", 1e-3 * delay),
                        EQUATION_10,
                    ],
                ));
            }
        }
    }
    let results =
        each(&motions, &variants, progress, |motion, variant| run_loop_observed::<Decisions>(motion, variant, conditions))?;
    let mut report = Report::new("decisions", "Decision quality");
    report.paragraph(&format!(
        "Motions: {} one-cycle sine and cosine pulses (ω/p 1.5 to 6, peaks of 1.5 to 4 uplift thresholds){}.\n\nEq. 10 predicted at 2 kHz, R = 2 m, α = 10°, σ = 0.5, among blocks that stand, against Eq. 10 on the true motion. Wrong: share of the rocking \
         time, weighted by |θ̇|, in which the clutches are not as the law on the true motion has them, mean over the motions. Late: from \
         the instant at which that law changes to the clutch's movement, over all changes that a movement within 0.1 s belongs to. \
         Chatter: movements of the clutches beyond those of the law, a run.",
        motions.len() - records.len(),
        and_records(records.len(), ", as recorded")
    ));
    let mut table = TextTable::new(
        2,
        [
            "estimator",
            "sensors",
            "delay ms",
            "wrong %",
            "late: median ms",
            "95th percentile ms",
            "chatter a run",
            "switches a run",
            "ideal switches a run",
        ],
    );
    for (label, results) in labels.into_iter().zip(&results) {
        // A block that falls over is decided on by nobody.
        let decisions: Vec<&Decisions> =
            results.iter().filter(|(result, _)| !result.outcome.overturned()).map(|(_, decisions)| decisions).collect();
        let reports: Vec<DecisionReport> = decisions.iter().map(|decisions| decisions.report()).collect();
        let mean = |pick: &dyn Fn(&DecisionReport) -> f64| reports.iter().map(pick).sum::<f64>() / reports.len() as f64;
        let delays: Vec<f64> = decisions.iter().flat_map(|decisions| decisions.delays()).map(|delay| 1e3 * delay).collect();
        let mut row = label.to_vec();
        row.push(number(100.0 * mean(&|report| report.wrong_share), 2));
        row.push(number(quantile(&delays, 0.5), 2));
        row.push(number(quantile(&delays, 0.95), 2));
        row.push(number(mean(&|report| f64::from(report.chatter)), 2));
        row.push(number(mean(&|report| f64::from(report.switches)), 1));
        row.push(number(mean(&|report| f64::from(report.ideal_switches)), 1));
        table.row(row);
    }
    report.table("decisions", table);
    Ok(report)
}
