//! Work-precision diagrams: the error against what it costs.

use super::row::Row;
use super::variant::{Family, Method, Number, Setting};
use crate::plot::{Chart, ChartPanel, Line, PlotError, Scale, chart_figure};
use crate::scene::accuracy::EventTreatment;

/// Errors below this are drawn at it: a result may be exact by chance.
const SMALLEST_ERROR: f64 = 1e-17;

/// What is drawn against what.
type Point = fn(&Row) -> Option<(f64, f64)>;

/// The line of every family of `wanted`, in each device's panel.
fn panels(rows: &[Row], devices: &[String], wanted: impl Fn(&Family) -> bool, point: Point, y_title: &str) -> Vec<ChartPanel> {
    let panel = |(index, name): (usize, &String)| {
        let mut lines: Vec<(Family, Line)> = Vec::new();
        for row in rows.iter().filter(|row| row.device == index && wanted(&row.variant.family())) {
            let family = row.variant.family();
            let Some((x, y)) = point(row) else { continue };
            let known = lines.iter().position(|(known, _)| *known == family).unwrap_or_else(|| {
                lines.push((family, Line { name: family.to_string(), points: Vec::new(), marks: true, guide: false }));
                lines.len() - 1
            });
            lines[known].1.points.push((x, y.max(SMALLEST_ERROR)));
        }
        let lines = lines.into_iter().map(|(_, line)| line).collect();
        ChartPanel { title: name.clone(), y_title: y_title.to_owned(), y: Scale::Logarithmic, lines }
    };
    devices.iter().enumerate().map(panel).filter(|panel| !panel.lines.is_empty()).collect()
}

/// The dashed line of the ways that no other one beats.
fn front(rows: &[Row], device: usize) -> Line {
    let mut points: Vec<(f64, f64)> = rows
        .iter()
        .filter(|row| row.device == device && row.on_front)
        .filter_map(|row| Some((row.nanoseconds, row.peak_error?.max(SMALLEST_ERROR))))
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Line { name: "Pareto front".to_owned(), points, marks: false, guide: true }
}

fn chart(title: &str, x_title: &str, panels: Vec<ChartPanel>) -> Option<Result<String, PlotError>> {
    let columns = panels.len().min(2);
    let chart = Chart { title: title.into(), x_title: x_title.to_owned(), x: Scale::Logarithmic, panels, columns };
    (!chart.panels.is_empty()).then(|| chart_figure(&chart))
}

/// A figure by the name of its file without the ending.
pub type Figure = (&'static str, String);

/// All figures of a study; those that nothing can be drawn in are left out.
///
/// # Errors
/// [`PlotError`].
pub fn figures(title: &str, rows: &[Row], devices: &[String]) -> Result<Vec<Figure>, PlotError> {
    let own = |family: &Family| matches!(family.number, Number::F64Libm | Number::F32Own);
    let f64s = |family: &Family| family.number == Number::F64Libm;
    let by_time: Point = |row| Some((row.nanoseconds, row.peak_error?));
    let peak = "error of max |*θ*|/α";
    let mut precision = panels(rows, devices, own, by_time, peak);
    for panel in &mut precision {
        let device = devices.iter().position(|name| *name == panel.title).unwrap_or(0);
        panel.lines.push(front(rows, device));
    }
    let x_time = "host: ns to a simulated second";
    let by_step: Point = |row| match row.variant.setting {
        Setting::Step(step) => Some((step, row.history_error?)),
        Setting::Tolerance(_) => None,
    };
    let by_wrong: Point = |row| Some((row.nanoseconds, row.wrong_share.filter(|share| *share > 0.0)?));
    let sines = |family: &Family| family.method == Method::RungeKutta4 && family.events == EventTreatment::StepEnd;
    let by_cycles: Point = |row| Some((row.board?.cycles() * row.steps_per_second, row.peak_error?));
    let charts = [
        ("work_precision", chart(&format!("{title}: error against time"), x_time, precision)),
        (
            "order",
            chart(
                &format!("{title}: error of the history against the step"),
                "step in 1/*p*",
                panels(rows, devices, f64s, by_step, "max |Δ*θ*|/α"),
            ),
        ),
        (
            "sines",
            chart(
                &format!("{title}: precision and source of the sine"),
                "step in 1/*p*",
                panels(rows, devices, sines, by_step, "max |Δ*θ*|/α"),
            ),
        ),
        (
            "wrong_outcomes",
            chart(&format!("{title}: outcomes gone wrong"), x_time, panels(rows, devices, own, by_wrong, "share of cells")),
        ),
        (
            "board",
            chart(
                &format!("{title}: error against time on the board"),
                "Cortex-M4F: cycles to a simulated second",
                panels(rows, devices, |_| true, by_cycles, peak),
            ),
        ),
    ];
    charts.into_iter().filter_map(|(name, figure)| Some(figure?.map(|figure| (name, figure)))).collect()
}
