//! The classes of cells that a map shows, their colours and names: outcomes, or bands of a quantity.

use sprag_shared::observers::outcome::Outcome;

use super::palette::Colour;
use super::ticks::tick_text;

/// How far the pale colours are on the way to white.
const PALENESS: f64 = 0.6;

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
    const ALL: [Self; 4] = [Self::NoRocking, Self::Stands, Self::OverturnsAfterImpact, Self::Overturns];

    /// Its colour: blue and orange for colour-blind readers, from light to dark for grey print.
    fn colour(self) -> Colour {
        match self {
            Self::NoRocking => Colour(248, 248, 246),
            Self::Stands => Colour(158, 202, 225),
            Self::OverturnsAfterImpact => Colour(213, 94, 0),
            Self::Overturns => Colour(54, 20, 38),
        }
    }

    /// Its name in the legend.
    fn name(self) -> &'static str {
        match self {
            Self::NoRocking => "no rocking",
            Self::Stands => "rocks and stands",
            Self::OverturnsAfterImpact => "overturns after an impact",
            Self::Overturns => "overturns without an impact",
        }
    }
}

impl From<Outcome> for Cell {
    fn from(outcome: Outcome) -> Cell {
        match outcome {
            Outcome::NoRocking => Cell::NoRocking,
            // Studies refuse a run that ends in flight.
            Outcome::Safe | Outcome::LiftedOff => Cell::Stands,
            Outcome::OverturnedWithoutImpact => Cell::Overturns,
            Outcome::OverturnedAfterImpact => Cell::OverturnsAfterImpact,
        }
    }
}

/// A class of cells: an entry of the legend.
#[derive(Debug, Clone, PartialEq)]
pub struct Class {
    /// Name of the class.
    pub name: String,
    pub(super) colour: Colour,
}

impl Class {
    fn new(name: &str, colour: Colour) -> Class {
        Class { name: name.to_owned(), colour }
    }

    /// The outcomes; [`Cell::class`] is their place here.
    pub fn outcomes() -> Vec<Class> {
        Cell::ALL.map(|cell| Class::new(cell.name(), cell.colour())).to_vec()
    }

    /// The outcomes in pale colours, for curves over them.
    pub fn pale_outcomes() -> Vec<Class> {
        let pale = |part: u8| part + ((255 - part) as f64 * PALENESS) as u8;
        let class = |Class { name, colour: Colour(r, g, b) }| Class { name, colour: Colour(pale(r), pale(g), pale(b)) };
        Class::outcomes().into_iter().map(class).collect()
    }

    /// No rocking, bands between neighbouring `limits` and beyond the last, and overturned, in this order; [`band`] finds a value's place.
    /// `limits` increase in equal steps.
    pub fn bands(limits: &[f64]) -> Vec<Class> {
        let step = if let [first, second, ..] = limits { second - first } else { 1.0 };
        let text = |value: f64| tick_text(value, step);
        let mut classes = vec![Class::new("no rocking", Cell::NoRocking.colour())];
        for (index, &low) in limits.iter().enumerate() {
            let name = match limits.get(index + 1) {
                Some(&high) => format!("{} to {}", text(low), text(high)),
                None => format!("{} and more", text(low)),
            };
            let share = if limits.len() > 1 { index as f64 / (limits.len() - 1) as f64 } else { 0.0 };
            classes.push(Class::new(&name, band_colour(share)));
        }
        classes.push(Class::new("overturns", Cell::Overturns.colour()));
        classes
    }
}

impl Cell {
    /// Its place in [`Class::outcomes`].
    pub fn class(self) -> usize {
        Cell::ALL.iter().position(|cell| *cell == self).unwrap_or(0)
    }
}

/// The place of `value` in the [`Class::bands`] of `limits`: of no rocking where it is none.
pub fn band(limits: &[f64], value: Option<f64>) -> usize {
    value.map_or(0, |value| limits.iter().filter(|limit| **limit <= value).count().max(1))
}

/// From pale yellow through green to deep blue as `share` goes from 0 to 1: brightness falls all the way, for colour-blind readers and
/// for grey print.
fn band_colour(share: f64) -> Colour {
    const STOPS: [(f64, f64, f64); 5] =
        [(240.0, 246.0, 200.0), (168.0, 218.0, 180.0), (77.0, 180.0, 190.0), (38.0, 120.0, 180.0), (30.0, 50.0, 130.0)];
    let place = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let below = (place.floor() as usize).min(STOPS.len() - 2);
    let part = place - below as f64;
    let ((r, g, b), (next_r, next_g, next_b)) = (STOPS[below], STOPS[below + 1]);
    let mix = |from: f64, to: f64| (from + part * (to - from)).round() as u8;
    Colour(mix(r, next_r), mix(g, next_g), mix(b, next_b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(colour: Colour) -> f64 {
        0.299 * f64::from(colour.0) + 0.587 * f64::from(colour.1) + 0.114 * f64::from(colour.2)
    }

    #[test]
    fn greys_of_outcomes_are_apart() {
        assert!(Cell::ALL.windows(2).all(|pair| grey(pair[0].colour()) - grey(pair[1].colour()) > 45.0));
        assert!(Class::pale_outcomes().windows(2).all(|pair| grey(pair[0].colour) - grey(pair[1].colour) > 15.0));
        assert!(Cell::ALL.iter().all(|cell| Class::outcomes()[cell.class()].name == cell.name()));
    }

    #[test]
    fn greys_of_bands_fall() {
        let classes = Class::bands(&[0.0, 0.2, 0.4, 0.6, 0.8, 1.0]);
        assert!(classes.windows(2).all(|pair| grey(pair[0].colour) - grey(pair[1].colour) > 8.0), "{classes:?}");
    }

    #[test]
    fn values_find_their_bands() {
        let limits = [0.0, 0.5, 1.0];
        let classes = Class::bands(&limits);
        let name = |value| classes[band(&limits, value)].name.as_str();
        assert_eq!((name(None), name(Some(0.0)), name(Some(0.49))), ("no rocking", "0 to 0.5", "0 to 0.5"));
        assert_eq!((name(Some(0.5)), name(Some(7.0))), ("0.5 to 1.0", "1.0 and more"));
        assert_eq!(classes[classes.len() - 1].name, "overturns");
    }
}
