//! Accelerometers at rest: the ground's and the block's measure gravity and nothing else, or else the same shaking.

use crate::control::ticks::Streak;

/// For how long which of them has been off alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Rest {
    block: Streak,
    ground: Streak,
    /// For how long the block's has measured gravity alone, at rest or not.
    quiet: Streak,
}

impl Rest {
    /// One tick. `block` and `ground` are how far each is off gravity, m/s², where it can be trusted.
    pub fn step(&mut self, at_rest: bool, block: Option<f32>, ground: Option<f32>, tolerance: f32) {
        let half = 0.5 * tolerance;
        let (mut block_alone, mut ground_alone) = (false, false);
        if let (true, Some(block), Some(ground)) = (at_rest, block, ground) {
            // Where both are off it is the ground that shakes, and both are right. Half the tolerance between the two, lest noise decide.
            block_alone = block > tolerance && ground <= half;
            ground_alone = ground > tolerance && block <= half;
        }
        self.block.note(block_alone);
        self.ground.note(ground_alone);
        self.quiet.note(block.is_some_and(|off| off <= tolerance));
    }

    /// The biases are new. Who has been quiet for long still is: the two that can contradict each other at once need this witness.
    pub fn recalibrated(&mut self) {
        *self = Rest { quiet: self.quiet, ..Rest::default() };
    }

    /// The block's contradicts gravity.
    pub fn block(&self, ticks: u32) -> bool {
        self.block.lasted(ticks)
    }

    /// The ground's contradicts gravity.
    pub fn ground(&self, ticks: u32) -> bool {
        self.ground.lasted(ticks)
    }

    /// The block's accelerometer says that the block lies flat on ground that does not shake.
    pub fn quiet(&self, ticks: u32) -> bool {
        self.quiet.lasted(ticks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(at_rest: bool, block: Option<f32>, ground: Option<f32>) -> (bool, bool, bool) {
        let mut rest = Rest::default();
        for _ in 0..=200 {
            rest.step(at_rest, block, ground, 0.5);
        }
        (rest.block(200), rest.ground(200), rest.quiet(8))
    }

    #[test]
    fn who_is_off_alone_is_wrong() {
        assert_eq!(run(true, Some(0.1), Some(0.1)), (false, false, true));
        assert_eq!(run(true, Some(0.6), Some(0.1)), (true, false, false));
        assert_eq!(run(true, Some(0.1), Some(0.6)), (false, true, true));
        assert_eq!(run(true, Some(3.0), Some(3.1)), (false, false, false));
        assert_eq!(run(true, Some(0.6), Some(0.4)), (false, false, false));
    }

    #[test]
    fn one_alone_or_a_block_that_moves_says_nothing() {
        assert_eq!(run(true, Some(3.0), None), (false, false, false));
        assert_eq!(run(true, None, Some(3.0)), (false, false, false));
        assert_eq!(run(false, Some(3.0), Some(0.0)), (false, false, false));
    }
}
