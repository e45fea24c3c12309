//! Robustness: what delay, noise, rate and wrong beliefs cost, and where the loop breaks.

use super::bench::{Conditions, Motion, StudyError, Variant, each, grid, run_ideal, run_loop};
use super::practice::{COLUMNS, Comparison};
use super::report::{Report, Table};
use super::statistics::cell;
use crate::plot::{Chart, ChartPanel, Line, Scale, chart_figure};
use crate::progress::Progress;

/// A sweep: heading, unit, values, and the override that sets one.
struct Sweep {
    heading: &'static str,
    axis: &'static str,
    values: &'static [f64],
    scale: Scale,
    set: fn(f64) -> Vec<String>,
}

const SWEEPS: [Sweep; 8] = [
    Sweep {
        heading: "Delay from sample to clutch",
        axis: "ms",
        values: &[0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.latency_s={:?}", 1e-3 * value)],
    },
    Sweep {
        heading: "Delay that the controller does not know of",
        axis: "ms",
        values: &[0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.latency_s={:?}", 1e-3 * value), "controller.law=\"resisting\"".to_owned()],
    },
    Sweep {
        heading: "Noise of gyroscope and accelerometers, times that of an ICM-42688-P",
        axis: "times",
        values: &[0.1, 1.0, 3.0, 10.0, 30.0, 100.0],
        scale: Scale::Logarithmic,
        set: |value| {
            vec![
                format!("controller.sensors.gyroscope={{preset=\"icm-42688-p\", noise_density_deg_s_rthz={:?}}}", 0.0028 * value),
                format!(
                    "controller.sensors.ground_accelerometer={{preset=\"icm-42688-p\", noise_density_ug_rthz={:?}}}",
                    70.0 * value
                ),
                format!(
                    "controller.sensors.block_accelerometer={{preset=\"icm-42688-p\", noise_density_ug_rthz={:?}}}",
                    70.0 * value
                ),
            ]
        },
    },
    Sweep {
        heading: "Control rate",
        axis: "Hz",
        values: &[100.0, 200.0, 500.0, 1000.0, 2000.0, 4000.0],
        scale: Scale::Logarithmic,
        set: |value| vec![format!("controller.rate_hz={value:?}")],
    },
    Sweep {
        heading: "Believed α over the true one",
        axis: "-",
        values: &[0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.belief.slenderness_factor={value:?}")],
    },
    Sweep {
        heading: "Believed R over the true one",
        axis: "-",
        values: &[0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.belief.size_factor={value:?}")],
    },
    Sweep {
        heading: "Believed σ over the true one",
        axis: "-",
        values: &[0.8, 0.9, 1.0, 1.1, 1.2],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.belief.mass_ratio_factor={value:?}")],
    },
    Sweep {
        heading: "Believed η over the true one",
        axis: "-",
        values: &[0.8, 0.9, 1.0, 1.1, 1.17],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.belief.restitution_factor={value:?}")],
    },
];

/// Where the 95th percentile leaves 5 %, in words.
fn breaking(sweep: &Sweep, high: &[(f64, f64)]) -> String {
    let beyond: Vec<String> =
        high.iter().filter(|(_, size)| *size > 5.0 || size.is_nan()).map(|(value, _)| cell(*value, 2)).collect();
    if beyond.is_empty() {
        "The 95th percentile stays within 5 % over the whole range.".to_owned()
    } else {
        format!("The 95th percentile is beyond 5 % at {} {}.", beyond.join(", "), sweep.axis)
    }
}

/// Runs the study over pulses and `records`.
///
/// # Errors
/// [`StudyError`].
pub fn robustness(records: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let mut motions = [grid("sine", 6, (1.0, 6.0), (1.5, 5.2)), grid("cosine", 6, (1.0, 6.0), (1.5, 5.2))].concat();
    motions.extend_from_slice(records);
    let ideals =
        each(&motions, &[Variant::new("ideal", &[])], progress, |motion, variant| run_ideal(motion, variant, conditions))?;
    let mut report = Report::new("robustness", "Robustness of the closed loop");
    report.paragraph(&format!(
        "Peak rotation against the ideal pair, R = 2 m, α = 10°, σ = 0.5, η = 0.85, over {} motions: model-aided estimator, Eq. 10 \
         predicted, 2 kHz, 1 ms, ADIS16470, but for the one thing that is swept. Made by `sprag loop-study robustness`.",
        motions.len()
    ));
    let plain: Vec<Variant> =
        ["passive", "always-engaged"].iter().map(|law| Variant::new(law, &[&format!("controller.law=\"{law}\"")])).collect();
    let results = each(&motions, &plain, progress, |motion, variant| run_loop(motion, variant, conditions))?;
    report.section("For comparison: what is left without decisions");
    report.paragraph(
        "A fault leaves the safe state: both clutches open (passive), or one flywheel engaged for good. Against the ideal pair:",
    );
    let mut table = Table::new(&[&["safe state"], &COLUMNS[..]].concat());
    for (variant, results) in plain.iter().zip(&results) {
        table.row([vec![variant.name.clone()], Comparison::of(results, &ideals[0]).cells()].concat());
    }
    report.table("robustness/safe-states", table);
    for (number, sweep) in SWEEPS.iter().enumerate() {
        let variants: Vec<Variant> = sweep
            .values
            .iter()
            .map(|&value| {
                let mut variant =
                    Variant::new(sweep.heading, &["controller.sensors.suite=\"adis16470\"", "controller.latency_s=0.001"]);
                variant.overrides.extend((sweep.set)(value));
                variant
            })
            .collect();
        let results = each(&motions, &variants, progress, |motion, variant| run_loop(motion, variant, conditions))?;
        let mut table = Table::new(&[
            sweep.axis,
            "median change %",
            "median size %",
            "95th percentile %",
            "overturned beyond ideal",
            "saved beyond ideal",
            "faults among blocks that stand",
        ]);
        let (mut median, mut high) = (Vec::new(), Vec::new());
        for (&value, results) in sweep.values.iter().zip(&results) {
            let comparison = Comparison::of(results, &ideals[0]);
            let faults = results.iter().filter(|result| !result.outcome.overturned() && !result.ending.faults.is_empty()).count();
            let [change, size, large, overturned, saved, ..] = <[String; 7]>::try_from(comparison.cells()).unwrap_or_default();
            table.row(vec![cell(value, 2), change, size, large, overturned, saved, faults.to_string()]);
            median.push((value, 100.0 * comparison.size(0.5)));
            high.push((value, 100.0 * comparison.size(0.95)));
        }
        report.section(sweep.heading);
        report.paragraph(&breaking(sweep, &high));
        let name = format!("robustness/{}", number + 1);
        report.table(&name, table);
        let line = |name: &str, points: Vec<(f64, f64)>| Line { name: name.to_owned(), points, marks: true, ..Line::default() };
        let panel = ChartPanel {
            title: String::new(),
            y_title: "change (%)".to_owned(),
            y: Scale::Linear,
            lines: vec![line("median size", median), line("95th percentile", high)],
        };
        let (title, x_title, x) = (sweep.heading.to_owned(), sweep.axis.to_owned(), sweep.scale);
        let chart = Chart { title: title.into(), x_title, x, panels: vec![panel], columns: 1, keys: Vec::new() };
        report.figure(&name, sweep.heading, chart_figure(&chart)?);
    }
    Ok(report)
}
