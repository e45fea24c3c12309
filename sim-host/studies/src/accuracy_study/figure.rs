//! Work-precision diagrams: the error against what it costs.

use sprag_report::plot::{Chart, ChartKey, ChartPanel, Line, LineLook, PlotError, Scale, chart_figure};
use sprag_sim::scene::accuracy::EventTreatment;

use super::row::Row;
use super::variant::{Family, Method, Number, Setting};

/// Errors below this are drawn at it: a result may be exact by chance.
const SMALLEST_ERROR: f64 = 1e-17;

/// What is drawn against what.
type Point = fn(&Row) -> Option<(f64, f64)>;

/// The line of every family of `wanted`, in each device's panel.
fn panels(
    rows: &[Row],
    devices: &[String],
    wanted: impl Fn(&Family) -> bool,
    colours: Colours,
    point: Point,
    y_title: &str,
) -> Vec<ChartPanel> {
    let panel = |(index, name): (usize, &String)| {
        let mut lines: Vec<(Family, Line)> = Vec::new();
        for row in rows.iter().filter(|row| row.device == index && wanted(&row.variant.family())) {
            let family = row.variant.family();
            let Some((x, y)) = point(row) else { continue };
            let known = lines.iter().position(|(known, _)| *known == family).unwrap_or_else(|| {
                let (name, label) = (family.to_string(), family.to_string());
                lines.push((family, Line { name, label, look: Some(colours.look(&family)), marks: true, ..Line::default() }));
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
    Line { name: "Pareto front".to_owned(), points, guide: true, ..Line::default() }
}

/// What colours stand for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Colours {
    /// Methods; dashes for the treatment of events.
    Methods,
    /// Sources of the sine, of one method.
    Sources,
}

impl Colours {
    /// The look of the line of `family`; it has circles for f32.
    fn look(self, family: &Family) -> LineLook {
        let open = family.number.precision() == "f32";
        match self {
            Colours::Methods => {
                let colour = METHODS.iter().position(|(method, _)| *method == family.method).unwrap_or(0);
                LineLook { colour, dashes: usize::from(family.events == EventTreatment::StepEnd), open }
            }
            Colours::Sources => {
                let colour = SOURCES.iter().position(|source| *source == family.number.math()).unwrap_or(0);
                LineLook { colour, dashes: 0, open }
            }
        }
    }
}

/// Methods in the order of their colours.
const METHODS: [(Method, &str); 4] = [
    (Method::Taylor, "Taylor series"),
    (Method::RungeKutta4, "Runge-Kutta 4"),
    (Method::SemiImplicitEuler, "semi-implicit Euler"),
    (Method::ClosedForm, "closed form"),
];

/// Sources of the sine in the order of their colours.
const SOURCES: [&str; 3] = ["libm", "own-polynomial", "micromath"];

/// What the looks of `wanted` families stand for.
fn keys(rows: &[Row], wanted: impl Fn(&Family) -> bool, colours: Colours) -> Vec<Vec<ChartKey>> {
    let families: Vec<Family> = rows.iter().map(|row| row.variant.family()).filter(wanted).collect();
    let any = |is: &dyn Fn(&Family) -> bool| families.iter().any(is);
    let mut rows = [Vec::new(), Vec::new()];
    match colours {
        Colours::Methods => {
            let used = METHODS.iter().enumerate().filter(|(_, (method, _))| any(&|family| family.method == *method));
            rows[0].extend(used.map(|(index, (_, name))| ChartKey::Colour(index, (*name).to_owned())));
            let treatments = [(EventTreatment::Located, "events located"), (EventTreatment::StepEnd, "events at step ends")];
            let used = treatments.iter().enumerate().filter(|(_, (events, _))| any(&|family| family.events == *events));
            rows[1].extend(used.map(|(index, (_, name))| ChartKey::Dashes(index, (*name).to_owned())));
        }
        Colours::Sources => {
            let used = SOURCES.iter().enumerate().filter(|(_, source)| any(&|family| family.number.math() == **source));
            rows[0].extend(used.map(|(index, source)| ChartKey::Colour(index, format!("sine: {}", source.replace('-', " ")))));
        }
    }
    let precisions = [(false, "f64"), (true, "f32")];
    let used = precisions.iter().filter(|(_, precision)| any(&|family| family.number.precision() == *precision));
    rows[1].extend(used.map(|(open, precision)| ChartKey::Marks(*open, (*precision).to_owned())));
    rows.to_vec()
}

fn chart(title: &str, x_title: &str, panels: Vec<ChartPanel>, keys: Vec<Vec<ChartKey>>) -> Option<Result<String, PlotError>> {
    let columns = panels.len().min(2);
    let chart = Chart { title: title.into(), x_title: x_title.to_owned(), x: Scale::Logarithmic, panels, columns, keys };
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
    let mut precision = panels(rows, devices, own, Colours::Methods, by_time, peak);
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
        ("work_precision", chart(&format!("{title}: error against time"), x_time, precision, keys(rows, own, Colours::Methods))),
        (
            "order",
            chart(
                &format!("{title}: error of the history against the step"),
                "step in 1/*p*",
                panels(rows, devices, f64s, Colours::Methods, by_step, "max |Δ*θ*|/α"),
                keys(rows, f64s, Colours::Methods),
            ),
        ),
        (
            "sines",
            chart(
                &format!("{title}: precision and source of the sine"),
                "step in 1/*p*",
                panels(rows, devices, sines, Colours::Sources, by_step, "max |Δ*θ*|/α"),
                keys(rows, sines, Colours::Sources),
            ),
        ),
        (
            "wrong_outcomes",
            chart(
                &format!("{title}: outcomes gone wrong"),
                x_time,
                panels(rows, devices, own, Colours::Methods, by_wrong, "share of cells"),
                keys(rows, own, Colours::Methods),
            ),
        ),
        (
            "board",
            chart(
                &format!("{title}: error against time on the board"),
                "Cortex-M4F: cycles to a simulated second",
                panels(rows, devices, |_| true, Colours::Methods, by_cycles, peak),
                keys(rows, |_| true, Colours::Methods),
            ),
        ),
    ];
    charts.into_iter().filter_map(|(name, figure)| Some(figure?.map(|figure| (name, figure)))).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::accuracy_study::board::BoardCost;
    use crate::accuracy_study::variant::{Variant, variants};
    use sprag_report::plot::assert_drawn;

    /// The rows of a table that `sprag accuracy` has written, and the names of its devices.
    fn read(table: &Path) -> (Vec<Row>, Vec<String>) {
        let known = variants(true, 0.0);
        let mut devices: Vec<String> = Vec::new();
        let mut rows = Vec::new();
        for record in csv::Reader::from_path(table).unwrap().records() {
            let record = record.unwrap();
            let number = |column: usize| record[column].parse::<f64>().ok();
            let is_its = |variant: &&Variant| {
                let family = variant.family();
                let names = [family.method.name(), family.events(), family.number.precision(), family.number.math()];
                names.iter().zip(1..).all(|(name, column)| *name == &record[column]) && Some(variant.setting.value()) == number(6)
            };
            let device = devices.iter().position(|name| *name == record[0]).unwrap_or_else(|| {
                devices.push(record[0].to_owned());
                devices.len() - 1
            });
            rows.push(Row {
                device,
                variant: *known.iter().find(is_its).unwrap_or_else(|| panic!("{record:?}")),
                outcome_right: &record[7] == "true",
                peak_error: number(8),
                history_error: number(9),
                wrong_share: number(10),
                steps_per_second: number(11).unwrap(),
                nanoseconds: number(12).unwrap(),
                board: number(13).map(|instructions| BoardCost { instructions: instructions as u32 }),
                on_front: &record[15] == "true",
            });
        }
        (rows, devices)
    }

    /// A table of docs/accuracy: every method, precision and treatment of events.
    #[test]
    fn texts_of_the_pictures_keep_apart() {
        let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/accuracy/figure10/accuracy.csv");
        let (rows, devices) = read(&table);
        let figures = figures("A study", &rows, &devices).unwrap();
        assert_eq!(figures.len(), 5);
        for (name, svg) in figures {
            assert_drawn(&svg);
            assert!(name == "order" || svg.contains(">f64<") && svg.contains(">f32<"), "{name}");
        }
    }

    #[test]
    fn looks_distinguish_methods_events_and_precisions() {
        let families: Vec<Family> = variants(true, 0.0).iter().map(Variant::family).collect();
        for one in &families {
            for other in &families {
                let looks = (Colours::Methods.look(one), Colours::Methods.look(other));
                assert_eq!(looks.0.colour == looks.1.colour, one.method == other.method);
                assert_eq!(looks.0.dashes == looks.1.dashes, one.events == other.events);
                assert_eq!(looks.0.open == looks.1.open, one.number.precision() == other.number.precision());
            }
        }
    }
}
