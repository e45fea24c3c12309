//! The link: bytes moved between a serial port and two rings by streams of a DMA controller. No interrupt.
//!
//! What comes is written by the stream into a ring that it goes round for ever; reading follows its position. A reader that is late by
//! more than the ring loses bytes, which the link's checksums show. What goes is copied into a ring whose longest stretch in one piece is
//! handed to the stream whenever the last one is out; both calls see to that.

use core::sync::atomic::{AtomicU8, Ordering, compiler_fence};

use crate::board::Line;

/// Bytes of a ring: 11 ms at 921,600 bit/s.
pub const RING: u16 = 1024;

static RECEIVED: [AtomicU8; RING as usize] = [const { AtomicU8::new(0) }; RING as usize];
static SENT: [AtomicU8; RING as usize] = [const { AtomicU8::new(0) }; RING as usize];

/// Where the receiving stream writes, round and round: single bytes, [`RING`] of them, which are atomic, live for ever and are otherwise
/// only read.
pub fn received() -> u32 {
    RECEIVED.as_ptr() as u32
}

/// Whether a word has bytes of a ring, which the streams read and write at any time.
pub fn holds(place: u32) -> bool {
    [RECEIVED.as_ptr() as u32, SENT.as_ptr() as u32].iter().any(|ring| (*ring & !3..ring + u32::from(RING)).contains(&place))
}

/// The two streams of a serial port.
pub trait Streams {
    /// How many bytes the receiving stream has left to the end of its ring. Clears what keeps the port from receiving.
    fn left(&mut self) -> u16;

    /// The last stretch is not out yet.
    fn sends(&self) -> bool;

    /// Sends so many bytes from an address on: within a ring that lives for ever, and not written to before they are gone.
    fn send(&mut self, first: u32, length: u16);
}

/// The link.
pub struct RingLine<S> {
    streams: S,
    /// Next byte to read.
    read: u16,
    /// Next byte to write, …
    written: u16,
    /// … first one not yet handed to the stream, …
    handed: u16,
    /// … and first one that may still be on its way.
    gone: u16,
}

impl<S: Streams> RingLine<S> {
    /// With streams of which the receiving one runs.
    pub fn new(streams: S) -> RingLine<S> {
        RingLine { streams, read: 0, written: 0, handed: 0, gone: 0 }
    }

    /// Hands the next stretch to the sending stream once the last one is out.
    fn send_on(&mut self) {
        if self.streams.sends() {
            return;
        }
        self.gone = self.handed;
        let end = if self.handed <= self.written { self.written } else { RING };
        let length = end - self.handed;
        let Some(first) = SENT.get(usize::from(self.handed)..) else { return };
        if length == 0 {
            return;
        }
        self.handed = end % RING;
        // The bytes must be in memory before the stream looks.
        compiler_fence(Ordering::Release);
        self.streams.send(first.as_ptr() as u32, length);
    }
}

impl<S: Streams> Line for RingLine<S> {
    fn read(&mut self, bytes: &mut [u8]) -> usize {
        self.send_on();
        let position = RING.saturating_sub(self.streams.left()) % RING;
        compiler_fence(Ordering::Acquire);
        let mut count = 0;
        for to in bytes {
            if self.read == position {
                break;
            }
            *to = RECEIVED.get(usize::from(self.read)).map_or(0, |byte| byte.load(Ordering::Relaxed));
            self.read = (self.read + 1) % RING;
            count += 1;
        }
        count
    }

    fn write(&mut self, bytes: &[u8]) -> usize {
        self.send_on();
        let mut count = 0;
        for byte in bytes {
            let next = (self.written + 1) % RING;
            if next == self.gone {
                break;
            }
            if let Some(place) = SENT.get(usize::from(self.written)) {
                place.store(*byte, Ordering::Relaxed);
            }
            self.written = next;
            count += 1;
        }
        self.send_on();
        count
    }
}
