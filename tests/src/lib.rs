//! Whole-workspace tests of Sprag, and what they share: the helpers of the hard cases (`sprag-stability`), the device loop, the
//! emulator, and the way to the project's shared folder.
//!
//! Numbers that the tests compare with come from closed forms and from the reference cells, never from an earlier run.

pub mod board_loop;
pub mod board_mirror;
pub mod device_loop;
pub mod dice;
pub mod digests;
pub mod emulation;
#[path = "../../shared/src/device/tests/flash.rs"]
pub mod flash;
pub mod pulse;
pub mod pulse_records;
pub mod records;
pub mod reference;
pub mod sample_tape;
pub mod scene_text;
pub mod shipped;

use std::path::PathBuf;

pub use sprag_stability::{
    Dice, FullLog, GEOMETRIES, Log, Logged, Sampled, Segment, Start, boundary, follow, overturned_without_impact, relative,
    release, resized, sane, shake, tight, unit_block,
};

/// A file of the folder beside the repository.
///
/// # Panics
/// If it is absent.
pub fn shared_file(name: &str) -> PathBuf {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared")).join(name);
    assert!(path.exists(), "this test needs {}, which is not part of the repository", path.display());
    path
}
