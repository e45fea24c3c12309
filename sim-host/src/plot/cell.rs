//! The outcomes that a map shows, their colours and names.

use plotters::style::RGBColor;

/// Outcome of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cell {
    /// The block rocks and comes back.
    Stands,
    /// The block never starts to rock.
    NoRocking,
    /// The block overturns without an impact before.
    Overturns,
    /// The block overturns after at least one impact.
    OverturnsAfterImpact,
}

impl Cell {
    /// All, from the lightest to the darkest.
    pub(super) const ALL: [Self; 4] = [Self::NoRocking, Self::Stands, Self::OverturnsAfterImpact, Self::Overturns];

    /// Its colour: blue and orange for colour-blind readers, from light to dark for grey print.
    pub(super) fn colour(self) -> RGBColor {
        match self {
            Self::NoRocking => RGBColor(248, 248, 246),
            Self::Stands => RGBColor(158, 202, 225),
            Self::OverturnsAfterImpact => RGBColor(213, 94, 0),
            Self::Overturns => RGBColor(54, 20, 38),
        }
    }

    /// Its name in the legend.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::NoRocking => "no rocking",
            Self::Stands => "rocks and stands",
            Self::OverturnsAfterImpact => "overturns after an impact",
            Self::Overturns => "overturns without an impact",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greys_are_apart() {
        let grey = |cell: &Cell| {
            let RGBColor(red, green, blue) = cell.colour();
            0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue)
        };
        assert!(Cell::ALL.windows(2).all(|pair| grey(&pair[0]) - grey(&pair[1]) > 45.0));
    }
}
