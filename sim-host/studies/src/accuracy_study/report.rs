//! The tables of a study.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::row::{Row, order};
use super::variant::{Family, Number, Setting};

/// Writes every row as CSV.
///
/// # Errors
/// Those of `out`.
pub fn write_csv(rows: &[Row], devices: &[String], out: impl Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    for row in rows {
        table.serialize(row.text(&devices[row.device])).map_err(io::Error::other)?;
    }
    table.flush()
}

/// Errors from which an order is read: above rounding.
fn floor(number: Number) -> f64 {
    match number.precision() {
        "f64" => 1e-12,
        _ => 1e-5,
    }
}

/// A table in Markdown for every device: what each family of variants needs to be this accurate, and where it ends.
pub fn page(title: &str, rows: &[Row], devices: &[String]) -> String {
    let mut page = format!("# {title}: what accuracy costs\n");
    for (index, device) in devices.iter().enumerate() {
        let of_device: Vec<&Row> = rows.iter().filter(|row| row.device == index).collect();
        let mut families: Vec<Family> = Vec::new();
        for row in &of_device {
            if !families.contains(&row.variant.family()) {
                families.push(row.variant.family());
            }
        }
        let fastest = of_device.iter().map(|row| row.nanoseconds).fold(f64::INFINITY, f64::min);
        let _ = writeln!(page, "\n## {device}\n");
        let _ =
            writeln!(page, "| method | order | 1e-2 | 1e-4 | 1e-6 | 1e-9 | smallest error | wrong outcomes | cycles a step |");
        let _ = writeln!(page, "| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
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
            let _ = writeln!(
                page,
                "| {family} | {order} | {} | {} | {} | {} | {smallest} | {wrong} | {cycles} |",
                cost(1e-2),
                cost(1e-4),
                cost(1e-6),
                cost(1e-9),
            );
        }
        let _ = writeln!(page, "\nTimes are multiples of the fastest run, {fastest:.0} ns to a simulated second.");
    }
    page
}
