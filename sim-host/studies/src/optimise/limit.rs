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
    /// Bending stress at the root of a gear tooth, MPa.
    ToothStress,
    /// Energy of the coils over a motion, J.
    CoilEnergy,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Quantity; 4] = [Quantity::Force, Quantity::Stroke, Quantity::ToothStress, Quantity::CoilEnergy];

    /// Those that overturning is traded for.
    pub const TRADED: [Quantity; 2] = [Quantity::Force, Quantity::Stroke];

    /// In a word or two.
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Force => "force",
            Quantity::Stroke => "stroke",
            Quantity::ToothStress => "tooth stress",
            Quantity::CoilEnergy => "coil energy",
        }
    }

    /// With its symbol and unit.
    pub fn title(self) -> &'static str {
        match self {
            Quantity::Force => "force on the support, max |F|/(mg)",
            Quantity::Stroke => "stroke of the terminals (m)",
            Quantity::ToothStress => "bending stress of gear teeth (MPa)",
            Quantity::CoilEnergy => "energy of the coils (J)",
        }
    }

    /// In the markup of [`sprag_report::plot::Chart::x_title`], of the quantile `share` of the motions.
    pub fn axis_title(self, share: f64) -> String {
        let of =
            if share == 1.0 { "largest".to_owned() } else { format!("{} quantile of the", crate::cloud::pages::percent(share)) };
        match self {
            Quantity::Force => format!("{of} device force, max |*F*|/(*mg*)"),
            Quantity::Stroke => format!("{of} stroke, max |*u*| (m)"),
            other => format!("{of} {}", other.title()),
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
    /// Largest bending stress of gear teeth, MPa.
    pub tooth_stress: Option<f64>,
    /// Largest energy of the coils over a motion, J.
    pub coil_energy: Option<f64>,
    /// Share of the motions that must respect them, 0 to 1.
    pub quantile: f64,
    /// Whether force, tooth stress and coil energy count under motions that overturn the block.
    pub force_of_overturned: bool,
}

impl Limits {
    /// No limit.
    pub const NONE: Limits =
        Limits { force: None, stroke: None, tooth_stress: None, coil_energy: None, quantile: 1.0, force_of_overturned: true };

    /// Without a limit, of the same quantile of the same motions.
    #[must_use]
    pub fn lifted(self) -> Limits {
        Limits { quantile: self.quantile, force_of_overturned: self.force_of_overturned, ..Limits::NONE }
    }

    /// The one on `quantity`.
    pub fn of(&self, quantity: Quantity) -> Option<f64> {
        match quantity {
            Quantity::Force => self.force,
            Quantity::Stroke => self.stroke,
            Quantity::ToothStress => self.tooth_stress,
            Quantity::CoilEnergy => self.coil_energy,
        }
    }

    /// Whether there is one at all.
    pub fn any(&self) -> bool {
        Quantity::ALL.into_iter().any(|quantity| self.of(quantity).is_some())
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
