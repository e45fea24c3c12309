//! `[map]`: the two axes of an overturning map.

use serde::{Deserialize, Serialize};
use sprag_shared::math;

use super::error::SceneError;
use super::schema::KeyOf;

/// Most cells of one axis.
pub const MOST_CELLS: usize = 100_000;

/// `[map]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapTable {
    /// Across.
    pub x: AxisTable,
    /// Up; without one the map is a cut along x.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y: Option<AxisTable>,
}

/// One axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AxisTable {
    /// Any numeric key of the scene, such as "ground.0.frequency_ratio" or "device.1.mass_ratio".
    pub key: String,
    /// Value of the first cell.
    pub from: f64,
    /// Value of the last cell.
    pub to: f64,
    /// Cells; the first and the last included.
    pub cells: usize,
    /// Equal steps or equal factors.
    #[serde(default)]
    pub scale: ScaleName,
}

/// How an axis is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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
        Ok(())
    }
}

impl AxisTable {
    fn check(&self, name: &str, key: &KeyOf<'_>) -> Result<(), SceneError> {
        let of = |part: &str| key(&format!("{name}.{part}"));
        if self.key.is_empty() || self.key.split('.').any(str::is_empty) || self.key.starts_with("map") {
            return Err(of("key").conflict("must be a numeric key of the scene, such as block.slenderness_deg"));
        }
        of("from").require(self.from, self.from.abs() < 1e9, "a number below 1e9")?;
        of("to").require(self.to, self.to > self.from && self.to < 1e9, "above `from` and below 1e9")?;
        let cells = self.cells as f64;
        of("cells").require(cells, (2..=MOST_CELLS).contains(&self.cells), "from 2 to 100000")?;
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
        let key = |name: &str| crate::scene::error::Key { origin: "scene".to_owned(), key: name.to_owned() };
        for (text, named) in [
            ("a=2:1:3", "map.x.to"),
            ("a=0:1:1", "map.x.cells"),
            ("a=0:1:3:log", "map.x.from"),
            ("=0:1:3", "map.x.key"),
            ("map.x.from=0:1:3", "map.x.key"),
            ("a=nan:1:3", "map.x.from"),
        ] {
            let map = MapTable { x: text.parse().unwrap(), y: None };
            assert!(map.check(&key).unwrap_err().to_string().contains(named), "{text}");
        }
    }
}
