//! `[map]`: the two axes of an overturning map, and what it calls overturned.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sprag_shared::math;

use super::controller::LawName;
use super::error::SceneError;
use super::schema::KeyOf;

/// Most cells of one axis.
pub const MOST_CELLS: usize = 100_000;

/// `[map]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MapTable {
    /// Axis across.
    pub x: AxisTable,
    /// Axis up; without it the map is a cut along x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<AxisTable>,
    /// Rotation |θ| at which a block counts as overturned.
    #[serde(default, skip_serializing_if = "is_no_return")]
    #[schemars(extend("default" = OverturnedAt::NoReturn))]
    pub overturned_at: OverturnedAt,
    /// Laws of the controller, each of which gets a map of its own with the clutches of every clutched pair in closed loop.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub laws: Vec<LawName>,
}

/// Rotation |θ| at which a block counts as overturned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OverturnedAt {
    /// Where the ground can no longer bring it back.
    #[default]
    NoReturn,
    /// α, even if the ground would bring it back.
    Slenderness,
}

fn is_no_return(at: &OverturnedAt) -> bool {
    *at == OverturnedAt::NoReturn
}

/// One axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisTable {
    /// Numeric key of the scene, such as "ground.0.frequency_ratio".
    #[schemars(example = &"block.slenderness_deg")]
    pub key: String,
    /// Value of the first cell.
    #[schemars(extend("exclusiveMinimum" = -1e9, "exclusiveMaximum" = 1e9))]
    pub from: f64,
    /// Value of the last cell, above `from`.
    #[schemars(extend("exclusiveMinimum" = -1e9, "exclusiveMaximum" = 1e9), example = 2.0)]
    pub to: f64,
    /// Cells, the first and the last included.
    #[schemars(range(min = 2, max = MOST_CELLS))]
    pub cells: usize,
    /// How the axis is divided.
    #[serde(default)]
    pub scale: ScaleName,
}

/// How an axis is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ScaleName {
    /// Equal steps.
    #[default]
    Linear,
    /// Equal factors.
    Logarithmic,
}

impl MapTable {
    /// # Errors
    /// [`SceneError`] names the key.
    pub(super) fn check(&self, key: &KeyOf<'_>) -> Result<(), SceneError> {
        self.x.check("map.x", key)?;
        if let Some(y) = &self.y {
            y.check("map.y", key)?;
            if y.key == self.x.key {
                return Err(key("map.y.key").conflict("the two axes need different keys"));
            }
        }
        key("map.laws").once(&self.laws)
    }
}

impl AxisTable {
    fn check(&self, name: &str, key: &KeyOf<'_>) -> Result<(), SceneError> {
        let of = |part: &str| key(&format!("{name}.{part}"));
        if self.key.is_empty() || self.key.split('.').any(str::is_empty) || self.key.starts_with("map") {
            return Err(of("key").conflict("must be a numeric key of the scene, such as block.slenderness_deg"));
        }
        of("to").require(self.to, self.to > self.from, "above `from`")?;
        if self.scale == ScaleName::Logarithmic {
            of("from").require(self.from, self.from > 0.0, "above 0 on a logarithmic axis")?;
        }
        Ok(())
    }

    /// Value of cell `index` (below `cells`): `from` + index (`to` − `from`)/(cells − 1), or the same of logarithms; the ends are exact.
    pub fn value(&self, index: usize) -> f64 {
        self.value_at(index as f64)
    }

    /// Value at `position`, in cells from the first (0 to `cells` − 1): that of the cell where it is a whole number, between those of its
    /// neighbours, by the scale, where it is not.
    pub fn value_at(&self, position: f64) -> f64 {
        let last = (self.cells - 1) as f64;
        let share = position / last;
        let value = match self.scale {
            _ if position <= 0.0 => self.from,
            _ if position >= last => self.to,
            ScaleName::Linear => self.from + (self.to - self.from) * share,
            ScaleName::Logarithmic => self.from * math::exp(share * math::ln(self.to / self.from)),
        };
        // Rounding could pass an end, and so the range of the key.
        value.max(self.from).min(self.to)
    }
}

/// KEY=FROM:TO:CELLS, with :log for a logarithmic axis, as the command line has it.
impl std::str::FromStr for AxisTable {
    type Err = String;

    fn from_str(text: &str) -> Result<AxisTable, String> {
        let refuse =
            || format!("`{text}` must be KEY=FROM:TO:CELLS or KEY=FROM:TO:CELLS:log, such as device.1.mass_ratio=0:1:50");
        let (key, range) = text.split_once('=').ok_or_else(refuse)?;
        let parts: Vec<&str> = range.split(':').collect();
        let (from, to, cells, scale) = match parts[..] {
            [from, to, cells] => (from, to, cells, ScaleName::Linear),
            [from, to, cells, "log"] => (from, to, cells, ScaleName::Logarithmic),
            _ => return Err(refuse()),
        };
        let number = |part: &str| part.trim().parse::<f64>().map_err(|_| refuse());
        let cells = cells.trim().parse().map_err(|_| refuse())?;
        Ok(AxisTable { key: key.trim().to_owned(), from: number(from)?, to: number(to)?, cells, scale })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_has_its_ends_and_equal_steps_or_factors() {
        let linear: AxisTable = "block.restitution=0.2:0.8:4".parse().unwrap();
        assert_eq!([0, 3].map(|index| linear.value(index)), [0.2, 0.8]);
        assert!((linear.value(1) - 0.4).abs() < 1e-15);
        assert_eq!([0.0, 1.0, 2.0, 3.0].map(|position| linear.value_at(position)), [0, 1, 2, 3].map(|index| linear.value(index)));
        assert!((linear.value_at(1.5) - 0.5).abs() < 1e-15);
        let logarithmic: AxisTable = "device.1.mass_ratio=0.01:100:5:log".parse().unwrap();
        assert_eq!([0, 4].map(|index| logarithmic.value(index)), [0.01, 100.0]);
        assert!((logarithmic.value(2) - 1.0).abs() < 1e-15);
        assert!((logarithmic.value_at(2.5) - sprag_shared::math::square_root(10.0)).abs() < 1e-14);
    }

    #[test]
    fn what_is_no_axis_is_refused() {
        for text in ["a", "a=1", "a=1:2", "a=1:2:x", "a=1:2:3:exp", "a=:2:3"] {
            assert!(text.parse::<AxisTable>().unwrap_err().contains("KEY=FROM:TO:CELLS"), "{text}");
        }
        for (x, named) in [
            ("{ key = 'block.size_m', from = 2, to = 1, cells = 3 }", "map.x.to"),
            ("{ key = 'block.size_m', from = 0, to = 1, cells = 1 }", "map.x.cells is 1, but must be from 2 to 100000"),
            ("{ key = 'block.size_m', from = 0, to = 1, cells = 3, scale = 'logarithmic' }", "map.x.from"),
            ("{ key = '', from = 0, to = 1, cells = 3 }", "map.x.key"),
            ("{ key = 'map.x.from', from = 0, to = 1, cells = 3 }", "map.x.key"),
            ("{ key = 'block.size_m', from = nan, to = 1, cells = 3 }", "map.x.from is NaN"),
        ] {
            let scene = format!(
                "block = {{ size_m = 2, slenderness_deg = 10, initial_rotation_ratio = 0.5 }}\ndevice = [{{ kind = 'none' }}]\nmap.x = {x}"
            );
            let message = crate::scene::Scene::parse(&scene, "scene").unwrap_err().to_string();
            assert!(message.contains(named), "{x}: {message}");
        }
    }
}
