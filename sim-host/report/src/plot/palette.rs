//! Colours and dash patterns: Okabe and Ito's colours for colour-blind readers, dashes for grey print.

/// Red, green and blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Colour(pub u8, pub u8, pub u8);

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stroke {
    /// Colour.
    pub colour: Colour,
    /// Dash lengths in tenths of a pixel, as SVG writes them; `none` for a solid line.
    pub dashes: &'static str,
    /// Width (px).
    pub width_px: f64,
}

impl Stroke {
    /// A solid curve.
    pub(super) fn solid(colour: Colour) -> Self {
        Self { colour, dashes: "none", width_px: CURVE_PX }
    }
}

/// How one device's curves look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct DeviceLook {
    /// Colour of curves and marks.
    pub colour: Colour,
    /// Dash lengths in tenths of a pixel, as SVG writes them; `none` for a solid curve.
    pub dashes: &'static str,
}

impl DeviceLook {
    /// The look of its curves.
    pub(super) fn stroke(self) -> Stroke {
        Stroke { colour: self.colour, dashes: self.dashes, width_px: CURVE_PX }
    }
}

/// Curve width in pixels.
pub(super) const CURVE_PX: f64 = 1.3;

/// Text and frames.
pub(super) const INK: Colour = Colour(34, 34, 34);

/// Reference lines.
pub(super) const GUIDE: Colour = Colour(150, 150, 150);

/// A front below lines and marks.
pub(super) const FRONT: Colour = Colour(205, 205, 205);

/// The ground motion.
pub(super) const GROUND: Colour = Colour(90, 90, 90);

/// Tints behind the curves while the first or second flywheel is engaged; their greys differ.
pub(super) const FLYWHEEL_TINTS: [Colour; 2] = [Colour(205, 226, 243), Colour(253, 238, 208)];

// The yellow of the palette is left out: it vanishes on white.
const COLOURS: [Colour; 7] = [
    Colour(0, 0, 0),
    Colour(213, 94, 0),
    Colour(0, 114, 178),
    Colour(0, 158, 115),
    Colour(204, 121, 167),
    Colour(86, 180, 233),
    Colour(230, 159, 0),
];

/// Bars that show when the first or second flywheel is engaged: the tints, dark enough to stand alone.
pub(super) const FLYWHEEL_BARS: [Colour; 2] = [Colour(62, 124, 177), Colour(226, 160, 48)];

/// Faults.
pub(super) const FAULT: Colour = Colour(150, 0, 90);

const DASHES: [&str; 5] = ["none", "60 25", "100 25 15 25", "18 18", "140 40"];

/// The look of the device at `index`; colours repeat after seven devices, pairs of colour and dash after 35.
pub(super) fn device_look(index: usize) -> DeviceLook {
    DeviceLook { colour: COLOURS[index % COLOURS.len()], dashes: DASHES[index % DASHES.len()] }
}

/// The stroke of the colour and the dashes of these numbers; colours repeat after seven, dashes after five.
pub(super) fn stroke_of(colour: usize, dashes: usize) -> Stroke {
    Stroke { colour: COLOURS[colour % COLOURS.len()], dashes: DASHES[dashes % DASHES.len()], width_px: CURVE_PX }
}

/// The look of the reference line at `index`; dashes repeat after three.
pub(super) fn guide_stroke(index: usize) -> Stroke {
    const GUIDE_DASHES: [&str; 3] = ["40 30", "100 40", "12 22"];
    Stroke { colour: GUIDE, dashes: GUIDE_DASHES[index % GUIDE_DASHES.len()], width_px: 0.9 }
}

/// `#rrggbb`.
pub(super) fn hex(colour: Colour) -> String {
    format!("#{:02x}{:02x}{:02x}", colour.0, colour.1, colour.2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_five_looks_differ() {
        for first in 0..35 {
            for second in 0..first {
                assert_ne!(device_look(first), device_look(second));
            }
        }
    }
}
