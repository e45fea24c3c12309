//! The flight recorder: every control tick of an earthquake, from a little before the block moves until it stands again, in idle flash.
//!
//! - [`record`]: a tick in eight bytes; [`page`]: a page of them, which says itself whether it is whole;
//! - [`ring`]: the last ticks in memory, and when they are worth keeping: the control task's part;
//! - [`writer`]: from there into flash, a word at a time: the part of the task that has time.
//!
//! A page is written once, from its header to its checksum. A cut of the supply costs the page that is being written and no other.

pub mod page;
pub mod record;
pub mod ring;
pub mod writer;

#[cfg(test)]
mod tests;

pub use page::{CAPACITY, Header, PAGE_BYTES, Page, PageError};
pub use record::Moment;
pub use ring::{BEFORE, Ring, Taken};
pub use writer::Recorder;
