//! Faults over time: vertical lines with their texts above the panels.

use super::layer::{Text, units};
use super::legend::shortened;
use super::palette::{FAULT, Stroke, hex};
use super::text_width::text_width_px;

const FAULT_FONT_PX: f64 = 10.5;
/// Height of a row of texts above the panels (px).
pub(super) const FAULT_ROW_PX: f64 = 13.0;
const MOST_FAULT_ROWS: usize = 6;
/// Widest text of a fault, and space right of it (px).
const FAULT_TEXT_PX: f64 = 340.0;
const FAULT_GAP_PX: f64 = 10.0;

/// The line of a fault.
pub(super) fn fault_stroke() -> Stroke {
    Stroke { colour: FAULT, dashes: "40 25", width_px: 1.0 }
}

/// Left edge (px) and row of a fault's text above the panels; `None` where there is no room.
pub(super) type FaultPlace = Option<(f64, usize)>;

/// Rows for the texts of `faults`, each a position (px) and a text, so that no two overlap.
pub(super) fn fault_places(faults: &[(f64, &str)], right_px: f64) -> Vec<FaultPlace> {
    let mut rows: Vec<Vec<(f64, f64)>> = vec![Vec::new(); MOST_FAULT_ROWS];
    let place = |(x_px, text): &(f64, &str)| {
        let width_px = text_width_px(text, FAULT_FONT_PX).min(FAULT_TEXT_PX) + FAULT_GAP_PX;
        let left_px = x_px.min(right_px + FAULT_GAP_PX - width_px);
        let free = |row: &Vec<(f64, f64)>| row.iter().all(|other| left_px >= other.1 || left_px + width_px <= other.0);
        let row = rows.iter().position(free)?;
        rows[row].push((left_px, left_px + width_px));
        Some((left_px, row))
    };
    faults.iter().map(place).collect()
}

/// Appends the lines of `faults` from their texts to the lower edge, then the texts.
pub(super) fn write_faults(svg: &mut String, faults: &[(f64, &str)], (first_px, bottom_px): (f64, f64), places: &[FaultPlace]) {
    let mut path = String::new();
    let mut before = None;
    for ((x_px, _), place) in faults.iter().zip(places) {
        let x = units(*x_px);
        let row = place.map_or(0, |place| place.1);
        if before != Some(x) || row > 0 {
            path.push_str(&format!("M{x} {}V{}", units(first_px - row as f64 * FAULT_ROW_PX), units(bottom_px)));
        }
        before = Some(x);
    }
    if path.is_empty() {
        return;
    }
    let stroke = fault_stroke();
    svg.push_str(&format!(
        "<path d=\"{path}\" stroke=\"{}\" stroke-width=\"{}\" stroke-dasharray=\"{}\"/>\n",
        hex(stroke.colour),
        units(stroke.width_px),
        stroke.dashes,
    ));
    for ((_, text), place) in faults.iter().zip(places) {
        if let Some((left_px, row)) = place {
            let at = (*left_px, first_px - 4.0 - *row as f64 * FAULT_ROW_PX);
            let attributes = " paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"30\"";
            Text { colour: FAULT, attributes, ..Text::new(&shortened(text, FAULT_TEXT_PX), at, FAULT_FONT_PX) }.write(svg, false);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fault_texts_do_not_overlap() {
        let places = fault_places(&[(10.0, "one"), (12.0, "two"), (300.0, "three"), (695.0, "four")], 700.0);
        assert_eq!(places[..3], [Some((10.0, 0)), Some((12.0, 1)), Some((300.0, 0))]);
        assert!(places[3].is_some_and(|(left_px, row)| left_px < 690.0 && row == 0));
        let many = fault_places(&[(10.0, "same"); 9], 700.0);
        assert_eq!(many.iter().flatten().count(), MOST_FAULT_ROWS);
    }
}
