//! A page of records: header, records, and at its end how many there are, and a CRC-32 over all of it.
//!
//! | bytes | what |
//! | --- | --- |
//! | 0 | `SPRQ` |
//! | 4 | format, 1 if a host said what the sensors read, part, bytes of a record |
//! | 8 | number of the earthquake (16 bits), of the page in this part (16 bits) |
//! | 12 | tick of the first record |
//! | 16 | period, s, as a float |
//! | 20 | CRC-32 of the settings in force |
//! | 24 | number of the page since the flash was new |
//! | 28 | CRC-32 of the header so far |
//! | 32 | [`CAPACITY`] records of 8 bytes |
//! | 2040 | how many of them count (16 bits), 1 if the recording ends here (16 bits) |
//! | 2044 | CRC-32 of header, records that count, and the word before |

use super::record::{Moment, RECORD_BYTES};
use crate::settings::store::CRC;

/// Bytes of a page.
pub const PAGE_BYTES: u32 = 2048;
/// Words of a header.
pub const HEADER_WORDS: usize = 8;
/// Bytes of a header.
pub const HEADER_BYTES: usize = 4 * HEADER_WORDS;
/// Bytes after the records.
pub const TRAILER_BYTES: usize = 8;
/// Records of a page.
pub const CAPACITY: usize = (PAGE_BYTES as usize - HEADER_BYTES - TRAILER_BYTES) / RECORD_BYTES;

/// Of what a page means: another one has another number.
pub const FORMAT: u8 = 1;

const MARK: u32 = u32::from_le_bytes(*b"SPRQ");

/// What a page says of its records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Header {
    /// Number of the earthquake, from 1 on.
    pub number: u16,
    /// Part of its recording: a reset in motion begins another.
    pub part: u8,
    /// Number of the page in this part, from 0 on.
    pub index: u16,
    /// A host said what the sensors read.
    pub attached: bool,
    /// Tick of the first record, counted from the start of the device.
    pub first_tick: u32,
    /// From tick to tick, s.
    pub period: f32,
    /// CRC-32 of the settings in force.
    pub check: u32,
    /// Number of the page, counted over all recordings.
    pub sequence: u32,
}

impl Header {
    /// Words of the header.
    pub fn words(&self) -> [u32; HEADER_WORDS] {
        let kind = [FORMAT, u8::from(self.attached), self.part, RECORD_BYTES as u8];
        let mut words = [
            MARK,
            u32::from_le_bytes(kind),
            u32::from(self.number) | u32::from(self.index) << 16,
            self.first_tick,
            self.period.to_bits(),
            self.check,
            self.sequence,
            0,
        ];
        let check = check(&words);
        let [.., last] = &mut words;
        *last = check;
        words
    }

    /// What such words say, if they are whole and of this [`FORMAT`].
    pub fn of(words: &[u32; HEADER_WORDS]) -> Option<Header> {
        let &[mark, kind, place, first_tick, period, settings, sequence, last] = words;
        let [format, attached, part, size] = kind.to_le_bytes();
        let known = mark == MARK && format == FORMAT && usize::from(size) == RECORD_BYTES;
        (known && last == check(words)).then_some(Header {
            number: place as u16,
            part,
            index: (place >> 16) as u16,
            attached: attached != 0,
            first_tick,
            period: f32::from_bits(period),
            check: settings,
            sequence,
        })
    }
}

/// Of all words of a header but the last.
fn check(words: &[u32; HEADER_WORDS]) -> u32 {
    let mut digest = CRC.digest();
    words.iter().take(HEADER_WORDS - 1).for_each(|word| digest.update(&word.to_le_bytes()));
    digest.finalize()
}

/// Bytes as words; what is left over at the end is 0.
pub fn words<const N: usize>(bytes: &[u8]) -> [u32; N] {
    let mut words = [0; N];
    for (word, bytes) in words.iter_mut().zip(bytes.chunks_exact(4)) {
        *word = bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte));
    }
    words
}

/// Whether bytes are as flash is before it is written.
pub fn is_blank(bytes: &[u8]) -> bool {
    bytes.iter().all(|byte| *byte == 0xFF)
}

/// A whole page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Page<'a> {
    /// Header of the page.
    pub header: Header,
    /// The recording ends with it.
    pub ends: bool,
    records: &'a [u8],
}

/// Reasons why bytes are no whole page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PageError {
    /// Nothing has been written.
    Blank,
    /// Not of this format, or the supply was cut while the header was written.
    Foreign,
    /// The supply was cut, or the chip was reset, while the records were written; or they are being written.
    Torn(Header),
}

impl<'a> Page<'a> {
    /// The page that these [`PAGE_BYTES`] hold.
    pub fn of(bytes: &'a [u8]) -> Result<Page<'a>, PageError> {
        let (head, rest) = bytes.split_at_checked(HEADER_BYTES).ok_or(PageError::Foreign)?;
        let Some(header) = Header::of(&words(head)) else {
            return Err(if is_blank(bytes) { PageError::Blank } else { PageError::Foreign });
        };
        let torn = PageError::Torn(header);
        let (records, trailer) = rest.split_at_checked(CAPACITY * RECORD_BYTES).ok_or(torn)?;
        let [count, expected] = words(trailer);
        let length = (count & 0xFFFF) as usize * RECORD_BYTES;
        let records = records.get(..length).ok_or(torn)?;
        let mut digest = CRC.digest();
        [head, records, &count.to_le_bytes()].into_iter().for_each(|part| digest.update(part));
        if digest.finalize() != expected {
            return Err(torn);
        }
        Ok(Page { header, ends: count >> 16 != 0, records })
    }

    /// Its ticks with their records; a record that is none is left out.
    pub fn moments(&self) -> impl Iterator<Item = (u32, Moment)> + 'a {
        let first = self.header.first_tick;
        let records = self.records.chunks_exact(RECORD_BYTES).zip(0..);
        records.filter_map(move |(bytes, place)| Some((first.wrapping_add(place), Moment::of(words(bytes))?)))
    }
}
