//! Parameters, their words and what is wrong with them in text. For the host: it prints, and it knows every name.

use core::fmt;

use super::kind::{ABOVE_ZERO, Description, Kind};
use super::table::{COUNT, Item, TABLE};
use super::{SettingError, Settings};

static DESCRIPTIONS: [Description; COUNT] = TABLE;

impl Description {
    /// Of every parameter, in the order of [`Item::ALL`].
    pub fn all() -> &'static [Description; COUNT] {
        &DESCRIPTIONS
    }

    /// Description of the parameter at `index`.
    pub fn at(index: u16) -> Option<&'static Description> {
        DESCRIPTIONS.get(usize::from(index))
    }

    /// The parameter called `name`, and its index.
    pub fn find(name: &str) -> Option<(u16, &'static Description)> {
        (0..).zip(&DESCRIPTIONS).find(|(_, description)| description.name == name)
    }

    /// The word that `text` is, by the kind of the parameter: a number, `true` or `false`, the name of a choice. Its range is not looked
    /// at.
    pub fn parse(&self, text: &str) -> Option<u32> {
        match self.kind {
            Kind::Real => text.parse().ok().map(f32::to_bits),
            Kind::Whole => text.parse().ok(),
            Kind::Switch => text.parse::<bool>().ok().map(u32::from),
            Kind::Choice(names) => (0..).zip(names).find(|(_, name)| **name == text).map(|(word, _)| word),
        }
    }

    /// `word` as [`Description::parse`] reads it, without a unit.
    pub fn show(&self, word: u32) -> Shown {
        Shown { kind: self.kind, word }
    }

    /// Range of the parameter, in words.
    pub fn range(&self) -> Range<'_> {
        Range(self)
    }
}

/// A word as its kind has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    kind: Kind,
    word: u32,
}

impl fmt::Display for Shown {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            Kind::Real => {
                let value = f32::from_bits(self.word);
                let short = value == 0.0 || (1e-4..1e7).contains(&value.abs()) || !value.is_finite();
                if short { write!(formatter, "{value}") } else { write!(formatter, "{value:e}") }
            }
            Kind::Switch if self.word <= 1 => write!(formatter, "{}", self.word == 1),
            Kind::Choice(names) => match names.get(self.word as usize) {
                Some(name) => formatter.write_str(name),
                None => write!(formatter, "{}", self.word),
            },
            Kind::Whole | Kind::Switch => write!(formatter, "{}", self.word),
        }
    }
}

/// A range in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Range<'a>(&'a Description);

impl fmt::Display for Range<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let description = self.0;
        let unit = if description.unit.is_empty() { "" } else { " " };
        let (least, most) = (description.show(description.least), description.show(description.most));
        match description.kind {
            Kind::Switch => formatter.write_str("true or false"),
            Kind::Choice(names) => {
                for (place, name) in names.iter().enumerate() {
                    write!(formatter, "{}{name}", if place == 0 { "one of " } else { ", " })?;
                }
                Ok(())
            }
            Kind::Real if description.least == ABOVE_ZERO.to_bits() => {
                write!(formatter, "above 0, up to {most}{unit}{}", description.unit)
            }
            Kind::Real | Kind::Whole => write!(formatter, "from {least} to {most}{unit}{}", description.unit),
        }
    }
}

impl SettingError {
    /// One line that names the parameter, what it is and what it may be. `settings` are those that contradict themselves; the other errors
    /// do not look at them.
    pub fn describe(self, settings: &Settings) -> impl fmt::Display {
        Line { error: self, settings: *settings }
    }
}

struct Line {
    error: SettingError,
    settings: Settings,
}

impl fmt::Display for Line {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.error {
            SettingError::NoSuch { index } => write!(formatter, "there is no parameter {index}; there are {COUNT}, from 0"),
            SettingError::OutOfRange { index, word } => match Description::at(index) {
                Some(it) => write!(formatter, "{} is {}, but must be {}", it.name, it.show(word), it.range()),
                None => write!(formatter, "there is no parameter {index}"),
            },
            SettingError::Contradiction { index, other } => {
                let named = |index: u16| Description::at(index).zip(self.settings.get(index));
                match (named(index), named(other)) {
                    (Some((it, word)), Some((bound, at))) => write!(
                        formatter,
                        "{} is {}, but must be {} {}, which is {}",
                        it.name,
                        it.show(word),
                        relation(index),
                        bound.name,
                        bound.show(at)
                    ),
                    _ => write!(formatter, "parameters {index} and {other} contradict each other"),
                }
            }
            SettingError::NotRepresentable => formatter.write_str(
                "this controller cannot be written as settings: its parts differ in period or belief, or it is supervised otherwise",
            ),
        }
    }
}

/// How a parameter is bound by another one that [`super::assemble`] or [`super::wiring`] compares it with; others must be "across" it.
const RELATIONS: [(Item, &str); 12] = [
    (Item::CalibrationPatience, "above"),
    (Item::SlowContradictionTime, "no less than"),
    (Item::ContradictionTime, "at least eight times"),
    (Item::FrequencySquared, "the square of"),
    (Item::LeverAcross, "such that the lever at rest is above 0 with"),
    (Item::TemperatureLeast, "no more than"),
    (Item::Smoothing, "above 0 with"),
    (Item::RotationByEncoder, "such that errors die out with the other gains of"),
    (Item::RequiredGyroscope, "true with"),
    (Item::RequiredBlockAccelerometer, "true with"),
    (Item::RequiredGroundAccelerometer, "true with"),
    (Item::RequiredEncoder, "true with"),
];

fn relation(index: u16) -> &'static str {
    RELATIONS.iter().find(|(item, _)| item.index() == index).map_or("across", |(_, words)| words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    #[test]
    fn a_contradiction_says_what_must_be() {
        let mut settings = Settings::default();
        settings.set(Item::RequiredEncoder.index(), 0).unwrap();
        for (item, other, line) in [
            (Item::TemperatureLeast, Item::TemperatureMost, "no more than board.temperature_most, which is 70"),
            (Item::RequiredEncoder, Item::Estimator, "true with estimator, which is model-aided"),
            (Item::RotationByEncoder, Item::Estimator, "such that errors die out with the other gains of estimator, which is"),
            (Item::Smoothing, Item::Estimator, "above 0 with estimator, which is"),
            (Item::BlockUpAxis, Item::BlockAlongAxis, "across board.block_along_axis, which is"),
        ] {
            let said = SettingError::contradiction(item, other).describe(&settings).to_string();
            assert!(said.contains(&["but must be ", line].concat()), "{said}");
        }
    }
}
