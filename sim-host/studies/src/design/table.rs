//! The tables of a design: its lines, the delays that were tried, and what each motion asks for; the lines for people too.

use sprag_report::columns::{Column, FieldTable, Fields, Table};
use sprag_report::text_table::TextTable;
use sprag_shared::observers::checks::Extreme;
use sprag_shared::structure::block::GRAVITY;

use super::asked::Asked;
use super::late::Late;
use super::parts::Item;
use super::study::{Findings, PartsList};
use crate::sensitivity::motion::StudyMotion;

/// A row below the name of its device.
struct Named<'s, R> {
    device: &'s str,
    row: &'s R,
}

/// `parts`: one line of a list a row, in SI units but for those that the column `unit` names.
pub fn parts_table<'s>(findings: &'s Findings) -> impl Table + 's {
    let of_list = |list: &'s PartsList| list.items.iter().map(|row| Named { device: &list.device, row });
    let number = |name: &str| Column::number(name).or_nothing();
    let fields = Fields::<Named<'s, Item>>::default()
        .with(Column::text("device"), |row| row.device.into())
        .with(Column::text("part"), |row| row.row.part.into())
        .with(Column::text("quantity"), |row| row.row.quantity.into())
        .with(Column::text("unit").or_nothing(), |row| row.row.unit.into())
        .with(number("needed"), |row| row.row.needed.into())
        .with(number("chosen"), |row| row.row.chosen.into())
        .with(number("margin"), |row| row.row.margin.into())
        .with(Column::text("motion").or_nothing(), |row| row.row.motion.as_ref().into())
        .with(number("time_s"), |row| row.row.time_s.into())
        .with(Column::text("chosen_clutches"), |row| row.row.chosen_clutches.into());
    FieldTable { fields, rows: findings.lists.iter().flat_map(of_list).collect() }
}

/// `delays`: one delay of a device's clutches a row; rotations are max |θ|/α.
pub fn delay_table<'s>(findings: &'s Findings) -> impl Table + 's {
    let of_list = |list: &'s PartsList| {
        let tried = list.delay.iter().flat_map(|delay| &delay.tried);
        tried.map(|row| Named { device: &list.device, row })
    };
    let fields = Fields::<Named<'s, Late>>::default()
        .with(Column::text("device"), |row| row.device.into())
        .with(Column::number("delay_s"), |row| row.row.delay_s.into())
        .with(Column::count("overturned"), |row| row.row.overturned.into())
        .with(Column::count("newly_overturned"), |row| row.row.newly_overturned.into())
        .with(Column::count("failed"), |row| row.row.failed.into())
        .with(Column::number("largest_rotation").or_nothing(), |row| row.row.largest_rotation.into())
        .with(Column::text("allowed"), |row| row.row.allowed.into());
    FieldTable { fields, rows: findings.lists.iter().flat_map(of_list).collect() }
}

/// What a device asks for under one motion.
struct OfMotion<'s> {
    device: &'s str,
    motion: &'s str,
    asked: &'s Asked,
    weight: f64,
}

/// `motions`: one motion of a device a row; what has no run is left out. Forces are in N, of a block of `mass_kg`.
pub fn motion_table<'s>(findings: &'s Findings, motions: &'s [StudyMotion], mass_kg: f64) -> impl Table + 's {
    let weight = mass_kg * GRAVITY;
    let of_list = |list: &'s PartsList| {
        let of_motion = move |(motion, asked): (&'s StudyMotion, &'s Option<Asked>)| {
            Some(OfMotion { device: &list.device, motion: &motion.name, asked: asked.as_ref()?, weight })
        };
        motions.iter().zip(&list.asked).filter_map(of_motion)
    };
    let number = |name: &str| Column::number(name).or_nothing();
    let value = |extreme: Option<Extreme<f64>>| extreme.map(|extreme| extreme.value);
    let fields = Fields::<OfMotion<'s>>::default()
        .with(Column::text("device"), |row| row.device.into())
        .with(Column::text("motion"), |row| row.motion.into())
        .with(Column::text("outcome"), |row| row.asked.outcome.name().into())
        .with(number("peak_rotation"), |row| row.asked.peak_rotation.into())
        .with(number("support_force_n"), move |row| value(row.asked.located.support).map(|force| row.weight * force).into())
        .with(number("flywheel_force_n"), move |row| value(row.asked.located.drive).map(|force| row.weight * force).into())
        .with(number("travel_m"), move |row| value(row.asked.located.stroke).into())
        .with(Column::number("rack_speed_m_s"), |row| row.asked.rack_speed.value.into())
        .with(Column::number("rate_rad_s"), |row| row.asked.rate.value.into())
        .with(Column::number("block_acceleration_m_s2"), |row| row.asked.block_acceleration.value.into())
        .with(Column::number("ground_acceleration_m_s2"), |row| row.asked.ground_acceleration.value.into())
        .with(number("coils_engaged_s"), |row| row.asked.coils.map(|coils| coils.engaged_s).into())
        .with(number("friction_needed"), |row| row.asked.friction_needed.into());
    FieldTable { fields, rows: findings.lists.iter().flat_map(of_list).collect() }
}

/// The lines of a list for people.
pub fn lines(list: &PartsList) -> TextTable {
    let mut table = TextTable::new(3, ["part", "quantity", "unit", "needed", "chosen", "margin", "limited by"]).ending_in_words();
    for item in &list.items {
        let (unit, factor) = readable(item.unit, item.chosen.or(item.needed).unwrap_or(0.0));
        let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| figures(factor * value));
        let time = item.time_s.map_or_else(String::new, |time| format!(" at {time:.2} s"));
        let chosen = if item.chosen_clutches { ", chosen clutches" } else { "" };
        table.row(vec![
            item.part.to_owned(),
            item.quantity.to_owned(),
            unit.to_owned(),
            number(item.needed),
            number(item.chosen),
            item.margin.map_or_else(
                || "-".to_owned(),
                |margin| if margin < 100.0 { format!("{margin:.2}") } else { format!("{margin:.0}") },
            ),
            item.motion.as_ref().map_or_else(|| "-".to_owned(), |motion| format!("{motion}{time}{chosen}")),
        ]);
    }
    table
}

/// A unit in which `value` is a number that people read, and the factor to it.
fn readable(unit: &'static str, value: f64) -> (&'static str, f64) {
    match unit {
        "N" if value >= 1e3 => ("kN", 1e-3),
        "m" if value < 10.0 => ("mm", 1e3),
        "s" if value < 1.0 => ("ms", 1e3),
        "J" if value >= 1e4 => ("kJ", 1e-3),
        _ => (unit, 1.0),
    }
}

/// `value` in at least four figures, without an exponent where that reads well.
pub fn figures(value: f64) -> String {
    if value == 0.0 || value.fract() == 0.0 && value.abs() < 1e6 {
        return format!("{value}");
    }
    if !(1e-4..1e7).contains(&value.abs()) {
        return format!("{value:.3e}");
    }
    let decimals = (3 - sprag_shared::math::log10(value.abs()).floor() as i32).clamp(0, 7) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_figures_and_units_that_people_read() {
        let shown =
            [(8.0, "8"), (0.25, "0.25"), (12.345_67, "12.35"), (1234.56, "1235"), (0.000_123_46, "0.0001235"), (1e9, "1.000e9")];
        for (value, text) in shown {
            assert_eq!(figures(value), text);
        }
        assert_eq!((readable("N", 2.5e4), readable("m", 0.25), readable("s", 12.0)), (("kN", 1e-3), ("mm", 1e3), ("s", 1.0)));
    }
}
