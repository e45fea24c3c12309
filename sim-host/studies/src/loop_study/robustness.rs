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

/// Where the 95th percentile leaves 5 %, in words; NaN where no motion has both standing.
fn breaking(unit: &str, name: &str, high: &[(f64, f64)]) -> String {
    let values = |of: fn(f64) -> bool| -> String {
        let values = high.iter().filter(|(_, size)| of(*size)).map(|(value, _)| text_table::number(*value, 2));
        values.collect::<Vec<String>>().join(", ")
    };
    let (beyond, unknown) = (values(|size| size > 5.0), values(f64::is_nan));
    let mut words = match (&beyond[..], high.iter().all(|(_, size)| size.is_nan())) {
        (_, true) => return format!("Under {name} the 95th percentile cannot be said: there is no change to take it of."),
        ("", _) if unknown.is_empty() => format!("Under {name} the 95th percentile stays within 5 % over the whole range."),
        ("", _) => format!("Under {name} the 95th percentile stays within 5 % where there is one."),
        (beyond, _) => format!("Under {name} the 95th percentile is beyond 5 % at {beyond}{unit}."),
    };
    if !unknown.is_empty() {
        words += &format!(" It cannot be said at {unknown}{unit}, where there is no change to take it of.");
    }
    words
}

/// Peaks of records over g tan α, by turns.
const THRESHOLDS: [f64; 2] = [1.6, 2.6];

/// Runs the study over pulses and `records`.
pub fn robustness(records: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let slenderness = block_of(&Variant::new("records", &[]))?.slenderness();
    let pulses = [grid("sine", 6, (1.0, 6.0), (1.5, 5.2)), grid("cosine", 6, (1.0, 6.0), (1.5, 5.2))].concat();
    let recorded = Records::new(records)?.at_turns(&THRESHOLDS, slenderness);
    let thresholds = THRESHOLDS.map(|threshold| threshold.to_string()).join(" and ");
    let mut report = Report::new("robustness", "Robustness of the closed loop");
    report.paragraph(&format!(
        "Motions: {} one-cycle sine and cosine pulses (ω/p 1 to 6, peaks of 1.5 to 5.2 uplift thresholds){}.\n\nPeak rotation against the ideal pair, R = 2 m, α = 10°, σ = 0.5, η = 0.85: model-aided \
         estimator, Eq. 10 predicted, 2 kHz, 1 ms, ADIS16470, but for the one thing that is swept. Changes among motions in which both keep \
         the block standing and the ideal pair rocks by {ROCKS} α or more; faults among blocks that stand.",
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
        words.push(breaking(sweep.unit, kind.name, &high));
        panels.extend(panel(kind.name, [("median size", median), ("95th percentile", high)]));
    }
    report.section(sweep.heading);
    report.paragraph(&words.join(" "));
    let name = format!("robustness/{}", number + 1);
    let mut table = TextTable::new(0, columns);
    rows.into_iter().for_each(|row| table.row(row));
    report.table(&name, table);
    if !panels.is_empty() {
        let (title, x_title, x) = (sweep.heading.to_owned(), sweep.axis.to_owned(), sweep.scale);
        let chart = Chart { title: title.into(), x_title, x, columns: panels.len(), panels, ..Chart::default() };
        report.figure(&name, sweep.heading, chart_figure(&chart)?);
    }
    Ok(())
}

/// The panel of motions called `title` with the numbers of its `lines`; none where these have no number at all.
fn panel(title: &str, lines: [(&str, Vec<(f64, f64)>); 2]) -> Option<ChartPanel> {
    let lines = lines.map(|(name, mut points)| {
        points.retain(|point| point.1.is_finite());
        Line { name: name.to_owned(), points, marks: true, ..Line::default() }
    });
    let (title, y_title) = (title.to_owned(), "change (%)".to_owned());
    let drawn = lines.iter().any(|line| !line.points.is_empty());
    drawn.then(|| ChartPanel { title, y_title, y: Scale::Linear, lines: lines.into() })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HIGH: [(f64, f64); 3] = [(1.0, 3.0), (2.0, 7.0), (5.0, f64::NAN)];

    #[test]
    fn what_has_no_change_is_beyond_nothing() {
        let words = |high: &[(f64, f64)]| breaking(" ms", "records", high);
        assert_eq!(words(&HIGH[..1]), "Under records the 95th percentile stays within 5 % over the whole range.");
        assert_eq!(words(&HIGH[..2]), "Under records the 95th percentile is beyond 5 % at 2.00 ms.");
        let unknown = "It cannot be said at 5.00 ms, where there is no change to take it of.";
        assert_eq!(words(&HIGH), format!("Under records the 95th percentile is beyond 5 % at 2.00 ms. {unknown}"));
        let within = words(&[HIGH[0], HIGH[2]]);
        assert_eq!(within, format!("Under records the 95th percentile stays within 5 % where there is one. {unknown}"));
        let nothing = "Under records the 95th percentile cannot be said: there is no change to take it of.";
        assert_eq!(words(&HIGH[2..]), nothing);
    }

    #[test]
    fn a_picture_leaves_out_what_is_no_number() {
        let drawn = panel("records", [("median size", HIGH.to_vec()), ("95th percentile", HIGH[2..].to_vec())]).unwrap();
        let points: Vec<usize> = drawn.lines.iter().map(|line| line.points.len()).collect();
        assert_eq!(points, [2, 0]);
        let title = "Delay".to_owned();
        chart_figure(&Chart { title: title.into(), columns: 1, panels: vec![drawn], ..Chart::default() }).unwrap();
        assert_eq!(panel("records", [("median size", HIGH[2..].to_vec()), ("95th percentile", Vec::new())]), None);
    }
}
