//! A parts list for the devices of a scene under a set of motions: flywheels, gear, clutches, coils and sensors, with what limits each.
//!
//! - [`basis`], [`standard`]: what is assumed, and the series that sizes are chosen from.
//! - [`subject`], [`asked`], [`largest`]: what a device asks for under each motion, and the largest of it; [`late`]: how late its clutches may be.
//! - [`gear`], [`flywheel`], [`sensors`]: one part each; [`parts`], [`study`]: the list.
//! - [`table`], [`page`], [`figure`]: tables, the page that a designer hands on, and a picture of it.

pub mod asked;
pub mod basis;
pub mod error;
pub mod figure;
pub mod flywheel;
pub mod gear;
pub mod largest;
pub mod late;
pub mod page;
pub mod parts;
pub mod sensors;
pub mod standard;
pub mod study;
pub mod subject;
pub mod table;
#[cfg(test)]
mod tests;
