//! Drivers of the parts around the controller, over embedded-hal, so that a host tests them against models of the parts:
//! `cargo test --package sprag-drivers --target x86_64-unknown-linux-gnu`.
#![no_std]

#[cfg(test)]
extern crate std;

pub mod icm42688;
