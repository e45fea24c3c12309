//! The core of Sprag, shared by the simulator and the firmware: the dynamics of a rocking block with inerters, the
//! methods that integrate it, and the events between which it is smooth. No `std`, no allocation, no `unsafe`.
//!
//! The map, from the ground up:
//! - [`scalar`], [`value`], [`lanes`]: what an equation is written over, so that it is written once; [`math`]: every
//!   transcendental function.
//! - [`block`], [`inertance`], [`lever`], [`clutch`]: the structure and its device; [`ground`]: what shakes it.
//! - [`equation`]: the equations of motion.
//! - [`arc`], [`fixed`], [`tape`], [`taylor`]: methods; [`decay`]: free motion summed to its end; [`polynomial`], [`locate`]: where a smooth motion crosses zero.
//! - [`structure`]: from parameters to the equations that they need.
//! - [`rocking`]: the block from event to event; [`observer`]: who watches; [`digest`]: whether two runs are the same.
//! - [`detected`]: the usual scheme, in which nothing is located, as the yardstick of accuracy and cost.
//! - [`case`]: a scene in words, which a board and its host run to the same bits.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod arc;
pub mod block;
pub mod case;
pub mod clutch;
pub mod decay;
pub mod detected;
pub mod digest;
pub mod drivetrain;
pub mod equation;
pub mod error;
pub mod fixed;
pub mod ground;
pub mod inertance;
pub mod lanes;
pub mod lever;
pub mod locate;
pub mod math;
pub mod observer;
pub mod polynomial;
pub mod rocking;
pub mod scalar;
pub mod snapshot;
pub mod structure;
pub mod tape;
pub mod taylor;
pub mod value;
