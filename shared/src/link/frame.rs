//! One message as bytes that survive a serial line, and back.

use crc::{CRC_16_IBM_3740, Crc, NoTable};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Of the messages: raised by every change of their meaning, so that strangers refuse each other instead of guessing.
pub const VERSION: u8 = 3;

/// Longest message with version, tag and checksum.
const MAX_CONTENT: usize = 124;

/// Longest frame with the byte that COBS adds to 254 or fewer, and the zero that ends it.
pub const MAX_FRAME: usize = MAX_CONTENT + 2;

/// CRC-16/IBM-3740: x¹⁶ + x¹² + x⁵ + 1 from 0xFFFF; every error of up to 3 bits and every burst of up to 16 in the content is found at this
/// length. Damage to what COBS put between moves bytes and is found as any other change, but for one in 65,536. Without a table: flash is
/// scarcer than time here.
const CHECK: Crc<u16, NoTable> = Crc::<u16, NoTable>::new(&CRC_16_IBM_3740);

/// Why bytes are no message, or a message no frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameError {
    /// Longer than [`MAX_FRAME`], or its end was lost.
    TooLong,
    /// No COBS, or the checksum is another.
    Damaged,
    /// Frame of another [`VERSION`].
    Version(u8),
    /// Whole, but no message that this version knows.
    Unknown,
}

impl core::fmt::Display for FrameError {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            FrameError::TooLong => write!(formatter, "a frame longer than {MAX_FRAME} bytes"),
            FrameError::Damaged => formatter.write_str("a damaged frame"),
            FrameError::Version(version) => {
                write!(
                    formatter,
                    "a frame of link version {version}, where {VERSION} is spoken: use firmware and sprag of one build"
                )
            }
            FrameError::Unknown => formatter.write_str("a frame that is no known message"),
        }
    }
}

impl core::error::Error for FrameError {}

/// Writes `message` as a frame into `frame` and says how long it is. `tag` is the sender's choice; a reply repeats that of its request, 0 is
/// for what nobody asked for.
///
/// # Errors
/// [`FrameError::TooLong`].
pub fn encode<T: Serialize>(tag: u8, message: &T, frame: &mut [u8; MAX_FRAME]) -> Result<usize, FrameError> {
    let mut content = [0; MAX_CONTENT];
    let [version, own_tag, body @ ..] = &mut content;
    (*version, *own_tag) = (VERSION, tag);
    // Two bytes stay for the checksum.
    let room = body.len().saturating_sub(2);
    let body = body.get_mut(..room).ok_or(FrameError::TooLong)?;
    let length = 2 + postcard::to_slice(message, body).map_err(|_| FrameError::TooLong)?.len();
    let check = CHECK.checksum(content.get(..length).ok_or(FrameError::TooLong)?).to_le_bytes();
    content.get_mut(length..length + 2).ok_or(FrameError::TooLong)?.copy_from_slice(&check);
    let content = content.get(..length + 2).ok_or(FrameError::TooLong)?;
    let stuffed = cobs::try_encode(content, frame).map_err(|_| FrameError::TooLong)?;
    *frame.get_mut(stuffed).ok_or(FrameError::TooLong)? = 0;
    Ok(stuffed + 1)
}

/// A message with its tag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Received<T> {
    /// The sender's choice.
    pub tag: u8,
    /// The message.
    pub message: T,
}

/// Finds frames in a stream of bytes.
#[derive(Clone, Debug)]
pub struct Deframer {
    buffer: [u8; MAX_FRAME],
    length: usize,
    lost: bool,
}

impl Default for Deframer {
    fn default() -> Deframer {
        Deframer::new()
    }
}

impl Deframer {
    /// Before the first byte.
    pub const fn new() -> Deframer {
        Deframer { buffer: [0; MAX_FRAME], length: 0, lost: false }
    }

    /// Takes a byte; at the end of a frame, what it was.
    pub fn feed<T: DeserializeOwned>(&mut self, byte: u8) -> Option<Result<Received<T>, FrameError>> {
        if byte != 0 {
            match self.buffer.get_mut(self.length) {
                Some(place) => {
                    *place = byte;
                    self.length += 1;
                }
                None => self.lost = true,
            }
            return None;
        }
        let (length, lost) = (self.length, self.lost);
        (self.length, self.lost) = (0, false);
        if lost {
            return Some(Err(FrameError::TooLong));
        }
        if length == 0 {
            // A zero after a zero: nothing, or a sender that makes sure.
            return None;
        }
        self.buffer.get_mut(..length).map(open)
    }
}

/// Undoes [`encode`], without the zero.
fn open<T: DeserializeOwned>(frame: &mut [u8]) -> Result<Received<T>, FrameError> {
    let length = cobs::decode_in_place(frame).map_err(|_| FrameError::Damaged)?;
    let content = frame.get(..length).ok_or(FrameError::Damaged)?;
    let (content, check) = content.split_last_chunk::<2>().ok_or(FrameError::Damaged)?;
    if CHECK.checksum(content) != u16::from_le_bytes(*check) {
        return Err(FrameError::Damaged);
    }
    let [version, tag, body @ ..] = content else { return Err(FrameError::Damaged) };
    if *version != VERSION {
        return Err(FrameError::Version(*version));
    }
    match postcard::take_from_bytes(body) {
        Ok((message, [])) => Ok(Received { tag: *tag, message }),
        _ => Err(FrameError::Unknown),
    }
}
