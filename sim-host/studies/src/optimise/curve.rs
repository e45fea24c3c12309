//! A clutch law on a mount: devices that differ by their mass ratio alone.

use serde::Serialize;
use sprag_sim::scene::checks::ChecksTable;
use sprag_sim::scene::controller::ControllerTable;
use sprag_sim::scene::device::DeviceTable;
use sprag_sim::scene::error::KeyPath;
use sprag_sim::scene::schema::KeyOf;
use sprag_sim::scene::{Scene, SceneError};

use super::law::{Law, laws};
use super::mount::DescribedMount;
use super::setting::with_settings;
use super::table::OptimiseTable;

/// A law on a mount.
#[derive(Clone, Debug, Serialize)]
pub struct Curve {
    /// The law's name.
    pub law: String,
    /// The mount's.
    pub mount: String,
    /// In the keys of a `[[device]]`, without its mass ratio.
    pub device: DeviceTable,
    /// Its controller, where it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub controller: Option<ControllerTable>,
}

impl Curve {
    /// In one string, for legends and messages.
    pub fn name(&self) -> String {
        format!("{}, {}", self.law, self.mount)
    }

    /// `scene` with the device of `mass_ratio` σ alone, whose clutches are later than its law says by `delay_s`, and checks that look for its
    /// largest force and travel.
    ///
    /// # Errors
    /// [`SceneError`] where the scene does not take it.
    pub fn scene(&self, scene: &Scene, mass_ratio: f64, delay_s: f64) -> Result<Scene, SceneError> {
        let mut device = DeviceTable { mass_ratio: Some(mass_ratio), ..self.device.clone() };
        if delay_s > 0.0 {
            let actuation = device.actuation.get_or_insert_default();
            actuation.engagement_delay_s += delay_s;
            actuation.release_delay_s += delay_s;
        }
        let mut scene = watched(scene, device)?;
        scene.file.controller.clone_from(&self.controller);
        Ok(scene)
    }

    /// Why `scene` does not take that device, if so. It is none of the scene's, so that its key would name another one.
    pub(super) fn refusal(&self, scene: &Scene, mass_ratio: f64, delay_s: f64) -> Option<String> {
        let error = self.scene(scene, mass_ratio, delay_s).err()?;
        Some(error.to_string().replacen(&format!("{}: ", scene.origin), "", 1).replace("device.0.", ""))
    }
}

/// `scene` with `device` alone, nothing to write down, and checks that look for its largest force and travel, and what its gears and coils
/// bear.
pub(super) fn watched(scene: &Scene, device: DeviceTable) -> Result<Scene, SceneError> {
    let ChecksTable { gear, coil, .. } = scene.file.checks.clone().unwrap_or_default();
    let mut scene = scene.with_device(device)?.only(0);
    scene.file.checks = Some(ChecksTable { gear, coil, ..ChecksTable::default() });
    Ok(scene)
}

/// Every law of `table` on every mount of it, for the block of `scene`. Pairs that no scene takes, such as a clutch of its own inertia
/// at the base corners, go to `left_out` in a line each.
///
/// # Errors
/// [`SceneError`] for a law or mount that cannot be, and where nothing is left.
pub(super) fn curves(
    table: &OptimiseTable,
    scene: &Scene,
    key: &KeyOf<'_>,
    left_out: &mut Vec<String>,
) -> Result<Vec<Curve>, SceneError> {
    let mounts: Vec<DescribedMount> = table.mounts.iter().map(|entry| entry.described()).collect();
    for (index, mount) in mounts.iter().enumerate() {
        let of_mount = |name: &str| key(&format!("mounts.{index}.{name}"));
        mount.check(&scene.block, &of_mount)?;
        if mounts[..index].contains(mount) {
            return Err(key(&format!("mounts.{index}")).conflict(&format!("\"{}\" is there twice", mount.name())));
        }
    }
    let mut curves = Vec::new();
    let mut reasons = Vec::new();
    let settled = with_settings(laws(&table.laws, scene, &key("laws"))?, &table.setting, scene, table.mass_ratio.from, key)?;
    for Law { name, device, controller } in settled {
        let of_law = if mounts.is_empty() { vec![DescribedMount::of(&device)] } else { mounts.clone() };
        for mount in of_law {
            let mut device = device.clone();
            mount.attach(&mut device);
            let curve = Curve { law: name.clone(), mount: mount.name(), device, controller: controller.clone() };
            let ends = [table.mass_ratio.from, table.mass_ratio.to];
            match ends.into_iter().find_map(|mass_ratio| curve.refusal(scene, mass_ratio, 0.0)) {
                None => curves.push(curve),
                Some(reason) => reasons.push(format!("{}: {reason}", curve.name())),
            }
        }
    }
    if curves.is_empty() {
        let KeyPath { origin, key } = key("laws");
        let reason = format!("none of them can be; {}", reasons.join("; "));
        return Err(SceneError::Conflict { origin, key, reason });
    }
    left_out.append(&mut reasons);
    Ok(curves)
}
