//! What a scene turns on for one of its devices, and the equations that result.

use sprag_shared::structure::Structure;
use sprag_shared::structure::device::DeviceKind;
use sprag_shared::structure::drivetrain::Engagement;

use super::motion::motion;
use super::number::number;
use super::{EFFECTS, Effect, block, rules, settings};
use crate::scene::schema::{EventTreatment, MethodName, Precision};
use crate::scene::sliding::step;
use crate::scene::{Scene, SceneDevice};

/// An effect that is on, and by which keys and values.
#[derive(Clone, Debug)]
pub struct Setting {
    /// The effect.
    pub effect: &'static Effect,
    /// `key = value, …`.
    pub keys: String,
}

/// A heading and its lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// Heading.
    pub title: &'static str,
    /// Lines, of any length.
    pub lines: Vec<String>,
}

/// Effects that are on, and the names of those that are off.
#[derive(Clone, Debug)]
pub struct Effects {
    /// On, and why.
    pub on: Vec<Setting>,
    /// Off.
    pub off: Vec<&'static str>,
}

impl Effects {
    /// Effects of the whole scene.
    pub fn of_scene(scene: &Scene) -> Effects {
        Effects::among(scene, 0, false)
    }

    /// Those of device number `index`, which `scene` has.
    pub fn of_device(scene: &Scene, index: usize) -> Effects {
        Effects::among(scene, index, true)
    }

    fn among(scene: &Scene, index: usize, of_device: bool) -> Effects {
        let (mut on, mut off) = (Vec::new(), Vec::new());
        for effect in EFFECTS.into_iter().filter(|effect| effect.of_device() == of_device) {
            match effect.setting(scene, index) {
                Some(keys) => on.push(Setting { effect, keys }),
                None => off.push(effect.name),
            }
        }
        Effects { on, off }
    }
}

/// One device, explained.
#[derive(Clone, Debug)]
pub struct Explanation {
    /// Name of the device.
    pub device: String,
    /// Kind of the device, as scenes spell it.
    pub kind: &'static str,
    /// Effects of the device.
    pub effects: Effects,
    /// Equations and rules.
    pub sections: Vec<Section>,
}

/// A device as the equations see it.
pub(super) struct Subject<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The device.
    pub device: &'a SceneDevice,
    /// Its number.
    pub index: usize,
    /// The block with what rides on it.
    pub loaded: Structure,
}

impl Subject<'_> {
    /// It has an inerter.
    pub fn has_inerter(&self) -> bool {
        self.device.device.kind != DeviceKind::None
    }

    /// A quantity per mass of the bare block as one per mass of the block with what rides on it.
    pub fn per_mass(&self, value: f64) -> f64 {
        value / (1.0 + self.device.added_mass.mass_ratio)
    }

    /// The ground moves vertically too.
    pub fn has_vertical(&self) -> bool {
        !self.scene.file.vertical.is_empty()
    }
}

impl Explanation {
    /// Of device number `index`, which `scene` has.
    pub fn of(scene: &Scene, index: usize) -> Explanation {
        let structure = scene.structure(index);
        // A scene has been checked, and so loads.
        let loaded = structure.loaded().unwrap_or(structure);
        let subject = Subject { scene, device: &scene.devices[index], index, loaded };
        let mut sections = vec![Section { title: "equation of motion", lines: motion(&subject) }];
        if subject.has_inerter() {
            sections.push(Section { title: "flywheels", lines: rules::flywheels(&subject) });
            sections.push(Section { title: "engagement", lines: rules::engagement(&subject) });
        }
        sections.push(Section { title: "uplift, impact, rest", lines: rules::impact(&subject) });
        sections.push(Section { title: "followed by", lines: vec![engine(&subject)] });
        let table = &scene.file.device[index];
        let standing = table.weight.as_ref().map(|weight| weight.standing()).unwrap_or_default();
        let still = standing.iter().map(|name| format!("device.{index}.{name}: it stands still on the support"));
        let hits = scene.file.block.foundation.is_some() && !settings(scene, index, block::IMPACT.keys).is_empty();
        let idle: Vec<String> = still.chain(hits.then(|| "block.restitution: on a foundation nothing hits".to_owned())).collect();
        if !idle.is_empty() {
            sections.push(Section { title: "given, but without effect on the motion", lines: idle });
        }
        let kind = table.kind.name();
        let effects = Effects::of_device(scene, index);
        Explanation { device: scene.devices[index].name.clone(), kind, effects, sections }
    }
}

/// Which engine, and how it integrates.
fn engine(subject: &Subject<'_>) -> String {
    let accuracy = &subject.scene.file.accuracy;
    if let Some(foundation) = subject.scene.file.block.foundation {
        let hertz = number(foundation.vertical_frequency_hz);
        return format!(
            "a block on feet that swing at {hertz} Hz: modes of its own; located events, Runge-Kutta 4 in steps that follow them"
        );
    }
    if subject.scene.file.block.friction_coefficient.is_some() {
        let precision = if accuracy.precision == Precision::F32 { " in f32" } else { "" };
        let step = number(step(&subject.scene.file, &subject.scene.block));
        return format!(
            "a block whose base may slide: modes of its own; located events, Runge-Kutta 4{precision}, step {step} s"
        );
    }
    let what = if subject.scene.is_ideal(subject.index) {
        "ideal: the device's state follows from the block's"
    } else if subject.device.is_ideal() && subject.has_vertical() {
        "device with memory, for the vertical ground motion"
    } else if subject.device.is_ideal() {
        "device with memory, for the scatter of impacts"
    } else {
        "device with memory: states and events of its own"
    };
    let events = match accuracy.events {
        EventTreatment::Located => "located events",
        EventTreatment::StepEnd => "events at step ends",
    };
    let elastic = matches!(subject.device.drivetrain.engagement, Engagement::Elastic { .. });
    let method = match accuracy.method {
        MethodName::Taylor => "Taylor series",
        MethodName::ExponentialMidpoint if elastic => "exponential midpoint",
        MethodName::RungeKutta4 | MethodName::ExponentialMidpoint => "Runge-Kutta 4",
        MethodName::SemiImplicitEuler => "semi-implicit Euler",
    };
    let step = match accuracy.step(subject.scene.block.frequency_parameter()) {
        Some(step) => format!("step {} s", number(step)),
        None => format!("tolerance {}", number(accuracy.tolerance)),
    };
    let precision = if accuracy.precision == Precision::F32 { " in f32" } else { "" };
    format!("{what}; {events}, {method}{precision}, {step}")
}
