//! Robustness: what delay, noise, rate and wrong beliefs cost, and where the loop breaks.

use sprag_report::long_run::in_order::all_in_order;
use sprag_report::plot::{Chart, ChartPanel, Line, Scale, chart_figure};
use sprag_report::progress::Progress;
use sprag_report::text_table::{self, TextTable};
use sprag_shared::observers::outcome::Outcome;

use super::bench::{Conditions, EQUATION_10, StudyError, Variant, block_of, each, run_ideal, run_loop};
use super::motion::{Motion, Records, and_records, grid};
use super::practice::{COLUMNS, Comparison, ROCKS};
use super::report::Report;

/// A sweep: heading, what is swept and its unit, values, and the override that sets one.
struct Sweep {
    heading: &'static str,
    axis: &'static str,
    unit: &'static str,
    values: &'static [f64],
    scale: Scale,
    set: fn(f64) -> Vec<String>,
}

const SWEEPS: [Sweep; 8] = [
    Sweep {
        heading: "Delay from sample to clutch",
        axis: "delay (ms)",
        unit: " ms",
        values: &[0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.latency_s={:?}", 1e-3 * value)],
    },
    Sweep {
        heading: "Delay that the controller does not know of",
        axis: "delay (ms)",
        unit: " ms",
        values: &[0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.latency_s={:?}", 1e-3 * value), "controller.law=\"resisting\"".to_owned()],
    },
    Sweep {
        heading: "Noise of gyroscope and accelerometers",
        axis: "noise over that of an ICM-42688-P",
        unit: " times",
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
        axis: "control rate (Hz)",
        unit: " Hz",
        values: &[100.0, 200.0, 500.0, 1000.0, 2000.0, 4000.0],
        scale: Scale::Logarithmic,
        set: |value| vec![format!("controller.rate_hz={value:?}")],
    },
    Sweep {
        heading: "Believed α",
        axis: "believed α over the true one",
        unit: "",
        values: &[0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.belief.slenderness_factor={value:?}")],
    },
    Sweep {
        heading: "Believed R",
        axis: "believed R over the true one",
        unit: "",
        values: &[0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.belief.size_factor={value:?}")],
    },
    Sweep {
        heading: "Believed σ",
        axis: "believed σ over the true one",
        unit: "",
        values: &[0.8, 0.9, 1.0, 1.1, 1.2],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.belief.mass_ratio_factor={value:?}")],
    },
    Sweep {
        heading: "Believed η",
        axis: "believed η over the true one",
        unit: "",
        values: &[0.8, 0.9, 1.0, 1.1, 1.17],
        scale: Scale::Linear,
        set: |value| vec![format!("controller.belief.restitution_factor={value:?}")],
    },
];

/// Motions of one kind, and the ideal pair under them.
struct Kind {
    name: &'static str,
    motions: Vec<Motion>,
    ideals: Vec<(Outcome, f64)>,
}

/// Where the 95th percentile leaves 5 %, in words.
fn breaking(sweep: &Sweep, name: &str, high: &[(f64, f64)]) -> String {
    let beyond: Vec<String> =
        high.iter().filter(|(_, size)| *size > 5.0 || size.is_nan()).map(|(value, _)| text_table::number(*value, 2)).collect();
    if beyond.is_empty() {
        format!("Under {name} the 95th percentile stays within 5 % over the whole range.")
    } else {
        format!("Under {name} the 95th percentile is beyond 5 % at {}{}.", beyond.join(", "), sweep.unit)
    }
}

/// Peaks of records over g tan α, by turns.
const THRESHOLDS: [f64; 2] = [1.6, 2.6];

/// Runs the study over pulses and `records`.
///
/// # Errors
/// [`StudyError`].
pub fn robustness(records: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let slenderness = block_of(&Variant::new("records", &[]))?.slenderness();
    let pulses = [grid("sine", 6, (1.0, 6.0), (1.5, 5.2)), grid("cosine", 6, (1.0, 6.0), (1.5, 5.2))].concat();
    let recorded = Records::new(records)?.at_turns(&THRESHOLDS, slenderness);
    let thresholds = THRESHOLDS.map(|threshold| threshold.to_string()).join(" and ");
    let mut report = Report::new("robustness", "Robustness of the closed loop");
    report.paragraph(&format!(
        "Motions: {} one-cycle sine and cosine pulses (ω/p 1 to 6, peaks of 1.5 to 5.2 uplift thresholds){}.\n\nPeak rotation against the ideal pair, R = 2 m, α = 10°, σ = 0.5, η = 0.85: model-aided \
         estimator, Eq. 10 predicted, 2 kHz, 1 ms, ADIS16470, but for the one thing that is swept. Changes among motions in which both keep \
         the block standing and the ideal pair rocks by {ROCKS} α or more; faults among blocks that stand. Made by `sprag loop-study robustness`.",
        pulses.len(),
        and_records(recorded.len(), &format!(" scaled to peaks of {thresholds} thresholds by turns"))
    ));
    let mut kinds = Vec::new();
    for (name, motions) in [("pulses", pulses), ("recorded motions", recorded)] {
        let ideal = |motion: &Motion| run_ideal(motion, &Variant::new("ideal", &[]), conditions);
        let ideals = all_in_order(&motions, progress, ideal)?;
        kinds.extend((!motions.is_empty()).then_some(Kind { name, motions, ideals }));
    }
    let plain: Vec<Variant> =
        ["passive", "always-engaged"].iter().map(|law| Variant::new(law, &[&format!("controller.law=\"{law}\"")])).collect();
    report.section("For comparison: what is left without decisions");
    report.paragraph(
        "A fault leaves the safe state: both clutches open (passive), or one flywheel engaged for good, which needs no sensor and is the \
         default. Both are opened only where an engaged clutch is the fault. Against the ideal pair:",
    );
    let mut table = TextTable::new(2, [&["motions", "safe state"], &COLUMNS[..]].concat());
    for kind in &kinds {
        let results = each(&kind.motions, &plain, progress, |motion, variant| run_loop(motion, variant, conditions))?;
        for (variant, results) in plain.iter().zip(&results) {
            let names = vec![kind.name.to_owned(), variant.name.clone()];
            table.row([names, Comparison::of(results, &kind.ideals).cells()].concat());
        }
    }
    report.table("robustness/safe-states", table);
    for (number, sweep) in SWEEPS.iter().enumerate() {
        add(&mut report, number, sweep, &kinds, (progress, conditions))?;
    }
    Ok(report)
}

/// Adds the section of a sweep.
fn add(
    report: &mut Report,
    number: usize,
    sweep: &Sweep,
    kinds: &[Kind],
    (progress, conditions): (&Progress, &Conditions<'_>),
) -> Result<(), StudyError> {
    let variant = |&value: &f64| {
        let loops = [EQUATION_10, "controller.sensors.suite=\"adis16470\"", "controller.latency_s=0.001"];
        let mut variant = Variant::new(sweep.heading, &loops);
        variant.overrides.extend((sweep.set)(value));
        variant
    };
    let variants: Vec<Variant> = sweep.values.iter().map(variant).collect();
    let mut columns = vec![sweep.axis.to_owned()];
    let mut rows: Vec<Vec<String>> = sweep.values.iter().map(|&value| vec![text_table::number(value, 2)]).collect();
    let (mut panels, mut words) = (Vec::new(), Vec::new());
    for kind in kinds {
        let results = each(&kind.motions, &variants, progress, |motion, variant| run_loop(motion, variant, conditions))?;
        let measures = ["median size %", "95th percentile %", "overturned beyond ideal", "saved beyond ideal", "faults"];
        columns.extend(measures.map(|name| format!("{}: {name}", kind.name)));
        let (mut median, mut high) = (Vec::new(), Vec::new());
        for ((&value, results), row) in sweep.values.iter().zip(&results).zip(&mut rows) {
            let comparison = Comparison::of(results, &kind.ideals);
            let faults = results.iter().filter(|result| !result.outcome.overturned() && !result.ending.faults.is_empty()).count();
            row.extend(comparison.cells().into_iter().skip(1).take(measures.len() - 1).chain([faults.to_string()]));
            median.push((value, 100.0 * comparison.size(0.5)));
            high.push((value, 100.0 * comparison.size(0.95)));
        }
        words.push(breaking(sweep, kind.name, &high));
        let line = |name: &str, points: Vec<(f64, f64)>| Line { name: name.to_owned(), points, marks: true, ..Line::default() };
        panels.push(ChartPanel {
            title: kind.name.to_owned(),
            y_title: "change (%)".to_owned(),
            y: Scale::Linear,
            lines: vec![line("median size", median), line("95th percentile", high)],
        });
    }
    report.section(sweep.heading);
    report.paragraph(&words.join(" "));
    let name = format!("robustness/{}", number + 1);
    let mut table = TextTable::new(0, columns);
    rows.into_iter().for_each(|row| table.row(row));
    report.table(&name, table);
    let (title, x_title, x) = (sweep.heading.to_owned(), sweep.axis.to_owned(), sweep.scale);
    let chart = Chart { title: title.into(), x_title, x, columns: panels.len(), panels, keys: Vec::new() };
    report.figure(&name, sweep.heading, chart_figure(&chart)?);
    Ok(())
}
