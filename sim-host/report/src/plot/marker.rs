//! Marks: open ones that distinguish devices without colour, those of the points of lines, and that of a choice.

use super::layer::{units, write_disc};
use super::palette::{Colour, INK, hex};

/// Half of a mark's size (px).
const HALF_PX: f64 = 2.7;

/// The shape of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross,
}

const SHAPES: [Marker; 5] = [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Diamond, Marker::Cross];

/// The mark of the device at `index`; shapes repeat after five devices, as dashes do.
pub(super) fn device_marker(index: usize) -> Marker {
    SHAPES[index % SHAPES.len()]
}

impl Marker {
    /// Appends the mark around a position in pixels.
    pub(super) fn write(self, svg: &mut String, (x_px, y_px): (f64, f64), colour: Colour) {
        let (x, y, half) = (units(x_px), units(y_px), units(HALF_PX));
        let style = format!("fill=\"none\" stroke=\"{}\" stroke-width=\"9\" stroke-opacity=\"0.75\"", hex(colour));
        let (small, high) = (units(0.88 * HALF_PX), units(1.15 * HALF_PX));
        let path = match self {
            Marker::Circle => {
                svg.push_str(&format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{half}\" {style}/>\n"));
                return;
            }
            Marker::Square => format!("M{} {}h{}v{}h-{}z", x - small, y - small, 2 * small, 2 * small, 2 * small),
            Marker::Triangle => format!("M{x} {}l{high} {}h-{}z", y - high, 2 * high - units(0.5), 2 * high),
            Marker::Diamond => format!("M{x} {}l{high} {high}l-{high} {high}l-{high} -{high}z", y - high),
            Marker::Cross => {
                format!("M{} {}l{} {}m0 -{}l-{} {}", x - small, y - small, 2 * small, 2 * small, 2 * small, 2 * small, 2 * small)
            }
        };
        svg.push_str(&format!("<path d=\"{path}\" {style}/>\n"));
    }
}

/// Radius of the discs at the points of a line (px).
const MARK_PX: f64 = 2.6;

/// Appends the mark of a point of a line: a disc, or a circle if it is `open`.
pub(super) fn write_mark(svg: &mut String, at_px: (f64, f64), colour: Colour, open: bool) {
    if open {
        let stroke = format!(" stroke=\"{}\" stroke-width=\"{}\"", hex(colour), units(1.1));
        write_disc(svg, at_px, MARK_PX - 0.3, Colour(255, 255, 255), &stroke);
    } else {
        write_disc(svg, at_px, MARK_PX, colour, "");
    }
}

/// Radius of the ring around a choice (px).
const RING_PX: f64 = 5.6;

/// Appends the mark of a choice around a position in pixels, as the legend has it.
pub(super) fn write_chosen_key(svg: &mut String, at_px: (f64, f64)) {
    write_chosen(svg, at_px, (at_px.1 + 7.0, at_px.1 - 7.0));
}

/// Appends the mark of a choice around a position in pixels: a ring, with whiskers to the heights of a band's `ends`.
pub(super) fn write_chosen(svg: &mut String, (x_px, y_px): (f64, f64), ends: (f64, f64)) {
    let (x, y, ink) = (units(x_px), units(y_px), hex(INK));
    svg.push_str(&format!(
        "<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\" fill=\"none\" stroke=\"{ink}\" stroke-width=\"16\"/>\n",
        units(RING_PX)
    ));
    let cap = units(3.5);
    let whisker = |end_px: f64| {
        let way = if end_px < y_px { -1.0 } else { 1.0 };
        let end = units(end_px);
        // From the ring on, if the band reaches that far.
        let from = if way * (end_px - y_px) > RING_PX { units(y_px + way * RING_PX) } else { end };
        format!("M{x} {from}V{end}M{} {end}h{}", x - cap, 2 * cap)
    };
    let path = whisker(ends.0) + &whisker(ends.1);
    svg.push_str(&format!("<path d=\"{path}\" fill=\"none\" stroke=\"{ink}\" stroke-width=\"10\"/>\n"));
}
