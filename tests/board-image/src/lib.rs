//! The unmodified image of the board, executed on the host: a Cortex-M4 by Unicorn, and models of every part of the chip and of the
//! board that it touches. The chip is an STM32F405 or an STM32G474 ([`model::Model`]).
//!
//! Times are estimates: an instruction is taken for 1.5 cycles, without the pipeline and the flash's wait states. A peripheral is as true
//! as its model, which follows the section of the reference manual (RM0090 or RM0440) or data sheet that it names.

pub mod bench;
pub mod chip;
pub mod engine;
pub mod image;
pub mod lockstep;
pub mod model;
pub mod peripheral;
pub mod random;
pub mod rig;
pub mod time;
