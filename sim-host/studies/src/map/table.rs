//! A map as a table: one row a cell and device.

use csv::StringRecord;
use sprag_ensemble::pulsed::PulseResult;
use sprag_report::columns::{Column, NumberText, TableError};
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::csv_field::quoted;

use sprag_sim::map::grid::Grid;

/// `device`, the keys of the axes, `outcome`, `peak_rotation` and `peak_acceleration`: peaks max|θ|/α and max|θ̈|/(p²α), empty when
/// overturned, the latter of closed loops too; numbers read back to the same f64. Devices one after another, of each cells row by row from
/// the lowest, each from the left.
pub fn columns(grid: &Grid) -> Vec<Column> {
    let mut columns = vec![Column::text("device"), Column::number(&grid.map.x.key)];
    columns.extend(grid.map.y.iter().map(|y| Column::number(&y.key)));
    columns.push(Column::text("outcome"));
    columns.extend(["peak_rotation", "peak_acceleration"].map(|name| Column::number(name).or_nothing()));
    columns
}

/// What says of a row which cell it is: put into words once, since a map has many more rows than names and values.
#[derive(Clone, Debug)]
pub struct Labels {
    devices: Vec<String>,
    /// Their fields in a CSV file.
    quoted: Vec<String>,
    /// Whether they are in closed loop, where nobody looks for the peak acceleration.
    by_law: Vec<bool>,
    x: Vec<String>,
    /// Empty in a cut.
    y: Vec<String>,
}

impl Labels {
    /// Table of the cells of `grid`.
    ///
    /// # Errors
    /// When a name cannot be written.
    pub fn new(grid: &Grid) -> Result<Labels, TableError> {
        let devices: Vec<String> = grid.mapped().iter().map(|mapped| mapped.name.clone()).collect();
        Ok(Labels {
            quoted: devices.iter().map(|name| quoted(name)).collect::<Result<_, _>>()?,
            devices,
            by_law: grid.mapped().iter().map(|mapped| mapped.law.is_some()).collect(),
            x: (0..grid.columns()).map(|column| format!("{:?}", grid.map.x.value(column))).collect(),
            y: grid.map.y.iter().flat_map(|y| (0..y.cells).map(|row| format!("{:?}", y.value(row)))).collect(),
        })
    }

    /// Number of the device, x and y of row number `row`.
    fn of(&self, row: usize) -> (usize, &str, Option<&str>) {
        let (columns, rows) = (self.x.len(), self.y.len().max(1));
        let up = self.y.get(row / columns % rows).map(String::as_str);
        (row / (columns * rows), &self.x[row % columns], up)
    }

    /// Writes row number `row` to the end of `out`.
    pub fn write(&self, row: usize, result: &PulseResult, out: &mut Vec<u8>) {
        let (device, x, y) = self.of(row);
        out.extend_from_slice(self.quoted[device].as_bytes());
        for label in [Some(x), y, Some(result.outcome.name())].into_iter().flatten() {
            out.push(b',');
            out.extend_from_slice(label.as_bytes());
        }
        let PulseResult { outcome, peak_rotation, peak_acceleration } = *result;
        let mut text = NumberText::default();
        for peak in [peak_rotation, peak_acceleration] {
            out.push(b',');
            if !outcome.overturned() && !peak.is_nan() {
                out.extend_from_slice(text.of(peak).as_bytes());
            }
        }
        out.push(b'\n');
    }

    /// What row number `row` says.
    ///
    /// # Errors
    /// When it is another cell's, or no row of a map.
    pub fn read(&self, row: usize, record: &StringRecord) -> Result<PulseResult, String> {
        let (device, x, y) = self.of(row);
        let mut fields = record.iter();
        let mut next = || fields.next().unwrap_or_default();
        for label in [Some(self.devices[device].as_str()), Some(x), y].into_iter().flatten() {
            let field = next();
            if field != label {
                return Err(format!("`{field}` should be {label}"));
            }
        }
        let name = next();
        let outcome = Outcome::from_name(name).ok_or_else(|| format!("`{name}` is no outcome"))?;
        let mut peak = |nothing: bool| match next() {
            "" if nothing || outcome.overturned() => Ok(f64::NAN),
            text => text.parse().map_err(|_| format!("`{text}` is no peak of a block with the outcome {outcome}")),
        };
        Ok(PulseResult { outcome, peak_rotation: peak(false)?, peak_acceleration: peak(self.by_law[device])? })
    }
}
