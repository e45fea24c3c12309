//! From the ring into flash, a word at a time, and out of it over the link.
//!
//! Where erasing stops the processor the pages are filled once, and what is there is kept until somebody asks for it to be erased. Where it
//! does not, the oldest page makes room for the newest.

use crc::{Digest, Table};
use embedded_storage::nor_flash::NorFlash;

use super::page::{CAPACITY, HEADER_BYTES, HEADER_WORDS, Header, PAGE_BYTES, TRAILER_BYTES, is_blank, words};
use super::record::RECORD_BYTES;
use super::ring::{Source, Taken};
use crate::link::{Done, RECORDED_PARTS, Recorded, RecorderActivity, RecorderState, Refusal, Reply, Request};
use crate::settings::store::CRC;

/// Bytes in which everything is laid out: what the flashes of all boards can be programmed and read by.
const ALIGNMENT: usize = 8;

/// Pages whose headers are read at once at the start.
const LOOKED_AT: u32 = 8;

/// Ticks after a reset in motion within which a recording is a further part of the one before.
const RESUMED_WITHIN: u32 = 4000;

/// A page that is being written.
#[derive(Clone)]
struct Open {
    header: Header,
    count: u16,
    digest: Digest<'static, u32, Table<1>>,
    /// The flash has refused a part of it.
    failed: bool,
}

#[derive(Clone)]
enum Stage {
    /// Looks for the last page, from this one on.
    Looking(u32),
    /// No page is open.
    Ready,
    /// One is.
    Writing(Open),
    /// Erases what is below this offset.
    Erasing(u32),
}

/// Bytes on their way into the flash.
#[derive(Clone)]
struct Pending {
    offset: u32,
    bytes: [u8; HEADER_BYTES],
    length: usize,
    done: usize,
}

/// The recordings in a flash `F`, whose sectors are whole pages.
#[derive(Clone)]
pub struct Recorder<F> {
    flash: F,
    /// The oldest page makes room for the newest.
    goes_round: bool,
    /// The device resumes after a reset in motion.
    resumed: bool,
    stage: Stage,
    pending: Pending,
    /// What came when the page before was not whole yet.
    held: Option<(u32, [u32; 2], Source)>,
    /// The page to be written next; there is none where the last one is full.
    next: u32,
    /// The newest header, and whether the recording ended with its page.
    last: Option<Header>,
    ended: bool,
    /// The present recording was begun by this start of the device.
    own: bool,
    /// Everything is to be erased, once what is to be kept is there.
    to_be_erased: bool,
    /// Ticks since the start that should have been kept and were not.
    lost: u32,
    /// Pages since the start that the flash did not take.
    refused: u16,
}

/// Takes words into a checksum. By itself, for flash is scarcer than time here.
#[inline(never)]
fn digest(digest: &mut Digest<'static, u32, Table<1>>, words: &[u32]) {
    words.iter().for_each(|word| digest.update(&word.to_le_bytes()));
}

impl<F: NorFlash> Recorder<F> {
    /// Bytes that are programmed at once: a word, where the flash takes one.
    const UNIT: usize = if F::WRITE_SIZE > 4 { F::WRITE_SIZE } else { 4 };

    /// Fails to compile for a flash that it does not suit.
    const SUITS: () = {
        assert!(
            ALIGNMENT.is_multiple_of(F::WRITE_SIZE) && ALIGNMENT.is_multiple_of(F::READ_SIZE),
            "read and write in double words"
        );
        assert!(F::ERASE_SIZE.is_multiple_of(PAGE_BYTES as usize), "pages do not reach over the ends of sectors");
    };

    /// In `flash`, which it has not looked at yet. With `goes_round` the oldest page is erased for the newest, which must be a sector each. The
    /// device has `resumed` after a reset in motion.
    pub fn new(flash: F, goes_round: bool, resumed: bool) -> Recorder<F> {
        let () = Self::SUITS;
        Recorder {
            flash,
            goes_round: goes_round && F::ERASE_SIZE == PAGE_BYTES as usize,
            resumed,
            stage: Stage::Looking(0),
            pending: Pending { offset: 0, bytes: [0; HEADER_BYTES], length: 0, done: 0 },
            held: None,
            next: 0,
            last: None,
            ended: true,
            own: false,
            to_be_erased: false,
            lost: 0,
            refused: 0,
        }
    }

    /// Gives the flash back.
    pub fn release(self) -> F {
        self.flash
    }

    fn pages(&self) -> u32 {
        self.flash.capacity() as u32 / PAGE_BYTES
    }

    /// A small piece of work that programs at most a word. What there is to be kept it asks of `take`. Whether there was any.
    pub fn work(&mut self, take: impl FnOnce() -> Option<Taken>) -> bool {
        if self.pending.done < self.pending.length {
            self.program();
            return true;
        }
        match self.stage {
            Stage::Looking(from) => {
                self.look(from);
                return true;
            }
            Stage::Erasing(_) => return false,
            Stage::Ready | Stage::Writing(_) => {}
        }
        let held = self.held.take().map(|(tick, words, source)| Taken::Record { tick, words, source });
        match held.or_else(take) {
            Some(Taken::Record { tick, words, source }) => self.keep(tick, words, source),
            Some(Taken::End) => {
                self.finish(true);
                self.own = false;
            }
            None => {
                if self.to_be_erased && matches!(self.stage, Stage::Ready) {
                    (self.to_be_erased, self.stage) = (false, Stage::Erasing(self.flash.capacity() as u32));
                }
                return false;
            }
        }
        true
    }

    /// Reads the headers of some pages.
    #[inline(never)]
    fn look(&mut self, from: u32) {
        let end = (from + LOOKED_AT).min(self.pages());
        for page in from..end {
            let mut head = [0; HEADER_BYTES];
            if self.flash.read(page * PAGE_BYTES, &mut head).is_ok() && is_blank(&head) {
                continue;
            }
            let newest = Header::of(&words(&head)).filter(|header| self.last.is_none_or(|last| header.sequence >= last.sequence));
            if let Some(header) = newest {
                (self.last, self.ended) = (Some(header), self.ends(page));
            }
            // What is not blank is not written to where nothing is erased.
            if newest.is_some() || !self.goes_round {
                self.next = page + 1;
            }
        }
        self.stage = if end < self.pages() { Stage::Looking(end) } else { Stage::Ready };
    }

    /// Whether a page says that its recording ends there.
    #[inline(never)]
    fn ends(&mut self, page: u32) -> bool {
        let mut trailer = [0; TRAILER_BYTES];
        let read = self.flash.read((page + 1) * PAGE_BYTES - TRAILER_BYTES as u32, &mut trailer).is_ok();
        let [count, _] = words(&trailer);
        read && count >> 16 == 1
    }

    /// Takes a record: into the page that is open, or into another.
    #[inline(never)]
    fn keep(&mut self, tick: u32, words: [u32; 2], source: Source) {
        let page = self.next * PAGE_BYTES;
        let Stage::Writing(open) = &mut self.stage else {
            self.begin(tick, words, source);
            return;
        };
        let due = open.header.first_tick.wrapping_add(open.count.into());
        if tick == due && usize::from(open.count) < CAPACITY && !open.failed {
            let offset = page + (HEADER_BYTES + usize::from(open.count) * RECORD_BYTES) as u32;
            open.count += 1;
            digest(&mut open.digest, &words);
            self.put(offset, &words);
        } else {
            self.lost = self.lost.saturating_add(tick.wrapping_sub(due));
            self.held = Some((tick, words, source));
            self.finish(false);
        }
    }

    /// Opens a page whose first record shall be this one.
    #[inline(never)]
    fn begin(&mut self, tick: u32, record: [u32; 2], source: Source) {
        self.to_be_erased = false;
        if !self.find_room() {
            self.lost = self.lost.saturating_add(1);
            return;
        }
        let resumes = self.resumed && tick < RESUMED_WITHIN && !self.ended;
        let (number, part, index) = match self.last {
            None => (1, 0, 0),
            Some(last) if self.own => (last.number, last.part, last.index.wrapping_add(1)),
            Some(last) if resumes => (last.number, last.part.wrapping_add(1), 0),
            Some(last) => (last.number.wrapping_add(1), 0, 0),
        };
        let sequence = self.last.map_or(0, |last| last.sequence.wrapping_add(1));
        let Source { period, check, attached } = source;
        let header = Header { number, part, index, attached, first_tick: tick, period, check, sequence };
        let words = header.words();
        let mut open = Open { header, count: 0, digest: CRC.digest(), failed: false };
        digest(&mut open.digest, &words);
        self.stage = Stage::Writing(open);
        (self.last, self.ended, self.own) = (Some(header), false, true);
        self.held = Some((tick, record, source));
        self.put(self.next * PAGE_BYTES, &words);
    }

    /// Closes the page that is open.
    #[inline(never)]
    fn finish(&mut self, ends: bool) {
        let Stage::Writing(mut open) = core::mem::replace(&mut self.stage, Stage::Ready) else { return };
        self.next += 1;
        if open.failed {
            self.refused = self.refused.saturating_add(1);
            return;
        }
        self.ended = ends;
        let count = u32::from(open.count) | u32::from(ends) << 16;
        digest(&mut open.digest, &[count]);
        self.put(self.next * PAGE_BYTES - TRAILER_BYTES as u32, &[count, open.digest.finalize()]);
    }

    /// Goes to the next page that can be written to, if there is one.
    #[inline(never)]
    fn find_room(&mut self) -> bool {
        if self.goes_round {
            if self.next >= self.pages() {
                self.next = 0;
            }
            let page = self.next * PAGE_BYTES;
            let erased = self.flash.erase(page, page + PAGE_BYTES).is_ok();
            if !erased {
                self.refused = self.refused.saturating_add(1);
                self.next += 1;
            }
            return erased;
        }
        while self.next < self.pages() && !self.is_blank(self.next * PAGE_BYTES, PAGE_BYTES) {
            self.next += 1;
        }
        self.next < self.pages()
    }

    #[inline(never)]
    fn is_blank(&mut self, offset: u32, length: u32) -> bool {
        let mut bytes = [0; HEADER_BYTES];
        (offset..offset + length).step_by(HEADER_BYTES).all(|at| self.flash.read(at, &mut bytes).is_ok() && is_blank(&bytes))
    }

    #[inline(never)]
    fn put(&mut self, offset: u32, words: &[u32]) {
        self.pending = Pending { offset, length: 4 * words.len().min(HEADER_WORDS), ..self.pending };
        self.pending.done = 0;
        for (place, word) in self.pending.bytes.chunks_exact_mut(4).zip(words) {
            place.copy_from_slice(&word.to_le_bytes());
        }
    }

    #[inline(never)]
    fn program(&mut self) {
        let Pending { offset, bytes, length, done } = &mut self.pending;
        let unit = bytes.get(*done..*done + Self::UNIT).unwrap_or_default();
        let taken = self.flash.write(*offset + *done as u32, unit).is_ok();
        *done += Self::UNIT;
        if !taken {
            *done = *length;
            match &mut self.stage {
                Stage::Writing(open) => open.failed = true,
                _ => self.refused = self.refused.saturating_add(1),
            }
        }
    }

    /// Whether a sector is to be erased now: [`Recorder::erase_sector`], or [`Recorder::stop_erasing`] if something moves.
    pub fn erases(&mut self) -> bool {
        let sector = F::ERASE_SIZE as u32;
        while let Stage::Erasing(below) = self.stage {
            let Some(from) = below.checked_sub(sector) else {
                (self.stage, self.next, self.ended) = (Stage::Ready, 0, true);
                break;
            };
            if !self.is_blank(from, sector) {
                return true;
            }
            self.stage = Stage::Erasing(from);
        }
        false
    }

    /// Erases a sector, from the last one to the first, so that what is left after a stop lies before what is blank. Where
    /// [erasing stalls](super) this takes seconds.
    pub fn erase_sector(&mut self) {
        let sector = F::ERASE_SIZE as u32;
        if let Stage::Erasing(below) = self.stage
            && let Some(from) = below.checked_sub(sector)
        {
            if self.flash.erase(from, below).is_err() {
                self.refused = self.refused.saturating_add(1);
            }
            self.stage = Stage::Erasing(from);
        }
    }

    /// Leaves what has not been erased yet.
    pub fn stop_erasing(&mut self) {
        (self.stage, self.next) = (Stage::Looking(0), 0);
    }

    /// State of the flight recorder.
    pub fn state(&self) -> RecorderState {
        let activity = match self.stage {
            _ if self.to_be_erased => RecorderActivity::Erasing,
            Stage::Looking(_) => RecorderActivity::Looking,
            Stage::Ready => RecorderActivity::Ready,
            Stage::Writing(_) => RecorderActivity::Writing,
            Stage::Erasing(_) => RecorderActivity::Erasing,
        };
        RecorderState {
            pages: self.pages() as u16,
            next: self.next as u16,
            goes_round: self.goes_round,
            activity,
            lost: self.lost,
            refused: self.refused,
        }
    }

    /// Answers a request that is the recorder's; whether it may erase has been decided.
    pub fn answer(&mut self, request: &Request) -> Reply {
        match *request {
            Request::Recorder => Reply::Recorder(self.state()),
            Request::Recorded { offset } => self.recorded(offset),
            Request::EraseRecordings => {
                self.to_be_erased = !matches!(self.stage, Stage::Erasing(_));
                Reply::Done(Done::AsAsked)
            }
            _ => Reply::Refused(Refusal::NotHere),
        }
    }

    #[inline(never)]
    fn recorded(&mut self, offset: u32) -> Reply {
        let offset = offset - offset % ALIGNMENT as u32;
        let left = (self.flash.capacity() as u32).saturating_sub(offset);
        let mut recorded = Recorded { offset, count: 0, bytes: [[0; 32]; RECORDED_PARTS] };
        for part in &mut recorded.bytes {
            let at = u32::from(recorded.count);
            let Some(part) = part.get_mut(..left.saturating_sub(at).min(32) as usize) else { break };
            if self.flash.read(offset + at, part).is_err() {
                return Reply::Refused(Refusal::FlashFailed);
            }
            recorded.count += part.len() as u8;
        }
        Reply::Recorded(recorded)
    }
}
