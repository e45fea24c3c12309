//! What a parameter is: its name, its unit, and what it may be.

use super::Settings;
use super::table::Item;

/// Type of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The bits of an f32; NaN and the infinities are never allowed.
    Real,
    /// A whole number from 0 up.
    Whole,
    /// 0 is no, 1 is yes.
    Switch,
    /// One of these, from 0.
    Choice(&'static [&'static str]),
}

/// By which choices a parameter is read. What is not read has no influence on the controller, but must be within its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// By all.
    Always,
    /// With these bodies only, one bit each in the order of their choice.
    Bodies(u8),
    /// With these estimators only.
    Estimators(u8),
    /// With these laws only.
    Laws(u8),
    /// By the board and not by its controller ([`super::wiring::Wiring`]).
    Board,
}

/// All about one parameter. For the host: firmware that does not ask for one does not contain any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Description {
    /// Dotted, such as `model.size`.
    pub name: &'static str,
    /// SI, `°C`, `g`, `ticks` or `counts`; empty where there is none.
    pub unit: &'static str,
    /// Type of the word.
    pub kind: Kind,
    /// The least word allowed, read as `kind` says.
    pub least: u32,
    /// The largest.
    pub most: u32,
    /// Word of the parameter in [`Settings::default`].
    pub default: u32,
    /// Who reads it.
    pub used: Use,
}

/// The least of what must be above 0.
pub(super) const ABOVE_ZERO: f32 = f32::MIN_POSITIVE;

/// A real number from `least` to `most`.
pub(super) const fn real(unit: &'static str, least: f32, most: f32, default: f32) -> Description {
    let (least, most, default) = (least.to_bits(), most.to_bits(), default.to_bits());
    Description { name: "", unit, kind: Kind::Real, least, most, default, used: Use::Always }
}

/// A whole number from `least` to `most`.
pub(super) const fn whole(unit: &'static str, least: u32, most: u32, default: u32) -> Description {
    Description { name: "", unit, kind: Kind::Whole, least, most, default, used: Use::Always }
}

/// Yes or no.
pub(super) const fn switch(default: bool) -> Description {
    Description { name: "", unit: "", kind: Kind::Switch, least: 0, most: 1, default: default as u32, used: Use::Always }
}

/// One of `names`.
pub(super) const fn choice(names: &'static [&'static str], default: u32) -> Description {
    let most = names.len() as u32 - 1;
    Description { name: "", unit: "", kind: Kind::Choice(names), least: 0, most, default, used: Use::Always }
}

impl Description {
    /// The same, `used` by fewer.
    pub(super) const fn only(self, used: Use) -> Description {
        Description { used, ..self }
    }

    /// Whether the controller that `settings` describe reads this parameter.
    pub fn applies(&self, settings: &Settings) -> bool {
        let among = |bits: u8, item: Item| u32::from(bits) >> settings.whole(item) & 1 == 1;
        match self.used {
            Use::Always => true,
            Use::Bodies(bits) => among(bits, Item::Body),
            Use::Estimators(bits) => among(bits, Item::Estimator),
            Use::Laws(bits) => among(bits, Item::Law),
            Use::Board => false,
        }
    }
}
