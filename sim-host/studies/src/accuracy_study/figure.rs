//! Work-precision diagrams: the error against what it costs.

use sprag_report::plot::{Chart, ChartKey, ChartPanel, FigureTitle, Line, PlotError, Scale, chart_figure};
use sprag_sim::scene::accuracy::EventTreatment;

use super::looks::{Colours, METHODS, SOURCES};
use super::row::Row;
use super::variant::{Family, Method, Number, Setting};

/// Errors below this are drawn at it: a result may be exact by chance.
const SMALLEST_ERROR: f64 = 1e-17;

/// A figure of a study.
struct Plan {
    /// Name of its file without the ending.
    name: &'static str,
    /// What it shows, behind the title of the study.
    shows: &'static str,
    /// Titles of its axes.
    axes: [&'static str; 2],
    /// The families in it.
    wanted: fn(&Family) -> bool,
    /// What its colours stand for.
    colours: Colours,
    /// What is drawn against what.
    point: fn(&Row) -> Option<(f64, f64)>,
    /// Smallest height of a point: lower ones are drawn at it; 0 leaves out those that are not above it.
    least: f64,
}

impl Plan {
    /// The rows that have a point, with it.
    fn points<'a>(&self, rows: &'a [Row]) -> impl Iterator<Item = (&'a Row, (f64, f64))> {
        let wanted = rows.iter().filter(|row| (self.wanted)(&row.variant.family));
        wanted.filter_map(|row| Some((row, (self.point)(row)?)))
    }

    /// Those that are drawn.
    fn drawn<'a>(&self, rows: &'a [Row]) -> impl Iterator<Item = (&'a Row, (f64, f64))> {
        self.points(rows).map(|(row, (x, y))| (row, (x, y.max(self.least)))).filter(|(_, (_, y))| *y > 0.0)
    }

    /// What to say of the points that are not where they belong, which a logarithmic axis cannot show.
    fn note(&self, rows: &[Row]) -> Option<String> {
        match self.points(rows).filter(|(_, (_, y))| *y < self.least || *y == 0.0).count() {
            0 => None,
            count if self.least > 0.0 => Some(format!("{count} errors below {:e} are drawn at it", self.least)),
            count => Some(format!("{count} points at 0 are not drawn")),
        }
    }

    /// The line of every family, in each device's panel; with the front where time is what errors cost.
    fn panels(&self, rows: &[Row], devices: &[String]) -> Vec<ChartPanel> {
        let panel = |(index, name): (usize, &String)| {
            let mut lines: Vec<(Family, Line)> = Vec::new();
            for (row, point) in self.drawn(rows).filter(|(row, _)| row.device == index) {
                let family = row.variant.family;
                let known = lines.iter().position(|(known, _)| *known == family).unwrap_or_else(|| {
                    let (name, label) = (family.to_string(), family.to_string());
                    lines.push((
                        family,
                        Line { name, label, look: Some(self.colours.look(&family)), marks: true, ..Line::default() },
                    ));
                    lines.len() - 1
                });
                lines[known].1.points.push(point);
            }
            let mut lines: Vec<Line> = lines.into_iter().map(|(_, line)| line).collect();
            if self.name == WORK_PRECISION && !lines.is_empty() {
                lines.push(front(rows, index));
            }
            ChartPanel { title: name.clone(), y_title: self.axes[1].to_owned(), y: Scale::Logarithmic, lines }
        };
        devices.iter().enumerate().map(panel).filter(|panel| !panel.lines.is_empty()).collect()
    }

    /// What the looks of the lines stand for.
    fn keys(&self, rows: &[Row]) -> Vec<Vec<ChartKey>> {
        let families: Vec<Family> = self.drawn(rows).map(|(row, _)| row.variant.family).collect();
        let any = |is: &dyn Fn(&Family) -> bool| families.iter().any(is);
        let mut rows = [Vec::new(), Vec::new()];
        match self.colours {
            Colours::Methods => {
                let used = METHODS.iter().enumerate().filter(|(_, (method, _))| any(&|family| family.method == *method));
                rows[0].extend(used.map(|(index, (_, name))| ChartKey::Colour(index, (*name).to_owned())));
                let treatments = [(EventTreatment::Located, "events located"), (EventTreatment::StepEnd, "events at step ends")];
                let used = treatments.iter().enumerate().filter(|(_, (events, _))| any(&|family| family.events == *events));
                rows[1].extend(used.map(|(index, (_, name))| ChartKey::Dashes(index, (*name).to_owned())));
            }
            Colours::Sources => {
                let used = SOURCES.iter().enumerate().filter(|(_, source)| any(&|family| family.number.math() == **source));
                rows[0]
                    .extend(used.map(|(index, source)| ChartKey::Colour(index, format!("sine: {}", source.replace('-', " ")))));
            }
        }
        let precisions = [(false, "f64"), (true, "f32")];
        let used = precisions.iter().filter(|(_, precision)| any(&|family| family.number.precision() == *precision));
        rows[1].extend(used.map(|(open, precision)| ChartKey::Marks(*open, (*precision).to_owned())));
        rows.to_vec()
    }

    /// The figure; none where nothing can be drawn.
    fn figure(&self, title: &str, rows: &[Row], devices: &[String]) -> Option<Result<Figure, PlotError>> {
        let panels = self.panels(rows, devices);
        let columns = panels.len().min(2);
        let title = FigureTitle { text: format!("{title}: {}", self.shows), conditions: self.note(rows).into_iter().collect() };
        let (x_title, x, keys) = (self.axes[0].to_owned(), Scale::Logarithmic, self.keys(rows));
        let chart = Chart { title, x_title, x, panels, columns, keys, ..Chart::default() };
        (!chart.panels.is_empty()).then(|| Ok((self.name, chart_figure(&chart)?)))
    }
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

/// A figure by the name of its file without the ending.
pub type Figure = (&'static str, String);

/// All figures of a study; those that nothing can be drawn in are left out.
pub fn figures(title: &str, rows: &[Row], devices: &[String]) -> Result<Vec<Figure>, PlotError> {
    PLANS.iter().filter_map(|plan| plan.figure(title, rows, devices)).collect()
}

const WORK_PRECISION: &str = "work_precision";
const PEAK_ERROR: &str = "error of max |*θ*|/α";
const HISTORY_ERROR: &str = "max |Δ*θ*|/α";
const HOST_TIME: &str = "host: ns to a simulated second";
const STEP: &str = "step in 1/*p*";

const PLANS: [Plan; 5] = [
    Plan {
        name: WORK_PRECISION,
        shows: "error against time",
        axes: [HOST_TIME, PEAK_ERROR],
        wanted: own,
        colours: Colours::Methods,
        point: |row| Some((row.nanoseconds, row.peak_error?)),
        least: SMALLEST_ERROR,
    },
    Plan {
        name: "order",
        shows: "error of the history against the step",
        axes: [STEP, HISTORY_ERROR],
        wanted: |family| family.number == Number::F64Libm,
        colours: Colours::Methods,
        point: by_step,
        least: SMALLEST_ERROR,
    },
    Plan {
        name: "sines",
        shows: "precision and source of the sine",
        axes: [STEP, HISTORY_ERROR],
        wanted: |family| family.method == Method::RungeKutta4 && family.events == EventTreatment::StepEnd,
        colours: Colours::Sources,
        point: by_step,
        least: SMALLEST_ERROR,
    },
    Plan {
        name: "wrong_outcomes",
        shows: "outcomes gone wrong",
        axes: [HOST_TIME, "share of cells"],
        wanted: own,
        colours: Colours::Methods,
        point: |row| Some((row.nanoseconds, row.wrong_share?)),
        least: 0.0,
    },
    Plan {
        name: "board",
        shows: "error against time on the board",
        axes: ["Cortex-M4F: cycles to a simulated second", PEAK_ERROR],
        wanted: |_| true,
        colours: Colours::Methods,
        point: |row| Some((row.board?.cycles() * row.steps_per_second, row.peak_error?)),
        least: SMALLEST_ERROR,
    },
];

fn own(family: &Family) -> bool {
    matches!(family.number, Number::F64Libm | Number::F32Own)
}

fn by_step(row: &Row) -> Option<(f64, f64)> {
    match row.variant.setting {
        Setting::Step(step) => Some((step, row.history_error?)),
        Setting::Tolerance(_) => None,
    }
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
                let family = variant.family;
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
            // What a logarithmic axis cannot show is said, and what is not drawn is not in the legend.
            let note = match name {
                WORK_PRECISION => Some(">3 errors below 1e-17 are drawn at it<"),
                "wrong_outcomes" => Some(">134 points at 0 are not drawn<"),
                _ => None,
            };
            assert!(note.is_none_or(|note| svg.contains(note)), "{name}");
            assert_eq!(svg.contains(">closed form<"), matches!(name, WORK_PRECISION | "order" | "board"), "{name}");
        }
    }
}
