//! State that a device retains over a reset, so that it resumes where it was in the middle of an earthquake: two copies, written in turn, because
//! a reset may come in the middle of a word.

use crate::control::sensing::calibration::Calibration;
use crate::link::Pace;
use crate::math::fnv::{FOLD_BASIS, fold};

/// Words of the retained state.
pub const RETAINED_WORDS: usize = 13;

/// Resets in a row from which a device resumes; one more, and it starts from the beginning, in its safe state.
pub const MOST_RESTARTS: u8 = 5;

/// State retained in memory that a reset does not clear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Retained {
    /// Biases in use.
    pub calibration: Calibration,
    /// Believed speeds of the flywheels, over R, 1/s.
    pub spins: [f32; 2],
    /// Velocity that the ground has lately gained, g/p ([`crate::control::law::Situation::ground_drift`]).
    pub ground_drift: f32,
    /// Last count of the encoder, which a reset sets to 0.
    pub counts: i32,
    /// The controller was Armed or Rocking: it may resume.
    pub deciding: bool,
    /// Samples come from the link.
    pub attached: Option<Pace>,
    /// Resets in a row without a second of good work between them.
    pub restarts: u8,
}

impl Retained {
    /// What a board that has sensors of its own resumes with: a host that said where the block was may be gone, and the block was another.
    pub fn alone(self) -> Retained {
        let deciding = self.deciding && self.attached.is_none();
        Retained { deciding, attached: None, ..self }
    }

    /// As words that show whether they have survived, and which `turn` of writing they are from.
    pub fn words(&self, turn: u8) -> [u32; RETAINED_WORDS] {
        let Calibration { gyroscope, block, ground, encoder_zero } = self.calibration;
        let attached = match self.attached {
            None => 0,
            Some(Pace::Timer) => 1,
            Some(Pace::Sample) => 2,
        };
        let flags = u32::from(self.restarts) | attached << 8 | u32::from(self.deciding) << 16 | u32::from(turn) << 24;
        let [block_along, block_up] = block.map(f32::to_bits);
        let [ground_along, ground_up] = ground.map(f32::to_bits);
        let [first, second] = self.spins.map(f32::to_bits);
        let gyroscope = gyroscope.to_bits();
        let mut words = [
            gyroscope,
            block_along,
            block_up,
            ground_along,
            ground_up,
            encoder_zero as u32,
            first,
            second,
            self.ground_drift.to_bits(),
            self.counts as u32,
            flags,
            !flags,
            0,
        ];
        let check = check(&words);
        let [.., last] = &mut words;
        *last = check;
        words
    }

    /// What such words hold, if they have survived.
    pub fn of(words: &[u32; RETAINED_WORDS]) -> Option<Retained> {
        let &[
            gyroscope,
            block_along,
            block_up,
            ground_along,
            ground_up,
            encoder_zero,
            first,
            second,
            ground_drift,
            counts,
            flags,
            inverse,
            last,
        ] = words;
        if last != check(words) || inverse != !flags {
            return None;
        }
        let attached = match flags >> 8 & 0xFF {
            0 => None,
            1 => Some(Pace::Timer),
            _ => Some(Pace::Sample),
        };
        Some(Retained {
            calibration: Calibration {
                gyroscope: f32::from_bits(gyroscope),
                block: [block_along, block_up].map(f32::from_bits),
                ground: [ground_along, ground_up].map(f32::from_bits),
                encoder_zero: encoder_zero as i32,
            },
            spins: [first, second].map(f32::from_bits),
            ground_drift: f32::from_bits(ground_drift),
            counts: counts as i32,
            deciding: flags >> 16 & 0xFF != 0,
            attached,
            restarts: flags as u8,
        })
    }
}

/// The turn in which words were written.
fn turn(words: &[u32; RETAINED_WORDS]) -> u8 {
    let &[.., flags, _, _] = words;
    (flags >> 24) as u8
}

/// Which of two copies, 0 or 1, has survived, the later one where both have; and the turn in which it was written.
pub fn latest(copies: &[[u32; RETAINED_WORDS]; 2]) -> Option<(usize, u8)> {
    let [first, second] = copies;
    let good = copies.each_ref().map(|words| Retained::of(words).is_some());
    match good {
        // Turns wrap, and two copies are never more than one apart.
        [true, true] if turn(first).wrapping_sub(turn(second)) < 128 => Some((0, turn(first))),
        [true, false] => Some((0, turn(first))),
        [_, true] => Some((1, turn(second))),
        [false, false] => None,
    }
}

/// Of all words but the last. It is taken at every tick of a motion, and no CRC is as quick.
fn check(words: &[u32; RETAINED_WORDS]) -> u32 {
    words.iter().take(RETAINED_WORDS - 1).fold(FOLD_BASIS, |digest, word| fold(digest, *word))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn retained() -> Retained {
        Retained {
            calibration: Calibration { gyroscope: 0.01, block: [0.1, -0.2], ground: [-0.3, 0.4], encoder_zero: -12_345 },
            spins: [0.5, -0.25],
            ground_drift: 0.125,
            counts: i32::MIN,
            deciding: true,
            attached: Some(Pace::Sample),
            restarts: 3,
        }
    }

    #[test]
    fn it_survives_as_it_was() {
        for attached in [None, Some(Pace::Timer), Some(Pace::Sample)] {
            for deciding in [false, true] {
                let expected = Retained { attached, deciding, ..retained() };
                assert_eq!(Retained::of(&expected.words(200)), Some(expected));
            }
        }
    }

    /// Cut off after any word, one copy is there still, and it is the latest whole one.
    #[test]
    fn a_reset_in_the_middle_of_writing_leaves_a_copy() {
        let mut copies = [[0; RETAINED_WORDS]; 2];
        assert_eq!(latest(&copies), None);
        let now = |counts| Retained { counts, ..retained() };
        for counts in 0..1000_i32 {
            let turn = counts as u8;
            let words = now(counts).words(turn);
            for cut in 0..RETAINED_WORDS {
                let mut torn = copies;
                torn[usize::from(turn % 2)][..cut].copy_from_slice(&words[..cut]);
                let found = latest(&torn).and_then(|(which, _)| Retained::of(&torn[which]));
                assert_eq!(found, counts.checked_sub(1).filter(|before| *before >= 0).map(now), "cut after {cut} words");
            }
            copies[usize::from(turn % 2)] = words;
            assert_eq!(latest(&copies), Some((usize::from(turn % 2), turn)));
        }
    }

    #[test]
    fn a_changed_bit_is_noticed() {
        let words = retained().words(7);
        for bit in 0..RETAINED_WORDS * 32 {
            let mut changed = words;
            changed[bit / 32] ^= 1 << (bit % 32);
            assert_eq!(Retained::of(&changed), None, "bit {bit}");
        }
        // As memory is after power-on.
        assert_eq!(Retained::of(&[0; RETAINED_WORDS]), None);
        assert_eq!(Retained::of(&[u32::MAX; RETAINED_WORDS]), None);
    }
}
