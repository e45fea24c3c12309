//! The serial link between a device and whoever talks to it.
//!
//! A frame is one message: version, tag and message by [postcard](https://postcard.jamesmunns.com/wire-format), a CRC-16 over them, all of it
//! stuffed by COBS so that a zero byte ends a frame and occurs nowhere else. Whoever joins late, or hears noise, is in step again after the
//! next zero. Nothing waits for a reply, no frame depends on another, and a frame that is not whole is dropped.
//!
//! [`reset_cause`]: why a device started. The room imports `control`.

mod frame;
mod message;
pub mod reset_cause;

pub use frame::{Deframer, FrameError, MAX_FRAME, Received, VERSION, encode};
pub use message::{
    Done, Identity, LOG_BLOCK, LogBlock, LogEntry, Mishap, Pace, Protection, RECORDED_PARTS, Recorded, RecorderActivity,
    RecorderState, Refusal, Reply, Request, Started, State, TickReport, TickSample, WORD_BLOCK, Words,
};

#[cfg(test)]
mod tests;
