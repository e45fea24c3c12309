//! Open marks that tell devices apart without colour.

use plotters::style::RGBColor;

use super::layer::units;
use super::palette::hex;

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
    pub(super) fn write(self, svg: &mut String, (x_px, y_px): (f64, f64), colour: RGBColor) {
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
