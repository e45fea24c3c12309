//! A map as a table: one row a cell and device.

use csv::StringRecord;

use super::grid::Grid;
use crate::ensemble::pulses::PulseResult;
use crate::outcome::Outcome;

/// `device,<keys of the axes>,outcome,peak_rotation,peak_acceleration`: peaks max|θ|/α and max|θ̈|/(p²α), empty when overturned; numbers
/// read back to the same f64. Devices one after another, of each cells row by row from the lowest, each from the left.
pub fn columns(grid: &Grid) -> Vec<String> {
    let mut columns = vec!["device".to_owned(), grid.map.x.key.clone()];
    columns.extend(grid.map.y.iter().map(|y| y.key.clone()));
    columns.extend(["outcome", "peak_rotation", "peak_acceleration"].map(str::to_owned));
    columns
}

/// What says of a row which cell it is.
#[derive(Clone, Debug)]
pub struct Labels {
    devices: Vec<String>,
    x: Vec<String>,
    /// Empty in a cut.
    y: Vec<String>,
}

impl Labels {
    /// Of the cells of `grid`.
    pub fn new(grid: &Grid) -> Labels {
        Labels {
            devices: grid.scene.devices.iter().map(|device| device.name.clone()).collect(),
            x: (0..grid.columns()).map(|column| format!("{:?}", grid.map.x.value(column))).collect(),
            y: grid.map.y.iter().flat_map(|y| (0..y.cells).map(|row| format!("{:?}", y.value(row)))).collect(),
        }
    }

    /// Device, x and y of row number `row`.
    fn of(&self, row: usize) -> (&str, &str, Option<&str>) {
        let (columns, rows) = (self.x.len(), self.y.len().max(1));
        let up = self.y.get(row / columns % rows).map(String::as_str);
        (&self.devices[row / (columns * rows)], &self.x[row % columns], up)
    }

    /// Writes row number `row` to the end of `out`.
    pub fn write(&self, row: usize, result: &PulseResult, out: &mut Vec<u8>) {
        let (device, x, y) = self.of(row);
        out.extend_from_slice(quoted(device).as_bytes());
        for label in [Some(x), y, Some(result.outcome.name())].into_iter().flatten() {
            out.push(b',');
            out.extend_from_slice(label.as_bytes());
        }
        let peaks = if result.outcome.overturned() {
            ",,\n".to_owned()
        } else {
            format!(",{:?},{:?}\n", result.peak_rotation, result.peak_acceleration)
        };
        out.extend_from_slice(peaks.as_bytes());
    }

    /// What row number `row` says.
    ///
    /// # Errors
    /// When it is another cell's, or no row of a map.
    pub fn read(&self, row: usize, record: &StringRecord) -> Result<PulseResult, String> {
        let (device, x, y) = self.of(row);
        let mut fields = record.iter();
        let mut next = || fields.next().unwrap_or_default();
        for label in [Some(device), Some(x), y].into_iter().flatten() {
            let field = next();
            if field != label {
                return Err(format!("`{field}` should be {label}"));
            }
        }
        let name = next();
        let outcome = Outcome::from_name(name).ok_or_else(|| format!("`{name}` is no outcome"))?;
        let mut peak = || match next() {
            "" if outcome.overturned() => Ok(f64::NAN),
            text => text.parse().map_err(|_| format!("`{text}` is no peak of a block with the outcome {outcome}")),
        };
        Ok(PulseResult { outcome, peak_rotation: peak()?, peak_acceleration: peak()? })
    }
}

/// A field of a CSV file.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_with_commas_are_quoted() {
        assert_eq!(quoted("pair (σ = 0.5)"), "pair (σ = 0.5)");
        assert_eq!(quoted("a, \"b\""), "\"a, \"\"b\"\"\"");
    }
}
