//! What a word may be, as firmware has it: every range once, and a byte for each parameter.

use super::kind::{Description, Kind};
use super::table::{COUNT, TABLE};
use crate::math::fnv::{FOLD_BASIS, fold};

/// A range of words.
#[derive(Clone, Copy)]
struct Range {
    real: bool,
    least: u32,
    most: u32,
}

impl Range {
    const fn of(description: &Description) -> Range {
        Range { real: matches!(description.kind, Kind::Real), least: description.least, most: description.most }
    }

    const fn equals(&self, other: &Range) -> bool {
        self.real == other.real && self.least == other.least && self.most == other.most
    }

    fn holds(&self, word: u32) -> bool {
        if self.real {
            // NaN and the infinities are in no range.
            (f32::from_bits(self.least)..=f32::from_bits(self.most)).contains(&f32::from_bits(word))
        } else {
            (self.least..=self.most).contains(&word)
        }
    }
}

/// Every range that occurs in front, how many they are, and which of them each parameter has.
const fn distinct() -> ([Range; COUNT], usize, [u8; COUNT]) {
    let mut ranges = [Range { real: false, least: 0, most: 0 }; COUNT];
    let mut which = [0; COUNT];
    let (mut count, mut item) = (0, 0);
    while item < COUNT {
        let range = Range::of(&TABLE[item]);
        let mut found = 0;
        while found < count && !ranges[found].equals(&range) {
            found += 1;
        }
        if found == count {
            ranges[count] = range;
            count += 1;
        }
        which[item] = found as u8;
        item += 1;
    }
    (ranges, count, which)
}

const DISTINCT: usize = distinct().1;

static RANGES: [Range; DISTINCT] = {
    let (all, ..) = distinct();
    let mut ranges = [all[0]; DISTINCT];
    let mut index = 0;
    while index < DISTINCT {
        ranges[index] = all[index];
        index += 1;
    }
    ranges
};

static RANGE_OF: [u8; COUNT] = distinct().2;

/// The words of [`super::Settings::default`].
pub(super) static DEFAULTS: [u32; COUNT] = {
    let mut words = [0; COUNT];
    let mut index = 0;
    while index < COUNT {
        words[index] = TABLE[index].default;
        index += 1;
    }
    words
};

/// Whether `word` is within the range of the parameter at `index`; `None` where there is no such parameter.
pub(super) fn allows(index: usize, word: u32) -> Option<bool> {
    let range = RANGES.get(usize::from(*RANGE_OF.get(index)?))?;
    Some(range.holds(word))
}

/// Of what words mean that no name shows; to be raised where a word of the same name comes to mean something else.
const VERSION: u32 = 1;

/// Digest of the names, kinds and order of the parameters: distinguishes words of this build from those of another.
pub const LAYOUT: u32 = {
    let mut digest = fold(fold(FOLD_BASIS, VERSION), COUNT as u32);
    let mut item = 0;
    while item < COUNT {
        let name = TABLE[item].name.as_bytes();
        let mut letter = 0;
        while letter < name.len() {
            digest = fold(digest, name[letter] as u32);
            letter += 1;
        }
        digest = match TABLE[item].kind {
            Kind::Real => fold(digest, 256),
            Kind::Whole => fold(digest, 257),
            Kind::Switch => fold(digest, 258),
            Kind::Choice(names) => fold(digest, 259 + names.len() as u32),
        };
        item += 1;
    }
    digest
};
