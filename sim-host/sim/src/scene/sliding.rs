//! What a block whose base may slide cannot go with.

use sprag_shared::structure::block::{Block, Geometry};
use sprag_shared::structure::device::DeviceKind;

use super::SceneDevice;
use super::error::SceneError;
use super::schema::{KeyOf, MethodName, SceneFile};
use crate::effect::number::number;

/// Step of a block that may slide where the scene gives none, in 1/p.
pub const STEP_RATIO: f64 = 1e-3;

/// Refuses what `block.friction_coefficient` = `friction` contradicts.
///
/// # Errors
/// [`SceneError`] names the key and the reason.
pub(super) fn check(file: &SceneFile, devices: &[SceneDevice], friction: f64, key: &KeyOf<'_>) -> Result<(), SceneError> {
    let name = "block.friction_coefficient";
    key(name).require(friction, friction > 0.0 && friction <= 10.0, "above 0, to 10")?;
    if let Some(index) = devices.iter().position(|device| device.device.kind != DeviceKind::None) {
        let reason =
            format!("the support of device.{index} does not slide with the block; only a block without a device may slide");
        return Err(key(name).conflict(&reason));
    }
    if Geometry::from(file.block.geometry) == Geometry::Slender {
        return Err(key(name).conflict("a block that slides has the exact geometry: block.geometry = \"full\""));
    }
    if file.block.scatter().is_on() {
        return Err(key(name).conflict("impacts that scatter (block.restitution_scatter) have no law for a toe that slides"));
    }
    if file.checks.is_some() {
        return Err(
            key("checks").conflict("the checks are those of a block that cannot slide, and block.friction_coefficient lets it")
        );
    }
    if file.output.energy {
        return Err(key("output.energy").conflict("the ledger has no entry for a base that slides (block.friction_coefficient)"));
    }
    if file.controller.is_some() {
        return Err(key(name).conflict("a controller needs a device, and a block that slides has none"));
    }
    let accuracy = &file.accuracy;
    let in_steps = format!("a block that slides is followed by Runge-Kutta steps, of {} /p by default", number(STEP_RATIO));
    if accuracy.level.is_some() {
        return Err(key("accuracy.level").conflict(&format!("{in_steps}: give accuracy.step_ratio")));
    }
    let stepped = accuracy.step_s.is_some() || accuracy.step_ratio.is_some();
    if stepped && accuracy.method == MethodName::Taylor {
        return Err(key("accuracy.method").conflict(&format!("{in_steps}: with a step give runge-kutta-4")));
    }
    Ok(())
}

/// Fixed step of `file` for `block`, s.
pub fn step(file: &SceneFile, block: &Block) -> f64 {
    let p = block.frequency_parameter();
    file.accuracy.step(p).unwrap_or(STEP_RATIO / p)
}
