//! Scenes: a block, its devices, the ground motion and how accurately to follow them, in a TOML file.

pub mod error;
pub mod ground;
pub mod overrides;
pub mod schema;

use std::path::{Path, PathBuf};

use sprag_shared::block::{Block, Geometry};
use sprag_shared::inertance::{Flywheel, inertance_of_train};
use sprag_shared::lever::Mount;
use sprag_shared::structure::{Device, DeviceKind, KinematicsKind, Restitution, Structure, WithSystem};

pub use error::SceneError;
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
    /// Its devices, each with its name.
    pub devices: Vec<(String, Device)>,
    /// The block.
    pub block: Block,
    /// Its impacts.
    pub restitution: Restitution,
    /// Where it was read from, for messages.
    pub origin: String,
    /// Folder that record files are relative to.
    pub folder: PathBuf,
}

impl Scene {
    /// Reads a scene file and applies `overrides` (`KEY=VALUE`).
    ///
    /// # Errors
    /// [`SceneError`] names the file, the key and what it may be.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Scene, SceneError> {
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
        let text = String::from_utf8(bytes)
            .map_err(|_| SceneError::Unreadable { origin: origin.clone(), message: "not UTF-8 text".to_owned() })?;
        let mut scene = Scene::parse_with(&text, &origin, overrides)?;
        scene.folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        Ok(scene)
    }

    /// Reads a scene from `text`; `origin` is its name in messages.
    ///
    /// # Errors
    /// [`SceneError`] names the key and what it may be.
    pub fn parse(text: &str, origin: &str) -> Result<Scene, SceneError> {
        Scene::parse_with(text, origin, &[])
    }

    /// [`Scene::parse`] with overrides (`KEY=VALUE`).
    ///
    /// # Errors
    /// As [`Scene::parse`], and for an override that names no key.
    pub fn parse_with(text: &str, origin: &str, overrides: &[String]) -> Result<Scene, SceneError> {
        let file: SceneFile = if overrides.is_empty() {
            let document = toml::Deserializer::parse(text).map_err(|error| SceneError::syntax(origin, text, "", &error))?;
            serde_path_to_error::deserialize(document)
                .map_err(|error| SceneError::syntax(origin, text, &error.path().to_string(), error.inner()))?
        } else {
            let mut table: toml::Table = toml::from_str(text).map_err(|error| SceneError::syntax(origin, text, "", &error))?;
            for item in overrides {
                overrides::apply(&mut table, item, origin)?;
            }
            // The lines of the file are no longer those of the scene, so only the key is named.
            serde_path_to_error::deserialize(toml::Value::Table(table))
                .map_err(|error| SceneError::syntax(origin, "", &error.path().to_string(), error.inner()))?
        };
        Scene::check(file, origin)
    }

    fn check(file: SceneFile, origin: &str) -> Result<Scene, SceneError> {
        let key = |key: &str| error::Key { origin: origin.to_owned(), key: key.to_owned() };
        let block = file.block.block(&key)?;
        let restitution = file.block.restitution(&key)?;
        if file.device.is_empty() {
            return Err(key("device").missing("at least one [[device]] table"));
        }
        if file.device.len() > MOST_DEVICES {
            return Err(key("device").range(file.device.len() as f64, "at most 16 tables"));
        }
        let mut devices = Vec::new();
        for (index, table) in file.device.iter().enumerate() {
            let key = |name: &str| key(&format!("device.{index}.{name}"));
            let device = resolve_device(table, file.block.mass_kg, &key)?;
            let structure = Structure {
                block,
                geometry: file.block.geometry.into(),
                device,
                restitution,
                rest_speed: file.run.rest_speed_ratio,
            };
            // Everything that the core refuses is found here, before any work.
            struct Nothing;
            impl WithSystem<f64> for Nothing {
                type Output = ();
                fn with<R, E, C>(self, _: sprag_shared::rocking::System<f64, R, E, C>) {}
            }
            structure.resolve(Nothing).map_err(|error| key(error.parameter).range(error.value, error.range))?;
            devices.push((table.name.clone().unwrap_or_else(|| default_name(table, &file.device)), device));
        }
        for (index, motion) in file.ground.iter().enumerate() {
            motion.check(&|name: &str| key(&format!("ground.{index}.{name}")))?;
        }
        file.run.check(&key)?;
        file.accuracy.check(&key)?;
        file.output.check(&key)?;
        if file.ground.is_empty() && file.block.initial_rotation_ratio == 0.0 && file.block.initial_velocity_ratio == 0.0 {
            return Err(key("ground").missing("a [[ground]] table, or block.initial_rotation_ratio for free rocking"));
        }
        Ok(Scene { file, devices, block, restitution, origin: origin.to_owned(), folder: PathBuf::new() })
    }

    /// The block with device number `index` (below the number of devices).
    pub fn structure(&self, index: usize) -> Structure {
        Structure {
            block: self.block,
            geometry: self.geometry(),
            device: self.devices[index].1,
            restitution: self.restitution,
            rest_speed: self.file.run.rest_speed_ratio,
        }
    }

    /// Full or slender.
    pub fn geometry(&self) -> Geometry {
        self.file.block.geometry.into()
    }

    /// g tan α, or gα for the slender model, in g.
    pub fn uplift_threshold(&self) -> f64 {
        self.geometry().uplift_threshold(&self.block)
    }

    /// How long the motion is followed after the ground motion, s.
    pub fn free_time_s(&self) -> f64 {
        match (self.file.run.free_time_s, self.file.run.free_time_ratio) {
            (Some(seconds), _) => seconds,
            (None, ratio) => ratio.unwrap_or(schema::FREE_TIME_RATIO) / self.block.frequency_parameter(),
        }
    }
}

fn default_name(table: &DeviceTable, all: &[DeviceTable]) -> String {
    let kind = match table.kind {
        schema::Kind::None => "none",
        schema::Kind::Inerter => "inerter",
        schema::Kind::ClutchedPair => "clutched pair",
    };
    if all.iter().filter(|other| other.kind == table.kind && other.name.is_none()).count() < 2 {
        return kind.to_owned();
    }
    // Several of a kind are told apart by what they differ in most often.
    let position = all.iter().position(|other| std::ptr::eq(other, table)).unwrap_or(0);
    match table.mass_ratio {
        Some(ratio) => format!("{kind} {} (σ = {ratio})", position + 1),
        None => format!("{kind} {}", position + 1),
    }
}

fn resolve_device(table: &DeviceTable, block_mass: Option<f64>, key: &dyn Fn(&str) -> error::Key) -> Result<Device, SceneError> {
    let kind = DeviceKind::from(table.kind);
    if kind == DeviceKind::None {
        let stray = [
            ("mass_ratio", table.mass_ratio.is_some()),
            ("inertance_kg", table.inertance_kg.is_some()),
            ("flywheels", table.flywheels.is_some()),
            ("mount", table.mount.is_some()),
            ("mount_height_m", table.mount_height_m.is_some()),
            ("pulley_ratio", table.pulley_ratio.is_some()),
            ("kinematics", table.kinematics.is_some()),
        ];
        return match stray.iter().find(|(_, given)| *given) {
            Some((name, _)) => Err(key(name).conflict("a device of kind \"none\" has no inerter")),
            None => Ok(Device::NONE),
        };
    }
    let mass = || block_mass.ok_or_else(|| key("inertance_kg").conflict("an inertance in kg needs block.mass_kg"));
    let mass_ratio = match (table.mass_ratio, table.inertance_kg, &table.flywheels) {
        (Some(ratio), None, None) => ratio,
        (None, Some(inertance), None) => {
            if inertance.is_nan() || inertance < 0.0 {
                return Err(key("inertance_kg").range(inertance, "0 kg or more"));
            }
            inertance / mass()?
        }
        (None, None, Some(wheels)) => {
            let train: Vec<Flywheel> = wheels
                .iter()
                .map(|w| Flywheel { mass: w.mass_kg, radius: w.radius_m, pinion_radius: w.pinion_radius_m })
                .collect();
            inertance_of_train(&train).map_err(|error| key("flywheels").parameter(&error))? / mass()?
        }
        (None, None, None) => return Err(key("mass_ratio").missing("mass_ratio, inertance_kg or flywheels")),
        _ => return Err(key("mass_ratio").conflict("give only one of mass_ratio, inertance_kg and flywheels")),
    };
    let pulley_ratio = table.pulley_ratio.unwrap_or(1.0);
    let mount = match (table.mount.unwrap_or_default(), table.mount_height_m) {
        (schema::MountName::TyingPoint, Some(height)) => Mount::TyingPoint { height, pulley_ratio },
        (schema::MountName::TyingPoint, None) => {
            return Err(key("mount_height_m").missing("the height of the tying point above the base, in m"));
        }
        (_, Some(_)) => return Err(key("mount_height_m").conflict("only a mount of kind \"tying-point\" has a height")),
        (schema::MountName::BaseCorners, None) => Mount::BaseCorners { pulley_ratio },
        (schema::MountName::CentreOfMass, None) if table.pulley_ratio.is_some() => {
            return Err(key("pulley_ratio").conflict("a pulley needs a mount of kind \"tying-point\" or \"base-corners\""));
        }
        (schema::MountName::CentreOfMass, None) => Mount::CentreOfMass,
    };
    let kinematics = table.kinematics.map_or(KinematicsKind::Paper, KinematicsKind::from);
    Ok(Device { kind, mass_ratio, mount, kinematics })
}

#[cfg(test)]
mod tests;
