//! Settings of laws that a choice is made over: thresholds and times of clutches and controllers.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sprag_sim::scene::error::KeyPath;
use sprag_sim::scene::schema::{DeviceTable, KeyOf};
use sprag_sim::scene::{Scene, SceneError, overrides};

use super::law::Law;

/// Most combinations of settings of one law.
pub const MOST_COMBINATIONS: usize = 256;

/// Two capacities.
const EXAMPLE_VALUES: [f64; 2] = [0.1, 0.2];

/// `[[optimise.setting]]`: every law that takes it is tried with each of its values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SettingTable {
    /// Key of a `[[device]]`, such as `clutch.capacity_ratio`, or of the controller, such as `controller.hysteresis`.
    #[schemars(example = &"clutch.capacity_ratio")]
    pub key: String,
    /// Values to choose from.
    #[schemars(length(min = 1), example = EXAMPLE_VALUES)]
    pub values: Vec<f64>,
    /// Laws that get it, by name; all that take it without the key.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(example = ["slipping"])]
    pub laws: Vec<String>,
}

impl SettingTable {
    /// Whether it is one of the controller.
    fn of_controller(&self) -> bool {
        self.key.starts_with("controller.")
    }

    /// `law` with `value`.
    ///
    /// # Errors
    /// [`SceneError`] where the law does not take it.
    fn set(&self, law: &Law, value: f64, scene: &Scene, mass_ratio: f64) -> Result<Law, SceneError> {
        let device = DeviceTable { mass_ratio: Some(mass_ratio), ..law.device.clone() };
        let mut with = scene.with_device(device)?;
        with.file.controller.clone_from(&law.controller);
        let mut table = toml::Table::try_from(&with.file)
            .map_err(|error| KeyPath { origin: scene.origin.clone(), key: self.key.clone() }.conflict(&error.to_string()))?;
        let key = if self.of_controller() { self.key.clone() } else { format!("device.0.{}", self.key) };
        overrides::apply(&mut table, &format!("{key}={value:?}"), &scene.origin)?;
        let changed = Scene::of_table(table, &scene.origin)?;
        let device = changed.file.device.into_iter().next().unwrap_or_else(|| law.device.clone());
        Ok(Law {
            name: format!("{} [{} = {value}]", law.name, self.key),
            device: DeviceTable { mass_ratio: None, ..device },
            controller: changed.file.controller,
        })
    }
}

/// `laws` with every combination of the values of `settings` that each takes; `key` makes the place of a key of `optimise`.
///
/// # Errors
/// [`SceneError`] for a setting that no law takes, a law that is named and does not take it, and too many combinations.
pub(super) fn with_settings(
    laws: Vec<Law>,
    settings: &[SettingTable],
    scene: &Scene,
    mass_ratio: f64,
    key: &KeyOf<'_>,
) -> Result<Vec<Law>, SceneError> {
    let mut of_laws: Vec<(String, Vec<Law>)> = laws.into_iter().map(|law| (law.name.clone(), vec![law])).collect();
    for (index, setting) in settings.iter().enumerate() {
        let of_setting = |name: &str| key(&format!("setting.{index}.{name}"));
        of_setting("values").once(&setting.values)?;
        if let Some(unknown) = setting.laws.iter().find(|name| !of_laws.iter().any(|(law, _)| law == *name)) {
            let names: Vec<String> = of_laws.iter().map(|(law, _)| format!("{law:?}")).collect();
            return Err(of_setting("laws").outside(format!("{unknown:?}"), &format!("among the laws {}", names.join(", "))));
        }
        let mut refused = None;
        let mut taken = false;
        for (name, variants) in &mut of_laws {
            let named = setting.laws.contains(name);
            let asked = named || setting.laws.is_empty();
            if !asked || (setting.of_controller() && variants[0].controller.is_none()) {
                continue;
            }
            let all: Result<Vec<Law>, SceneError> = variants
                .iter()
                .flat_map(|law| setting.values.iter().map(move |&value| setting.set(law, value, scene, mass_ratio)))
                .collect();
            match all {
                Ok(all) if all.len() > MOST_COMBINATIONS => {
                    return Err(of_setting("values").range(all.len() as f64, "at most 256 combinations of the settings of a law"));
                }
                Ok(all) => {
                    *variants = all;
                    taken = true;
                }
                Err(error) => refused = refused.or(Some((named, error))),
            }
        }
        match refused {
            Some((named, error)) if named || !taken => {
                let reason = error.to_string().replacen(&format!("{}: ", scene.origin), "", 1).replace("device.0.", "");
                return Err(of_setting("values").conflict(&reason));
            }
            None if !taken => return Err(of_setting("key").conflict("no law has a controller")),
            _ => {}
        }
    }
    Ok(of_laws.into_iter().flat_map(|(_, laws)| laws).collect())
}
