//! Faults over time: vertical lines with their texts above the panels.

use super::layer::{Text, units, write_path};
use super::legend::shortened;
use super::palette::{FAULT, Stroke};
use super::stack::{LEFT_PX, PANELS_PX, Stack};
use super::text_width::text_width_px;

const FAULT_FONT_PX: f64 = 10.5;
/// Height of a row of texts above the panels (px).
const FAULT_ROW_PX: f64 = 13.0;
const MOST_FAULT_ROWS: usize = 6;
/// Widest text of a fault, and space right of it (px).
const FAULT_TEXT_PX: f64 = 340.0;
const FAULT_GAP_PX: f64 = 10.0;

/// The line of a fault.
pub(super) fn fault_stroke() -> Stroke {
    Stroke { colour: FAULT, dashes: "40 25", width_px: 1.0 }
}

/// Left edge (px) and row of a fault's text above the panels; `None` where there is no room.
type FaultPlace = Option<(f64, usize)>;

/// Faults with the places of their texts above the panels.
pub(super) struct Faults<'a> {
    /// Positions (px) and texts.
    marks: Vec<(f64, &'a str)>,
    places: Vec<FaultPlace>,
    /// Lower edge of the texts (px).
    first_px: f64,
}

impl<'a> Faults<'a> {
    /// The faults, each a time and a text, within the time span of `stack`, which gets room for their texts.
    pub(super) fn new(stack: &mut Stack, faults: &'a [(f64, String)]) -> Self {
        let shown = faults.iter().filter(|fault| stack.shows(fault.0));
        let marks: Vec<(f64, &str)> = shown.map(|fault| (stack.position_px(fault.0), fault.1.as_str())).collect();
        let places = fault_places(&marks, LEFT_PX + PANELS_PX);
        let rows = places.iter().flatten().map(|place| place.1 + 1).max().unwrap_or(0);
        stack.top_px += rows as f64 * FAULT_ROW_PX;
        Self { marks, places, first_px: stack.top_px }
    }

    /// Appends lines from the texts down to `bottom_px`, then the texts.
    pub(super) fn write(&self, svg: &mut String, bottom_px: f64) {
        let (mut path, first_px) = (String::new(), self.first_px);
        let mut before = None;
        for ((x_px, _), place) in self.marks.iter().zip(&self.places) {
            let x = units(*x_px);
            let row = place.map_or(0, |place| place.1);
            if before != Some(x) || row > 0 {
                path.push_str(&format!("M{x} {}V{}", units(first_px - row as f64 * FAULT_ROW_PX), units(bottom_px)));
            }
            before = Some(x);
        }
        write_path(svg, &path, fault_stroke());
        for ((_, text), place) in self.marks.iter().zip(&self.places) {
            if let Some((left_px, row)) = place {
                let at = (*left_px, first_px - 4.0 - *row as f64 * FAULT_ROW_PX);
                let attributes = " paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"30\"";
                Text { colour: FAULT, attributes, ..Text::new(&shortened(text, FAULT_TEXT_PX), at, FAULT_FONT_PX) }
                    .write(svg, false);
            }
        }
    }
}

/// Rows for the texts of `faults`, each a position (px) and a text, so that no two overlap.
fn fault_places(faults: &[(f64, &str)], right_px: f64) -> Vec<FaultPlace> {
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
