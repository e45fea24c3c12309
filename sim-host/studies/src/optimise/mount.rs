//! Where a device may be attached (Figure 3 of the paper).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sprag_shared::structure::block::Block;
use sprag_shared::structure::error::ParameterError;
use sprag_sim::scene::SceneError;
use sprag_sim::scene::device::{DeviceTable, MountName, resolve_mount};
use sprag_sim::scene::schema::KeyOf;

/// An entry of `optimise.mounts`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    expecting = "a mount is \"centre-of-mass\", \"base-corners\", or { mount = \"tying-point\", mount_height_m = 2.0 }, with \
                 pulley_ratio where there is one"
)]
pub enum MountEntry {
    /// By its name alone.
    Name(MountName),
    /// With what else a `[[device]]` says of it.
    Described(DescribedMount),
}

/// A mount, in the keys of a `[[device]]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DescribedMount {
    /// Where the device is attached (Figure 3).
    pub mount: MountName,
    /// Height of a tying point above the base.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub mount_height_m: Option<f64>,
    /// Travel of the terminal over that of the tying point or corner; 1 without the key.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub pulley_ratio: Option<f64>,
}

impl MountEntry {
    /// In the keys of a device.
    pub fn described(self) -> DescribedMount {
        match self {
            MountEntry::Name(mount) => DescribedMount { mount, mount_height_m: None, pulley_ratio: None },
            MountEntry::Described(described) => described,
        }
    }
}

impl DescribedMount {
    /// Mount of `device`.
    pub fn of(device: &DeviceTable) -> DescribedMount {
        DescribedMount {
            mount: device.mount.unwrap_or_default(),
            mount_height_m: device.mount_height_m,
            pulley_ratio: device.pulley_ratio,
        }
    }

    /// Puts `device` here.
    pub fn attach(self, device: &mut DeviceTable) {
        device.mount = Some(self.mount);
        device.mount_height_m = self.mount_height_m;
        device.pulley_ratio = self.pulley_ratio;
    }

    /// As tables and legends call it: "tying-point 2 m, pulley 4".
    pub fn name(self) -> String {
        let height = self.mount_height_m.map_or_else(String::new, |height| format!(" {height} m"));
        let pulley = self.pulley_ratio.map_or_else(String::new, |ratio| format!(", pulley {ratio}"));
        format!("{}{height}{pulley}", self.mount.name())
    }

    /// Refuses what no device can have on `block`; `key` makes the place of a key of this mount.
    ///
    /// # Errors
    /// [`SceneError`] names the key.
    pub(super) fn check(self, block: &Block, key: &KeyOf<'_>) -> Result<(), SceneError> {
        let mount = resolve_mount(self.mount, self.mount_height_m, self.pulley_ratio, key)?;
        let refused = |error: ParameterError| {
            let name = if error.parameter == "height" { "mount_height_m" } else { error.parameter };
            key(name).range(error.value, error.range)
        };
        mount.lever(block).map(|_| ()).map_err(refused)
    }
}
