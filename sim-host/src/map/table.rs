//! A map as a table: one row a cell and device.

use std::io::{self, Write};

use super::grid::Grid;
use super::study::DeviceMap;

/// Writes `device,<keys of the axes>,outcome,peak_rotation,peak_acceleration`: peaks max|θ|/α and max|θ̈|/(p²α), empty when overturned;
/// numbers read back to the same f64.
///
/// # Errors
/// As `out`.
pub fn write_csv(grid: &Grid, maps: &[DeviceMap], out: &mut impl Write) -> io::Result<()> {
    write!(out, "device,{}", quoted(&grid.map.x.key))?;
    if let Some(y) = &grid.map.y {
        write!(out, ",{}", quoted(&y.key))?;
    }
    writeln!(out, ",outcome,peak_rotation,peak_acceleration")?;
    for map in maps {
        let device = quoted(&map.device);
        for (cell, result) in map.results.iter().enumerate() {
            write!(out, "{device},{:?}", grid.map.x.value(cell % grid.columns()))?;
            if let Some(y) = &grid.map.y {
                write!(out, ",{:?}", y.value(cell / grid.columns()))?;
            }
            write!(out, ",{}", result.outcome)?;
            if result.outcome.overturned() {
                writeln!(out, ",,")?;
            } else {
                writeln!(out, ",{:?},{:?}", result.peak_rotation, result.peak_acceleration)?;
            }
        }
    }
    Ok(())
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
