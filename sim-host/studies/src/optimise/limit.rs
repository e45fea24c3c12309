//! Limits on what a device asks for.

use serde::Serialize;

use super::design::Score;

/// A quantity of a device that may be limited.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Quantity {
    /// |F|/(mg) of the device on its support.
    Force,
    /// Travel of the terminals to one side, m.
    Stroke,
}

impl Quantity {
    /// Both quantities.
    pub const ALL: [Quantity; 2] = [Quantity::Force, Quantity::Stroke];

    /// In the markup of [`sprag_report::plot::Chart::x_title`], of the quantile `share` of the motions.
    pub fn axis_title(self, share: f64) -> String {
        let of =
            if share == 1.0 { "largest".to_owned() } else { format!("{} quantile of the", crate::cloud::pages::percent(share)) };
        match self {
            Quantity::Force => format!("{of} device force, max |*F*|/(*mg*)"),
            Quantity::Stroke => format!("{of} stroke, max |*u*| (m)"),
        }
    }
}

/// The limits of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest |F|/(mg).
    pub force: Option<f64>,
    /// Largest stroke, m.
    pub stroke: Option<f64>,
    /// Share of the motions that must respect them, 0 to 1.
    pub quantile: f64,
    /// Whether the force counts under motions that overturn the block.
    pub force_of_overturned: bool,
}

impl Limits {
    /// The one on `quantity`.
    pub fn of(&self, quantity: Quantity) -> Option<f64> {
        match quantity {
            Quantity::Force => self.force,
            Quantity::Stroke => self.stroke,
        }
    }

    /// Whether there is one at all.
    pub fn any(&self) -> bool {
        self.force.is_some() || self.stroke.is_some()
    }

    /// Whether `score` respects the limit on `quantity`, if there is one.
    pub fn respected(&self, quantity: Quantity, score: &Score) -> bool {
        self.of(quantity).is_none_or(|limit| score.asks(quantity) <= limit)
    }

    /// Whether `score` respects all of them but that on `quantity`, which it may or may not.
    pub fn others_respected(&self, quantity: Quantity, score: &Score) -> bool {
        Quantity::ALL.into_iter().all(|other| other == quantity || self.respected(other, score))
    }

    /// Whether `score` respects them all.
    pub fn allow(&self, score: &Score) -> bool {
        Quantity::ALL.into_iter().all(|quantity| self.respected(quantity, score))
    }

    /// The largest of what `score` asks for over what is allowed; above 1 a limit is not respected.
    pub fn demand(&self, score: &Score) -> f64 {
        let ratio = |quantity: Quantity| self.of(quantity).map(|limit| score.asks(quantity) / limit);
        Quantity::ALL.into_iter().filter_map(ratio).fold(0.0, f64::max)
    }
}
