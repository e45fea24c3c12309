//! SIMD ensemble of blocks: overturning maps, rocking spectra and fragilities at the speed of the machine's registers.
//!
//! [`blocks`] steps several blocks side by side, in lanes, by the equations of motion and the series that every other part uses; [`pulses`]
//! keeps the lanes filled with blocks under pulses ([`pulsed`]), decides the outcome of each after its pulse by the first integral of free
//! rocking, and hands the few that the lanes cannot settle to the core ([`alone`]); [`times`] adds impacts and times. [`records`] does the
//! same for blocks under records ([`shaken`]), and [`after_record`] continues from there. [`rows`] are blocks and results as plain numbers.
//! [`machine`] picks the widest registers of the machine that runs it: the bits of a result do not depend on them, nor on a block's
//! neighbours.
//!
//! A package of its own because it is built three times over, once for each kind of registers: what depends on it is not.

// Unit tests are of the parts: what asks for all of them takes long to build, and `tests/tests/motion/lanes_*.rs` test it.
#![cfg_attr(test, allow(dead_code))]

pub mod after_record;
pub mod alone;
pub mod blocks;
pub mod hybrid;
#[cfg(not(test))]
pub mod machine;
pub mod model;
pub mod plain;
pub mod polynomial;
pub mod pulsed;
pub mod pulses;
pub mod records;
pub mod rest;
pub mod rows;
pub mod series;
pub mod shaken;
pub mod slender;
pub mod times;

use sprag_shared::math::lanes::{LaneMask, Lanes};

/// Number of lanes: the doubles of one 512-bit register, of two of 256 bits, or of four of 128.
pub const WIDTH: usize = 8;

/// One quantity of the block in every lane.
pub type Number = Lanes<f64, WIDTH>;

/// One condition of the block in every lane.
pub type Mask = LaneMask<WIDTH>;

/// The same number in every lane.
#[inline(always)]
pub(crate) fn number(value: f64) -> Number {
    Lanes([value; WIDTH])
}
