//! Which devices of a scene the lanes know.

use sprag_ensemble::plain::PlainBlock;

use super::Scene;
use super::accuracy::{AccuracyTable, MethodName};
use super::map::OverturnedAt;

impl Scene {
    /// The block with device number `device`, if lanes know it; whatever the ground does.
    pub fn plain_block(&self, device: usize) -> Option<PlainBlock> {
        let file = &self.file;
        let carrier = self.devices.get(device)?;
        let AccuracyTable { level, method, step_s, step_ratio, precision, .. } = &file.accuracy;
        let as_it_is = level.is_none() && *method == MethodName::Taylor && step_s.is_none() && step_ratio.is_none();
        let plain = as_it_is
            && *precision == Default::default()
            && file.vertical.is_empty()
            && file.block.initial_rotation_ratio == 0.0
            && file.block.initial_velocity_ratio == 0.0
            && carrier.is_ideal();
        let block = PlainBlock::of_structure(&self.structure(device)).filter(|_| plain)?;
        Some(PlainBlock { overturned_at_slenderness: self.overturned_at == OverturnedAt::Slenderness, ..block })
    }
}
