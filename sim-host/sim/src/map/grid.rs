//! The cells of a map: which blocks they are.

use sprag_ensemble::pulsed::PulsedBlock;
use sprag_shared::structure::block::Block;
use sprag_shared::structure::mount::Mount;
use toml::Table;

use super::pulse::Pulse;
use crate::batch::case::PulseShape;
use crate::record::Record;
use crate::scene::controller::LawName;
use crate::scene::ground::Motion;
use crate::scene::map::{AxisTable, MapTable};
use crate::scene::schema::RestitutionValue;
use crate::scene::{Scene, SceneDevice, SceneError, overrides};
use crate::side_by_side::{self, OnlyRecords, Shaking};

/// A scene with the axes of its map.
#[derive(Clone, Debug)]
pub struct Grid {
    /// The scene as it is without the axes' values.
    pub scene: Scene,
    /// Axes of the grid.
    pub map: MapTable,
    /// What is mapped, one map each.
    mapped: Vec<Mapped>,
    text: Table,
    /// For every map, how a cell's block follows from the scene's own; none where cells are read anew as scenes.
    direct: Vec<Option<Direct>>,
    /// The record that shakes every cell, and the one that moves the ground vertically, if no axis changes more of them than their scales.
    record: Option<OnlyRecords>,
}

/// What one of the maps is of.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapped {
    /// Name of the map.
    pub name: String,
    /// Index of the device in the scene.
    pub device: usize,
    /// Law that drives its clutches in closed loop; without one the device is as it is.
    pub law: Option<LawName>,
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
    /// A scene with one device, whose clutches a law drives in closed loop.
    Loop(Box<Scene>, LawName),
}

/// A block under a pulse and the quantities of it that the axes set.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Direct {
    base: PulsedBlock,
    block: Block,
    pulse: Pulse,
    x: Quantity,
    y: Option<Quantity>,
}

/// A quantity of a block under a pulse, by the key that sets it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quantity {
    /// `ground.0.frequency_ratio` or `frequency_hz`, whichever the scene has.
    Frequency,
    /// `ground.0.amplitude_ratio`, `amplitude_g` or `amplitude_m_s2`.
    Amplitude,
    /// `block.size_m`.
    Size,
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
    pub fn new(mut scene: Scene, mut text: Table) -> Result<Grid, SceneError> {
        let key = |key: &str| crate::scene::error::KeyPath { origin: scene.origin.clone(), key: key.to_owned() };
        let Some(map) = scene.file.map.clone() else {
            return Err(key("map.x").missing("a [map] table with an axis x, or --x KEY=FROM:TO:CELLS"));
        };
        scene.overturned_at = map.overturned_at;
        let mapped = mapped(&scene, &map)?;
        // A cell has no axes.
        text.remove("map");
        let folder = scene.folder.clone();
        // What cannot be read is reported by the first cell.
        _ = scene.take_records(|motion| Record::read(motion.path(&folder).unwrap_or_default(), &motion.read_options()));
        let mut grid = Grid { mapped, direct: Vec::new(), record: None, scene, map, text };
        // Keys that the scene does not know are refused here, as in a file. Ranges are intervals: what holds at the corners holds
        // between them.
        for row in [0, grid.rows() - 1] {
            for column in [0, grid.columns() - 1] {
                grid.scene_of(column, row)?;
            }
        }
        grid.direct = grid.mapped.iter().map(|mapped| grid.direct(mapped)).collect();
        let mut keys = std::iter::once(&grid.map.x).chain(&grid.map.y).map(|axis| axis.key.as_str());
        let fixed = |key: &str| !key.starts_with("ground.") && !key.starts_with("vertical.");
        if keys.all(|key| fixed(key) || ["ground.0.scale", "vertical.0.scale"].contains(&key)) {
            grid.record = OnlyRecords::of(&grid.scene).ok().flatten();
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

    /// What is mapped: every device, and every clutched pair by every law of `map.laws`.
    pub fn mapped(&self) -> &[Mapped] {
        &self.mapped
    }

    /// Rows of the map's table: a cell of a map each.
    pub fn table_rows(&self) -> usize {
        self.columns() * self.rows() * self.mapped.len()
    }

    /// Cells of map `index` that one task works on: so many that their lanes are full, or one where each is a simulation.
    pub fn task(&self, index: usize) -> usize {
        let Mapped { device, law, .. } = self.mapped[index];
        if law.is_some() {
            return 1;
        }
        match (&self.direct[index], pulsed(&self.scene, device)) {
            (Some(_), _) => 2048,
            (None, Some(_)) => 256,
            _ if side_by_side::Subject::new(self.scene.only(device)).is_known(self.record.is_some()) => 64,
            _ => 1,
        }
    }

    /// The block of map `device` in a cell, if its scene is a dimensionless block under a one-cycle pulse.
    ///
    /// # Errors
    /// [`SceneError`] for a cell's value outside its range.
    pub fn pulsed(&self, device: usize, column: usize, row: usize) -> Result<Option<PulsedBlock>, SceneError> {
        Ok(match self.subject(device, self.values(column, row))? {
            Subject::Pulsed(block) => Some(block),
            Subject::Scene(_) | Subject::Loop(..) => None,
        })
    }

    /// The block of map `index` where the axes have `values`.
    ///
    /// # Errors
    /// [`SceneError`] for a value outside its range.
    pub(super) fn subject(&self, index: usize, values: Values) -> Result<Subject, SceneError> {
        let Mapped { device, law, .. } = self.mapped[index];
        if let Some(block) = self.direct[index].and_then(|direct| direct.at(device, values)) {
            return Ok(Subject::Pulsed(block));
        }
        let scene = self.scene_at(values)?;
        if let Some(law) = law {
            return Ok(Subject::Loop(Box::new(scene.only(device)), law));
        }
        Ok(pulsed(&scene, device).map_or_else(|| Subject::Scene(Box::new(scene)), Subject::Pulsed))
    }

    /// How the record that shakes all of the map shakes `scene`, at a place of it; none if there is no such record.
    pub(super) fn shaking(&self, scene: &Scene) -> Option<Shaking<'_>> {
        Some(self.record.as_ref()?.shaking(scene))
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

    /// KEY=VALUE of both axes; values read back to the same f64, whole ones as keys of whole numbers take them too.
    pub fn settings(&self, (x, y): Values) -> Vec<String> {
        let setting = |axis: &AxisTable, value: f64| {
            let text = format!("{value:?}");
            format!("{}={}", axis.key, text.strip_suffix(".0").unwrap_or(&text))
        };
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
        let mut table = self.text.clone();
        overrides::apply_all(&mut table, &self.settings(values), &self.scene.origin)?;
        let mut scene = Scene::of_table(table, &self.scene.origin)?;
        scene.folder.clone_from(&self.scene.folder);
        scene.given.clone_from(&self.scene.given);
        scene.overturned_at = self.scene.overturned_at;
        Ok(scene)
    }

    fn direct(&self, mapped: &Mapped) -> Option<Direct> {
        let device = mapped.device;
        let base = pulsed(&self.scene, device).filter(|_| mapped.law.is_none())?;
        let file = &self.scene.file;
        let pulse = Pulse::of(&file.ground[0])?;
        // Whatever else depends on the block or its device is read anew.
        let plain = matches!(file.block.restitution, RestitutionValue::Number(_))
            && self.scene.devices[device].device.mount == Mount::CentreOfMass;
        let quantity = |axis: &AxisTable| {
            Some(match axis.key.split('.').collect::<Vec<_>>()[..] {
                ["ground", "0", key] if key == pulse.frequency.key() => Quantity::Frequency,
                ["ground", "0", key] if key == pulse.amplitude.key() => Quantity::Amplitude,
                ["block", "size_m"] if plain && file.block.size_m.is_some() => Quantity::Size,
                ["block", "slenderness_deg"] if plain => Quantity::Slenderness,
                ["block", "restitution"] => Quantity::Restitution,
                ["device", index, "mass_ratio"] if plain => Quantity::MassRatio(index.parse().ok()?),
                _ => return None,
            })
        };
        let y = match &self.map.y {
            Some(axis) => Some(quantity(axis)?),
            None => None,
        };
        Some(Direct { base, block: self.scene.block, pulse, x: quantity(&self.map.x)?, y })
    }
}

/// The maps of `scene`: its devices, then its clutched pairs by the laws of `map`.
fn mapped(scene: &Scene, map: &MapTable) -> Result<Vec<Mapped>, SceneError> {
    let alone = |(device, of): (usize, &SceneDevice)| Mapped { name: of.name.clone(), device, law: None };
    let mut mapped: Vec<Mapped> = scene.devices.iter().enumerate().map(alone).collect();
    for (device, of) in scene.devices.iter().enumerate().filter(|(_, of)| of.takes_commands()) {
        let by = |&law: &LawName| Mapped { name: format!("{}, {}", of.name, law.name()), device, law: Some(law) };
        mapped.extend(map.laws.iter().map(by));
    }
    if mapped.len() == scene.devices.len() && !map.laws.is_empty() {
        let reason = "a closed loop needs a [[device]] of kind \"clutched-pair\" whose clutches take commands";
        return Err(scene.key("map.laws").conflict(reason));
    }
    if !map.laws.is_empty() {
        scene.check_loop_base()?;
    }
    Ok(mapped)
}

impl Direct {
    /// The block that carries device number `device` where the axes have `values`; none where it is no block.
    fn at(&self, device: usize, values: Values) -> Option<PulsedBlock> {
        let Direct { mut base, mut pulse, .. } = *self;
        let (mut size, ratio) = (self.block.size(), self.block.inertia_ratio());
        for (quantity, value) in [(Some(self.x), Some(values.0)), (self.y, values.1)] {
            let (Some(quantity), Some(value)) = (quantity, value) else { continue };
            match quantity {
                Quantity::Frequency => pulse.frequency.set(value),
                Quantity::Amplitude => pulse.amplitude.set(value),
                Quantity::Size => size = value,
                Quantity::Slenderness => base.plain.slenderness = value.to_radians(),
                Quantity::Restitution => base.plain.restitution = value,
                Quantity::MassRatio(index) if index == device => base.plain.coupling = value / ratio,
                Quantity::MassRatio(_) => {}
            }
        }
        let block = Block::new(size, base.plain.slenderness, ratio).ok()?;
        (base.frequency_ratio, base.amplitude_ratio) = pulse.ratios(&block, base.plain.geometry);
        Some(base)
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
    let (frequency_ratio, amplitude_ratio) = Pulse::of(ground)?.ratios(&scene.block, scene.geometry());
    Some(PulsedBlock { plain: scene.plain_block(device)?, pulse, frequency_ratio, amplitude_ratio })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use sprag_shared::structure::block::GRAVITY;

    use super::*;

    const SCENE: &str = "
        block = { frequency_parameter_1_s = 2.0, slenderness_deg = 12.0, restitution = 0.8, inertia_ratio = 1.5 }
        device = [{ kind = 'none' }, { kind = 'clutched-pair', mass_ratio = 0.6 }]
        ground = [{ motion = 'cosine', amplitude_ratio = 3.0, frequency_ratio = 2.0, scale = -2.0 }]
    ";

    const UNITS: &str = "
        block = { size_m = 2.0, slenderness_deg = 12.0, restitution = 0.8 }
        device = [{ kind = 'none' }, { kind = 'clutched-pair', mass_ratio = 0.6 }]
        ground = [{ motion = 'sine', amplitude_g = 0.5, frequency_hz = 1.2, scale = 1.5 }]
    ";

    fn grid(axes: &str) -> Result<Grid, SceneError> {
        grid_of(SCENE, axes)
    }

    fn grid_of(scene: &str, axes: &str) -> Result<Grid, SceneError> {
        let text: Table = toml::from_str(&format!("{scene}\n{axes}")).unwrap();
        Grid::new(Scene::of_table(text.clone(), "scene")?, text)
    }

    /// A cell made from the scene's own block is the cell read as a scene.
    #[test]
    fn the_short_way_to_a_cell_is_the_long_one() {
        let metres = UNITS.replace("amplitude_g", "amplitude_m_s2");
        for (scene, x, y) in [
            (SCENE, "ground.0.frequency_ratio", "ground.0.amplitude_ratio"),
            (SCENE, "block.slenderness_deg", "block.restitution"),
            (SCENE, "device.1.mass_ratio", "block.slenderness_deg"),
            (UNITS, "ground.0.frequency_hz", "ground.0.amplitude_g"),
            (UNITS, "block.size_m", "block.slenderness_deg"),
            (UNITS, "block.size_m", "ground.0.frequency_hz"),
            (&metres, "block.slenderness_deg", "ground.0.amplitude_m_s2"),
        ] {
            let grid = grid_of(
                scene,
                &format!(
                    "map.x = {{ key = '{x}', from = 0.3, to = 0.9, cells = 4 }}
                 map.y = {{ key = '{y}', from = 0.2, to = 0.7, cells = 3, scale = 'logarithmic' }}"
                ),
            )
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

    /// A restitution that depends on the block and its device, and a flywheel elsewhere, are read anew with them.
    #[test]
    fn what_depends_on_more_than_its_key_takes_the_long_way() {
        let axes = "map.x = { key = 'device.1.mass_ratio', from = 0.3, to = 0.9, cells = 4 }";
        let inerter = SCENE.replace("clutched-pair", "inerter");
        for scene in [
            inerter.replace("restitution = 0.8", "restitution = 'momentum-balance'"),
            inerter.replace("mass_ratio = 0.6", "mass_ratio = 0.6, mount = 'tying-point', mount_height_m = 1.0"),
        ] {
            let grid = grid_of(&scene, axes).unwrap();
            for column in 0..4 {
                let values = grid.values(column, 0);
                let found = match grid.subject(1, values).unwrap() {
                    Subject::Pulsed(block) => Some(block),
                    Subject::Scene(_) | Subject::Loop(..) => None,
                };
                assert_eq!(found, pulsed(&grid.scene_at(values).unwrap(), 1), "{scene}");
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
        let scene = |change: &str| Scene::parse_with(SCENE, "scene", &[change]).unwrap();
        for change in
            ["block.restitution=0.7", "accuracy.tolerance=1e-15", "accuracy.tolerance=1e-6", "run.rest_speed_ratio=1e-6"]
        {
            assert!(pulsed(&scene(change), 1).is_some(), "{change}");
        }
        for change in [
            "ground.0.start_s=1.0",
            "ground.0.motion=\"half-sine\"",
            "block.initial_rotation_ratio=0.1",
            "accuracy.step_s=0.001",
            "accuracy.level=\"tight\"",
            "accuracy.tolerance=1e-16",
            "run.rest_speed_ratio=1e-3",
            "device.1.kinematics=\"consistent\"",
        ] {
            assert_eq!(pulsed(&scene(change), 1), None, "{change}");
        }
        // Lanes of real devices know the speed at which a block comes to rest.
        assert!(scene("run.rest_speed_ratio=1e-3").hybrid_system(1).is_some());
        assert!(scene("accuracy.tolerance=1e-16").hybrid_system(1).is_none());
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

    #[test]
    fn no_loop_is_closed_over_a_block_on_a_foundation() {
        let soft = UNITS.replace("restitution = 0.8", "foundation = { vertical_frequency_hz = 8.0, damping_ratio = 0.3 }");
        let axes = "map.x = { key = 'ground.0.amplitude_g', from = 0.3, to = 0.9, cells = 4 }";
        assert!(grid_of(&soft, axes).is_ok());
        let refused = grid_of(&soft, &format!("{axes}\nmap.laws = ['passive']")).unwrap_err().to_string();
        assert_eq!(refused, "scene: block.foundation: a controller follows a block on rigid ground");
    }
}
