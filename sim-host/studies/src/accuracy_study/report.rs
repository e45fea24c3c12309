//! The tables of a study.

use sprag_report::columns::{Column, FieldTable, Fields, Table};
use sprag_report::page::Page;
use sprag_report::text_table::TextTable;

use super::row::{Row, RowText, order};
use super::variant::{Family, Number, Setting};

/// `accuracy`: one device, followed in one way, a row.
pub fn row_table<'s>(rows: &'s [RowText<'s>]) -> impl Table {
    FieldTable { fields: fields(), rows: rows.iter().collect() }
}

fn fields<'s>() -> Fields<&'s RowText<'s>> {
    let number = |name: &str| Column::number(name).or_nothing();
    let truth = |truth: bool| if truth { "true" } else { "false" };
    Fields::<&'s RowText<'s>>::default()
        .with(Column::text("device"), |row| row.device.into())
        .with(Column::text("method"), |row| row.method.into())
        .with(Column::text("events"), |row| row.events.into())
        .with(Column::text("precision"), |row| row.precision.into())
        .with(Column::text("math"), |row| row.math.into())
        .with(Column::text("setting"), |row| row.setting.into())
        .with(Column::number("value"), |row| row.value.into())
        .with(Column::text("outcome_right"), move |row| truth(row.outcome_right).into())
        .with(number("peak_rotation_error"), |row| row.peak_rotation_error.into())
        .with(number("history_error"), |row| row.history_error.into())
        .with(number("wrong_outcome_share"), |row| row.wrong_outcome_share.into())
        .with(Column::number("steps_per_s"), |row| row.steps_per_s.into())
        .with(Column::number("nanoseconds_per_s"), |row| row.nanoseconds_per_s.into())
        .with(Column::count("board_instructions_per_step").or_nothing(), |row| row.board_instructions_per_step.into())
        .with(number("board_cycles_per_step"), |row| row.board_cycles_per_step.into())
        .with(Column::text("on_pareto_front"), move |row| truth(row.on_pareto_front).into())
}

/// Errors from which an order is read: above rounding.
fn floor(number: Number) -> f64 {
    match number.precision() {
        "f64" => 1e-12,
        _ => 1e-5,
    }
}

/// A table for every device: what each family of variants needs to be this accurate, and where it ends.
pub fn page(title: &str, rows: &[Row], devices: &[String]) -> Page {
    let mut page = Page::new(&format!("{title}: what accuracy costs"));
    for (index, device) in devices.iter().enumerate() {
        let of_device: Vec<&Row> = rows.iter().filter(|row| row.device == index).collect();
        let mut families: Vec<Family> = Vec::new();
        for row in &of_device {
            if !families.contains(&row.variant.family()) {
                families.push(row.variant.family());
            }
        }
        let fastest = of_device.iter().map(|row| row.nanoseconds).fold(f64::INFINITY, f64::min);
        page.section(device);
        let headings = ["method", "order", "1e-2", "1e-4", "1e-6", "1e-9", "smallest error", "wrong outcomes", "cycles a step"];
        let mut table = TextTable::new(1, headings);
        for family in families {
            let own: Vec<&Row> = of_device.iter().copied().filter(|row| row.variant.family() == family).collect();
            let points = own.iter().filter_map(|row| match row.variant.setting {
                Setting::Step(step) => Some((step, row.history_error?)),
                Setting::Tolerance(_) => None,
            });
            let order = order(points, floor(family.number)).map_or_else(|| "-".to_owned(), |order| format!("{order:.1}"));
            // The cheapest setting from which on every closer one keeps the error.
            let cost = |error: f64| {
                let kept = |row: &&&Row| row.peak_error.is_some_and(|own| own <= error);
                own.iter()
                    .filter(kept)
                    .map(|row| row.nanoseconds)
                    .reduce(f64::min)
                    .map_or_else(|| "-".to_owned(), |time| format!("{:.1}", time / fastest))
            };
            let smallest = own.iter().filter_map(|row| row.peak_error).reduce(f64::min);
            let smallest = smallest.map_or_else(|| "-".to_owned(), |error| format!("{error:.0e}"));
            let wrong = own.iter().filter_map(|row| row.wrong_share);
            let wrong =
                wrong.fold(None, |range: Option<(f64, f64)>, w| Some(range.map_or((w, w), |(l, h)| (l.min(w), h.max(w)))));
            let wrong =
                wrong.map_or_else(|| "-".to_owned(), |(low, high)| format!("{:.1} to {:.1} %", 100.0 * low, 100.0 * high));
            let cycles =
                own.iter().find_map(|row| row.board).map_or_else(|| "-".to_owned(), |cost| format!("{:.0}", cost.cycles()));
            let costs = [1e-2, 1e-4, 1e-6, 1e-9].map(cost);
            table.row([&[family.to_string(), order][..], &costs, &[smallest, wrong, cycles]].concat());
        }
        page.table(table);
        page.paragraph(&format!("Times are multiples of the fastest run, {fastest:.0} ns to a simulated second."));
    }
    page
}
