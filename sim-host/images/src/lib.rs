//! The firmware for the emulator, inside the program that runs it.

mod cargo;

pub use cargo::cargo_build;

/// The firmware for the emulator, built from the source that this program was built from: an ELF file for ARM, without symbols and without
/// logs. Empty in a program that was built without optimisation or the feature `inside`, or where there was no Rust for the target.
pub static EMULATOR: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/emulator.elf"));
