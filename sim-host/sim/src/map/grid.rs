//! The cells of a map: which blocks they are.

use std::f64::consts::TAU;

use sprag_ensemble::pulsed::PulsedBlock;
use sprag_ensemble::shaken::{Samples, ShakenBlock};
use sprag_shared::structure::block::GRAVITY;
use sprag_shared::structure::mount::Mount;
use toml::Table;

use crate::batch::case::PulseShape;
use crate::scene::ground::Motion;
use crate::scene::map::{AxisTable, MapTable};
use crate::scene::schema::RestitutionValue;
use crate::scene::{Scene, SceneError};

/// A scene with the axes of its map.
#[derive(Clone, Debug)]
pub struct Grid {
    /// The scene as it is without the axes' values.
    pub scene: Scene,
    /// Axes of the grid.
    pub map: MapTable,
    text: Table,
    /// For every device, how a cell's block follows from the scene's own; none where cells are read anew as scenes.
    direct: Vec<Option<Direct>>,
    /// The record that shakes every cell, if no axis changes more of it than its scale.
    record: Option<Samples>,
}

/// What the axes are set to: x, and y where there is one.
pub type Values = (f64, Option<f64>);

/// What there is at a place of a map.
#[derive(Debug)]
pub(super) enum Subject {
    /// A dimensionless block under a one-cycle pulse.
    Pulsed(PulsedBlock),
    /// Anything else.
    Scene(Box<Scene>),
}

/// A dimensionless block and the quantities of it that the axes set.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Direct {
    base: PulsedBlock,
    x: Quantity,
    y: Option<Quantity>,
    /// λ.
    inertia_ratio: f64,
    /// `ground.0.scale`, which amplitudes are multiplied by.
    scale: f64,
}

/// A quantity of a [`PulsedBlock`], by the key that sets it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    /// `ground.0.frequency_ratio`.
    Frequency,
    /// `ground.0.amplitude_ratio`.
    Amplitude,
    /// `block.slenderness_deg`.
    Slenderness,
    /// `block.restitution`.
    Restitution,
    /// `device.N.mass_ratio`.
    MassRatio(usize),
}

impl Grid {
    /// The grid of `scene`, whose text is `text`.
    ///
    /// # Errors
    /// [`SceneError`] when the scene has no axes, or a value at a corner of the map is outside its range.
    pub fn new(mut scene: Scene, text: Table) -> Result<Grid, SceneError> {
        let key = |key: &str| crate::scene::error::KeyPath { origin: scene.origin.clone(), key: key.to_owned() };
        let Some(map) = scene.file.map.clone() else {
            return Err(key("map.x").missing("a [map] table with an axis x, or --x KEY=FROM:TO:CELLS"));
        };
        scene.overturned_at = map.overturned_at;
        let mut grid = Grid { direct: Vec::new(), record: None, scene, map, text };
        // Keys that the scene does not know are refused here, as in a file. Ranges are intervals: what holds at the corners holds
        // between them.
        for row in [0, grid.rows() - 1] {
            for column in [0, grid.columns() - 1] {
                grid.scene_of(column, row)?;
            }
        }
        grid.direct = (0..grid.scene.devices.len()).map(|device| grid.direct(device)).collect();
        let mut keys = std::iter::once(&grid.map.x).chain(&grid.map.y).map(|axis| axis.key.as_str());
        if keys.all(|key| !key.starts_with("ground.") || key == "ground.0.scale") {
            // What cannot be read is reported by the first cell.
            grid.record = grid.scene.only_record().ok().flatten().map(|record| Samples::from(&record));
        }
        Ok(grid)
    }

    /// Cells across.
    pub fn columns(&self) -> usize {
        self.map.x.cells
    }

    /// Cells up; 1 for a cut.
    pub fn rows(&self) -> usize {
        self.map.y.as_ref().map_or(1, |y| y.cells)
    }

    /// Rows of the map's table: a cell of a device each.
    pub fn table_rows(&self) -> usize {
        self.columns() * self.rows() * self.scene.devices.len()
    }

    /// Cells of device `device` that one task works on: so many that their lanes are full, or one where each is a simulation.
    pub fn task(&self, device: usize) -> usize {
        match (&self.direct[device], pulsed(&self.scene, device), &self.record) {
            (Some(_), ..) => 2048,
            (None, Some(_), _) => 256,
            (None, None, Some(_)) if self.scene.plain_block(device).is_some() => 64,
            (None, None, _) => 1,
        }
    }

    /// The block with device `device` in a cell, if its scene is a dimensionless block under a one-cycle pulse.
    ///
    /// # Errors
    /// [`SceneError`] for a cell's value outside its range.
    pub fn pulsed(&self, device: usize, column: usize, row: usize) -> Result<Option<PulsedBlock>, SceneError> {
        Ok(match self.subject(device, self.values(column, row))? {
            Subject::Pulsed(block) => Some(block),
            Subject::Scene(_) => None,
        })
    }

    /// The block with device `device` where the axes have `values`.
    ///
    /// # Errors
    /// [`SceneError`] for a value outside its range.
    pub(super) fn subject(&self, device: usize, values: Values) -> Result<Subject, SceneError> {
        let Some(direct) = &self.direct[device] else {
            let scene = self.scene_at(values)?;
            return Ok(pulsed(&scene, device).map_or_else(|| Subject::Scene(Box::new(scene)), Subject::Pulsed));
        };
        let mut block = direct.base;
        direct.set(&mut block, device, direct.x, values.0);
        if let (Some(quantity), Some(value)) = (direct.y, values.1) {
            direct.set(&mut block, device, quantity, value);
        }
        Ok(Subject::Pulsed(block))
    }

    /// The block of `scene`, at a place of the map, with device `device` under the record that shakes all of it, if there is one.
    pub(super) fn shaken(&self, scene: &Scene, device: usize) -> Option<ShakenBlock<'_>> {
        Some(ShakenBlock {
            plain: scene.plain_block(device)?,
            frequency_parameter: scene.block.frequency_parameter(),
            samples: self.record.as_ref()?,
            factor: scene.file.ground[0].scale,
        })
    }

    /// The values of a cell.
    pub fn values(&self, column: usize, row: usize) -> Values {
        self.values_at(column as f64, row as f64)
    }

    /// The values at a place in cells from the first, across and up.
    pub fn values_at(&self, column: f64, row: f64) -> Values {
        (self.map.x.value_at(column), self.map.y.as_ref().map(|axis| axis.value_at(row)))
    }

    /// `values` with their keys, for messages.
    pub fn place(&self, values: Values) -> String {
        self.settings(values).join(", ")
    }

    /// KEY=VALUE of both axes; values read back to the same f64.
    pub fn settings(&self, (x, y): Values) -> Vec<String> {
        let setting = |axis: &AxisTable, value: f64| format!("{}={value:?}", axis.key);
        let mut settings = vec![setting(&self.map.x, x)];
        settings.extend(self.map.y.iter().zip(y).map(|(axis, value)| setting(axis, value)));
        settings
    }

    /// The scene of a cell.
    ///
    /// # Errors
    /// [`SceneError`] for a value outside its range.
    pub fn scene_of(&self, column: usize, row: usize) -> Result<Scene, SceneError> {
        self.scene_at(self.values(column, row))
    }

    /// The scene where the axes have `values`.
    ///
    /// # Errors
    /// [`SceneError`] for a value outside its range.
    pub fn scene_at(&self, values: Values) -> Result<Scene, SceneError> {
        let mut scene = Scene::of_table(self.text.clone(), &self.scene.origin, &self.settings(values))?;
        scene.folder.clone_from(&self.scene.folder);
        scene.given.clone_from(&self.scene.given);
        scene.overturned_at = self.scene.overturned_at;
        Ok(scene)
    }

    fn direct(&self, device: usize) -> Option<Direct> {
        let base = pulsed(&self.scene, device)?;
        let file = &self.scene.file;
        let quantity = |axis: &AxisTable| {
            let ground = &file.ground[0];
            let resolved = &self.scene.devices[device].device;
            Some(match axis.key.split('.').collect::<Vec<_>>()[..] {
                ["ground", "0", "frequency_ratio"] => Quantity::Frequency,
                ["ground", "0", "amplitude_ratio"] => Quantity::Amplitude,
                // Whatever else depends on α is read anew.
                ["block", "slenderness_deg"]
                    if ground.amplitude_ratio.is_some()
                        && matches!(file.block.restitution, RestitutionValue::Number(_))
                        && resolved.mount == Mount::CentreOfMass =>
                {
                    Quantity::Slenderness
                }
                ["block", "restitution"] => Quantity::Restitution,
                ["device", index, "mass_ratio"] if resolved.mount == Mount::CentreOfMass => {
                    Quantity::MassRatio(index.parse().ok()?)
                }
                _ => return None,
            })
        };
        let y = match &self.map.y {
            Some(axis) => Some(quantity(axis)?),
            None => None,
        };
        let inertia_ratio = file.block.inertia_ratio;
        Some(Direct { base, x: quantity(&self.map.x)?, y, inertia_ratio, scale: file.ground[0].scale })
    }
}

impl Direct {
    /// Sets one quantity of `block`, which carries device number `device`.
    fn set(&self, block: &mut PulsedBlock, device: usize, quantity: Quantity, value: f64) {
        match quantity {
            Quantity::Frequency => block.frequency_ratio = value,
            Quantity::Amplitude => block.amplitude_ratio = self.scale * value,
            Quantity::Slenderness => block.plain.slenderness = value.to_radians(),
            Quantity::Restitution => block.plain.restitution = value,
            Quantity::MassRatio(index) if index == device => block.plain.coupling = value / self.inertia_ratio,
            Quantity::MassRatio(_) => {}
        }
    }
}

/// The block of `scene` with device number `device`, if that is an ideal device under a one-cycle pulse and nothing else is asked for.
pub fn pulsed(scene: &Scene, device: usize) -> Option<PulsedBlock> {
    let file = &scene.file;
    let [ground] = &file.ground[..] else { return None };
    let pulse = match ground.motion {
        Motion::Sine => PulseShape::Sine,
        Motion::Cosine => PulseShape::Cosine,
        _ => return None,
    };
    if ground.start_s != 0.0 {
        return None;
    }
    let plain = scene.plain_block(device)?;
    let p = scene.block.frequency_parameter();
    let amplitude = match (ground.amplitude_ratio, ground.amplitude_g, ground.amplitude_m_s2) {
        (Some(ratio), ..) => ratio,
        (_, Some(g), _) => g / scene.uplift_threshold(),
        (.., m_s2) => m_s2? / GRAVITY / scene.uplift_threshold(),
    };
    let frequency_ratio = ground.frequency_ratio.or(ground.frequency_hz.map(|hertz| hertz * TAU / p))?;
    Some(PulsedBlock { plain, pulse, frequency_ratio, amplitude_ratio: ground.scale * amplitude })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "
        block = { frequency_parameter_1_s = 2.0, slenderness_deg = 12.0, restitution = 0.8, inertia_ratio = 1.5 }
        device = [{ kind = 'none' }, { kind = 'clutched-pair', mass_ratio = 0.6 }]
        ground = [{ motion = 'cosine', amplitude_ratio = 3.0, frequency_ratio = 2.0, scale = -2.0 }]
    ";

    fn grid(axes: &str) -> Result<Grid, SceneError> {
        let text: Table = toml::from_str(&format!("{SCENE}\n{axes}")).unwrap();
        Grid::new(Scene::of_table(text.clone(), "scene", &[])?, text)
    }

    /// A cell made from the scene's own block is the cell read as a scene.
    #[test]
    fn the_short_way_to_a_cell_is_the_long_one() {
        for (x, y) in [
            ("ground.0.frequency_ratio", "ground.0.amplitude_ratio"),
            ("block.slenderness_deg", "block.restitution"),
            ("device.1.mass_ratio", "block.slenderness_deg"),
        ] {
            let grid = grid(&format!(
                "map.x = {{ key = '{x}', from = 0.3, to = 0.9, cells = 4 }}
                 map.y = {{ key = '{y}', from = 0.2, to = 0.7, cells = 3, scale = 'logarithmic' }}"
            ))
            .unwrap();
            assert!(grid.direct.iter().all(Option::is_some));
            for (device, column, row) in [(0, 0, 0), (1, 2, 1), (0, 3, 2), (1, 3, 0)] {
                let between = grid.values_at(column as f64 * 0.9, row as f64 * 0.7);
                for values in [grid.values(column, row), between] {
                    let long = pulsed(&grid.scene_at(values).unwrap(), device);
                    let Subject::Pulsed(short) = grid.subject(device, values).unwrap() else { panic!("{x} {y}") };
                    assert_eq!(Some(short), long, "{x} {y}");
                }
            }
        }
    }

    #[test]
    fn a_pulse_in_other_units_is_the_same_pulse() {
        let of = |ground: &str| {
            let text = SCENE.replace("amplitude_ratio = 3.0, frequency_ratio = 2.0, scale = -2.0", ground);
            pulsed(&Scene::parse(&text, "scene").unwrap(), 1).unwrap()
        };
        let ratios = of("amplitude_ratio = 3.0, frequency_ratio = 2.0");
        let g = 3.0 * sprag_shared::math::tan(12.0_f64.to_radians());
        let others = [
            of(&format!("amplitude_g = {g}, frequency_hz = {}", 4.0 / TAU)),
            of(&format!("amplitude_m_s2 = {}, frequency_ratio = 2.0", g * GRAVITY)),
        ];
        for other in others {
            assert!((other.amplitude_ratio - ratios.amplitude_ratio).abs() < 1e-14);
            assert!((other.frequency_ratio - ratios.frequency_ratio).abs() < 1e-14);
        }
        assert!((ratios.plain.coupling - 0.4).abs() < 1e-15 && ratios.plain.restitution == 0.8);
    }

    #[test]
    fn whatever_is_not_a_plain_pulse_is_simulated() {
        let scene = |change: &str| Scene::parse_with(SCENE, "scene", &[change.to_owned()]).unwrap();
        assert!(pulsed(&scene("block.restitution=0.7"), 1).is_some());
        for change in [
            "ground.0.start_s=1.0",
            "ground.0.motion=\"half-sine\"",
            "block.initial_rotation_ratio=0.1",
            "accuracy.step_s=0.001",
            "accuracy.level=\"tight\"",
            "device.1.kinematics=\"consistent\"",
        ] {
            assert_eq!(pulsed(&scene(change), 1), None, "{change}");
        }
    }

    #[test]
    fn axes_that_lead_nowhere_are_refused() {
        let refused = |axes: &str| grid(axes).unwrap_err().to_string();
        assert!(refused("").contains("map.x is missing"));
        assert!(refused("map.x = { key = 'block.colour', from = 0, to = 1, cells = 3 }").contains("unknown field `colour`"));
        assert!(refused("map.x = { key = 'device.0.kind', from = 0, to = 1, cells = 3 }").contains("device.0.kind"));
        let beyond = refused("map.x = { key = 'block.restitution', from = 0.5, to = 1.5, cells = 3 }");
        assert!(beyond.contains("block.restitution is 1.5"), "{beyond}");
    }
}
