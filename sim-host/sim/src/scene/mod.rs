//! Scenes: a block, its devices, the ground motion and how accurately to follow them, in a TOML file.

pub mod accuracy;
pub mod checks;
pub mod controller;
pub mod device;
pub mod document;
pub mod drivetrain;
pub mod error;
pub mod foundation;
pub mod ground;
pub mod map;
pub mod motions;
pub mod overrides;
mod plain_block;
pub mod schema;
pub mod sensors;
pub mod sliding;
pub mod support;
mod warnings;
pub mod weight;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sprag_shared::structure::block::{Block, Geometry};
use sprag_shared::structure::drivetrain::Engagement;
use sprag_shared::structure::error::ParameterError;
use sprag_shared::structure::{Base, Restitution, RestitutionScatter, Structure};

pub use device::SceneDevice;
pub use error::SceneError;
use ground::{Direction, GivenRecord};
use map::OverturnedAt;
use schema::{DeviceTable, SceneFile};

/// Largest scene file that is read, bytes.
pub const LARGEST_FILE: u64 = 1 << 20;

/// Most devices in one scene.
pub const MOST_DEVICES: usize = 16;

/// A scene whose every value is within its range.
#[derive(Clone, Debug)]
pub struct Scene {
    /// As written, with defaults filled in.
    pub file: SceneFile,
    /// Devices of the scene, one run each.
    pub devices: Vec<SceneDevice>,
    /// The block.
    pub block: Block,
    /// Restitution of the block.
    pub restitution: Restitution,
    /// Where it was read from, for messages.
    pub origin: String,
    /// Folder that record files are relative to.
    pub folder: PathBuf,
    /// Records in memory, which go before the files of the folder.
    pub given: Arc<[GivenRecord]>,
    /// |θ| at which a block counts as overturned; a map's cells have `map.overturned_at`, everything else the default.
    pub overturned_at: OverturnedAt,
}

impl Scene {
    /// Reads a scene file and applies `overrides` (`KEY=VALUE`).
    ///
    /// # Errors
    /// [`SceneError`] names the file, the key and what it may be.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Scene, SceneError> {
        let origin = path.display().to_string();
        let text = text_of(path)?;
        let mut scene = Scene::parse_with(&text, &origin, overrides)?;
        scene.folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        Ok(scene)
    }

    /// Reads a scene from `text`; `origin` is its name in messages.
    ///
    /// # Errors
    /// [`SceneError`] names the key and what it may be.
    pub fn parse(text: &str, origin: &str) -> Result<Scene, SceneError> {
        Scene::check(document::from_text(text, origin)?, origin).map_err(|error| document::with_line(error, text))
    }

    /// [`Scene::parse`] with overrides (`KEY=VALUE`).
    ///
    /// # Errors
    /// As [`Scene::parse`], and for an override that names no key.
    pub fn parse_with(text: &str, origin: &str, overrides: &[impl AsRef<str>]) -> Result<Scene, SceneError> {
        if overrides.is_empty() {
            return Scene::parse(text, origin);
        }
        let mut table = document::table(text, origin)?;
        overrides::apply_all(&mut table, overrides, origin)?;
        Scene::of_table(table, origin)
    }

    /// The scene in `table`.
    ///
    /// # Errors
    /// As [`Scene::parse`].
    pub fn of_table(table: toml::Table, origin: &str) -> Result<Scene, SceneError> {
        Scene::check(document::from_table(table, origin)?, origin)
    }

    fn check(file: SceneFile, origin: &str) -> Result<Scene, SceneError> {
        let key = |key: &str| error::KeyPath { origin: origin.to_owned(), key: key.to_owned() };
        let block = file.block.block(&key)?;
        let restitution = file.block.restitution(&key)?;
        let scatter = file.block.scatter();
        scatter.check().map_err(|error| key("block.restitution_scatter").range(error.value, error.range))?;
        if file.device.is_empty() {
            return Err(key("device").missing("at least one [[device]] table"));
        }
        let mut devices: Vec<SceneDevice> = Vec::new();
        for (index, table) in file.device.iter().enumerate() {
            let key = |name: &str| key(&format!("device.{index}.{name}"));
            let device = SceneDevice::resolve(table, &file.device, &block, file.block.mass_kg, &key)?;
            // Tables have a device by its name.
            if devices.iter().any(|other| other.name == device.name) {
                return Err(key("name").conflict(&format!("{:?} is another device's; each needs a name of its own", device.name)));
            }
            // Everything that the core refuses is found here, before any work.
            let structure = structure(&file, block, restitution, &device);
            let structure = Structure { restitution_scatter: RestitutionScatter::NONE, base: Base::Rigid, ..structure };
            structure.resolve::<f64>().map_err(|error| refusal(&error, origin, index))?;
            devices.push(device);
        }
        if file.block.foundation.is_some() {
            foundation::check(&file, &devices, &key)?;
            for (index, device) in devices.iter().enumerate() {
                let gives = structure(&file, block, restitution, device).resolve_compliant::<f64>();
                gives.map_err(|error| refusal(&error, origin, index))?;
            }
        } else if let Some(friction) = file.block.friction_coefficient {
            sliding::check(&file, &devices, friction, &key)?;
            for (index, device) in devices.iter().enumerate() {
                let slides = structure(&file, block, restitution, device).resolve_sliding::<f64>();
                slides.map_err(|error| refusal(&error, origin, index))?;
            }
        }
        for direction in [Direction::Horizontal, Direction::Vertical] {
            let (name, tables) = file.motions(direction);
            for (index, motion) in tables.iter().enumerate() {
                motion.check(direction, &|key_of_motion: &str| key(&format!("{name}.{index}.{key_of_motion}")))?;
            }
        }
        file.run.check(&key)?;
        file.accuracy.check(&key)?;
        let elastic = devices.iter().any(|device| matches!(device.drivetrain.engagement, Engagement::Elastic { .. }));
        file.accuracy.check_devices(&key, first_beyond_ideal(&file, &devices).as_deref(), elastic)?;
        file.accuracy.check_watched(&file, &key)?;
        if let Some(checks) = &file.checks {
            checks.check(file.block.mass_kg, &key)?;
        }
        if let Some(controller) = &file.controller {
            controller.check(&key)?;
        }
        if let Some(map) = &file.map {
            map.check(&key)?;
        }
        if file.ground.is_empty() && file.block.initial_rotation_ratio == 0.0 && file.block.initial_velocity_ratio == 0.0 {
            return Err(key("ground").missing("a [[ground]] table, or block.initial_rotation_ratio for free rocking"));
        }
        let scene = Scene {
            file,
            devices,
            block,
            restitution,
            origin: origin.to_owned(),
            folder: PathBuf::new(),
            given: Arc::default(),
            overturned_at: OverturnedAt::default(),
        };
        scene.check_support_records()?;
        Ok(scene)
    }

    /// The block with device number `index` (below the number of devices).
    pub fn structure(&self, index: usize) -> Structure {
        structure(&self.file, self.block, self.restitution, &self.devices[index])
    }

    /// With only device number `index` (below the number of devices), and with nothing to write down: for studies that keep
    /// peaks and outcomes alone.
    pub fn only(&self, index: usize) -> Scene {
        let mut scene = self.clone();
        scene.devices = vec![scene.devices.swap_remove(index)];
        scene.file.device = vec![scene.file.device.swap_remove(index)];
        // Histories are not kept, so that they should cost nothing.
        scene.file.output.interval_s = Some(10.0);
        scene.file.output.energy = false;
        scene.file.checks = None;
        scene
    }

    /// With `device` in the place of its devices.
    ///
    /// # Errors
    /// [`SceneError`] names the key of `device` as that of device 0, and what it may be.
    pub fn with_device(&self, device: DeviceTable) -> Result<Scene, SceneError> {
        let scene = Scene::check(SceneFile { device: vec![device], ..self.file.clone() }, &self.origin)?;
        Ok(Scene { folder: self.folder.clone(), given: self.given.clone(), ..scene })
    }

    /// Full or slender.
    pub fn geometry(&self) -> Geometry {
        self.file.block.geometry.into()
    }

    /// The first key of the scene that takes a device or the ground beyond what an ideal device is followed under, if any.
    pub fn first_beyond_ideal(&self) -> Option<String> {
        first_beyond_ideal(&self.file, &self.devices)
    }

    /// Whether the loop of ideal devices is enough for device number `index` (below the number of devices), on ground that moves as the
    /// scene says.
    pub fn is_ideal(&self, index: usize) -> bool {
        let block = &self.file.block;
        let all_alike = !block.scatter().is_on() && block.base() == Base::Rigid;
        self.devices[index].is_ideal() && self.file.vertical.is_empty() && all_alike
    }

    /// g tan α, or gα for the slender model, in g.
    pub fn uplift_threshold(&self) -> f64 {
        self.geometry().uplift_threshold(self.block.slenderness())
    }

    /// How long the motion is followed after the ground motion, s.
    pub fn free_time_s(&self) -> f64 {
        match (self.file.run.free_time_s, self.file.run.free_time_ratio) {
            (Some(seconds), _) => seconds,
            (None, ratio) => ratio.unwrap_or(schema::FREE_TIME_RATIO) / self.block.frequency_parameter(),
        }
    }
}

/// The text of the scene or study at `path`.
///
/// # Errors
/// [`SceneError`] for what is not a file, is larger than [`LARGEST_FILE`], or is not UTF-8.
pub fn text_of(path: &Path) -> Result<String, SceneError> {
    let origin = path.display().to_string();
    let unreadable = |error: std::io::Error| SceneError::Unreadable { origin: origin.clone(), message: error.to_string() };
    let data = std::fs::metadata(path).map_err(unreadable)?;
    if !data.is_file() {
        return Err(SceneError::Unreadable { origin, message: "not a file".to_owned() });
    }
    if data.len() > LARGEST_FILE {
        return Err(SceneError::TooLarge { origin, bytes: data.len() });
    }
    let bytes = std::fs::read(path).map_err(unreadable)?;
    String::from_utf8(bytes).map_err(|_| SceneError::Unreadable { origin, message: "not UTF-8 text".to_owned() })
}

fn structure(file: &SceneFile, block: Block, restitution: Restitution, device: &SceneDevice) -> Structure {
    Structure {
        block,
        geometry: file.block.geometry.into(),
        device: device.device,
        added_mass: device.added_mass,
        restitution,
        restitution_scatter: file.block.scatter(),
        base: file.block.base(),
        rest_speed: file.run.rest_speed_ratio,
    }
}

/// A parameter of device number `index` that the core refuses, by the key that it comes from.
fn refusal(error: &ParameterError, origin: &str, index: usize) -> SceneError {
    let key = match error.parameter {
        "rest_speed" => "run.rest_speed_ratio".to_owned(),
        "friction_coefficient" => "block.friction_coefficient".to_owned(),
        "vertical_frequency" => "block.foundation.vertical_frequency_hz".to_owned(),
        "damping_ratio" => "block.foundation.damping_ratio".to_owned(),
        "restitution" => "block.restitution".to_owned(),
        "height" | "carried height" => format!("device.{index}.mount_height_m"),
        rule if rule.ends_with(" restitution") => format!("block.restitution: the {rule} of device.{index}"),
        parameter => format!("device.{index}.{parameter}"),
    };
    error::KeyPath { origin: origin.to_owned(), key }.range(error.value, error.range)
}

/// The first key of the scene that takes a device or the ground beyond what an ideal device is followed under, if any.
fn first_beyond_ideal(file: &SceneFile, devices: &[SceneDevice]) -> Option<String> {
    let tables = file.device.iter().zip(devices).enumerate();
    let of_device = |(index, (table, device)): (usize, (&schema::DeviceTable, &SceneDevice))| {
        table.beyond_ideal(&device.drivetrain).map(|name| format!("device.{index}.{name}"))
    };
    let vertical = || (!file.vertical.is_empty()).then(|| "vertical".to_owned());
    let scatter = || file.block.scatter().is_on().then(|| "block.restitution_scatter".to_owned());
    let friction = || file.block.friction_coefficient.map(|_| "block.friction_coefficient".to_owned());
    let foundation = || file.block.foundation.map(|_| "block.foundation".to_owned());
    tables.into_iter().find_map(of_device).or_else(vertical).or_else(scatter).or_else(friction).or_else(foundation)
}

#[cfg(test)]
mod device_tests;
#[cfg(test)]
mod motions_tests;
#[cfg(test)]
mod tests;
