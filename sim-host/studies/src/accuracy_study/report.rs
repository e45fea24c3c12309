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
    Fields::<&'s RowText<'s>>::default()
        .with(Column::text("device"), |row| row.device.into())
        .with(Column::text("method"), |row| row.method.into())
        .with(Column::text("events"), |row| row.events.into())
        .with(Column::text("precision"), |row| row.precision.into())
        .with(Column::text("math"), |row| row.math.into())
        .with(Column::text("setting"), |row| row.setting.into())
        .with(Column::number("value"), |row| row.value.into())
        .with(Column::text("outcome_right"), |row| row.outcome_right.into())
        .with(number("peak_rotation_error"), |row| row.peak_rotation_error.into())
        .with(number("history_error"), |row| row.history_error.into())
        .with(number("wrong_outcome_share"), |row| row.wrong_outcome_share.into())
        .with(Column::number("steps_per_s"), |row| row.steps_per_s.into())
        .with(Column::number("nanoseconds_per_s"), |row| row.nanoseconds_per_s.into())
        .with(Column::count("board_instructions_per_step").or_nothing(), |row| row.board_instructions_per_step.into())
        .with(number("board_cycles_per_step"), |row| row.board_cycles_per_step.into())
        .with(Column::text("on_pareto_front"), |row| row.on_pareto_front.into())
}

/// Errors from which an order is read: above rounding.
fn floor(number: Number) -> f64 {
    match number.precision() {
        "f64" => 1e-12,
        _ => 1e-5,
    }
}

/// The time of the fastest of `settings`, from the coarsest to the closest, that keeps `error` as every closer one does. Closer ones may be worse
/// by their roundings.
fn time_for(error: f64, settings: &[&Row]) -> Option<f64> {
    let keeps = |row: &Row, error: f64| row.peak_error.is_some_and(|own| own <= error);
    let trusted = settings.iter().rev().take_while(|row| keeps(row, error.max(floor(row.variant.family.number))));
    trusted.filter(|row| keeps(row, error)).map(|row| row.nanoseconds).reduce(f64::min)
}

/// A table for every device: what each family of variants needs to be this accurate, and where it ends.
pub fn page(title: &str, rows: &[Row], devices: &[String]) -> Page {
    let mut page = Page::new(&format!("{title}: what accuracy costs"));
    for (index, device) in devices.iter().enumerate() {
        let of_device: Vec<&Row> = rows.iter().filter(|row| row.device == index).collect();
        let mut families: Vec<Family> = Vec::new();
        for row in &of_device {
            if !families.contains(&row.variant.family) {
                families.push(row.variant.family);
            }
        }
        let fastest = of_device.iter().map(|row| row.nanoseconds).fold(f64::INFINITY, f64::min);
        page.section(device);
        let headings = ["method", "order", "1e-2", "1e-4", "1e-6", "1e-9", "smallest error", "wrong outcomes", "cycles a step"];
        let mut table = TextTable::new(1, headings);
        for family in families {
            let own: Vec<&Row> = of_device.iter().copied().filter(|row| row.variant.family == family).collect();
            let points = own.iter().filter_map(|row| match row.variant.setting {
                Setting::Step(step) => Some((step, row.history_error?)),
                Setting::Tolerance(_) => None,
            });
            let order = order(points, floor(family.number)).map_or_else(|| "-".to_owned(), |order| format!("{order:.1}"));
            let cost = |error: f64| time_for(error, &own).map_or_else(|| "-".to_owned(), |time| format!("{:.1}", time / fastest));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy_study::variant::variants;

    /// Settings with these errors, each twice as slow as the one before.
    fn time(number: Number, error: f64, errors: &[Option<f64>]) -> Option<f64> {
        let variant = variants(false, 1e-2).into_iter().find(|variant| variant.family.number == number).unwrap();
        let row = |(index, &peak_error): (usize, &Option<f64>)| Row {
            device: 0,
            variant,
            outcome_right: true,
            peak_error,
            history_error: None,
            wrong_share: None,
            steps_per_second: 1.0,
            nanoseconds: f64::from(1_u32 << index),
            board: None,
            on_front: false,
        };
        let rows: Vec<Row> = errors.iter().enumerate().map(row).collect();
        time_for(error, &rows.iter().collect::<Vec<_>>())
    }

    #[test]
    fn a_setting_that_is_right_by_luck_does_not_count() {
        let errors = [None, Some(7e-3), Some(2e-2), Some(6e-3), Some(5e-5)];
        assert_eq!(
            [1e-1, 1e-2, 1e-4, 1e-6].map(|error| time(Number::F64Libm, error, &errors)),
            [Some(2.0), Some(8.0), Some(16.0), None]
        );
        // The one that overturned, too.
        assert_eq!(time(Number::F64Libm, 1e-2, &[Some(9e-3), None, Some(8e-3)]), Some(4.0));
        assert_eq!(time(Number::F64Libm, 1e-2, &[Some(9e-3), None]), None);
    }

    #[test]
    fn roundings_of_closer_settings_take_nothing_from_one() {
        let errors = [Some(2e-3), Some(4e-7), Some(7e-6)];
        assert_eq!(time(Number::F32Own, 1e-6, &errors), Some(2.0));
        assert_eq!(time(Number::F64Libm, 1e-6, &errors), None);
        assert_eq!(time(Number::F32Own, 1e-6, &[Some(4e-7), Some(7e-5)]), None);
    }
}
