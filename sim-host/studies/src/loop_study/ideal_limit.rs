//! The ideal limit: with ideal sensors and no delay the loop becomes the ideal pair as its rate grows.

use sprag_report::plot::{Chart, ChartPanel, Line, Scale, chart_figure};
use sprag_report::progress::Progress;
use sprag_report::text_table::TextTable;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::scene::controller::EstimatorName;

use super::bench::{Conditions, StudyError, Variant, each, run_ideal, run_loop};
use super::motion::Motion;
use super::report::Report;

/// Control rates, Hz.
pub const RATES: [f64; 6] = [500.0, 1000.0, 2000.0, 4000.0, 8000.0, 16_000.0];

/// Pulses of moderate size, far from an outcome's boundary.
pub fn motions() -> Vec<Motion> {
    let mut motions = Vec::new();
    for shape in ["sine", "cosine"] {
        for (frequency, amplitude) in [(2.0, 1.6), (2.5, 1.8), (3.0, 2.2), (4.0, 3.0), (5.0, 3.0)] {
            motions.push(Motion::Pulse { shape, frequency, amplitude });
        }
    }
    motions
}

/// Those of [`motions`] under which the ideal pair stands.
pub fn standing(conditions: &Conditions<'_>) -> Result<Vec<Motion>, StudyError> {
    let mut kept = Vec::new();
    for motion in motions() {
        if !run_ideal(&motion, &Variant::new("ideal", &[]), conditions)?.0.overturned() {
            kept.push(motion);
        }
    }
    Ok(kept)
}

/// The loop of the limit: Eq. 10 as it is, ideal sensors, nothing late, no hysteresis.
pub fn variant(estimator: EstimatorName, rate: f64) -> Variant {
    Variant::new(
        estimator.name(),
        &[
            &format!("controller.estimator=\"{}\"", estimator.name()),
            &format!("controller.rate_hz={rate:?}"),
            "controller.law=\"resisting\"",
            "controller.hysteresis=0.0",
            "controller.shock_s=0.0",
        ],
    )
}

/// Mean over the motions of |peak/ideal − 1|.
pub fn error(loops: &[super::bench::LoopResult], ideals: &[(Outcome, f64)]) -> f64 {
    let total: f64 = loops.iter().zip(ideals).map(|(closed, (_, peak))| (closed.peak / peak - 1.0).abs()).sum();
    total / loops.len().max(1) as f64
}

/// The slope of ln y over ln x by least squares.
pub fn order(points: &[(f64, f64)]) -> f64 {
    let logarithms: Vec<(f64, f64)> =
        points.iter().map(|(x, y)| (sprag_shared::math::ln(*x), sprag_shared::math::ln(*y))).collect();
    let count = logarithms.len() as f64;
    let (x, y) = logarithms.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
    let (above, below) = logarithms
        .iter()
        .fold((0.0, 0.0), |(a, b), point| (a + (point.0 - x) * (point.1 - y), b + (point.0 - x) * (point.0 - x)));
    above / below
}

/// Runs the study.
pub fn ideal_limit(progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let motions = standing(conditions)?;
    let ideals =
        each(&motions, &[Variant::new("ideal", &[])], progress, |motion, variant| run_ideal(motion, variant, conditions))?;
    let mut report = Report::new("ideal-limit", "The ideal limit");
    report.paragraph(&format!(
        "Motions: {} one-cycle sine and cosine pulses under which the ideal pair stands (ω/p 2 to 5, peaks of 1.6 to 3 uplift thresholds).\n\n\
         Ideal sensors, no delay, no hysteresis, Eq. 10: mean error of the peak rotation (R = 2 m, α = 10°, σ = 0.5) \
         against the ideal pair with located events, over the control rate. The order is the slope of a straight line through the \
         logarithms over the control period.",
        motions.len()
    ));
    let rates = RATES.map(|rate| format!("{rate:.0} Hz"));
    let mut table = TextTable::new(1, ["estimator".to_owned()].into_iter().chain(rates).chain(["order".to_owned()]));
    let mut panel =
        ChartPanel { title: String::new(), y_title: "mean error of the peak".to_owned(), y: Scale::Logarithmic, lines: vec![] };
    for estimator in EstimatorName::ALL {
        let variants: Vec<Variant> = RATES.iter().map(|&rate| variant(estimator, rate)).collect();
        let loops = each(&motions, &variants, progress, |motion, variant| run_loop(motion, variant, conditions))?;
        let errors: Vec<f64> = loops.iter().map(|loops| error(loops, &ideals[0])).collect();
        let points: Vec<(f64, f64)> = RATES.iter().map(|rate| 1.0 / rate).zip(errors.iter().copied()).collect();
        let mut row = vec![estimator.name().to_owned()];
        row.extend(errors.iter().map(|error| format!("{error:.2e}")));
        row.push(format!("{:.2}", order(&points)));
        table.row(row);
        panel.lines.push(Line { name: estimator.name().to_owned(), points, marks: true, ..Line::default() });
    }
    let first = 2e-3;
    let guide = [1.0 / 16_000.0, 2e-3].map(|period: f64| (period, first * period / 2e-3)).to_vec();
    panel.lines.push(Line { name: "order 1".to_owned(), points: guide, guide: true, ..Line::default() });
    report.table("ideal-limit", table);
    let chart = Chart {
        title: "Closed loop against the ideal pair".into(),
        x_title: "control period (s)".to_owned(),
        x: Scale::Logarithmic,
        panels: vec![panel],
        columns: 1,
        ..Chart::default()
    };
    report.figure("ideal-limit", "error over control period", chart_figure(&chart)?);
    Ok(report)
}
