//! The core of Sprag, shared by the simulator and the firmware: the dynamics of a rocking block with inerters, the
//! methods that integrate it, and the events between which it is smooth. No `std`, no allocation, no `unsafe`.
//!
//! The map, from the ground up:
//! - [`scalar`], [`value`], [`lanes`]: what an equation is written over, so that it is written once; [`math`]: every
//!   transcendental function.
//! - [`block`], [`carried`], [`inertance`], [`lever`], [`clutch`], [`restitution`]: the structure and its device; [`ground`]: what
//!   shakes it.
//! - [`equation`]: the equations of motion.
//! - [`arc`], [`fixed`], [`grid`], [`tape`], [`taylor`], [`closed_form`]: methods; [`decay`]: free motion summed to its end; [`polynomial`], [`locate`]: where a smooth motion crosses zero.
//! - [`structure`]: from parameters to the equations that they need.
//! - [`rocking`]: the block from event to event; [`observer`]: who watches; [`digest`]: whether two runs are the same.
//! - [`snapshot`]: block and device at an instant; [`watched`]: of an ideal device; [`ledger`]: where the energy goes; [`checks`]:
//!   what the motion asks of toe, rack and flywheels; [`gear`]: and of their teeth.
//! - [`detected`]: the usual scheme, in which nothing is located, as the yardstick of accuracy and cost.
//! - [`case`]: a scene in words, which a board and its host run to the same bits.
//! - [`control`]: the controller; [`settings`]: all that it is told, in words, which a board keeps and its host writes.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

// Modules that tests share with other crates name this one as those do.
#[cfg(test)]
extern crate self as sprag_shared;

pub mod accumulation;
pub mod any_body;
pub mod any_equation;
pub mod arc;
pub mod block;
pub mod body;
pub mod carried;
pub mod case;
pub mod checks;
pub mod closed_form;
pub mod clutch;
pub mod control;
pub mod decay;
pub mod detected;
pub mod device;
pub mod digest;
pub mod drivetrain;
pub mod equation;
pub mod error;
pub mod first_integral;
pub mod fixed;
pub mod free_motion;
pub mod gear;
pub mod grid;
pub mod ground;
pub mod hybrid;
pub mod inertance;
pub mod lanes;
pub mod ledger;
pub mod lever;
pub mod link;
pub mod locate;
pub mod math;
pub mod motion_series;
pub mod observer;
pub mod polynomial;
pub mod restitution;
pub mod rocking;
pub mod scalar;
pub mod settings;
pub mod snapshot;
pub mod structure;
pub mod tape;
pub mod taylor;
pub mod value;
pub mod watched;
