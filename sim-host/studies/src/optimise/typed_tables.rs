//! The tables of an optimisation for programs, as CSV and Parquet: one row a design, and one row a motion.

use sprag_report::columns::{Column, FieldTable, Fields, Shown, Table};
use sprag_report::long_run::row_fields::FAILED;

use super::design::Design;
use super::findings::{Findings, Row};
use super::motion::Motion;
use super::problem::{Problem, Solution};
use super::response::Response;

/// A design, and what it is among those of its table.
struct NamedRow<'s> {
    name: &'s str,
    design: &'s Row,
}

/// `designs`: the bare block, then every device that was tried, by law, mount and mass ratio.
pub fn design_table(findings: &Findings) -> impl Table {
    let rows = std::iter::once(&findings.reference).chain(&findings.rows).map(|design| NamedRow { name: "", design });
    let rows: Vec<NamedRow<'_>> = rows.collect();
    FieldTable { fields: design_fields(Fields::default(), &rows), rows }
}

/// Designs for people, each below its name where any has one.
pub(super) fn named_table<'s>(rows: Vec<(&'s str, &'s Row)>) -> impl Table + 's {
    let rows: Vec<NamedRow<'s>> = rows.into_iter().map(|(name, design)| NamedRow { name, design }).collect();
    let mut first = Fields::<NamedRow<'s>>::default();
    if rows.iter().any(|row| !row.name.is_empty()) {
        first = first.with(Column::text("name").shown("", Shown::Digits(0)), |row| row.name.into());
    }
    FieldTable { fields: design_fields(first, &rows), rows }
}

/// The columns of designs, after those of `first`. What none of `rows` has gets no column.
fn design_fields<'s>(first: Fields<NamedRow<'s>>, rows: &[NamedRow<'s>]) -> Fields<NamedRow<'s>> {
    let (number, digits) = (|name: &str| Column::number(name).or_nothing(), Shown::Digits);
    let mut fields = first
        .with(Column::text("law").shown("law", digits(0)), |row| (&row.design.law).into())
        .with(Column::text("mount").or_nothing().shown("mount", digits(0)), |row| row.design.mount.as_ref().into())
        .with(number("mass_ratio").shown("σ", digits(4)), |row| row.design.mass_ratio.into())
        .with(Column::count("motions"), |row| row.design.motions.into())
        .with(Column::count("overturned").shown("overturned", digits(0)), |row| row.design.overturned.into())
        .with(Column::count("failed"), |row| row.design.failed.into())
        .with(Column::number("probability").shown("share", Shown::Percent), |row| row.design.probability.into())
        .with(Column::number("probability_low").shown("from", Shown::Percent), |row| row.design.probability_band.low.into())
        .with(Column::number("probability_high").shown("to", Shown::Percent), |row| row.design.probability_band.high.into())
        .with(Column::count("saved").shown("saved", digits(0)), |row| row.design.saved.into())
        .with(Column::count("newly_overturned").shown("newly", digits(0)), |row| row.design.newly_overturned.into())
        .with(number("peak_force_ratio").shown("F/(mg)", digits(4)), |row| row.design.peak_force_ratio.into())
        .with(number("stroke_m").shown("stroke (m)", digits(4)), |row| row.design.stroke_m.into())
        .with(number("median_peak_rotation").shown("median θ/α", digits(3)), |row| row.design.median_peak_rotation.into())
        .with(Column::text("feasible"), |row| row.design.feasible.into())
        .with(Column::text("on_force_front"), |row| row.design.on_force_front.into())
        .with(Column::text("on_stroke_front"), |row| row.design.on_stroke_front.into());
    if rows.iter().any(|row| row.design.tooth_stress_mpa.is_some()) {
        fields =
            fields.with(number("tooth_stress_mpa").shown("teeth (MPa)", digits(1)), |row| row.design.tooth_stress_mpa.into());
    }
    if rows.iter().any(|row| row.design.coil_energy_j.is_some()) {
        fields = fields.with(number("coil_energy_j").shown("coils (J)", digits(1)), |row| row.design.coil_energy_j.into());
    }
    fields
}

/// A motion under a design.
struct MotionRow<'s> {
    motion: &'s Motion<'s>,
    design: &'s Design,
    response: &'s Result<Response, String>,
    /// Number of the specimen, and its η.
    specimen: usize,
    restitution: Option<f64>,
}

impl MotionRow<'_> {
    fn answer(&self) -> Option<&Response> {
        self.response.as_ref().ok()
    }
}

/// `motions`: every motion under the bare block and under the chosen device, if there is one. Peaks are max |θ|/α, empty when overturned;
/// forces and strokes are those of this one motion.
pub fn motion_table<'s>(problem: &'s Problem<'s>, solution: &'s Solution, chosen: Option<&Row>) -> impl Table + use<'s> {
    let of_chosen = |design: &&Design| chosen.is_some_and(|row| row.candidate == design.candidate);
    let chosen = solution.designs.iter().find(of_chosen);
    let designs = std::iter::once(&solution.bare).chain(chosen);
    let designs: Vec<_> = designs.map(|design| (design, problem.restitutions(design.candidate))).collect();
    let (motions, several) = (problem.motions.len(), problem.specimens.len() > 1);
    let mut rows = Vec::new();
    for index in 0..problem.trials() {
        let (motion, specimen) = (&problem.motions[index % motions], index / motions);
        let row = |(design, restitutions): &(&'s Design, Vec<Option<f64>>)| MotionRow {
            motion,
            design,
            response: &design.responses[index],
            specimen,
            restitution: restitutions[specimen],
        };
        rows.extend(designs.iter().map(row));
    }
    FieldTable { fields: motion_fields(several), rows }
}

/// The columns of motions, with those of `several` specimens.
fn motion_fields<'s>(several: bool) -> Fields<MotionRow<'s>> {
    let number = |name: &str| Column::number(name).or_nothing();
    let fields = Fields::<MotionRow<'s>>::default()
        .with(Column::text("record"), |row| (&row.motion.name).into())
        .with(Column::number("scale"), |row| row.motion.factor.into())
        .with(number("level"), |row| row.motion.level.into())
        .with(Column::text("device"), |row| if row.design.candidate.is_none() { "none" } else { "chosen" }.into())
        .with(Column::text("outcome"), |row| row.answer().map_or(FAILED, |response| response.outcome.name()).into())
        .with(number("peak_rotation"), |row| row.answer().and_then(|response| response.peak_rotation).into())
        .with(number("peak_force_ratio"), |row| row.answer().map(|response| response.force_ratio).into())
        .with(number("stroke_m"), |row| {
            row.answer().filter(|_| row.design.candidate.is_some()).map(|response| response.stroke_m).into()
        })
        .with(Column::text("failure").or_nothing(), |row| row.response.as_ref().err().into());
    if !several {
        return fields;
    }
    fields.with(Column::count("specimen"), |row| row.specimen.into()).with(number("restitution"), |row| row.restitution.into())
}
