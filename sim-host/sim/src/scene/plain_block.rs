//! Which devices of a scene the lanes know.

use sprag_ensemble::hybrid::HybridBlock;
use sprag_ensemble::plain::PlainBlock;
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::structure::REST_SPEED;

use super::Scene;
use super::accuracy::{AccuracyTable, MethodName};
use super::map::OverturnedAt;
use crate::batch::case::TIGHT;

impl Scene {
    /// The block with device number `device`, if lanes of ideal devices know it; whatever the ground does.
    pub fn plain_block(&self, device: usize) -> Option<PlainBlock> {
        let as_lanes_rest = self.file.run.rest_speed_ratio == REST_SPEED;
        let plain = device < self.devices.len() && as_lanes_rest && self.is_followed_from_rest() && self.is_ideal(device);
        let block = PlainBlock::of_structure(&self.structure(device)).filter(|_| plain)?;
        Some(PlainBlock { overturned_at_slenderness: self.overturned_at_slenderness(), ..block })
    }

    /// Equations, modes and guards of the block with device number `device`, if lanes of real devices know it; whatever the ground does.
    pub fn hybrid_system(&self, device: usize) -> Option<HybridSystem<f64>> {
        let carrier = self.devices.get(device).filter(|_| self.is_followed_from_rest())?;
        carrier.drivetrain.resolve(&self.structure(device), !self.file.vertical.is_empty()).ok().filter(HybridBlock::knows)
    }

    /// Whether blocks count as overturned as soon as |θ| reaches α.
    pub fn overturned_at_slenderness(&self) -> bool {
        self.overturned_at == OverturnedAt::Slenderness
    }

    /// A block at rest, followed as by default, or with a larger tolerance, which lanes keep with room to spare.
    fn is_followed_from_rest(&self) -> bool {
        let file = &self.file;
        let AccuracyTable { level, method, step_s, step_ratio, precision, tolerance, .. } = &file.accuracy;
        let as_it_is = level.is_none() && *method == MethodName::Taylor && step_s.is_none() && step_ratio.is_none();
        as_it_is
            && *tolerance >= TIGHT
            && *precision == Default::default()
            && file.block.initial_rotation_ratio == 0.0
            && file.block.initial_velocity_ratio == 0.0
    }
}
